"""Half-edges of any triangle list: non-manifold parts cut, boundary loops closed by dummy vertices (encoder only).

Half-edge ``3 * i + k`` runs from corner k of face i to corner k + 1. The result is a closed oriented surface: every
half-edge has a twin. Vertices of that surface are *fans*: a vertex of the mesh around which the faces do not form one
fan appears once per fan. Each boundary loop is closed by one dummy vertex with one dummy face per boundary edge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels

Ints = npt.NDArray[np.int32]


class Surface(NamedTuple):
    """A closed surface."""

    twin: Ints
    corner: Ints
    valence: Ints
    vertex: Ints


def close_surface(faces: Ints, vertex_count: int) -> Surface:
    """Build the closed surface of faces without repeated corners, shape (m, 3), indices below `vertex_count`."""
    origin = np.ascontiguousarray(faces, np.int32).reshape(-1)
    twin = match_halfedges(origin, vertex_count)
    corner, vertex = _find_fans(origin, twin)
    return _fill_loops(twin, corner, vertex)


def match_halfedges(origin: Ints, vertex_count: int) -> Ints:
    """Twin of each half-edge, -1 unless its edge has exactly one half-edge in each direction; in linear time."""
    starts = np.empty(vertex_count + 1, np.int64)
    by_high, order, twin = (np.empty(origin.size, np.int32) for _ in range(3))
    _kernels.match_halfedges(origin, starts, by_high, order, twin)
    return twin


def _find_fans(origin: Ints, twin: Ints) -> tuple[Ints, Ints]:
    corner, vertex = np.empty_like(origin), np.empty_like(origin)
    count = _kernels.find_fans(origin, twin, corner, vertex)
    return corner, vertex[:count].copy()


def _fill_loops(twin: Ints, corner: Ints, vertex: Ints) -> Surface:
    """Add a dummy vertex for every boundary loop, and its faces (b, a, dummy) for each boundary half-edge (a, b)."""
    size = twin.size + 3 * int(np.count_nonzero(twin < 0))
    full_twin, full_corner = np.empty(size, np.int32), np.empty(size, np.int32)
    dummies = _kernels.fill_loops(twin, corner, np.empty_like(vertex), full_twin, full_corner)
    valence = np.bincount(full_corner, minlength=len(vertex) + dummies).astype(np.int32)
    return Surface(full_twin, full_corner, valence, vertex)
