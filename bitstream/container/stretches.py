"""Which of the frames that a GOP tells of is shown when, in stretches: motion returns, stands still and turns back."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.wire import Cursor, write_varint
from bsm.bitstream.errors import CorruptError

WAYS = (1, 0, -1)
"""From frame to frame of a stretch: as they were sent, standing still, backwards."""


def write_stretches(shown: npt.NDArray[np.int64] | None) -> bytes:
    """The frame that is shown at each time, shape (T,); None: each once, in order."""
    if shown is None:
        return write_varint(0)
    parts = []
    at, due = 0, 0
    while at < len(shown):
        changes = np.diff(shown[at:])
        way = int(changes[0]) if len(changes) and changes[0] in WAYS else WAYS[0]
        others = np.flatnonzero(changes != way)
        count = int(others[0]) + 1 if len(others) else len(shown) - at
        beyond = int(shown[at]) - due
        parts += [3 * (2 * beyond if beyond >= 0 else -2 * beyond - 1) + WAYS.index(way), count]
        at += count
        due = int(shown[at - 1]) + 1
    return b"".join(map(write_varint, [len(parts) // 2, *parts]))


def parse_stretches(cursor: Cursor, frames: int) -> npt.NDArray[np.int64] | None:
    """Inverse of `write_stretches` for so many frames: an array of shape (T,), or None."""
    count = cursor.varint()
    if not count:
        return None
    shown = np.empty(frames, np.int64)
    at, due = 0, 0
    for _ in range(count):
        beyond, way = divmod(cursor.varint(), 3)
        length = cursor.varint()
        first = due + (beyond // 2 if beyond % 2 == 0 else -(beyond + 1) // 2)
        last = first + WAYS[way] * (length - 1)
        if not (0 < length <= frames - at and 0 <= min(first, last) <= max(first, last) < frames):
            raise CorruptError(f"a stretch of {length} frames from frame {first} on, of a GOP of {frames}")
        shown[at : at + length] = first + WAYS[way] * np.arange(length)
        at, due = at + length, last + 1
    if at < frames:
        raise CorruptError(f"stretches of {at} frames in a GOP of {frames}")
    return shown
