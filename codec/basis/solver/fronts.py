"""Which rows of a block are eliminated when: nested dissection along the bisection that ordered the rows.

The rows before a cut that see across it separate the two halves; they are eliminated after both. The rows of a
separator, or of a half that is not cut further, make a front: its own steps, and the later steps to which they lead,
its border. A front is kept as a dense matrix, one row for each of its own steps, own steps first and then the border;
this costs some fill and buys vector instructions (C. Ashcraft, R. Grimes, "The influence of relaxed supernode
partitions on the multifrontal method", 1989).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import LimitError
from bsm.codec import _kernels

LEAF = 8
"""Halves of at most so many rows are not cut further."""

WORK = 1 << 16
"""Operations of a factorisation, per row, that are too many; surfaces in blocks of 8,000 take an eighth of them."""

_FULL, _TOO_MUCH = -1, -2
"""What the kernel answers where there is no room for the borders, and where there are too many operations."""


class Fronts(NamedTuple):
    """The fronts of a block of n rows, in the order of elimination."""

    rows: npt.NDArray[np.uint32]
    steps: npt.NDArray[np.uint32]
    owners: npt.NDArray[np.uint32]
    firsts: npt.NDArray[np.uint32]
    starts: npt.NDArray[np.uint32]
    borders: npt.NDArray[np.uint32]
    places: npt.NDArray[np.uint32]
    sums: npt.NDArray[np.float64]


def find_fronts(offsets: npt.NDArray[np.int32], neighbours: npt.NDArray[np.int32]) -> Fronts:
    """Fronts of a graph whose rows are in the order of a recursive bisection; any order will do."""
    n = len(offsets) - 1
    rows, steps, owners = np.empty((3, n), np.uint32)
    firsts, starts, places = np.empty((3, n + 1), np.uint32)
    scratch, sums = np.empty(3 * n, np.uint32), np.empty(2)
    room, count = 16 * n + 64, _FULL
    while count == _FULL:
        borders = np.empty(room, np.uint32)
        count = _kernels.find_fronts(
            offsets,
            neighbours,
            LEAF,
            float(WORK * n),
            scratch,
            rows,
            steps,
            owners,
            firsts,
            starts,
            borders,
            places,
            sums,
        )
        room *= 4
    if count == _TOO_MUCH:
        raise LimitError(
            f"the faces of a block of {n} vertices are too entangled: more than {WORK} operations a vertex; "
            "if this is a surface, take smaller blocks"
        )
    firsts, starts, places = firsts[: count + 1], starts[: count + 1], places[: count + 1]
    return Fronts(rows, steps, owners, firsts, starts, borders[: starts[-1]].copy(), places, sums)
