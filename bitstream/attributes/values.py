"""Whole numbers on vertices and faces to bytes and back; exact."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from bitstream.container.wire import Cursor, write_varint
from bitstream.errors import CorruptError
from bitstream.fields.levels import LevelsDecoder, LevelsEncoder
from bitstream.limits import DEFAULT_LIMITS, Limits

Ints = npt.NDArray[np.int32]
Kind = Literal["plain", "texcoord", "normal", "color"]


class ValueEncoder:
    def __init__(
        self, faces: Ints, values: Ints, largest: tuple[int, ...], kind: Kind, geometry: Ints | None = None
    ) -> None:
        self._coders = [LevelsEncoder(faces, values[:, [column]]) for column in range(values.shape[1])]

    def chunk(self, count: int) -> bytes:
        parts = [coder.chunk(count) for coder in self._coders]
        return b"".join(write_varint(len(part)) + part for part in parts)


class ValueDecoder:
    def __init__(
        self,
        faces: Ints,
        vertices: int,
        largest: tuple[int, ...],
        kind: Kind,
        geometry: Ints | None = None,
        limits: Limits = DEFAULT_LIMITS,
    ) -> None:
        self._largest = np.array(largest)
        self._coders = [LevelsDecoder(faces, vertices, 1, limits) for _ in largest]

    @property
    def coded(self) -> int:
        return self._coders[0].coded if self._coders else 0

    def chunk(self, payload: bytes, count: int) -> tuple[Ints, Ints]:
        cursor = Cursor(payload)
        columns = []
        vertices = np.zeros(0, np.int32)
        for coder in self._coders:
            vertices, levels = coder.chunk(cursor.take(cursor.varint()), count)
            columns.append(levels)
        cursor.finish()
        values = np.concatenate(columns, axis=1)
        if ((values < 0) | (values > self._largest)).any():
            raise CorruptError("a value is out of range")
        return vertices, values


class FaceValueEncoder(ValueEncoder):
    def __init__(self, faces: Ints, values: Ints, largest: tuple[int, ...]) -> None:
        super().__init__(np.zeros((0, 3), np.int32), values, largest, "plain")


class FaceValueDecoder(ValueDecoder):
    def __init__(self, faces: Ints, largest: tuple[int, ...], limits: Limits = DEFAULT_LIMITS) -> None:
        super().__init__(np.zeros((0, 3), np.int32), len(faces), largest, "plain", None, limits)
