"""Polygons cut into triangles."""

from __future__ import annotations

import numpy as np

from bsm.files.census import Doubles, Ints

_MOST_TURNS = 64


def triangulate(positions: Doubles, sizes: Ints, corners: Ints) -> tuple[Ints, int]:
    """Cut polygons into triangles, in the order of the polygons.

    A polygon becomes the fan around its first corner; where a triangle of that fan faces the other way than the polygon
    (which is then not convex), around the first corner that gives no such triangle.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    sizes : ndarray of int64, shape (p,)
        Corners of each polygon; those with fewer than three give no triangle.
    corners : ndarray of int64, shape (sum(sizes),)
        Vertex indices, legal.

    Returns
    -------
    triangles : ndarray of int64, shape (m, 3)
    folded : int
        Number of polygons that no corner sees as a whole: their triangles overlap.
    """
    if (sizes == 3).all():
        return corners.reshape(-1, 3), 0
    positions = positions / max(float(np.abs(positions).max()), 1e-300)  # so that no product overflows
    pieces = np.maximum(sizes - 2, 0)
    first = np.cumsum(sizes) - sizes
    owner = np.repeat(np.arange(len(sizes)), pieces)
    step = np.arange(len(owner)) - np.repeat(np.cumsum(pieces) - pieces, pieces)

    def fans(rows: Ints, turn: int) -> Ints:
        polygon = owner[rows]
        places = np.column_stack([np.zeros_like(rows), step[rows] + 1, step[rows] + 2]) + turn
        return corners[first[polygon][:, None] + places % sizes[polygon][:, None]]

    triangles = fans(np.arange(len(owner)), 0)
    vectors = _area_vectors(positions, triangles)
    normals = np.column_stack([np.bincount(owner, weights=axis, minlength=len(sizes)) for axis in vectors.T])

    def folded(rows: Ints, candidates: Ints) -> Ints:
        against = (_area_vectors(positions, candidates) * normals[owner[rows]]).sum(axis=1) < 0
        return np.unique(owner[rows[against]])

    bad = folded(np.arange(len(owner)), triangles)
    for turn in range(1, min(int(sizes.max(initial=0)), _MOST_TURNS)):
        if len(bad) == 0:
            break
        rows = np.flatnonzero(np.isin(owner, bad[sizes[bad] > turn]))
        candidates = fans(rows, turn)
        good = ~np.isin(owner[rows], folded(rows, candidates))
        triangles[rows[good]] = candidates[good]
        bad = np.setdiff1d(bad, owner[rows[good]])
    return triangles, len(bad)


def _area_vectors(positions: Doubles, triangles: Ints) -> Doubles:
    a, b, c = positions[triangles[:, 0]], positions[triangles[:, 1]], positions[triangles[:, 2]]
    return np.cross(b - a, c - a)
