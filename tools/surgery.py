"""Streams taken apart and put together again with right checksums, however wrong: for vectors and fuzzing."""

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import msgpack

from bsm.bitstream.container.header import (
    HEADER_FIELDS,
    LAW,
    LAW_OF_SEQUENCES,
    PAPER,
    Declaration,
    Header,
    fields_of,
)
from bsm.bitstream.container.packets import (
    BRIEF,
    BRIEF_TURNED,
    WRITERS,
    Declared,
    End,
    Metadata,
    Packet,
)
from bsm.bitstream.container.wire import (
    MAGIC,
    MAX_VARINT_BYTES,
    PREAMBLE_BYTES,
    SKIPPABLE_TYPES,
    VERSION,
    FrameType,
    checksum,
    checksum_size,
    write_frame,
    write_map,
    write_varint,
)
from bsm.bitstream.errors import BsmError, CorruptError

Frames = list[tuple[int, bytes]]


class Cursor:
    """Reads bytes from front to back; raises `CorruptError` where they end early."""

    def __init__(self, data: bytes, at: int = 0) -> None:
        self.data, self.at = data, at

    def varint(self) -> int:
        value = 0
        for place in range(MAX_VARINT_BYTES):
            (byte,) = self.take(1)
            value |= (byte & 0x7F) << 7 * place
            if byte < 0x80:
                break
        return value

    def take(self, count: int) -> bytes:
        if count > len(self.data) - self.at:
            raise CorruptError("the bytes end early")
        self.at += count
        return self.data[self.at - count : self.at]

    def rest(self) -> bytes:
        return self.take(len(self.data) - self.at)


@dataclass(frozen=True)
class Span:
    """A frame: its type and payload, and its place in the stream, tag and checksum included."""

    type: int
    payload: bytes
    offset: int
    length: int


def spans_of(stream: bytes) -> Iterator[Span]:
    """Yield all frames of a stream, END included; of a brief one those for which it stands."""
    cursor = Cursor(stream, PREAMBLE_BYTES)
    while (start := cursor.at) < len(stream):
        length, kind = divmod(cursor.varint(), 16)
        payload, body = cursor.take(length), stream[start : cursor.at]
        size = checksum_size(kind, length)
        if cursor.take(size) != checksum(size, body):
            raise CorruptError(f"checksum of the frame at byte {start} is wrong")
        if kind == FrameType.HEADER and _begins_brief(payload):
            yield from spans_of(stream_of(brief_frames(payload), stream[PREAMBLE_BYTES - 1]))
        else:
            yield Span(kind, payload, start, cursor.at - start)


def brief_frames(payload: bytes) -> Frames:
    """The frames for which that of a brief stream stands, without END."""
    (key, value), *notes = header_entries(payload).items()
    if not isinstance(value, bytes):
        raise CorruptError("a brief stream without bytes")
    cursor = Cursor(value)
    n, m, *grid, congruence = (cursor.varint() for _ in range(6))
    scale, *center = struct.unpack(">4f", cursor.take(16))
    more = {"turn": struct.unpack(">3f", cursor.take(12))} if key == BRIEF_TURNED else {}
    header = header_frame(
        vertices=n, faces=m, grid=grid, congruence=congruence, scale=scale, center=center, **more
    )
    connectivity = cursor.take(cursor.varint())
    values = write_varint(0) + write_varint(n) + cursor.rest()
    named = [(int(FrameType.METADATA), packed) for _, packed in notes if isinstance(packed, bytes)]
    return [
        header,
        *named,
        (int(FrameType.CONNECTIVITY), connectivity),
        (int(FrameType.GRID), values),
    ]


def first_payload(stream: bytes) -> bytes:
    """The payload of the first frame; of a brief stream, that which stands for all of them."""
    cursor = Cursor(stream, PREAMBLE_BYTES)
    return cursor.take(cursor.varint() // 16)


def is_brief(stream: bytes) -> bool:
    """Whether one frame is the whole stream."""
    return _begins_brief(first_payload(stream))


def _begins_brief(payload: bytes) -> bool:
    return payload[1:2] in (bytes([BRIEF]), bytes([BRIEF_TURNED]))


def frames_of(stream: bytes) -> Frames:
    """Type and payload of every frame of a stream, END left out."""
    return [(span.type, span.payload) for span in spans_of(stream) if span.type != FrameType.END]


def scan(stream: bytes) -> Iterator[tuple[Packet, Span]]:
    """Yield the packets of a stream, and their frames."""
    for span in spans_of(stream):
        if span.type not in SKIPPABLE_TYPES:
            yield parse_packet(span.type, span.payload), span


def parse_packet(kind: int, payload: bytes) -> Any:
    """Inverse of `WRITERS`."""
    made, cursor = next(made for made, (own, _) in WRITERS.items() if own == kind), Cursor(payload)
    if made is Header:
        return record_of(Header, payload)
    if made is Metadata:
        return Metadata(header_entries(payload))  # type: ignore[arg-type]
    if made is Declared:
        index, length = cursor.varint(), cursor.varint()
        return Declared(index, record_of(Declaration, cursor.take(length)), cursor.rest())
    if made is End:
        return End(cursor.varint(), *struct.unpack(f"<{len(cursor.data) // 4}I", cursor.rest()))
    return made(*(cursor.varint() for _ in fields(made)[1:]), cursor.rest())


def record_of(kind: Any, payload: bytes) -> Any:
    """The header or declaration that a map holds."""
    names = {declared.key: (name, declared) for name, declared in fields_of(kind).items()}
    entries = ((*names[key], value) for key, value in header_entries(payload).items())
    try:
        return kind(**{name: declared.normalize(value) for name, declared, value in entries})
    except (KeyError, TypeError, ValueError) as error:
        raise CorruptError(f"this cannot be read: {error}") from error


def stream_of(frames: Frames, version: int | None = None, positions: bytes = b"") -> bytes:
    """The stream of these frames, with an END that fits them, and has a checksum of positions if that is given.

    Without a version it has the least that its headers need (F 2.2), as encoders write it.
    """
    version = VERSION + max(map(_minor, frames), default=0) if version is None else version
    body = (
        MAGIC + bytes([version]) + b"".join(write_frame(kind, payload) for kind, payload in frames)
    )
    sums = zlib.crc32(body).to_bytes(4, "little") + positions
    return body + write_frame(FrameType.END, write_varint(len(frames)) + sums)


def _minor(frame: tuple[int, bytes]) -> int:
    """The minor version that has all fields of a frame, if it is a header, as far as it can be read."""
    try:
        entries = header_entries(frame[1]) if frame[0] == FrameType.HEADER else {}
        return max((minor for key, minor in LATER.items() if key in entries), default=0)
    except (BsmError, TypeError, ValueError):
        return 0


_LATER = {"onorm": 1, "congruence": 1, "turn": 1, "base": 2, "swift": 3, "repeats": 3}
LATER = {HEADER_FIELDS[name].key: minor for name, minor in _LATER.items()}
"""The minor versions of fields that 1.0 does not have."""
PARTS = {"paper": tuple(PAPER), "sequence": ("frames", "gop_frames")}
"""Fields of the header that are lists of numbers with names of their own."""
PLACES = {part: (name, place) for name, parts in PARTS.items() for place, part in enumerate(parts)}


def header_frame(**values: Any) -> tuple[int, bytes]:
    """A header of any fields, by name, except those at their default; unchecked."""
    entries = {
        HEADER_FIELDS[name].key: HEADER_FIELDS[name].normalize(value)
        for name, value in values.items()
        if name not in PLACES
        and HEADER_FIELDS[name].normalize(value) != HEADER_FIELDS[name].default
    }
    _set_parts(entries, {name: value for name, value in values.items() if name in PLACES})
    return FrameType.HEADER, write_map(sorted(entries.items()))


def change_entries(entries: dict[int, Any], changes: dict[str, Any]) -> None:
    """Change fields of a header by name, in place (None: not stored), those within `paper` and `sequence` as well."""
    _set_parts(entries, {name: value for name, value in changes.items() if name in PLACES})
    entries |= {
        HEADER_FIELDS[name].key: value for name, value in changes.items() if name not in PLACES
    }


def _set_parts(entries: dict[int, Any], changes: dict[str, Any]) -> None:
    for name, parts in PARTS.items():
        changed = {place: changes[part] for place, part in enumerate(parts) if part in changes}
        if changed:
            key = HEADER_FIELDS[name].key
            law = LAW_OF_SEQUENCES if HEADER_FIELDS["sequence"].key in entries else LAW
            usual = [float(getattr(law, part)) for part in parts] if name == "paper" else [0, 1]
            numbers = list(entries.get(key, usual))
            for place, value in changed.items():
                numbers[place] = usual[place] if value is None else type(usual[place])(value)
            entries[key] = None if name == "paper" and numbers == usual else numbers
            if entries[key] is None:
                del entries[key]


def header_entries(payload: bytes) -> dict[int, Any]:
    """Key and value of every field that a header or a declaration stores."""
    try:
        return dict(msgpack.unpackb(payload, strict_map_key=False))
    except (ValueError, TypeError) as error:
        raise CorruptError(f"not a map: {error}") from error


def first_entries(stream: bytes) -> dict[int, Any]:
    """The fields in the header of a stream; empty if it cannot be read."""
    try:
        frame = next(spans_of(stream), None)
        return (
            header_entries(frame.payload)
            if frame is not None and frame.type == FrameType.HEADER
            else {}
        )
    except CorruptError:
        return {}


def with_header(stream: bytes, which: int = 0, /, **changes: Any) -> bytes:
    """The stream with other fields in the header of a run, by name (None: not stored), unchecked."""
    headers = [payload for kind, payload in frames_of(stream) if kind == FrameType.HEADER]
    entries = header_entries(headers[which])
    change_entries(entries, changes)
    kept = sorted((key, value) for key, value in entries.items() if value is not None)
    return with_payload(stream, FrameType.HEADER, write_map(kept), which)


def with_declaration(stream: bytes, index: int, **changes: Any) -> bytes:
    """Change, add or (with None) remove fields of the declaration of an attribute; `key_40` is one without a name."""
    payload = [payload for kind, payload in frames_of(stream) if kind == FrameType.ATTRIBUTE][index]
    cursor = Cursor(payload)
    number, length = cursor.varint(), cursor.varint()
    entries = header_entries(cursor.take(length))
    keys = {name: declared.key for name, declared in fields_of(Declaration).items()}
    keys |= {name: int(name.removeprefix("key_")) for name in changes if name.startswith("key_")}
    entries |= {keys[name]: value for name, value in changes.items()}
    packed = write_map(sorted((key, value) for key, value in entries.items() if value is not None))
    changed = write_varint(number) + write_varint(len(packed)) + packed + cursor.rest()
    return with_payload(stream, FrameType.ATTRIBUTE, changed, index)


def with_payload(stream: bytes, kind: FrameType, payload: bytes, which: int = 0) -> bytes:
    """The stream with another payload in the frame number `which` of a type."""
    frames = frames_of(stream)
    place = [i for i, frame in enumerate(frames) if frame[0] == kind][which]
    frames[place] = (kind, payload)
    return stream_of(frames)
