"""Bilateral mesh denoising (Fleishman, Drori, Cohen-Or 2003): vertices move along their normals."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from codec.denoise.filters.reach import reach, themselves
from codec.denoise.filters.topology import Topology
from codec.denoise.filters.vertex_update import Floats, face_geometry, vertex_normals
from codec.geometry.incidence import Rows
from codec.geometry.mesh import Faces, Positions


def bilateral_mesh_denoising(positions: Positions, faces: Faces, iterations: int = 5) -> Positions:
    """Denoise by a bilateral filter of heights over the tangent planes.

    The spatial width at a vertex is its shortest edge, its neighbourhood reaches twice as far, and the width of the
    height kernel is the standard deviation of the absolute heights found there.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    faces : ndarray of int32, shape (m, 3)
    iterations : int
    """
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    own = themselves(len(positions))
    for _ in range(iterations):
        normals = vertex_normals(face_geometry(positions, faces).normals, topology.around)
        width = shortest_edges(positions, topology.neighbours)
        near = reach(positions, own, positions, topology.neighbours, 2.0 * width)
        positions = _filter_heights(positions, normals, width, near.starts, near.members)
    return positions


def shortest_edges(positions: Positions, neighbours: Rows) -> Floats:
    """Length of the shortest edge at each vertex, shape (n,); 0 where there is none."""
    lengths: Floats = _shortest_edges(positions, neighbours.starts, neighbours.members)
    return lengths


@njit(cache=True, nogil=True)
def _shortest_edges(positions, starts, members):  # type: ignore[no-untyped-def]
    lengths = np.zeros(len(positions))
    for v in range(len(positions)):
        shortest = math.inf
        for k in range(starts[v], starts[v + 1]):
            a, b = positions[v], positions[members[k]]
            shortest = min(shortest, (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
        if shortest < math.inf:
            lengths[v] = math.sqrt(shortest)
    return lengths


@njit(cache=True, nogil=True)
def _filter_heights(positions, normals, width, starts, near):  # type: ignore[no-untyped-def]
    moved = positions.copy()
    for v in range(len(positions)):
        first, last = starts[v], starts[v + 1]
        if last - first < 2 or width[v] == 0.0:
            continue
        p, n = positions[v], normals[v]
        mean = square = 0.0
        for k in range(first, last):
            q = positions[near[k]]
            height = abs((q[0] - p[0]) * n[0] + (q[1] - p[1]) * n[1] + (q[2] - p[2]) * n[2])
            mean += height
            square += height * height
        count = last - first
        variance = max(square / count - (mean / count) ** 2, 0.0)
        if variance == 0.0:
            continue
        total = moment = 0.0
        for k in range(first, last):
            q = positions[near[k]]
            x, y, z = q[0] - p[0], q[1] - p[1], q[2] - p[2]
            height = x * n[0] + y * n[1] + z * n[2]
            weight = math.exp(-0.5 * (x * x + y * y + z * z) / (width[v] * width[v]) - 0.5 * height * height / variance)
            total += weight
            moment += weight * height
        for axis in range(3):
            moved[v, axis] = p[axis] + n[axis] * moment / total
    return moved
