"""The cheapest way to keep a contract: blocks, blocks and refinement, or a grid; each checked on what is decoded.

Rules say which ways can win, and whole files decide among these. What the rules are made of was measured on scans,
models and assets; they decide about bytes and time, never about whether a contract is kept.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property

import numpy as np

from bsm.bitstream.container.header import Layer
from bsm.bitstream.errors import LimitError, TargetError
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.geometry.closeness import Closeness, Original
from bsm.codec.static.choice.borders import borders_of
from bsm.codec.static.choice.grid_search import COARSEST, GridSearch
from bsm.codec.static.choice.lattices import rounded
from bsm.codec.static.choice.search import Trial, widest_step
from bsm.codec.static.choice.shaping import Aim, Shaper
from bsm.codec.static.choice.spectral import Base, Spectral, Stack, base_step
from bsm.codec.static.contract import ANY_ANGLE, Contract
from bsm.codec.static.draft import Draft
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble import FEW_VERTICES, Prepared
from bsm.codec.static.ways.block_coder import Progress

FINE_REACH = 0.001
"""Where normals do not matter, grids are smaller than blocks from this distance on, in BSM units."""
MODEL_ANGLE = 4.0
"""Up to this angle, models with flat faces are smaller on grids."""
PLAIN_ANGLE = 6.0
"""From this angle on, blocks with a detail layer are tried before refinement."""
WIDEST = 0.155
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
FINEST = 2.0**-38
"""Smallest step, in BSM units."""
ALL_AXES = 6.0
"""How much coarser levels in the plane are than those along the normal."""
HEIGHTS, HEIGHTS_OF_MODELS = 1.34, 2.6
"""Step of a layer along normals over what moves the end of a mean edge by the angle that is asked for."""
LAYER, LAYER_IF_ROUGH, LEAST_LAYER, MOST_LAYER = 2.22, 0.09, 0.94, 1.5
"""The same along all axes; less by degrees between faces beside each other."""
STEEP, STEEP_HEIGHTS = 1.05, 0.65
"""How angles grow with the step of a layer, in their logarithms: of one along all axes, and along normals alone."""
FLATTER = 0.6
"""And how much less they may."""
MARGIN = 1e-9
"""Of a bound on distances, for what rounding may add."""


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
        self._shaper = Shaper(self._original, prepared.graph)
        self._reach = contract.reach(prepared.mesh.diagonal, prepared.units.scale) * (1.0 - MARGIN)
        self._borders = borders_of(prepared, options.lock_borders, self._reach)
        self._edge = self._shaper.mean_edge or 1.0
        self._grids = GridSearch(
            prepared, self._original, self._shaper, contract, self._reach, self._borders, self._told
        )
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
            if self._blocks_may_win():
                found.extend(draft for draft in self._spectral() if self._keeps(draft))
        except LimitError:
            pass  # blocks that decoders would refuse: a grid asks for little
        smallest = min((draft.size for draft in found), default=None)
        if smallest is None or len(self._prepared.connectivity.data) + self._grids.bytes < smallest:
            found.extend(draft for draft in self._grids.drafts() if self._keeps(draft))
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
        if self._contract.angle >= ANY_ANGLE and self._reach < FINE_REACH:
            return False
        if self._borders.vertices.any():
            return self._prepared.graph.size >= FEW_VERTICES
        if self._grids.fits_model or (self._contract.angle <= MODEL_ANGLE and self._shaper.character.is_model):
            return False
        return self._prepared.has_low_frequencies and not self._blocks.is_flat(COARSE, FLAT)

    @cached_property
    def _blocks(self) -> Spectral:
        return Spectral(self._prepared, self._options, WIDEST)

    def _spectral(self) -> Iterator[Draft]:
        angle = self._contract.angle
        coarse = Spectral(self._prepared, replace(self._options, detail=0.0), WIDEST)
        if angle >= PLAIN_ANGLE and self._is_smooth:
            plain = self._plain(coarse if self._shaper.character.roughness < SHEET * angle else self._blocks)
            if plain is not None:
                yield plain
                return
        stack = self._refined(coarse.base(base_step(angle), self._progress))
        if stack is not None:
            yield stack.draft()

    def _plain(self, blocks: Spectral) -> Draft | None:
        """The smallest of a few steps without refinement, except for vertices out of reach: these cost more at coarser
        ones.
        """
        sheet = blocks is not self._blocks
        found: list[Draft] = []

        def measure(step: float) -> Trial[Stack]:
            plain = self._with_outliers(blocks.base(step, self._progress), [])
            closeness = self._original.closeness(plain.positions)
            if closeness.angle <= self._contract.angle:
                found.append(plain.draft())
            return Trial(step, closeness, plain)

        first = SHEET_STEP if sheet else PLAIN_STEP * self._contract.angle
        widest = widest_step(
            measure, first, self._contract.angle, math.inf, tries=3, most=COARSEST, slopes=PLAIN_SLOPES
        )
        if widest is not None:
            measure(math.sqrt(first * widest.step) if widest.step > first else PLAIN_STRIDE * first)
        return min(found, key=lambda draft: draft.size, default=None)

    @property
    def _is_smooth(self) -> bool:
        """Whether normals can be right without refinement: they cannot where faces are flat, or bent at random."""
        character = self._shaper.character
        return not character.is_model and character.roughness < min(ROUGH * self._contract.angle, ROUGHEST)

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

    def _refined(self, base: Base) -> Stack | None:
        """A base with heights along the normals, if these can bring normals right; with all axes if not."""
        many = MANY_OUTLIERS * len(base.positions)
        heights = self._original.angle(base.upright) <= self._contract.angle and self._outliers(base.upright) <= many
        if heights:
            layer = base.layer(self._first_layer(0.0), 0.0)
            heights = self._outliers(base.moved(layer, base.wanted(layer)[0])) <= many
        best = self._refinement(base, 0.0 if heights else ALL_AXES)
        if heights and (best is None or self._outliers(base.moved(*best.found)) > many):
            best = self._refinement(base, ALL_AXES)
        return None if best is None else self._with_outliers(base, [best.found])

    def _refinement(self, base: Base, ratio: float) -> Trial[tuple[Layer, Levels]] | None:
        """One layer whose normals are right, where borders, and vertices out of reach, are back at their places."""
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
                closeness = self._original.closeness(self._brought_back(base, base.moved(layer, levels, start)))
            return Trial(step, closeness, (layer, levels))

        steep = STEEP if ratio else STEEP_HEIGHTS
        return widest_step(
            measure,
            self._first_layer(ratio),
            self._contract.angle,
            math.inf,
            tries=2 if self._shaper.character.is_model else 3,
            most=COARSEST,
            slopes=(FLATTER * steep, steep),
        )

    def _first_layer(self, ratio: float) -> float:
        """The step of a layer that should be about right."""
        character = self._shaper.character
        if ratio:
            factor = min(max(LAYER - LAYER_IF_ROUGH * character.roughness, LEAST_LAYER), MOST_LAYER)
        else:
            factor = HEIGHTS_OF_MODELS if character.is_model else HEIGHTS
        return factor * math.radians(self._contract.angle) * self._edge
