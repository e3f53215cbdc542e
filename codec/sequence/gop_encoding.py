"""GOPs of a run, in the way that costs least; the twin of `codec.sequence.gop_decoding`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bsm.bitstream.container.gop import GopBody, GopField, GopMethod
from bsm.codec.arrays import Matrix, Order, Positions
from bsm.codec.sequence.first_frame_encoding import Opening, open_sequence
from bsm.codec.sequence.gop import GopDecoder, GopEncoder, silent
from bsm.codec.sequence.groups import Group
from bsm.codec.sequence.history import Inherited
from bsm.codec.sequence.level_writer import ROUNDS
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.promise import Promise
from bsm.codec.sequence.returning import told_frames
from bsm.codec.sequence.row_prediction import LARGEST_LEVEL
from bsm.codec.sequence.watch import Watch
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.ways.block_coder import Progress
from bsm.codec.static.work import Allowance

HARDLY_CUT = 256
"""So many frames are one GOP: in no sequence seen did two cost less."""

TOGETHER = 4
"""GOPs with a basis of which each but the first refers to the one before; who comes late waits no longer than that."""

FINEST_STEP = 2e-5
"""Below, a search does not look."""

NEAR = 0.8, 1.15
"""A first frame will do for steps so many times that for which it was coded."""


@dataclass(frozen=True, eq=False)
class Wish:
    """How frames are to be encoded."""

    step: float
    weights: Matrix | None = None
    singly: bool | None = None
    cut: bool | None = None
    rounds: int = ROUNDS


@dataclass(frozen=True, eq=False)
class Coded:
    """GOPs that were encoded with some step."""

    opening: Opening
    encoder: GopEncoder
    bodies: tuple[GopBody, ...]
    before: Inherited | None = None

    @property
    def singly(self) -> bool:
        """Whether frames are sent one by one."""
        return not self.bodies[0].method.has_basis

    @property
    def cut(self) -> bool:
        """Whether there are several GOPs."""
        return len(self.bodies) > 1

    @property
    def decoded(self) -> Positions:
        """What the decoder makes of them, shape (T, n, 3), in BSM units; not kept, since it is large."""
        if self.encoder.low_delay and self.encoder.latest is not None:
            return self.encoder.latest
        setting = self.opening.setting
        decoder = GopDecoder(setting, setting.tracks[:1], [self.before] if self.before else None)
        frames = np.empty((sum(body.frames for body in self.bodies), setting.vertices, 3))
        for number, (frame,) in enumerate(frame for body in self.bodies for frame in decoder.decode(body)):
            frames[number] = frame
        return frames


class Gops:
    """GOPs of a run, each with the step that keeps the options' promise in it, if there is one."""

    def __init__(self, prepared: Prepared, options: SequenceOptions, count: int, tell: Progress) -> None:
        self._prepared, self._options = prepared, options
        self._count, self._tell = count, tell

    def first(self, group: Group, before: Allowance, moving: Sequence[Matrix]) -> Coded:
        """The first frame, with values that move, shapes (n, d), as of `make_setting`, and the first GOP."""
        opened: Opening | None = None
        opened_for = 0.0
        options = self._options

        def attempt(wish: Wish, tell: Progress = silent) -> Coded:
            nonlocal opened, opened_for
            if opened is None or not NEAR[0] <= wish.step / opened_for <= NEAR[1]:
                opened_for = wish.step
                fitting = replace(options, step=wish.step)
                opened = open_sequence(self._prepared, fitting, self._count, tell, before, moving)
            encoder = GopEncoder(opened.setting, options)
            return attempted(opened, encoder, wish, group, 0, tell)

        if options.promise is None:
            return attempt(Wish(options.step), self._tell)
        coded = self._settled(attempt, group.positions, options.promise, None)
        for _ in range(2):
            self._tell(len(coded.opening.blocks), len(coded.opening.blocks))
        return coded

    def next(self, group: Group, number: int, before: Coded) -> Coded:
        """The GOP behind another; its first frame has this number."""
        opening = before.opening

        def attempt(wish: Wish, tell: Progress = silent) -> Coded:
            return attempted(opening, before.encoder.copy(), wish, group, number, tell)

        if self._options.promise is None:
            return attempt(Wish(before.encoder.step), self._tell)
        coded = self._settled(attempt, group.positions, self._options.promise, before.encoder.step)
        self._tell(len(opening.blocks), len(opening.blocks))
        return coded

    def _settled(
        self, attempt: Callable[[Wish], Coded], frames: Positions, promise: Promise, first: float | None
    ) -> Coded:
        """What keeps the promise; the step to try first is the promise's own, if none is given."""
        prepared, options = self._prepared, self._options
        watch = Watch(frames, prepared.mesh.faces, promise, prepared.units.scale, options.threads)
        singly: bool | None = None
        cut: bool | None = None

        def settled(step: float, weights: Matrix | None, rounds: int) -> Coded:
            nonlocal singly, cut
            coded = attempt(Wish(step, weights, singly, cut, rounds))
            singly, cut = coded.singly, coded.cut  # as the first attempt was, so are the others
            return coded

        return watch.settle(settled, first or promise.first_step, finest_step(frames, options))


def finest_step(frames: Sequence[Matrix] | Positions, options: SequenceOptions) -> float:
    """The finest step to try for frames, each of shape (n, 3): levels can be coded if all motion is one component."""
    scale = float(np.linalg.norm(np.ptp(frames[0], axis=0))) or 1.0
    middle, longest = frames[0].mean(axis=0), options.longest(len(frames[0]))
    most = 0.0
    for first in range(0, len(frames), longest):
        energies = np.zeros(len(frames[0]))
        for frame in frames[first : first + longest]:
            energies += np.square(frame - middle).sum(axis=1)
        most = max(most, float(np.sort(energies)[-2 * options.block_size :].sum()))
    return max(FINEST_STEP, 2.0 * float(np.sqrt(most)) / scale / LARGEST_LEVEL)


def attempted(opening: Opening, encoder: GopEncoder, wish: Wish, group: Group, number: int, tell: Progress) -> Coded:
    """Encode the next frames, of which the first has this number, in the way that costs least."""
    encoder.step, encoder.rounds = wish.step, wish.rounds
    frames, before = group.positions, encoder.inherited
    weights = np.ones(len(frames)) if wish.weights is None else wish.weights
    if encoder.low_delay:
        key = encoder.is_key(number, frames.shape[1])
        method = GopMethod.KEY_FRAME if key else GopMethod.NEXT_FRAME
        bodies: tuple[GopBody, ...] = (GopBody(method, len(frames), (encoder.encode_next(frames, tell, key=key),)),)
    elif wish.singly:
        bodies = _singles(encoder.encode_singles(frames, weights))
    else:
        learnt = _learnt(opening, encoder, frames, weights, group.same(encoder.step), wish.cut, tell)
        singles = encoder.encode_singles(frames, weights, learnt.cost) if wish.singly is None else ()
        if not singles:
            return Coded(opening, learnt.encoder, learnt.bodies, before)
        bodies = _singles(singles)
    return Coded(opening, encoder, bodies)


def _singles(fields: tuple[GopField, ...]) -> tuple[GopBody, ...]:
    methods = (GopMethod.NEXT_FRAME if number else GopMethod.KEY_FRAME for number in range(len(fields)))
    return tuple(GopBody(method, 1, (field,)) for method, field in zip(methods, fields, strict=True))


@dataclass(frozen=True, eq=False)
class _Learnt:
    """GOPs with a basis, the encoder behind them, and their cost."""

    bodies: tuple[GopBody, ...]
    encoder: GopEncoder
    cost: float


def _learnt(
    opening: Opening,
    encoder: GopEncoder,
    frames: Positions,
    weights: Matrix,
    same: Order,
    cut: bool | None,
    tell: Progress,
) -> _Learnt:
    """Frames as one GOP, or as more where that costs less or decoders would lack the memory."""
    half = len(frames) // 2
    whole: _Learnt | None = None
    if not (cut and half):
        whole = _whole(encoder.copy(), frames, weights, same, tell)
        has_room = opening.has_room(*whole.bodies)
        if not half or (has_room and (cut is not None or len(frames) <= HARDLY_CUT)):
            return whole
        if not has_room:
            whole = None
    first = _learnt(opening, encoder, frames[:half], weights[:half], same[:half], False, silent)
    second = _learnt(opening, first.encoder, frames[half:], weights[half:], same[half:], False, silent)
    halves = _Learnt(first.bodies + second.bodies, second.encoder, first.cost + second.cost)
    return halves if whole is None or halves.cost < whole.cost else whole


def _whole(encoder: GopEncoder, frames: Positions, weights: Matrix, same: Order, tell: Progress) -> _Learnt:
    """Frames as one GOP, which tells once of those that are the same."""
    told, shown = told_frames(same)
    method = encoder.method_with_basis(TOGETHER)
    if len(told) == len(frames):
        field, cost = encoder.encode_learnt(frames, weights, method, tell)
        return _Learnt((GopBody(method, len(frames), (field,)),), encoder, cost)
    field, cost = encoder.encode_learnt(frames[told], np.sqrt(np.bincount(shown, weights**2)), method, tell)
    return _Learnt((GopBody(method, len(frames), (field,), shown),), encoder, cost)
