"""Where the rows of a binary table begin when their lists differ in length."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm import _kernels


def walk_rows(
    raw: npt.NDArray[np.uint8], offset: int, count: int, widths: npt.NDArray[np.int64], place: int, big_endian: bool
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], int]:
    """Walk over `count` rows of numbers and lists."""
    starts, sizes = np.zeros(count, np.int64), np.zeros(count, np.int64)
    end = _kernels.walk_rows(raw, offset, widths, place, big_endian, starts, sizes)
    return starts, sizes, end
