"""Non-iterative, feature-preserving mesh smoothing (Jones, Durand, Desbrun 2003)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from codec.denoise.filters.reach import reach
from codec.denoise.filters.topology import Topology
from codec.denoise.filters.vertex_update import face_geometry
from codec.geometry.mesh import Faces, Positions
from codec.geometry.metrics import mean_edge_length

SPATIAL = 1.0
INFLUENCE = 1.0


def non_iterative_smoothing(positions: Positions, faces: Faces, iterations: int = 1) -> Positions:
    """Denoise by a robust mean of the predictions that the faces around make for a vertex.

    A face predicts the vertex's projection on its plane, whose normal is taken from a mesh smoothed beforehand
    (mollified, at half the spatial width). Both Gaussians are one mean edge wide.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    faces : ndarray of int32, shape (m, 3)
    iterations : int
        The method needs one pass; more repeat it.
    """
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    for _ in range(iterations):
        edge = mean_edge_length(positions, faces)
        spatial, influence = SPATIAL * edge, INFLUENCE * edge
        centroids, areas, _normals = face_geometry(positions, topology.faces)
        near = reach(positions, topology.around, centroids, topology.patches, 2.0 * spatial)
        mollified = _mollify(positions, centroids, areas, near.starts, near.members, 0.5 * spatial)
        normals = face_geometry(mollified, topology.faces).normals
        positions = _predict(positions, centroids, areas, normals, near.starts, near.members, spatial, influence)
    return positions


@njit(cache=True, nogil=True)
def _mollify(positions, centroids, areas, starts, near, width):  # type: ignore[no-untyped-def]
    moved = positions.copy()
    for v in range(len(positions)):
        p = positions[v]
        total = x = y = z = 0.0
        for k in range(starts[v], starts[v + 1]):
            c = centroids[near[k]]
            squared = (c[0] - p[0]) ** 2 + (c[1] - p[1]) ** 2 + (c[2] - p[2]) ** 2
            weight = areas[near[k]] * math.exp(-0.5 * squared / (width * width))
            total += weight
            x += weight * c[0]
            y += weight * c[1]
            z += weight * c[2]
        if total > 0.0:
            moved[v, 0], moved[v, 1], moved[v, 2] = x / total, y / total, z / total
    return moved


@njit(cache=True, nogil=True)
def _predict(positions, centroids, areas, normals, starts, near, spatial, influence):  # type: ignore[no-untyped-def]
    moved = positions.copy()
    for v in range(len(positions)):
        p = positions[v]
        total = x = y = z = 0.0
        for k in range(starts[v], starts[v + 1]):
            c, n = centroids[near[k]], normals[near[k]]
            height = (c[0] - p[0]) * n[0] + (c[1] - p[1]) * n[1] + (c[2] - p[2]) * n[2]
            squared = (c[0] - p[0]) ** 2 + (c[1] - p[1]) ** 2 + (c[2] - p[2]) ** 2
            exponent = -0.5 * squared / (spatial * spatial) - 0.5 * height * height / (influence * influence)
            weight = areas[near[k]] * math.exp(exponent)
            total += weight
            x += weight * height * n[0]
            y += weight * height * n[1]
            z += weight * height * n[2]
        if total > 0.0:
            moved[v, 0], moved[v, 1], moved[v, 2] = p[0] + x / total, p[1] + y / total, p[2] + z / total
    return moved
