"""How the energy of a mesh falls with frequency, measured on a few blocks: it tells how many coefficients pay."""

import numpy as np

from bsm.codec.arrays import Matrix
from bsm.codec.basis.laplacian import factorize, laplacian_of
from bsm.codec.basis.orthogonal_iteration import first_columns, orthogonal_iteration
from bsm.codec.blocks.overlap import Blocks
from bsm.codec.signal.transform import project

SAMPLES = 2  # blocks that are measured; one, or four, come to 1 % more bytes, which is chance
WORTHWHILE = 0.75  # root mean square in steps from which on a coefficient pays; half of it costs 3 %, twice 8 %
FIRST_LOOK = 160  # frequencies that are measured before anybody asks for more: this is about time alone


class MeasuredSpectrum:
    """Root mean square coefficient at each frequency, measured from the low ones on as far as somebody asks."""

    def __init__(self, blocks: Blocks, positions: Matrix, *, shift: float) -> None:
        numbers = np.unique(np.linspace(0, blocks.count - 1, SAMPLES + 2).astype(int)[1:-1])
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
            if size < known - known // 8 or known == self._size or min(size, known - known // 8) >= most:
                return max(1, min(size, most))
            self._magnitudes = self._measure(min(2 * known, self._size))

    def _measure(self, width: int) -> Matrix:
        """The lowest `width` frequencies, not rising; the first columns of a dictionary do not depend on later ones."""
        energy, count = np.zeros(width), np.zeros(width)
        for block in self._samples:
            start = first_columns(block.size, min(width, block.size), False)
            factor = factorize(laplacian_of(block), self._shift)
            subspace = orthogonal_iteration(factor, start, power=1, iterations=1)
            coefficients = project(subspace, self._positions[block.vertices], subspace.shape[1])
            energy[: block.size] += np.square(coefficients).mean(axis=1)
            count[: block.size] += 1
        energy /= np.maximum(count, 1)
        sums, j = np.concatenate([[0.0], np.cumsum(energy)]), np.arange(width)
        first, last = j - (j + 4) // 8, np.minimum(j + (j + 4) // 8 + 1, width)
        smooth = (sums[last] - sums[first]) / (last - first)
        return np.sqrt(np.maximum.accumulate(smooth[::-1])[::-1])
