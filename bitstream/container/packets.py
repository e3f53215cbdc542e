"""The packets of a stream, and how they become bytes."""

import math
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from bsm.bitstream.container import wire
from bsm.bitstream.container.header import Declaration as Declaration
from bsm.bitstream.container.header import Header as Header
from bsm.bitstream.container.header import MetadataValue, entries_of
from bsm.bitstream.container.wire import (
    MAX_ENTRIES,
    FrameType,
    write_frame,
    write_map,
    write_preamble,
    write_varint,
)
from bsm.bitstream.errors import OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS


@dataclass(frozen=True)
class Metadata:
    """The user's own names and values; kept in the order of the names."""

    entries: Mapping[str, MetadataValue] = field(default_factory=dict)

    def __post_init__(self) -> None:
        plain = {
            k: value.item() if isinstance(value, np.generic) else value
            for k, value in self.entries.items()
        }
        for name, value in plain.items():
            if type(name) is not str or type(value) not in (str, int, float, bytes):
                raise OptionError(
                    f"metadata {name!r}: {value!r} must map a str to a str, int, float or bytes"
                )
        # The law wants the keys of a map in ascending order, and so the same metadata always make the same bytes.
        object.__setattr__(self, "entries", dict(sorted(plain.items())))

    # msgpack holds larger integers, and Python reads them. C has no type for them, and C strings end at a NUL.
    def require_readable(self) -> None:
        """Raise `OptionError` for values that a stream can hold, but bsmdec does not return."""
        for name, value in self.entries.items():
            if "\0" in name:
                raise OptionError(f"metadata {name!r}: there is a NUL in the name; leave it out")
            if isinstance(value, int) and not -(1 << 63) <= value < 1 << 63:
                raise OptionError(
                    f"metadata {name!r}: {value} does not fit into 64 bits; store it as a text"
                )


@dataclass(frozen=True)
class Connectivity:
    """The coded faces."""

    data: bytes


@dataclass(frozen=True)
class Labels:
    """Which vertex belongs to which block, coded."""

    data: bytes


@dataclass(frozen=True)
class Order:
    """The order that vertices and faces had before coding, coded."""

    data: bytes


@dataclass(frozen=True)
class Coefficients:
    """The coded coefficients of block `index`: `coefficients` (c_i) of them per coordinate."""

    index: int
    coefficients: int
    data: bytes


@dataclass(frozen=True)
class Gop:
    """The coded coefficients of a group of a sequence's frames; `index` is the number of the first of them."""

    index: int
    data: bytes


@dataclass(frozen=True)
class Grid:
    """The coded positions, on the header's grid, of `count` vertices, from number `first` of the order of coding on."""

    first: int
    count: int
    data: bytes


@dataclass(frozen=True)
class Refinement:
    """The coded levels of `count` vertices, from number `first` on, in the layer of refinement."""

    first: int
    count: int
    data: bytes


@dataclass(frozen=True)
class Declared:
    """An attribute of the mesh, counted from 0, and its coded seams, if it has any of its own."""

    index: int
    declaration: Declaration
    seams: bytes = b""


@dataclass(frozen=True)
class Values:
    """The coded values of an attribute: `count` of them, from number `first` of the order of coding on."""

    attribute: int
    first: int
    count: int
    data: bytes


@dataclass(frozen=True)
class End:
    """The last frame: how many were before it, the CRC-32 of all bytes before it, and that of decoded positions."""

    frames: int
    crc: int
    positions: int | None = None


Packet: TypeAlias = (
    Header
    | Metadata
    | Connectivity
    | Labels
    | Order
    | Declared
    | Coefficients
    | Gop
    | Grid
    | Refinement
    | Values
    | End
)


def write_header(header: Header) -> bytes:
    return write_map(entries_of(header))


BRIEF, BRIEF_TURNED, BRIEF_METADATA, MOST_BRIEF = 23, 25, 26, 60_000
"""Keys in the header of a brief stream, and bytes of all of it that fit into one frame."""


def write_brief(header: Header, body: Sequence[Packet]) -> bytes | None:
    """Return the payload of the only frame of a brief stream (F 11); None: these packets cannot be in one."""
    turn = header.turn if any(header.turn) else ()
    # Without the byte that tells the type: all of them must be in single precision, and their length tells whether they
    # are.
    floats = b"".join(wire.pack(value)[1:] for value in (header.scale, *header.center, *turn))
    entries = {
        name: value
        for packet in body
        if isinstance(packet, Metadata)
        for name, value in packet.entries.items()
    }
    # A brief stream exists for small meshes on grids. All others have packets that one frame cannot hold, and stay as
    # they are.
    match [packet for packet in body if not isinstance(packet, Metadata)]:
        case [Connectivity(faces), Grid(0, header.vertices, values)] if (
            len(floats) == 16 + 4 * len(turn) and not header.repeats
        ):
            # Only these fields: a brief header has no keys, so everything else must be at its default.
            whole = (header.vertices, header.faces, *header.grid, header.congruence, len(faces))
            *fields, length = map(write_varint, whole)
            data = b"".join(fields) + floats + length + faces + values
            notes = [(BRIEF_METADATA, write_metadata(Metadata(entries)))] * bool(entries)
            payload = write_map([(BRIEF_TURNED if turn else BRIEF, data), *notes])
            return payload if len(payload) < MOST_BRIEF and len(entries) <= MAX_ENTRIES else None
    return None


def metadata_of(entries: Sequence[tuple[str, MetadataValue]]) -> tuple[Metadata, ...]:
    """Metadata packets of at most as many entries as a map may have."""
    return tuple(
        Metadata(dict(entries[i : i + MAX_ENTRIES])) for i in range(0, len(entries), MAX_ENTRIES)
    )


def write_metadata(metadata: Metadata) -> bytes:
    """A map from names to values; raises `OptionError` for values that a stream cannot hold."""
    for name, value in metadata.entries.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise OptionError(f"metadata {name!r} is {value}; only finite numbers can be stored")
    try:
        return write_map(metadata.entries.items())
    except (ValueError, OverflowError) as error:
        raise OptionError(f"metadata cannot be stored: {error}") from error


def write_plain(packet: Any) -> bytes:
    """Varints, as many as the packet has numbers, then its data."""
    # The fields of a packet are declared in the order of their bytes, so most packets need no writer of their own.
    *numbers, data = vars(packet).values()
    return bytes(b"".join(map(write_varint, numbers)) + data)


def write_attribute(attribute: Declared) -> bytes:
    """Varint index, varint length of a map from field keys to values, this map, coded seams."""
    entries = write_map(entries_of(attribute.declaration))
    return write_varint(attribute.index) + write_varint(len(entries)) + entries + attribute.seams


def write_end(end: End) -> bytes:
    """Varint number of frames, CRC-32 of bytes and, if it is known, of positions, little-endian."""
    sums = [end.crc] if end.positions is None else [end.crc, end.positions]
    return write_varint(end.frames) + b"".join(each_sum.to_bytes(4, "little") for each_sum in sums)


WRITERS: dict[type[Any], tuple[FrameType, Callable[[Any], bytes]]] = {
    Header: (FrameType.HEADER, write_header),
    Metadata: (FrameType.METADATA, write_metadata),
    Connectivity: (FrameType.CONNECTIVITY, write_plain),
    Labels: (FrameType.PARTITION, write_plain),
    Order: (FrameType.ORDER, write_plain),
    Declared: (FrameType.ATTRIBUTE, write_attribute),
    Coefficients: (FrameType.BLOCK, write_plain),
    Gop: (FrameType.GOP, write_plain),
    Grid: (FrameType.GRID, write_plain),
    Refinement: (FrameType.REFINEMENT, write_plain),
    Values: (FrameType.VALUES, write_plain),
    End: (FrameType.END, write_end),
}
"""The type of the frame of each packet, and the function that writes its payload."""


class SectionWriter:
    """Turns packets into the bytes of a stream; encoders decode the result before they return it."""

    def __init__(self) -> None:
        self._frames = self._crc = 0

    def start(self, minor: int = 0) -> bytes:
        """Return the preamble, which comes first, of a minor version."""
        preamble = write_preamble(minor)
        self._crc = zlib.crc32(preamble)
        return preamble

    def write(self, packet: Packet) -> bytes:
        """Return the frame of one packet."""
        frame_type, write = WRITERS[type(packet)]
        # Checked here, since no decoder with default limits would take the stream.
        payload = write(packet)
        DEFAULT_LIMITS.check("frame_bytes", len(payload))
        frame = write_frame(frame_type, payload)
        self._frames += 1
        # The sum of all bytes before END grows with each frame, so nothing need be kept for it.
        self._crc = zlib.crc32(frame, self._crc)
        return frame

    def end(self, positions: int | None = None) -> bytes:
        """Return the END frame, with the checksum of decoded positions if it is known."""
        return self.write(End(self._frames, self._crc, positions))
