"""Cells and floats of grids."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int32]
Numbers = npt.NDArray[np.int64]


def ordered(values: npt.ArrayLike) -> Numbers:
    """Numbers of floats of any shape in their order (V 16.1): 0 for 0.0, -1 for -0.0; all are rounded to float32."""
    with np.errstate(over="ignore"):
        single = np.ascontiguousarray(np.asarray(values, np.float64).astype(np.float32))
    bits = single.view(np.uint32).astype(np.int64)
    return np.where(bits >> 31, (1 << 31) - 1 - bits, bits)


class Cells(NamedTuple):
    """Numbers of floats in the cells of values (V 16.2), all of shape (k, 3)."""

    low: Numbers
    nearest: Numbers
    high: Numbers


def cells_of(values: Ints, origin: npt.NDArray[np.float64], step: float) -> Cells:
    """The cells of values, shape (k, 3); `origin`, shape (3,), is the place of value 0."""
    with np.errstate(over="ignore"):
        return Cells(*(ordered((values + side) * step + origin) for side in (-0.5, 0.0, 0.5)))
