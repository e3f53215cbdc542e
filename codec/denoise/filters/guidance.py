"""Patch guidance of guided normal filtering (Zhang, Deng, Zhang, Bouaziz, Liu 2015).

Every face looks at the patches it belongs to and takes the mean normal of the most consistent one. A patch is a face
with all faces that share a vertex with it; it is consistent if its normals lie close together (small range) and its
differences are spread over many inner edges instead of one crease.
"""

from __future__ import annotations

import numpy as np

from bsm.codec import _kernels
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.filters.vertex_update import FaceGeometry, Floats, pair_distances


def patch_guidance(geometry: FaceGeometry, topology: Topology) -> Floats:
    """Guidance normal of each face: the mean normal of the most consistent patch that holds the face."""
    patches, inner = topology.patches, topology.inner
    normals = geometry.normals
    steps = pair_distances(normals, topology.pairs)
    scores, means, guide = np.empty(len(normals)), np.empty_like(normals), np.empty_like(normals)
    _kernels.patch_scores(normals, geometry.areas, *patches, steps, *inner, scores, means)
    _kernels.most_consistent(scores, means, *patches, guide)
    return guide
