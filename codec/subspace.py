"""Tracking the low-frequency subspace of each block by orthogonal iterations (paper, section 4, Algorithm 1).

U is the dictionary of a block, n_d rows and c orthonormal columns; R = (L + delta I)^-1; Onorm is the Q of a QR
factorisation with a positive diagonal, which makes Q unique and nested: its
first c columns do not depend on later ones.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.errors import NumericError
from codec.blocks import Block
from codec.laplacian import dense_laplacian, factorize, solve

Matrix = npt.NDArray[np.float64]

CLUSTER_GAP = 1e-6
"""Neighbouring eigenvalues closer than this span one eigenspace in the exact basis."""


def cosine_columns(rows: int, first: int, last: int) -> Matrix:
    """Cosines along the rows, frequencies `first` to `last - 1`: the start that needs no predecessor.

    Column j is cos(pi j (2 r + 1) / (2 n)), the eigenvectors of a path of n vertices, orthogonal to each other.
    """
    r = np.arange(rows, dtype=np.int64)[:, None]
    j = np.arange(first, last, dtype=np.int64)[None, :]
    # Reduced as integers first, so that the argument of the cosine stays small and exact.
    return np.cos(np.pi / (2 * rows) * ((2 * r + 1) * j % (4 * rows)))


def onorm(columns: Matrix) -> Matrix:
    """Q of the QR factorisation with positive diagonal of `columns`, shape (n, c), n >= c.

    Cholesky QR, twice where the first pass cannot be trusted to be orthogonal to working precision, and Householder
    reflections where the columns are so close to dependent that the Gram matrix is not safely positive definite. All
    of them compute the same Q.

    Raises
    ------
    NumericError
        If a value is not finite.
    """
    q, spread = cholesky_orthonormalize(columns)
    if 0.0 < spread < 1e2:
        return q
    if 0.0 < spread < 1e6:
        return cholesky_orthonormalize(q)[0]
    return householder_orthonormalize(columns)


def householder_orthonormalize(columns: Matrix) -> Matrix:
    """`onorm` by Householder reflections (LAPACK geqrf), for any condition number."""
    if not np.isfinite(columns).all():
        raise NumericError("the subspace iteration produced a value that is not finite")
    q, r = np.linalg.qr(columns)
    return np.ascontiguousarray(q * np.where(np.diag(r) < 0, -1.0, 1.0))


def orthogonal_iteration(block: Block, start: Matrix, *, shift: float, power: int, iterations: int) -> Matrix:
    """U(t) = Onorm(R^z U(t-1)), `iterations` times (Algorithm 1).

    Parameters
    ----------
    block : Block
        Of n rows.
    start : float64 array, shape (n, c)
        U(0); need not be orthonormal.
    shift, power, iterations
        delta, z and t_max.

    Returns
    -------
    float64 array, shape (n, c), C-contiguous
    """
    factor = factorize(block, shift)
    subspace = start
    for _ in range(iterations):
        subspace = onorm(solve(factor, subspace, power))
    return subspace


def resized(previous: Matrix, width: int) -> Matrix:
    """The start for a block of `width` columns: the predecessor's columns, and cosines where it has fewer."""
    rows, known = previous.shape
    if known >= width:
        return previous[:, :width]
    return np.concatenate([previous, cosine_columns(rows, known, width)], axis=1)


def exact_basis(block: Block, width: int) -> Matrix:
    """The `width` lowest eigenvectors of L in a form that does not depend on the eigensolver.

    Within a cluster of equal eigenvalues a solver may return any rotation; the projection of fixed pseudo-random
    columns onto the cluster's space, orthonormalised, is the same for all of them. It also fixes the signs.
    """
    values, vectors = np.linalg.eigh(dense_laplacian(block))
    starts = np.flatnonzero(np.diff(values, prepend=-np.inf) > CLUSTER_GAP)
    ends = np.append(starts[1:], len(values))
    probe = hash_columns(block.size, int((ends - starts).max()))
    basis = np.empty((block.size, width))
    for first, last in zip(starts, ends):
        if first >= width:
            break
        cluster = vectors[:, first:last]
        canonical = householder_orthonormalize(cluster @ (cluster.T @ probe[:, : last - first]))
        basis[:, first : min(last, width)] = canonical[:, : width - first]
    return basis


def hash_columns(rows: int, columns: int) -> Matrix:
    """Fixed pseudo-random numbers in [-1, 1), shape (rows, columns): the splitmix64 of row * 2^32 + column."""
    row = np.arange(rows, dtype=np.uint64)[:, None]
    column = np.arange(columns, dtype=np.uint64)[None, :]
    with np.errstate(over="ignore"):
        z = (row * np.uint64(1 << 32) + column + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        z = z ^ (z >> np.uint64(31))
    return (z >> np.uint64(11)).astype(np.float64) * 2.0**-52 - 1.0


@njit(cache=True, nogil=True)
def cholesky_orthonormalize(columns):  # type: ignore[no-untyped-def]
    """One pass of Cholesky QR: Q = X C^-T with X^T X = C C^T; also the spread of C's diagonal, 0 where it failed.

    The inverse of the small factor is formed so that the large product is one matrix multiplication.
    """
    c = columns.shape[1]
    gram = np.dot(columns.T, columns)
    largest, smallest = 0.0, np.inf
    for j in range(c):
        for k in range(j):
            value = gram[j, k]
            for i in range(k):
                value -= gram[j, i] * gram[k, i]
            gram[j, k] = value / gram[k, k]
        value = gram[j, j]
        for i in range(j):
            value -= gram[j, i] * gram[j, i]
        if not value > 0.0:
            return columns, 0.0
        gram[j, j] = np.sqrt(value)
        largest = max(largest, gram[j, j])
        smallest = min(smallest, gram[j, j])
    inverse = np.zeros((c, c))
    for j in range(c):
        inverse[j, j] = 1.0 / gram[j, j]
        for k in range(j):
            value = 0.0
            for i in range(k, j):
                value -= gram[j, i] * inverse[k, i]
            inverse[k, j] = value / gram[j, j]
    return np.dot(columns, inverse), largest / smallest
