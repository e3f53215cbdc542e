"""The conquest: triangle by triangle over a closed surface, the same walk for encoder and decoder.

After the first triangle of a component the front is that triangle's border. A node without free edges is closed by the
triangle to its neighbours, which costs nothing; else the triangle beyond the gate of the first node is added, and its
third vertex is told: a new vertex (with its valence, by which the decoder knows when to close it), the dummy vertex of
a boundary loop not met before, or a node already on the front (which splits one polygon of it or joins two).

References
----------
C. Touma, C. Gotsman, "Triangle mesh compression", Graphics Interface 1998; P. Alliez, M. Desbrun, "Valence-driven
connectivity encoding for 3D meshes", Eurographics 2001.
"""

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

DONE, NONSENSE, NO_ROOM, PAUSED = range(4)
"""How a call of `conquer` ends; without room, make some and call again."""

_REAL, _DUMMIES, _TURNS, _STEPS, _STOP, _TALLIES = 1, 3, 4, 5, 8, 9

TURN_BYTES = 1024
"""More than one triangle can take."""


class Guide(NamedTuple):
    """What only the encoder knows; a decoder has empty arrays.

    Attributes
    ----------
    surface : Surface
        The surface to conquer.
    conquered : uint8 array
        Which of its faces are behind the front.
    node : int32 array
        Node whose gate a half-edge is.
    number : int32 array
        Number of each fan and dummy in the order of conquest, or -1.
    fans : int32 array
        Fan of each real vertex in the order of conquest.
    faces : int32 array
        Face of the surface of each emitted face.
    """

    surface: Surface
    conquered: npt.NDArray[np.uint8]
    node: Ints
    number: Ints
    fans: Ints
    faces: Ints


class Conquest(NamedTuple):
    """What both sides know.

    Attributes
    ----------
    front : Front
        Border of the conquered part.
    vertices : int64 array, shape (fans + dummies, 2)
        What contexts see of a vertex (`Vertex` in `valence_model.h`).
    faces : int32 array, shape (m, 3)
        Emitted faces.
    tallies : int64 array
        Vertices, real vertices and faces so far; dummies, triangles and steps along the front still allowed; first
        face that the encoder may have left; label of the latest real vertex; faces behind which to pause, 0: none.
    """

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


def pause_behind(conquest: Conquest, faces: int) -> None:
    """Let the conquest pause once so many faces are emitted; 0: not at all."""
    conquest.tallies[_STOP] = faces


def fans_of(conquest: Conquest) -> int:
    """Fans that a conquest has met so far."""
    return int(conquest.tallies[_REAL])


def conquer(coder: Coder, models: Models, guide: Guide, conquest: Conquest) -> int:
    """Code the surface, from where the last call ran out of room or paused.

    The encoder's guide tells each third vertex; without one, the coder's payload does.
    """
    return _kernels.conquer(coder, models, guide, conquest)
