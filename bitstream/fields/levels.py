"""Levels that refine a mesh to bytes and back, given the faces; exact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy.range_coder import Coder, make_bank
from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.fields.chunks import Field, FieldDecoder, FieldEncoder
from bsm.bitstream.fields.corners import BYTES_PER_FACE, BYTES_PER_VERTEX, corners_of, keep_borders
from bsm.bitstream.fields.model import TERMS, make_learners
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

Ints = npt.NDArray[np.int32]

LEGAL_AXES = (1, 3)
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


def levels_charge(vertices: int, faces: int, axes: int) -> int:
    """Bytes of memory that coding levels takes at most; its work is linear in `vertices` + `faces`, 1 µs per level."""
    return (BYTES_PER_VERTEX + 12 * axes) * vertices + BYTES_PER_FACE * faces + MODEL_BYTES + (1 << 17)


def _levels_of(faces: npt.ArrayLike, vertices: int, axes: int, borders: bool) -> tuple[Field, npt.NDArray[np.bool_]]:
    """What encoder and decoder share; and which vertices have levels."""
    if axes not in LEGAL_AXES:
        raise OptionError(f"a vertex has one level or three, not {axes}")
    corners = corners_of(faces, vertices)
    coded = keep_borders(corners) if borders else np.ones(vertices, np.bool_)
    model = make_bank(_SLOTS, _SORTS * _NODES, _INPUTS, rate=_RATE)
    levels = _Levels(
        np.zeros((vertices, axes), np.int32),
        np.zeros((vertices, axes), np.int32),
        np.zeros((vertices, axes), np.int32),
        make_learners(_start_of_learners()),
    )

    def code(coder: Coder, first: int, count: int) -> int:
        return _kernels.code_levels(coder, model, corners, levels, first, count)

    return Field(code, np.arange(vertices, dtype=np.int32), levels.levels), coded


class LevelsEncoder(FieldEncoder):
    """Codes levels, vertices in the order of their numbers."""

    def __init__(self, faces: npt.ArrayLike, levels: npt.ArrayLike, *, borders: bool = False) -> None:
        given = np.asarray(levels)
        if given.ndim != 2 or given.dtype.kind not in "iu":
            raise MeshError("levels must be integers of shape (n, 1) or (n, 3)")
        field, coded = _levels_of(faces, given.shape[0], given.shape[1], borders)
        if ((given < -MOST_LEVEL) | (given > MOST_LEVEL)).any():
            raise MeshError(f"levels must be at most {MOST_LEVEL} in magnitude; choose a larger step")
        if given[~coded].any():
            raise MeshError("a vertex that is on no border has levels")
        field.values[:] = given
        super().__init__(field)


class LevelsDecoder(FieldDecoder):
    """Twin of `LevelsEncoder`."""

    def __init__(
        self,
        faces: npt.ArrayLike,
        vertices: int,
        axes: int,
        limits: Limits = DEFAULT_LIMITS,
        *,
        borders: bool = False,
    ) -> None:
        limits.check("field_bytes", levels_charge(vertices, len(np.asarray(faces)), axes))
        super().__init__(_levels_of(faces, vertices, axes, borders)[0])


def _start_of_learners() -> npt.NDArray[np.int64]:
    """Weights at the start, for each axis by the number of flaps (V 11)."""
    start = np.zeros((3, 4, TERMS), np.int64)
    start[:, :, 0] = 52000
    start[:, 1:, 1] = 28000
    return start.reshape(12, TERMS)
