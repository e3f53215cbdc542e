"""The smallest pieces of the format: varints, checksums, tags and frames, as twins of writing and parsing."""

from __future__ import annotations

import binascii
import zlib
from dataclasses import dataclass
from enum import IntEnum

from bsm.bitstream.errors import CorruptError, FormatError, OptionError, UnsupportedError
from bsm.bitstream.limits import Limits

MAGIC = b"\x89BSM"
VERSION = 0

MAX_VARINT_BYTES = 5
MAX_VARINT = (1 << 7 * MAX_VARINT_BYTES) - 1
SKIPPABLE_TYPES = range(8, 12)
SHORT = 128
"""A payload of fewer bytes has a short checksum."""


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
    """The bytes every stream begins with: magic and version."""
    return MAGIC + bytes([VERSION])


def parse_preamble(data: bytes) -> bool:
    """Check the beginning of a stream, as far as it has arrived."""
    if not MAGIC.startswith(data[: len(MAGIC)]):
        raise FormatError("not a BSM stream: it does not begin with 89 42 53 4D", offset=0)
    if len(data) <= len(MAGIC):
        return False
    if data[len(MAGIC)] != VERSION:
        raise UnsupportedError(
            f"stream version {data[len(MAGIC)]} is not version {VERSION}, the one this decoder reads", offset=len(MAGIC)
        )
    return True


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
        """Offset of the checksum."""
        return self.payload + self.length

    @property
    def end(self) -> int:
        """Offset behind the frame."""
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
        """The next varint."""
        parsed = parse_varint(self._payload, self._offset)
        if parsed is None:
            raise CorruptError("payload ends inside a varint")
        value, self._offset = parsed
        return value

    def take(self, count: int) -> bytes:
        """The next `count` bytes."""
        if count > len(self._payload) - self._offset:
            raise CorruptError(f"payload ends where {count} more bytes should be")
        self._offset += count
        return self._payload[self._offset - count : self._offset]

    def rest(self) -> bytes:
        """Everything that is left."""
        return self.take(len(self._payload) - self._offset)

    @property
    def ended(self) -> bool:
        """Whether nothing is left."""
        return self._offset == len(self._payload)

    def finish(self) -> None:
        """Check that nothing is left."""
        if self._offset != len(self._payload):
            raise CorruptError(f"payload has {len(self._payload) - self._offset} bytes too many")
