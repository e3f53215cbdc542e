"""Where the rows of a binary table begin when their lists differ in length."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm import _kernels


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
        Where the last row ends; negative, minus the offset where the walk stopped, if a list runs over the end.
    """
    starts, sizes = np.zeros(count, np.int64), np.zeros(count, np.int64)
    end = _kernels.walk_rows(raw, offset, widths, place, big_endian, starts, sizes)
    return starts, sizes, end
