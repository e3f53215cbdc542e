"""Non-iterative, feature-preserving mesh smoothing (Jones, Durand, Desbrun 2003)."""

from __future__ import annotations

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise.filters.reach import reach
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.filters.vertex_update import face_geometry
from bsm.codec.geometry.metrics import mean_edge_length

SPATIAL = 1.0
INFLUENCE = 1.0


def non_iterative_smoothing(positions: Positions, faces: Faces, iterations: int = 1) -> Positions:
    """Denoise by a robust mean of the predictions that the faces around make for a vertex."""
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    for _ in range(iterations):
        edge = mean_edge_length(positions, faces)
        spatial, influence = SPATIAL * edge, INFLUENCE * edge
        centroids, areas, _normals = face_geometry(positions, topology.faces)
        near = reach(positions, topology.around, centroids, topology.patches, 2.0 * spatial)
        mollified = np.empty_like(positions)
        _kernels.mollify(positions, centroids, areas, *near, 0.5 * spatial, mollified)
        normals = face_geometry(mollified, topology.faces).normals
        predicted = np.empty_like(positions)
        _kernels.predict_from_planes(positions, centroids, areas, normals, *near, spatial, influence, predicted)
        positions = predicted
    return positions
