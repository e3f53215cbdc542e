"""The payload of every packet: twins of writing and parsing side by side, and the tables that find them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar

from bsm.bitstream.container.declaration import Declaration
from bsm.bitstream.container.header import entries_of, header_from_entries, header_to_entries, record_of
from bsm.bitstream.container.packets import (
    Attribute,
    Block,
    Connectivity,
    End,
    Gop,
    Grid,
    Header,
    Metadata,
    Order,
    Packet,
    Partition,
    Refinement,
    Values,
)
from bsm.bitstream.container.wire import MAX_ENTRIES, Cursor, FrameType, parse_map, write_map, write_varint
from bsm.bitstream.errors import CorruptError, OptionError
from bsm.bitstream.limits import Limits

MOST_HEADER = 1 << 16
MOST_DECLARATION = 1 << 16
"""Bytes of their maps."""
LIMITED_FIELDS = ("vertices", "faces", "blocks", "block_size", "coefficients", "frames", "gop_frames", "attributes")

Coded = TypeVar("Coded", Connectivity, Partition, Order)


def write_header(header: Header) -> bytes:
    """A map from field keys to values."""
    return write_map(header_to_entries(header))


def parse_header(payload: bytes, limits: Limits) -> Header:
    """Inverse of `write_header`; counts are checked against `limits`."""
    if len(payload) > MOST_HEADER:
        raise CorruptError(f"a header of {len(payload)} bytes, where {MOST_HEADER} are legal")
    header = header_from_entries(parse_map(payload))
    for name in LIMITED_FIELDS:
        limits.check(name, getattr(header, name))
    return header


def write_metadata(metadata: Metadata) -> bytes:
    """A map from names to values; raises `OptionError` for what a stream cannot hold."""
    if len(metadata.entries) > MAX_ENTRIES:
        raise OptionError(
            f"{len(metadata.entries)} entries of metadata are more than the {MAX_ENTRIES} that a stream holds; "
            "leave some out, or put several into one text"
        )
    for name, value in metadata.entries.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise OptionError(f"metadata {name!r} is {value}; only finite numbers can be stored")
    try:
        return write_map(metadata.entries.items())
    except (ValueError, OverflowError) as error:
        raise OptionError(f"metadata cannot be stored: {error}") from error


def parse_metadata(payload: bytes, limits: Limits) -> Metadata:
    """Inverse of `write_metadata`."""
    limits.check("metadata_bytes", len(payload))
    try:
        return Metadata(dict(parse_map(payload)))
    except OptionError as error:
        raise CorruptError(error.message) from error


def write_coded(packet: Connectivity | Partition | Order) -> bytes:
    """Its data."""
    return packet.data


def parse_coded(make: Callable[[bytes], Coded]) -> Callable[[bytes, Limits], Coded]:
    """Inverse of `write_coded` for the packet type `make`."""
    return lambda payload, limits: make(payload)


def write_block(block: Block) -> bytes:
    """Varint index, varint c_i, coefficient bytes."""
    return write_varint(block.index) + write_varint(block.coefficients) + block.data


def parse_block(payload: bytes, limits: Limits) -> Block:
    """Inverse of `write_block`."""
    cursor = Cursor(payload)
    return Block(cursor.varint(), cursor.varint(), cursor.rest())


def write_gop(gop: Gop) -> bytes:
    """Varint index, then data."""
    return write_varint(gop.index) + gop.data


def parse_gop(payload: bytes, limits: Limits) -> Gop:
    """Inverse of `write_gop`."""
    cursor = Cursor(payload)
    return Gop(cursor.varint(), cursor.rest())


def write_grid(grid: Grid) -> bytes:
    """Varint number of the first vertex, varint number of vertices, coded positions."""
    return write_varint(grid.first) + write_varint(grid.count) + grid.data


def parse_grid(payload: bytes, limits: Limits) -> Grid:
    """Inverse of `write_grid`."""
    cursor = Cursor(payload)
    return Grid(cursor.varint(), cursor.varint(), cursor.rest())


def write_refinement(refinement: Refinement) -> bytes:
    """Varint number of the first vertex, varint number of vertices, coded levels."""
    return write_varint(refinement.first) + write_varint(refinement.count) + refinement.data


def parse_refinement(payload: bytes, limits: Limits) -> Refinement:
    """Inverse of `write_refinement`."""
    cursor = Cursor(payload)
    return Refinement(cursor.varint(), cursor.varint(), cursor.rest())


def write_attribute(attribute: Attribute) -> bytes:
    """Varint index, varint length of a map from field keys to values, this map, coded seams."""
    entries = write_map(entries_of(attribute.declaration))
    return write_varint(attribute.index) + write_varint(len(entries)) + entries + attribute.seams


def parse_attribute(payload: bytes, limits: Limits) -> Attribute:
    """Inverse of `write_attribute`; counts are checked against `limits`."""
    cursor = Cursor(payload)
    index, length = cursor.varint(), cursor.varint()
    if length > MOST_DECLARATION:
        raise CorruptError(f"a declaration of {length} bytes, where {MOST_DECLARATION} are legal")
    declaration = record_of(Declaration, "attribute", parse_map(cursor.take(length)))
    limits.check("attribute_values", declaration.rows * max(1, declaration.words))
    return Attribute(index, declaration, cursor.rest())


def write_values(values: Values) -> bytes:
    """Varint attribute, varint number of the first value, varint number of values, coded values."""
    numbers = (values.attribute, values.first, values.count)
    return b"".join(map(write_varint, numbers)) + values.data


def parse_values(payload: bytes, limits: Limits) -> Values:
    """Inverse of `write_values`."""
    cursor = Cursor(payload)
    return Values(cursor.varint(), cursor.varint(), cursor.varint(), cursor.rest())


def write_end(end: End) -> bytes:
    """Varint number of frames, CRC-32 little-endian."""
    return write_varint(end.frames) + end.crc.to_bytes(4, "little")


def parse_end(payload: bytes, limits: Limits) -> End:
    """Inverse of `write_end`."""
    cursor = Cursor(payload)
    end = End(cursor.varint(), int.from_bytes(cursor.take(4), "little"))
    cursor.finish()
    return end


FRAME_TYPES: dict[type, FrameType] = {
    Header: FrameType.HEADER,
    Metadata: FrameType.METADATA,
    Connectivity: FrameType.CONNECTIVITY,
    Partition: FrameType.PARTITION,
    Order: FrameType.ORDER,
    Attribute: FrameType.ATTRIBUTE,
    Block: FrameType.BLOCK,
    Gop: FrameType.GOP,
    Grid: FrameType.GRID,
    Refinement: FrameType.REFINEMENT,
    Values: FrameType.VALUES,
    End: FrameType.END,
}

WRITERS: dict[FrameType, Callable[[Any], bytes]] = {
    FrameType.HEADER: write_header,
    FrameType.METADATA: write_metadata,
    FrameType.CONNECTIVITY: write_coded,
    FrameType.PARTITION: write_coded,
    FrameType.ORDER: write_coded,
    FrameType.BLOCK: write_block,
    FrameType.GOP: write_gop,
    FrameType.GRID: write_grid,
    FrameType.REFINEMENT: write_refinement,
    FrameType.ATTRIBUTE: write_attribute,
    FrameType.VALUES: write_values,
    FrameType.END: write_end,
}

PARSERS: dict[FrameType, Callable[[bytes, Limits], Packet]] = {
    FrameType.HEADER: parse_header,
    FrameType.METADATA: parse_metadata,
    FrameType.CONNECTIVITY: parse_coded(Connectivity),
    FrameType.PARTITION: parse_coded(Partition),
    FrameType.ORDER: parse_coded(Order),
    FrameType.BLOCK: parse_block,
    FrameType.GOP: parse_gop,
    FrameType.GRID: parse_grid,
    FrameType.REFINEMENT: parse_refinement,
    FrameType.ATTRIBUTE: parse_attribute,
    FrameType.VALUES: parse_values,
    FrameType.END: parse_end,
}
