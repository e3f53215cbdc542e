"""Blending the copies of a vertex in overlapping blocks (paper, section 6.1, Algorithm 3)."""

from __future__ import annotations

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Indices, Mask, Matrix


class Blend:
    """Weighted sums over the copies of each of n vertices."""

    def __init__(self, vertices: int) -> None:
        # Zeros cost memory only where they are touched.
        self.sums: Matrix = np.zeros((vertices, 3))
        self.weights: Matrix = np.zeros(vertices)

    def grow(self, vertices: int) -> Blend:
        """Make room for vertices that have become known, so that there are so many; returns the same blend."""
        more = vertices - len(self.weights)
        if more:
            self.sums = np.concatenate([self.sums, np.zeros((more, 3))])
            self.weights = np.concatenate([self.weights, np.zeros(more)])
        return self

    def add(self, vertices: Indices, positions: Matrix, weights: Matrix) -> None:
        """Add one copy of each vertex in `vertices`, shape (n_i,), at `positions`, shape (n_i, 3)."""
        _kernels.add_copies(self.sums, self.weights, vertices, positions, weights)

    def known(self, vertices: Indices) -> Mask:
        """Which of `vertices`, shape (k,), have a copy that counts; shape (k,)."""
        return self.weights[vertices] > 0

    def all_positions(self) -> Matrix:
        """Weighted averages of all vertices, all of them known, shape (n, 3)."""
        return self.sums / self.weights[:, None]

    def positions(self, vertices: Indices) -> Matrix:
        """Weighted averages for `vertices`, all of them known, shape (len(vertices), 3)."""
        return self.sums[vertices] / self.weights[vertices][:, None]


def degree_weights(degrees: Indices) -> Matrix:
    """Weight of each row, shape (n_i,): its neighbours inside the block; a row without any counts as one."""
    return np.maximum(degrees, 1).astype(np.float64)
