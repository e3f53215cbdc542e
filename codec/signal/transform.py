"""From positions to the coefficients of a subspace and back (paper, section 4): E = U^T V and V = U E.

Products this thin gain nothing from BLAS, and summed in a fixed order they are the same to the last bit everywhere,
whatever the width of the matrix whose first columns they take.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

Matrix = npt.NDArray[np.float64]


def project(subspace: Matrix, values: Matrix, count: int) -> Matrix:
    """E = U^T V, shape (count, d) or (count,), for the first `count` columns U of `subspace`, shape (n, c).

    V has shape (n, d) or (n,).
    """
    coefficients: Matrix = _project(subspace, values.reshape(len(values), math.prod(values.shape[1:])), count)
    return coefficients.reshape(count, *values.shape[1:])


def reconstruct(subspace: Matrix, coefficients: Matrix) -> Matrix:
    """V = U E, shape (n, d) or (n,), for E of shape (c, d) or (c,); U is the first c columns of `subspace`."""
    values: Matrix = _reconstruct(subspace, coefficients.reshape(len(coefficients), math.prod(coefficients.shape[1:])))
    return values.reshape(len(subspace), *coefficients.shape[1:])


@njit(cache=True, nogil=True)
def _project(subspace, values, count):  # type: ignore[no-untyped-def]
    sums = np.zeros((values.shape[1], count))
    for r in range(len(subspace)):
        for d in range(values.shape[1]):
            for j in range(count):
                sums[d, j] += subspace[r, j] * values[r, d]
    return sums.T.copy()


@njit(cache=True, nogil=True)
def _reconstruct(subspace, coefficients):  # type: ignore[no-untyped-def]
    c, width = coefficients.shape
    values = np.empty((len(subspace), width))
    last = np.uint64(len(subspace) - 1)
    for first in range(np.uint64(0), np.uint64(len(subspace)), np.uint64(4)):
        # Four rows at a time (the last one again and again at the end): an addition need not wait for the one before.
        i, j = first, min(first + np.uint64(1), last)
        k, m = min(first + np.uint64(2), last), min(first + np.uint64(3), last)
        for d in range(np.uint64(width)):
            s, t, u, v = 0.0, 0.0, 0.0, 0.0
            for q in range(np.uint64(c)):
                e = coefficients[q, d]
                s += subspace[i, q] * e
                t += subspace[j, q] * e
                u += subspace[k, q] * e
                v += subspace[m, q] * e
            values[i, d], values[j, d], values[k, d], values[m, d] = s, t, u, v
    return values
