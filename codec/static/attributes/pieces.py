"""The coders of an attribute's numbers: what they are told, and numbers that are too large for them in two pieces."""

from __future__ import annotations

import numpy as np

from bitstream.attributes.values import FaceValueDecoder, FaceValueEncoder, Kind, ValueDecoder, ValueEncoder
from bitstream.container.declaration import COLOR, FACE, LEVELS, OCTAHEDRAL, TEXCOORD, Declaration
from bitstream.errors import CorruptError
from bitstream.limits import Limits
from codec.arrays import Levels
from codec.static.attributes.levels import Words
from codec.static.attributes.surface import Surface

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
    """Twin of `to_pieces`; raises `CorruptError` for levels that are too large."""
    columns, at = [], 0
    for largest in declaration.largest:
        level = pieces[:, at].astype(np.int64)
        if largest > MOST_WHOLE:
            at += 1
            level = level << PIECE_BITS | pieces[:, at]
        if level.max(initial=0) > largest:
            raise CorruptError(f"a level of attribute {declaration.name!r} is above {largest}")
        columns.append(level)
        at += 1
    return np.stack(columns, axis=1)


def kind_of(declaration: Declaration) -> Kind:
    """How numbers are predicted."""
    if declaration.coding == OCTAHEDRAL:
        return "normal"
    if declaration.coding == LEVELS and declaration.semantic == TEXCOORD and declaration.components == 2:
        return "texcoord"
    return "color" if declaration.coding == LEVELS and declaration.semantic == COLOR else "plain"


def leans(declaration: Declaration) -> bool:
    """Whether numbers are predicted from positions, should these be there."""
    return declaration.domain != FACE and kind_of(declaration) in ("normal", "texcoord")


def encoder_of(
    declaration: Declaration, surface: Surface, pieces: Levels, relief: Levels | None
) -> ValueEncoder | FaceValueEncoder:
    """A coder of numbers, shape (k, pieces); `relief`, shape (n, 3), if it leans on positions."""
    largest = largest_pieces(declaration)
    if declaration.domain == FACE:
        return FaceValueEncoder(surface.faces, pieces, largest)
    geometry = None if relief is None else surface.relief(relief)
    return ValueEncoder(surface.faces, pieces, largest, kind_of(declaration), geometry)


def decoder_of(
    declaration: Declaration, surface: Surface, relief: Levels | None, limits: Limits
) -> ValueDecoder | FaceValueDecoder:
    """Twin of `encoder_of`."""
    largest = largest_pieces(declaration)
    if declaration.domain == FACE:
        return FaceValueDecoder(surface.faces, largest, limits)
    geometry = None if relief is None else surface.relief(relief)
    return ValueDecoder(surface.faces, len(surface.vertices), largest, kind_of(declaration), geometry, limits)
