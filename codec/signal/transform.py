"""From positions to coefficients of a subspace and back (paper, section 4), E = U^T V and V = U E; and quantization.

Products this thin gain nothing from BLAS, and summed in a fixed order they are the same to the last bit everywhere,
whatever the width of the matrix whose first columns they take. Levels are whole numbers, a level times the step is a
coefficient.
"""

import math

import numpy as np

from bsm._core import codec as _kernels
from bsm.codec.arrays import Basis, Matrix, distinct
from bsm.codec.basis.orthogonal_iteration import cosine_columns
from bsm.codec.blocks.overlap import Blocks


def project(subspace: Basis, values: Matrix, count: int) -> Matrix:
    """E = U^T V, shape (count, d) or (count,), for the first `count` columns U of `subspace`, shape (n, c)."""
    # The kernel would read beyond the matrix.
    if len(values) != len(subspace) or count > subspace.shape[1]:
        raise ValueError(f"{count} of {subspace.shape} coefficients of {len(values)} values")
    flat = np.ascontiguousarray(values.reshape(len(values), math.prod(values.shape[1:])))
    coefficients = np.empty((count, flat.shape[1]))
    _kernels.project(np.ascontiguousarray(subspace), flat, coefficients)
    return coefficients.reshape(count, *values.shape[1:])


def reconstruct(subspace: Basis, coefficients: Matrix) -> Matrix:
    """V = U E, shape (n, d) or (n,), for E of shape (c, d) or (c,); U is the first c columns of `subspace`."""
    if len(coefficients) > subspace.shape[1]:
        raise ValueError(f"{len(coefficients)} coefficients for {subspace.shape[1]} columns")
    flat = np.ascontiguousarray(
        coefficients.reshape(len(coefficients), math.prod(coefficients.shape[1:]))
    )
    values = np.empty((len(subspace), flat.shape[1]))
    _kernels.reconstruct(np.ascontiguousarray(subspace), flat, values)
    return values.reshape(len(subspace), *coefficients.shape[1:])


LARGEST_LEVEL = (1 << 23) - 1


def smallest_step(block_size: int) -> float:
    """Finest step whose levels hold every coefficient, and every difference of two, of a block of n_d vertices."""
    # Columns are orthonormal, so no coefficient of a block in units of its diagonal exceeds the root of its size.
    return float(np.sqrt(block_size) / LARGEST_LEVEL)


def packed_range(first: float, others: float, bits: int) -> tuple[float, int]:
    """Step with which `bits` bits hold every coefficient, and how many bits coarser the first row is for that."""
    half = (1 << (bits - 1)) - 1
    # The header has single precision. Rounded up, so that the largest coefficient still fits.
    step = float(
        np.nextafter(np.float32(max(others, first * 2.0**-20, 2.0**-20) / half), np.float32(np.inf))
    )
    coarser = 0
    # The lowest frequency is the mean of the block, and far larger than all others. A step of its own saves bits of
    # these.
    while first > half * step * 2**coarser:
        coarser += 1
    return step, coarser


SAMPLES = 2  # blocks that are measured; one, or four, come to 1 % more bytes, which is chance
# Root mean square in steps from which on a coefficient pays; half of it costs 3 %, twice 8 %.
WORTHWHILE = 0.75
FIRST_LOOK = 160  # frequencies that are measured at first; this only saves time


class MeasuredSpectrum:
    """Root mean square coefficient at each frequency, measured from the lowest one as far as it is needed."""

    def __init__(self, blocks: Blocks, positions: Matrix, *, shift: float) -> None:
        # Not the first and last block, which are often small remainders.
        numbers = distinct(np.linspace(0, blocks.count - 1, SAMPLES + 2).astype(int)[1:-1])
        self._samples = [blocks.block(index) for index in numbers]
        self._positions = positions
        self._shift = shift
        self._size = int(np.diff(blocks.starts).max())
        self._magnitudes = self._measure(min(FIRST_LOOK, self._size))

    def worthwhile_size(self, step: float, most: int | None = None) -> int:
        """Subspace size beyond which a coefficient is hardly ever quantized to anything but zero; `most` at most."""
        most = self._size if most is None else min(most, self._size)
        while True:
            known = len(self._magnitudes)
            size = int(np.count_nonzero(self._magnitudes > WORTHWHILE * step))
            # The last eighth is an average over fewer frequencies than there are.
            if (
                size < known - known // 8
                or known == self._size
                or min(size, known - known // 8) >= most
            ):
                return max(1, min(size, most))
            self._magnitudes = self._measure(min(2 * known, self._size))

    def _measure(self, width: int) -> Matrix:
        """The lowest `width` frequencies, not rising; the first columns of a dictionary do not depend on later ones."""
        energy, count = np.zeros(width), np.zeros(width)
        for block in self._samples:
            # As a key block is made, since a measured block must not depend on others.
            subspace = block.iterated(
                cosine_columns(block.size, min(width, block.size)), self._shift
            )
            coefficients = project(subspace, self._positions[block.vertices], subspace.shape[1])
            energy[: block.size] += np.square(coefficients).mean(axis=1)
            count[: block.size] += 1
        energy /= np.maximum(count, 1)
        sums, j = np.concatenate([[0.0], np.cumsum(energy)]), np.arange(width)
        # A window in proportion to the frequency: spectra fall by powers, so single coefficients scatter and their
        # trend is smooth.
        first, last = j - (j + 4) // 8, np.minimum(j + (j + 4) // 8 + 1, width)
        smooth = (sums[last] - sums[first]) / (last - first)
        # Not rising, so that the number of worthwhile columns is well defined.
        return np.sqrt(np.maximum.accumulate(smooth[::-1])[::-1])
