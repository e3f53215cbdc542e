"""Where the rows of a binary table begin when their lists differ in length."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit


@njit(cache=True, nogil=True)
def walk_rows(
    raw: npt.NDArray[np.uint8], offset: int, count: int, widths: npt.NDArray[np.int64], place: int, big_endian: bool
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], int]:
    """Walk over `count` rows of numbers and lists.

    Parameters
    ----------
    raw : ndarray of uint8
        The bytes of the file.
    offset : int
        Where the first row begins.
    count : int
        Number of rows; the caller has checked that this many can be there.
    widths : ndarray of int64, shape (k, 2)
        For each property the bytes of its list's length (0: it is a number), and the bytes of one item.
    place : int
        The property whose lists are wanted.
    big_endian : bool
        Order of the bytes of the lengths.

    Returns
    -------
    starts, sizes : ndarray of int64, shape (count,)
        Where the items of each wanted list begin, and how many there are.
    end : int
        Where the last row ends; negative, minus the offset of its row, if a list runs over the end.
    """
    starts = np.zeros(count, dtype=np.int64)
    sizes = np.zeros(count, dtype=np.int64)
    cursor = offset
    for row in range(count):
        for i in range(len(widths)):
            length_width, item_width = widths[i]
            size = 1
            if length_width:
                if cursor + length_width > len(raw):
                    return starts, sizes, -cursor
                size = 0
                for j in range(length_width):
                    byte = int(raw[cursor + (j if big_endian else length_width - 1 - j)])
                    size = size * 256 + byte
                cursor += length_width
            if i == place:
                starts[row] = cursor
                sizes[row] = size
            if size > len(raw) or cursor + size * item_width > len(raw):
                return starts, sizes, -cursor
            cursor += size * item_width
    return starts, sizes, cursor
