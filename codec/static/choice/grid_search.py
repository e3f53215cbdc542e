"""Looking for the grid on which a mesh is smallest, within bounds: its step, and how much normals count."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels
from bsm.codec.geometry.mesh import extent_of
from bsm.codec.static.choice.judge import Judge
from bsm.codec.static.choice.lattices import Shaped
from bsm.codec.static.choice.search import LOOK_SLACK, LOOK_TRIES, THOROUGH, Trial, widest_step
from bsm.codec.static.choice.shaping import Aim, Shaper
from bsm.codec.static.contract import Contract
from bsm.codec.static.draft import Draft
from bsm.codec.static.preamble_encoding import FEW_VERTICES, Prepared

COARSEST = 0.05
"""Largest step, in BSM units."""
WORTH, WORTH_ANGLE, WORTH_GROWTH, WORTH_OF_MODELS = 0.4, 3.0, 0.7, 1.6
"""What a nat is worth, in angles that a step bends a mean face by: where 3 degrees are asked for, how it grows with
what is asked for, and of models, whose bits are not where their area is."""
WORTH_OF_LOOK, STEEP_LOOK = 0.8, (0.7, 1.5)
"""The same where pictures count; and how these get worse with the step, in their logarithms."""
HELPED, HELPED_MODELS = 0.62, 0.75
"""Angle that shaping leaves, of what rounding gives."""
ON_MODEL = 1.0
"""A grid is tried whose entropy is below so much of that of one that is about right."""
LATTICE_GAIN = 0.75
"""And where it is below so much of it, the model was made on that grid."""
PLATEAU, PLATEAU_STEPS = 1.25, 24
"""Where a grid four times as fine has no more entropy than this, so many steps a sixth of a power of two apart are
compared, too."""
NEAR_PLACE = 3.0
"""How far shaping may bring a vertex from its place, in cells, where bounds are wide."""
FINEST_BITS = 16
"""Bits along the longest side of the finest grid that is tried without need."""
OTHERS, ALIKE = 2, 1.25
"""So many of these, if they are nearly as good as the best."""
ROUNDED_MORE = 1.1
"""Where rounding bends normals by so much more than what is asked for, shaping may still do."""
QUICK_VERTICES = 4000
"""Of fewer, a trial takes no time worth speaking of."""
TRIES, SLACK, FLATTER, LAST_RESORTS = (4, 7), (0.05, 0.025), 0.5, 4
"""In the search for a step (of many vertices; of few), and where it has found none; how far below a bound on angles it
may stay; and how much less than that of rounded places the angle of shaped ones grows with it at least."""
CLOSE, MOST_COMPARED = 1.015, 2
"""Of drafts whose estimates are so close to the best, so many are compared as files."""
SHARE_OF_MODELS, SHARE_IF_SHARP = 0.45, 0.52
SHARE, SHARE_VERTICES, SHARE_OF_FEWER, SHARE_OF_BITS, MEAN_BITS = 0.575, 50_000, 0.027, 0.02, 7.0
"""What is coded of the entropy of rounded places, about: where surfaces have sharp edges, and otherwise; how that grows
when vertices are half as many as so many, and with bits of a vertex above the mean."""
MOST_EXTENTS = 256.0
"""How many times its diagonal a model may be from the origin, for its places to be counted from there."""
COARSEST_LOOKS, FITS_LOOK = 6, 0.002
"""Of these, so many are looked at; and how far off vertices may be on them, in BSM units, over the look."""
MOST_PARTS, COARSEST_GRIDS = 256, 3
"""Of models of few vertices: cells along the longest side, and how many of the coarsest grids that fit are tried."""

ROUND = 2.0 / math.sqrt(3.0) * 0.999
"""A cell of a cubic grid whose corners are just within 1 of its middle."""


@dataclass(frozen=True, eq=False)
class Placed:
    """Places that may be coded."""

    step: float
    places: Levels
    estimate: float


class GridSearch:
    """Tries grids for one mesh."""

    def __init__(
        self,
        prepared: Prepared,
        shaper: Shaper,
        contract: Contract,
        reach: float,
        judge: Judge,
        told: Callable[[], AbstractContextManager[None]],
        *,
        angle: float,
        thorough: bool = False,
    ) -> None:
        self._prepared = prepared
        self._shaper = shaper
        self._character = shaper.character
        self._angle = angle
        self._thorough = thorough
        self._shades = contract.shades
        self._look, self._looks = contract.look, contract.look < math.inf
        self._judge = judge
        self._reach = reach
        self._told = told
        self._edge = shaper.mean_edge or 1.0
        self._extent = float(extent_of(prepared.positions).max())
        self._most = min(1.6 * reach, COARSEST)
        self._widest = ROUND * reach

    def drafts(self) -> Iterator[Draft]:
        """Drafts that may be smallest."""
        shaped = Shaped(self._prepared, self._shaper)
        tried = sorted(self._tried(shaped), key=lambda trial: trial.found.estimate)
        for trial in tried[:MOST_COMPARED]:
            if trial.found.estimate <= CLOSE * tried[0].found.estimate:
                yield shaped.draft(trial.found.step, trial.found.places)
        if self._prepared.graph.size < FEW_VERTICES and self._shades:
            yield from self._coarsest(shaped)

    @property
    def bytes(self) -> float:
        """Bytes of the places, rather too few."""
        first, size = self.first_step, self._prepared.graph.size
        entropy = min([self._character.entropy(first), *(entropy for entropy, _ in self._model_grids)])
        if self._character.is_model:
            return SHARE_OF_MODELS * entropy
        if self._character.is_sharp:
            return SHARE_IF_SHARP * entropy
        more = SHARE_OF_FEWER * math.log2(SHARE_VERTICES / size) + SHARE_OF_BITS * (8.0 * entropy / size - MEAN_BITS)
        return (SHARE + more) * entropy

    @property
    def fits_model(self) -> bool:
        """Whether there is a grid that a model seems to have been made on: it has far less entropy there."""
        if not self._character.is_model:
            return False
        bound = LATTICE_GAIN * self._character.entropy(self.first_step)
        return any(entropy <= bound for entropy, _ in self._model_grids)

    @cached_property
    def _model_grids(self) -> list[tuple[float, float]]:
        return sorted(self._made_on(self.first_step))

    @cached_property
    def first_step(self) -> float:
        """The step of a grid that should be about right."""
        if not self._shades:
            return self._widest
        helped = HELPED_MODELS if self._character.is_model else HELPED
        return self._character.step_of(self._angle / helped, self._most)

    def _tried(self, shaped: Shaped) -> list[Trial[Placed]]:
        """Drafts that keep the bounds."""
        if self.fits_model and not self._thorough:
            kept = [*self._on_grids(shaped, self._model_grids)]
            if kept:
                return kept
        first, trials = self.first_step, list[Trial[Placed]]()
        if not self._shades:
            trials.append(self._trial(shaped, first, 0.8, axes=3, sweeps=6))
        else:
            few = self._prepared.graph.size < QUICK_VERTICES
            steep = self._steepness(first)
            slopes = STEEP_LOOK if self._looks else (FLATTER * steep, steep)
            tries, slack = THOROUGH if self._thorough else (TRIES[few], SLACK[few])
            if self._looks:
                tries, slack = LOOK_TRIES, LOOK_SLACK
            for worth in dict.fromkeys([self._worth, WORTH] if self._thorough else [self._worth]):

                def measure(step: float, sure: bool, worth: float = worth) -> Trial[Placed]:
                    trials.append(self._trial(shaped, step, worth, sure=sure))
                    return trials[-1]

                widest_step(measure, first, tries=tries, most=self._most, slack=slack, slopes=slopes)
        kept = [trial for trial in trials if trial.kept]
        for finer in range(1, LAST_RESORTS + 1):
            if not kept:
                trial = self._trial(shaped, min(first, self._widest) / 4.0**finer, WORTH)
                kept = [trial] if trial.kept else []
        if self._prepared.graph.size >= FEW_VERTICES:
            best = min(kept, key=lambda trial: trial.found.estimate, default=None)
            grids = self._model_grids if best is None else sorted(self._made_on(best.step))
            kept += self._on_grids(shaped, grids)
        return kept

    def _on_grids(self, shaped: Shaped, grids: list[tuple[float, float]]) -> Iterator[Trial[Placed]]:
        for entropy, step in grids[:OTHERS]:
            if entropy > ALIKE * grids[0][0]:
                break
            trial = self._trial(shaped, step, WORTH_OF_MODELS)
            if trial.kept:
                yield trial

    def _made_on(self, right: float) -> Iterator[tuple[float, float]]:
        """Entropy and step of grids that have less of it than one that is about right: a model may be made on them."""
        character, last = self._character, self._extent * 2.0**-FINEST_BITS
        least = ON_MODEL * character.entropy(right)
        steps = [self._extent / ((1 << bits) - 1) for bits in range(1, FINEST_BITS)]
        if character.entropy(max(right / 4.0, last)) <= PLATEAU * least:
            steps += [right * 2.0 ** (-count / 6.0) for count in range(1, PLATEAU_STEPS)]
        for step in steps:
            if last <= step <= self._widest and abs(step - right) > 0.01 * right:
                entropy = character.entropy(step)
                if entropy <= least and character.rounded_angle(step) <= ROUNDED_MORE * self._angle:
                    yield entropy, step

    def _coarsest(self, shaped: Shaped) -> Iterator[Draft]:
        """The coarsest grids on which a model of few vertices is right already where it is rounded."""
        from_origin = Shaped(self._prepared, self._shaper, np.zeros(3))
        farthest = float(np.abs(self._prepared.mesh.positions).max())
        reach = min(self._reach, FITS_LOOK * self._look)
        grids = [shaped, from_origin] if farthest < MOST_EXTENTS * self._prepared.mesh.diagonal else [shaped]
        for grid in grids:
            left, tries = COARSEST_GRIDS, COARSEST_LOOKS if self._looks else MOST_PARTS
            for parts in range(1, MOST_PARTS):
                if left and tries and grid.fits(self._extent / parts, reach):
                    trial = self._trial(grid, self._extent / parts, 0.8, sure=False)
                    tries -= 1
                    if trial.within:
                        left -= 1
                        step, places = trial.found.step, trial.found.places
                        yield grid.draft(step, places) if grid is shaped else grid.draft_from_origin(step, places)

    def _trial(
        self, shaped: Shaped, step: float, worth: float, *, axes: int = 2, sweeps: int = 3, sure: bool = True
    ) -> Trial[Placed]:
        step = max(step, shaped.finest)
        with self._told():
            aim = Aim(
                worth * step / self._edge,
                min(self._reach, NEAR_PLACE * step) if self._thorough else self._reach,
                sweeps,
            )
            held, places, decoded, estimate = shaped.places(step, aim, axes)
            return self._judge.trial(step, self._prepared.units.into(decoded), Placed(held, places, estimate), sure)

    @property
    def _worth(self) -> float:
        if self._character.is_model:
            return WORTH_OF_MODELS
        if self._looks:
            return WORTH_OF_LOOK
        return WORTH * min(max(math.pow(self._angle / WORTH_ANGLE, WORTH_GROWTH), 0.5), 2.0)

    def _steepness(self, step: float) -> float:
        coarse, fine = self._character.rounded_angle(step), self._character.rounded_angle(0.7 * step)
        return min(max(math.log(max(coarse, 1e-6) / max(fine, 1e-6)) / -math.log(0.7), 0.4), 1.2)
