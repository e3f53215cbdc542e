"""What a stream with swift attributes gives to a decoder of their rows: faces, ranges, places and payloads."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, cast

import numpy as np

from bsm.bitstream.container import packets
from bsm.bitstream.container.header import FACE, OCTAHEDRAL, TANGENTS, Declaration, Header
from bsm.codec.decoding import decode
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from tools.surgery import Cursor, scan

PIECE_BITS, MOST_WHOLE, MOST_COMPONENTS = 16, (1 << 20) - 1, 4
Rows = list[list[int]]


@dataclass(frozen=True)
class SwiftRows:
    """The coded rows of an attribute: those of each corner, their places on a grid, and chunks of each group."""

    declaration: Declaration
    swift: int
    faces: Rows
    vertices: list[int]
    places: Rows | None
    groups: list[list[int]]  # the largest piece of each column
    chunks: list[tuple[list[bytes], int]]
    attribute: Attribute

    def read(self, reference: Any) -> Rows:
        """Return the words that a reference decoder of rows gives."""
        declared = self.declaration
        leans = declared.leans and declared.coding != TANGENTS and self.places is not None
        geometry = self.places if leans else None
        normals = declared.coding == OCTAHEDRAL
        columns: list[Rows] = []
        for number, largest in enumerate(self.groups):
            rows = reference.Rows(self.faces, declared.rows, largest, self.swift, normals, geometry)
            for payloads, count in self.chunks:
                rows.read(payloads[number], count)
            columns.append(rows.values)
        joined = (chain.from_iterable(parts) for parts in zip(*columns, strict=True))
        return [_words_of(row, declared.largest) for row in joined]


def _words_of(pieces: Iterable[int], largest: Sequence[int]) -> list[int]:
    words, rest = list[int](), iter(pieces)
    for most in largest:
        word = next(rest)
        words.append(word << PIECE_BITS | next(rest) if most > MOST_WHOLE else word)
    return words


def rows_of(stream: bytes) -> dict[int, SwiftRows]:
    """The rows of each attribute of a stream without ORDER, by its number."""
    mesh = decode(stream)
    found = [packet for packet, _ in scan(stream)]
    header = next(packet for packet in found if isinstance(packet, Header))
    if any(isinstance(packet, packets.Order) for packet in found):
        return {}
    declared = {
        packet.index: packet.declaration for packet in found if isinstance(packet, packets.Declared)
    }
    values = [packet for packet in found if isinstance(packet, packets.Values)]
    return {
        index: _rows_of(
            mesh,
            header,
            declaration,
            mesh.attributes[index],
            [v for v in values if v.attribute == index],
        )
        for index, declaration in declared.items()
        if declaration.domain != FACE
    }


def _rows_of(
    mesh: TriangleMesh,
    header: Header,
    declaration: Declaration,
    attribute: Attribute,
    values: list[packets.Values],
) -> SwiftRows:
    faces = mesh.faces if attribute.indices is None else attribute.indices
    vertices = np.zeros(declaration.rows, np.int64)
    vertices[faces] = mesh.faces
    places = None
    if header.grid:
        on_grid = np.rint((mesh.positions - np.array(header.center)) / header.scale).astype(
            np.int64
        )
        places = cast(Rows, on_grid[vertices].tolist())
    pieces = list[int]()
    for most in declaration.largest:
        wide = most > MOST_WHOLE
        pieces += [most >> PIECE_BITS, (1 << PIECE_BITS) - 1] if wide else [most]
    groups = [
        pieces[start : start + MOST_COMPONENTS] for start in range(0, len(pieces), MOST_COMPONENTS)
    ]
    chunks = [(_payloads(packet.data, len(groups)), packet.count) for packet in values]
    return SwiftRows(
        declaration,
        header.swift,
        faces.tolist(),
        vertices.tolist(),
        places,
        groups,
        chunks,
        attribute,
    )


def _payloads(data: bytes, count: int) -> list[bytes]:
    """The payload of each group: more than one are preceded by their lengths."""
    if count == 1:
        return [data]
    cursor = Cursor(data)
    return [cursor.take(cursor.varint()) for _ in range(count)]
