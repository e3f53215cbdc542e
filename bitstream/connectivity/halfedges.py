"""Half-edges of any triangle list: non-manifold parts cut, boundary loops closed by dummy vertices (encoder only).

Half-edge ``3 * i + k`` runs from corner k of face i to corner k + 1. The result is a closed oriented surface: every
half-edge has a twin. Vertices of that surface are *fans*: a vertex of the mesh around which the faces do not form one
fan appears once per fan. Each boundary loop is closed by one dummy vertex with one dummy face per boundary edge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.entropy.range_coder import leaf

Ints = npt.NDArray[np.int32]


class Surface(NamedTuple):
    """A closed surface.

    Attributes
    ----------
    twin : int32 array, shape (3 * (m + d),)
        The half-edge on the other side; the d dummy faces follow the m real ones.
    corner : int32 array, shape (3 * (m + d),)
        Fan where the half-edge starts; the dummy vertices follow the fans.
    valence : int32 array
        Number of edges of each fan and dummy vertex.
    vertex : int32 array
        Vertex of the mesh that each fan belongs to.
    """

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


@leaf
def next_halfedge(h: int) -> int:
    """The half-edge after h in its face."""
    return h + 1 if h % 3 != 2 else h - 2


@leaf
def previous_halfedge(h: int) -> int:
    """The half-edge before h in its face."""
    return h - 1 if h % 3 != 0 else h + 2


@njit(cache=True, nogil=True)
def match_halfedges(origin: Ints, vertex_count: int) -> Ints:
    """Twin of each half-edge, -1 unless its edge has exactly one half-edge in each direction.

    Sorted by both ends with two counting passes, so linear in time whatever the degrees.
    """
    size = origin.size
    starts = np.zeros(vertex_count + 1, np.int64)
    by_high = np.empty(size, np.int32)
    order = np.empty(size, np.int32)
    low = np.empty(size, np.int32)
    high = np.empty(size, np.int32)
    for h in range(size):
        a, b = origin[h], origin[next_halfedge(h)]
        low[h], high[h] = min(a, b), max(a, b)
        starts[high[h] + 1] += 1
    for v in range(vertex_count):
        starts[v + 1] += starts[v]
    for h in range(size):
        by_high[starts[high[h]]] = h
        starts[high[h]] += 1
    starts[:] = 0
    for h in range(size):
        starts[low[h] + 1] += 1
    for v in range(vertex_count):
        starts[v + 1] += starts[v]
    for i in range(size):
        h = by_high[i]
        order[starts[low[h]]] = h
        starts[low[h]] += 1

    twin = np.full(size, -1, np.int32)
    begin = 0
    while begin < size:
        first = order[begin]
        end = begin + 1
        while end < size and low[order[end]] == low[first] and high[order[end]] == high[first]:
            end += 1
        if end == begin + 2:
            second = order[begin + 1]
            if origin[first] != origin[second]:
                twin[first], twin[second] = second, first
        begin = end
    return twin


@njit(cache=True, nogil=True)
def _find_fans(origin: Ints, twin: Ints) -> tuple[Ints, Ints]:
    """Number the fans by first corner; return the fan of each corner and the vertex of each fan."""
    corner = np.full(origin.size, -1, np.int32)
    vertex = np.empty(origin.size, np.int32)
    count = 0
    for start in range(origin.size):
        if corner[start] >= 0:
            continue
        h = start
        while h >= 0 and corner[h] < 0:
            corner[h] = count
            h = twin[previous_halfedge(h)]
        h = start
        while twin[h] >= 0 and corner[next_halfedge(twin[h])] < 0:
            h = next_halfedge(twin[h])
            corner[h] = count
        vertex[count] = origin[start]
        count += 1
    return corner, vertex[:count].copy()


@njit(cache=True, nogil=True)
def _fill_loops(twin: Ints, corner: Ints, vertex: Ints) -> Surface:
    """Add a dummy vertex for every boundary loop, and its faces (b, a, dummy) for each boundary half-edge (a, b)."""
    size = twin.size
    fans = vertex.size
    leaving = np.full(fans, -1, np.int32)  # the boundary half-edge that starts at each fan: at most one
    open_edges = 0
    for h in range(size):
        if twin[h] < 0:
            leaving[corner[h]] = h
            open_edges += 1
    full_twin = np.empty(size + 3 * open_edges, np.int32)
    full_corner = np.empty(size + 3 * open_edges, np.int32)
    full_twin[:size] = twin
    full_corner[:size] = corner
    dummies = 0
    fill = size
    for start in range(size):
        if full_twin[start] >= 0:
            continue
        first, h = fill, start
        while full_twin[h] < 0:
            a, b = corner[h], corner[next_halfedge(h)]
            full_corner[fill], full_corner[fill + 1], full_corner[fill + 2] = b, a, fans + dummies
            full_twin[h], full_twin[fill] = fill, h
            # Edge (dummy, b) of this face meets edge (b, dummy) of the face over the loop's next edge.
            following = fill + 3 if full_twin[leaving[b]] < 0 else first
            full_twin[fill + 2], full_twin[following + 1] = following + 1, fill + 2
            fill += 3
            h = leaving[b]
        dummies += 1
    valence = np.zeros(fans + dummies, np.int32)
    for h in range(full_corner.size):
        valence[full_corner[h]] += 1
    return Surface(full_twin, full_corner, valence, vertex)
