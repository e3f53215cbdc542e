"""Bilateral normal filtering, local scheme (Zheng, Fu, Au, Tai 2011)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise.filters.kernel import filter_normals
from bsm.codec.denoise.filters.topology import Topology, without_first
from bsm.codec.denoise.filters.vertex_update import FaceGeometry, face_geometry, follow_normals, mean_centroid_distance

SIGMA_R = 0.35
VERTEX_ITERATIONS = 10
PATIENT_VERTICES = 20
"""Vertex updates where nothing hurries; half as many leave 0.2 % more of the angle, twice as many the same
(tools.constants)."""
AT_ONCE = 2


def bilateral_normal_filtering(positions: Positions, faces: Faces, iterations: int = 20) -> Positions:
    """Denoise by bilateral filtering of the normals over faces that share a vertex; the boundary stays."""
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    geometry = face_geometry(positions, topology.faces)
    filtering = _normals(geometry, topology, SIGMA_R)
    for _ in range(iterations):
        geometry = next(filtering)
    return follow_normals(positions, topology, geometry.normals, VERTEX_ITERATIONS, ~topology.boundary)


def filtered_normals(positions: Positions, topology: Topology, sigma_r: float) -> Iterator[Positions]:
    """The positions, shape (n, 3), after 0, 1, 2, ... times two iterations of the filter and twenty vertex updates."""
    geometry = face_geometry(positions, topology.faces)
    filtering = _normals(geometry, topology, sigma_r)
    while True:
        yield follow_normals(positions, topology, geometry.normals, PATIENT_VERTICES, ~topology.boundary)
        for _ in range(AT_ONCE):
            geometry = next(filtering)


def _normals(geometry: FaceGeometry, topology: Topology, sigma_r: float) -> Iterator[FaceGeometry]:
    """The geometry with normals filtered 1, 2, ... times."""
    others = without_first(topology.patches)
    sigma_s = mean_centroid_distance(geometry.centroids, topology.pairs)
    while True:
        geometry = geometry._replace(normals=filter_normals(geometry, geometry.normals, others, sigma_s, sigma_r))
        yield geometry
