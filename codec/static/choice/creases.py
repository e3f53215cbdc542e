"""Pairs of faces with a crease between them, or almost one: errors that change that are plain to see. Encoder only."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Indices, Matrix, Positions
from bsm.codec.geometry.graph import vertex_faces
from bsm.codec.look.pictures import CREASE, MOST_AROUND

WITHIN = 8.0
"""Degrees, on both sides of the angle that makes a crease, in which bends are watched."""


class Creases(NamedTuple):
    """Bends near the angle from which on faces are shaded each by itself; the struct of that name in `creases.h`."""

    faces: Faces
    pairs: Indices
    sharp: npt.NDArray[np.uint8]
    costs: Matrix
    starts: Indices
    members: Indices
    cosine: float

    def priced(self, price: float) -> Creases:
        """These creases at costs so many times as high."""
        return self._replace(costs=self.costs * price)


def creases_of(positions: Positions, faces: Faces) -> Creases:
    """The creases of a mesh, and what is almost one."""
    count = len(positions)
    around = vertex_faces(faces, count)
    crosses = np.empty((len(faces), 4))
    middle = math.degrees(math.acos(CREASE))
    bends = CREASE, math.cos(math.radians(middle + WITHIN)), math.cos(math.radians(middle - WITHIN))

    def collect(room: int) -> tuple[int, Indices, npt.NDArray[np.uint8], Matrix]:
        pairs, sharp, costs = np.empty((room, 2), np.int32), np.empty(room, np.uint8), np.empty(room)
        found = _kernels.collect_creases(
            positions, faces, around.starts, around.members, MOST_AROUND, *bends, crosses, pairs, sharp, costs
        )
        return found, pairs, sharp, costs

    _, pairs, sharp, costs = collect(collect(0)[0])
    starts, members = np.empty(count + 1, np.int32), np.empty(6 * len(pairs), np.int32)
    hanging = _kernels.hang_creases(faces, pairs, starts, members)
    area = max(float(crosses[:, 3].sum()), 1e-300)
    return Creases(faces, pairs, sharp, costs / area, starts, members[:hanging].copy(), CREASE)
