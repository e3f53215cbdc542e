"""Fast and effective feature-preserving mesh denoising (Sun, Rosin, Martin, Langbein 2007)."""

from __future__ import annotations

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.filters.vertex_update import face_geometry, follow_normals

THRESHOLD = 0.5
VERTEX_ITERATIONS = 50
"""The authors' values."""


def fast_effective_denoising(positions: Positions, faces: Faces, iterations: int = 20) -> Positions:
    """Denoise by thresholded averages of normals, then let the vertices follow; the boundary stays."""
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    normals = face_geometry(positions, topology.faces).normals
    for _ in range(iterations):
        averaged = np.empty_like(normals)
        _kernels.average_alike(normals, *topology.patches, THRESHOLD, averaged)
        normals = averaged
    return follow_normals(positions, topology, normals, VERTEX_ITERATIONS, ~topology.boundary)
