"""Bilateral normal filtering, local scheme (Zheng, Fu, Au, Tai 2011)."""

from __future__ import annotations

import numpy as np

from codec.denoise.filters.kernel import filter_normals
from codec.denoise.filters.topology import Topology, without_first
from codec.denoise.filters.vertex_update import face_geometry, follow_normals, mean_centroid_distance
from codec.geometry.mesh import Faces, Positions

SIGMA_R = 0.35
VERTEX_ITERATIONS = 10


def bilateral_normal_filtering(positions: Positions, faces: Faces, iterations: int = 20) -> Positions:
    """Denoise by bilateral filtering of the normals over faces that share a vertex; the boundary stays.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    faces : ndarray of int32, shape (m, 3)
    iterations : int
        Of the normal filter, whose centroids and areas stay those of the input; ten vertex updates follow.
    """
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    others = without_first(topology.patches)
    geometry = face_geometry(positions, topology.faces)
    sigma_s = mean_centroid_distance(geometry.centroids, topology.pairs)
    for _ in range(iterations):
        normals = filter_normals(geometry, geometry.normals, others, sigma_s, SIGMA_R)
        geometry = geometry._replace(normals=normals)
    return follow_normals(positions, topology, geometry.normals, VERTEX_ITERATIONS, ~topology.boundary)
