"""Who touches whom in a triangle mesh, as compressed rows: faces around a vertex, neighbours of a vertex, of a face.

A `Rows` value lists the members of row i as ``members[starts[i]:starts[i + 1]]``, ascending and without repetition.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.geometry.graph import Indices, graph_of_faces
from codec.geometry.mesh import Faces


class Rows(NamedTuple):
    """Compressed rows of integers.

    Parameters
    ----------
    starts : ndarray of int64, shape (rows + 1,)
    members : ndarray of int32, shape (starts[-1],)
    """

    starts: npt.NDArray[np.int64]
    members: Indices


def vertex_faces(faces: Faces, n: int) -> Rows:
    """Faces around each vertex; a face that names a vertex twice is listed once.

    Parameters
    ----------
    faces : ndarray of int32, shape (m, 3)
    n : int
        Number of vertices.
    """
    return Rows(*_vertex_faces(faces, n))


def vertex_neighbours(faces: Faces, n: int) -> Rows:
    """Vertices that share an edge with each vertex, itself excluded.

    Parameters
    ----------
    faces : ndarray of int32, shape (m, 3)
    n : int
        Number of vertices.
    """
    graph = graph_of_faces(faces, n)
    return Rows(graph.offsets.astype(np.int64), graph.neighbours)


def mesh_edges(faces: Faces, n: int) -> Indices:
    """Undirected edges, each once, as rows (a, b) with a < b, ascending; shape (e, 2)."""
    starts, members = vertex_neighbours(faces, n)
    first = np.repeat(np.arange(n, dtype=np.int32), np.diff(starts))
    once = first < members
    return np.stack([first[once], members[once]], axis=1)


@njit(cache=True, nogil=True)
def _vertex_faces(faces, n):  # type: ignore[no-untyped-def]
    starts = np.zeros(n + 1, dtype=np.int64)
    for f in range(len(faces)):
        a, b, c = faces[f]
        starts[a + 1] += 1
        if b != a:
            starts[b + 1] += 1
        if c != a and c != b:
            starts[c + 1] += 1
    for v in range(n):
        starts[v + 1] += starts[v]
    fill = starts[:-1].copy()
    members = np.empty(starts[n], dtype=np.int32)
    for f in range(len(faces)):
        a, b, c = faces[f]
        members[fill[a]] = f
        fill[a] += 1
        if b != a:
            members[fill[b]] = f
            fill[b] += 1
        if c != a and c != b:
            members[fill[c]] = f
            fill[c] += 1
    return starts, members
