"""Dynamic orthogonal iterations: the subspace's size follows the error of each block (paper, section 5, Algorithm 2).

The printed algorithm has its two branches the wrong way round; this follows the text. Where the paper appends the
residual, which a decoder cannot know, both sides append a cosine (`codec.basis.orthogonal_iteration.resized`). Q of a
QR factorisation is nested, so one iteration at the largest size holds the subspace of every smaller size, and the
residual for all of them is one cumulative sum: the search costs no further iteration.
"""

import numpy as np

from bsm.codec.arrays import Matrix


def residual_norms(positions: Matrix, coefficients: Matrix) -> Matrix:
    """The error that a subspace of every size leaves."""
    total = float(np.square(positions).sum())
    captured = np.concatenate([[0.0], np.cumsum(np.square(coefficients).sum(axis=1))])
    return np.sqrt(np.maximum(total - captured, 0.0))


def dynamic_size(positions: Matrix, coefficients: Matrix, previous: int, lowest: float, highest: float) -> int:
    """c_i: from the predecessor's size, one column more while the error is over eps_h, one less while under eps_l."""
    norms = residual_norms(positions, coefficients)
    size = min(max(previous, 1), len(coefficients))
    if norms[size] > highest:
        while size < len(coefficients) and norms[size] > highest:
            size += 1
    else:
        while size > 1 and norms[size] < lowest and norms[size - 1] <= highest:
            size -= 1
    return size


class DynamicSize:
    """c_i of one block of a chain after the other."""

    def __init__(self, lowest: float, highest: float, first: int) -> None:
        self._thresholds = lowest, highest
        self._size = first

    def follow(self, positions: Matrix, coefficients: Matrix) -> int:
        """`dynamic_size` from the block before, for `positions`, shape (n, 3), and `coefficients`, shape (c, 3)."""
        self._size = dynamic_size(positions, coefficients, self._size, *self._thresholds)
        return self._size
