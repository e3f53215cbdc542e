"""How the energy of a mesh falls with frequency, measured on a few blocks: it tells how many coefficients pay."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from codec.blocks import Blocks
from codec.subspace import cosine_columns, orthogonal_iteration

Matrix = npt.NDArray[np.float64]

SAMPLES = 2
WORTHWHILE = 0.75


def measure_spectrum(blocks: Blocks, positions: Matrix, *, shift: float) -> Matrix:
    """Root mean square coefficient at each frequency, not rising, shape (n_d,).

    Parameters
    ----------
    blocks : Blocks
    positions : float64 array, shape (n, 3)
        In the unit of the quantization step.
    shift : float
        delta of the dictionaries.
    """
    size = int(np.diff(blocks.starts).max())
    energy, count = np.zeros(size), np.zeros(size)
    for index in np.unique(np.linspace(0, blocks.count - 1, SAMPLES + 2).astype(int)[1:-1]):
        block = blocks.block(int(index))
        subspace = orthogonal_iteration(
            block, cosine_columns(block.size, 0, block.size), shift=shift, power=1, iterations=1
        )
        energy[: block.size] += np.square(subspace.T @ positions[block.vertices]).mean(axis=1)
        count[: block.size] += 1
    energy /= np.maximum(count, 1)
    smooth = np.array([energy[j - (j + 4) // 8 : j + (j + 4) // 8 + 1].mean() for j in range(size)])
    return np.sqrt(np.maximum.accumulate(smooth[::-1])[::-1])


def worthwhile_size(spectrum: Matrix, step: float) -> int:
    """Subspace size beyond which a coefficient is hardly ever quantized to anything but zero."""
    return max(1, int(np.count_nonzero(spectrum > WORTHWHILE * step)))
