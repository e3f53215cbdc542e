"""Tracking the low-frequency subspace of each block by orthogonal iterations (paper, section 4, Algorithm 1).

U is the dictionary of a block, n_d rows and c orthonormal columns; R = (L + delta I)^-1; Onorm is the Q of a QR
factorisation with a positive diagonal, which makes Q unique and nested: its
first c columns do not depend on later ones.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from bsm.bitstream.errors import NumericError
from bsm.codec import _kernels
from bsm.codec.arrays import Matrix
from bsm.codec.basis.cost import (
    Steps,
    careful_dictionary_cost,
    completion_cost,
    dictionary_cost,
    reflection_cost,
    unpaid,
    up_to,
)
from bsm.codec.basis.laplacian import Factor, Laplacian, check_rows, factorize, solve

ONCE, TWICE = 1e-5, 1e-13
"""Independence (`factorize_gram` of the kernel) of the columns of a panel from which Cholesky QR is
orthogonal to 1e-11 after one pass; and of all columns, from which the whole is to 1e-9. Beyond that, Onorm after every
solution."""

LEAST_PIVOT = 2.0**-20
"""From which columns are completed with the accuracy that is asked for."""

EXACT_POWER, EXACT_ITERATIONS, EXACT_SHIFT = 2, 128, 2.0**-5
"""What makes a basis exact: the sum of the Rayleigh quotients of any first columns is then within a thousandth of that
of the lowest eigenvalues, on blocks of surfaces. Eigenvectors of closer eigenvalues nobody needs to tell apart."""
START_NOISE = 0.25
FOLLOWING_NOISE = 2.0**-8
"""How much of the hash columns is added to cosines, and to a predecessor's orthonormal columns, for blocks of several
components (M 8.3); half or twice of it changes bytes by nothing, and by 0.3 % at most on the mean."""


def cosine_columns(rows: int, first: int, last: int) -> Matrix:
    """Cosines along the rows, frequencies `first` to `last - 1`: the start that needs no predecessor."""
    columns, table = np.empty((rows, last - first)), np.empty(rows + 8)
    _kernels.cosines(first, table, columns)
    return columns


def onorm(columns: Matrix) -> Matrix:
    """Q of the QR factorisation with positive diagonal of `columns`, shape (n, c), n >= c."""
    return unpaid(onorm_steps(columns))


def onorm_steps(columns: Matrix) -> Steps:
    """`onorm` of `columns`, shape (n, c), with the price of reflections."""
    q, scratch = np.empty(columns.shape), np.empty(_kernels.iteration_space(*columns.shape))
    independence = _kernels.cholesky_onorm(np.ascontiguousarray(columns), ONCE, scratch, q)
    if independence >= TWICE:
        return q
    yield partial(reflection_cost, len(columns))
    return householder_orthonormalize(columns)


def householder_orthonormalize(columns: Matrix) -> Matrix:
    """`onorm` of `columns`, shape (n, c), by Householder reflections, for any condition number."""
    if not np.isfinite(columns).all():
        raise NumericError("the subspace iteration produced a value that is not finite")
    q = np.empty(columns.shape)
    _kernels.householder(np.array(columns, order="C"), np.empty(3 * columns.shape[1]), q)
    return q


def orthogonal_iteration(
    factor: Factor, start: Matrix, *, power: int, iterations: int, width: int | None = None
) -> Matrix:
    """U(t) = Onorm(R^z U(t-1)), `iterations` times (Algorithm 1)."""
    return unpaid(iteration_steps(factor, start, power=power, iterations=iterations, width=width))


def iteration_steps(factor: Factor, start: Matrix, *, power: int, iterations: int, width: int | None = None) -> Steps:
    """`orthogonal_iteration` from `start`, shape (n, c) or wider, with the price of each step."""
    rows, width = len(start), start.shape[1] if width is None else min(width, start.shape[1])
    yield partial(dictionary_cost, factor.fronts, power=power, iterations=iterations)
    start = np.ascontiguousarray(start)
    check_rows(factor, rows)
    subspace, scratch = np.empty((rows, width)), np.empty(_kernels.iteration_space(rows, width))
    independence = _kernels.iterate(
        factor.fronts, factor.values, factor.inverse, start, power, iterations, ONCE, scratch, subspace
    )
    if independence < TWICE:
        # R^z has all but lost the higher columns. Orthonormalised after every R they stay, and the subspaces of the
        # first columns, which is all that Q depends on, are the same.
        yield partial(careful_dictionary_cost, factor.fronts, power=power, iterations=iterations)
        subspace = start[:, :width]
        for _ in range(iterations * power):
            subspace = yield from onorm_steps(solve(factor, subspace, 1))
    return subspace


def completed_steps(first: Steps, rows: int, most: int, width: int) -> Steps:
    """The columns that `first` leads to, `most` of them at most, completed to `width`, with the price of each step."""
    columns = yield from up_to(most, first)
    if columns.shape[1] == width:
        return columns
    yield partial(completion_cost, rows, most)
    return completed(columns, width)


def completed(first: Matrix, width: int) -> Matrix:
    """Orthonormal columns, shape (n, width): those of `first`, shape (n, h), and any that are at right angles to them.

    R. Schreiber, B. Parlett, "Block reflectors: theory and computation", 1988; this is one that is not symmetric.
    """
    whole, scratch = np.empty((len(first), width)), np.empty(_kernels.completion_space(first.shape[1]))
    if not _kernels.complete_columns(np.ascontiguousarray(first), LEAST_PIVOT, scratch, whole):
        raise NumericError("the columns of a dictionary cannot be completed")
    return whole


def follow_columns(previous: Matrix, width: int, noisy: bool) -> Matrix:
    """The start of a block that follows: the predecessor's columns, shape (n, c), and noise where it is `noisy`."""
    if noisy:
        return resized(previous, width) + FOLLOWING_NOISE * hash_columns(len(previous), width)
    return previous if previous.shape[1] >= width else resized(previous, width)


def first_columns(rows: int, width: int, noisy: bool) -> Matrix:
    """The start of a block that follows none, shape (rows, width): cosines, and noise where they might lack some."""
    start = cosine_columns(rows, 0, width)
    return start + START_NOISE * hash_columns(rows, width) if noisy else start


def resized(previous: Matrix, width: int) -> Matrix:
    """The predecessor's columns, shape (n, c), `width` of them, and cosines where it has fewer: shape (n, width)."""
    rows = len(previous)
    columns, table = np.empty((rows, width)), np.empty(rows + 8)
    _kernels.resize_columns(np.ascontiguousarray(previous), table, columns)
    return columns


def exact_basis(laplacian: Laplacian, start: Matrix, springs: float | Matrix = 0.0) -> Matrix:
    """The lowest eigenvectors of L + diag(springs): many orthogonal iterations from `start`, see `first_columns`."""
    return unpaid(exact_steps(laplacian, start, springs))


def exact_steps(laplacian: Laplacian, start: Matrix, springs: float | Matrix) -> Steps:
    """`exact_basis` from `start`, shape (n, c), with the price of each step."""
    factor = factorize(laplacian, springs + EXACT_SHIFT)
    return (yield from iteration_steps(factor, start, power=EXACT_POWER, iterations=EXACT_ITERATIONS))


def hash_columns(rows: int, columns: int) -> Matrix:
    """Fixed pseudo-random numbers in [-1, 1), shape (rows, columns): the splitmix64 of row * 2^32 + column."""
    hashed = np.empty((rows, columns))
    _kernels.hash_columns(hashed)
    return hashed
