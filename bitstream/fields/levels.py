"""Levels that refine a mesh to bytes and back, given the faces; exact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy.range_coder import Coder, make_bank
from bsm.bitstream.errors import MeshError
from bsm.bitstream.fields.corners import (
    BYTES_PER_FACE,
    BYTES_PER_VERTEX,
    TERMS,
    Field,
    FieldDecoder,
    FieldEncoder,
    corners_of,
    make_learners,
)
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

Ints = npt.NDArray[np.int32]

AXES = 3
"""Of a level: along the normal, and along two tangents."""
MOST_LEVEL = 1 << 20

_INPUTS, _CONTEXT_SIZE, _NODES, _SORTS = 5, 512, 32, 2
_SLOTS = _SORTS * _INPUTS * _CONTEXT_SIZE * _NODES
_RATE = 16
MODEL_BYTES = 4 * _SLOTS
"""About what a model takes."""


class _Levels(NamedTuple):
    """State of levels; the struct `Levels` of `levels.h`."""

    levels: Ints
    gaps: Ints
    means: Ints
    learners: npt.NDArray[np.int64]


def levels_charge(vertices: int, faces: int) -> int:
    """Bytes of memory that coding levels takes at most; its work is linear in `vertices` + `faces`, 1 µs per level."""
    return (BYTES_PER_VERTEX + 12 * AXES) * vertices + BYTES_PER_FACE * faces + MODEL_BYTES + (1 << 17)


def _levels_of(faces: npt.ArrayLike, vertices: int) -> Field:
    """What encoder and decoder share."""
    corners = corners_of(faces, vertices)
    model = make_bank(_SLOTS, _SORTS * _NODES, _INPUTS, rate=_RATE)
    shape = vertices, AXES
    levels = _Levels(
        np.zeros(shape, np.int32),
        np.zeros(shape, np.int32),
        np.zeros(shape, np.int32),
        make_learners(_start_of_learners()),
    )

    def code(coder: Coder, first: int, count: int) -> int:
        return _kernels.code_levels(coder, model, corners, levels, first, count)

    return Field(code, np.arange(vertices, dtype=np.int32), levels.levels)


class LevelsEncoder(FieldEncoder):
    """Codes levels, vertices in the order of their numbers."""

    def __init__(self, faces: npt.ArrayLike, levels: npt.ArrayLike) -> None:
        given = np.asarray(levels)
        if given.ndim != 2 or given.shape[1] != AXES or given.dtype.kind not in "iu":
            raise MeshError("levels must be integers of shape (n, 3)")
        if ((given < -MOST_LEVEL) | (given > MOST_LEVEL)).any():
            raise MeshError(f"levels must be at most {MOST_LEVEL} in magnitude; choose a larger step")
        field = _levels_of(faces, given.shape[0])
        field.values[:] = given
        super().__init__(field)


class LevelsDecoder(FieldDecoder):
    """Twin of `LevelsEncoder`."""

    def __init__(self, faces: npt.ArrayLike, vertices: int, limits: Limits = DEFAULT_LIMITS) -> None:
        limits.check("field_bytes", levels_charge(vertices, len(np.asarray(faces))))
        super().__init__(_levels_of(faces, vertices))


def _start_of_learners() -> npt.NDArray[np.int64]:
    """Weights at the start, for each axis by the number of flaps (V 11)."""
    start = np.zeros((3, 4, TERMS), np.int64)
    start[:, :, 0] = 52000
    start[:, 1:, 1] = 28000
    return start.reshape(12, TERMS)
