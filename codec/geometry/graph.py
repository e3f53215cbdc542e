"""The graph of a mesh: its vertices, and an edge wherever two of them share a face; and who touches whom there.

Everything that encoder and decoder derive from connectivity starts here. Rows are stored compressed (CSR) and
sorted, so that every rule built on "the first neighbor" is the same on both sides.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bsm._core import codec as _kernels
from bsm.codec.arrays import Faces, Indices, Integers, Order


@dataclass(frozen=True, eq=False)
class Graph:
    """An undirected graph without loops or repeated edges."""

    offsets: Indices
    neighbors: Indices

    @property
    def size(self) -> int:
        return len(self.offsets) - 1


def graph_of_faces(faces: Indices, size: int) -> Graph:
    """Graph on `size` vertices of the triangles `faces`, shape (m, 3); degenerate corners make no edges."""
    offsets, filled = np.empty(size + 1, np.int32), np.empty(size, np.int32)
    # Two directions for each of three sides is the most that there can be. Memory comes from here, since kernels take
    # none.
    ends, second = np.empty(6 * len(faces), np.int32), np.empty(6 * len(faces), np.int32)
    kept = _kernels.collect_edges(
        np.ascontiguousarray(faces, np.int32), offsets, filled, ends, second
    )
    # Copied, or a view would keep the whole buffer alive.
    return Graph(offsets, ends[:kept].copy())


def components(graph: Graph) -> Indices:
    """The connected component of each vertex, shape (n,), numbered in the order of their first vertices."""
    labels, waiting = np.empty(graph.size, np.int32), np.empty(graph.size, np.int32)
    _kernels.label_components(graph.offsets, graph.neighbors, waiting, labels)
    return labels


class Lists(NamedTuple):
    """Compressed rows: those of i are ``members[starts[i]:starts[i + 1]]``, ascending and without repetition."""

    starts: Order
    members: Indices


def vertex_faces(faces: Faces, n: int) -> Lists:
    """Faces, or longer rows of vertices, around each vertex; one that names a vertex twice is listed once."""
    starts, members = np.empty(n + 1, np.int64), np.empty(faces.size, np.int32)
    _kernels.vertex_faces(np.ascontiguousarray(faces, np.int32), starts, members)
    if starts[n] == len(members):
        return Lists(starts, members)
    return Lists(starts, members[: starts[n]].copy())


def vertex_neighbors(faces: Faces, n: int) -> Lists:
    """Vertices that share an edge with each vertex, itself excluded."""
    graph = graph_of_faces(faces, n)
    return Lists(graph.offsets.astype(np.int64), graph.neighbors)


def mesh_edges(faces: Faces, n: int) -> Indices:
    """Undirected edges, each once, as rows (a, b) with a < b, ascending; shape (e, 2)."""
    starts, members = vertex_neighbors(faces, n)
    first = np.repeat(np.arange(n, dtype=np.int32), np.diff(starts))
    once = first < members
    return np.stack([first[once], members[once]], axis=1)


def edges_of(faces: Integers) -> tuple[Order, Order, Order]:
    """The edge from each corner of faces on: its ends, ascending, shape (3 m, 2); its number, and in how many corners
    it begins, shape (3 m,)."""
    # One number for each edge: sorting numbers is much faster than sorting rows.
    ends = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)).astype(np.int64)
    _, edge, counts = np.unique(ends @ [1 << 32, 1], return_inverse=True, return_counts=True)
    return ends, edge, counts[edge]


def canonical(faces: Integers) -> Integers:
    """Faces as rows that begin with their least corner, sorted: equal for equal sets of oriented triangles."""
    rows, corners = canonical_order(faces)
    return np.take_along_axis(faces, corners, axis=1)[rows]


def canonical_order(faces: Integers) -> tuple[Order, Order]:
    # Rotated and never sorted: the order of corners is the side that a face shows.
    # The corner after the least one decides where a face has it twice.
    pairs = faces.astype(np.int64) * (int(faces.max(initial=0)) + 2) + np.roll(faces, -1, axis=1)
    corners = (np.argmin(pairs, axis=1)[:, None] + np.arange(3)) % 3
    turned = np.take_along_axis(faces, corners, axis=1)
    return np.lexsort(turned.T[::-1]), corners
