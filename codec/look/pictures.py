"""Shaded pictures of a mesh, and how much two of them differ."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Indices, Matrix, Positions
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
_SCRATCH_ROWS, _TILE = 88, 8
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


def draw(positions: Positions, faces: Faces, normals: Normals, camera: Matrix, pixels: int) -> Picture:
    """A picture of a mesh, shape (pixels, pixels), lit alike on both sides of its faces; see `draw_owned`."""
    return draw_owned(positions, faces, normals, camera, pixels)[0]


def draw_owned(
    positions: Positions, faces: Faces, normals: Normals, camera: Matrix, pixels: int
) -> tuple[Picture, Indices]:
    """A picture, and which face each pixel shows, -1: none; both of shape (pixels, pixels)."""
    picture, depth, lengths = (np.empty((pixels, pixels), np.float32) for _ in range(3))
    tiles, owner = np.empty((-(-pixels // _TILE),) * 2, np.float32), np.empty((pixels, pixels), np.int32)
    _kernels.draw_shaded(
        positions, faces, normals, camera, np.empty(positions.shape), depth, lengths, tiles, picture, owner
    )
    return picture, owner


def difference(first: Picture, second: Picture) -> Matrix:
    """Sums over pixels that either picture, shape (h, w), covers; shape (4,)."""
    return _compared(first, second, _NOWHERE)


def difference_map(first: Picture, second: Picture) -> Picture:
    """How unlike each pixel is, shape (h, w)."""
    found = np.zeros(first.shape, np.float32)
    _compared(first, second, found)
    return found


def _compared(first: Picture, second: Picture, found: Picture) -> Matrix:
    sums = np.zeros(4)
    scratch = np.empty((_SCRATCH_ROWS, first.shape[1] + 2 * _SPREADS["wide"][1]), np.float32)
    _kernels.likeness(first, second, _half("wide"), _half("narrow"), VISIBLE, PLAIN, scratch, sums, found)
    return sums


def _half(name: str) -> Picture:
    spread, reach = _SPREADS[name]
    weights = [math.exp(-0.5 * (k / spread) ** 2) for k in range(reach + 1)]
    return np.array([weight / (2 * sum(weights) - weights[0]) for weight in weights], np.float32)
