"""Positions on a grid to bytes and back, given the faces; exact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy.range_coder import (
    Coder,
    finish_reading,
    finish_writing,
    make_room,
    overran,
    start_reading,
    start_writing,
)
from bsm.bitstream.errors import CorruptError, MeshError, OptionError, TruncatedError
from bsm.bitstream.fields.corners import (
    BYTES_PER_FACE,
    BYTES_PER_VERTEX,
    MODEL_BYTES,
    TERMS,
    Field,
    FieldDecoder,
    FieldEncoder,
    corners_of,
    make_learners,
    make_model,
    traverse,
)
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

_SAMPLES = (4, 32)
_AT_ONCE = 1 << 20


def spread(points: npt.NDArray[np.int32], lattice: tuple[int, ...]) -> npt.NDArray[np.int64]:
    """Values on the grid of points of a lattice (V 12): exact integers, any shape."""
    values = points.astype(np.int64)
    if not lattice:
        return values
    cells, count = lattice
    return (2 * values * cells + count) // (2 * count)


def find_lattice(values: npt.ArrayLike, cells: int) -> tuple[npt.NDArray[np.int32], tuple[int, ...]]:
    """The coarsest lattice that holds all values of a grid, if it saves a bit or more of each."""
    given = np.asarray(values, np.int64)
    different = np.unique(given)
    counts = np.arange(1, cells // 2 + 1)
    for samples in (*_SAMPLES, len(different)):
        some = different[:: max(1, len(different) // samples)]
        pieces = np.array_split(counts, 1 + len(counts) * len(some) // _AT_ONCE)
        counts = np.concatenate([piece[_fits(some, piece[:, None], cells)] for piece in pieces])
    if not len(counts):
        return given.astype(np.int32), ()
    count = int(counts[0])
    return _nearest(given, count, cells).astype(np.int32), (cells, count)


def _nearest(values: npt.NDArray[np.int64], count: npt.NDArray[np.int64] | int, cells: int) -> npt.NDArray[np.int64]:
    return (2 * values * count + cells) // (2 * cells)


def _fits(values: npt.NDArray[np.int64], count: npt.NDArray[np.int64], cells: int) -> npt.NDArray[np.bool_]:
    back = (2 * _nearest(values, count, cells) * cells + count) // (2 * count)
    fits: npt.NDArray[np.bool_] = (back == values).all(axis=1)
    return fits


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


_SIZES = 24
_SLOTS_OF_SIZE = 12 * 12 + 3 + 4


class _Light(NamedTuple):
    """State of a light grid; the struct `Light` of `light.h`."""

    largest: Ints
    values: Ints
    gaps: Ints
    slots: npt.NDArray[np.uint32]


def _light_of(faces: npt.ArrayLike, vertices: int, largest: npt.ArrayLike) -> Field:
    """What encoder and decoder share (V 15)."""
    top = largest_of(largest)
    corners = corners_of(faces, vertices)
    light = _Light(
        top,
        np.zeros((vertices, AXES), np.int32),
        np.zeros((vertices, AXES), np.int32),
        np.full(_SIZES * _SLOTS_OF_SIZE, 1 << 31, np.uint32),
    )

    def code(coder: Coder, first: int, count: int) -> int:
        return _kernels.code_light(coder, corners, light, first, count)

    return Field(code, corners.rank, light.values)


class LightEncoder(GridEncoder):
    """Codes positions on a grid so that they are quick to decode; all else as `GridEncoder`."""

    _field_of = staticmethod(_light_of)


class LightDecoder(GridDecoder):
    """Twin of `LightEncoder`; `grid_charge` is more than it takes."""

    _field_of = staticmethod(_light_of)


Numbers = npt.NDArray[np.int64]
_SLOTS = 9
_NO_FLOAT = 1 << 40
_ROOM, _BYTES_PER_ROW = 1024, 16


def ordered(values: npt.ArrayLike) -> Numbers:
    """Numbers of floats of any shape in their order (V 16.1): 0 for 0.0, -1 for -0.0; all are rounded to float32."""
    with np.errstate(over="ignore"):
        single = np.ascontiguousarray(np.asarray(values, np.float64).astype(np.float32))
    bits = single.view(np.uint32).astype(np.int64)
    return np.where(bits >> 31, (1 << 31) - 1 - bits, bits)


def floats_of(numbers: Numbers) -> npt.NDArray[np.float32]:
    """Inverse of `ordered`: floats of the same shape as their numbers."""
    bits = np.where(numbers < 0, (1 << 31) - 1 - numbers, numbers)
    return np.ascontiguousarray(bits.astype(np.uint32)).view(np.float32)


class Cells(NamedTuple):
    """Numbers of floats in the cells of values (V 16.2), all of shape (k, 3)."""

    low: Numbers
    nearest: Numbers
    high: Numbers


def cells_of(values: Ints, origin: npt.NDArray[np.float64], step: float) -> Cells:
    """The cells of values, shape (k, 3); `origin`, shape (3,), is the place of value 0."""
    with np.errstate(over="ignore"):
        return Cells(*(ordered((values + side) * step + origin) for side in (-0.5, 0.0, 0.5)))


class Floats:
    """What is learnt of floats, from frame to frame; the struct `Floats` of `floats.h`."""

    def __init__(self, largest: tuple[int, ...]) -> None:
        self._state = (
            np.full(AXES * _SLOTS, 1 << 31, np.uint32),
            np.zeros(AXES, np.int64),
            np.full((AXES, max(largest) + 1), _NO_FLOAT, np.int64),
        )

    @staticmethod
    def charge(largest: tuple[int, ...]) -> int:
        """Bytes of memory that it takes."""
        return 24 * (max(largest) + 1)

    def encode(self, values: Ints, cells: Cells, floats: Numbers) -> bytes:
        """Code the numbers of floats, shape (k, 3), each in its cell, of values of a grid, shape (k, 3)."""
        if ((floats < cells.low) | (floats >= cells.high)).any():
            raise OptionError("a float is not in the cell of its value")
        coder, done = start_writing(_ROOM), 0
        while done < len(values):
            coder = make_room(coder, _ROOM + _BYTES_PER_ROW * (len(values) - done))
            done += self._code(coder, values[done:], Cells(*(numbers[done:] for numbers in cells)), floats[done:])
        return finish_writing(coder)

    def decode(self, payload: bytes, values: Ints, cells: Cells) -> Numbers:
        """Twin of `encode`: returns the numbers of the floats, shape (k, 3)."""
        floats = np.zeros(values.shape, np.int64)
        coder = start_reading(payload)
        done = self._code(coder, values, cells, floats)
        if overran(coder):
            raise TruncatedError(f"a payload of {len(payload)} bytes ends before the last of its {len(values)} floats")
        if done < len(values):
            raise CorruptError(f"number {done} of {len(values)} is in a cell without floats")
        finish_reading(coder)
        return floats

    def _code(self, coder: Coder, values: Ints, cells: Cells, floats: Numbers) -> int:
        return _kernels.code_floats(coder, self._state, np.ascontiguousarray(values), *cells, floats)
