"""GOPs of a run, in the way that costs least; the twin of `codec.sequence.gop_decoding`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.container.gop import GopBody, GopMethod
from bsm.codec.arrays import Matrix, Positions
from bsm.codec.sequence.first_frame_encoding import Opening
from bsm.codec.sequence.gop import GopDecoder, GopEncoder, silent
from bsm.codec.sequence.level_writer import ROUNDS
from bsm.codec.static.ways.block_coder import Progress


@dataclass(frozen=True, eq=False)
class Wish:
    """How GOPs are to be encoded; see the attributes of `GopEncoder`."""

    step: float
    weights: Matrix | None = None
    singly: bool | None = None
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
    def decoded(self) -> Positions:
        """What the decoder makes of them, shape (T, n, 3), in BSM units; not kept, since it is large."""
        if self.encoder.low_delay and self.encoder.latest is not None:
            return self.encoder.latest[None]
        decoder = GopDecoder(self.opening.setting)
        frames = np.empty((sum(body.frames for body in self.bodies), self.opening.setting.vertices, 3))
        for number, frame in enumerate(frame for body in self.bodies for frame in decoder.decode(body)):
            frames[number] = frame
        return frames


def attempted(
    opening: Opening, encoder: GopEncoder, wish: Wish, frames: Positions, number: int, tell: Progress
) -> Coded:
    encoder.step, encoder.weights, encoder.singly, encoder.rounds = wish.step, wish.weights, wish.singly, wish.rounds
    return Coded(opening, encoder, tuple(_affordable(opening, encoder, frames, number, tell)))


def _affordable(
    opening: Opening, encoder: GopEncoder, frames: Positions, number: int, progress: Progress
) -> Iterator[GopBody]:
    """Frames as one GOP or one by one, whatever costs less, or as shorter GOPs where decoders would lack the memory."""
    if encoder.low_delay:
        yield encoder.encode_single(frames[0], number, progress)
        return
    if encoder.singly:
        yield from encoder.encode_singles(frames)
        return
    learnt, cost = encoder.encode_learnt(frames, progress)
    half = len(frames) // 2
    if encoder.singly is None and (singles := encoder.encode_singles(frames, cost)):
        yield from singles
    elif half and not opening.has_room(learnt):
        weights = encoder.weights
        for part in (slice(half), slice(half, None)):
            encoder.weights = None if weights is None else weights[part]
            yield from _affordable(opening, encoder, frames[part], number + (part.start or 0), silent)
    else:
        yield learnt
