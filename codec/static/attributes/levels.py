"""An attribute's values: where they are, their levels, and the numbers that are coded, in one piece or two."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._core import Field
from bsm._core.bitstream import constant
from bsm.bitstream.container.header import BITS, FACE, LEVELS, OCTAHEDRAL, TEXCOORD, Declaration, entries_of
from bsm.bitstream.container.wire import with_lengths, write_map
from bsm.codec.arrays import Faces, Indices, Levels, Matrix
from bsm.codec.geometry.attributes import KINDS

Values = npt.NDArray[Any]
Words = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Surface:
    """The values of an attribute as vertices of a mesh of their own."""

    faces: Faces
    vertices: Indices


def recomputed(surface: Surface, positions: Matrix) -> Matrix:
    """Normals of the values of a surface: those of the faces around, by area (A 7); shape (k, 3)."""
    places = positions[surface.vertices] if len(surface.vertices) else positions
    a, b, c = (places[surface.faces[:, corner]] for corner in range(3))
    across = np.cross(b - a, c - a)
    normals = np.zeros((len(surface.vertices), 3))
    for corner in range(3):
        for axis in range(3):
            normals[:, axis] += np.bincount(surface.faces[:, corner], weights=across[:, axis], minlength=len(normals))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > 0.0, normals / np.where(lengths > 0.0, lengths, 1.0), [0.0, 0.0, 1.0])


def octahedral_normals(levels: Words, size: int) -> Matrix:
    """The unit vectors, shape (n, 3), of levels, shape (n, 2): points on an octahedron (Meyer et al., EGSR 2010)."""
    points = unfolded(levels, size).astype(np.float64)
    return np.asarray(points / np.sqrt((points * points).sum(axis=1, keepdims=True)))


def unfolded(levels: Words, size: int) -> Words:
    """The points of levels on an octahedron of this size."""
    flat = np.asarray(levels, np.int64) - size
    height = size - np.abs(flat).sum(axis=1, keepdims=True)
    inside = np.where(flat < 0, -1, 1) * (size - np.abs(flat[:, ::-1]))
    return np.hstack([np.where(height < 0, inside, flat), height])


def restored(declaration: Declaration, levels: Words) -> Values:
    """Values of levels, shape (k, words) (A 5)."""
    kind = np.dtype(KINDS[declaration.kind])
    if declaration.coding == OCTAHEDRAL:
        return octahedral_normals(levels, declaration.largest[0] // 2).astype(kind)
    offset = np.array(declaration.offsets)
    if declaration.coding == BITS:
        return _of_bits(levels + offset.astype(np.int64), kind)
    values = offset + np.array(declaration.steps) * levels
    return values.astype(kind) if declaration.is_float else values.astype(np.int64).astype(kind)


def noted(error: float, step: float, bits: int, zeros: int, scaled: bool) -> str:
    """What became of values, in words."""
    if not bits:
        return f"in steps of {step:g}" if step else f"within {error:.3g}" if error else "exact"
    note = [f"{bits} bits, within {error:.2g} degrees"]
    return ", ".join([*note, *[f"{zeros} of no length"] * (zeros > 0), *["all of length one now"] * scaled])


def _of_bits(words: Words, kind: np.dtype[Any]) -> Values:
    """Floats of bits as whole numbers that ascend with them; values that are not finite become 0."""
    unsigned = np.dtype(f"u{kind.itemsize}")
    if kind.itemsize == 8:
        pairs = words.reshape(len(words), -1, 2).astype(np.uint64)
        ordered = pairs[:, :, 0] << np.uint64(32) | pairs[:, :, 1]
    else:
        ordered = words.astype(np.uint32)
    top = unsigned.type(1) << unsigned.type(8 * kind.itemsize - 1)
    bits = np.where(ordered & top, ordered ^ top, ~ordered)
    values = np.ascontiguousarray(bits.astype(unsigned)).view(kind)
    return np.where(np.isfinite(values), values, kind.type(0))


MOST_WHOLE, PIECE_BITS = constant("MOST_WHOLE"), constant("PIECE_BITS")  # larger levels are coded in two pieces


def to_pieces(declaration: Declaration, levels: Words) -> Levels:
    """Levels, shape (k, words), as numbers that are coded, shape (k, pieces)."""
    columns = []
    for largest, level in zip(declaration.largest, levels.T, strict=True):
        columns += [level] if largest <= MOST_WHOLE else [level >> PIECE_BITS, level & ((1 << PIECE_BITS) - 1)]
    return np.stack(columns, axis=1).astype(np.int32)


def leans(declaration: Declaration) -> bool:
    """Whether numbers are predicted from positions, should these be there."""
    small = declaration.coding == LEVELS and max(declaration.largest) <= MOST_WHOLE
    texcoords = small and declaration.semantic == TEXCOORD and declaration.words == 2
    return declaration.domain != FACE and (texcoords or declaration.coding == OCTAHEDRAL)


def field_of(declaration: Declaration, surface: Surface, pieces: Levels, places: Levels | None) -> Field:
    """The field of the numbers of an attribute, shape (k, pieces), predicted from `places`, shape (n, 3)."""
    declared = write_map(entries_of(replace(declaration, leans=int(places is not None))))
    vertices = 1 + int(max(surface.faces.max(initial=0), surface.vertices.max(initial=0)))
    field = Field(surface.faces, pieces)
    field.attribute(declared, vertices if places is None else len(places), surface.vertices, places)
    return field


def write_values(field: Field, count: int) -> bytes:
    """The next `count` values: where there are several payloads, each with its length before it."""
    payloads = field.write(count)
    return payloads[0] if len(payloads) == 1 else with_lengths([*payloads, b""])
