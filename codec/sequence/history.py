"""What GOPs refer to: components of the one before, or frames of low delay."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from bsm.bitstream.coefficients.matrices import make_level_bank
from bsm.bitstream.entropy.range_coder import Bank, copy_bank
from bsm.bitstream.errors import CorruptError
from bsm.codec.arrays import Levels, Matrix, sum_in_order
from bsm.codec.sequence.row_prediction import Loop
from bsm.codec.sequence.temporal import time_cosines
from bsm.codec.sequence.tracks import INHERITED, Track, lags


class Inherited:
    """The first components of a GOP, which those of the next one are predicted from; filled block after block."""

    def __init__(self, before: Inherited | None = None) -> None:
        self.depth: int = before.depth + 1 if before else 0
        self.known: list[Matrix] = []
        self.around: list[Matrix] = []

    def keep(self, ends: Matrix, differences: Matrix) -> None:
        """Take note of the next part: its components around it, shape (k_i, r), and in it, shape (c_i, r)."""
        self.around.append(ends[:, :INHERITED].copy())
        self.known.append(differences[:, :INHERITED].copy())


def begin_part(track: Track, before: Inherited | None, block: int, ends: Matrix, step: float) -> tuple[Loop, Matrix]:
    """What the components of a part follow from, which are `ends`, shape (k_i, r), around it."""
    known, around = track.known[block], track.around[block]
    if before is not None:
        known = np.hstack((known, before.known[block]))
        around = np.hstack((around, before.around[block]))
    return Loop(known.shape[1], ends.shape[1]).begin(around, ends, step), known


class FrameHistory:
    """What low-delay frames refer to, block after block; starts anew with every key frame."""

    def __init__(self, track: Track) -> None:
        self.bank: Bank = make_level_bank()
        self.levels: list[Levels] = []
        self._track = track
        self._cosines = np.empty((0, 0))
        self._back = 0
        self._kept = [track.start]  # the latest frame first

    def expect(self, frames: int, back: int = 0) -> None:
        """Get ready for so many frames, which start from those so far back, or with 0 all from the latest."""
        if back > len(self._kept):
            raise CorruptError(f"a frame refers to one {back} before it, where {len(self._kept)} are kept")
        self._back = back
        if len(self._cosines) == frames:
            return
        self._cosines = time_cosines(frames)
        self.levels = [np.zeros((len(matrix), self._track.width * frames), np.int32) for matrix in self._track.known]

    def begin(self, block: int, ends: Matrix, step: float) -> tuple[Loop, Matrix, Matrix]:
        """What a block's change follows from, where the frames are `ends`, shape (k_i, dT), around it."""
        kept, base, count = [frame[block] for frame in self._kept], self.base(block), len(ends)
        ages = [min(lag, len(kept) - 1) for lag in (0, *lags(self._track.kept))]
        known = [self._track.first[block], kept[0], *(kept[late] - kept[early] for late, early in pairwise(ages))]
        if self._back:
            known.append(kept[self._back - 1] - kept[0])
        columns = np.hstack(known)
        loop = Loop(columns.shape[1], ends.shape[1]).begin(columns[:count], ends - base[:count], step)
        return loop, columns[count:], base[count:]

    def base(self, block: int) -> Matrix:
        """What frames start from, around a block and its coefficients, shape (k_i + c_i, dT)."""
        base = np.zeros((len(self._kept[0][block]), len(self._cosines), self._track.width))
        for frame, cosines in enumerate(self._cosines):
            begun = self._kept[self._back - 1 - frame if self._back else 0][block]
            base += begun[:, None] * cosines[:, None]
        return base.reshape(len(base), -1)

    def copy(self) -> FrameHistory:
        """An independent copy of the present state."""
        twin = FrameHistory(self._track)
        twin.bank, twin.levels, twin._cosines = copy_bank(self.bank), self.levels, self._cosines
        twin._kept = self._kept
        return twin

    def commit(self, levels: list[Levels], coded: list[Matrix]) -> None:
        """Make frames the latest: their levels, shapes (c_i, dT), and what they are as of `base`."""
        self.levels = levels
        spectra = [part.reshape(len(part), len(self._cosines), self._track.width) for part in coded]
        latest = self._cosines[::-1][: self._track.kept]
        fresh = [[sum_in_order(part.swapaxes(0, 1) * cosines[:, None, None]) for part in spectra] for cosines in latest]
        self._kept = [*fresh, *self._kept][: self._track.kept]


def held_cosines(width: int, frames: int) -> Matrix:
    """The basis of low-delay frames, shape (d, T, dT): each cosine by itself in one number after the other."""
    rows = np.kron(time_cosines(frames), np.eye(width))
    return np.ascontiguousarray(rows.reshape(frames, width, -1).transpose(1, 0, 2))
