"""How much alike two meshes look: a distance, up to 1 they look the same on a screen (`spec/look.md`)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass
from functools import partial
from hashlib import blake2b
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError, public
from bsm.codec.arrays import Faces, Mask, Matrix, Positions
from bsm.codec.geometry.attributes import Attribute, Semantic, at_corners
from bsm.codec.geometry.mesh import LARGEST, TriangleMesh, box_around
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.look.pictures import (
    BACKGROUND,
    FEW,
    LEAST_PIXELS,
    MOST_PIXELS,
    SQUARE,
    TOWARDS,
    Canvas,
    Normals,
    Picture,
    Shape,
    Size,
    cameras,
    checker_steepness,
    difference,
)
from bsm.codec.threads import Result, ordered_map

DISSIMILAR = 0.03  # 1 - SSIM at distance 1
VISIBLE_SHARE = 0.005  # share of covered pixels that differ visibly, at distance 1
MOVING = 0.05  # 1 - SSIM of a frame of a moving picture at distance 1; no pixel of it counts by itself
POWER = 0.8  # of the larger of both over its bound: so that a distance is about linear in the step of a quantizer
GONE, GONE_POWER = 0.5, 2.0  # the same of `Look.gone`: what is gone altogether is at distance 4, however small it is
STRIKING, STRIKING_POWER = 0.0032, 1.35  # the same of `Look.striking`: about 4 in Butteraugli's 3-norm at distance 1
TURNED = 1.5  # degrees that normals may be turned, on average over the picture where that is most, at distance 1
MOST_TILES = 2.0**20  # how often a texture may be repeated
LEAST_AREA = 1e-12  # of a face that faces some side, over the squared diagonal
_LARGEST = 1e150
MOST_WORK, WORK_PER_FACE = 120_000_000, 10_000
"""Pixels to draw before an encoder no longer looks for still smaller streams: about half a second, and 50 us a face."""

Paint = Callable[[Canvas, Faces, Matrix], list[Picture]]
Shading = Callable[[Positions], Normals]  # normals of corners, where vertices are known
Version = tuple["Gallery", Positions, Normals, dict[int, Matrix]]
"""Pictures of an original; where a version has its vertices, its normals; and what is known of sides."""


@public
@dataclass(frozen=True)
class Look:
    """The difference of a mesh from an original in pictures.

    Attributes
    ----------
    distance : float
        0: the pictures are equal; up to 1: the meshes look the same. Steps twice as wide about double it.
    dissimilarity : float
        1 - SSIM, mean over the covered pixels of all pictures.
    visible : float
        Share of covered pixels whose shade differs by more than 12 of 255 after a slight blur.
    gone : float
        Share of pixels that differ by more than 48 of 255, in the square of 8 by 8 pixels where it is largest: half if
        an edge moves by some pixels, all if a part is missing.
    striking : float
        4-norm of the difference of shades after a blur, which counts less where shades vary: it sees grain on smooth
        places, and contours that have moved.

    Examples
    --------
    >>> import bsm
    >>> seen = bsm.look("bunny.ply", "bunny.bsm")
    >>> seen.distance <= 1, seen.visible <= 0.005
    (True, True)
    """

    distance: float
    dissimilarity: float
    visible: float
    gone: float
    striking: float

    @property
    def moving(self) -> float:
        """The distance of a frame that is one of many, and soon gone, see `spec/look.md`, L 5."""
        return math.pow(self.dissimilarity / MOVING, POWER)


class Gallery:
    """Pictures of an original; each is drawn when it is first looked at."""

    def __init__(self, cameras: Sequence[Matrix], positions: Positions, faces: Faces, normals: Normals) -> None:
        self._cameras, self._mesh = cameras, (positions, faces, normals)
        self._pictures: dict[int, Picture] = {}

    def picture(self, canvas: Canvas, side: int) -> Picture:
        """The picture from one side, drawn on this canvas if nobody has seen it yet."""
        if side not in self._pictures:
            self._pictures[side] = canvas.draw(*self._mesh, self._cameras[side]).copy()
        return self._pictures[side]


class LookMetric:
    """Pictures of an original, and versions of it: with its own normals if it has some, or what `shading` makes."""

    def __init__(
        self,
        mesh: TriangleMesh,
        *,
        threads: int | None = None,
        shading: Shading | None = None,
        most_pixels: int = MOST_PIXELS,
    ) -> None:
        self._mesh, self._threads = mesh, threads
        used = mesh.positions[_used(mesh.faces, len(mesh.positions))]
        low, high = box_around(used)
        with np.errstate(over="ignore"):
            self._diagonal = math.hypot(*(high - low))
        if not self._diagonal > 0.0:
            raise MeshError("the mesh cannot be looked at: all vertices are at one place")
        if not self._diagonal < _LARGEST:
            raise MeshError("the mesh cannot be looked at: its coordinates are too large to compute with; scale it")
        self._middle = low + (high - low) / 2
        positions = self._placed(mesh.positions)
        self._shape = Shape.of(positions, mesh.faces)
        self._size = Size.of(positions, mesh.faces, most_pixels)
        self.pixels = self._size.pixels
        self._cameras = cameras(self._placed(used), self.pixels)
        self._sides = range(len(self._cameras))
        self._idle = [Canvas(self.pixels)]
        self._pictures = Gallery(self._cameras, positions, self._shape.faces, self._shape.normals(positions))
        covered = (self._covered(side) for side in self._sides)
        if self._size.largest < LEAST_AREA or not any(covered):
            raise MeshError("the mesh cannot be looked at: its faces have no area")
        own = own_normals(mesh)
        self._own = None if own is None else (Gallery(self._cameras, positions, self._shape.faces, own), own)
        self._drawn_pictures = len(self._cameras) * (1 if own is None else 2)  # sooner or later
        self._shading = shading
        self._worst = list(FEW)
        self._known: dict[bytes, tuple[dict[int, Matrix], ...]] = {}
        self._last: tuple[bytes, list[Version]] = b"", []

    def shaded_by(self, shading: Shading) -> LookMetric:
        """Return the same metric for versions with normals that `shading` makes."""
        other = copy(self)
        other._shading, other._known, other._last = shading, {}, (b"", [])
        return other

    @property
    def spent(self) -> float:
        """How much was drawn, over that from which on nothing should be drawn that need not be."""
        return self._drawn_pictures * self._size.work / (MOST_WORK + WORK_PER_FACE * len(self._mesh.faces))

    def look(self, positions: Positions) -> Look:
        """How these positions look on the faces of the original, with normals that follow from them."""
        _, whole = self.glance(positions, 0.0, math.inf)
        assert whole is not None
        return whole

    def glance(self, positions: Positions, least: float, most: float) -> tuple[Look, Look | None]:
        """How `positions`, shape (n, 3), look from a few sides; and from all, unless a few say enough."""
        positions = np.ascontiguousarray(positions, np.float64)
        if positions.shape != self._mesh.positions.shape:
            raise MeshError(f"positions must have shape {self._mesh.positions.shape}, not {positions.shape}")
        if not np.isfinite(positions).all():
            raise MeshError("a position is not finite")
        glances = [self._glanced(version, least, most) for version in self._versions(positions)]
        return max(glances, key=lambda glance: (glance[1] or glance[0]).distance)

    def breaks(self, positions: Positions, most: float) -> bool:
        """Whether a few sides, first those that did so last, show that `positions`, shape (n, 3), look farther."""
        version = self._versions(positions)[0]
        own = {side: self._covered(side) for side in FEW}
        dissimilar, visible, striking, covered = 0.0, 0.0, 0.0, max(sum(own.values()), 1.0)
        for at, side in enumerate(self._worst):
            sums = self._of(version, [side])[0]
            dissimilar, visible = dissimilar + float(sums[0]), visible + float(sums[1])
            covered, striking = covered + float(sums[2]) - own[side], striking + float(sums[4]) / len(FEW)
            if judged(dissimilar / covered, visible / covered, float(sums[3]) / SQUARE, striking).distance > most:
                self._worst.insert(0, self._worst.pop(at))
                return True
        return False

    def _glanced(self, version: Version, least: float, most: float) -> tuple[Look, Look | None]:
        few = self._of(version, FEW)
        seen = summed(few) if few[:, 2].any() else None
        if seen is not None and not least <= seen.distance <= most:
            return seen, None
        whole = summed(self._of(version, self._sides))
        return seen or whole, whole

    def _versions(self, positions: Positions) -> list[Version]:
        """What is known of `positions`, with the normals that follow from them, and with the mesh's own."""
        key = blake2b(np.ascontiguousarray(positions).data).digest()
        if key != self._last[0]:
            placed, known = self._placed(positions), self._known.setdefault(key, ({}, {}))
            normals = Shape.of(placed, self._shape.faces).normals(placed)  # those that have come to one place are one
            self._last = key, [(self._pictures, placed, normals, known[0])]
            if self._own is not None:
                own = self._shading(placed) if self._shading else self._own[1]
                self._last[1].append((self._own[0], placed, own, known[1]))
        return self._last[1]

    def _of(self, version: Version, sides: Sequence[int]) -> Matrix:
        """What `difference` says of some sides, a row each; each is drawn once."""
        pictures, placed, normals, sums = version
        new = [side for side in sides if side not in sums]
        sums.update(zip(new, self._sums(pictures, placed, self._shape.faces, normals, new), strict=True))
        return np.array([sums[side] for side in sides])

    def shaded(self, positions: Positions, normals: Normals) -> float:
        """The distance of positions, shape (n, 3), with normals of corners, from pictures of the original's own; or by
        how much they are turned from these, where that is more: gloss shows what no picture here does."""
        assert self._own is not None
        pictures, own = self._own
        # From the chord: two normals of no length are equal.
        cosines = (1.0 - np.square((normals - own).reshape(-1, 3).astype(np.float64)).sum(axis=1) / 2.0).clip(-1.0, 1.0)
        turned, placed = np.degrees(np.arccos(cosines)).reshape(-1, 3).mean(axis=1), self._placed(positions)

        def seen(canvas: Canvas, side: int) -> tuple[Matrix, float]:
            original = pictures.picture(canvas, side)
            picture = canvas.draw(placed, self._shape.faces, normals, self._cameras[side])
            shown = canvas.owner[canvas.owner >= 0]
            return difference(original, picture)[:4], float(turned[shown].mean()) if len(shown) else 0.0

        found = self._each(seen, self._sides)
        sums = np.array([(*sums, 0.0) for sums, _ in found])
        return max(summed(sums).distance, max(angle for _, angle in found) / TURNED)

    @property
    def against_faces(self) -> bool:
        """Whether the original has normals that point to the other side of their faces, or nowhere."""
        assert self._own is not None
        positions, faces = self._placed(self._mesh.positions), self._shape.faces
        first, second, third = (positions[corner] for corner in faces.T)
        sums = np.cross(second - first, third - first)
        own = self._own[1].reshape(-1, 3, 3)
        facing = np.einsum("fd,fcd->fc", sums, own) <= 0.0
        return bool(facing[np.sqrt(np.square(sums).sum(axis=1)) > LEAST_AREA].any())

    def bare_distance(self, positions: Positions) -> float:
        """The distance of positions, shape (n, 3), with normals that follow from them."""
        return summed(self._of(self._versions(positions)[0], self._sides)).distance

    def distance(self, positions: Positions) -> float:
        """The distance alone of `look` at `positions`, shape (n, 3)."""
        return self.look(positions).distance

    def compare(self, other: TriangleMesh) -> Look:
        """How another mesh looks, of whatever vertices and faces, in the frames that the original fills."""
        placed = self._placed(other.positions)
        shape = Shape.of(placed, other.faces)
        smooth = shape.normals(placed)
        seen = self._seen(self._pictures, placed, shape.faces, smooth)
        if self._own is None:
            return seen
        others = own_normals(other)
        shaded = self._seen(self._own[0], placed, shape.faces, smooth if others is None else others)
        return max(seen, shaded, key=lambda look: look.distance)

    def flat(self, other: TriangleMesh) -> float:
        """1 - SSIM of pictures in which each face has its own normal, see `spec/look.md`, L 6."""
        pictures = []
        for mesh in (self._mesh, other):
            placed = self._placed(mesh.positions)
            normals = np.tile(face_normals(placed, mesh.faces).astype(np.float32), 3)
            pictures.append(self._drawn(placed, np.ascontiguousarray(mesh.faces, np.int32), normals))
        return summed(np.array([difference(*pair) for pair in zip(*pictures, strict=True)])).dissimilarity

    def blame(self, positions: Positions) -> Matrix:
        """Where a version looks different: how unlike the pixels are that show each of its faces, added."""
        placed, faces = self._placed(positions), self._shape.faces
        normals = self._shape.normals(placed)

        def blamed(canvas: Canvas, side: int) -> tuple[int, Matrix]:
            original, found = self._pictures.picture(canvas, side), np.zeros(len(faces))
            difference(original, canvas.draw(placed, faces, normals, self._cameras[side]), canvas.owner, found)
            return int((canvas.owner >= 0).sum()), found

        counts, added = zip(*self._each(blamed, self._sides), strict=True)
        return np.asarray(np.sum(added, axis=0) / max(sum(counts), 1))

    def pictures(self, other: TriangleMesh) -> tuple[Picture, Picture]:
        """Both meshes from the side where they differ most, each of shape (pixels, pixels)."""
        placed = self._placed(other.positions)
        shape = Shape.of(placed, other.faces)
        drawn = self._drawn(placed, shape.faces, shape.normals(placed))
        originals = self._each(self._pictures.picture, self._sides)
        return max(zip(originals, drawn, strict=True), key=lambda pair: difference(*pair)[0])

    def _covered(self, side: int) -> float:
        """How many pixels the original covers."""
        return float((self._pictures.picture(self._idle[-1], side) < BACKGROUND).sum())

    def _placed(self, positions: Positions) -> Positions:
        with np.errstate(over="ignore"):
            placed = (positions - self._middle) / self._diagonal
        return np.ascontiguousarray(placed.clip(-LARGEST, LARGEST))

    def _each(self, work: Callable[[Canvas, int], Result], sides: Sequence[int]) -> list[Result]:
        """Work on each side, on a canvas that nobody else draws on meanwhile."""

        def done(side: int) -> Result:
            try:
                canvas = self._idle.pop()
            except IndexError:
                canvas = Canvas(self.pixels)
            result = work(canvas, side)
            self._idle.append(canvas)
            return result

        self._drawn_pictures += len(sides)
        return list(ordered_map(done, sides, self._threads))

    def _drawn(self, placed: Positions, faces: Faces, normals: Normals) -> list[Picture]:
        """From all sides."""
        drawn = Gallery(self._cameras, placed, faces, normals)
        return self._each(drawn.picture, self._sides)

    def _seen(self, pictures: Gallery, placed: Positions, faces: Faces, normals: Normals) -> Look:
        return summed(self._sums(pictures, placed, faces, normals, self._sides))

    def _sums(
        self, pictures: Gallery, placed: Positions, faces: Faces, normals: Normals, sides: Sequence[int]
    ) -> Matrix:
        """What `difference` says of some sides, a row each."""

        def sums(canvas: Canvas, side: int) -> Matrix:
            return difference(pictures.picture(canvas, side), canvas.draw(placed, faces, normals, self._cameras[side]))

        found = np.array(self._each(sums, sides)).reshape(-1, 5)
        if pictures is not self._pictures:
            found[:, 4] = 0.0  # normals that are turned change shades of a whole place, which does not strike
        return found


class AttributeLook:
    """Pictures of an original under a checker, at texture coordinates, or in colours: `spec/look.md`, L 7 and L 8.

    `values` are what corners have, shape (m, 3 c)."""

    def __init__(self, mesh: TriangleMesh, semantic: Semantic, values: Matrix, *, threads: int | None = None) -> None:
        self._metric = LookMetric(mesh.bare, threads=threads, most_pixels=LEAST_PIXELS)
        self._faces, self._semantic = self._metric._shape.faces, semantic
        self._paint = self._painting(values, mesh.positions, self._faces)
        self._pictures = self._drawn(self._paint, mesh.positions, self._faces, values, range(len(TOWARDS)))

    def distance(self, positions: Positions, values: Matrix, sides: Sequence[int] = range(len(TOWARDS))) -> float:
        """How far other positions, and what corners have then, look from the original."""
        return self._far(self._drawn(self._paint, positions, self._faces, values, sides), sides)

    def compare(self, other: TriangleMesh) -> float | None:
        """How far another mesh looks, of whatever faces; None: it has no such attribute."""
        values, faces = look_values(other, self._semantic), np.ascontiguousarray(other.faces, np.int32)
        if values is None:
            return None
        paint, sides = self._painting(values, other.positions, faces), range(len(TOWARDS))
        return self._far(self._drawn(paint, other.positions, faces, values, sides), sides)

    def _painting(self, values: Matrix, positions: Positions, faces: Faces) -> Paint:
        if self._semantic == "color":
            return Canvas.in_colours
        return partial(Canvas.checkered, steepness=checker_steepness(values, self._metric._placed(positions), faces))

    def _far(self, drawn: Sequence[list[Picture]], sides: Sequence[int]) -> float:
        pairs = (zip(self._pictures[side], pictures, strict=True) for side, pictures in zip(sides, drawn, strict=True))
        sums = np.array([difference(*pair) for side in pairs for pair in side])
        return math.pow(summed(sums).dissimilarity / DISSIMILAR, POWER)

    def _drawn(
        self, paint: Paint, positions: Positions, faces: Faces, values: Matrix, sides: Sequence[int]
    ) -> list[list[Picture]]:
        metric, placed = self._metric, self._metric._placed(np.ascontiguousarray(positions, np.float64))
        normals = Shape.of(placed, faces).normals(placed)

        def drawn(canvas: Canvas, side: int) -> list[Picture]:
            canvas.draw(placed, faces, normals, metric._cameras[side])
            return paint(canvas, faces, values)

        return metric._each(drawn, sides)


def look(original: TriangleMesh, other: TriangleMesh, *, threads: int | None = None) -> Look:
    """How much alike two meshes look, of whatever vertices and faces."""
    return LookMetric(original, threads=threads).compare(other)


def summed(sums: Matrix) -> Look:
    """The look of what `difference` says of some sides, shape (sides, 5)."""
    dissimilar, visible, covered, _, striking = (float(sum(column)) for column in sums.T)
    return judged(dissimilar / covered, visible / covered, float(sums[:, 3].max()) / SQUARE, striking / len(sums))


def judged(dissimilarity: float, visible: float, gone: float, striking: float) -> Look:
    """The distance that these numbers make."""
    dissimilarity = max(0.0, dissimilarity)  # of equal pictures it is a rounding error
    distance = max(dissimilarity / DISSIMILAR, visible / VISIBLE_SHARE) ** POWER
    distance = max(distance, (gone / GONE) ** GONE_POWER, (striking / STRIKING) ** STRIKING_POWER)
    return Look(distance, dissimilarity, visible, gone, striking)


def _used(faces: Faces, count: int) -> Mask:
    used = np.zeros(count, np.bool_)
    used[faces] = True
    return used


def own_normals(mesh: TriangleMesh) -> Normals | None:
    """Normals of corners that the mesh has as an attribute, of length 1, shape (m, 9); None: it has none."""
    for attribute in mesh.attributes:
        if attribute.semantic == "normal" and attribute.components == 3 and attribute.domain != "face":
            return of_length_1(at_corners(attribute, mesh.faces))
    return None


def of_length_1(normals: npt.NDArray[Any]) -> Normals:
    """Normals of corners, shape (m, 3, 3), of length 1 or 0; shape (m, 9)."""
    corners = np.asarray(normals, np.float64)
    lengths = np.sqrt(np.square(corners).sum(axis=-1, keepdims=True))
    unit = np.divide(corners, lengths, out=np.zeros_like(corners), where=lengths > 0)
    return np.ascontiguousarray(unit.reshape(-1, 9), np.float32)


def look_values(mesh: TriangleMesh, semantic: Semantic) -> Matrix | None:
    """The arguments of `AttributeLook` for the first attribute that means colors, or texture coordinates, or None."""
    found = (attribute for attribute in mesh.attributes if attribute.semantic == semantic and has_look(attribute))
    return next((painted(semantic, at_corners(attribute, mesh.faces)) for attribute in found), None)


def has_look(attribute: Attribute) -> bool:
    """Whether an attribute is seen in pictures: texture coordinates of a plane; and colours, if floats from 0 to 1."""
    kind = attribute.values.dtype.kind
    if attribute.semantic == "color":
        return kind == "u" or (kind == "f" and bool(np.abs(attribute.values - 0.5).max(initial=0.0) <= 0.5))
    plane = attribute.semantic == "texcoord" and attribute.components == 2 and attribute.domain != "face"
    return plane and kind == "f" and float(np.abs(attribute.values).max(initial=0.0)) <= MOST_TILES


def painted(semantic: Semantic, corners: npt.NDArray[Any]) -> Matrix:
    """Values of corners as `AttributeLook` takes them, shape (m, 3, c): of colours red, green, blue, from 0 to 1."""
    if semantic == "color":
        whole = 1.0 if corners.dtype.kind == "f" else float(np.iinfo(corners.dtype).max)
        corners = (corners[..., :3] if corners.shape[2] > 2 else corners[..., [0, 0, 0]]) / whole
    return corners.astype(np.float64).reshape(len(corners), -1)
