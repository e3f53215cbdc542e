"""Positions on a grid, and levels that refine a mesh, to bytes and back, given the faces; exact."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy.range_coder import make_bank
from bsm.bitstream.errors import OptionError
from bsm.bitstream.fields import corners as shared

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


class _Grid(NamedTuple):
    """State of a grid; the struct with this name in `fields.h`, and so are those below."""

    largest: Ints
    order: Ints
    values: Ints
    gaps: Ints
    sums: npt.NDArray[np.int64]
    seen: npt.NDArray[np.int64]
    learners: npt.NDArray[np.int64]


def grid_field(faces: npt.ArrayLike, vertices: int, largest: npt.ArrayLike) -> shared.Field:
    """Positions on a grid, in as few bytes as can be."""
    top = shared.checked_largest(largest, range(AXES, AXES + 1))
    weights = np.zeros((4 * 2 * 6 + 4 * AXES, shared.TERMS), np.int64)  # at the start (V 9)
    weights[:48, 0] = 49152  # of the guesses
    weights[48:, :2] = 49152, 8192  # of the sizes of their errors

    def start() -> shared.State:
        corners = shared.corners_of(faces, vertices)
        model = shared.make_model()
        given, gaps = np.zeros((2, vertices, AXES), np.int32)
        grid = _Grid(
            top,
            shared.traverse(corners),
            given,
            gaps,
            np.zeros((vertices, 4), np.int64),
            np.zeros((AXES, int(top.max()) // 64 + 1), np.int64),
            shared.make_learners(weights),
        )
        return shared.State(
            lambda coder, *rows: _kernels.code_grid(coder, model, corners, grid, *rows), grid.order, grid.values
        )

    return shared.Field(np.zeros_like(top), top, start)


_SIZES = 24
_SLOTS_OF_SIZE = 12 * 12 + 3 + 4


class _Light(NamedTuple):
    largest: Ints
    values: Ints
    gaps: Ints
    slots: npt.NDArray[np.uint32]


def light_field(faces: npt.ArrayLike, vertices: int, largest: npt.ArrayLike) -> shared.Field:
    """Positions on a grid that are quick to decode (V 15)."""
    full = grid_field(faces, vertices, largest)

    def start() -> shared.State:
        corners = shared.corners_of(faces, vertices)
        slots = np.full(_SIZES * _SLOTS_OF_SIZE, 1 << 31, np.uint32)
        given, gaps = np.zeros((2, vertices, AXES), np.int32)
        light = _Light(full.high, given, gaps, slots)
        return shared.State(
            lambda coder, *rows: _kernels.code_light(coder, corners, light, *rows), corners.rank, light.values
        )

    return replace(full, start=start)


Numbers = npt.NDArray[np.int64]
_SLOTS = 9
_NO_FLOAT = 1 << 40
_BYTES_PER_ROW = 16


def ordered(values: npt.ArrayLike) -> Numbers:
    """Numbers of floats of any shape in their order (V 16.1): 0 for 0.0, -1 for -0.0; all are rounded to float32."""
    with np.errstate(over="ignore"):
        single = np.ascontiguousarray(np.asarray(values, np.float64).astype(np.float32))
    bits = single.view(np.uint32).astype(np.int64)
    return np.where(bits >> 31, (1 << 31) - 1 - bits, bits)


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
    """What is learnt of floats, from frame to frame."""

    def __init__(self, largest: tuple[int, ...]) -> None:
        self._state = (
            np.full(AXES * _SLOTS, 1 << 31, np.uint32),
            np.zeros(AXES, np.int64),
            np.full((AXES, max(largest) + 1), _NO_FLOAT, np.int64),
        )

    def encode(self, values: Ints, cells: Cells, floats: Numbers) -> bytes:
        """Code the numbers of floats, shape (k, 3), each in its cell, of values of a grid, shape (k, 3)."""
        if ((floats < cells.low) | (floats >= cells.high)).any():
            raise OptionError("a float is not in the cell of its value")
        return shared.write_rows(self._kernel(values, cells, floats), 0, len(values), _BYTES_PER_ROW)

    def _kernel(self, values: Ints, cells: Cells, floats: Numbers) -> shared.Kernel:
        given, numbers = np.ascontiguousarray(values), (*cells, floats)
        return lambda coder, first, _: _kernels.code_floats(
            coder, self._state, given[first:], *(each[first:] for each in numbers)
        )


MOST_LEVEL = 1 << 20

_LEVEL_INPUTS, _CONTEXT_SIZE, _NODES, _SORTS = 5, 512, 32, 2
_LEVEL_SLOTS = _SORTS * _LEVEL_INPUTS * _CONTEXT_SIZE * _NODES
_RATE = 16


class _Levels(NamedTuple):
    """The struct `Levels` of `fields.h`."""

    levels: Ints
    gaps: Ints
    means: Ints
    learners: npt.NDArray[np.int64]


def levels_field(faces: npt.ArrayLike, vertices: int) -> shared.Field:
    """Levels, vertices in the order of their numbers."""
    top = np.full(AXES, MOST_LEVEL, np.int32)
    weights = np.zeros((3, 4, shared.TERMS), np.int64)  # at the start, for each axis by the number of flaps (V 11)
    weights[:, :, 0] = 52000
    weights[:, 1:, 1] = 28000

    def start() -> shared.State:
        corners = shared.corners_of(faces, vertices)
        model = make_bank(_LEVEL_SLOTS, _SORTS * _NODES, _LEVEL_INPUTS, rate=_RATE)
        given, gaps, means = np.zeros((3, vertices, AXES), np.int32)
        levels = _Levels(given, gaps, means, shared.make_learners(weights.reshape(12, shared.TERMS)))
        return shared.State(
            lambda coder, *rows: _kernels.code_levels(coder, model, corners, levels, *rows), corners.rank, levels.levels
        )

    return shared.Field(-top, top, start)
