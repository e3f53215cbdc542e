"""Tracking the low-frequency subspace of each block by orthogonal iterations (paper, section 4, Algorithm 1).

U is the dictionary of a block, n_d rows and c orthonormal columns; R = (L + delta I)^-1; Onorm is the Q of a QR
factorisation with a positive diagonal, which makes Q unique and nested: its
first c columns do not depend on later ones.
"""

from __future__ import annotations

import numpy as np

from bitstream.errors import NumericError
from codec import _kernels
from codec.arrays import Matrix
from codec.basis.laplacian import Laplacian, check_rows, dense_laplacian, factorize, solve
from codec.blocks.overlap import Block
from codec.threads import SINGLE_BLAS_THREAD

ONCE, TWICE = 1e-3, 1e-11
"""Independence of the columns (`factorize_gram` of solver/cholesky_qr.c) from which Cholesky QR is orthogonal to
1e-12 after one pass, and to working precision after two."""

CLUSTER_GAP = 1e-6
"""Neighbouring eigenvalues closer than this span one eigenspace in the exact basis."""


def cosine_columns(rows: int, first: int, last: int) -> Matrix:
    """Cosines along the rows, frequencies `first` to `last - 1`: the start that needs no predecessor.

    Column j is cos(pi j (2 r + 1) / (2 n)), the eigenvectors of a path of n vertices, orthogonal to each other.
    """
    columns, table = np.empty((rows, last - first)), np.empty(rows + 8)
    _kernels.cosines(first, table, columns)
    return columns


def onorm(columns: Matrix) -> Matrix:
    """Q of the QR factorisation with positive diagonal of `columns`, shape (n, c), n >= c.

    Cholesky QR; twice where the columns are so close to dependent that once would not be orthogonal to working
    precision, and Householder reflections where that is not safe either. All of them compute the same Q.

    Raises
    ------
    NumericError
        If a value is not finite.
    """
    q, scratch = np.empty(columns.shape), np.empty(_kernels.iteration_space(*columns.shape))
    independence = _kernels.cholesky_onorm(np.ascontiguousarray(columns), ONCE, scratch, q)
    return q if independence >= TWICE else householder_orthonormalize(columns)


def householder_orthonormalize(columns: Matrix) -> Matrix:
    """`onorm` by Householder reflections, for any condition number."""
    if not np.isfinite(columns).all():
        raise NumericError("the subspace iteration produced a value that is not finite")
    q = np.empty(columns.shape)
    _kernels.householder(np.array(columns, order="C"), np.empty(3 * columns.shape[1]), q)
    return q


def orthogonal_iteration(
    laplacian: Laplacian, start: Matrix, *, shift: float | Matrix, power: int, iterations: int
) -> Matrix:
    """U(t) = Onorm(R^z U(t-1)), `iterations` times (Algorithm 1).

    Parameters
    ----------
    laplacian : Laplacian
        Of a block of n rows.
    start : float64 array, shape (n, c)
        U(0); need not be orthonormal.
    shift : float, or float64 array, shape (n,)
        delta, or the diagonal that takes the place of delta I.
    power, iterations : int
        z and t_max.

    Returns
    -------
    float64 array, shape (n, c), C-contiguous
    """
    factor = factorize(laplacian, shift)
    start = np.ascontiguousarray(start)
    check_rows(factor, len(start))
    subspace, scratch = np.empty(start.shape), np.empty(_kernels.iteration_space(*start.shape))
    independence = _kernels.iterate(
        factor.fronts, factor.values, factor.inverse, start, power, iterations, ONCE, scratch, subspace
    )
    if independence < TWICE:
        # R^z has all but lost the higher columns. Orthonormalised after every R they stay, and the subspaces of the
        # first columns, which is all that Q depends on, are the same.
        subspace = start
        for _ in range(iterations * power):
            subspace = onorm(solve(factor, subspace, 1))
    return subspace


def resized(previous: Matrix, width: int) -> Matrix:
    """The start for a block of `width` columns: the predecessor's columns, and cosines where it has fewer."""
    rows, known = previous.shape
    if known >= width:
        return previous[:, :width]
    return np.concatenate([previous, cosine_columns(rows, known, width)], axis=1)


def exact_basis(block: Block, width: int, springs: float | Matrix = 0.0) -> Matrix:
    """The `width` lowest eigenvectors of L + diag(springs), see `canonical_eigenvectors`."""
    return canonical_eigenvectors(dense_laplacian(block) + springs * np.eye(block.size), width)[1]


def canonical_eigenvectors(matrix: Matrix, width: int) -> tuple[Matrix, Matrix]:
    """The `width` lowest eigenvalues and eigenvectors of a symmetric matrix, whatever the eigensolver.

    Within a cluster of equal eigenvalues a solver may return any rotation; the projection of fixed pseudo-random
    columns onto the cluster's space, orthonormalised, is the same for all of them. For an eigenvalue of its own this
    is its eigenvector with the sign that makes its product with the first of these columns positive.

    Returns
    -------
    values : float64 array, shape (width,)
    vectors : float64 array, shape (n, width), C-contiguous
    """
    with SINGLE_BLAS_THREAD:
        values, vectors = np.linalg.eigh(matrix)
    starts = np.flatnonzero(np.diff(values, prepend=-np.inf) > CLUSTER_GAP)
    ends = np.append(starts[1:], len(values))
    probe = hash_columns(len(matrix), int((ends - starts).max()))
    basis = vectors[:, :width] * np.where(probe[:, 0] @ vectors[:, :width] < 0, -1.0, 1.0)
    shared = (ends - starts > 1) & (starts < width)
    for first, last in zip(starts[shared], ends[shared]):
        cluster = vectors[:, first:last]
        canonical = householder_orthonormalize(cluster @ (cluster.T @ probe[:, : last - first]))
        basis[:, first:last] = canonical[:, : width - first]
    return values[:width], np.ascontiguousarray(basis)


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
