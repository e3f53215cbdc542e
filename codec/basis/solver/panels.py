"""Tall matrices in panels of `LANES` columns, and their Cholesky QR.

A matrix of n rows and c columns is an array of shape (p, m, LANES): panel b holds columns b LANES to (b + 1) LANES of
all rows, one row after the other, so that work on a panel stays near the processor. Columns beyond c and rows from n
to m, a multiple of four above n, are zero. Small upper triangular matrices are kept alike, m being p LANES.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from codec.basis.solver.simd import LANES, add_scaled, aligned, filled, load, scaled, store

_LANES = np.uint64(LANES)
_ONE, _TWO, _THREE, _FOUR = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)


@njit(cache=True, nogil=True)
def pack(columns, order):  # type: ignore[no-untyped-def]
    """Panels whose row k is row `order[k]` of `columns`, shape (n, c)."""
    n, c = columns.shape
    count, m = -(-c // LANES), (n // 4 + 1) * 4
    panels = aligned(count * m * LANES).reshape(count, m, LANES)
    panels[:] = 0.0
    for b in range(count):
        first, width = b * LANES, min(LANES, c - b * LANES)
        for k in range(n):
            for j in range(width):
                panels[b, k, j] = columns[order[k], first + j]
    return panels


@njit(cache=True, nogil=True)
def unpack(panels, order, c):  # type: ignore[no-untyped-def]
    """Inverse of `pack`."""
    columns = np.empty((len(order), c))
    for b in range(panels.shape[0]):
        first, width = b * LANES, min(LANES, c - b * LANES)
        for k in range(len(order)):
            for j in range(width):
                columns[order[k], first + j] = panels[b, k, j]
    return columns


@njit(cache=True, nogil=True)
def gram(panels):  # type: ignore[no-untyped-def]
    """X^T X of a matrix X, the panels on and above the diagonal."""
    count, m = panels.shape[0], panels.shape[1]
    product = aligned(count * count * LANES * LANES).reshape(count, count * LANES, LANES)
    for b in range(count):
        right = panels[b].reshape(-1)
        for a in range(b + 1):
            left = panels[a].reshape(-1)
            result = product[b, a * LANES : (a + 1) * LANES].reshape(-1)
            for i in range(np.uint64(0), _LANES, _FOUR):
                # Four rows of the product at a time, in registers.
                s0, s1, s2, s3 = filled(0.0), filled(0.0), filled(0.0), filled(0.0)
                for r in range(np.uint64(0), np.uint64(m) * _LANES, _LANES):
                    row = load(right, r)
                    s0 = add_scaled(s0, left[r + i], row)
                    s1 = add_scaled(s1, left[r + i + _ONE], row)
                    s2 = add_scaled(s2, left[r + i + _TWO], row)
                    s3 = add_scaled(s3, left[r + i + _THREE], row)
                store(result, i * _LANES, s0)
                store(result, (i + _ONE) * _LANES, s1)
                store(result, (i + _TWO) * _LANES, s2)
                store(result, (i + _THREE) * _LANES, s3)
    return product


@njit(cache=True, nogil=True)
def multiply(panels, triangle):  # type: ignore[no-untyped-def]
    """X T of a matrix X and an upper triangular T."""
    count, m = panels.shape[0], panels.shape[1]
    product = aligned(panels.size).reshape(panels.shape)
    x = panels.reshape(-1)
    for b in range(count):
        t = triangle[b].reshape(-1)
        result = product[b].reshape(-1)
        for r in range(np.uint64(0), np.uint64(m) * _LANES, _FOUR * _LANES):
            s0, s1, s2, s3 = filled(0.0), filled(0.0), filled(0.0), filled(0.0)
            for a in range(np.uint64(b + 1)):
                first = a * np.uint64(m) * _LANES + r
                for i in range(_LANES):
                    row = load(t, (a * _LANES + i) * _LANES)
                    s0 = add_scaled(s0, x[first + i], row)
                    s1 = add_scaled(s1, x[first + i + _LANES], row)
                    s2 = add_scaled(s2, x[first + i + _TWO * _LANES], row)
                    s3 = add_scaled(s3, x[first + i + _THREE * _LANES], row)
            store(result, r, s0)
            store(result, r + _LANES, s1)
            store(result, r + _TWO * _LANES, s2)
            store(result, r + _THREE * _LANES, s3)
    return product


@njit(cache=True, nogil=True)
def factorize_gram(product, c):  # type: ignore[no-untyped-def]
    """Overwrite the first c rows of G = X^T X by the upper triangular C with G = C^T C (Cholesky).

    Returns the least squared sine of the angle between a column of X and the space of those before it; 0 if C could
    not be computed. It is what limits the accuracy of X C^-1: the lengths of the columns do not.
    """
    count, rows = product.shape[0], product.shape[1]
    g = product.reshape(-1)
    independence = 1.0
    for j in range(c):
        own = (j // LANES) * rows * LANES + j % LANES
        before = g[own + j * LANES]
        for b in range(j // LANES, count):
            base = b * rows * LANES
            row = load(g, base + j * LANES)
            for k in range(j):
                row = add_scaled(row, -g[own + k * LANES], load(g, base + k * LANES))
            store(g, base + j * LANES, row)
        pivot = g[own + j * LANES]
        if not 0.0 < pivot < np.inf:
            return 0.0
        independence = min(independence, pivot / before)
        for b in range(j // LANES, count):
            base = b * rows * LANES
            store(g, base + j * LANES, scaled(load(g, base + j * LANES), 1.0 / np.sqrt(pivot)))
    return independence


@njit(cache=True, nogil=True)
def invert_triangle(triangle, c):  # type: ignore[no-untyped-def]
    """Inverse of an upper triangular matrix of c rows; what `triangle` holds below its diagonal is ignored."""
    count, rows = triangle.shape[0], triangle.shape[1]
    inverse = aligned(triangle.size).reshape(triangle.shape)
    inverse[:] = 0.0
    t, result = triangle.reshape(-1), inverse.reshape(-1)
    for j in range(c - 1, -1, -1):
        own = (j // LANES) * rows * LANES + j * LANES + j % LANES
        scale = 1.0 / t[own]
        for b in range(j // LANES, count):
            base = b * rows * LANES
            row = filled(0.0)
            for k in range(j + 1, min(c, (b + 1) * LANES)):
                entry = t[(k // LANES) * rows * LANES + j * LANES + k % LANES]
                row = add_scaled(row, -entry * scale, load(result, base + k * LANES))
            store(result, base + j * LANES, row)
        result[own] = scale
    return inverse
