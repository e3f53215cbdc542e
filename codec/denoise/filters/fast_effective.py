"""Fast and effective feature-preserving mesh denoising (Sun, Rosin, Martin, Langbein 2007)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from codec.denoise.filters.topology import Topology
from codec.denoise.filters.vertex_update import face_geometry, follow_normals
from codec.geometry.mesh import Faces, Positions

THRESHOLD = 0.5
VERTEX_ITERATIONS = 50


def fast_effective_denoising(positions: Positions, faces: Faces, iterations: int = 20) -> Positions:
    """Denoise by thresholded averages of normals, then let the vertices follow; the boundary stays.

    Faces that share a vertex, the face itself included, weigh ``max(n . n' - 0.5, 0) ** 2``.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    faces : ndarray of int32, shape (m, 3)
    iterations : int
        Of the normal filter; fifty vertex updates follow.
    """
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    normals = face_geometry(positions, topology.faces).normals
    for _ in range(iterations):
        normals = _average_alike(normals, topology.patches.starts, topology.patches.members, THRESHOLD)
    return follow_normals(positions, topology, normals, VERTEX_ITERATIONS, ~topology.boundary)


@njit(cache=True, nogil=True)
def _average_alike(normals, starts, members, threshold):  # type: ignore[no-untyped-def]
    averaged = normals.copy()
    for f in range(len(normals)):
        n = normals[f]
        x = y = z = 0.0
        for k in range(starts[f], starts[f + 1]):
            other = normals[members[k]]
            excess = n[0] * other[0] + n[1] * other[1] + n[2] * other[2] - threshold
            if excess > 0.0:
                x += excess * excess * other[0]
                y += excess * excess * other[1]
                z += excess * excess * other[2]
        length = math.sqrt(x * x + y * y + z * z)
        if length > 0.0:
            averaged[f, 0], averaged[f, 1], averaged[f, 2] = x / length, y / length, z / length
    return averaged
