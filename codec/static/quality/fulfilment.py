"""The cheapest way to keep a contract: blocks, blocks and refinement, or a grid; each checked on what is decoded.

Rules say which ways can win, and whole files decide among these. What the rules are made of was measured on scans,
models and assets; they decide about bytes and time, never about whether a contract is kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Generic, TypeVar

import numpy as np

from bitstream.container.header import Layer
from bitstream.errors import LimitError, TargetError
from bitstream.fields.grid import MOST_LARGEST
from codec.arrays import Levels, Matrix
from codec.geometry.closeness import Closeness, Original
from codec.static.layers.block_coder import Progress
from codec.static.options import EncodeOptions
from codec.static.preamble import FEW_VERTICES, Prepared
from codec.static.quality.borders import ROUND, borders_of
from codec.static.quality.contract import ANY_ANGLE, Contract
from codec.static.quality.draft import Draft
from codec.static.quality.lattices import Shaped, rounded
from codec.static.quality.shaping import Aim, Shaper
from codec.static.quality.spectral import Base, Spectral, base_step

PLAIN_ANGLE = 6.0
"""From this angle on, blocks with a detail layer are tried before refinement."""
WIDEST = 0.155
"""Columns of a dictionary over the rows of a block: wider ones cost every decoder more time than their bytes
are worth."""
FLAT = 0.15
"""Share of frequencies worth coding at a coarse step from which on a grid is smaller than blocks."""
LATTICES = 3
"""Successive powers of two that may be tried for the grid: models made on one cost half as much there."""
MOST_PARTS, COARSEST_GRIDS = 256, 3
"""Of models of few vertices: cells along the longest side, and how many of the coarsest grids that fit are tried."""
SHARP_SHARE, GRID_SHARE = 0.45, 0.75
"""Of the entropy of second differences on a rounded grid: what a shaped one costs at least,
with and without sharp edges."""
LATTICE_GAIN = 0.75
"""A finer grid whose entropy is below so much of the coarser one's is one that the model was made on."""
MANY_OUTLIERS = 0.01
"""Of this many vertices out of reach, more are cheaper to bring back along all axes of a layer that all have."""
DOUBT = 1.4
"""Blocks alone are not tried where a sample of them has normals so many times too wrong."""
COARSE = 0.016
"""A step, in BSM units, at which blocks carry nothing but what they are for."""
STEEP, FLATTEST = 0.8, 0.1
"""How an angle grows with the step in their logarithms, as long as nobody knows, and at least."""
SLACK = 0.03
"""How far below a bound on angles the search for a step may stay."""
FINEST, COARSEST = 2.0**-38, 0.05
"""Smallest and largest step, in BSM units."""
MARGIN = 1e-9
"""Of a bound on distances, for what rounding may add."""

Found = TypeVar("Found")


@dataclass(frozen=True)
class Trial(Generic[Found]):
    """What a step came to."""

    step: float
    closeness: Closeness
    found: Found


def widest_step(
    measure: Callable[[float], Trial[Found]], first: float, angle: float, reach: float, *, tries: int, most: float
) -> Trial[Found] | None:
    """About the largest step whose trial keeps the bounds: a secant in the logarithms, within brackets.

    Parameters
    ----------
    measure : callable
        Tries a step.
    first : float
        To begin with.
    angle : float
        Degrees; the search ends where the trial's is at most `SLACK` below.
    reach : float
        How far a vertex may be from its place.
    tries : int
    most : float
        The largest step that may be tried.
    """
    aim = math.log(angle * (1.0 - SLACK / 2.0))
    best: Trial[Found] | None = None
    good: tuple[float, float] | None = None
    bad: tuple[float, float] | None = None
    step, slope = min(first, most), STEEP
    before: tuple[float, float] | None = None
    for _ in range(tries):
        trial = measure(step)
        kept = trial.closeness.angle <= angle
        near = trial.closeness.farthest <= reach
        at = math.log(step), math.log(max(trial.closeness.angle, 1e-6))
        if before is not None and at[0] != before[0]:
            slope = min(max((at[1] - before[1]) / (at[0] - before[0]), FLATTEST), STEEP)
        before = at
        if kept and near:
            if best is None or step > best.step:
                best, good = trial, at
            if trial.closeness.angle > angle * (1.0 - SLACK) or step >= most:
                break
        elif bad is None or at[0] < bad[0]:
            bad = at[0], max(at[1], math.log(1.05 * angle))
        if good is not None and bad is not None:
            if bad[0] - good[0] < SLACK:
                break
            share = (aim - good[1]) / max(bad[1] - good[1], 1e-9)
            step = math.exp(good[0] + min(max(share, 0.15), 0.85) * (bad[0] - good[0]))
        elif kept and not near:
            step *= 0.8
        else:
            step *= math.exp(min(max((aim - at[1]) / slope, -1.2), 1.2))
        step = min(step, most)
    return best


class Fulfilment:
    """Looks for the smallest stream of a mesh that keeps a contract.

    Parameters
    ----------
    prepared : Prepared
    options : EncodeOptions
    contract : Contract
    progress : callable, optional
        Called with the number of blocks done and of all blocks, and with none and all of them around every other trial.
    """

    def __init__(
        self, prepared: Prepared, options: EncodeOptions, contract: Contract, progress: Progress | None = None
    ) -> None:
        self._prepared = prepared
        self._options = options
        self._contract = contract
        self._progress = progress
        self._original = Original(prepared.positions, prepared.mesh.faces)
        self._shaper = Shaper(self._original)
        self._reach = contract.reach(prepared.mesh.diagonal, prepared.units.scale) * (1.0 - MARGIN)
        self._borders = borders_of(prepared, options.lock_borders, self._reach)
        self._edge = self._shaper.mean_edge or 1.0
        self._best_seen: Closeness | None = None

    def draft(self) -> Draft:
        """The smallest draft that was found.

        Raises
        ------
        TargetError
            If none keeps the contract; says what the best that was found comes to.
        """
        if not self._prepared.mesh.diagonal > 0.0:
            return rounded(self._prepared, 1)  # a point
        found: list[Draft] = []
        try:
            if self._has_low_frequencies():
                found.extend(draft for draft in self._spectral() if self._keeps(draft))
        except LimitError:
            pass  # blocks that decoders would refuse: a grid asks for little
        smallest = min((draft.size for draft in found), default=None)
        if smallest is None or self._grid_may_win(smallest):
            found.extend(draft for draft in self._grids() if self._keeps(draft))
        if not found:
            raise TargetError(self._refusal())
        return min(found, key=lambda draft: draft.size)

    # What a draft must be.

    def _keeps(self, draft: Draft) -> bool:
        """Whether what its decoder makes of a draft keeps the contract."""
        decoded = self._prepared.units.into(draft.decoded)
        closeness = self._original.closeness(decoded)
        best = self._best_seen
        if best is None or closeness.farthest < best.farthest:
            self._best_seen = closeness
        return self._within(closeness) and self._borders.kept(self._prepared.positions, decoded)

    def _within(self, closeness: Closeness) -> bool:
        return closeness.farthest <= self._reach and closeness.angle <= self._contract.angle

    def _refusal(self) -> str:
        if self._best_seen is not None and self._within(self._best_seen):
            return f"{self._options.lock_borders} cannot be had on this mesh: they are too fine"
        had = "nothing" if self._best_seen is None else self._contract.worded(self._best_seen, self._reach)
        return f"{self._contract} cannot be kept on this mesh; the best that can be had is {had}"

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Tell of a trial as of all blocks once more."""
        blocks = self._prepared.parts.count(self._prepared.graph.size)
        if self._progress:
            self._progress(0, blocks)
        yield
        if self._progress:
            self._progress(blocks, blocks)

    # Blocks.

    def _has_low_frequencies(self) -> bool:
        """Whether there are some, and most of what is worth coding is there; or only blocks can be fine at borders."""
        if self._borders.vertices.any():
            return self._prepared.graph.size >= FEW_VERTICES
        return self._prepared.has_low_frequencies and not self._blocks.is_flat(COARSE, FLAT)

    @cached_property
    def _blocks(self) -> Spectral:
        return Spectral(self._prepared, self._options, WIDEST)

    def _spectral(self) -> Iterator[Draft]:
        angle = self._contract.angle
        if self._contract.angle >= ANY_ANGLE and self._reach < 0.001:
            return  # a grid is smaller
        if angle >= PLAIN_ANGLE and self._blocks.sample(self._options.first_step, self._original) < DOUBT * angle:
            base = self._blocks.base(self._options.first_step, self._progress)
            draft = self._with_outliers(base, [])
            if self._original.angle(self._prepared.units.into(draft.decoded)) <= angle:
                yield draft
                return
        plain = replace(self._options, detail=0.0)
        base = Spectral(self._prepared, plain, WIDEST).base(base_step(angle), self._progress)
        yield from self._refined(base)

    def _with_outliers(self, base: Base, layers: list[tuple[Layer, Levels]]) -> Draft:
        """With one more layer, if vertices are out of reach: of levels for these alone; and one for borders."""
        positions = base.positions
        for layer, levels in layers:
            positions = base.moved(layer, levels, positions)
        back = self._back(base, positions)
        layers = layers if back is None else [*layers, back]
        lock = self._lock(base)
        if lock is not None:
            return base.refined(*layers, lock, borders=True)
        return base.refined(*layers) if layers else base.draft

    def _back(self, base: Base, positions: Matrix) -> tuple[Layer, Levels] | None:
        """The layer that brings vertices back that are out of reach, borders aside."""
        offsets = base.offsets_of(positions)
        out = (np.square(offsets).sum(axis=1) > self._reach**2) & ~self._borders.vertices
        if not out.any():
            return None
        layer = base.layer(self._reach, 1.0)
        return layer, np.where(out[:, None], np.rint(offsets / layer.step), 0.0).astype(np.int32)

    def _brought_back(self, base: Base, positions: Matrix) -> Matrix:
        """Positions after that layer."""
        back = self._back(base, positions)
        return positions if back is None else base.moved(*back, positions)

    def _lock(self, base: Base) -> tuple[Layer, Levels] | None:
        """The layer that brings borders back; no other layer moves them."""
        if not self._borders.out(base.offsets).any():
            return None
        layer = base.layer(max(self._borders.cell, FINEST), 1.0)
        levels = self._borders.levels(base.offsets, layer.step)
        return None if levels is None else (layer, levels)

    def _outliers(self, positions: Matrix) -> int:
        """How many vertices are out of reach, borders aside."""
        out = np.square(positions - self._prepared.positions).sum(axis=1) > self._reach**2
        return int((out & ~self._borders.vertices).sum())

    def _refined(self, base: Base) -> Iterator[Draft]:
        """A base with heights along the normals, if these can bring normals right; with all axes if not."""
        many = MANY_OUTLIERS * len(base.positions)
        heights = self._original.angle(base.upright) <= self._contract.angle and self._outliers(base.upright) <= many
        best = self._refinement(base, 0.0 if heights else 6.0, lambda moved: moved)
        if heights and (best is None or self._outliers(base.moved(*best.found)) > many):
            heights = False
            best = self._refinement(base, 6.0, lambda moved: moved)
        draft = None if best is None else self._with_outliers(base, [best.found])
        if draft is not None and not self._keeps(draft):
            # What is brought back bends normals a little; nearly always, there is room for that.
            best = self._refinement(base, 0.0 if heights else 6.0, lambda moved: self._brought_back(base, moved))
            draft = None if best is None else self._with_outliers(base, [best.found])
        if draft is not None:
            yield draft

    def _refinement(
        self, base: Base, ratio: float, then: Callable[[Matrix], Matrix]
    ) -> Trial[tuple[Layer, Levels]] | None:
        """One layer whose normals are right, where borders are back at their places, and after what comes then."""
        lock, still = self._lock(base), self._borders.vertices
        start = base.positions if lock is None else base.moved(*lock)

        def measure(step: float) -> Trial[tuple[Layer, Levels]]:
            layer = base.layer(step, ratio)
            wanted, directions = base.wanted(layer)
            wanted[still] = 0
            aim = Aim(layer.step / self._edge, self._reach, 6)
            with self._told():
                levels = self._shaper.levels(start, wanted, directions, aim)
                levels[still] = 0
                closeness = self._original.closeness(then(base.moved(layer, levels, start)))
            return Trial(step, closeness, (layer, levels))

        first = 1.2 * math.radians(self._contract.angle) * self._edge
        return widest_step(measure, first, self._contract.angle, math.inf, tries=3, most=COARSEST)

    # Grids.

    def _grid_may_win(self, size: int) -> bool:
        """Whether a grid could be smaller than `size`."""
        entropy = min(self._entropy(step) for step in (self._first_cell, *self._cells(self._first_cell)))
        share = SHARP_SHARE if self._shaper.is_sharp else GRID_SHARE
        return len(self._prepared.connectivity.data) + share * entropy < size

    def _entropy(self, step: float) -> float:
        """Bytes of second differences on a grid."""
        return self._shaper.entropy(step) / 8.0

    @property
    def _first_cell(self) -> float:
        """The step of a grid that should be about right."""
        angle = self._contract.angle
        first = 4.9 * angle**-0.35 * math.radians(angle) * self._edge
        return float(min(first, 1.6 * self._reach, self._borders.cell, COARSEST))

    def _grids(self) -> Iterator[Draft]:
        shaped = Shaped(self._prepared, self._shaper, still=self._borders.vertices)
        angle = self._contract.angle
        if angle >= ANY_ANGLE:
            step = max(min(ROUND * self._reach, self._borders.cell), shaped.finest)
            held, places, _ = shaped.places(step, Aim(0.8 * step / self._edge, self._reach, 6), axes=3)
            yield shaped.draft(held, places)
            return
        most = min(1.6 * self._reach, self._borders.cell, COARSEST)
        best = widest_step(
            lambda step: self._on_grid(shaped, step, 0.4), self._first_cell, angle, self._reach, tries=5, most=most
        )
        if best is not None:
            yield shaped.draft(*best.found)
        if self._prepared.graph.size < FEW_VERTICES:
            yield from self._coarsest(shaped)
        else:
            yield from self._lattices(shaped, self._first_cell if best is None else best.step)

    def _lattices(self, shaped: Shaped, step: float) -> Iterator[Draft]:
        """Grids of powers of two along the longest side, from about a step on, where one seems to fit the model."""
        least = self._entropy(step)
        for cell in self._cells(step):
            if self._entropy(cell) <= LATTICE_GAIN * least:
                trial = self._on_grid(shaped, cell, 0.8)
                if self._within(trial.closeness):
                    yield shaped.draft(*trial.found)

    def _coarsest(self, shaped: Shaped) -> Iterator[Draft]:
        """The coarsest grids on which a model of few vertices is right already where it is rounded.

        Those that begin at the origin of the mesh's unit need not say where.
        """
        extent = float(np.ptp(self._prepared.positions, axis=0).max())
        grids = [shaped]
        if (self._prepared.mesh.positions >= 0.0).all():
            grids.append(Shaped(self._prepared, self._shaper, np.zeros(3), still=self._borders.vertices))
        for grid in grids:
            left = COARSEST_GRIDS
            for parts in range(1, MOST_PARTS):
                if left and grid.fits(extent / parts, min(self._reach, self._borders.cell / ROUND)):
                    trial = self._on_grid(grid, extent / parts, 0.8)
                    if self._within(trial.closeness):
                        left -= 1
                        step, places = trial.found
                        from_origin = grid is not shaped and int(places.max()) < MOST_LARGEST
                        yield grid.draft_from_origin(step, places) if from_origin else grid.draft(step, places)

    def _cells(self, step: float) -> list[float]:
        """Steps of grids of powers of two from about a step on."""
        extent = float(np.ptp(self._prepared.positions, axis=0).max())
        bits = max(1, math.floor(math.log2(extent / step + 1.0)))
        last = min(math.floor(math.log2(extent / self._first_cell + 1.0)) + LATTICES, 19)
        return [extent / ((1 << number) - 1) for number in range(bits, last + 1)]

    def _on_grid(self, shaped: Shaped, step: float, worth: float) -> Trial[tuple[float, Levels]]:
        step = max(step, shaped.finest)
        with self._told():
            held, places, decoded = shaped.places(step, Aim(worth * step / self._edge, self._reach, 3))
            closeness = self._original.closeness(self._prepared.units.into(decoded))
        return Trial(step, closeness, (held, places))
