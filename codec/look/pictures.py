"""Shaded pictures of a mesh from all sides, and how much two of them differ."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.codec.arrays import Faces, Matrix, Positions, end_phase
from bsm.codec.geometry.graph import Lists, vertex_faces
from bsm.codec.geometry.welding import degenerate, group_rows

# Shades, 0 (black) to 1 (white, the background); first row on top.
Picture = npt.NDArray[np.float32]
Normals = npt.NDArray[np.float32]  # of the corners of faces, shape (m, 9)

# Normals across sharper edges would draw gradients on flat faces.
# Cosine of the angle between faces from which on shading is not smooth.
CREASE = math.cos(math.radians(40.0))
_HALF_CREASE = math.cos(math.radians(19.9))
# The hub of a fan may have a million faces. Comparing each with each would take hours.
MOST_AROUND = 128  # faces around a vertex, above which its corners are shaded as their faces are
BACKGROUND = 1.0
# Not along the axes, where CAD parts show single faces, edge-on. The two ends of each axis see what the other misses.
TOWARDS = ((2, 2, 1), (-2, -2, -1), (-2, 1, 2), (2, -1, -2), (1, -2, 2), (-1, 2, -2))
"""Directions of the camera, from the middle of the mesh: both ends of three oblique axes at right angles."""
ROLL = math.radians(33.0)
"""The angle by which cameras are rolled: edges along an axis of the mesh cross columns and rows of samples, and one bit
of a coordinate does not move a whole column."""
SAMPLES = 4  # samples along each side of a pixel, which is their mean
LIGHT = (0.35, 0.5, 0.79)  # where the light is: right, up, towards the camera
# Without it, the last bit of a coordinate decides whether a sample on an edge is covered, and equal meshes look
# different.
# Samples, by which edges of symmetric shapes miss the centers of samples.
ASIDE = (2.0**-12, 2.0**-11.5, 0.0)
AIR = 1.03  # the side of the picture over the longer side of what it shows
LEAST_PIXELS, MOST_PIXELS = 512, 2048  # samples along the side of a picture
FEWEST_PIXELS = 16  # if many faces cover each other and `LEAST_PIXELS` would take too long
FACE_PIXELS = 8  # by which a picture of more than the least samples grows for each face, at most
EDGE_PIXELS = 2.0  # samples along a mean edge, where `MOST_PIXELS` and `MOST_COVERED` allow it
MOST_COVERED, COVERED_BY_FACE, ROW = 5 * LEAST_PIXELS**2, 16, 4
"""Samples that faces may cover in a picture, each as often as it is covered, and how many more for each face; and
samples that take as long to cover as a row of a face takes."""
# Of a checker: squares a side, how bright dark ones are, texels of their sides.
CHECKS, DARK, TEXELS = 8, 0.35, 128
# Eyes see less where the surface is busy (masking): squared differences are divided by this plus the local variance.
STEADY = 0.02  # variance of shades that hides half of a squared difference
_GRID = 2.0**24
_SPREAD, _REACH = 1.5, 5  # standard deviation of the blur, and its reach, in pixels
_BELL = np.exp(-0.5 * (np.arange(_REACH + 1) / _SPREAD) ** 2)
_BLUR = (_BELL / (2.0 * _BELL.sum() - _BELL[0])).astype(np.float32)  # one side of it
_SCRATCH_ROWS, _SCRATCH_COLUMNS, _TILE = 52, 18, 8


@dataclass(frozen=True, eq=False)
class Shape:
    """The faces of a mesh, and which of their corners are shaded together."""

    faces: Faces
    joined: Faces
    around: Lists  # without faces that have two corners at one place

    @classmethod
    def of(
        cls,
        positions: Positions,
        faces: Faces,
        known: Shape | None = None,
        around: Lists | None = None,
    ) -> Shape:
        """The shape of positions, shape (n, 3), within a box of diagonal 1: a known one of these faces if it is so.

        `around`, if it is known already, lists the faces around each vertex.
        """
        end_phase(len(positions))  # what follows takes many arrays
        index = group_rows(np.rint(positions * _GRID))
        # Grouped on a grid of 2^-24 of the diagonal: finer distances are rounding.
        joined = index[faces]
        if np.array_equal(joined, faces):
            joined = faces  # one array instead of two
        # Nearly always the same: lists of faces around vertices take longer than the comparison.
        if known is not None and np.array_equal(joined, known.joined):
            return known
        counted, places = np.flatnonzero(~degenerate(joined)).astype(np.int32), int(index.max()) + 1
        if len(counted) == len(joined):
            if around is None or joined is not faces:
                around = vertex_faces(joined, places)
        else:
            around = vertex_faces(joined[counted], places)
            around = Lists(around.starts, counted[around.members])
        return cls(np.ascontiguousarray(faces, np.int32), joined, around)

    def normals(self, positions: Positions) -> Normals:
        """Normals of corners as viewers make them, shape (m, 9), for `positions`, shape (n, 3)."""
        count = len(self.faces)
        normals = np.zeros((count, 9), np.float32)
        shading = CREASE, _HALF_CREASE, MOST_AROUND
        _kernels.shown_normals(
            positions, self.faces, self.joined, self.around, shading, np.empty((count, 4)), normals
        )
        return normals


class Canvas:
    """Room for pictures, one after another: `samples` along each side, which make a quarter as many pixels."""

    def __init__(self, samples: int) -> None:
        # Kept from picture to picture. Clearing only what was drawn is faster than memory from the system.
        self.samples, self._depth = (np.empty((samples, samples), np.float32) for _ in "12")
        self.owner, self._drawn = (
            np.empty((0, samples), np.int32),
            np.array([0, samples, 0, samples], np.int32),
        )
        self._tiles = np.empty((-(-samples // _TILE),) * 2, np.float32)
        self._placed: Positions = np.empty((0, 3))

    def draw(
        self,
        positions: Positions,
        faces: Faces,
        normals: Normals,
        camera: Matrix,
        owned: bool = True,
    ) -> Picture:
        """Draw a mesh, lit alike on both sides; if `owned`, `owner` is the face that each sample shows, or -1."""
        placed = np.empty(positions.shape)
        self.owner = np.empty(self.samples.shape if owned else (0, 0), np.int32)
        room, on = (
            np.empty(len(faces), np.int32),
            (self._depth, self._tiles, self.samples, self.owner, self._drawn),
        )
        _kernels.draw_shaded(positions, faces, normals, camera, placed, room, on)
        if owned:
            self._placed = placed  # colors are painted from the owners and these places
        return averaged(self.samples)

    def in_colors(self, faces: Faces, colors: Matrix) -> list[Picture]:
        """Return the last picture in red, in green and in blue, given those of corners, shape (m, 9)."""
        painted = np.empty((3, *self.samples.shape), np.float32)
        _kernels.paint_colors(
            self.owner,
            self._placed,
            faces,
            colors,
            self.samples,
            painted.reshape(-1, len(self.owner)),
        )
        return [averaged(samples) for samples in painted]

    def checkered(self, faces: Faces, places: Matrix, steepness: Matrix) -> list[Picture]:
        """Return the last picture under a checker at places of corners, shape (m, 6), with its steepness on faces."""
        samples = self.samples.copy()
        _kernels.paint_checker(
            self.owner, self._placed, faces, places * CHECKS, steepness, DARK, samples
        )
        return [averaged(samples)]


def averaged(samples: Picture) -> Picture:
    """Return pixels: the means of squares of samples."""
    pixels = np.empty((samples.shape[0] // SAMPLES, samples.shape[1] // SAMPLES), np.float32)
    _kernels.averaged(samples, pixels)
    return pixels


def axes(towards: tuple[int, int, int]) -> Matrix:
    """The camera's axes as rows, shape (3, 3): right, up, towards the camera; z is up in the mesh."""
    x, y, z = towards
    flat, length = math.sqrt(x * x + y * y), math.sqrt(x * x + y * y + z * z)
    right = (-y / flat, x / flat, 0.0)
    ahead = (x / length, y / length, z / length)
    up = (-ahead[2] * right[1], ahead[2] * right[0], ahead[0] * right[1] - ahead[1] * right[0])
    return np.array([right, up, ahead])


def light_of(towards: tuple[int, int, int]) -> Matrix:
    """Return the direction of the light in a picture from a side, in the axes of the mesh."""
    right, up, ahead = axes(towards)
    return np.asarray(LIGHT[0] * right + LIGHT[1] * up + LIGHT[2] * ahead)


def _rolled_axes(towards: tuple[int, int, int]) -> Matrix:
    right, up, ahead = axes(towards)
    cosine, sine = math.cos(ROLL), math.sin(ROLL)
    return np.array([cosine * right + sine * up, cosine * up - sine * right, ahead])


_FLAT_AXES = np.concatenate([_rolled_axes(towards)[:2] for towards in TOWARDS])
"""To the right and up, in the picture of each side."""


def _bounds_along(positions: Positions, directions: Matrix) -> Matrix:
    """Return the least and the largest coordinate along each direction, shape (k, 2)."""
    # Not a matrix product, whose sums BLAS orders as it likes: pictures must be equal on all machines.
    bounds = np.empty((len(directions), 2))
    _kernels.bounds_along(np.ascontiguousarray(positions), np.ascontiguousarray(directions), bounds)
    return bounds


def _side_of(bounds: Matrix) -> float:
    """Return the side of a picture, from bounds to the right and up."""
    low, high = bounds.T
    return AIR * float((high - low)[:2].max()) or 1.0


def sides_of(positions: Positions) -> Matrix:
    """Return the sides of the pictures of positions, shape (n, 3), in their unit."""
    return np.array(
        [_side_of(bounds) for bounds in _bounds_along(positions, _FLAT_AXES).reshape(-1, 2, 2)]
    )


def cameras(
    positions: Positions, pixels: int, sides: tuple[tuple[int, int, int], ...] = TOWARDS
) -> list[Matrix]:
    """Return the arguments of `draw_shaded` for sides, shape (15,), so that positions, shape (n, 3), fill pictures."""
    rows = [_rolled_axes(towards) for towards in sides]
    extents = _bounds_along(positions, np.concatenate(rows)).reshape(-1, 3, 2)
    arguments = []
    for towards, rotation, bounds in zip(sides, rows, extents, strict=True):
        side, (low, high) = _side_of(bounds), bounds.T
        # As many depths in the box's diagonal.
        scale = np.array([pixels / side, -pixels / side, 2.0**22])
        offset = np.array([pixels / 2, pixels / 2, 0.0]) + ASIDE - scale * (low + high) / 2
        to_picture = np.column_stack([rotation * scale[:, None], offset])
        arguments.append(np.concatenate([to_picture.ravel(), light_of(towards)]))
    return arguments


@dataclass(frozen=True)
class Size:
    """How large pictures are."""

    pixels: int
    thickest: float  # of the heights of faces over their longest sides, in a box of diagonal 1

    @classmethod
    def of(cls, positions: Positions, faces: Faces, most_pixels: int = MOST_PIXELS) -> Size:
        """Enough pixels that the mean edge has `EDGE_PIXELS`, but no more than `MOST_COVERED` ones that are covered."""
        lengths, areas, bounds = np.empty((3, len(faces))), np.empty(len(faces)), np.empty((3, 2))
        _kernels.measure_faces(
            positions, np.ascontiguousarray(faces, np.int32), lengths, areas, bounds
        )
        extent = AIR * float((bounds[:, 1] - bounds[:, 0]).max())
        # Detail as fine as the mesh must be seen, so dense meshes get larger pictures, as on a screen that is zoomed
        # in.
        edge = float(lengths.sum()) / (3 * len(faces))
        if not edge > 0.0:
            return cls(LEAST_PIXELS, 0.0)
        # On average over all sides, a face covers half of its area, and has rows for half of its longest side.
        # Triangles that cover each other many times would make drawing arbitrarily slow. The pictures shrink instead.
        covered = float(areas.sum()) / (2.0 * extent**2)
        rows = ROW * float(lengths.max(axis=0).sum()) / (2.0 * extent)
        room = MOST_COVERED + COVERED_BY_FACE * len(faces)
        most = 2.0 * room / (rows + math.sqrt(rows**2 + 4.0 * covered * room))
        wanted = max(LEAST_PIXELS, math.ceil(min(EDGE_PIXELS * extent / edge, MOST_PIXELS)))
        grown = math.isqrt(LEAST_PIXELS**2 + FACE_PIXELS * len(faces))
        pixels = max(FEWEST_PIXELS, min(wanted, grown, most_pixels, int(min(most, MOST_PIXELS))))
        pixels -= pixels % SAMPLES
        longest = np.maximum(lengths.max(axis=0), np.finfo(np.float64).tiny)
        return cls(pixels, float((2.0 * areas / longest).max()))


def checker_steepness(places: Matrix, positions: Positions, faces: Faces) -> Matrix:
    """One over the part of a checker's square that its edges take on each face, shape (m,); 0: it is gray there."""
    first, second = places[:, 2:4] - places[:, :2], places[:, 4:] - places[:, :2]
    # A checker finer than a pixel would flicker. It fades to gray where its squares get too small.
    texels = (
        np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) * (CHECKS * TEXELS) ** 2
    )
    a, b, c = (positions[corner] for corner in faces.T)
    shown = np.sqrt(np.square(np.cross(b - a, c - a)).sum(axis=1)) * LEAST_PIXELS**2
    ratio = np.divide(texels, shown, out=np.zeros(len(faces)), where=shown > 0.0)
    steepness: Matrix = 2.0 * np.floor(
        TEXELS * 0.5 ** np.rint(0.5 * np.log2(np.maximum(ratio, 1.0)))
    )
    return steepness


def difference(first: Picture, second: Picture) -> Matrix:
    """Return how unlike two pictures are, and the largest difference of blurred pixels; shape (2,)."""
    sums, scratch = (
        np.empty(2),
        np.empty((_SCRATCH_ROWS, first.shape[1] + _SCRATCH_COLUMNS), np.float32),
    )
    _kernels.contrast(first, second, _BLUR, STEADY, scratch, sums)
    sums[0] = math.sqrt(sums[0] / first.size)
    return sums
