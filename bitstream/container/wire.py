"""The smallest pieces of the format: varints, checksums, tags and frames, as twins of writing and parsing."""

import binascii
import struct
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import msgpack

from bsm.bitstream.errors import CorruptError, FormatError, OptionError, UnsupportedError
from bsm.bitstream.limits import Limits

MAGIC = b"\x89BSM"
MAJOR, MINOR = 1, 0
VERSION = 16 * MAJOR + MINOR
PREAMBLE_BYTES = len(MAGIC) + 1
MAX_VARINT_BYTES = 5
MAX_VARINT = (1 << 7 * MAX_VARINT_BYTES) - 1
SKIPPABLE_TYPES = range(8, 12)
SHORT = 128  # a payload of fewer bytes has a short checksum


class FrameType(IntEnum):
    """What a frame carries; the low four bits of its tag."""

    VALUES = 0
    HEADER = 1
    METADATA = 2
    CONNECTIVITY = 3
    PARTITION = 4
    ORDER = 5
    BLOCK = 6
    GOP = 7
    GRID = 12
    REFINEMENT = 13
    ATTRIBUTE = 14
    END = 15


@dataclass(frozen=True, slots=True)
class Frame:
    """One frame whose checksum is right; `size` counts its tag and checksum too."""

    type: int
    payload: bytes
    size: int


def write_preamble() -> bytes:
    return MAGIC + bytes([VERSION])


def parse_preamble(data: bytes) -> bool:
    """Check the beginning of a stream, as far as it has arrived."""
    if not MAGIC.startswith(data[: len(MAGIC)]):
        raise FormatError("not a BSM stream: it does not begin with 89 42 53 4D", offset=0)
    if len(data) <= len(MAGIC):
        return False
    require_major("this stream is", data[len(MAGIC)] >> 4, len(MAGIC))
    return True


def require_major(what: str, major: int, offset: int | None = None) -> None:
    if major != MAJOR:
        older = "encode the source again, or decode it with the release that wrote it"
        message = f"{what} written by version {major} of the format, and this reads {MAJOR}: "
        raise UnsupportedError(message + (older if major < MAJOR else "a later release reads it"), offset=offset)


def write_varint(value: int) -> bytes:
    """Unsigned LEB128 in its shortest form, at most five bytes."""
    if not 0 <= value <= MAX_VARINT:
        raise OptionError(f"{value} does not fit a varint (0..{MAX_VARINT})")
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def parse_varint(data: bytes | bytearray, start: int) -> tuple[int, int] | None:
    """The varint at `start` and the offset behind it; None if `data` ends inside."""
    value = 0
    for position, byte in enumerate(data[start : start + MAX_VARINT_BYTES]):
        value |= (byte & 0x7F) << 7 * position
        if byte < 0x80:
            if byte == 0 and position > 0:
                raise CorruptError("varint is not in its shortest form")
            return value, start + position + 1
    if len(data) - start < MAX_VARINT_BYTES:
        return None
    raise CorruptError(f"varint is longer than {MAX_VARINT_BYTES} bytes")


def checksum_size(frame_type: int, length: int) -> int:
    """Bytes of checksum behind a frame of so much payload: two for blocks and short ones, four for everything else."""
    return 2 if frame_type == FrameType.BLOCK or length < SHORT else 4


def checksum(size: int, data: bytes | bytearray | memoryview) -> bytes:
    """Two bytes: CRC-16 (CCITT polynomial 0x1021, initial value 0); of four: CRC-32 (as in zlib); little-endian."""
    value = binascii.crc_hqx(data, 0) if size == 2 else zlib.crc32(data)
    return value.to_bytes(size, "little")


def write_frame(frame_type: int, payload: bytes) -> bytes:
    """Tag, payload and checksum."""
    body = write_varint(len(payload) << 4 | frame_type) + payload
    return body + checksum(checksum_size(frame_type, len(payload)), body)


@dataclass(frozen=True, slots=True)
class Tag:
    """What a frame says about itself; `payload` and `end` are offsets into the data it was parsed from."""

    type: int
    length: int
    payload: int

    @property
    def checksum(self) -> int:
        return self.payload + self.length

    @property
    def end(self) -> int:
        return self.checksum + checksum_size(self.type, self.length)


def parse_tag(data: bytes | bytearray, start: int) -> Tag | None:
    """The tag of the frame at `start` of `data`; None if `data` ends inside it."""
    parsed = parse_varint(data, start)
    return None if parsed is None else Tag(parsed[0] & 15, parsed[0] >> 4, parsed[1])


def parse_frame(data: bytes | bytearray, start: int, limits: Limits) -> Frame | None:
    """The frame at `start` of `data`; None if `data` ends inside it."""
    tag = parse_tag(data, start)
    if tag is None:
        return None
    limits.check("frame_bytes", tag.length)
    ends, end = tag.checksum, tag.end
    if end > len(data):
        return None
    with memoryview(data) as view:
        if checksum(end - ends, view[start:ends]) != view[ends:end]:
            raise CorruptError(f"checksum of a frame of type {tag.type} and {tag.length} bytes is wrong")
        return Frame(tag.type, bytes(view[tag.payload : ends]), end - start)


class Cursor:
    """Reads a payload from front to back; what it lacks or has too much is a `CorruptError`."""

    def __init__(self, payload: bytes) -> None:
        self._payload = payload
        self._offset = 0

    def varint(self) -> int:
        parsed = parse_varint(self._payload, self._offset)
        if parsed is None:
            raise CorruptError("payload ends inside a varint")
        value, self._offset = parsed
        return value

    def take(self, count: int) -> bytes:
        if count > len(self._payload) - self._offset:
            raise CorruptError(f"payload ends {count} bytes early")
        self._offset += count
        return self._payload[self._offset - count : self._offset]

    def rest(self) -> bytes:
        return self.take(len(self._payload) - self._offset)

    @property
    def ended(self) -> bool:
        return self._offset == len(self._payload)

    def finish(self) -> None:
        """Check that nothing is left."""
        if self._offset != len(self._payload):
            raise CorruptError(f"payload has {len(self._payload) - self._offset} bytes too many")


MAX_ENTRIES = 256
_FLOAT32_MAX = struct.unpack(">f", b"\x7f\x7f\xff\xff")[0]


def write_map(entries: Iterable[tuple[Any, Any]]) -> bytes:
    """A msgpack map of (key, value) pairs in the order given; every value in its shortest exact form."""
    pairs = list(entries)
    packed = b"".join(_pack(key) + _pack(value) for key, value in pairs)
    return bytes(msgpack.Packer().pack_map_header(len(pairs))) + packed


def parse_map(payload: bytes) -> list[tuple[Any, Any]]:
    """Return the pairs of a msgpack map, as they stand; the decoder (`engine/`) checks that they are canonical."""
    most = len(payload)
    try:
        pairs = msgpack.unpackb(
            payload, strict_map_key=False, object_pairs_hook=tuple, max_map_len=most, max_array_len=most, max_ext_len=0
        )
    except (ValueError, TypeError, OverflowError, msgpack.UnpackException) as error:
        raise CorruptError(f"map is not readable msgpack: {error}") from error
    if type(pairs) is not tuple:
        raise CorruptError(f"expected a map, found {type(pairs).__name__}")
    return list(pairs)


def _pack(value: Any) -> bytes:
    if isinstance(value, float):
        # Single precision where that is exact, double otherwise.
        if abs(value) <= _FLOAT32_MAX:
            single = struct.pack(">f", value)
            if struct.unpack(">f", single)[0] == value:
                return b"\xca" + single
        return b"\xcb" + struct.pack(">d", value)
    if isinstance(value, list | tuple):
        return bytes(msgpack.Packer().pack_array_header(len(value))) + b"".join(map(_pack, value))
    return bytes(msgpack.packb(value))
