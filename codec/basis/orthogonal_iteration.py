"""Tracking the low-frequency subspace of each block by orthogonal iterations (paper, section 4, Algorithm 1).

U is the dictionary of a block, n_d rows and c orthonormal columns in single precision; R = (L + delta I)^-1. Onorm, the
Q of a QR factorisation with a positive diagonal, follows every solution, or in the paper's mode the z of an iteration;
no column depends on a later one.

In dynamic orthogonal iterations the subspace's size follows the error of each block (section 5, Algorithm 2, whose two
branches are printed the wrong way round; this follows the text). Where the paper appends the residual, which a decoder
cannot know, both sides append a cosine (`resized`). Q of a QR factorisation is nested, so one iteration at the largest
size holds the subspace of every smaller size, and the residual for all of them is one cumulative sum: the search costs
no further iteration.
"""

import numpy as np

from bsm._core import codec as _kernels
from bsm.bitstream.errors import NumericError
from bsm.codec.arrays import Basis, Matrix
from bsm.codec.basis.laplacian import Factor, Laplacian, check_rows, factorize

_DONE, _NEEDS_CARE = 0, 1
"""Results of the kernel: U is complete, or columns must be made orthonormal one by one."""

FIRST_CARE = 16
"""Columns that may be made orthonormal one by one where some have to be; then four times as many, and so on."""

EXACT_POWER, EXACT_ITERATIONS, EXACT_SHIFT = 2, 128, 2.0**-5
"""Settings of an exact basis: the sum of the Rayleigh quotients of any first columns is within two thousandths of the
sum of the lowest eigenvalues, on blocks of surfaces. Eigenvectors of closer eigenvalues need not be told apart."""
START_NOISE = 0.25
FOLLOWING_NOISE = 2.0**-8
"""How much of the hash columns is added to cosines, and to a predecessor's orthonormal columns, for blocks of several
components (M 8.3); half or twice of it changes bytes by nothing, and by 0.3 % at most on the mean."""


def cosine_columns(rows: int, columns: int) -> Matrix:
    """The first columns of cosines along the rows."""
    cosines, table = np.empty((rows, columns)), np.empty(rows + 8)
    _kernels.cosines(table, cosines)
    return cosines


def orthogonal_iteration(
    factor: Factor, start: Basis, *, power: int, iterations: int, width: int | None = None, apart: int = 0
) -> Basis:
    """U(t) = Onorm(R^z U(t-1)), `iterations` times (Algorithm 1), from `start`, shape (n, c) or wider.

    Onorm follows each solution, or each `apart` of them and the last of an iteration, in double precision.
    """
    rows, width = len(start), start.shape[1] if width is None else min(width, start.shape[1])
    check_rows(factor, rows)
    subspace = np.empty((rows, width), np.float32)
    scratch = np.empty(_kernels.iteration_space(rows, width, apart), np.float32)
    arrays = factor.fronts, factor.values, factor.inverse, np.ascontiguousarray(start)
    care = 0
    while (found := _kernels.iterate(*arrays, power, iterations, apart, care, scratch, subspace)) == _NEEDS_CARE:
        care = 4 * care or FIRST_CARE
    if found != _DONE:
        raise NumericError("the columns of a dictionary cannot be made orthonormal")
    return subspace


def completed(first: Basis, width: int) -> Basis:
    """Orthonormal columns, shape (n, width): those of `first`, shape (n, h), and any that are orthogonal to them.

    R. Schreiber, B. Parlett, "Block reflectors: theory and computation", 1988; this is one that is not symmetric.
    """
    if first.shape[1] == width:
        return first
    whole = np.empty((len(first), width), np.float32)
    scratch = np.empty(_kernels.completion_space(first.shape[1]), np.float32)
    if not _kernels.complete_columns(np.ascontiguousarray(first), scratch, whole):
        raise NumericError("the columns of a dictionary cannot be completed")
    return whole


def follow_columns(previous: Basis, width: int, noisy: bool) -> Basis:
    """The start of a block that follows: the predecessor's columns, shape (n, c), and noise where it is `noisy`."""
    if noisy:
        return with_noise(resized(previous, width), FOLLOWING_NOISE)
    return previous if previous.shape[1] >= width else resized(previous, width)


def first_columns(rows: int, width: int, noisy: bool) -> Basis:
    """The start of a block that follows none, shape (rows, width): cosines, and noise where they might lack some."""
    start = resized(np.empty((rows, 0), np.float32), width)
    return with_noise(start, START_NOISE) if noisy else start


def with_noise(start: Basis, share: float) -> Basis:
    """A start, shape (n, c), and a share of the hash columns."""
    return start + (share * hash_columns(*start.shape)).astype(np.float32)


def resized(previous: Basis, width: int) -> Basis:
    """The predecessor's columns, shape (n, c), `width` of them, and cosines where it has fewer: shape (n, width)."""
    rows = len(previous)
    columns, table = np.empty((rows, width), np.float32), np.empty(rows + 8)
    _kernels.resize_columns(np.ascontiguousarray(previous), table, columns)
    return columns


def exact_basis(laplacian: Laplacian, start: Basis, springs: float | Matrix = 0.0) -> Basis:
    """The lowest eigenvectors of L + diag(springs): many orthogonal iterations from `start`, see `first_columns`."""
    factor = factorize(laplacian, springs + EXACT_SHIFT)
    return orthogonal_iteration(factor, start, power=EXACT_POWER, iterations=EXACT_ITERATIONS)


def hash_columns(rows: int, columns: int) -> Matrix:
    """Fixed pseudo-random numbers in [-1, 1), shape (rows, columns): the splitmix64 of row * 2^32 + column."""
    hashed = np.empty((rows, columns))
    _kernels.hash_columns(hashed)
    return hashed


class DynamicSize:
    """c_i of one block of a chain after the other."""

    def __init__(self, lowest: float, highest: float, first: int) -> None:
        self._lowest, self.highest, self._size = lowest, highest, first

    @property
    def reach(self) -> int:
        """Columns to try first: more than the predecessor's, as most blocks take hardly more."""
        return self._size + self._size // 4 + 8

    def follow(self, left: float, coefficients: Matrix) -> int | None:
        """Return c_i for coefficients, shape (c, 3), and the squared error that they leave; None: they leave too much.

        From the predecessor's size, one column more while the error is over eps_h, one less while under eps_l.
        """
        norms = np.sqrt(left + np.append(np.cumsum(np.square(coefficients).sum(axis=1)[::-1])[::-1], 0.0))
        if norms[-1] > self.highest:
            return None
        size = min(max(self._size, 1), len(coefficients))
        if norms[size] > self.highest:
            while norms[size] > self.highest:
                size += 1
        else:
            while size > 1 and norms[size] < self._lowest and norms[size - 1] <= self.highest:
                size -= 1
        self._size = size
        return size
