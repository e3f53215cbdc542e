from typing import Any

import numpy as np
import pytest

from bsm.codec.basis.orthogonal_iteration import cosine_columns
from bsm.codec.signal.transform import MeasuredSpectrum
from tests.blocks import blocks_of
from tests.shapes import patch

SHIFT = 2.0**-5


def square(side: int, parts: int) -> Any:
    return blocks_of(patch(side, side), parts, side * side // parts + 40)


def waves(blocks: Any, count: int, amplitude: float) -> np.ndarray:
    """Positions of a single block whose first `count` coefficients in x, y and z are all `amplitude`, and no others."""
    block = blocks.block(0)
    subspace = block.iterated(cosine_columns(block.size, count), SHIFT)
    positions = np.zeros((block.size, 3))
    positions[block.vertices] = amplitude * subspace.sum(axis=1)[:, None]
    return positions


@pytest.mark.parametrize("count", [9, 40, 200])
def test_each_frequency_is_worth_a_coefficient(count: int) -> None:
    blocks = square(22, 1)
    spectrum = MeasuredSpectrum(blocks, waves(blocks, count, 0.01), shift=SHIFT)
    blur = 2 + (count + 4) // 8  # frequencies are averaged with an eighth of them around
    assert abs(spectrum.worthwhile_size(0.005) - count) <= blur
    assert spectrum.worthwhile_size(0.1) == 1


def test_noise_is_worth_them_all_and_a_finer_step_no_fewer() -> None:
    blocks = square(24, 3)
    positions = np.random.default_rng(1).normal(size=(576, 3))
    spectrum = MeasuredSpectrum(blocks, positions, shift=SHIFT)
    largest = int(np.diff(blocks.starts).max())
    assert spectrum.worthwhile_size(0.01) == largest
    sizes = [spectrum.worthwhile_size(step) for step in (3.0, 1.0, 0.3, 0.1)]
    assert sizes == sorted(sizes)
