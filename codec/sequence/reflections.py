"""Columns at right angles to each other, told by what is free in them.

References
----------
A. S. Householder, "Unitary triangularization of a nonsymmetric matrix", 1958; T. Joffrain et al., "Accumulating
Householder transformations, revisited", 2006 (many reflections at once).
"""

from __future__ import annotations

import numpy as np

from bsm.codec.arrays import Matrix

TOGETHER = 32
"""Reflections that are made at once: fewer take longer, more take more memory."""
LEAST = 1e-9
"""Of a column's length on the diagonal, at least: below 0 it would be another reflection."""


def free_of(columns: Matrix) -> Matrix:
    """What is free in columns, shape (n, r) with r <= n: zeros above the diagonal, and nothing negative on it."""
    if not columns.size:
        return columns.copy()
    packed, factors = np.linalg.qr(columns, mode="raw")  # vectors are 1 on the diagonal, where lengths stand instead
    lengths = np.diagonal(packed)
    # Of a diagonal that rounding has made 0 the length tells the sign: where it is reflected, it is the other one.
    negative = np.where(factors > 0.0, lengths > 0.0, lengths < 0.0)
    free = np.tril(packed.T, -1) * (-lengths * factors) * np.where(negative, -1.0, 1.0)
    np.fill_diagonal(free, np.maximum(np.abs(lengths * (1.0 - factors)), LEAST * np.abs(lengths)))
    return np.asarray(free)


def columns_of(free: Matrix) -> Matrix:
    """Columns at right angles, shape (n, r), of what is free in them; zeros are columns of nothing."""
    columns = free.copy()
    for first in reversed(range(0, free.shape[1], TOGETHER)):
        own = slice(first, first + TOGETHER)
        vectors = free[:, own].copy()
        diagonal, lengths = np.diagonal(vectors[first:]), np.sqrt(np.square(vectors).sum(axis=0))
        np.fill_diagonal(vectors[first:], diagonal + np.where(diagonal < 0.0, -lengths, lengths))
        products = vectors.T @ vectors
        halves = 0.5 * np.diagonal(products)
        turned = np.triu(products, 1) + np.diag(np.where(halves > 0.0, halves, 1.0))
        wanted = vectors.T @ columns[:, first:]
        wanted[:, : len(turned)] = np.triu(wanted[:, : len(turned)], 1)
        columns[:, first:] -= vectors @ np.linalg.solve(turned, wanted)
    return columns
