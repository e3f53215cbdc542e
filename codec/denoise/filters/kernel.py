"""Joint bilateral filter of face normals (section 7.2 of the paper, equations 9 to 11)."""

from __future__ import annotations

import numpy as np

from bsm.codec import _kernels
from bsm.codec.denoise.filters.vertex_update import FaceGeometry, Floats
from bsm.codec.geometry.incidence import Rows


def filter_normals(geometry: FaceGeometry, guide: Floats, near: Rows, sigma_s: float, sigma_r: float) -> Floats:
    """Average each face's normal with its neighbours', by area, distance and likeness of the guide."""
    filtered = np.empty_like(geometry.normals)
    _kernels.filter_normals(*geometry, guide, near.starts, near.members, sigma_s, sigma_r, filtered)
    return filtered
