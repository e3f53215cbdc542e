"""Sequences that every decoder must refuse."""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import cache
from unittest.mock import patch

from bsm.bitstream.container.wire import FrameType, write_map, write_varint
from bsm.codec.sequence.verification import SequenceVerifier
from tools.surgery import Cursor, Frames, change_entries, frames_of, header_entries, stream_of, with_header
from tools.vectors.bad import Bad, unlike
from tools.vectors.good_sequences import SEQUENCES, _runs

Edit = Callable[[bytes], bytes]

_STEP = slice(3, 7)  # of the data of a GOP with a basis, of fewer than 128 frames, all of them coded


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


def _learnt_behind_frame(frames: Frames) -> Frames:
    place = _gops_of(frames)[1]
    return [*frames[:place], (FrameType.GOP, b"\x01\x03\x01" + _FIELD), *frames[place + 1 :]]


def _step(value: float) -> Edit:
    return lambda data: data[: _STEP.start] + struct.pack("<f", value) + data[_STEP.stop :]


def _stretches(*codes: int) -> Callable[[], bytes]:
    """A first GOP, of six frames, with stretches of such beginnings and lengths."""
    coded = b"".join(map(write_varint, (len(codes) // 2, *codes)))
    return _gop(lambda data: data[:2] + coded + data[3:])


def _back(frames: int) -> Edit:
    """Next frames that start from those so far before them."""
    return lambda data: data[:6] + bytes([frames]) + data[7:]


def _fields(attribute: Edit, positions: Edit) -> Edit:
    """Edit the field of the first attribute that a GOP codes, and that of positions, which comes after it."""

    def edit(data: bytes) -> bytes:
        cursor = Cursor(data)
        cursor.take(1)
        cursor.varint()
        for _ in range(2 * cursor.varint()):
            cursor.varint()
        assert cursor.varint() == 3
        cursor.varint()
        begin = cursor.at
        field = attribute(cursor.take(cursor.varint()))
        others = cursor.at
        for _ in range(2):
            cursor.varint()
            cursor.take(cursor.varint())
        head = data[:begin] + write_varint(len(field)) + field + data[others : cursor.at]
        return head + positions(cursor.rest())

    return edit


def _shorter(field: bytes) -> bytes:
    return field[:-12]


def _longer(field: bytes) -> bytes:
    return field + bytes(20)


def _keeping(meshes: int, *kinds: int) -> Callable[[], bytes]:
    """Tori that come again, by an encoder for decoders that keep more meshes than they do."""

    def make() -> bytes:
        trusting = patch.object(SequenceVerifier, "take", lambda verifier, chunk, **_: chunk)
        with trusting, patch("bsm.codec.sequence.encoder.KEPT_MESHES", meshes):
            return _runs("", *((kind, 1) for kind in kinds)).make()

    return make


def _headers_of(frames: Frames) -> list[int]:
    return [i for i, (kind, _) in enumerate(frames) if kind == FrameType.HEADER]


def _with_run(data: bytes, number: int, **fields: object) -> bytes:
    """The stream with other fields in the header of a run."""
    frames = frames_of(data)
    place = _headers_of(frames)[number]
    entries = dict(header_entries(frames[place][1]))
    change_entries(entries, fields)
    kept = sorted((key, value) for key, value in entries.items() if value is not None)
    frames[place] = (FrameType.HEADER, write_map(kept))
    return stream_of(frames)


def _run(number: int = 1, **fields: object) -> Callable[[], bytes]:
    return lambda: _with_run(_base("runs"), number, **fields)


def _from_run(number: int) -> Callable[[Frames], Frames]:
    return lambda frames: frames[_headers_of(frames)[number] :]


def _without_gops(frames: Frames) -> Frames:
    second = _headers_of(frames)[1]
    return [frame for i, frame in enumerate(frames) if i > second or frame[0] != FrameType.GOP]


def _without_header(frames: Frames) -> Frames:
    place = _headers_of(frames)[2]
    return frames[:place] + frames[place + 1 :]


def _with_connectivity(frames: Frames) -> Frames:
    place = _headers_of(frames)[2] + 1
    return [*frames[:place], next(frame for frame in frames if frame[0] == FrameType.CONNECTIVITY), *frames[place:]]


_FIELD = struct.pack("<fBB", 1.0, 0, 0)
"""Of no components."""


def _with_fields(*fields: tuple[int, bytes]) -> Edit:
    """A GOP that tells of other attributes: number and field of each."""

    def edit(data: bytes) -> bytes:
        changes = b"".join(write_varint(number) + write_varint(len(field)) + field for number, field in fields)
        return data[:3] + write_varint(len(fields)) + changes + _positions_of(data)

    return edit


def _positions_of(data: bytes) -> bytes:
    """The field of positions of a GOP of fewer than 128 frames, all of them coded."""
    return _fields_of(data)[1]


def _fields_of(data: bytes) -> tuple[list[tuple[int, bytes]], bytes]:
    cursor = Cursor(data[3:])
    fields = [(cursor.varint(), cursor.take(cursor.varint())) for _ in range(cursor.varint())]
    return fields, cursor.rest()


def _far(data: bytes) -> bytes:
    """The velocity of a later GOP, which differs in its first frame, too, with a step as large as can be."""
    later = [payload for kind, payload in frames_of(_base("moving")) if kind == FrameType.GOP][1]
    fields, _ = _fields_of(later[1:])
    large = struct.pack("<f", float.fromhex("0x1.fffffep+127"))
    return _with_fields(*((number, large + field[4:] if number == 2 else field) for number, field in fields))(data)


def _without_values(frames: Frames) -> Frames:
    last = [i for i, (kind, _) in enumerate(frames) if kind == FrameType.VALUES][-1]
    return frames[:last] + frames[last + 1 :]


BAD_SEQUENCES: dict[str, Bad] = {
    "unsupported-sequence-smoothing": Bad(
        "smoothing of a sequence", "unsupported", lambda: with_header(_base("learnt"), smoothing=1.0)
    ),
    "bad-sequence-empty": Bad("a GOP without method", "corrupt", _gop(lambda d: b"")),
    "bad-sequence-end-positions": Bad(
        "positions that are none of the encoder's", "corrupt", lambda: unlike(_base("learnt"))
    ),
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
    "bad-sequence-components": Bad("more components than 3 T", "corrupt", _gop(lambda d: d[:7] + b"\x13" + d[8:])),
    "bad-sequence-stretch-none": Bad("a stretch of no frames", "corrupt", _stretches(0, 6, 0, 0)),
    "bad-sequence-stretch-long": Bad("stretches of more frames than there are", "corrupt", _stretches(0, 4, 0, 3)),
    "bad-sequence-stretch-short": Bad("stretches of fewer frames than there are", "corrupt", _stretches(0, 3, 1, 2)),
    "bad-sequence-stretch-before": Bad("a stretch that turns back before frame 0", "corrupt", _stretches(0, 3, 11, 3)),
    "bad-sequence-stretch-behind": Bad("a stretch of frames behind the last", "corrupt", _stretches(0, 3, 12, 3)),
    "bad-sequence-stretch-components": Bad(
        "more components than 3 Q, as one frame is told of", "corrupt", _stretches(1, 6)
    ),
    "bad-sequence-exponent": Bad("an exponent of 401", "corrupt", _gop(lambda d: d[:8] + write_varint(802) + d[9:])),
    "bad-sequence-exponent-negative": Bad("an exponent below 0", "corrupt", _gop(lambda d: d[:8] + b"\x01" + d[10:])),
    "bad-sequence-levels-short": Bad("levels that end too early", "truncated", _gop(lambda d: d[:-9])),
    "bad-sequence-levels-long": Bad("bytes behind the levels", "corrupt", _gop(lambda d: d + b"\x55" * 9)),
    "bad-sequence-moving-count": Bad(
        "a GOP that tells of no attribute, and says that it does", "corrupt", _gop(_with_fields(), base="moving")
    ),
    "bad-sequence-moving-still": Bad(
        "a GOP that tells of an attribute that does not move", "corrupt", _gop(_with_fields((1, b"x")), base="moving")
    ),
    "bad-sequence-moving-twice": Bad(
        "a GOP that tells of an attribute twice", "corrupt", _gop(_with_fields((3, _FIELD), (3, _FIELD)), base="moving")
    ),
    "bad-sequence-moving-short": Bad(
        "a field that ends in its step", "corrupt", _gop(_with_fields((3, _FIELD[:3])), base="moving")
    ),
    "bad-sequence-moving-step": Bad(
        "a field with a step of 0", "corrupt", _gop(_with_fields((3, bytes(4) + _FIELD[4:])), base="moving")
    ),
    "bad-sequence-moving-components": Bad(
        "a field of more components than d T", "corrupt", _gop(_with_fields((3, _FIELD[:4] + b"\x05")), base="moving")
    ),
    "bad-sequence-moving-far": Bad("values beyond the range of single precision", "numeric", _gop(_far, base="moving")),
    "bad-sequence-moving-late": Bad(
        "first values of an attribute that moves are missing", "corrupt", _frames(_without_values, base="moving")
    ),
    "bad-sequence-next-first": Bad(
        "a frame that refers to one before the first", "corrupt", _frames(_without(0), base="low-delay")
    ),
    "bad-sequence-next-after-gop": Bad(
        "a first frame that refers to the one before it", "corrupt", _gop(lambda d: b"\x02" + d[1:], base="low-delay")
    ),
    "bad-sequence-learnt-next-first": Bad(
        "a first GOP that refers to one before it", "corrupt", _gop(lambda d: b"\x03" + d[1:])
    ),
    "bad-sequence-learnt-next-after-frame": Bad(
        "components that refer to frames without", "corrupt", _frames(_learnt_behind_frame, base="low-delay")
    ),
    "bad-sequence-back-early": Bad(
        "a frame that starts from one that is not kept", "corrupt", _gop(_back(3), 1, base="low-delay")
    ),
    "bad-sequence-back-late": Bad(
        "frames that start from some of their own", "corrupt", _gop(_back(2), 1, base="together")
    ),
    "bad-sequence-run-number": Bad("a run that is not the next", "corrupt", _run(run=[2])),
    "bad-sequence-run-frames": Bad("a run that announces other frames", "corrupt", _run(frames=9)),
    "bad-sequence-run-static": Bad("a static mesh behind a run", "corrupt", _run(run=None, sequence=None)),
    "bad-sequence-paper-default": Bad(
        "paper as the law has it for sequences",
        "corrupt",
        lambda: with_header(_base("learnt"), paper=[0.0, 0.0, 0.0, 3.0, 2.0, 2.0, 2.0**-5, 1.0]),
    ),
    "bad-sequence-run-zero": Bad("run 0 is stored", "corrupt", lambda: with_header(_base("runs"), run=[0])),
    "bad-sequence-gop-zero": Bad("GOPs of no frames", "corrupt", lambda: with_header(_base("learnt"), gop_frames=0)),
    "bad-sequence-refinement": Bad(
        "a layer of a sequence", "corrupt", lambda: with_header(_base("learnt"), refinement=[0.1, 3.0])
    ),
    "bad-sequence-run-begins": Bad("a stream that begins with run 1", "corrupt", _frames(_from_run(1), base="runs")),
    "bad-sequence-run-early": Bad("a HEADER before any GOP", "corrupt", _frames(_without_gops, base="runs")),
    "bad-sequence-run-of-gop": Bad(
        "a GOP of another run", "corrupt", _gop(lambda d: bytes([d[0] + 8]) + d[1:], 1, base="runs")
    ),
    "bad-sequence-run-lost": Bad("a HEADER is missing", "corrupt", _frames(_without_header, base="runs")),
    "bad-sequence-again-connectivity": Bad(
        "a run that has a mesh again and brings one", "corrupt", _frames(_with_connectivity, base="runs")
    ),
    "bad-sequence-again-fields": Bad("a run that has a mesh again, and blocks", "corrupt", _run(2, blocks=1)),
    "bad-sequence-again-later": Bad("a run that has its own mesh again", "corrupt", _run(2, run=[2, 2])),
    "bad-sequence-again-none": Bad(
        "a run that says another size of a mesh again", "corrupt", _run(2, run=[2, 1], faces=64)
    ),
    "bad-sequence-again-gone": Bad(
        "a run that has a mesh again which is kept no longer",
        "corrupt",
        lambda: _with_run(_base("runs-many"), 11, run=[11, 0], vertices=12, faces=24),
    ),
    "bad-sequence-again-ninth": Bad(
        "a run that has the ninth of the latest meshes again", "corrupt", _keeping(9, *range(3, 12), 3)
    ),
    "bad-sequence-again-older": Bad(
        "a mesh that is gone, since another one has come again", "corrupt", _keeping(9, *range(3, 11), 3, 11, 4)
    ),
    "bad-sequence-moving-attribute-first": Bad(
        "an attribute that ends early, before positions that end late",
        "truncated",
        _gop(_fields(_shorter, _longer), base="moving"),
    ),
    "bad-sequence-moving-attribute-later": Bad(
        "an attribute that ends late, before positions that end early",
        "corrupt",
        _gop(_fields(_longer, _shorter), base="moving"),
    ),
    "bad-sequence-again-next": Bad(
        "a run whose first frame refers to one of another",
        "corrupt",
        _gop(lambda d: bytes([d[0] + 1]) + d[1:], 5, base="runs-low-delay"),
    ),
    "bad-sequence-not-finite": Bad(
        "frames beyond the greatest double", "numeric", lambda: with_header(_gop(_step(3e38))(), scale=1e300)
    ),
}
