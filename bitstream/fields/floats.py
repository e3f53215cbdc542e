"""Floats of single precision behind a grid: which one of those in the cell of its value each coordinate is; exact.

Floats are counted in their order, so that the cells of a grid part them: in a cell there are as many numbers as floats,
none of them likelier than others but the one that was there last. In a new cell that is the one nearest to its place:
there decimals are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy.range_coder import (
    Coder,
    finish_reading,
    finish_writing,
    make_room,
    overran,
    start_reading,
    start_writing,
)
from bsm.bitstream.errors import CorruptError, OptionError, TruncatedError

Ints = npt.NDArray[np.int32]
Numbers = npt.NDArray[np.int64]

AXES = 3
_SLOTS = 9
_NO_FLOAT = 1 << 40
_ROOM, _BYTES_PER_ROW = 1024, 16


def ordered(values: npt.ArrayLike) -> Numbers:
    """Numbers of floats of any shape in their order (V 16.1): 0 for 0.0, -1 for -0.0; all are rounded to float32."""
    with np.errstate(over="ignore"):
        single = np.ascontiguousarray(np.asarray(values, np.float64).astype(np.float32))
    bits = single.view(np.uint32).astype(np.int64)
    return np.where(bits >> 31, (1 << 31) - 1 - bits, bits)


def floats_of(numbers: Numbers) -> npt.NDArray[np.float32]:
    """Inverse of `ordered`: floats of the same shape as their numbers."""
    bits = np.where(numbers < 0, (1 << 31) - 1 - numbers, numbers)
    return np.ascontiguousarray(bits.astype(np.uint32)).view(np.float32)


class Cells(NamedTuple):
    """Numbers of floats in the cells of values (V 16.2), all of shape (k, 3)."""

    low: Numbers
    nearest: Numbers
    high: Numbers


def cells_of(values: Ints, origin: npt.NDArray[np.float64], step: float) -> Cells:
    """The cells of values, shape (k, 3); `origin`, shape (3,), is the place of value 0."""
    with np.errstate(over="ignore"):
        return Cells(*(ordered((values + side) * step + origin) for side in (-0.5, 0.0, 0.5)))


class Floats:
    """What is learnt of floats, from frame to frame; the struct `Floats` of `floats.h`."""

    def __init__(self, largest: tuple[int, ...]) -> None:
        self._state = (
            np.full(AXES * _SLOTS, 1 << 31, np.uint32),
            np.zeros(AXES, np.int64),
            np.full((AXES, max(largest) + 1), _NO_FLOAT, np.int64),
        )

    @staticmethod
    def charge(largest: tuple[int, ...]) -> int:
        """Bytes of memory that it takes."""
        return 24 * (max(largest) + 1)

    def encode(self, values: Ints, cells: Cells, floats: Numbers) -> bytes:
        """Code the numbers of floats, shape (k, 3), each in its cell, of values of a grid, shape (k, 3)."""
        if ((floats < cells.low) | (floats >= cells.high)).any():
            raise OptionError("a float is not in the cell of its value")
        coder, done = start_writing(_ROOM), 0
        while done < len(values):
            coder = make_room(coder, _ROOM + _BYTES_PER_ROW * (len(values) - done))
            done += self._code(coder, values[done:], Cells(*(numbers[done:] for numbers in cells)), floats[done:])
        return finish_writing(coder)

    def decode(self, payload: bytes, values: Ints, cells: Cells) -> Numbers:
        """Twin of `encode`: returns the numbers of the floats, shape (k, 3)."""
        floats = np.zeros(values.shape, np.int64)
        coder = start_reading(payload)
        done = self._code(coder, values, cells, floats)
        if overran(coder):
            raise TruncatedError(f"a payload of {len(payload)} bytes ends before the last of its {len(values)} floats")
        if done < len(values):
            raise CorruptError(f"number {done} of {len(values)} is in a cell without floats")
        finish_reading(coder)
        return floats

    def _code(self, coder: Coder, values: Ints, cells: Cells, floats: Numbers) -> int:
        return _kernels.code_floats(coder, self._state, np.ascontiguousarray(values), *cells, floats)
