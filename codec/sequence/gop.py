"""GOPs: the coders of their frames, one for each direction.

A frame has one field or more: positions, in BSM units throughout, and attributes that move, in their own, as what they
differ from the first frame by.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, replace

import numpy as np

from bsm._core import Track
from bsm.bitstream.container.gop import MAX_EXPONENT, GopField, GopMethod
from bsm.codec.arrays import Matrix, Order
from bsm.codec.progress import Progress
from bsm.codec.sequence import temporal
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.temporal import time_cosines
from bsm.codec.sequence.tracks import Setting
from bsm.codec.static.units import single

# Motion that swings back is often nearer to an older frame than to the latest. To refer to it costs a number.
LIKE = 0.5
"""If kept frames are nearer than this, in squares and relative to the latest one, the next frames start from them."""


@dataclass(frozen=True, eq=False)
class LearntGop:
    """Frames by a basis learnt from them: a field, components, shape (n, r), and basis, (d, T, r)."""

    field: GopField
    components: Matrix
    basis: Matrix

    def frames(self, places: Order) -> Iterator[Matrix]:
        """Return some of the frames as decoded, each of shape (n, d)."""
        return temporal.frames_of(self.components, 0, self.basis[:, places])


class GopEncoder:
    """Encodes a track of one GOP after the other, at first that of positions."""

    def __init__(self, setting: Setting, options: SequenceOptions, number: int = 0) -> None:
        self._setting, self._options, self._number = setting, options, number
        self._width = setting.widths[number]
        self.step = single(options.step)
        self.latest: Matrix | None = None
        self._track: Track = setting.track(number)
        self._depth = -1  # GOPs with a basis in the chain before the latest one; -1: it has none
        self._kept: list[Matrix] = []

    def copy(self) -> GopEncoder:
        """One that goes on from the same state."""
        twin = copy(self)
        twin._track = Track(self._track, self._setting.chain)
        return twin

    def beside(self, number: int) -> GopEncoder:
        """One of another track, by the same dictionaries, that begins anew."""
        return GopEncoder(self._setting, replace(self._options, step=self.step), number)

    def stay(self, frames: int, method: GopMethod) -> None:
        """Skip frames that are not coded; they repeat the previous frame, or the first one."""
        # The track counts its frames even if nothing is coded, as decoders do.
        self._track.code(method, frames, 1.0, 0, np.empty((0, 0)))
        self._depth = self._follow(method)
        self._kept = []

    def method_with_basis(self, together: int) -> GopMethod:
        """Return the method of the next GOP with a basis, given the longest chain of GOPs."""
        # A chain of references must end: a viewer that joins late, or a lost GOP, waits for its beginning.
        following = 0 <= self._depth < together - 1
        return GopMethod.LEARNT_NEXT if following else GopMethod.LEARNT

    def _follow(self, method: GopMethod) -> int:
        """The depth of a GOP that comes next."""
        return (
            -1
            if not method.has_basis
            else self._depth + 1
            if method is GopMethod.LEARNT_NEXT
            else 0
        )

    @property
    def low_delay(self) -> bool:
        return self._options.low_delay > 0

    def is_key(self, number: int, vertices: int) -> bool:
        """Whether those are key frames that begin with frame `number` of a sequence of low delay."""
        longest, together = self._options.longest(vertices), self._options.low_delay
        return number % (longest - longest % together) == 0

    def encode_next(self, frames: Matrix, progress: Progress, *, key: bool) -> GopField:
        """Encode frames, shape (T, n, d), without a basis of their own."""
        if key:
            self._kept = []
        width, columns = self._width, self._width * len(frames)
        back = self._nearest(frames)
        # With few frames there is nothing to learn a basis from, and cosines need not be sent.
        # Each cosine in one number after the other.
        rows = np.kron(time_cosines(len(frames)), np.eye(width))
        basis = np.ascontiguousarray(rows.reshape(len(frames), width, -1).transpose(1, 0, 2))
        targets = temporal.trajectories(frames) @ basis.reshape(-1, columns)
        method = GopMethod.KEY_FRAME if key else GopMethod.NEXT_FRAME
        payload, field = self._track.code(method, len(frames), self.step, back, targets)
        progress(1, 1)
        self._depth = -1
        self.latest = np.array(list(temporal.frames_of(field, 0, basis)))
        self._kept = [*self.latest[::-1], *self._kept][: self._setting.reach(self._number)]
        return GopField(width, self.step, columns, np.empty(0, np.int32), b"", payload, back)

    def encode_learnt(
        self, fields: Matrix, shapes: Matrix, weights: Matrix, method: GopMethod, progress: Progress
    ) -> LearntGop:
        """Encode frames, products of `fields`, shape (n, k), and shapes, (k, d, T), by a basis learnt from them; errors
        count by `weights`, shape (T,).
        """
        frames, weights = shapes.shape[2], np.tile(weights, self._width)
        motion = shapes.reshape(len(shapes), self._width * frames) * weights
        body, columns = self._basis(motion, weights)
        progress(1, 2)
        basis = columns * weights[:, None]
        # The basis was rounded, so its columns are not quite orthogonal. The pseudo-inverse fits motion to what
        # decoders have.
        fit = basis @ np.linalg.pinv(basis.T @ basis, hermitian=True)
        targets = fields @ (motion @ fit)
        # Coded and decoded in one: what follows must build on the decoded coefficients.
        levels, coefficients = self._track.code(method, frames, self.step, 0, targets)
        field = coefficients.reshape(targets.shape)  # which may have no columns
        progress(2, 2)
        self._depth = self._follow(method)
        bases = columns.reshape(self._width, frames, body.components)
        return LearntGop(replace(body, levels=levels), field, bases)

    def _nearest(self, frames: Matrix) -> int:
        """How far before them the kept frames are that they are so like that it is better to start from these."""
        count = len(frames)
        backs = range(count, len(self._kept) + 1)
        if not backs:
            return 0
        off = [
            sum(_apart(frames[t], self._kept[back - 1 - t]) for t in range(count)) for back in backs
        ]
        latest = sum(_apart(frame, self._kept[0]) for frame in frames)
        best = int(np.argmin(off))
        return backs[best] if off[best] < LIKE * latest else 0

    def _basis(self, motion: Matrix, weights: Matrix) -> tuple[GopField, Matrix]:
        """A field without the levels of parts, and its temporal basis, of weighted motion, shape (k, dT)."""
        width = self._width
        learnt, exponents = temporal.learn_basis(motion, self.step, MAX_EXPONENT)
        spectrum = temporal.spectrum_of(learnt / weights[:, None], exponents, width)
        payload, basis = self._track.basis(exponents, spectrum)
        return GopField(width, self.step, len(exponents), exponents, payload, b""), basis.reshape(
            spectrum.shape
        )


def _apart(first: Matrix, second: Matrix) -> float:
    return float(np.square(first - second).sum())
