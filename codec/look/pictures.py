"""Shaded pictures of a mesh, and how much two of them differ."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.graph import Rows, vertex_faces
from bsm.codec.geometry.welding import weld

Picture = npt.NDArray[np.float32]  # shades, 0 (black) to 1 (white, the background); first row on top
Normals = npt.NDArray[np.float32]  # of the corners of faces, shape (m, 9)

CREASE = math.cos(math.radians(40.0))  # cosine of the angle between faces from which on shading is not smooth
_HALF_CREASE = math.cos(math.radians(19.9))
MOST_AROUND = 128  # faces around a vertex, above which its corners are shaded as their faces are
VISIBLE = 12.0 / 255.0  # difference of shades, after the narrow blur, that is seen
PLAIN = 48.0 / 255.0  # difference that is plain; where it fills a square, a part is gone
SQUARE = 64.0  # pixels of such a square
BACKGROUND = 1.0
_GRID = 2.0**24
_SPREADS = {"wide": (1.5, 5), "narrow": (0.7, 3)}
_SCRATCH_ROWS, _TILE = 75, 8
_NOWHERE = np.empty((0, 0), np.float32)


@dataclass(frozen=True, eq=False)
class Shape:
    """The faces of a mesh, and which of their corners are shaded together."""

    faces: Faces
    joined: Faces
    around: Rows

    @classmethod
    def of(cls, positions: Positions, faces: Faces) -> Shape:
        """The shape of positions, shape (n, 3), within a box of diagonal 1."""
        _, joined, index = weld(np.rint(positions * _GRID), faces)
        joined = np.ascontiguousarray(joined, np.int32)
        return cls(np.ascontiguousarray(faces, np.int32), joined, vertex_faces(joined, int(index.max()) + 1))

    def normals(self, positions: Positions) -> Normals:
        """Normals of corners as viewers make them, shape (m, 9), for `positions`, shape (n, 3)."""
        count = len(self.faces)
        normals = np.empty((count, 9), np.float32)
        _kernels.shown_normals(
            positions,
            self.faces,
            self.joined,
            self.around.starts,
            self.around.members,
            CREASE,
            _HALF_CREASE,
            MOST_AROUND,
            np.empty((count, 4)),
            normals,
        )
        return normals


class Canvas:
    """Room for pictures, shape (pixels, pixels), one after another."""

    def __init__(self, pixels: int) -> None:
        self.picture, self.unlike, self._depth, self._lengths = (np.empty((pixels, pixels), np.float32) for _ in "1234")
        self.owner = np.empty((pixels, pixels), np.int32)
        self._tiles = np.empty((-(-pixels // _TILE),) * 2, np.float32)

    def draw(self, positions: Positions, faces: Faces, normals: Normals, camera: Matrix) -> Picture:
        """A picture of a mesh, lit alike on both sides of its faces; `owner`: which face each pixel shows, -1: none."""
        room = np.empty(positions.shape), self._depth, self._lengths, self._tiles
        _kernels.draw_shaded(positions, faces, normals, camera, *room, self.picture, self.owner)
        return self.picture


def difference(first: Picture, second: Picture, unlike: Picture = _NOWHERE) -> Matrix:
    """Sums over pixels that either picture, shape (h, w), covers; shape (4,). `unlike` gets how unlike each is."""
    sums = np.zeros(4)
    scratch = np.empty((_SCRATCH_ROWS, first.shape[1] + 2 * _SPREADS["wide"][1]), np.float32)
    _kernels.likeness(first, second, _WIDE, _NARROW, VISIBLE, PLAIN, scratch, sums, unlike)
    return sums


def _half(name: str) -> Picture:
    spread, reach = _SPREADS[name]
    weights = [math.exp(-0.5 * (k / spread) ** 2) for k in range(reach + 1)]
    return np.array([weight / (2 * sum(weights) - weights[0]) for weight in weights], np.float32)


_WIDE, _NARROW = _half("wide"), _half("narrow")
