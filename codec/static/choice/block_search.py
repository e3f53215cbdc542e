"""Looking for the blocks, and the layer of refinement on them, that are smallest within bounds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from functools import partial

import numpy as np

from bsm.bitstream.container.header import Layer
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.signal.transform import smallest_step
from bsm.codec.static.choice.grid_search import COARSEST
from bsm.codec.static.choice.judge import Judge, Sight
from bsm.codec.static.choice.search import LOOK_SLACK, LOOK_TRIES, SLACK, THOROUGH, Trial, widest_step
from bsm.codec.static.choice.settling import RATIO, Sensitivity
from bsm.codec.static.choice.shaping import Aim
from bsm.codec.static.choice.spectral import Base, Spectral, base_step
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
"""From this angle on, blocks alone are tried, too."""
WIDEST = 0.14
"""Columns of a dictionary over the rows of a block: wider ones cost every decoder more time than their bytes
are worth."""
ROUGH, ROUGHEST = 1.57, 13.3
"""Up to these mean angles between adjacent faces, over what is asked for, and at most, blocks alone are tried."""
PLAIN_STEP, PLAIN_SLOPES = 0.0016, (0.35, 0.55)
"""Step of blocks alone that is about right, over the angle that is asked for; and how angles grow with it, in their
logarithms."""
PLAIN_STRIDE = 1.4
"""The widest such step that keeps a bound may not be the cheapest; one so many times as wide is tried, too."""
FINEST_LAYER = 1e-6
"""Smallest step of a layer, in BSM units."""
ALL_AXES = 15.0
"""How much coarser levels in the plane are than those along the normal, where the surface is flat."""
LAYER, LAYER_IF_ROUGH, LEAST_LAYER, MOST_LAYER = 2.22, 0.09, 0.94, 1.5
"""Step of a layer over what moves the end of a mean edge by the angle that is asked for; less by degrees between faces
beside each other."""
STEEP = 1.05
"""How angles grow with the step of a layer, in their logarithms."""
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
        self._shaper = sight.shaper
        self._reaches = reaches
        self._reach = float(reaches.max())
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
        plain = self._angle >= DETAILED_ANGLE if self._thorough else self._angle >= PLAIN_ANGLE and self._is_smooth
        if plain:
            alone = self._plain()
            if alone is not None:
                yield alone
        for finer in (1.0, FINER) if self._thorough else (1.0,):
            base = self._blocks.base(self._base_step / finer, self._progress)
            found = self._refinement(base)
            if found is not None:
                yield base.refined(*found.found)

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

    def _plain(self) -> Draft | None:
        """The smallest of a few steps without refinement."""
        found: list[Draft] = []

        def measure(step: float, sure: bool) -> Trial[Draft]:
            base = self._blocks.base(max(step, smallest_step(self._prepared.size)), self._progress)
            trial = self._judge.trial(step, base.positions, base.draft, sure)
            if trial.excess <= 0.0 and trial.near:
                found.append(base.draft)
            return trial

        first = PLAIN_STEP * self._angle
        tries, slack = THOROUGH if self._thorough else (3, SLACK)
        widest = widest_step(measure, first, tries=tries, most=COARSEST, slopes=PLAIN_SLOPES, slack=slack)
        if widest is not None:
            measure(math.sqrt(first * widest.step) if widest.step > first else PLAIN_STRIDE * first, True)
        return min(found, key=lambda draft: draft.size, default=None)

    @property
    def _is_smooth(self) -> bool:
        character = self._shaper.character
        return not character.is_model and character.roughness < min(ROUGH * self._angle, ROUGHEST)

    def _refinement(self, base: Base) -> Trial[tuple[Layer, Levels]] | None:
        """The layer that keeps what is asked for, and brings vertices that are out of reach back to their places."""
        ratio = self._ratio
        choose = self._bent_levels(base) if self._sensitivity is None else self._seen_levels(base)

        def measure(step: float, sure: bool) -> Trial[tuple[Layer, Levels]]:
            layer = base.layer(max(step, FINEST_LAYER), ratio)
            with self._told():
                levels = choose(layer)
                out = self._judge.out(base.moved(layer, levels))
                if out.any():
                    levels[out] = base.wanted(base.known_steps(layer, levels))[0][out]
                return self._judge.trial(step, base.moved(layer, levels), (layer, levels), sure)

        if self._sensitivity is not None:
            first = self._sensitivity.first_step(self._contract.look, 3)
            return widest_step(measure, first, tries=LOOK_TRIES, most=COARSEST, slopes=STEEP_LOOK, slack=LOOK_SLACK)
        tries, slack = THOROUGH if self._thorough else (2 if self._shaper.character.is_model else 3, SLACK)
        slopes = FLATTER * STEEP, STEEP
        return widest_step(measure, self._first_layer, tries=tries, most=COARSEST, slopes=slopes, slack=slack)

    def _bent_levels(self, base: Base) -> Callable[[Layer], Levels]:
        """Levels of a layer that bend faces least."""

        def choose(layer: Layer) -> Levels:
            aim = Aim(layer.step / self._edge, min(self._reach, NEAR * layer.step), 6)
            levels = self._shaper.levels(base.positions, *base.wanted(base.expected_steps(layer)), aim)
            wanted, directions = base.wanted(base.known_steps(layer, levels))
            wanted[:, 0] = levels[:, 0]
            return self._shaper.levels(base.positions, wanted, directions, aim)

        return choose

    def _seen_levels(self, base: Base) -> Callable[[Layer], Levels]:
        """Levels of a layer of which least is seen."""
        sensitivity = self._sensitivity
        assert sensitivity is not None

        def choose(layer: Layer) -> Levels:
            reach = np.minimum(self._reaches, NEAR_SEEN * layer.step)
            steps, known = base.expected_steps(layer), partial(base.known_steps, layer)
            return sensitivity.levels(base.offsets, base.frames, steps, known, WORTH_OF_LOOK, reach)

        return choose

    @cached_property
    def _sensitivity(self) -> Sensitivity | None:
        """None: nothing is asked of pictures, or to be seen in them."""
        looker = None if self._contract.look == math.inf else self._sight.looker
        if looker is None:
            return None
        step = FIRST_LOOK * self._first_layer
        positions, faces = self._prepared.positions, self._prepared.mesh.faces
        return Sensitivity(positions, faces, self._prepared.graph, looker, step)

    @property
    def _ratio(self) -> float:
        if self._contract.visual < math.inf:
            return ALL_AXES / 2.0
        return ALL_AXES if self._sensitivity is None else RATIO

    @property
    def _first_layer(self) -> float:
        """The step of a layer that should be about right."""
        roughness = self._shaper.character.roughness
        factor = min(max(LAYER - LAYER_IF_ROUGH * roughness, LEAST_LAYER), MOST_LAYER)
        return factor * math.radians(self._angle) * self._edge
