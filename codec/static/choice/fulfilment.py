"""The cheapest way to keep a contract: blocks, blocks and refinement, or a grid; each checked on what is decoded.

Rules say which ways can win, and whole files decide among these. What the rules are made of was measured on scans,
models and assets; they decide about bytes and time, never about whether a contract is kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from operator import attrgetter

import numpy as np

from bsm.bitstream.container.header import Layer
from bsm.bitstream.errors import LimitError, TargetError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.signal.quantize import smallest_step
from bsm.codec.static.choice.borders import borders_of
from bsm.codec.static.choice.grid_search import COARSEST, GridSearch
from bsm.codec.static.choice.judge import Judge, Sight
from bsm.codec.static.choice.lattices import rounded
from bsm.codec.static.choice.reaches import reaches
from bsm.codec.static.choice.search import LOOK_SLACK, LOOK_TRIES, SLACK, THOROUGH, Trial, widest_step
from bsm.codec.static.choice.settling import RATIO, Sensitivity
from bsm.codec.static.choice.shaping import Aim
from bsm.codec.static.choice.spectral import Base, Spectral, Stack, base_step
from bsm.codec.static.contract import Contract
from bsm.codec.static.draft import Draft
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import FEW_VERTICES, Prepared
from bsm.codec.static.ways.block_coder import Progress

FINE_REACH = 0.001
"""Where normals do not matter, grids are smaller than blocks from this distance on, in BSM units."""
MODEL_ANGLE = 4.0
"""Up to this angle, models with flat faces are smaller on grids."""
DETAILED_ANGLE, FINER = 4.5, 1.6
"""Below this angle blocks alone are larger than refined ones; rough meshes may be smaller with bases so much finer."""
VISUAL_TRIES, FINER_IF_VISUAL = 4, 4.0
"""Grids that are rounded to for the angle that comes with a visual error; the base is as for one so much smaller."""
PLAIN_ANGLE = 6.0
"""From this angle on, blocks with a detail layer are tried before refinement."""
WIDEST = 0.14
"""Columns of a dictionary over the rows of a block: wider ones cost every decoder more time than their bytes
are worth."""
FLAT = 0.15
"""Share of frequencies worth coding at a coarse step from which on a grid is smaller than blocks."""
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
COARSE = 0.016
"""A step, in BSM units, at which blocks carry nothing but what they are for."""
FINEST, FINEST_LAYER = 2.0**-38, 1e-6
"""Smallest step, in BSM units, of layers for borders and of others."""
FINEST_BITS = 20
"""Of the grid that is tried where nothing else will do."""
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
FEW_LOOKS = 4000
"""Meshes of more vertices are looked at in one way to code alone, the one that is likely to be smaller."""
DEARER = 1.1
"""Of fewer, grids are looked at, too, unless what they should take is so much more than what blocks took."""
DENSE, TINY, PREVIEW = 0.0062, 0.0012, 2.0
"""Below this look, models with flat faces are smaller on grids, unless the mean edge is shorter than the first; and so
are all meshes where it is shorter than the second: pictures do not show their faces."""
MARGIN = 1e-9
"""Of a bound on distances, for what rounding may add."""


class Fulfilment:
    """Looks for the smallest stream of a mesh that keeps a contract.

    Parameters
    ----------
    prepared : Prepared
    options : EncodeOptions
    contract : Contract
    sight : Sight
        Of the same mesh.
    progress : callable, optional
        Called with the number of blocks done and of all blocks, and with none and all of them around every other trial.
    thorough : bool
        Rules leave out no way that may win, and bounds are used up as far as can be: some times the work.
    """

    def __init__(
        self,
        prepared: Prepared,
        options: EncodeOptions,
        contract: Contract,
        sight: Sight,
        progress: Progress | None = None,
        *,
        thorough: bool = False,
    ) -> None:
        self._thorough = thorough
        self._prepared = prepared
        self._options = options
        self._contract = contract
        self._progress = progress
        self._sight = sight
        self._original = sight.original
        self._shaper = sight.shaper
        self._reaches = reaches(prepared, contract) * (1.0 - MARGIN)
        self._reach = float(self._reaches.max())
        self._borders = borders_of(prepared, options.lock_borders, float(self._reaches.min()))
        self._edge = self._shaper.mean_edge or 1.0
        self._judge = Judge(prepared, sight, contract, self._reaches, self._borders)
        self._angle = self._about_angle()
        self._grids = GridSearch(
            prepared,
            self._shaper,
            contract,
            float(self._reaches.min()),
            self._borders,
            self._judge,
            self._told,
            angle=self._angle,
            thorough=thorough,
        )

    def draft(self, size: Callable[[Draft], int] = attrgetter("size")) -> Draft:
        """The smallest draft that was found.

        Parameters
        ----------
        size : callable
            What a draft comes to with all that it has to carry: attributes may cost less on one way than on another.

        Raises
        ------
        TargetError
            If none keeps the contract; says what the best that was found comes to.
        """
        if not self._prepared.mesh.diagonal > 0.0:
            return rounded(self._prepared, 1)  # a point
        for every in (False, True):
            found = self._drafts(every=every)
            for draft in sorted(found, key=size) if len(found) > 1 else found:
                if self.keeps(draft):
                    return draft
        finest = rounded(self._prepared, FINEST_BITS)
        if self.keeps(finest):
            return finest
        raise TargetError(self._refusal())

    def keeps(self, draft: Draft) -> bool:
        """Whether what its decoder makes of a draft keeps the contract."""
        return self._judge.keeps(self._prepared.units.into(draft.decoded))

    @property
    def had(self) -> str:
        """The bounds that the best draft broke that was seen."""
        return self._judge.had

    def _about_angle(self) -> float:
        """Mean angle of normals that comes with all that is asked for, about, degrees."""
        contract, step = self._contract, COARSE
        if contract.visual == math.inf:
            return contract.about_angle
        for _ in range(VISUAL_TRIES):
            found = self._sight.reference.nmsve(np.rint(self._prepared.positions / step) * step)
            step *= min(max(contract.visual / max(found, 1e-300), 1.0 / 64.0), 64.0)
        return min(contract.about_angle, max(self._shaper.character.rounded_angle(step), 1e-4))

    def _drafts(self, *, every: bool) -> list[Draft]:
        """Drafts that may be smallest; with `every`, grids even where they should be larger."""
        found: list[Draft] = []
        try:
            if not every and self._blocks_may_win():
                found.extend(self._spectral())
        except LimitError:
            pass  # blocks that decoders would refuse: a grid asks for little
        smallest = min((draft.size for draft in found), default=None)
        if smallest is None or self._grids_may_win(smallest):
            found.extend(self._grids.drafts())
        return found

    def _grids_may_win(self, smallest: int) -> bool:
        """Whether grids may take fewer bytes than blocks did."""
        if self._thorough:
            return True
        if self._contract.look < math.inf:
            return self._few_looks and self.bytes_on_grids < DEARER * smallest
        return self.bytes_on_grids < smallest

    @property
    def _few_looks(self) -> bool:
        """Whether pictures may be taken of more than one way."""
        return self._contract.look < math.inf and self._prepared.graph.size < FEW_LOOKS

    @property
    def bytes_on_grids(self) -> float:
        """Bytes of a stream on a grid, rather too few, by measures alone."""
        return len(self._prepared.connectivity.data) + self._grids.bytes

    def _refusal(self) -> str:
        had = self._judge.had
        if not had:
            return f"{self._options.lock_borders} cannot be had on this mesh: they are too fine"
        return f"{self._contract} cannot be kept on this mesh; the best that can be had is {had}"

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Tell of a trial as of all blocks once more."""
        blocks = self._prepared.block_count
        if self._progress:
            self._progress(0, blocks)
        yield
        if self._progress:
            self._progress(blocks, blocks)

    # Blocks.

    def _blocks_may_win(self) -> bool:
        """Whether most of what is worth coding is at low frequencies; or only blocks can be fine at borders."""
        if self._options.quick:
            return False
        if self._thorough:
            return self._prepared.has_low_frequencies
        if not self._contract.shades and self._reach < FINE_REACH:
            return False
        if self._borders.vertices.any():
            return self._prepared.graph.size >= FEW_VERTICES
        if self._grids.fits_model or (self._angle <= MODEL_ANGLE and self._shaper.character.is_model):
            return False
        plain = self._shaper.character.is_model and self._edge >= DENSE
        if self._contract.look < PREVIEW and (plain or self._edge < TINY):
            return False
        if not self._prepared.has_low_frequencies:
            return False
        return self._few_looks or not self._blocks.is_flat(COARSE, FLAT)

    @cached_property
    def _blocks(self) -> Spectral:
        return Spectral(self._prepared, self._options, WIDEST)

    def _spectral(self) -> Iterator[Draft]:
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
        ones.
        """
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
        """Whether normals can be right without refinement: they cannot where faces are flat, or bent at random."""
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
