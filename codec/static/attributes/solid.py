"""Decoded positions, as attributes need them."""

from __future__ import annotations

from dataclasses import dataclass

from bsm.codec.arrays import Levels, Matrix


@dataclass(frozen=True, eq=False)
class Solid:
    """Decoded positions."""

    positions: Matrix
    places: Levels | None = None
