"""Sequences that every decoder must refuse."""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import cache

from bsm.bitstream.container.wire import FrameType, write_varint
from tools.surgery import Frames, frames_of, stream_of, with_header
from tools.vectors.bad import Bad
from tools.vectors.good_sequences import SEQUENCES

Edit = Callable[[bytes], bytes]

_STEP = slice(2, 6)  # of the data of a GOP of fewer than 128 frames


@cache
def _base(name: str) -> bytes:
    return SEQUENCES[f"good-sequence-{name}"].make()


def _gop(edit: Edit, which: int = 0, base: str = "learnt") -> Callable[[], bytes]:
    """A sequence with other data in GOP number `which`; `edit` does not see its index."""

    def make() -> bytes:
        frames = frames_of(_base(base))
        place = [i for i, (kind, _) in enumerate(frames) if kind == FrameType.GOP][which]
        payload = frames[place][1]
        frames[place] = (FrameType.GOP, payload[:1] + edit(payload[1:]))
        return stream_of(frames)

    return make


def _frames(edit: Callable[[Frames], Frames], base: str = "learnt") -> Callable[[], bytes]:
    return lambda: stream_of(edit(frames_of(_base(base))))


def _gops_of(frames: Frames) -> list[int]:
    return [i for i, (kind, _) in enumerate(frames) if kind == FrameType.GOP]


def _without(number: int) -> Callable[[Frames], Frames]:
    return lambda frames: [frame for i, frame in enumerate(frames) if i != _gops_of(frames)[number]]


def _first_block_gone(frames: Frames) -> Frames:
    place = next(i for i, (kind, _) in enumerate(frames) if kind == FrameType.BLOCK)
    return frames[:place] + frames[place + 1 :]


def _renumbered(frames: Frames) -> Frames:
    place = _gops_of(frames)[1]
    return [*frames[:place], (FrameType.GOP, b"\x05" + frames[place][1][1:]), *frames[place + 1 :]]


def _unknown_behind_gap(frames: Frames) -> Frames:
    place = _gops_of(frames)[0]
    return [*frames[:place], (FrameType.GOP, b"\x01\x04" + frames[place][1][2:]), *frames[place + 1 :]]


def _step(value: float) -> Edit:
    return lambda data: data[: _STEP.start] + struct.pack("<f", value) + data[_STEP.stop :]


BAD_SEQUENCES: dict[str, Bad] = {
    "unsupported-sequence-method": Bad("a GOP of method 3", "unsupported", _gop(lambda d: b"\x03" + d[1:])),
    "unsupported-sequence-smoothing": Bad(
        "smoothing of a sequence", "unsupported", lambda: with_header(_base("learnt"), smoothing=1.0)
    ),
    "bad-sequence-empty": Bad("a GOP without method", "corrupt", _gop(lambda d: b"")),
    "bad-sequence-no-frames": Bad("a GOP of no frames", "corrupt", _gop(lambda d: d[:1] + b"\0" + d[2:])),
    "bad-sequence-long": Bad("a GOP of more frames than announced", "corrupt", _gop(lambda d: d[:1] + b"\x07" + d[2:])),
    "bad-sequence-beyond": Bad(
        "frames beyond those announced", "corrupt", lambda: with_header(_base("learnt"), frames=7)
    ),
    "bad-sequence-missing-end": Bad("fewer frames than announced", "corrupt", _frames(_without(1))),
    "bad-sequence-missing-begin": Bad("the first GOP is missing", "corrupt", _frames(_without(0))),
    "bad-sequence-missing-unknown": Bad(
        "the first GOP is missing, and the method of the next is unknown", "corrupt", _frames(_unknown_behind_gap)
    ),
    "bad-sequence-overlap": Bad("a GOP that begins in the one before", "corrupt", _frames(_renumbered)),
    "bad-sequence-block": Bad("a block of the first frame is missing", "corrupt", _frames(_first_block_gone)),
    "bad-sequence-step-zero": Bad("a step of 0", "corrupt", _gop(_step(0.0))),
    "bad-sequence-step-negative": Bad("a step below 0", "corrupt", _gop(_step(-1.0))),
    "bad-sequence-step-infinite": Bad("an infinite step", "corrupt", _gop(_step(float("inf")))),
    "bad-sequence-step-nan": Bad("a step that is no number", "corrupt", _gop(_step(float("nan")))),
    "bad-sequence-components": Bad("more components than 3 T", "corrupt", _gop(lambda d: d[:6] + b"\x13" + d[7:])),
    "bad-sequence-exponent": Bad("an exponent of 401", "corrupt", _gop(lambda d: d[:7] + write_varint(802) + d[8:])),
    "bad-sequence-exponent-negative": Bad("an exponent below 0", "corrupt", _gop(lambda d: d[:7] + b"\x01" + d[9:])),
    "bad-sequence-levels-short": Bad("levels that end too early", "truncated", _gop(lambda d: d[:-9])),
    "bad-sequence-levels-long": Bad("bytes behind the levels", "corrupt", _gop(lambda d: d + b"\x55" * 9)),
    "bad-sequence-next-first": Bad(
        "a frame that refers to one before the first", "corrupt", _frames(_without(0), base="low-delay")
    ),
    "bad-sequence-next-after-gop": Bad(
        "a first frame that refers to the one before it",
        "corrupt",
        _gop(lambda d: b"\x02" + d[1:], base="low-delay"),
    ),
    "bad-sequence-not-finite": Bad(
        "frames beyond the greatest double", "numeric", lambda: with_header(_gop(_step(3e38))(), scale=1e300)
    ),
}
