"""Streams taken apart and put together again with right checksums, however wrong: for vectors and fuzzing."""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Iterator
from typing import Any

import msgpack

from bsm.bitstream.container.header import (
    HEADER_DEFAULTS,
    HEADER_FIELDS,
    LAW,
    LAW_OF_SEQUENCES,
    Declaration,
    Paper,
    fields_of,
)
from bsm.bitstream.container.packets import Packet
from bsm.bitstream.container.scanner import FrameSpan, Scanner
from bsm.bitstream.container.wire import (
    MAGIC,
    PREAMBLE_BYTES,
    VERSION,
    Cursor,
    FrameType,
    parse_frame,
    parse_map,
    write_frame,
    write_map,
    write_varint,
)
from bsm.bitstream.container.writer import Writer
from bsm.bitstream.errors import BsmError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS

Frames = list[tuple[int, bytes]]


def frames_of(stream: bytes) -> Frames:
    """Type and payload of every frame of a stream, END left out."""
    frames: Frames = []
    offset = PREAMBLE_BYTES
    while offset < len(stream):
        frame = parse_frame(stream, offset, DEFAULT_LIMITS)
        if frame is None:
            raise ValueError(f"the stream ends inside the frame at byte {offset}")
        frames.append((frame.type, frame.payload))
        offset += frame.size
    return [frame for frame in frames if frame[0] != FrameType.END]


def scan(chunks: Iterable[bytes], scanner: Scanner | None = None) -> Iterator[tuple[Packet, FrameSpan]]:
    """Yield the packets of a whole stream, and where the frame of each lies."""
    scanner = scanner or Scanner()
    for chunk in chunks:
        yield from scanner.receive(chunk)
    if not scanner.ended:
        raise TruncatedError("the stream ends before its END frame")


def write_stream(packets: list[Packet]) -> bytes:
    """Return a whole stream: preamble, the packets given, END."""
    writer = Writer()
    return b"".join([writer.start(), *(writer.write(packet) for packet in packets), writer.end()])


def stream_of(frames: Frames, version: int = VERSION) -> bytes:
    """The stream of these frames, with an END that fits them."""
    body = MAGIC + bytes([version]) + b"".join(write_frame(kind, payload) for kind, payload in frames)
    return body + write_frame(FrameType.END, write_varint(len(frames)) + zlib.crc32(body).to_bytes(4, "little"))


PARTS = {"paper": tuple(fields_of(Paper)), "sequence": ("frames", "gop_frames")}
"""Fields of the header that are lists of numbers with names of their own."""
PLACES = {part: (name, place) for name, parts in PARTS.items() for place, part in enumerate(parts)}


def header_frame(**values: Any) -> tuple[int, bytes]:
    """A header of any fields, by name, but for those that have their default; checked by nobody."""
    entries = {
        HEADER_FIELDS[name].key: HEADER_FIELDS[name].normalise(value)
        for name, value in values.items()
        if name not in PLACES
        and (name not in HEADER_DEFAULTS or HEADER_DEFAULTS[name] != HEADER_FIELDS[name].normalise(value))
    }
    _set_parts(entries, {name: value for name, value in values.items() if name in PLACES})
    return FrameType.HEADER, write_map(sorted(entries.items()))


def change_entries(entries: dict[int, Any], changes: dict[str, Any]) -> None:
    """Change fields of a header by name, in place (None: not stored), those within `paper` and `sequence` as well."""
    _set_parts(entries, {name: value for name, value in changes.items() if name in PLACES})
    entries |= {HEADER_FIELDS[name].key: value for name, value in changes.items() if name not in PLACES}


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
    """Key and value of every field that a header stores."""
    return dict(msgpack.unpackb(payload, strict_map_key=False))


def first_entries(stream: bytes) -> dict[int, Any]:
    """What the header of a stream stores, whatever comes behind it; nothing if there is none that can be read."""
    try:
        frame = parse_frame(stream, PREAMBLE_BYTES, DEFAULT_LIMITS)
        return header_entries(frame.payload) if frame is not None and frame.type == FrameType.HEADER else {}
    except (BsmError, ValueError, TypeError):
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
    entries = dict(parse_map(cursor.take(length)))
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
