"""Looking for the blocks, and the layer of refinement on them, that are smallest within bounds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import partial

import numpy as np

from bsm.bitstream.container.header import Layer
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.signal.quantize import smallest_step
from bsm.codec.static.choice.borders import Borders
from bsm.codec.static.choice.grid_search import COARSEST
from bsm.codec.static.choice.judge import Judge, Sight
from bsm.codec.static.choice.search import LOOK_SLACK, LOOK_TRIES, SLACK, THOROUGH, Trial, widest_step
from bsm.codec.static.choice.settling import RATIO, Sensitivity
from bsm.codec.static.choice.shaping import Aim
from bsm.codec.static.choice.spectral import Base, Spectral, Stack, base_step
from bsm.codec.static.contract import Contract
from bsm.codec.static.draft import Draft
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.ways.block_coder import Progress

DETAILED_ANGLE, FINER = 4.5, 1.6
"""Below this angle blocks alone are larger than refined ones; rough meshes may be smaller with bases so much finer."""
FINER_IF_VISUAL = 4.0
"""Where a visual error is asked for, bases are as for angles so much smaller."""
PLAIN_ANGLE = 6.0
"""From this angle on, blocks with a detail layer are tried before refinement."""
WIDEST = 0.14
"""Columns of a dictionary over the rows of a block: wider ones cost every decoder more time than their bytes
are worth."""
MANY_OUTLIERS = 0.01
"""Of this many vertices out of reach, more are cheaper to bring back along all axes of a layer that all have."""
ROUGH, ROUGHEST = 1.57, 13.3
"""Up to these mean angles between adjacent faces, over what is asked for, and at most, blocks alone are tried."""
PLAIN_STEP, PLAIN_SLOPES = 0.0008, (0.35, 0.55)
"""Step of blocks with details that is about right, over the angle that is asked for; and how angles grow with it, in
their logarithms."""
PLAIN_STRIDE = 1.4
"""The widest such step that keeps a bound may not be the cheapest; one so many times as wide is tried, too."""
SHEET, SHEET_STEP = 1.0 / 16.0, 0.024
"""Where they are so small, the surface is a flat sheet, which coarser blocks without details are enough for."""
FINEST, FINEST_LAYER = 2.0**-38, 1e-6
"""Smallest step, in BSM units, of layers for borders and of others."""
ALL_AXES = 15.0
"""How much coarser levels in the plane are than those along the normal, where the surface is flat."""
HEIGHTS, HEIGHTS_OF_MODELS = 1.34, 2.6
"""Step of a layer along normals over what moves the end of a mean edge by the angle that is asked for."""
LAYER, LAYER_IF_ROUGH, LEAST_LAYER, MOST_LAYER = 2.22, 0.09, 0.94, 1.5
"""The same along all axes; less by degrees between faces beside each other."""
STEEP, STEEP_HEIGHTS = 1.05, 0.65
"""How angles grow with the step of a layer, in their logarithms: of one along all axes, and along normals alone."""
FLATTER = 0.6
"""And how much less they may."""
WORTH_OF_LOOK, STEEP_LOOK = 0.11, (1.0, 1.3)
"""Where a look is asked for: what a bit is worth, over the mean cost of an error of one step along the normal, which is
about what it saves where all is rounded; and how pictures get worse with the step, in their logarithms."""
LOOK_BASE, LOOK_BASE_IF_ROUGH, COARSEST_LOOK_BASE = 18.0, 0.0006, 0.016
"""The step of blocks below a layer, in steps of that; at least so much for each degree between faces beside each other,
for what is rough is not in low frequencies; and at most."""
FIRST_LOOK, NEAR_SEEN = 1.6, 16.0
"""Noise that sensitivity is measured with, over the step that angles would have; and how far a vertex may be brought
from its place where nobody sees it, in steps of the layer."""
NEAR = 8.0
"""How far shaping along all axes may bring a vertex from its place, in steps of the layer."""


class BlockSearch:
    """Tries blocks for one mesh, alone and refined."""

    def __init__(
        self,
        prepared: Prepared,
        options: EncodeOptions,
        contract: Contract,
        sight: Sight,
        reaches: Matrix,
        borders: Borders,
        judge: Judge,
        told: Callable[[], AbstractContextManager[None]],
        progress: Progress | None,
        *,
        angle: float,
        thorough: bool = False,
    ) -> None:
        self._thorough = thorough
        self._prepared = prepared
        self._options = options
        self._contract = contract
        self._sight = sight
        self._original = sight.original
        self._shaper = sight.shaper
        self._reaches = reaches
        self._reach = float(reaches.max())
        self._borders = borders
        self._judge = judge
        self._told = told
        self._progress = progress
        self._angle = angle
        self._edge = sight.shaper.mean_edge or 1.0
        self._blocks = Spectral(prepared, options, WIDEST)

    def is_flat(self, step: float, share: float) -> bool:
        """Whether as large a share of all frequencies is worth coding at a step."""
        return self._blocks.is_flat(step, share)

    def drafts(self) -> Iterator[Draft]:
        """Drafts that may be smallest."""
        angle = self._angle
        coarse = Spectral(self._prepared, replace(self._options, detail=0.0), WIDEST)
        if self._thorough:
            if angle >= DETAILED_ANGLE:
                plain = self._plain(self._blocks)
                if plain is not None:
                    yield plain
            for finer in (1.0, FINER):
                stack = self._refined(coarse.base(self._base_step / finer, self._progress))
                if stack is not None:
                    yield stack.draft()
            return
        if angle >= PLAIN_ANGLE and self._is_smooth:
            plain = self._plain(coarse if self._shaper.character.roughness < SHEET * angle else self._blocks)
            if plain is not None:
                yield plain
                return
        stack = self._refined(coarse.base(self._base_step, self._progress))
        if stack is not None:
            yield stack.draft()

    @property
    def _base_step(self) -> float:
        """The step of blocks that are refined."""
        if self._contract.visual < math.inf:
            return base_step(self._angle / FINER_IF_VISUAL)
        if self._sensitivity is None:
            return base_step(self._angle)
        step = LOOK_BASE * self._sensitivity.step_for(self._contract.look, 3)
        rough = LOOK_BASE_IF_ROUGH * self._shaper.character.roughness
        return min(max(step, rough), COARSEST_LOOK_BASE)

    def _plain(self, blocks: Spectral) -> Draft | None:
        """The smallest of a few steps without refinement, except for vertices out of reach: these cost more at coarser
        ones."""
        sheet = blocks is not self._blocks
        found: list[Draft] = []

        def measure(step: float, sure: bool) -> Trial[Stack]:
            plain = self._with_outliers(blocks.base(max(step, smallest_step(self._prepared.size)), self._progress), [])
            trial = self._judge.trial(step, plain.positions, plain, sure)
            if trial.excess <= 0.0:
                found.append(plain.draft())
            return trial

        first = SHEET_STEP if sheet else PLAIN_STEP * self._angle
        tries, slack = THOROUGH if self._thorough else (3, SLACK)
        widest = widest_step(measure, first, tries=tries, most=COARSEST, slopes=PLAIN_SLOPES, slack=slack)
        if widest is not None:
            measure(math.sqrt(first * widest.step) if widest.step > first else PLAIN_STRIDE * first, True)
        return min(found, key=lambda draft: draft.size, default=None)

    @property
    def _is_smooth(self) -> bool:
        character = self._shaper.character
        return not character.is_model and character.roughness < min(ROUGH * self._angle, ROUGHEST)

    def _with_outliers(self, base: Base, layers: list[tuple[Layer, Levels]]) -> Stack:
        """With one more layer, if vertices are out of reach: of levels for these alone; and one for borders."""
        positions = base.positions
        for layer, levels in layers:
            positions = base.moved(layer, levels, positions)
        back = self._back(base, positions)
        layers = layers if back is None else [*layers, back]
        lock = self._lock(base)
        if lock is not None:
            return base.refined(*layers, lock, borders=True)
        return base.refined(*layers)

    def _back(self, base: Base, positions: Matrix) -> tuple[Layer, Levels] | None:
        """The layer that brings vertices back that are out of reach, borders aside."""
        out = self._judge.out(positions)
        if not out.any():
            return None
        layer = base.layer(float(self._reaches[out].min()), 1.0)
        levels = np.rint(base.offsets_of(positions) / layer.step)
        return layer, np.where(out[:, None], levels, 0.0).astype(np.int32)

    def _brought_back(self, base: Base, positions: Matrix) -> Matrix:
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
        return int(self._judge.out(positions).sum())

    def _refined(self, base: Base) -> Stack | None:
        """A base with heights along the normals, if these can bring normals right; with all axes if not."""
        many = MANY_OUTLIERS * len(base.positions)
        heights = (
            self._contract.visual == math.inf
            and self._original.angle(base.upright) <= self._angle
            and self._outliers(base.upright) <= many
        )
        if heights:
            layer = base.layer(self._first_layer(0.0), 0.0)
            heights = self._outliers(base.moved(layer, base.wanted(base.expected_steps(layer))[0])) <= many
        best = self._refinement(base, 0.0 if heights else self._ratio)
        if heights and (best is None or self._outliers(base.moved(*best.found)) > many):
            best = self._refinement(base, self._ratio)
        return None if best is None else self._with_outliers(base, [best.found])

    def _refinement(self, base: Base, ratio: float) -> Trial[tuple[Layer, Levels]] | None:
        """One layer whose normals are right, where borders, and vertices out of reach, are back at their places."""
        lock, still = self._lock(base), self._borders.vertices
        start = base.positions if lock is None else base.moved(*lock)

        choose = self._bent_levels(base, start) if self._sensitivity is None else self._seen_levels(base, start)

        def measure(step: float, sure: bool) -> Trial[tuple[Layer, Levels]]:
            layer = base.layer(max(step, FINEST_LAYER), ratio)
            with self._told():
                levels = choose(layer)
                levels[still] = 0
                moved = self._brought_back(base, base.moved(layer, levels, start))
                return self._judge.trial(step, moved, (layer, levels), sure)

        if self._sensitivity is not None:
            first = self._sensitivity.first_step(self._contract.look, 3 if ratio else 1)
            return widest_step(measure, first, tries=LOOK_TRIES, most=COARSEST, slopes=STEEP_LOOK, slack=LOOK_SLACK)
        tries, slack = THOROUGH if self._thorough else (2 if self._shaper.character.is_model else 3, SLACK)
        steep = STEEP if ratio else STEEP_HEIGHTS
        slopes = FLATTER * steep, steep
        return widest_step(measure, self._first_layer(ratio), tries=tries, most=COARSEST, slopes=slopes, slack=slack)

    def _bent_levels(self, base: Base, start: Matrix) -> Callable[[Layer], Levels]:
        """Levels of a layer, on positions, that bend faces least."""
        still = self._borders.vertices

        def choose(layer: Layer) -> Levels:
            aim = Aim(layer.step / self._edge, min(self._reach, NEAR * layer.step if layer.ratio else math.inf), 6)
            wanted, directions = base.wanted(base.expected_steps(layer))
            wanted[still] = 0
            levels = self._shaper.levels(start, wanted, directions, aim)
            if layer.axes == 1:
                return levels
            wanted, directions = base.wanted(base.known_steps(layer, levels))
            wanted[still], wanted[:, 0] = 0, levels[:, 0]
            return self._shaper.levels(start, wanted, directions, aim)

        return choose

    def _seen_levels(self, base: Base, start: Matrix) -> Callable[[Layer], Levels]:
        """Levels of a layer, on positions, of which least is seen."""
        sensitivity, offsets = self._sensitivity, base.offsets_of(start)
        assert sensitivity is not None

        def choose(layer: Layer) -> Levels:
            reach = np.minimum(self._reaches, NEAR_SEEN * layer.step)
            steps, known = base.expected_steps(layer), partial(base.known_steps, layer)
            return sensitivity.levels(offsets, base.frames, steps, known, WORTH_OF_LOOK, reach)

        return choose

    @cached_property
    def _sensitivity(self) -> Sensitivity | None:
        """None: nothing is asked of pictures, or to be seen in them."""
        looker = None if self._contract.look == math.inf else self._sight.looker
        if looker is None:
            return None
        step = FIRST_LOOK * self._first_layer(RATIO)
        positions, faces = self._prepared.positions, self._prepared.mesh.faces
        return Sensitivity(positions, faces, self._prepared.graph, looker, step)

    @property
    def _ratio(self) -> float:
        if self._contract.visual < math.inf:
            return ALL_AXES / 2.0
        return ALL_AXES if self._sensitivity is None else RATIO

    def _first_layer(self, ratio: float) -> float:
        """The step of a layer that should be about right."""
        character = self._shaper.character
        if ratio:
            factor = min(max(LAYER - LAYER_IF_ROUGH * character.roughness, LEAST_LAYER), MOST_LAYER)
        else:
            factor = HEIGHTS_OF_MODELS if character.is_model else HEIGHTS
        return factor * math.radians(self._angle) * self._edge
