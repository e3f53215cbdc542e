"""Who touches whom in a triangle mesh, as compressed rows: faces around a vertex, neighbours of a vertex, of a face.

A `Rows` value lists the members of row i as ``members[starts[i]:starts[i + 1]]``, ascending and without repetition.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Indices, Order
from bsm.codec.geometry.graph import graph_of_faces


class Rows(NamedTuple):
    """Compressed rows of integers."""

    starts: Order
    members: Indices


def vertex_faces(faces: Faces, n: int) -> Rows:
    """Faces around each vertex; a face that names a vertex twice is listed once."""
    starts, members = np.empty(n + 1, np.int64), np.empty(faces.size, np.int32)
    _kernels.vertex_faces(np.ascontiguousarray(faces, np.int32), starts, members)
    return Rows(starts, members[: starts[n]])


def vertex_neighbours(faces: Faces, n: int) -> Rows:
    """Vertices that share an edge with each vertex, itself excluded."""
    graph = graph_of_faces(faces, n)
    return Rows(graph.offsets.astype(np.int64), graph.neighbours)


def mesh_edges(faces: Faces, n: int) -> Indices:
    """Undirected edges, each once, as rows (a, b) with a < b, ascending; shape (e, 2)."""
    starts, members = vertex_neighbours(faces, n)
    first = np.repeat(np.arange(n, dtype=np.int32), np.diff(starts))
    once = first < members
    return np.stack([first[once], members[once]], axis=1)
