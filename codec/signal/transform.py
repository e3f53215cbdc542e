"""From positions to the coefficients of a subspace and back (paper, section 4): E = U^T V and V = U E.

Products this thin gain nothing from BLAS, and summed in a fixed order they are the same to the last bit everywhere,
whatever the width of the matrix whose first columns they take.
"""

from __future__ import annotations

import math

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Levels, Matrix


def project(subspace: Matrix, values: Matrix, count: int) -> Matrix:
    """E = U^T V, shape (count, d) or (count,), for the first `count` columns U of `subspace`, shape (n, c)."""
    if len(values) != len(subspace) or count > subspace.shape[1]:
        raise ValueError(f"{count} of {subspace.shape} coefficients of {len(values)} values")
    flat = np.ascontiguousarray(values.reshape(len(values), math.prod(values.shape[1:])))
    coefficients = np.empty((count, flat.shape[1]))
    _kernels.project(np.ascontiguousarray(subspace), flat, coefficients)
    return coefficients.reshape(count, *values.shape[1:])


def placed(prediction: Matrix, subspace: Matrix, levels: Levels, step: float) -> Matrix:
    """Prediction, shape (n, 3), plus U times the coefficients of levels, shape (c, 3), on the trellis's two grids."""
    positions = np.empty(prediction.shape)
    _kernels.place_block(prediction, subspace, levels, step / 2, np.empty(levels.size), positions)
    return positions


def reconstruct(subspace: Matrix, coefficients: Matrix) -> Matrix:
    """V = U E, shape (n, d) or (n,), for E of shape (c, d) or (c,); U is the first c columns of `subspace`."""
    if len(coefficients) > subspace.shape[1]:
        raise ValueError(f"{len(coefficients)} coefficients for {subspace.shape[1]} columns")
    flat = np.ascontiguousarray(coefficients.reshape(len(coefficients), math.prod(coefficients.shape[1:])))
    values = np.empty((len(subspace), flat.shape[1]))
    _kernels.reconstruct(np.ascontiguousarray(subspace), flat, values)
    return values.reshape(len(subspace), *coefficients.shape[1:])
