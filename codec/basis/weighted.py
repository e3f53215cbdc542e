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
import numpy.typing as npt
from numba import njit

from codec.geometry.graph import Graph, Indices
from codec.geometry.mesh import Faces, Positions

Matrix = npt.NDArray[np.float64]

SMALLEST_WEIGHT = 0.05
LARGEST_WEIGHT = 10.0


def cotangent_weights(graph: Graph, faces: Faces, positions: Positions) -> Matrix:
    """Weight of every entry of `graph.neighbours`: half the sum of the cotangents opposite to the edge, clamped.

    A triangle without area counts nothing. The result does not depend on the unit of `positions`, shape (n, 3).
    """
    weights: Matrix = _cotangents(graph.offsets, graph.neighbours, faces, np.ascontiguousarray(positions))
    return weights


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
    return HeldLaplacian(*_held(graph.offsets, graph.neighbours, weights, vertices, rank))


@njit(cache=True, nogil=True)
def _entry(offsets, neighbours, v, w):  # type: ignore[no-untyped-def]
    """Index of w among the neighbours of v."""
    low, high = offsets[v], offsets[v + 1] - 1
    while low < high:
        middle = (low + high) // 2
        if neighbours[middle] < w:
            low = middle + 1
        else:
            high = middle
    return low


@njit(cache=True, nogil=True)
def _cotangents(offsets, neighbours, faces, positions):  # type: ignore[no-untyped-def]
    weights = np.zeros(len(neighbours))
    for f in range(len(faces)):
        for corner in range(3):
            a, b, c = faces[f, corner], faces[f, (corner + 1) % 3], faces[f, (corner + 2) % 3]
            if a in (b, c) or b == c:
                continue
            ux, uy, uz = (
                positions[b, 0] - positions[a, 0],
                positions[b, 1] - positions[a, 1],
                positions[b, 2] - positions[a, 2],
            )
            vx, vy, vz = (
                positions[c, 0] - positions[a, 0],
                positions[c, 1] - positions[a, 1],
                positions[c, 2] - positions[a, 2],
            )
            x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            area = np.sqrt(x * x + y * y + z * z)
            if area > 0.0:
                half = 0.5 * (ux * vx + uy * vy + uz * vz) / area
                weights[_entry(offsets, neighbours, b, c)] += half
                weights[_entry(offsets, neighbours, c, b)] += half
    return np.minimum(np.maximum(weights, SMALLEST_WEIGHT), LARGEST_WEIGHT)


@njit(cache=True, nogil=True)
def _held(offsets, neighbours, weights, vertices, rank):  # type: ignore[no-untyped-def]
    n = len(vertices)
    own = rank[vertices[0]]
    matrix = np.zeros((n, n))
    springs = 0
    for v in vertices:
        for i in range(offsets[v], offsets[v + 1]):
            if rank[neighbours[i]] < own:
                springs += 1
    rows = np.empty(springs, np.int32)
    outer = np.empty(springs, np.int32)
    stiffness = np.empty(springs, np.float64)
    springs = 0
    for r in range(n):
        v = vertices[r]
        for i in range(offsets[v], offsets[v + 1]):
            w = neighbours[i]
            if rank[w] > own:
                continue
            matrix[r, r] += weights[i]
            if rank[w] == own:
                matrix[r, np.searchsorted(vertices, w)] -= weights[i]
            else:
                rows[springs], outer[springs], stiffness[springs] = r, w, weights[i]
                springs += 1
    return matrix, rows, outer, stiffness
