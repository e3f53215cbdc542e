"""Levels that refine a mesh to bytes and back, given the faces; exact."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy.range_coder import make_bank
from bsm.bitstream.fields import corners as shared

Ints = npt.NDArray[np.int32]

AXES = 3  # of a level: along the normal, and along two tangents
MOST_LEVEL = 1 << 20

_INPUTS, _CONTEXT_SIZE, _NODES, _SORTS = 5, 512, 32, 2
_SLOTS = _SORTS * _INPUTS * _CONTEXT_SIZE * _NODES
_RATE = 16
MODEL_BYTES = 4 * _SLOTS  # about what a model takes


class _Levels(NamedTuple):
    """The struct `Levels` of `fields.h`."""

    levels: Ints
    gaps: Ints
    means: Ints
    learners: npt.NDArray[np.int64]


def levels_charge(vertices: int, faces: int) -> int:
    """Bytes of memory that coding levels takes at most; its work is linear in `vertices` + `faces`, 1 µs per level."""
    return (shared.BYTES_PER_VERTEX + 12 * AXES) * vertices + shared.BYTES_PER_FACE * faces + MODEL_BYTES + (1 << 17)


def levels_field(faces: npt.ArrayLike, vertices: int) -> shared.Field:
    """Levels, vertices in the order of their numbers."""
    top = np.full(AXES, MOST_LEVEL, np.int32)
    weights = np.zeros((3, 4, shared.TERMS), np.int64)  # at the start, for each axis by the number of flaps (V 11)
    weights[:, :, 0] = 52000
    weights[:, 1:, 1] = 28000

    def start() -> shared.State:
        corners = shared.corners_of(faces, vertices)
        model = make_bank(_SLOTS, _SORTS * _NODES, _INPUTS, rate=_RATE)
        given, gaps, means = np.zeros((3, vertices, AXES), np.int32)
        levels = _Levels(given, gaps, means, shared.make_learners(weights.reshape(12, shared.TERMS)))
        return shared.State(
            lambda coder, *rows: _kernels.code_levels(coder, model, corners, levels, *rows), corners.rank, levels.levels
        )

    return shared.Field(-top, top, levels_charge(vertices, len(np.asarray(faces))), start)
