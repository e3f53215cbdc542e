"""Animated numbers: curves between keys, as glTF has them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError
from bsm.files.rows import Doubles

Array = npt.NDArray[Any]


@dataclass(frozen=True, eq=False)
class Curve:
    """Values at keys, and how they go on between them."""

    times: Doubles
    values: Doubles
    way: str
    turns: bool = False

    def __post_init__(self) -> None:
        each = 3 if self.way == "CUBICSPLINE" else 1
        if not len(self.times) or len(self.values) != each * len(self.times) or (np.diff(self.times) < 0).any():
            raise FormatError(f"a curve has {len(self.values)} values for {len(self.times)} keys, or keys out of order")
        if not (np.isfinite(self.times).all() and np.isfinite(self.values).all()):
            raise FormatError("a curve has a number that is not finite")

    def at(self, time: float) -> Doubles:
        """The value at a time, shape (c,); before the first key and behind the last that of those."""
        after = int(np.searchsorted(self.times, time, side="right"))
        before, after = max(after - 1, 0), min(after, len(self.times) - 1)
        span = float(self.times[after] - self.times[before])
        part = min(max((time - float(self.times[before])) / span, 0.0), 1.0) if span > 0 else 0.0
        if self.way == "CUBICSPLINE":
            value = self._spline(before, after, part, span)
            return value / (float(np.linalg.norm(value)) or 1.0) if self.turns else value
        one: Doubles = self.values[before]
        two: Doubles = self.values[after]
        if self.way == "STEP" or part == 0.0:
            return one
        return _turned(one, two, part) if self.turns else one + part * (two - one)

    def _spline(self, before: int, after: int, part: float, span: float) -> Doubles:
        keys = self.values.reshape(len(self.times), 3, -1)
        square, cube = part * part, part * part * part
        found: Doubles = (
            (2 * cube - 3 * square + 1) * keys[before, 1]
            + (cube - 2 * square + part) * span * keys[before, 2]
            + (3 * square - 2 * cube) * keys[after, 1]
            + (cube - square) * span * keys[after, 0]
        )
        return found


def _turned(one: Doubles, two: Doubles, part: float) -> Doubles:
    """Between two quaternions, along the shorter arc."""
    cosine = float(one @ two)
    two, cosine = (-two, -cosine) if cosine < 0 else (two, cosine)
    if cosine > 1 - 1e-9:
        mixed: Doubles = one + part * (two - one)
    else:
        angle = float(np.arccos(min(cosine, 1.0)))
        mixed = (np.sin((1 - part) * angle) * one + np.sin(part * angle) * two) / np.sin(angle)
    return mixed / (float(np.linalg.norm(mixed)) or 1.0)


def matrix_of(translation: Array, rotation: Array, scale: Array) -> Doubles:
    """The 4 x 4 matrix of a translation, a quaternion (x, y, z, w) and a scale."""
    x, y, z, w = (float(number) for number in rotation)
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.asarray(scale, np.float64)
    matrix[:3, 3] = translation
    return matrix
