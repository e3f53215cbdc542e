"""The coders of an attribute's numbers: what they are told, and numbers that are too large for them in two pieces."""

from __future__ import annotations

import numpy as np

from bsm.bitstream.attributes.values import MOST_COMPONENTS, Kind, face_values_field, values_field
from bsm.bitstream.container.declaration import COLOR, FACE, LEVELS, OCTAHEDRAL, TEXCOORD, Declaration
from bsm.bitstream.container.wire import Cursor, write_varint
from bsm.bitstream.errors import CorruptError
from bsm.bitstream.fields.corners import Field, FieldDecoder, FieldEncoder
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Indices, Levels
from bsm.codec.static.attributes.levels import Words
from bsm.codec.static.attributes.surface import Surface

MOST_WHOLE = (1 << 20) - 1
"""Larger levels are coded in two pieces."""
PIECE_BITS = 16


def largest_pieces(declaration: Declaration) -> tuple[int, ...]:
    """Largest value of each number that is coded for a value: of a larger level its upper bits, then the lower ones."""
    pieces: list[int] = []
    for largest in declaration.largest:
        pieces += [largest] if largest <= MOST_WHOLE else [largest >> PIECE_BITS, (1 << PIECE_BITS) - 1]
    return tuple(pieces)


def to_pieces(declaration: Declaration, levels: Words) -> Levels:
    """Levels, shape (k, words), as numbers that are coded, shape (k, pieces)."""
    columns = []
    for largest, level in zip(declaration.largest, levels.T, strict=True):
        columns += [level] if largest <= MOST_WHOLE else [level >> PIECE_BITS, level & ((1 << PIECE_BITS) - 1)]
    return np.stack(columns, axis=1).astype(np.int32)


def from_pieces(declaration: Declaration, pieces: Levels) -> Words:
    """Twin of `to_pieces`, of shape (k, pieces); raises `CorruptError` for levels that are too large."""
    columns, at = [], 0
    for largest in declaration.largest:
        level = pieces[:, at].astype(np.int64)
        if largest > MOST_WHOLE:
            at += 1
            level = level << PIECE_BITS | pieces[:, at]
        if level.max(initial=0) > largest:
            raise CorruptError(f"a level is above {largest}")
        columns.append(level)
        at += 1
    return np.stack(columns, axis=1)


def kind_of(declaration: Declaration) -> Kind:
    """How numbers are predicted."""
    if declaration.coding == OCTAHEDRAL:
        return "normal"
    if declaration.coding == LEVELS and max(declaration.largest) <= MOST_WHOLE:
        if declaration.semantic == TEXCOORD and declaration.words == 2:
            return "texcoord"
        if declaration.semantic == COLOR:
            return "color"
    return "plain"


def leans(declaration: Declaration) -> bool:
    """Whether numbers are predicted from positions, should these be there."""
    return declaration.domain != FACE and kind_of(declaration) in ("texcoord", "normal")


def _fields(declaration: Declaration, surface: Surface, places: Levels | None) -> list[Field]:
    """The fields of an attribute, of at most `MOST_COMPONENTS` numbers of each value."""
    faces, kind = surface.faces, kind_of(declaration)
    of_groups = [largest_pieces(declaration)[some] for some in _groups(declaration)]
    if declaration.domain == FACE:
        return [face_values_field(faces, largest) for largest in of_groups]
    geometry, size = None if places is None else surface.geometry(places), len(surface.vertices)
    return [values_field(faces, size, largest, kind, geometry, surface.places) for largest in of_groups]


class PieceEncoder:
    """Codes the numbers of an attribute, shape (k, pieces)."""

    def __init__(self, declaration: Declaration, surface: Surface, pieces: Levels, places: Levels | None) -> None:
        of_groups = [pieces[:, some] for some in _groups(declaration)]
        self._coders = list(map(FieldEncoder, _fields(declaration, surface, places), of_groups))

    def chunk(self, count: int) -> bytes:
        """Code the next `count` values: where there are several groups, each with its length before it."""
        parts = [coder.chunk(count) for coder in self._coders]
        return parts[0] if len(parts) == 1 else b"".join(write_varint(len(part)) + part for part in parts)


class PieceDecoder:
    """Twin of `PieceEncoder`; raises as `FieldDecoder`."""

    def __init__(self, declaration: Declaration, surface: Surface, places: Levels | None, limits: Limits) -> None:
        self._coders = [FieldDecoder(field, limits) for field in _fields(declaration, surface, places)]

    @property
    def coded(self) -> int:
        """How many values are decoded."""
        return min(coder.coded for coder in self._coders)

    def chunk(self, payload: bytes, count: int) -> tuple[Indices, Levels]:
        """The numbers of the next `count` values, and their pieces, shape (count, pieces)."""
        cursor, found = Cursor(payload), []
        for coder in self._coders:
            part = cursor.take(cursor.varint()) if len(self._coders) > 1 else cursor.rest()
            rows, pieces = coder.chunk(part, count)
            found.append(pieces)
        cursor.finish()
        return rows, np.concatenate(found, axis=1)


def _groups(declaration: Declaration) -> list[slice]:
    starts = range(0, len(largest_pieces(declaration)), MOST_COMPONENTS)
    return [slice(start, start + MOST_COMPONENTS) for start in starts]
