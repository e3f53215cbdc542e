"""Every frame type and every field, each as large as its bytes allow.

The list of what there is to make large is that of the code: a field that is new is walked without a word here.
"""

from collections.abc import Iterator
from functools import cache, partial
from pathlib import Path
from random import Random
from typing import Any

from bsm.bitstream.container.header import HEADER_FIELDS, Declaration, Field, fields_of
from bsm.bitstream.container.wire import (
    MAX_ENTRIES,
    SKIPPABLE_TYPES,
    FrameType,
    write_map,
    write_varint,
)
from tools.attack.taken import Case
from tools.surgery import Frames, frames_of, stream_of, with_declaration, with_header

VECTORS = Path(__file__).parents[2] / "spec" / "vectors"
COUNTS = {"BLOCK": 2, "GOP": 1, "GRID": 2, "REFINEMENT": 3, "VALUES": 3, "ATTRIBUTE": 2, "END": 1}
"""Varints at the beginning of a payload."""
MOST_VARINT = 2**31 - 1


@cache
def _good() -> dict[str, bytes]:
    """The smallest sound vector that has a frame of each type, and one of several runs."""
    smallest: dict[str, bytes] = {}
    for path in sorted(VECTORS.glob("*/good-*.bsm"), key=lambda path: path.stat().st_size):
        stream = path.read_bytes()
        kinds = [kind for kind, _ in frames_of(stream)]
        for kind in kinds:
            smallest.setdefault(
                FrameType(kind).name if kind not in SKIPPABLE_TYPES else "SKIPPABLE", stream
            )
        if kinds.count(FrameType.CONNECTIVITY) > 1 and kinds.count(FrameType.HEADER) > 1:
            smallest.setdefault("RUN", stream)
    return smallest


def bases() -> dict[str, bytes]:
    """Streams of each kind: blocks, a grid, layers, a sequence, one of several runs, attributes."""
    return {
        kind: _good()[kind] for kind in ("BLOCK", "GRID", "REFINEMENT", "GOP", "RUN", "ATTRIBUTE")
    }


def _framed(base: str, kind: str) -> tuple[Frames, int]:
    """The frames of a stream, and the place of the last one of a type."""
    frames = frames_of(_good()[base])
    return frames, max(
        i for i, (frame_kind, _) in enumerate(frames) if frame_kind == FrameType[kind]
    )


def _longer(base: str, kind: str, fill: bytes) -> bytes:
    """A frame of a type with so much behind it."""
    frames, place = _framed(base, kind)
    frames[place] = (frames[place][0], frames[place][1] + fill)
    return stream_of(frames)


def _counted(base: str, kind: str, which: int, size: int) -> bytes:
    """One of the counts of a payload as large as it may be written, and bytes behind them."""
    frames, place = _framed(base, kind)
    counts = [1 if number != which else MOST_VARINT for number in range(COUNTS[kind])]
    frames[place] = (frames[place][0], b"".join(map(write_varint, counts)) + bytes(size))
    return stream_of(frames)


def _many(base: str, kind: str, size: int) -> bytes:
    """Fill a number of bytes with equal packets of a type."""
    frames, place = _framed(base, kind)
    count = max(1, size // (len(frames[place][1]) + 4))
    return stream_of([*frames[:place], *[frames[place]] * count, *frames[place + 1 :]])


def _largest(declared: Field, size: int) -> list[Any]:
    """The largest values that a field may have, or more."""
    high = declared.high
    if declared.type is tuple:
        return [[declared.item(high)] * count for count in (declared.lengths[1], MAX_ENTRIES)]
    if declared.type is str:
        return ["x" * int(high), "x" * size]
    if declared.type is bytes:
        return [bytes(min(int(high), size)), bytes([127]) * min(int(high), size)]
    return [declared.type(value) for value in (high, declared.low, MOST_VARINT)]


def _maps(size: int) -> Iterator[tuple[str, bytes]]:
    """Return maps that are as large as a number of bytes allows."""
    yield "entries", write_map((64 + i, i) for i in range(MAX_ENTRIES))
    yield "arrays", write_map([(64, [1] * MAX_ENTRIES)])
    yield "binary", write_map([(64, bytes(size))])
    yield "text", write_map([(64, "x" * size)])
    yield "nested", b"\x81\x40" + b"\x91" * size + b"\x01"
    yield "many", b"\x81\x40\xdd" + size.to_bytes(4, "big") + b"\x01" * size


def _of_frames(base: str, kind: str, size: int) -> Iterator[Case]:
    """One type of frame: longer, with larger counts, and many times."""
    name = kind if base == kind else f"{base} {kind}"
    fills = {"zeros": bytes(size), "ones": b"\xff" * size, "noise": Random(size).randbytes(size)}
    for what, fill in fills.items():
        yield Case(f"{name} and {what}", partial(_longer, base, kind, fill))
    for which in range(COUNTS.get(kind, 0)):
        yield Case(f"{name} count {which}", partial(_counted, base, kind, which, 1000))
    yield Case(f"{name}, many", partial(_many, base, kind, size))


def cases(size: int) -> Iterator[Case]:
    """Return all of them, of about this many bytes each."""
    for base, stream in bases().items():
        for name, declared in HEADER_FIELDS.items():
            for number, value in enumerate(_largest(declared, size)):
                yield Case(
                    f"{base} header {name} {number}",
                    partial(with_header, stream, -1, **{name: value}),
                )
    for name, declared in fields_of(Declaration).items():
        for number, value in enumerate(_largest(declared, size)):
            yield Case(
                f"declaration {name} {number}",
                partial(with_declaration, _good()["ATTRIBUTE"], 0, **{name: value}),
            )
    for kind in FrameType:
        if kind.name not in _good() and kind is not FrameType.END:
            raise ValueError(f"no vector has a frame of type {kind.name}")
        if kind is FrameType.END:
            continue
        yield from _of_frames(kind.name, kind.name, size)
    for kind in (FrameType.HEADER, FrameType.CONNECTIVITY, FrameType.BLOCK, FrameType.GOP):
        yield from _of_frames("RUN", kind.name, size)
    for kind in (FrameType.HEADER, FrameType.METADATA):
        for what, payload in _maps(size):
            yield Case(f"{kind.name} map of {what}", partial(_mapped, kind, payload))
    for what, payload in _maps(size):
        attribute_payload = write_varint(0) + write_varint(len(payload)) + payload
        yield Case(
            f"ATTRIBUTE map of {what}", partial(_mapped, FrameType.ATTRIBUTE, attribute_payload)
        )
    for number in SKIPPABLE_TYPES:
        yield Case(f"skippable {number}, many", partial(_skipped, number, b"", size // 3))
        yield Case(f"skippable {number}, long", partial(_skipped, number, bytes(size), 1))


def _mapped(kind: FrameType, payload: bytes) -> bytes:
    frames = frames_of(_good()["BLOCK" if kind is not FrameType.ATTRIBUTE else "ATTRIBUTE"])
    if kind is FrameType.METADATA:
        return stream_of([frames[0], (kind, payload), *frames[1:]])
    place = next(i for i, (frame_kind, _) in enumerate(frames) if frame_kind == kind)
    return stream_of([*frames[:place], (kind, payload), *frames[place + 1 :]])


def _skipped(kind: int, payload: bytes, count: int) -> bytes:
    frames = frames_of(_good()["BLOCK"])
    return stream_of([frames[0], *[(kind, payload)] * count, *frames[1:]])
