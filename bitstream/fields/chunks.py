"""Payloads of fields: so many vertices of one, in its order; what was learnt goes on from chunk to chunk."""

from __future__ import annotations

from collections.abc import Callable

from bitstream.entropy.range_coder import (
    Coder,
    finish_reading,
    finish_writing,
    make_room,
    overran,
    start_reading,
    start_writing,
)
from bitstream.errors import CorruptError, OptionError, TruncatedError

Kernel = Callable[[Coder, int, int], int]
"""Codes vertices from a number on, so many, as far as it can; returns how many."""

_ROOM = 1024
_BYTES_PER_VERTEX = 4


class Progress:
    """How far a field is coded."""

    def __init__(self, code: Kernel, vertices: int) -> None:
        self._code = code
        self._vertices = vertices
        self.next = 0
        """Number, in the order of coding, of the first vertex that is not coded."""

    def take(self, count: int) -> range:
        """Numbers of the next `count` vertices."""
        if not 0 < count <= self._vertices - self.next:
            raise OptionError(f"a chunk of {count} vertices where {self._vertices - self.next} are left")
        return range(self.next, self.next + count)

    def write(self, count: int) -> bytes:
        """Code the next `count` vertices; raises `OptionError` if fewer are left."""
        numbers = self.take(count)
        coder = start_writing(_ROOM + _BYTES_PER_VERTEX * count)
        while self.next < numbers.stop:
            coder = make_room(coder, _ROOM + _BYTES_PER_VERTEX * (numbers.stop - self.next))
            self.next += self._code(coder, self.next, numbers.stop - self.next)
        return finish_writing(coder)

    def read(self, payload: bytes, count: int) -> range:
        """Twin of `write`; the numbers of what was read. After an error, nothing more can be read.

        Raises
        ------
        OptionError
            If fewer vertices are left.
        CorruptError, TruncatedError
            If `payload` is not of so many vertices.
        """
        numbers = self.take(count)
        self.next = self._vertices
        coder = start_reading(payload)
        done = self._code(coder, numbers.start, count)
        if overran(coder):
            raise TruncatedError(f"a payload of {len(payload)} bytes ends before the last of {count} vertices")
        if done < count:
            raise CorruptError(f"vertex {done} of a payload of {count} has a value out of range")
        finish_reading(coder)
        self.next = numbers.stop
        return numbers
