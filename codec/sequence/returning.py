"""Frames that come again: what loops, stands still or turns back is told of once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bsm.codec.arrays import Matrix, Order, Positions
from bsm.codec.static.attributes.levels import Values

SAME = 1 / 64, 1 / 4
"""How far a frame that comes again may be off, in steps: the root mean square of coordinates, and each of them."""
LOOKED_AT = 32
"""Coordinates that most frames differ in."""


def same_frames(frames: Positions, moving: Sequence[Values], step: float) -> Order:
    """The first frame that each one is the same as, far below what `step` leaves, shape (T,)."""
    rows = frames.reshape(len(frames), -1)
    glimpses = np.ascontiguousarray(rows[:, :: max(1, rows.shape[1] // LOOKED_AT)])
    same = np.arange(len(frames))
    for number in range(1, len(frames)):
        alike = np.abs(glimpses[:number] - glimpses[number]).max(axis=1) <= SAME[1] * step
        for other in np.flatnonzero(alike & (same[:number] == np.arange(number))):
            if _same(rows[other] - rows[number], step) and all((own[other] == own[number]).all() for own in moving):
                same[number] = other
                break
    return same


def _same(difference: Matrix, step: float) -> bool:
    mean, most = (share * step for share in SAME)
    return bool(difference @ difference <= len(difference) * mean**2 and np.abs(difference).max() <= most)


def told_frames(same: Order) -> tuple[Order, Order]:
    """Which frames are told of, shape (Q,), if those are the `same`, shape (T,), and which of them each is, (T,)."""
    _, told, shown = np.unique(same, return_index=True, return_inverse=True)
    return told, shown
