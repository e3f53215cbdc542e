"""Payloads of fields: so many rows of one, in its order; what was learnt goes on from chunk to chunk."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream.entropy.range_coder import (
    Coder,
    finish_reading,
    finish_writing,
    make_room,
    overran,
    start_reading,
    start_writing,
)
from bsm.bitstream.errors import CorruptError, OptionError, TruncatedError

Ints = npt.NDArray[np.int32]
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
