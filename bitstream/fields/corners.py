"""Integers on vertices or faces: what both sides know of a mesh before them, and the one pair that codes all kinds."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy import range_coder as entropy
from bsm.bitstream.errors import MeshError, OptionError

Ints = npt.NDArray[np.int32]
MOST_FACES = (1 << 30) // 3


class Corners(NamedTuple):
    """The corners of a mesh; corner k is corner k % 3 of face k // 3."""

    faces: Ints
    starts: Ints
    corners: Ints
    opposite: Ints
    rank: Ints


def corners_of(faces: npt.ArrayLike, vertices: int) -> Corners:
    """The corners of a mesh whose vertices are coded as they are numbered."""
    given = np.asarray(faces)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iu" or len(given) > MOST_FACES:
        raise MeshError(f"faces must be integers of shape (m, 3), not {given.dtype} of {given.shape}")
    if not 0 <= vertices < 1 << 30 or (given.size and (given.min() < 0 or given.max() >= vertices)):
        raise MeshError(f"faces must be made of the vertices 0 to {vertices - 1}")
    own = np.array(given, np.int32, order="C")
    size = 3 * len(own)
    corners = Corners(
        own,
        np.empty(vertices + 1, np.int32),
        np.empty(size, np.int32),
        np.empty(size, np.int32),
        np.arange(vertices, dtype=np.int32),
    )
    _kernels.link_corners(corners, np.empty(vertices + size, np.int32))
    return corners


def traverse(corners: Corners) -> Ints:
    """Make each vertex come when as much as possible is known around it."""
    vertices = len(corners.rank)
    order = np.empty(vertices, np.int32)
    _kernels.order_vertices(corners, order, np.empty((3, vertices), np.int32))
    return order


Kernel = Callable[[entropy.Coder, int, int], int]
"""Codes up to a number of rows from one on, in their order; returns how many."""
MOST_LARGEST = (1 << 20) - 1  # values from 0 on are at most this
_ROOM = 1024


class State(NamedTuple):
    """A field under way: what codes it, its rows as they are coded, and their values."""

    code: Kernel
    order: Ints
    values: Ints


@dataclass(frozen=True, eq=False)
class Field:
    """One kind of integers on vertices or faces: the range of each column, and how coding begins."""

    low: Ints
    high: Ints
    start: Callable[[], State]
    canonical: Callable[[Ints], Ints] | None = None  # what a decoder makes of values, where several mean the same


class FieldEncoder:
    """Codes the values of a field."""

    def __init__(self, field: Field, values: npt.ArrayLike) -> None:
        given, columns = np.asarray(values), len(field.high)
        if given.ndim != 2 or given.shape[1] != columns or given.dtype.kind not in "iu":
            raise MeshError(f"values must be integers of shape (n, {columns}), not {given.dtype} of {given.shape}")
        if ((given < field.low) | (given > field.high)).any():
            raise MeshError(f"values are outside their range, {field.low} to {field.high}")
        if field.canonical is not None and (field.canonical(given) != given).any():
            raise MeshError("values are not those that a decoder makes of them")
        self._state, self._next = field.start(), 0
        if len(given) != len(self.order):
            raise MeshError(f"{len(given)} values where there are {len(self.order)} vertices or faces")
        self._state.values[:] = given

    @property
    def order(self) -> Ints:
        """Vertices or faces in the order in which they are coded, shape (n,); it follows from the faces of the mesh."""
        return self._state.order

    def chunk(self, count: int) -> bytes:
        """Code the next `count` of `order`; raises `OptionError` if there are fewer."""
        left = len(self.order) - self._next
        if not 0 < count <= left:
            raise OptionError(f"a chunk of {count} where {left} are left")
        self._next += count
        return write_rows(self._state.code, self._next - count, count)


def write_rows(code: Kernel, first: int, count: int, row_bytes: int = 4) -> bytes:
    """Code rows; `row_bytes` is the usual size of one."""
    coder, end = entropy.start_writing(_ROOM + row_bytes * count), first + count
    while first < end:
        coder = entropy.make_room(coder, _ROOM + row_bytes * (end - first))
        first += code(coder, first, end - first)
    return entropy.finish_writing(coder)


def checked_largest(largest: npt.ArrayLike, columns: range) -> Ints:
    """Return the largest value of each column as int32, or raise `OptionError`."""
    top = np.array(largest, np.int64)
    if top.ndim != 1 or len(top) not in columns or top.min() < 0 or top.max() > MOST_LARGEST:
        some = f"{columns[0]} to {columns[-1]}" if len(columns) > 1 else f"{columns[0]}"
        raise OptionError(f"the largest values must be {some}, from 0 to {MOST_LARGEST}, not {top.tolist()}")
    return top.astype(np.int32)


PREDICTIONS = 7
TERMS = 7
_CONTEXTS, _CONTEXT_SIZE, _NODES = 6, 512, 66
_WEIGHT_ROWS = _NODES + 3 * 6
_INPUTS = PREDICTIONS + _CONTEXTS + 1
_WEIGHT_ROW, _MODEL_ROW = 16, 8  # numbers from one row to the next
_HIT_CONTEXTS, _SCALE_CONTEXTS = 32, 512


class ValueModel(NamedTuple):
    """What is learnt about integers (V 3); the struct with this name in `fields.h`."""

    slots: npt.NDArray[np.uint32]
    hits: npt.NDArray[np.uint32]
    weights: npt.NDArray[np.int32]
    scales: npt.NDArray[np.int32]


def make_model() -> ValueModel:
    """A model that has learnt nothing."""
    weights = np.zeros((_WEIGHT_ROWS, _WEIGHT_ROW), np.int32)
    weights[:_NODES, :PREDICTIONS] = (1 << 16) * 9 // (8 * PREDICTIONS)
    weights[:_NODES, PREDICTIONS + 1 : _INPUTS] = 6000
    return ValueModel(
        np.full(_CONTEXTS * _CONTEXT_SIZE * _NODES, 1 << 31, np.uint32),
        np.full(_HIT_CONTEXTS * _MODEL_ROW, 1 << 28, np.uint32),
        weights,
        np.zeros((_SCALE_CONTEXTS, _MODEL_ROW), np.int32),
    )


def make_learners(start: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """Learners that have learnt nothing."""
    weights = np.asarray(start, np.int64)
    learners = np.zeros((len(weights), TERMS + 3, _MODEL_ROW), np.int64)
    learners[:, -2:, :TERMS] = weights[:, np.newaxis]
    return learners.reshape(len(weights), -1)
