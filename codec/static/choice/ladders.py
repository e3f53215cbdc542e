"""Drafts from coarse to fine, one for every step: what a search for a quality or a size climbs.

Blocks alone are best far up, where dictionaries are narrow; blocks and a layer of refinement below. Grids go all the
way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

from bsm.codec.geometry.closeness import Original
from bsm.codec.static.choice.lattices import Shaped
from bsm.codec.static.choice.shaping import Aim, Shaper
from bsm.codec.static.choice.spectral import Base, Spectral, base_step
from bsm.codec.static.draft import Draft
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble import Prepared
from bsm.codec.static.targets import COARSEST_STEP
from bsm.codec.static.ways.block_coder import Progress

WIDEST = 0.18
"""Columns of a dictionary over the rows of a block."""
NOMINAL = 2000.0
"""Degrees that a step comes to, about, times which."""
HEIGHTS_SHARE = 0.93
"""Levels along normals alone are enough where exact ones would leave at most so much of the angle that is asked for."""
RATIOS = {"nmsve_db": 3.0}
"""How much coarser levels in the plane are than those along the normal, by what is asked for; 6, or none at all, where
it is about normals."""


FINER = 1.6
"""Rough meshes are smaller with blocks so much finer."""


class Ladder(Protocol):
    """Drafts of one mesh."""

    @property
    def finest(self) -> float:
        """The smallest step."""

    def draft(self, step: float) -> Draft:
        """The draft at a step, in BSM units."""


@dataclass(frozen=True, eq=False)
class Blocks:
    """Blocks alone."""

    spectral: Spectral
    finest: float
    progress: Progress | None

    def draft(self, step: float) -> Draft:
        """The draft at a step."""
        return self.spectral.base(step, self.progress).draft


class Refined:
    """A layer of refinement on blocks that are coarser where it is.

    Parameters
    ----------
    prepared : Prepared
    options : EncodeOptions
        With a target.
    shaper : Shaper
    original : Original
    progress : callable, optional
    finer : float
        How many times finer the blocks are than what is best on most meshes.
    """

    finest = 1e-6

    def __init__(
        self,
        prepared: Prepared,
        options: EncodeOptions,
        shaper: Shaper,
        original: Original,
        progress: Progress | None,
        finer: float = 1.0,
    ) -> None:
        self._finer = finer
        self._shaper = shaper
        self._original = original
        self._progress = progress
        self._kind = "" if options.target is None else options.target.kind
        self._angle = options.target.value if options.target is not None and self._kind == "theta_deg" else None
        self._spectral = Spectral(prepared, replace(options, detail=0.0), WIDEST)
        self._bases: dict[float, Base] = {}

    def draft(self, step: float) -> Draft:
        """The draft at a step."""
        nominal = NOMINAL * step
        # Where the angle is known, base and axes are the same at all steps: sizes and angles do not jump.
        base = self._base(base_step(self._angle or nominal) / self._finer)
        ratio = RATIOS.get(self._kind, 6.0)
        if self._angle is not None and self._original.angle(base.upright) < HEIGHTS_SHARE * self._angle:
            ratio = 0.0
        edge = self._shaper.mean_edge or 1.0
        layer = base.layer(min(1.2 * math.radians(nominal) * edge, COARSEST_STEP), ratio)
        wanted, directions = base.wanted(layer)
        aim = Aim(layer.step / edge, 8.0 * layer.step if ratio else math.inf)
        return base.refined((layer, self._shaper.levels(base.positions, wanted, directions, aim))).draft()

    def _base(self, step: float) -> Base:
        if step not in self._bases:
            self._bases[step] = self._spectral.base(step, self._progress)
        return self._bases[step]


class Grids:
    """Shaped grids, of any step."""

    def __init__(self, prepared: Prepared, shaper: Shaper) -> None:
        self._shaped = Shaped(prepared, shaper)
        self._edge = shaper.mean_edge or 1.0

    @property
    def finest(self) -> float:
        """The smallest step."""
        return self._shaped.finest / self._scale

    def draft(self, step: float) -> Draft:
        """The draft at a step."""
        cell = max(step * self._scale, self._shaped.finest)
        held, places, _, _ = self._shaped.places(cell, Aim(0.4 * cell / self._edge, 3.0 * cell, 3))
        return self._shaped.draft(held, places)

    @property
    def _scale(self) -> float:
        """Cells at step 1."""
        return 4.0 * math.radians(NOMINAL) * self._edge
