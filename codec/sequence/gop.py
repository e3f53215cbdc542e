"""GOPs: the coders of their frames, one for each direction.

A frame has one field or more: positions, in BSM units throughout, and attributes that move, in their own, as what they
differ from the first frame by.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from bsm.bitstream.coefficients.matrices import make_level_bank
from bsm.bitstream.container.gop import MAX_EXPONENT, GopField, GopMethod
from bsm.bitstream.entropy.range_coder import Bank, copy_bank
from bsm.codec.arrays import Levels, Matrix, Order, sum_in_order
from bsm.codec.progress import Progress
from bsm.codec.sequence import temporal
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.row_prediction import WEIGHT, LevelWriter, Loop
from bsm.codec.sequence.temporal import time_cosines
from bsm.codec.sequence.tracks import INHERITED, LAGS, Setting, Track
from bsm.codec.static.units import single


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


class FrameHistory:
    """The state that low-delay frames refer to, block after block; every key frame resets it."""

    def __init__(self, track: Track) -> None:
        self.bank: Bank = make_level_bank()
        self.levels: list[Levels] = []
        self._track = track
        self._cosines = np.empty((0, 0))
        self._back = 0
        self._kept = [track.start]  # the latest frame first

    def expect(self, frames: int, back: int = 0) -> None:
        """Prepare for `frames` frames that start from the one `back` before them, or with 0 all from the latest."""
        self._back = back
        if len(self._cosines) == frames:
            return
        self._cosines = time_cosines(frames)
        self.levels = [np.zeros((len(matrix), self._track.width * frames), np.int32) for matrix in self._track.known]

    def begin(self, block: int, ends: Matrix, step: float) -> tuple[Loop, Matrix, Matrix]:
        """Return the prediction of a block's change from the frames `ends`, shape (k_i, dT), around it."""
        kept, base, count = [frame[block] for frame in self._kept], self.base(block), len(ends)
        ages = [min(lag, len(kept) - 1) for lag in (0, *LAGS) if lag < self._track.kept]
        known = [self._track.first[block], kept[0], *(kept[late] - kept[early] for late, early in pairwise(ages))]
        if self._back:
            known.append(kept[self._back - 1] - kept[0])
        columns = np.hstack(known)
        loop = Loop(columns.shape[1], ends.shape[1]).begin(columns[:count], ends - base[:count], step)
        return loop, columns[count:], base[count:]

    def base(self, block: int) -> Matrix:
        """Return the values that frames start from, around a block and its coefficients, shape (k_i + c_i, dT)."""
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
        """Make frames the latest: their levels, shapes (c_i, dT), and their values from `base` on."""
        self.levels = levels
        spectra = [part.reshape(len(part), len(self._cosines), self._track.width) for part in coded]
        latest = self._cosines[::-1][: self._track.kept]
        fresh = [[sum_in_order(part.swapaxes(0, 1) * cosines[:, None, None]) for part in spectra] for cosines in latest]
        self._kept = [*fresh, *self._kept][: self._track.kept]


OVERHEAD = 14  # bytes of a GOP besides its levels, about
PLACES, SENT, CLEARLY = 8, 0.35, 0.95
"""Places where a cut is looked for at first; bytes of one more component over those of all on average, about; and the
share of the numbers with which a cut is worth an attempt."""
LIKE = 0.5
"""If kept frames are nearer than this, in squares and relative to the latest one, the next frames start from them."""


@dataclass(frozen=True, eq=False)
class LearntGop:
    """Frames by a basis learnt from them: a field, its cost, components, shape (n, r), and basis, (d, T, r)."""

    field: GopField
    cost: float
    components: Matrix
    basis: Matrix

    def frames(self, places: Order) -> Iterator[Matrix]:
        """Return some of the frames as decoded, each of shape (n, d)."""
        return temporal.frames_of(self.components, 0, self.basis[:, places])

    def lengths(self, places: Order) -> list[int]:
        """Return the lengths of GOPs in which frames at `places` need fewest numbers: motion changes between them."""
        energies, turns = np.linalg.eigh(self.components.T @ self.components)
        shapes = np.tensordot(turns * np.sqrt(energies.clip(0.0)), self.basis[:, places], axes=(0, 2))
        columns = self.field.width * len(places)
        sent = SENT * columns * len(self.field.levels) / max(1, len(self.field.basis))
        return _cut(shapes, sent, temporal.WORTH * self.field.step**2)


def _cut(shapes: Matrix, sent: float, worth: float) -> list[int]:
    """Return lengths of GOPs for motion of a shape (r, d, T), by the numbers of each component and its basis."""
    frames = shapes.shape[2]

    def numbers(part: Matrix) -> float:
        rows = part.reshape(len(part), -1)
        columns = rows.shape[1]
        return float(np.count_nonzero(np.linalg.eigvalsh(rows @ rows.T) > worth * columns) * (columns + sent))

    def cost(place: int) -> tuple[float, int]:
        return numbers(shapes[..., :place]) + numbers(shapes[..., place:]), abs(2 * place - frames)

    stride = frames // PLACES
    best = min(range(stride, frames - stride + 1, stride), key=cost) if stride > 1 else 0
    if not best or cost(best)[0] >= CLEARLY * numbers(shapes):
        return [frames]
    while stride := stride // 2:
        best = min((best - stride, best, best + stride), key=cost)
    return [*_cut(shapes[..., :best], sent, worth), *_cut(shapes[..., best:], sent, worth)]


class GopEncoder:
    """Encodes a track of one GOP after the other, at first that of positions."""

    def __init__(self, setting: Setting, options: SequenceOptions) -> None:
        self._track = setting.tracks[0]
        self._parts = setting.parts
        self._options = options
        self.step = single(options.step)
        self.latest: Matrix | None = None
        self._begin()

    def _begin(self) -> None:
        self.inherited: Inherited | None = None
        self._history = FrameHistory(self._track)
        self._kept: list[Matrix] = []

    def copy(self) -> GopEncoder:
        """One that goes on from the same state."""
        twin = copy(self)
        twin._history = self._history.copy()
        return twin

    def beside(self, track: Track) -> GopEncoder:
        """One of another track, by the same dictionaries, that begins anew."""
        twin = copy(self)
        twin._track = track
        twin._begin()
        twin.latest = None
        return twin

    def stay(self, frames: int, method: GopMethod) -> None:
        """Skip frames that are not coded; they repeat the previous frame, or the first one."""
        if method.has_basis:
            self.inherited = Inherited(self._before(method))
            for known, around in zip(self._track.known, self._track.around, strict=True):
                self.inherited.keep(around[:, :0], known[:, :0])
            return
        self.inherited = None
        if method is GopMethod.KEY_FRAME:
            self._begin()
        history = self._history
        history.expect(frames)
        levels = [np.zeros_like(levels) for levels in history.levels]
        history.commit(levels, [history.base(k) for k in range(len(levels))])
        self._kept = []

    def method_with_basis(self, together: int) -> GopMethod:
        """Return the method of the next GOP with a basis, given the longest chain of GOPs."""
        following = self.inherited is not None and self.inherited.depth < together - 1
        return GopMethod.LEARNT_NEXT if following else GopMethod.LEARNT

    def _before(self, method: GopMethod) -> Inherited | None:
        return self.inherited if method is GopMethod.LEARNT_NEXT else None

    @property
    def low_delay(self) -> bool:
        return self._options.low_delay > 0

    def is_key(self, number: int, vertices: int) -> bool:
        """Whether those are key frames that begin with frame `number` of a sequence of low delay."""
        longest, together = self._options.longest(vertices), self._options.low_delay
        return number % (longest - longest % together) == 0

    def encode_next(self, frames: Matrix, progress: Progress, *, key: bool) -> GopField:
        """Encode frames, shape (T, n, d), without a basis of their own."""
        self.inherited = None
        if key:
            self._begin()
        history, width, columns = self._history, self._track.width, self._track.width * len(frames)
        back = self._nearest(frames)
        history.expect(len(frames), back)
        rows = np.kron(time_cosines(len(frames)), np.eye(width))  # each cosine in one number after the other
        basis = np.ascontiguousarray(rows.reshape(len(frames), width, -1).transpose(1, 0, 2))
        wanted = temporal.trajectories(frames) @ basis.reshape(-1, columns)
        field = np.zeros_like(wanted)
        writer, coded = LevelWriter(history.bank, columns), []
        for k, part in enumerate(self._parts):
            ends = field[part.around]
            loop, known, base = history.begin(k, ends, self.step)
            change = writer.write(loop, known, part.difference(wanted, field) - base, self.step, history.levels[k])
            coded.append(np.vstack((ends, base + change)))
            part.place(field, base + change)
            progress(k + 1, len(self._parts))
        payload = writer.finish()
        history.commit(writer.levels, coded)
        self.latest = np.array(list(temporal.frames_of(field, 0, basis)))
        self._kept = [*self.latest[::-1], *self._kept][: self._track.kept]
        return GopField(width, self.step, columns, np.empty(0, np.int32), b"", payload, back)

    def encode_learnt(self, frames: Matrix, weights: Matrix, method: GopMethod, progress: Progress) -> LearntGop:
        """Encode frames, shape (T, n, d), whose errors count by `weights`, shape (T,), by a basis learnt from them."""
        weights = np.tile(weights, self._track.width)
        motion = temporal.trajectories(frames)
        motion *= weights
        body, columns = self._basis(motion, weights)
        basis = columns * weights[:, None]
        wanted = motion @ (basis @ np.linalg.pinv(basis.T @ basis, hermitian=True))
        energy = np.vdot(motion, motion)
        del motion  # as large as the frames
        field = np.zeros_like(wanted)
        writer = LevelWriter(make_level_bank(), body.components)
        before = self._before(method)
        self.inherited = Inherited(before)
        for k, part in enumerate(self._parts):
            target, ends = part.difference(wanted, field), field[part.around]
            known, around = self._track.known[k], self._track.around[k]
            if before is not None:
                known, around = np.hstack((known, before.known[k])), np.hstack((around, before.around[k]))
            loop = Loop(known.shape[1], ends.shape[1]).begin(around, ends, self.step)
            differences = writer.write(loop, known, target, self.step)
            part.place(field, differences)
            self.inherited.keep(ends, differences)
            progress(k + 1, len(self._parts))
        coded = replace(body, levels=writer.finish())
        left = energy - _energy(wanted, basis)  # of the fit, which `wanted - field` is orthogonal to
        error = float(left + _energy(wanted - field, basis)) / self.step**2
        cost = error + WEIGHT * 8.0 * (coded.size + OVERHEAD)
        return LearntGop(coded, cost, field, columns.reshape(self._track.width, len(frames), body.components))

    def _nearest(self, frames: Matrix) -> int:
        """How far before them the kept frames are that they are so like that it is better to start from these."""
        count = len(frames)
        backs = range(count, len(self._kept) + 1)
        if not backs:
            return 0
        off = [sum(_apart(frames[t], self._kept[back - 1 - t]) for t in range(count)) for back in backs]
        latest = sum(_apart(frame, self._kept[0]) for frame in frames)
        best = int(np.argmin(off))
        return backs[best] if off[best] < LIKE * latest else 0

    def _basis(self, motion: Matrix, weights: Matrix) -> tuple[GopField, Matrix]:
        """A field without the levels of parts, and its temporal basis, of weighted trajectories, shapes (n, dT)."""
        width = self._track.width
        learnt, exponents = temporal.learn_basis(motion, self.step, MAX_EXPONENT)
        spectrum = temporal.spectrum_of(learnt / weights[:, None], exponents, width)
        _, frames, columns = spectrum.shape
        writer = LevelWriter(make_level_bank(), columns)
        for lead, matrix in enumerate(spectrum, 1):  # column i has i levels that are not free
            writer.write(Loop(0, columns, 0), np.empty((frames, 0)), matrix, 1.0, lead=(lead, width))
        field = GopField(width, self.step, columns, exponents, writer.finish(), b"")
        return field, temporal.basis_of(np.array(writer.levels), exponents)


def _apart(first: Matrix, second: Matrix) -> float:
    return float(np.square(first - second).sum())


def _energy(field: Matrix, basis: Matrix) -> float:
    return float(np.vdot(field, field @ (basis.T @ basis)))
