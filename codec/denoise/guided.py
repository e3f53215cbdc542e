"""Guided normal filtering (Zhang et al. 2015), the fine step of the paper."""

from __future__ import annotations

import numpy as np

from codec.denoise.bilateral import filter_normals
from codec.denoise.guidance import inner_pairs, patch_guidance
from codec.denoise.reach import reach, themselves
from codec.denoise.surface import (
    Floats,
    face_geometry,
    follow_normals,
    mean_centroid_distance,
    topology_of,
)
from codec.mesh import Faces, Positions

SIGMA_R = 0.35
RADIUS = 2.0
VERTEX_ITERATIONS = 10


class GuidedFilter:
    """The filter with its neighbourhoods, which are found once, on the mesh that it starts from.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
        Where the filter starts: the neighbourhood of a face reaches twice the mean distance of adjacent centroids.
    faces : ndarray of int32, shape (m, 3)
    """

    def __init__(self, positions: Positions, faces: Faces) -> None:
        self.topology = topology_of(faces, len(positions))
        self._inner = inner_pairs(self.topology)
        centroids = face_geometry(positions, self.topology.faces).centroids
        radius = RADIUS * mean_centroid_distance(centroids, self.topology.pairs)
        self._near = reach(centroids, themselves(len(centroids)), centroids, self.topology.patches, radius)

    def normals(self, positions: Positions, sigma_r: float = SIGMA_R) -> Floats:
        """Face normals filtered once, guided by the most consistent patches; shape (m, 3)."""
        geometry = face_geometry(positions, self.topology.faces)
        return self.guided_normals(positions, patch_guidance(geometry, self.topology, self._inner), sigma_r)

    def guided_normals(self, positions: Positions, guide: Floats, sigma_r: float) -> Floats:
        """Face normals filtered once, under guidance normals of shape (m, 3) from elsewhere."""
        geometry = face_geometry(positions, self.topology.faces)
        sigma_s = mean_centroid_distance(geometry.centroids, self.topology.pairs)
        return filter_normals(geometry, guide, self._near, sigma_s, sigma_r)

    def follow(self, positions: Positions, normals: Floats) -> Positions:
        """Positions after the vertex updates that belong to one iteration."""
        return follow_normals(positions, self.topology, normals, VERTEX_ITERATIONS)

    def step(self, positions: Positions) -> Positions:
        """Positions after one iteration: filter the normals, then let the vertices follow."""
        return self.follow(positions, self.normals(positions))


def guided_normal_filtering(positions: Positions, faces: Faces, iterations: int = 20) -> Positions:
    """Denoise by guided normal filtering.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    faces : ndarray of int32, shape (m, 3)
    iterations : int
        Outer iterations, of one normal filter and ten vertex updates each.
    """
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    guided = GuidedFilter(positions, faces)
    for _ in range(iterations):
        positions = guided.step(positions)
    return positions
