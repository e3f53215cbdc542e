"""Neighbourhoods on the surface: what is reached from a place without leaving a ball about it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.geometry.incidence import Rows
from codec.geometry.mesh import Positions

Floats = npt.NDArray[np.float64]


def themselves(count: int) -> Rows:
    """Rows that hold their own number and nothing else."""
    return Rows(np.arange(count + 1, dtype=np.int64), np.arange(count, dtype=np.int32))


def reach(centres: Positions, seeds: Rows, points: Positions, adjacent: Rows, radius: float | Floats) -> Rows:
    """Points that are reached from each centre over adjacent points, all of them within a radius of the centre.

    Parameters
    ----------
    centres : ndarray of float64, shape (k, 3)
    seeds : Rows
        For each centre, the points where the search starts; those beyond the radius do not count.
    points : ndarray of float64, shape (m, 3)
        Vertices, or centroids of faces.
    adjacent : Rows
        Neighbours of each point.
    radius : float or ndarray of float64, shape (k,)

    Returns
    -------
    Rows
        k rows of point numbers, in the order of a breadth-first search.
    """
    radii = np.broadcast_to(np.asarray(radius, dtype=np.float64), len(centres))
    return Rows(*_reach(centres, seeds.starts, seeds.members, points, adjacent.starts, adjacent.members, radii))


@njit(cache=True, nogil=True)
def _reach(centres, seed_starts, seeds, points, starts, members, radii):  # type: ignore[no-untyped-def]
    m = len(points)
    reached_starts = np.zeros(len(centres) + 1, dtype=np.int64)
    reached = np.empty(32 * len(centres) + m, dtype=np.int32)
    seen = np.full(m, -1, dtype=np.int32)
    end = 0
    for i in range(len(centres)):
        if end + m > len(reached):
            # A row has at most m members; growing here keeps the inner loops free of checks.
            grown = np.empty(2 * len(reached) + m, dtype=np.int32)
            grown[:end] = reached[:end]
            reached = grown
        x, y, z = centres[i]
        squared = radii[i] * radii[i]
        head = end
        for k in range(seed_starts[i], seed_starts[i + 1]):
            p = seeds[k]
            seen[p] = i
            if (points[p, 0] - x) ** 2 + (points[p, 1] - y) ** 2 + (points[p, 2] - z) ** 2 <= squared:
                reached[end] = p
                end += 1
        while head < end:
            g = reached[head]
            head += 1
            for k in range(starts[g], starts[g + 1]):
                p = members[k]
                if seen[p] != i:
                    seen[p] = i
                    if (points[p, 0] - x) ** 2 + (points[p, 1] - y) ** 2 + (points[p, 2] - z) ** 2 <= squared:
                        reached[end] = p
                        end += 1
        reached_starts[i + 1] = end
    return reached_starts, reached[:end].copy()
