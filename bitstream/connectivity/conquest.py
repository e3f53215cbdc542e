"""The conquest: triangle by triangle over a closed surface, the same walk for encoder and decoder."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.connectivity.front import Front, enlarge_front, make_front
from bsm.bitstream.connectivity.halfedges import Surface
from bsm.bitstream.connectivity.valence_model import Models
from bsm.bitstream.entropy.range_coder import Coder

Ints = npt.NDArray[np.int32]

DONE, NONSENSE, NO_ROOM = range(3)
"""How a call of `conquer` ends; without room, make some and call again."""

_DUMMIES, _TURNS, _STEPS, _TALLIES = 3, 4, 5, 8

TURN_BYTES = 1024
"""More than one triangle can take."""


class Guide(NamedTuple):
    """What only the encoder knows; a decoder has empty arrays."""

    surface: Surface
    conquered: npt.NDArray[np.uint8]
    node: Ints
    number: Ints
    fans: Ints
    faces: Ints


class Conquest(NamedTuple):
    """What both sides know."""

    front: Front
    vertices: npt.NDArray[np.int64]
    faces: Ints
    tallies: npt.NDArray[np.int64]


def make_guide(surface: Surface, face_count: int) -> Guide:
    """For encoding `surface`, of which the first `face_count` faces are real."""
    halfedges = len(surface.twin)
    return Guide(
        surface,
        np.zeros(halfedges // 3, np.uint8),
        np.empty(halfedges, np.int32),
        np.full(len(surface.valence), -1, np.int32),
        np.empty(len(surface.vertex), np.int32),
        np.empty(face_count, np.int32),
    )


def no_guide() -> Guide:
    """The guide of a decoder, which has none."""
    nothing = np.empty(0, np.int32)
    return make_guide(Surface(nothing, nothing, nothing, nothing), 0)


def make_conquest(face_count: int, fans: int, dummies: int) -> Conquest:
    """The state before the first triangle."""
    tallies = np.zeros(_TALLIES, np.int64)
    tallies[_DUMMIES] = dummies
    tallies[_TURNS] = 4 * face_count  # each real face has at most three dummy neighbours
    tallies[_STEPS] = 65536 + 16 * face_count
    vertices = np.empty((fans + dummies, 2), np.int64)
    return Conquest(make_front(fans + 16), vertices, np.empty((face_count, 3), np.int32), tallies)


def enlarge_conquest(conquest: Conquest) -> Conquest:
    """State of a conquest with room for more nodes."""
    return conquest._replace(front=enlarge_front(conquest.front))


def conquer(coder: Coder, models: Models, guide: Guide, conquest: Conquest) -> int:
    """Code the surface, from where the last call ran out of room."""
    return _kernels.conquer(coder, models, guide, conquest)
