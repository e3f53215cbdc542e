"""Decoded positions as whole numbers that encoder and decoder agree on, to predict attributes from.

On a grid they are that anyhow. The positions of blocks agree but for the last digits: they are rounded to a step that
is far above these, and where a coordinate lies so near to the middle between two steps that the sides might disagree,
the stream says which one it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.declaration import MOST_RELIEF
from bsm.bitstream.container.wire import MAX_VARINT_BYTES, write_varint
from bsm.bitstream.errors import CorruptError
from bsm.codec.arrays import Faces, Levels, Matrix

Ints = npt.NDArray[np.int32]

MARGIN = 2.0**-26
"""Of BSM units: decoders agree far better than this."""
MOST_COORDINATE = 1 << 20
STEPS_PER_EDGE = 128
FARTHEST = 2.0**20
"""Of BSM units between a mesh and the origin of its own: beyond, its positions are too coarse themselves."""


@dataclass(frozen=True, eq=False)
class Solid:
    """Decoded positions.

    Parameters
    ----------
    positions : float64 array, shape (n, 3)
        In BSM units, or for grids in the mesh's unit.
    places : int32 array, shape (n, 3), optional
        Coded values on a grid; None: there is none.
    """

    positions: Matrix
    places: Levels | None = None

    def relief(self, exponent: int, doubts: bytes) -> Ints:
        """The positions as whole numbers, shape (n, 3), in units of 2^-exponent where there is no grid (A 6).

        Raises
        ------
        CorruptError
            If `doubts` are not of these positions.
        """
        if self.places is not None:
            return self.places.astype(np.int32)
        scaled = (self.positions * 2.0**exponent + 0.5).ravel()
        low = np.floor(scaled)
        indices, up = _parse(doubts, len(low))
        low[indices] = np.rint(scaled[indices]) - 1.0 + up
        return low.clip(-MOST_COORDINATE, MOST_COORDINATE).astype(np.int32).reshape(-1, 3)

    def doubts(self, exponent: int) -> bytes:
        """Which coordinates another decoder might round otherwise, and how they are to be."""
        scaled = (self.positions * 2.0**exponent + 0.5).ravel()
        nearest = np.rint(scaled)
        indices = np.flatnonzero(np.abs(scaled - nearest) < MARGIN * 2.0**exponent)
        up = scaled[indices] >= nearest[indices]
        gaps = np.diff(indices, prepend=0)
        return b"".join(write_varint(int(2 * gap + bit)) for gap, bit in zip(gaps, up, strict=True))


def relief_exponent(positions: Matrix, faces: Faces) -> int:
    """Fine enough for a mesh in BSM units: some steps per mean edge."""
    edges = positions[faces] - positions[np.roll(faces, 1, axis=1)]
    mean = float(np.sqrt(np.square(edges).sum(axis=2)).mean())
    return int(min(max(math.ceil(math.log2(STEPS_PER_EDGE / mean)), 1), MOST_RELIEF)) if mean > 0.0 else 1


def _parse(doubts: bytes, size: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float64]]:
    """Coordinates in doubt, ascending, and 1 for the larger of the two numbers, 0 for the smaller.

    Many thousands of varints, all read at once: where they end, then byte after byte of all that have as many.
    """
    data = np.frombuffer(doubts, np.uint8).astype(np.int64)
    ends = np.flatnonzero(data < 128)
    if len(data) and (not len(ends) or ends[-1] != len(data) - 1):
        raise CorruptError("the coordinates in doubt end inside a number")
    starts = np.concatenate([[0], ends + 1])[:-1].astype(np.int64)
    lengths = ends - starts + 1
    if (lengths > MAX_VARINT_BYTES).any() or ((lengths > 1) & (data[ends] == 0)).any():
        raise CorruptError("a coordinate in doubt is not in its shortest form")
    entries = np.zeros(len(starts), np.int64)
    for place in range(MAX_VARINT_BYTES):
        some = lengths > place
        entries[some] |= (data[starts[some] + place] & 127) << 7 * place
    gaps = entries >> 1
    indices = np.cumsum(gaps)
    if len(indices) and (indices[-1] >= size or (gaps[1:] == 0).any()):
        raise CorruptError(f"a coordinate is in doubt twice, or is none of {size}")
    return indices, (entries & 1).astype(np.float64)
