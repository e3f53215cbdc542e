"""An attribute's values: where they are, their levels, and the numbers that are coded, in one piece or two."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._core import Field
from bsm._core.bitstream import constant
from bsm.bitstream.container.header import FACE, LEVELS, OCTAHEDRAL, TEXCOORD, Declaration, entries_of
from bsm.bitstream.container.wire import with_lengths, write_map
from bsm.codec.arrays import Faces, Indices, Levels, Matrix

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


def noted(error: float, step: float, bits: int, zeros: int, scaled: bool) -> str:
    """What became of values, in words."""
    if not bits:
        return f"in steps of {step:g}" if step else f"within {error:.3g}" if error else "exact"
    note = [f"{bits} bits, within {error:.2g} degrees"]
    return ", ".join([*note, *[f"{zeros} of no length"] * (zeros > 0), *["all of length one now"] * scaled])


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
