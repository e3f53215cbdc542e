"""Trading error for bits: what a bit is worth, and coefficients as the coder's side of the trade wants them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Matrix = npt.NDArray[np.float64]

BIT_WORTH = 0.13
"""Squared steps of error that a bit is worth.

A finely quantized coefficient has a mean squared error of step^2 / 12, which a bit more divides by four: the slope is
step^2 ln(2) / 6 = 0.1155 step^2 per bit. Measured on real meshes, angles between normals ask for slightly more.
"""


def targets(coefficients: Matrix, step: float, unit: int, largest: int) -> npt.NDArray[np.int64]:
    """Coefficients, shape (c, 3), in whole multiples of `step` / `unit`, cut to `largest` steps."""
    scaled = np.rint(coefficients * (unit / step))
    return np.clip(scaled, -largest * unit, largest * unit).astype(np.int64)
