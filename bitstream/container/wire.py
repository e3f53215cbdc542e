"""The smallest pieces of the format: varints, checksums, tags and frames."""

import binascii
import struct
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import msgpack

from bsm._core.bitstream import constant
from bsm.bitstream.errors import OptionError

MAGIC = b"\x89BSM"
MAJOR = constant("MAJOR")
VERSION = 16 * MAJOR  # of minor version 0
PREAMBLE_BYTES = len(MAGIC) + 1
MAX_VARINT_BYTES = 5
MAX_VARINT = (1 << 7 * MAX_VARINT_BYTES) - 1
# Types that later minor versions may use for frames that older decoders pass over.
SKIPPABLE_TYPES = range(8, 12)
SHORT = constant("SHORT_PAYLOAD")  # a payload of fewer bytes has a short checksum


class FrameType(IntEnum):
    """The type of a frame; the low four bits of its tag."""

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


def write_preamble(minor: int = 0) -> bytes:
    return MAGIC + bytes([VERSION + minor])


def write_varint(value: int) -> bytes:
    """Unsigned LEB128 in its shortest form, at most five bytes."""
    # Five bytes hold 35 bits. Longer ones would let a hostile stream ask for more.
    if not 0 <= value <= MAX_VARINT:
        raise OptionError(f"{value} does not fit a varint (0..{MAX_VARINT})")
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def read_varint(data: bytes | memoryview) -> tuple[int, int]:
    """Return the number at the start of some bytes and its size in bytes; a size of 0 where there is none."""
    value = 0
    for place, byte in enumerate(data[:MAX_VARINT_BYTES]):
        value |= (byte & 0x7F) << 7 * place
        if byte < 0x80:
            return value, place + 1
    return 0, 0


def with_lengths(payloads: list[bytes]) -> bytes:
    """Payloads one after the other, each but the last with its length before it."""
    return (
        b"".join(write_varint(len(payload)) + payload for payload in payloads[:-1]) + payloads[-1]
    )


def checksum_size(frame_type: int, length: int) -> int:
    """Bytes of checksum after a frame of this payload: two for blocks and short ones, four for everything else."""
    # Blocks are small and many: four bytes in each would be felt. A long payload is where two bytes are likely to miss
    # damage.
    return 2 if frame_type == FrameType.BLOCK or length < SHORT else 4


def checksum(size: int, data: bytes | bytearray | memoryview) -> bytes:
    """Two bytes: CRC-16 (CCITT polynomial 0x1021, initial value 0); of four: CRC-32 (as in zlib); little-endian."""
    value = binascii.crc_hqx(data, 0) if size == 2 else zlib.crc32(data)
    return value.to_bytes(size, "little")


def write_frame(frame_type: int, payload: bytes) -> bytes:
    """Tag, payload and checksum."""
    body = write_varint(len(payload) << 4 | frame_type) + payload
    return body + checksum(checksum_size(frame_type, len(payload)), body)


@dataclass(frozen=True)
class Section:
    """A section as its tag describes it, which may be cut off, or have a wrong checksum."""

    type: int
    payload: memoryview
    is_sound: bool


def sections_of(stream: bytes) -> Iterator[Section]:
    """Walk over the sections of a stream by the lengths in their tags, as far as these lead."""
    # A view, since a slice of a large stream for each section would copy it many times.
    rest = memoryview(stream)[PREAMBLE_BYTES:]
    while rest:
        tag, head = read_varint(rest)
        length, kind = divmod(tag, 16)
        body_size = head + length
        sum_size = checksum_size(kind, length)
        if head == 0:
            return
        expected = bytes(rest[body_size : body_size + sum_size])
        yield Section(kind, rest[head:body_size], checksum(sum_size, rest[:body_size]) == expected)
        rest = rest[body_size + sum_size :]


MAX_ENTRIES = 256
_FLOAT32_MAX = struct.unpack(">f", b"\x7f\x7f\xff\xff")[0]


def write_map(entries: Iterable[tuple[Any, Any]]) -> bytes:
    """A msgpack map of (key, value) pairs in the order given; every value in its shortest exact form."""
    pairs = list(entries)
    # Not msgpack.packb of a dict: it writes doubles always, and the law wants the shortest exact form.
    packed = b"".join(pack(key) + pack(value) for key, value in pairs)
    return bytes(msgpack.Packer().pack_map_header(len(pairs))) + packed


def pack(value: Any) -> bytes:
    if isinstance(value, float):
        # Single precision where that is exact, double otherwise.
        if abs(value) <= _FLOAT32_MAX:
            # Values beyond single precision raise OverflowError in pack, so they are sorted out before.
            single = struct.pack(">f", value)
            if struct.unpack(">f", single)[0] == value:
                return b"\xca" + single
        return b"\xcb" + struct.pack(">d", value)
    if isinstance(value, list | tuple):
        return bytes(msgpack.Packer().pack_array_header(len(value))) + b"".join(map(pack, value))
    return bytes(msgpack.packb(value))
