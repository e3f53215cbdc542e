"""Positions on a grid to bytes and back, given the faces; exact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy.range_coder import Coder
from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.fields.chunks import Field, FieldDecoder, FieldEncoder
from bsm.bitstream.fields.corners import BYTES_PER_FACE, BYTES_PER_VERTEX, corners_of, traverse
from bsm.bitstream.fields.model import MODEL_BYTES, TERMS, make_learners, make_model
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

Ints = npt.NDArray[np.int32]

AXES = 3
MOST_LARGEST = (1 << 20) - 1
"""Values of an axis are 0 to at most this."""


class _Grid(NamedTuple):
    """State of a grid; the struct `Grid` of `grid.h`."""

    largest: Ints
    order: Ints
    values: Ints
    gaps: Ints
    sums: npt.NDArray[np.int64]
    seen: npt.NDArray[np.int64]
    learners: npt.NDArray[np.int64]


def grid_charge(vertices: int, faces: int) -> int:
    """Bytes of memory that coding a grid takes at most; its work is linear in `vertices` + `faces`, 3 µs per vertex."""
    return (BYTES_PER_VERTEX + 60) * vertices + BYTES_PER_FACE * faces + MODEL_BYTES + (1 << 20)


def largest_of(largest: npt.ArrayLike) -> Ints:
    """The largest values of the axes, shape (3,), checked; raises `OptionError` as `GridEncoder`."""
    top = np.array(largest, np.int64)
    if top.shape != (AXES,) or top.min() < 0 or top.max() > MOST_LARGEST:
        raise OptionError(f"the largest values of a grid must be {AXES} from 0 to {MOST_LARGEST}, not {top.tolist()}")
    return top.astype(np.int32)


def _grid_of(faces: npt.ArrayLike, vertices: int, largest: npt.ArrayLike) -> Field:
    """What encoder and decoder share."""
    top = largest_of(largest)
    corners = corners_of(faces, vertices)
    model = make_model()
    grid = _Grid(
        top,
        traverse(corners),
        np.zeros((vertices, AXES), np.int32),
        np.zeros((vertices, AXES), np.int32),
        np.zeros((vertices, 4), np.int64),
        np.zeros((AXES, int(top.max()) // 64 + 1), np.int64),
        make_learners(_start_of_learners()),
    )

    def code(coder: Coder, first: int, count: int) -> int:
        return _kernels.code_grid(coder, model, corners, grid, first, count)

    return Field(code, grid.order, grid.values)


class GridEncoder(FieldEncoder):
    """Codes positions on a grid, in as few bytes as can be."""

    _field_of = staticmethod(_grid_of)

    def __init__(self, faces: npt.ArrayLike, positions: npt.ArrayLike, largest: npt.ArrayLike) -> None:
        given = np.asarray(positions)
        if given.ndim != 2 or given.shape[1] != AXES or given.dtype.kind not in "iu":
            raise MeshError(f"positions on a grid must be integers of shape (n, {AXES})")
        field = self._field_of(faces, len(given), largest)
        if ((given < 0) | (given > np.asarray(largest))).any():
            raise MeshError(f"positions are outside their grid, 0 to {np.asarray(largest)}")
        field.values[:] = given
        super().__init__(field)


class GridDecoder(FieldDecoder):
    """Twin of `GridEncoder`."""

    _field_of = staticmethod(_grid_of)

    def __init__(
        self, faces: npt.ArrayLike, vertices: int, largest: npt.ArrayLike, limits: Limits = DEFAULT_LIMITS
    ) -> None:
        limits.check("field_bytes", grid_charge(vertices, len(np.asarray(faces))))
        super().__init__(self._field_of(faces, vertices, largest))


def _start_of_learners() -> npt.NDArray[np.int64]:
    """Weights at the start: of the guesses, then of the sizes of their errors (V 9)."""
    start = np.zeros((4 * 2 * 6 + 4 * AXES, TERMS), np.int64)
    start[:48, 0] = 49152
    start[48:, :2] = 49152, 8192
    return start
