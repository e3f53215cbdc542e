"""Patch guidance of guided normal filtering (Zhang, Deng, Zhang, Bouaziz, Liu 2015).

Every face looks at the patches it belongs to and takes the mean normal of the most consistent one. A patch is a face
with all faces that share a vertex with it; it is consistent if its normals lie close together (small range) and its
differences are spread over many inner edges instead of one crease.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from codec.denoise.filters.topology import Topology
from codec.denoise.filters.vertex_update import FaceGeometry, Floats


def patch_guidance(geometry: FaceGeometry, topology: Topology) -> Floats:
    """Guidance normal of each face: the mean normal of the most consistent patch that holds the face.

    Parameters
    ----------
    geometry : FaceGeometry
    topology : Topology

    Returns
    -------
    ndarray of float64, shape (m, 3)
        Unit normals, zero only where a patch's normals cancel.
    """
    patches, inner = topology.patches, topology.inner
    score, mean = _patch_scores(
        geometry.normals, geometry.areas, patches.starts, patches.members, topology.pairs, inner.starts, inner.members
    )
    guide: Floats = _most_consistent(score, mean, patches.starts, patches.members)
    return guide


@njit(cache=True, nogil=True)
def _patch_scores(normals, areas, starts, members, pairs, inner_starts, inner):  # type: ignore[no-untyped-def]
    m = len(normals)
    step = np.empty(len(pairs))
    for p in range(len(pairs)):
        a, b = normals[pairs[p, 0]], normals[pairs[p, 1]]
        step[p] = math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
    score, mean = np.empty(m), np.zeros((m, 3))
    for f in range(m):
        first, last = starts[f], starts[f + 1]
        widest = 0.0
        x = y = z = 0.0
        for k in range(first, last):
            g = members[k]
            nx, ny, nz = normals[g, 0], normals[g, 1], normals[g, 2]
            x += areas[g] * nx
            y += areas[g] * ny
            z += areas[g] * nz
            for q in range(k + 1, last):
                h = members[q]
                dx, dy, dz = normals[h, 0] - nx, normals[h, 1] - ny, normals[h, 2] - nz
                widest = max(widest, dx * dx + dy * dy + dz * dz)
        total = largest = 0.0
        for k in range(inner_starts[f], inner_starts[f + 1]):
            total += step[inner[k]]
            largest = max(largest, step[inner[k]])
        score[f] = math.sqrt(widest) * largest / (total + 1e-9)
        length = math.sqrt(x * x + y * y + z * z)
        if length > 0.0:
            mean[f, 0], mean[f, 1], mean[f, 2] = x / length, y / length, z / length
    return score, mean


@njit(cache=True, nogil=True)
def _most_consistent(score, mean, starts, members):  # type: ignore[no-untyped-def]
    guide = np.empty_like(mean)
    for f in range(len(score)):
        best = members[starts[f]]
        for k in range(starts[f] + 1, starts[f + 1]):
            if score[members[k]] < score[best]:
                best = members[k]
        guide[f] = mean[best]
    return guide
