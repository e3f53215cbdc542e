"""Neighbourhoods on the surface: what is reached from a place without leaving a ball about it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.codec import _kernels
from bsm.codec.arrays import Positions
from bsm.codec.geometry.incidence import Rows

Floats = npt.NDArray[np.float64]


def themselves(count: int) -> Rows:
    """Rows that hold their own number and nothing else."""
    return Rows(np.arange(count + 1, dtype=np.int64), np.arange(count, dtype=np.int32))


def reach(centres: Positions, seeds: Rows, points: Positions, adjacent: Rows, radius: float | Floats) -> Rows:
    """Points that are reached from each centre over adjacent points, all of them within a radius of the centre."""
    count, size = len(centres), len(points)
    radii = np.ascontiguousarray(np.broadcast_to(np.asarray(radius, dtype=np.float64), count))
    starts, seen = np.zeros(count + 1, np.int64), np.full(size, -1, np.int32)
    reached = np.empty(32 * count + size, np.int32)
    done = 0
    while True:
        done = _kernels.reach(
            centres,
            seeds.starts,
            seeds.members,
            points,
            adjacent.starts,
            adjacent.members,
            radii,
            done,
            seen,
            starts,
            reached,
        )
        if done == count:
            return Rows(starts, reached[: starts[count]].copy())
        # A row has at most as many members as there are points; with room for one, the kernel goes on.
        reached = np.concatenate([reached, np.empty(len(reached) + size, np.int32)])
