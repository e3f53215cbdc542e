"""Coefficients as targets of the choice of levels."""

from __future__ import annotations

import numpy as np

from bsm.codec.signal.quantize import targets


def test_targets_are_coefficients_in_parts_of_a_step() -> None:
    coefficients = np.array([[0.5, -0.25, 0.001], [1e9, -1e9, 0.0]])
    expected = [[256, -128, 1], [2560, -2560, 0]]
    np.testing.assert_array_equal(targets(coefficients, 0.5, 256, 10), expected)
