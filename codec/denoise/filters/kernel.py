"""Joint bilateral filter of face normals (section 7.2 of the paper, equations `BF`, `Wm` and `Wn`)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from codec.denoise.filters.vertex_update import FaceGeometry, Floats
from codec.geometry.incidence import Rows


def filter_normals(geometry: FaceGeometry, guide: Floats, near: Rows, sigma_s: float, sigma_r: float) -> Floats:
    """Average each face's normal with its neighbours', by area, distance and likeness of the guide.

    Parameters
    ----------
    geometry : FaceGeometry
        Of the mesh whose normals are filtered.
    guide : ndarray of float64, shape (m, 3)
        Unit normals that the range kernel compares; `geometry.normals` itself gives the ordinary bilateral filter.
    near : Rows
        Neighbourhood of each face, as the sum should take it: with or without the face itself.
    sigma_s : float
        Width of the spatial Gaussian, a distance between centroids.
    sigma_r : float
        Width of the range Gaussian, a distance between unit vectors.

    Returns
    -------
    ndarray of float64, shape (m, 3)
        Unit normals; where all weights vanish or cancel, the normal that was there.
    """
    filtered: Floats = _filter_normals(*geometry, guide, near.starts, near.members, sigma_s, sigma_r)
    return filtered


@njit(cache=True, nogil=True)
def _filter_normals(centroids, areas, normals, guide, starts, near, sigma_s, sigma_r):  # type: ignore[no-untyped-def]
    filtered = np.empty_like(normals)
    spatial, range_ = -0.5 / (sigma_s * sigma_s), -0.5 / (sigma_r * sigma_r)
    for f in range(len(normals)):
        cx, cy, cz = centroids[f]
        gx, gy, gz = guide[f]
        x = y = z = 0.0
        for k in range(starts[f], starts[f + 1]):
            h = near[k]
            dx, dy, dz = centroids[h, 0] - cx, centroids[h, 1] - cy, centroids[h, 2] - cz
            ex, ey, ez = guide[h, 0] - gx, guide[h, 1] - gy, guide[h, 2] - gz
            # Both kernels are Gaussian, so one exponential of the sum serves.
            exponent = spatial * (dx * dx + dy * dy + dz * dz) + range_ * (ex * ex + ey * ey + ez * ez)
            weight = areas[h] * math.exp(exponent)
            x += weight * normals[h, 0]
            y += weight * normals[h, 1]
            z += weight * normals[h, 2]
        length = math.sqrt(x * x + y * y + z * z)
        if length > 0.0:
            filtered[f, 0], filtered[f, 1], filtered[f, 2] = x / length, y / length, z / length
        else:
            filtered[f] = normals[f]
    return filtered
