"""Decoded positions, as attributes need them."""

from __future__ import annotations

from dataclasses import dataclass

from bsm.codec.arrays import Levels, Matrix


@dataclass(frozen=True, eq=False)
class Solid:
    """Decoded positions.

    Parameters
    ----------
    positions : float64 array, shape (n, 3)
        In BSM units, or for grids in the mesh's unit.
    places : int32 array, shape (n, 3), optional
        Coded values on a grid, which attributes may be predicted from; None: there is none.
    """

    positions: Matrix
    places: Levels | None = None
