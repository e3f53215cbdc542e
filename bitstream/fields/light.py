"""Positions on a grid to bytes and back by a small model: some more bytes, which are many times quicker to decode."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy.range_coder import Coder
from bsm.bitstream.fields.chunks import Field
from bsm.bitstream.fields.corners import corners_of
from bsm.bitstream.fields.grid import AXES, GridDecoder, GridEncoder, Ints, largest_of

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
