"""Units, axes and colors of meshes, as the table of formats has them: readers name them, and writers obey."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.geometry.mesh import Metadata
from bsm.files.table import FORMATS
from bsm.ground.lengths import metres

TIME_VALUE = "TimeValue"  # seconds, in the field data of a VTP
Array = npt.NDArray[Any]
Doubles = npt.NDArray[np.float64]


_TO_Y = {
    "y": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "x": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    "z": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
}
"""The rotations that turn the axis that a mesh calls up to y."""


@dataclass(frozen=True, eq=False)
class Placement:
    """A factor and a rotation from coordinates of a mesh to those of a format, and the metadata that these express."""

    scale: float
    turn: Doubles
    expressed: frozenset[str]

    @property
    def matrix(self) -> Doubles:
        return self.scale * self.turn


def placement(metadata: Metadata, kind: str) -> Placement:
    """Return the placement for a format; a mesh without a known unit or axis is taken to have those of the format."""
    to_format_axis = np.array(_TO_Y[FORMATS[kind].up], np.float64).T
    scale, turn = 1.0, to_format_axis @ np.array(_TO_Y[FORMATS[kind].up], np.float64)
    expressed: set[str] = set()
    axis = str(metadata.get("up", "")).lower()
    if axis in _TO_Y:
        turn = to_format_axis @ np.array(_TO_Y[axis], np.float64)
        expressed.add("up")
    mesh_unit = metres(str(metadata.get("unit", "")))
    format_unit = metres(FORMATS[kind].unit)
    if mesh_unit is not None and format_unit is not None:
        scale = mesh_unit / format_unit
        expressed.add("unit")
    return Placement(scale, turn, frozenset(expressed))


# -------------------------------------------------------------------------------------------------------------- colors

_WORD = 65535.0


def to_linear(shares: Array) -> Doubles:
    """Return the linear values of colors in sRGB; a fourth column is an opacity, which stays."""
    linear = np.array(shares, np.float64)
    c = linear[..., :3]
    # The curve of IEC 61966-2-1. A plain power of 2.2 would be off by some levels in the dark.
    linear[..., :3] = np.where(
        c <= 0.04045, c / 12.92, ((np.maximum(c, 0.0) + 0.055) / 1.055) ** 2.4
    )
    return linear


def to_srgb(shares: Array) -> Doubles:
    """Return linear colors in sRGB; a fourth column is an opacity, which stays."""
    colors = np.array(shares, np.float64)
    c = colors[..., :3]
    colors[..., :3] = np.where(
        c <= 0.0031308, c * 12.92, 1.055 * np.maximum(c, 1e-9) ** (1 / 2.4) - 0.055
    )
    return colors


def linear_colors(colors: Array) -> Array:
    """Return the colors of a mesh in numbers that `srgb_colors` makes the same ones of, as few as possible."""
    linear = to_linear(shares_of(colors))
    if colors.dtype == np.uint8:
        return np.rint(linear * _WORD).astype(np.uint16)
    narrow = np.rint(linear.clip(0.0, 1.0) * 255).astype(np.uint8)
    if colors.dtype == np.uint16 and np.array_equal(srgb_colors(narrow), colors):
        return np.asarray(narrow)
    return linear.astype(np.float32)


def srgb_colors(colors: Array) -> Array:
    """Return linear colors as those of a mesh: as bytes where bytes become these colors, or else as words or floats."""
    linear = shares_of(colors)
    shares = to_srgb(linear)
    levels = np.rint(shares.clip(0.0, 1.0) * 255)
    # Half a step of the words in which bytes are written: such values were bytes, and become the same bytes again.
    if colors.size and np.abs(to_linear(levels / 255) - linear).max() <= 0.51 / _WORD:
        return np.asarray(levels, np.uint8)
    if colors.dtype == np.uint8:
        return np.rint(shares * _WORD).astype(np.uint16)
    return shares.astype(np.float32)


def shares_of(colors: Array) -> Doubles:
    """Return floats as they are, and whole numbers as shares of their largest one."""
    if colors.dtype.kind == "f":
        return colors.astype(np.float64)
    return colors / np.float64(np.iinfo(colors.dtype).max)
