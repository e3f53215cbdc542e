"""How much work a stream asks for, and how much it may."""

from __future__ import annotations

from threading import Lock

import numpy as np

from bitstream.limits import Limits
from codec.basis.laplacian import Laplacian


def dictionary_work(blocks: int, block_size: int, coefficients: int, solves: int) -> float:
    """Floating point operations for all dictionaries, about: what `Limits.work` bounds.

    Parameters
    ----------
    blocks, block_size, coefficients
        k, n_d and c.
    solves : int
        Orthogonal iterations times power, of a block at most.
    """
    per_iteration = 8.0 * block_size * coefficients**2
    return blocks * (block_size * 200.0 + solves * (40.0 * block_size * coefficients + per_iteration))


def check_work(limits: Limits, blocks: int, block_size: int, coefficients: int, solves: int) -> None:
    """Raise `LimitError` if a header asks for more blocks, larger ones or more work than `limits` grant."""
    limits.check("blocks", blocks)
    limits.check("block_size", block_size)
    limits.check("coefficients", coefficients)
    limits.check("work", dictionary_work(blocks, block_size, coefficients, solves))


def block_work(laplacian: Laplacian, columns: int, solves: int) -> float:
    """Floating point operations that one block takes, about: two factorisations, solutions, orthonormalisation.

    `dictionary_work` supposes surfaces; in the graph of a hostile list of faces everything may be beside everything,
    and the factors are as dense.
    """
    fronts, size = laplacian.fronts, laplacian.block.size
    own = np.diff(fronts.firsts.astype(np.float64))
    width = own + np.diff(fronts.starts.astype(np.float64))
    factorisation, entries = float((own * width**2).sum()), float((own * width).sum())
    return 2.0 * factorisation + solves * columns * (4.0 * entries + 8.0 * size * columns)


class Allowance:
    """How much work a decoder may still do; blocks of several chains draw on it at the same time."""

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._spent = 0.0
        self._lock = Lock()

    def spend(self, work: float) -> None:
        """Take note of work to come; `LimitError` if all of it together is over the limit."""
        with self._lock:
            self._spent += work
            self._limits.check("work", self._spent)
