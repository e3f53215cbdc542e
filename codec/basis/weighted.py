"""Laplacians that weigh edges by geometry that both sides already know: the decoded first frame of a sequence.

The paper's Laplacian is the binary one because a decoder knows connectivity only. The frames of a sequence are
different: once one of them is decoded, the others may be transformed in a basis that knows the shape of the
triangles. L = D - W with W the cotangent weights, clamped to a positive range (they may be negative, and L indefinite,
where a triangle is obtuse), and D = rowsum(W).

References
----------
U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates", 1993, section 4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from codec import _kernels
from codec.arrays import Faces, Indices, Matrix, Positions
from codec.geometry.graph import Graph

SMALLEST_WEIGHT = 0.05
LARGEST_WEIGHT = 10.0


def cotangent_weights(graph: Graph, faces: Faces, positions: Positions) -> Matrix:
    """Weight of every entry of `graph.neighbours`: half the sum of the cotangents opposite to the edge, clamped.

    A triangle without area counts nothing. The result does not depend on the unit of `positions`, shape (n, 3).
    """
    if positions.shape != (graph.size, 3):
        raise ValueError(f"positions of shape {positions.shape} for {graph.size} vertices")
    weights = np.zeros(len(graph.neighbours))
    _kernels.cotangents(graph.offsets, graph.neighbours, faces, np.ascontiguousarray(positions), weights)
    return np.minimum(np.maximum(weights, SMALLEST_WEIGHT), LARGEST_WEIGHT)


def binary_weights(graph: Graph) -> Matrix:
    """Weight one for every entry of `graph.neighbours`."""
    return np.ones(len(graph.neighbours))


@dataclass(frozen=True, eq=False)
class HeldLaplacian:
    """The Laplacian of a part, and the springs on which it hangs: its edges to parts that are known before it.

    Parameters
    ----------
    matrix : float64 array, shape (n_i, n_i)
        D - W over the part's own edges, plus the springs' weights on the diagonal; edges to parts that are not known
        yet count nothing.
    rows, outer : int32 arrays, shape (s,)
        Row of the part, and vertex of the mesh, that each spring connects; rows ascend.
    weights : float64 array, shape (s,)
    """

    matrix: Matrix
    rows: Indices
    outer: Indices
    weights: Matrix


def held_laplacian(graph: Graph, weights: Matrix, vertices: Indices, rank: Indices) -> HeldLaplacian:
    """Laplacian of the part with the given vertices.

    Parameters
    ----------
    graph : Graph
        Of the mesh.
    weights : float64 array
        Of the entries of `graph.neighbours`.
    vertices : int32 array, shape (n_i,)
        Of the part, ascending.
    rank : int32 array, shape (n,)
        When the part of each vertex becomes known.
    """
    if len(weights) != len(graph.neighbours) or len(rank) != graph.size or len(vertices) == 0:
        raise ValueError(f"{len(weights)} weights, {len(rank)} ranks and a part of {len(vertices)} vertices")
    matrix = np.zeros((len(vertices), len(vertices)))
    room = int((graph.offsets[vertices + 1] - graph.offsets[vertices]).sum())
    rows, outer, stiffness = np.empty(room, np.int32), np.empty(room, np.int32), np.empty(room)
    count = _kernels.hold(graph.offsets, graph.neighbours, weights, vertices, rank, matrix, rows, outer, stiffness)
    return HeldLaplacian(matrix, rows[:count], outer[:count], stiffness[:count])
