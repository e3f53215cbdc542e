"""Centroids, areas and normals of faces, and vertices that follow given normals."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.denoise.filters.topology import Mask, Topology
from codec.geometry.graph import Indices
from codec.geometry.incidence import Rows
from codec.geometry.mesh import Faces, Positions

Floats = npt.NDArray[np.float64]


class FaceGeometry(NamedTuple):
    """Centroids (m, 3), areas (m,) and unit normals (m, 3) of the faces; a face without area has normal zero."""

    centroids: Floats
    areas: Floats
    normals: Floats


def face_geometry(positions: Positions, faces: Faces) -> FaceGeometry:
    """Centroids, areas and unit normals of the faces."""
    return FaceGeometry(*_face_geometry(positions, faces))


def vertex_normals(normals: Floats, around: Rows) -> Floats:
    """Unit vertex normals: the plain mean of the normals of the faces around; zero where they cancel."""
    averaged: Floats = _vertex_normals(normals, around.starts, around.members)
    return averaged


def mean_centroid_distance(centroids: Floats, pairs: Indices) -> float:
    """Mean distance between the centroids of faces that share an edge; 1 where that is zero or no two do."""
    return _mean_distance(centroids, pairs) or 1.0


def follow_normals(
    positions: Positions,
    topology: Topology,
    normals: Floats,
    iterations: int,
    free: Mask | None = None,
) -> Positions:
    """Move the vertices until the faces agree with given normals (Sun et al. 2007; equation `iter1` of the paper).

    Every iteration moves each vertex by the mean, over its faces, of its offset from the plane through the face's
    centroid with the given normal.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    topology : Topology
    normals : ndarray of float64, shape (m, 3)
        Unit normals; a zero normal pulls nowhere.
    iterations : int
    free : ndarray of bool, shape (n,), optional
        Vertices that may move; all of them if absent.
    """
    if free is None:
        free = np.ones(len(positions), dtype=np.bool_)
    moved: Positions = _follow_normals(
        positions, topology.faces, topology.around.starts, topology.around.members, normals, iterations, free
    )
    return moved


@njit(cache=True, nogil=True)
def _face_geometry(positions, faces):  # type: ignore[no-untyped-def]
    m = len(faces)
    centroids, areas, normals = np.empty((m, 3)), np.empty(m), np.zeros((m, 3))
    for f in range(m):
        a, b, c = positions[faces[f, 0]], positions[faces[f, 1]], positions[faces[f, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = math.sqrt(x * x + y * y + z * z)
        areas[f] = 0.5 * length
        if length > 0.0:
            normals[f, 0], normals[f, 1], normals[f, 2] = x / length, y / length, z / length
        for axis in range(3):
            centroids[f, axis] = (a[axis] + b[axis] + c[axis]) / 3.0
    return centroids, areas, normals


@njit(cache=True, nogil=True)
def _vertex_normals(normals, starts, around):  # type: ignore[no-untyped-def]
    averaged = np.zeros((len(starts) - 1, 3))
    for v in range(len(starts) - 1):
        x = y = z = 0.0
        for k in range(starts[v], starts[v + 1]):
            x += normals[around[k], 0]
            y += normals[around[k], 1]
            z += normals[around[k], 2]
        length = math.sqrt(x * x + y * y + z * z)
        if length > 0.0:
            averaged[v, 0], averaged[v, 1], averaged[v, 2] = x / length, y / length, z / length
    return averaged


@njit(cache=True, nogil=True)
def _mean_distance(centroids, pairs):  # type: ignore[no-untyped-def]
    total = 0.0
    for k in range(len(pairs)):
        a, b = centroids[pairs[k, 0]], centroids[pairs[k, 1]]
        total += math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
    return total / len(pairs) if len(pairs) else 0.0


@njit(cache=True, nogil=True)
def _follow_normals(positions, faces, starts, around, normals, iterations, free):  # type: ignore[no-untyped-def]
    current = positions.copy()
    offset = np.empty(len(faces))
    for _ in range(iterations):
        for f in range(len(faces)):
            a, b, c = current[faces[f, 0]], current[faces[f, 1]], current[faces[f, 2]]
            n = normals[f]
            offset[f] = (n[0] * (a[0] + b[0] + c[0]) + n[1] * (a[1] + b[1] + c[1]) + n[2] * (a[2] + b[2] + c[2])) / 3.0
        for v in range(len(current)):
            first, last = starts[v], starts[v + 1]
            if first == last or not free[v]:
                continue
            px, py, pz = current[v]
            x = y = z = 0.0
            for k in range(first, last):
                f = around[k]
                nx, ny, nz = normals[f, 0], normals[f, 1], normals[f, 2]
                height = offset[f] - (nx * px + ny * py + nz * pz)
                x += nx * height
                y += ny * height
                z += nz * height
            scale = 1.0 / (last - first)
            current[v, 0] = px + x * scale
            current[v, 1] = py + y * scale
            current[v, 2] = pz + z * scale
    return current
