"""What both sides know of a mesh before its values: corners, the corners beyond edges, and the order of coding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
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

Ints = npt.NDArray[np.int32]
MOST_FACES = (1 << 30) // 3
BYTES_PER_VERTEX = 24
BYTES_PER_FACE = 48
"""Of memory, scratch included, for corners and order."""


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
        np.zeros(vertices + 1, np.int32),
        np.zeros(size, np.int32),
        np.full(size, -1, np.int32),
        np.arange(vertices, dtype=np.int32),
    )
    _kernels.link_corners(corners, np.full(vertices + size, -1, np.int32))
    return corners


def traverse(corners: Corners) -> Ints:
    """Make each vertex come when as much as possible is known around it."""
    vertices = len(corners.rank)
    order = np.empty(vertices, np.int32)
    _kernels.order_vertices(corners, order, np.full((3, vertices), -1, np.int32))
    return order


Kernel = Callable[[Coder, int, int], int]
"""Codes rows of a field from a number in its order on, so many, as far as it can; returns how many."""
_ROOM = 1024
_BYTES_PER_ROW = 4


@dataclass(frozen=True, eq=False)
class Field:
    """Integers of vertices or faces, with what codes them."""

    code: Kernel
    order: Ints
    values: Ints


class _FieldCoder:
    """What encoder and decoder share: how far they are."""

    def __init__(self, field: Field) -> None:
        self._field = field
        self._next = 0

    @property
    def order(self) -> Ints:
        """Vertices or faces in the order in which they are coded, shape (n,); it follows from the faces of the mesh."""
        return self._field.order

    @property
    def coded(self) -> int:
        """How many of them are coded."""
        return self._next

    def _take(self, count: int) -> range:
        if not 0 < count <= len(self.order) - self._next:
            raise OptionError(f"a chunk of {count} where {len(self.order) - self._next} are left")
        return range(self._next, self._next + count)


class FieldEncoder(_FieldCoder):
    """Codes the values of a field."""

    def chunk(self, count: int) -> bytes:
        """Code the next `count` of `order`; raises `OptionError` if there are fewer."""
        end = self._take(count).stop
        coder = start_writing(_ROOM + _BYTES_PER_ROW * count)
        while self._next < end:
            coder = make_room(coder, _ROOM + _BYTES_PER_ROW * (end - self._next))
            self._next += self._field.code(coder, self._next, end - self._next)
        return finish_writing(coder)


class FieldDecoder(_FieldCoder):
    """Twin of `FieldEncoder`."""

    def chunk(self, payload: bytes, count: int) -> tuple[Ints, Ints]:
        """Decode the next `count` of `order`."""
        places = self._take(count)
        self._next = len(self.order)
        coder = start_reading(payload)
        done = self._field.code(coder, places.start, count)
        if overran(coder):
            raise TruncatedError(f"a payload of {len(payload)} bytes ends before the last of its {count} values")
        if done < count:
            raise CorruptError(f"number {done} of a payload of {count} has a value out of range")
        finish_reading(coder)
        self._next = places.stop
        rows = self.order[places.start : places.stop].copy()
        return rows, self._field.values[rows]


PREDICTIONS = 7
TERMS = 7
_CONTEXTS = 6
_CONTEXT_SIZE = 512
_NODES = 66
_WEIGHT_ROWS = _NODES + 3 * 6
_INPUTS = PREDICTIONS + _CONTEXTS + 1
_HIT_CONTEXTS = 32
_SCALE_CONTEXTS = 512
MODEL_BYTES = 4 * (_CONTEXTS * _CONTEXT_SIZE * _NODES + PREDICTIONS * (_HIT_CONTEXTS + 2 * _SCALE_CONTEXTS))
"""About what a model takes."""


class ValueModel(NamedTuple):
    """What is learnt about integers (V 3); the struct of that name in `value.h`."""

    slots: npt.NDArray[np.uint32]
    hits: npt.NDArray[np.uint32]
    weights: npt.NDArray[np.int32]
    scales: npt.NDArray[np.int32]


def make_model() -> ValueModel:
    """A model that has learnt nothing."""
    weights = np.zeros((_WEIGHT_ROWS, _INPUTS), np.int32)
    weights[:_NODES, :PREDICTIONS] = (1 << 16) * 9 // (8 * PREDICTIONS)
    weights[:_NODES, PREDICTIONS:-1] = 6000
    return ValueModel(
        np.full(_CONTEXTS * _CONTEXT_SIZE * _NODES, 1 << 31, np.uint32),
        np.full(PREDICTIONS * _HIT_CONTEXTS, 1 << 28, np.uint32),
        weights,
        np.zeros((PREDICTIONS * _SCALE_CONTEXTS, 2), np.int32),
    )


def make_learners(start: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """Learners that have learnt nothing."""
    weights = np.asarray(start, np.int64)
    empty = np.zeros((len(weights), TERMS * (TERMS + 1)), np.int64)
    return np.ascontiguousarray(np.hstack([empty, weights, weights]))
