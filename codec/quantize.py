"""Uniform quantization of coefficients: levels are whole numbers, a level times the step is a coefficient."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Matrix = npt.NDArray[np.float64]
Levels = npt.NDArray[np.int32]

LARGEST_LEVEL = (1 << 23) - 1


def quantize(coefficients: Matrix, step: float) -> Levels:
    """Levels nearest to `coefficients`, shape (c, 3)."""
    return np.rint(coefficients / step).astype(np.int32)


def dequantize(levels: Levels, step: float) -> Matrix:
    """Coefficients of `levels`."""
    return np.asarray(levels * step, dtype=np.float64)


def smallest_step(block_size: int) -> float:
    """Finest step whose levels hold every coefficient, and every difference of two, of a block of n_d vertices."""
    return float(np.sqrt(block_size) / LARGEST_LEVEL)


def packed_step(block_size: int, bits: int) -> float:
    """Step with which `bits` bits hold every coefficient of a block of n_d vertices.

    Positions lie within half a diagonal of the centre, so a coefficient lies within sqrt(n_d) / 2.
    """
    return float(np.sqrt(block_size) / (2**bits - 1))


def levels_to_unsigned(levels: Levels, bits: int) -> npt.NDArray[np.uint32]:
    """Levels of `packed_step` as unsigned integers of `bits` bits."""
    half = 1 << (bits - 1)
    return np.clip(levels + half, 0, 2 * half - 1).astype(np.uint32)


def unsigned_to_levels(values: npt.NDArray[np.uint32], bits: int) -> Levels:
    """Twin of `levels_to_unsigned`, shape (c, 3)."""
    return (values.astype(np.int64) - (1 << (bits - 1))).astype(np.int32).reshape(-1, 3)
