"""Cells and floats of grids."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

_SAMPLES = (4, 32)
_AT_ONCE = 1 << 20


def spread(points: npt.NDArray[np.int32], lattice: tuple[int, ...]) -> npt.NDArray[np.int64]:
    """Values on the grid of points of a lattice (V 12): exact integers, any shape."""
    values = points.astype(np.int64)
    if not lattice:
        return values
    cells, count = lattice
    return (2 * values * cells + count) // (2 * count)


def find_lattice(values: npt.ArrayLike, cells: int) -> tuple[npt.NDArray[np.int32], tuple[int, ...]]:
    """The coarsest lattice that holds all values of a grid, if it saves a bit or more of each."""
    given = np.asarray(values, np.int64)
    different = np.unique(given)
    counts = np.arange(1, cells // 2 + 1)
    for samples in (*_SAMPLES, len(different)):
        some = different[:: max(1, len(different) // samples)]
        pieces = np.array_split(counts, 1 + len(counts) * len(some) // _AT_ONCE)
        counts = np.concatenate([piece[_fits(some, piece[:, None], cells)] for piece in pieces])
    if not len(counts):
        return given.astype(np.int32), ()
    count = int(counts[0])
    return _nearest(given, count, cells).astype(np.int32), (cells, count)


def _nearest(values: npt.NDArray[np.int64], count: npt.NDArray[np.int64] | int, cells: int) -> npt.NDArray[np.int64]:
    return (2 * values * count + cells) // (2 * cells)


def _fits(values: npt.NDArray[np.int64], count: npt.NDArray[np.int64], cells: int) -> npt.NDArray[np.bool_]:
    back = (2 * _nearest(values, count, cells) * cells + count) // (2 * count)
    fits: npt.NDArray[np.bool_] = (back == values).all(axis=1)
    return fits


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
