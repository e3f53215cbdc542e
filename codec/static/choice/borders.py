"""Borders that stay where they are, so that parts of a mesh fit that were encoded apart."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.fields.corners import corners_of, keep_borders
from bsm.bitstream.fields.levels import MOST_LEVEL
from bsm.codec.arrays import Levels, Mask, Matrix
from bsm.codec.static.contract import Fit
from bsm.codec.static.preamble_encoding import Prepared

ROUND = 2.0 / math.sqrt(3.0) * 0.999
"""A cell of a cubic grid whose corners are just within 1 of its middle."""


@dataclass(frozen=True, eq=False)
class Borders:
    """Vertices of borders, and how far they may come to lie from their places."""

    vertices: Mask
    reach: float

    def out(self, offsets: Matrix) -> Mask:
        """Which vertices of borders are too far off, by what is missing of all, shape (n, 3)."""
        return np.asarray(self.vertices & (np.square(offsets).sum(axis=1) > self.reach**2))

    def kept(self, wanted: Matrix, decoded: Matrix) -> bool:
        """Whether all of `decoded` are near enough to `wanted`, both of shape (n, 3)."""
        return not self.out(decoded - wanted).any()

    @property
    def cell(self) -> float:
        """The largest cell of a grid on which every vertex of a border is near enough, wherever it is."""
        return ROUND * self.reach if self.vertices.any() else math.inf

    def levels(self, offsets: Matrix, step: float) -> Levels | None:
        """Levels of a cubic layer for those that are too far off, shape (n, 3); None: there are none so large."""
        out = self.out(offsets)
        wanted = np.rint(np.where(out[:, None], offsets / step, 0.0))
        return wanted.astype(np.int32) if np.abs(wanted).max(initial=0.0) <= MOST_LEVEL else None


def borders_of(prepared: Prepared, fit: Fit | None, reach: float) -> Borders:
    """The borders that `fit` locks; no vertex at all may be farther off than `reach`, in BSM units."""
    size = len(prepared.positions)
    if fit is None:
        return Borders(np.zeros(size, np.bool_), reach)
    own = fit.reach(prepared.mesh.diagonal, prepared.units.scale)
    return Borders(keep_borders(corners_of(prepared.mesh.faces, size)), min(own * (1.0 - 1e-9), reach))
