"""From positions to the coefficients of a subspace and back (paper, section 4): E = U^T V and V = U E.

Products this thin gain nothing from BLAS, and summed in a fixed order they are the same to the last bit everywhere.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

Matrix = npt.NDArray[np.float64]


def project(subspace: Matrix, positions: Matrix) -> Matrix:
    """E = U^T V, shape (c, 3), for U of shape (n, c) and V of shape (n, 3)."""
    coefficients: Matrix = _project(subspace, positions)
    return coefficients


def reconstruct(subspace: Matrix, coefficients: Matrix) -> Matrix:
    """V = U E, shape (n, 3); U may have more columns than E, shape (c, 3), has rows: the first c count."""
    positions: Matrix = _reconstruct(subspace, coefficients)
    return positions


@njit(cache=True, nogil=True)
def _project(subspace, positions):  # type: ignore[no-untyped-def]
    n, c = subspace.shape
    sums = np.zeros((3, c))
    for r in range(n):
        for d in range(3):
            for j in range(c):
                sums[d, j] += subspace[r, j] * positions[r, d]
    return sums.T.copy()


@njit(cache=True, nogil=True)
def _reconstruct(subspace, coefficients):  # type: ignore[no-untyped-def]
    n, c = len(subspace), len(coefficients)
    positions = np.empty((n, 3))
    for r in range(n):
        # Sums over even and odd columns, so that an addition need not wait for the one before.
        x, y, z = 0.0, 0.0, 0.0
        p, q, s = 0.0, 0.0, 0.0
        for j in range(0, c - 1, 2):
            x += subspace[r, j] * coefficients[j, 0]
            y += subspace[r, j] * coefficients[j, 1]
            z += subspace[r, j] * coefficients[j, 2]
            p += subspace[r, j + 1] * coefficients[j + 1, 0]
            q += subspace[r, j + 1] * coefficients[j + 1, 1]
            s += subspace[r, j + 1] * coefficients[j + 1, 2]
        if c % 2 > 0:
            x += subspace[r, c - 1] * coefficients[c - 1, 0]
            y += subspace[r, c - 1] * coefficients[c - 1, 1]
            z += subspace[r, c - 1] * coefficients[c - 1, 2]
        positions[r, 0], positions[r, 1], positions[r, 2] = x + p, y + q, z + s
    return positions
