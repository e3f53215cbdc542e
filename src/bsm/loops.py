"""Loops in sequences: frames that come again, told while the frames pass by."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Positions

_POINTS = 64
MOST_FRAMES = 4096
"""Beyond, nothing is said: each frame is compared with each."""


class Loops:
    """Remembers a few vertices of each frame, and tells which frames repeat others."""

    def __init__(self) -> None:
        self._kept: list[npt.NDArray[np.float64]] = []
        self._diagonal = 0.0

    def take(self, frame: Positions) -> None:
        """Look at the next frame, shape (n, 3)."""
        if not self._kept:
            self._diagonal = float(np.linalg.norm(np.ptp(frame, axis=0)))
        if len(self._kept) <= MOST_FRAMES:
            rows = np.linspace(0, len(frame) - 1, min(_POINTS, len(frame))).astype(np.int64)
            self._kept.append(frame[rows].reshape(-1))

    def found(self, tolerance: float = 1e-4) -> tuple[range, int] | None:
        """The frames that repeat, and how many frames before them those are that they repeat."""
        count = len(self._kept)
        if not 4 <= count <= MOST_FRAMES:
            return None
        if len({len(kept) for kept in self._kept}) > 1:
            return None  # frames of other numbers of vertices
        table, near = np.array(self._kept), tolerance * self._diagonal
        if np.abs(table - table[0]).max() <= near:
            return None
        for period in range(2, count // 2 + 1):
            alike = np.abs(table[period:] - table[:-period]).max(axis=1) <= near
            start, length = _longest(alike)
            if length >= period and np.abs(table[start : start + period] - table[start]).max() > near:
                return range(start + period, start + period + length), period
        return None

    def said(self) -> tuple[str, ...]:
        """What is found, in words: nothing, or a sentence."""
        found = self.found()
        if found is None:
            return ()
        frames, period = found
        first, last = frames.start, frames.stop - 1
        return (f"frames {first} to {last} repeat {first - period} to {first - 1}",)


def _longest(alike: npt.NDArray[np.bool_]) -> tuple[int, int]:
    """Where the longest run of truths begins, and how long it is."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], alike.astype(np.int8), [0]])))
    starts, ends = edges[::2], edges[1::2]
    if not len(starts):
        return 0, 0
    best = int(np.argmax(ends - starts))
    return int(starts[best]), int(ends[best] - starts[best])
