"""Laplacians as dense matrices, which LAPACK solves where the codec takes fronts."""

import numpy as np

from bsm.codec.arrays import Matrix
from bsm.codec.blocks.overlap import Block


def dense_laplacian(block: Block) -> Matrix:
    """L of a block, with all weights one, shape (n, n)."""
    laplacian = np.zeros((block.size, block.size))
    laplacian[np.repeat(np.arange(block.size), block.degrees), block.neighbors] = -1.0
    np.fill_diagonal(laplacian, block.degrees)
    return laplacian
