"""Centroids, areas and normals of faces, and vertices that follow given normals."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Indices, Positions
from bsm.codec.denoise.filters.topology import Mask, Topology
from bsm.codec.geometry.incidence import Rows

Floats = npt.NDArray[np.float64]


class FaceGeometry(NamedTuple):
    """Centroids (m, 3), areas (m,) and unit normals (m, 3) of the faces; a face without area has normal zero."""

    centroids: Floats
    areas: Floats
    normals: Floats


def face_geometry(positions: Positions, faces: Faces) -> FaceGeometry:
    """Centroids, areas and unit normals of `faces`, shape (m, 3), on `positions`, shape (n, 3)."""
    m = len(faces)
    geometry = FaceGeometry(np.empty((m, 3)), np.empty(m), np.empty((m, 3)))
    _kernels.face_geometry(
        np.ascontiguousarray(positions, np.float64), np.ascontiguousarray(faces, np.int32), *geometry
    )
    return geometry


def vertex_normals(normals: Floats, around: Rows) -> Floats:
    """Unit vertex normals, shape (n, 3): the plain mean of the normals, shape (m, 3), of the faces around."""
    averaged = np.empty((len(around.starts) - 1, 3))
    _kernels.vertex_normals(normals, around.starts, around.members, averaged)
    return averaged


def pair_distances(values: Floats, pairs: Indices) -> Floats:
    """How far the rows of `values`, shape (m, 3), that each of `pairs`, shape (e, 2), names are from each other."""
    distances = np.empty(len(pairs))
    _kernels.pair_distances(values, pairs, distances)
    return distances


def mean_centroid_distance(centroids: Floats, pairs: Indices) -> float:
    """Mean distance between the centroids, shape (m, 3), of faces that share an edge, `pairs`, shape (e, 2)."""
    if len(pairs) == 0:
        return 1.0
    return float(pair_distances(centroids, pairs).mean()) or 1.0


def follow_normals(
    positions: Positions,
    topology: Topology,
    normals: Floats,
    iterations: int,
    free: Mask | None = None,
) -> Positions:
    """Move the vertices until the faces agree with given normals (Sun et al. 2007; equations 12 and 13 of the paper)"""
    if free is None:
        free = np.ones(len(positions), dtype=np.bool_)
    moved = np.array(positions, dtype=np.float64)
    offsets = np.empty(len(topology.faces))
    _kernels.follow_normals(
        moved, topology.faces, *topology.around, normals, iterations, free.astype(np.uint8), offsets
    )
    return moved
