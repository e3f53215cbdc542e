"""GOPs of a run, in the way that costs least; the twin of `codec.sequence.gop_decoding`."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.container.gop import GopBody, GopField, GopMethod
from bsm.codec.arrays import Matrix, Positions
from bsm.codec.sequence.first_frame_encoding import Opening
from bsm.codec.sequence.gop import GopDecoder, GopEncoder, silent
from bsm.codec.sequence.level_writer import ROUNDS
from bsm.codec.static.ways.block_coder import Progress

HARDLY_CUT = 256
"""So many frames are one GOP: in no sequence seen did two cost less."""


@dataclass(frozen=True, eq=False)
class Wish:
    """How frames are to be encoded.

    Parameters
    ----------
    step : float
    weights : float64 array, shape (T,), optional
        What errors of each frame count, beside each other; None: all the same.
    singly : bool, optional
        Whether frames are sent one by one; None: if that costs less.
    cut : bool, optional
        Whether those that are not are two GOPs and not one; None: if that costs less.
    rounds : int
        As of `LevelWriter`.
    """

    step: float
    weights: Matrix | None = None
    singly: bool | None = None
    cut: bool | None = None
    rounds: int = ROUNDS


@dataclass(frozen=True, eq=False)
class Coded:
    """GOPs that were encoded with some step, the first frame before them, and their encoder."""

    opening: Opening
    encoder: GopEncoder
    bodies: tuple[GopBody, ...]

    @property
    def singly(self) -> bool:
        """Whether frames are sent one by one."""
        return self.bodies[0].method is not GopMethod.LEARNT

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
        decoder = GopDecoder(setting, setting.tracks[:1])
        frames = np.empty((sum(body.frames for body in self.bodies), setting.vertices, 3))
        for number, (frame,) in enumerate(frame for body in self.bodies for frame in decoder.decode(body)):
            frames[number] = frame
        return frames


def attempted(
    opening: Opening, encoder: GopEncoder, wish: Wish, frames: Positions, number: int, tell: Progress
) -> Coded:
    """Encode the next frames, shape (T, n, 3), of which the first has this number, in the way that costs least."""
    encoder.step, encoder.rounds = wish.step, wish.rounds
    weights = np.ones(len(frames)) if wish.weights is None else wish.weights
    if encoder.low_delay:
        key = encoder.is_key(number, frames.shape[1])
        method = GopMethod.KEY_FRAME if key else GopMethod.NEXT_FRAME
        bodies: tuple[GopBody, ...] = (GopBody(method, len(frames), (encoder.encode_next(frames, tell, key=key),)),)
    elif wish.singly:
        bodies = _singles(encoder.encode_singles(frames, weights))
    else:
        bodies, cost = _learnt(opening, encoder, frames, weights, wish.cut, tell)
        if wish.singly is None:
            bodies = _singles(encoder.encode_singles(frames, weights, cost)) or bodies
    return Coded(opening, encoder, bodies)


def _singles(fields: tuple[GopField, ...]) -> tuple[GopBody, ...]:
    """Frames that were encoded one by one, the first of them as a key frame."""
    methods = (GopMethod.NEXT_FRAME if number else GopMethod.KEY_FRAME for number in range(len(fields)))
    return tuple(GopBody(method, 1, (field,)) for method, field in zip(methods, fields, strict=True))


def _learnt(
    opening: Opening, encoder: GopEncoder, frames: Positions, weights: Matrix, cut: bool | None, tell: Progress
) -> tuple[tuple[GopBody, ...], float]:
    """Frames as one GOP, or as more where that costs less or decoders would lack the memory; with the cost."""
    half = len(frames) // 2
    whole: tuple[tuple[GopBody, ...], float] = (), math.inf
    if not (cut and half):
        field, cost = encoder.encode_learnt(frames, weights, tell)
        body = GopBody(GopMethod.LEARNT, len(frames), (field,))
        has_room = opening.has_room(body)
        if not half or (has_room and (cut is not None or len(frames) <= HARDLY_CUT)):
            return (body,), cost
        if has_room:
            whole = (body,), cost
    parts = (slice(half), slice(half, None))
    first, second = (_learnt(opening, encoder, frames[part], weights[part], False, silent) for part in parts)
    halves = first[0] + second[0], first[1] + second[1]
    return halves if halves[1] < whole[1] else whole
