"""Tracking the low-frequency subspace of each block by orthogonal iterations (paper, section 4, Algorithm 1).

U is the dictionary of a block, n_d rows and c orthonormal columns in single precision; R = (L + delta I)^-1. Onorm, the
Q of a QR factorisation with a positive diagonal, follows every solution, or in the paper's mode the z of an iteration;
no column depends on a later one.

In dynamic orthogonal iterations the subspace's size follows the error of each block (section 5, Algorithm 2, whose two
branches are printed the wrong way round; this follows the text). Where the paper appends the residual, which a decoder
cannot know, both sides append a cosine. Q of a QR factorisation is nested, so one iteration at the largest
size holds the subspace of every smaller size, and the residual for all of them is one cumulative sum: the search costs
no further iteration.
"""

import numpy as np

from bsm._core import codec as _kernels
from bsm.codec.arrays import Matrix


def cosine_columns(rows: int, columns: int) -> Matrix:
    """The first columns of cosines along the rows."""
    cosines, table = np.empty((rows, columns)), np.empty(rows + 8)
    _kernels.cosines(table, cosines)
    return cosines


class DynamicSize:
    """c_i of one block of a chain after the other."""

    def __init__(self, lowest: float, highest: float, first: int) -> None:
        self._lowest, self._highest, self._size, self.met = lowest, highest, first, True

    @property
    def reach(self) -> int:
        """Columns to try first: more than the predecessor's, as most blocks take hardly more."""
        # Trying more columns than needed costs time, and a second try costs all of it again. Most blocks need about as
        # many as the one before.
        return self._size + self._size // 4 + 8

    def follow(self, left: float, coefficients: Matrix) -> int:
        """Return c_i by the predecessor's size, shape (c, 3) given, and the squared error left, or c, over eps_h."""
        # Columns are orthonormal, so the error that any size leaves is the sum of the squares that it leaves out.
        norms = np.sqrt(
            left + np.append(np.cumsum(np.square(coefficients).sum(axis=1)[::-1])[::-1], 0.0)
        )
        self.met = bool(norms[-1] <= self._highest)
        if not self.met:
            return len(coefficients)
        size = min(max(self._size, 1), len(coefficients))
        # From the predecessor's size on, as the paper does: blocks in a chain are alike.
        while norms[size] > self._highest:
            size += 1
        while size > 1 and norms[size] < self._lowest and norms[size - 1] <= self._highest:
            size -= 1
        self._size = size
        return size
