"""Joint bilateral filter of face normals (section 7.2 of the paper, equations 9 to 11)."""

from __future__ import annotations

import numpy as np

from bsm.codec import _kernels
from bsm.codec.denoise.filters.vertex_update import FaceGeometry, Floats
from bsm.codec.geometry.incidence import Rows


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
    filtered = np.empty_like(geometry.normals)
    _kernels.filter_normals(*geometry, guide, near.starts, near.members, sigma_s, sigma_r, filtered)
    return filtered
