"""The look distance of two meshes: at 1 they look the same on a screen (`spec/look.md`)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError, public
from bsm.codec.arrays import Faces, Matrix, Positions, end_phase
from bsm.codec.geometry.attributes import Attribute, Semantic, at_corners
from bsm.codec.geometry.graph import Lists
from bsm.codec.geometry.mesh import LARGEST, TriangleMesh, box_around
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.geometry.welding import degenerate, group_rows
from bsm.codec.look.pictures import (
    BACKGROUND,
    LEAST_PIXELS,
    MOST_PIXELS,
    TOWARDS,
    Canvas,
    Normals,
    Picture,
    Shape,
    Size,
    axes,
    cameras,
    checker_steepness,
    difference,
)
from bsm.codec.threads import Crew, Result

# Of the definition in `spec/look.md`; distances of different versions are not comparable.
LOOK_VERSION = 2
# `Look.unlike` at distance 1, and its power: twice a step is about twice as far.
UNLIKE, POWER = 0.0155, 4.0 / 3.0
GONE, GONE_POWER = 0.08, 2.0  # the same of `Look.gone`
MOVING = 0.034  # `Look.unlike` of a frame of a moving picture at distance 1
PAINTED = 0.044  # the same of pictures in colors, or under a checker
ROOM = 0.1  # share of a distance that is left for rounding normals
# Degrees that normals may be turned, on average over the picture where that is most, at distance 1.
TURNED = 1.5
MOST_TILES = 2.0**20  # how often a texture may be repeated
LEAST_AREA = 1e-12  # of a face that faces some side, over the squared diagonal
# Of a face that can be seen, over the diagonal: rounding makes thinner ones.
LEAST_THICKNESS = 2.0**-22
_LARGEST = 1e150
FAR = 1e3  # times as far away as most vertices: the stray vertex of a scan

Paint = Callable[[Canvas, Faces, Matrix], list[Picture]]


@public
@dataclass(frozen=True)
class Look:
    """The difference of a mesh from an original in pictures.

    Attributes
    ----------
    distance : float
        The look distance. 0: the pictures are equal; 1: the meshes look the same at a glance. Steps twice as wide
        about double it.
    unlike : float
        Root mean square difference of shades, which counts less where shades vary; mean over all sides.
    gone : float
        Largest difference of shades after a blur: it shows missing parts.

    Examples
    --------
    >>> import bsm
    >>> seen = bsm.look("bunny.ply", "bunny.bsm")
    >>> seen.distance <= 1, seen.unlike <= 0.0155
    (True, True)
    """

    distance: float
    unlike: float
    gone: float

    @property
    def moving(self) -> float:
        """The distance of a frame, which is shown for a moment only, see `spec/look.md`, L 5."""
        return math.pow(self.unlike / MOVING, POWER)


class Gallery:
    """Pictures of an original; each is drawn when it is first looked at."""

    def __init__(
        self, cameras: Sequence[Matrix], positions: Positions, faces: Faces, normals: Normals
    ) -> None:
        self._cameras = cameras
        self._mesh: tuple[Positions, Faces, Normals] | None = (positions, faces, normals)
        self._pictures: dict[int, Picture] = {}

    def picture(self, canvas: Canvas, side: int) -> Picture:
        """Return the picture from one side; draw it on this canvas the first time."""
        mesh = self._mesh
        if side not in self._pictures and mesh is not None:
            self._pictures[side] = canvas.draw(*mesh, self._cameras[side], owned=False)
        # After the last picture, nothing needs the mesh, which is as large as all others together.
        if len(self._pictures) == len(self._cameras):
            self._mesh = None
        return self._pictures[side]


class LookMetric:
    """Pictures of an original, and versions of it: with its own normals if it has some."""

    def __init__(
        self,
        mesh: TriangleMesh,
        *,
        threads: int | None = None,
        most_pixels: int = MOST_PIXELS,
        around: Lists | None = None,
    ) -> None:
        self._mesh, self._crew = mesh, Crew(threads)
        # Encoders leave out faces with two corners at one position, so that these may not count here, either.
        # The original has such faces and the decoded mesh has not. Its size and its frames must be the same for both.
        faces = mesh.faces[~degenerate(group_rows(mesh.positions)[mesh.faces])]
        # A stray vertex in no face would make the object small in its own pictures.
        used = mesh.positions[np.bincount(faces.ravel(), minlength=len(mesh.positions)) > 0]
        if not len(used):
            raise MeshError("the mesh cannot be looked at: its faces have no area")
        low, high = box_around(used)
        with np.errstate(over="ignore", invalid="ignore"):
            self._diagonal, lost = (
                math.hypot(*(high - low)),
                np.abs(used.astype(np.float32) - used).max(),
            )
        if not self._diagonal > 0.0:
            raise MeshError("the mesh cannot be looked at: all vertices are at one place")
        if not self._diagonal < _LARGEST:
            raise MeshError(
                "the mesh cannot be looked at: its coordinates are too large to compute with; scale it"
            )
        # Not (low + high) / 2, whose sum may overflow.
        self._middle = low + (high - low) / 2
        # Files hold single precision. Where that is exact enough, the original is drawn as files have it, or rounding
        # alone would count as a difference.
        # As files have them.
        self._kept = np.dtype(np.float32 if lost <= 1e-6 * self._diagonal else np.float64)
        positions = self._placed(mesh.positions)
        self._shape = Shape.of(positions, mesh.faces, around=around)
        self._size = Size.of(positions, faces, most_pixels)
        self.pixels = self._size.pixels
        self._cameras = cameras(self._placed(used), self.pixels)
        self._sides = range(len(self._cameras))
        self._idle = [Canvas(self.pixels)]
        self._pictures = Gallery(
            self._cameras, positions, self._shape.faces, self._shape.normals(positions)
        )
        # A mesh with area may still be invisible, if all of it is seen edge-on. Any number would then be a false
        # promise.
        if self._size.thickest < LEAST_THICKNESS or not self._shows_something():
            raise MeshError(f"the mesh cannot be looked at: its faces have no area{_outlier(used)}")
        own = own_normals(mesh)
        self._own = (
            None
            if own is None
            else (Gallery(self._cameras, positions, self._shape.faces, own), own)
        )
        self._known: dict[tuple[int, ...], Look] = {}
        self._turned: dict[tuple[int, ...], tuple[float, float]] = {}

    def _shows_something(self) -> bool:
        # All pictures at once: after the last one, the gallery lets go of its mesh and normals.
        originals = self._each(self._pictures.picture, self._sides)
        return any((picture < BACKGROUND).any() for picture in originals)

    def against(self, mesh: TriangleMesh) -> LookMetric:
        """Return a metric of versions of another mesh, which shows the pictures of this original."""
        # The pictures are the expensive part. They are shared, and only what depends on the other mesh is made anew.
        other = copy(self)
        other._mesh, other._shape = mesh, Shape.of(self._placed(mesh.positions), mesh.faces)
        own = own_normals(mesh)
        other._own = None if self._own is None or own is None else (self._own[0], own)
        other._known, other._turned = {}, {}
        return other

    def look(self, positions: Positions) -> Look:
        """How these positions, shape (n, 3), look on the faces of the original; with its own normals, too."""
        positions = np.ascontiguousarray(positions, np.float64)
        if positions.shape != self._mesh.positions.shape:
            raise MeshError(
                f"positions must have shape {self._mesh.positions.shape}, not {positions.shape}"
            )
        if not np.isfinite(positions).all():
            raise MeshError("a position is not finite")
        bare = self.bare(positions)
        # Viewers may shade by normals of the file or by their own. The promise holds for both.
        return (
            bare
            if self._own is None
            else max(bare, self._dressed(positions), key=lambda look: look.distance)
        )

    def distance(self, positions: Positions) -> float:
        """Return the distance of `look` at `positions`, shape (n, 3)."""
        return self.look(positions).distance

    def with_room(self, positions: Positions) -> float:
        """Return the distance of positions, shape (n, 3); with own normals, some of it is left for rounding these."""
        bare = self.bare(positions).distance
        return (
            bare
            if self._own is None
            else max(bare, self._dressed(positions).distance / (1.0 - ROOM))
        )

    # Three of six sides take half of the time, and see every face of a flat mesh. Searches ask this first.
    def glance(self, positions: Positions) -> float:
        """About the distance of positions, shape (n, 3), as three sides show it."""
        placed, sides = self._placed(positions), self._sides[::2]
        return self._seen(
            self._pictures, placed, self._shape.faces, self._shape.normals(placed), sides
        ).distance

    def bare(self, positions: Positions) -> Look:
        """How positions, shape (n, 3), look with normals that follow from them."""

        def seen() -> Look:
            placed, known = self._placed(positions), self._shape
            # Vertices that have come to one place are one.
            # Rounding can make vertices meet. Viewers then shade across, and so must these pictures.
            return self._seen(
                self._pictures,
                placed,
                known.faces,
                Shape.of(placed, known.faces, known).normals(placed),
            )

        return self._once(seen, positions)

    def _dressed(self, positions: Positions) -> Look:
        assert self._own is not None
        pictures, own = self._own

        def seen() -> Look:
            return self._seen(pictures, self._placed(positions), self._shape.faces, own)

        return self._once(seen, positions, own)

    def shaded(self, positions: Positions, normals: Normals) -> tuple[float, float]:
        """The distance of positions, shape (n, 3), with normals of corners, from pictures of the original's own; and by
        how much they are turned from these: gloss shows what no picture here does."""
        assert self._own is not None
        pictures, own = self._own

        def seen(canvas: Canvas, side: int) -> tuple[Matrix, float]:
            original = pictures.picture(canvas, side)
            picture = canvas.draw(placed, self._shape.faces, normals, self._cameras[side])
            shown = canvas.owner[canvas.owner >= 0]
            return difference(original, picture), float(turned[shown].mean()) if len(shown) else 0.0

        # From the chord: two normals of no length are equal.
        # Dot products of nearly equal vectors lose half of their digits; chords do not.
        cosines = (
            1.0 - np.square((normals - own).reshape(-1, 3).astype(np.float64)).sum(axis=1) / 2.0
        ).clip(-1.0, 1.0)
        turned, placed = (
            np.degrees(np.arccos(cosines)).reshape(-1, 3).mean(axis=1),
            self._placed(positions),
        )
        key = key_of(positions, normals)
        # By the bytes of the arrays: a search comes back to the same candidate by several ways.
        if key not in self._turned:
            sums, angles = zip(*self._each(seen, self._sides), strict=True)
            self._turned[key] = summed(np.array(sums)).distance, max(angles) / TURNED
        return self._turned[key]

    def _once(self, measure: Callable[[], Look], *of: Matrix | Normals) -> Look:
        """Return the earlier measurement of these arrays, or measure them."""
        key = key_of(*of)
        if key not in self._known:
            self._known[key] = measure()
        return self._known[key]

    @property
    def against_faces(self) -> bool:
        """Whether the original has normals that point to the other side of their faces, or nowhere."""
        assert self._own is not None
        positions, faces = self._placed(self._mesh.positions), self._shape.faces
        first, second, third = (positions[corner] for corner in faces.T)
        sums = np.cross(second - first, third - first)
        own = self._own[1].reshape(-1, 3, 3)
        # Such normals shade a surface from inside. Normals computed by a decoder would change the picture completely.
        facing = np.einsum("fd,fcd->fc", sums, own) <= 0.0
        return bool(facing[np.sqrt(np.square(sums).sum(axis=1)) > LEAST_AREA].any())

    def compare(self, other: TriangleMesh) -> Look:
        """How another mesh looks, of whatever vertices and faces, in the frames that the original fills."""
        placed = self._placed(other.positions)
        shape = Shape.of(placed, other.faces)
        smooth = shape.normals(placed)
        # Frames are those of the original, so that a mesh of another size is not scaled to fit.
        seen = self._seen(self._pictures, placed, shape.faces, smooth)
        if self._own is None:
            return seen
        others = own_normals(other)
        shaded = self._seen(self._own[0], placed, shape.faces, smooth if others is None else others)
        return max(seen, shaded, key=lambda look: look.distance)

    def flat(self, other: TriangleMesh) -> float:
        """The distance of pictures in which each face has its own normal, see `spec/look.md`, L 6."""
        pictures = []
        for mesh in (self._mesh, other):
            placed = self._placed(mesh.positions)
            normals = np.tile(face_normals(placed, mesh.faces).astype(np.float32), 3)
            pictures.append(
                self._drawn(placed, np.ascontiguousarray(mesh.faces, np.int32), normals)
            )
        return summed(
            np.array([difference(*pair) for pair in zip(*pictures, strict=True)])
        ).distance

    def view(self, other: TriangleMesh) -> Matrix:
        """The axes of the camera that sees both meshes differ most, as rows: right, up, towards the camera."""
        placed = self._placed(other.positions)
        shape = Shape.of(placed, other.faces)
        drawn = self._drawn(placed, shape.faces, shape.normals(placed))
        originals = self._each(self._pictures.picture, self._sides)
        return axes(
            TOWARDS[
                max(
                    self._sides, key=lambda side: float(difference(originals[side], drawn[side])[0])
                )
            ]
        )

    def _placed(self, positions: Positions) -> Positions:
        with np.errstate(over="ignore"):
            placed = (positions.astype(self._kept) - self._middle) / self._diagonal
        # A vertex that a damaged stream throws far away must still be a number that can be drawn.
        return np.ascontiguousarray(placed.clip(-LARGEST, LARGEST))

    def _each(self, work: Callable[[Canvas, int], Result], sides: Sequence[int]) -> list[Result]:
        """Work on each side, on a canvas of its own."""

        def done(side: int) -> Result:
            try:
                # A canvas takes up to tens of megabytes. Threads hand them on, and there are never more than threads.
                canvas = self._idle.pop()
            except IndexError:
                canvas = Canvas(self.pixels)
            result = work(canvas, side)
            self._idle.append(canvas)
            return result

        return self._crew.map(done, sides)

    def _drawn(self, placed: Positions, faces: Faces, normals: Normals) -> list[Picture]:
        """From all sides."""
        drawn = Gallery(self._cameras, placed, faces, normals)
        return self._each(drawn.picture, self._sides)

    def _seen(
        self,
        pictures: Gallery,
        placed: Positions,
        faces: Faces,
        normals: Normals,
        sides: Sequence[int] | None = None,
    ) -> Look:
        end_phase(len(placed))

        def sums(canvas: Canvas, side: int) -> Matrix:
            drawn = canvas.draw(placed, faces, normals, self._cameras[side], owned=False)
            return difference(pictures.picture(canvas, side), drawn)

        return summed(np.array(self._each(sums, self._sides if sides is None else sides)))


class AttributeLook:
    """Pictures of an original under a checker, or in colors of corners, shape (m, 3 c): `spec/look.md`, L 7, L 8."""

    def __init__(
        self, mesh: TriangleMesh, semantic: Semantic, values: Matrix, *, threads: int | None = None
    ) -> None:
        # Colors and checkers are smooth or coarse. Fewer pixels show their differences.
        self._metric = LookMetric(mesh.bare, threads=threads, most_pixels=LEAST_PIXELS)
        self._faces, self._semantic = self._metric._shape.faces, semantic
        self._paint = self._painting(values, mesh.positions, self._faces)
        self._known: dict[tuple[int, ...], float] = {}
        self._pictures = self._drawn(self._paint, mesh.positions, self._faces, values)

    def distance(self, positions: Positions, values: Matrix) -> float:
        """How far other positions, and the values of corners, look from the original."""
        key = key_of(positions, values)
        if key not in self._known:
            self._known[key] = self._far(self._drawn(self._paint, positions, self._faces, values))
        return self._known[key]

    def compare(self, other: TriangleMesh) -> float | None:
        """How far another mesh looks, of whatever faces; None: it has no such attribute."""
        values, faces = (
            look_values(other, self._semantic),
            np.ascontiguousarray(other.faces, np.int32),
        )
        if values is None:
            return None
        return self._far(
            self._drawn(
                self._painting(values, other.positions, faces), other.positions, faces, values
            )
        )

    def _painting(self, values: Matrix, positions: Positions, faces: Faces) -> Paint:
        if self._semantic == "color":
            return Canvas.in_colors
        return partial(
            Canvas.checkered,
            steepness=checker_steepness(values, self._metric._placed(positions), faces),
        )

    def _far(self, drawn: Sequence[list[Picture]]) -> float:
        pairs = (zip(*both, strict=True) for both in zip(self._pictures, drawn, strict=True))
        return math.pow(
            summed(np.array([difference(*pair) for side in pairs for pair in side])).unlike
            / PAINTED,
            POWER,
        )

    def _drawn(
        self, paint: Paint, positions: Positions, faces: Faces, values: Matrix
    ) -> list[list[Picture]]:
        metric, placed = (
            self._metric,
            self._metric._placed(np.ascontiguousarray(positions, np.float64)),
        )
        normals = Shape.of(placed, faces).normals(placed)

        def drawn(canvas: Canvas, side: int) -> list[Picture]:
            canvas.draw(placed, faces, normals, metric._cameras[side], owned=True)
            return paint(canvas, faces, values)

        return metric._each(drawn, metric._sides)


def look(original: TriangleMesh, other: TriangleMesh, *, threads: int | None = None) -> Look:
    """How much alike two meshes look, of whatever vertices and faces."""
    return LookMetric(original, threads=threads).compare(other)


def _outlier(used: Positions) -> str:
    """The vertex that is so far away that all others are one point, in words."""
    # The median, since the mean would follow the stray vertex.
    far = np.abs(used - np.median(used, axis=0)).max(axis=1)
    farthest = int(far.argmax())
    if far[farthest] < FAR * np.median(far):
        return ""
    place = ", ".join(f"{number:g}" for number in used[farthest].tolist())
    return f" beside the distance to the vertex at ({place}); remove it if it is a stray one"


def key_of(*arrays: Matrix | Normals) -> tuple[int, ...]:
    """Return numbers that other arrays do not have."""
    # Hashes of 64 bits rather than the arrays: a search keeps hundreds of results.
    return tuple(hash(array.tobytes()) for array in arrays)


def summed(sums: Matrix) -> Look:
    """The look of pairs of pictures, of which `difference` has these rows, shape (k, 2)."""
    unlike, gone = float(sums[:, 0].mean()), float(sums[:, 1].max())
    # A mean over the picture forgives a missing small part. The largest blurred difference does not.
    return Look(max((unlike / UNLIKE) ** POWER, (gone / GONE) ** GONE_POWER), unlike, gone)


def own_normals(mesh: TriangleMesh) -> Normals | None:
    """Normals of corners that the mesh has as an attribute, of length 1, shape (m, 9); None: it has none."""
    found = next(filter(shades, mesh.attributes), None)
    return None if found is None else of_length_1(at_corners(found, mesh.faces))


def shades(attribute: Attribute) -> bool:
    """Whether an attribute is normals of corners."""
    return (
        attribute.semantic == "normal" and attribute.components == 3 and attribute.domain != "face"
    )


def of_length_1(normals: npt.NDArray[Any]) -> Normals:
    """Normals of corners, shape (m, 3, 3), of length 1 or 0; shape (m, 9)."""
    corners = np.asarray(normals, np.float64)
    lengths = np.sqrt(np.square(corners).sum(axis=-1, keepdims=True))
    unit = np.divide(corners, lengths, out=np.zeros_like(corners), where=lengths > 0)
    return np.ascontiguousarray(unit.reshape(-1, 9), np.float32)


def look_values(mesh: TriangleMesh, semantic: Semantic) -> Matrix | None:
    """The arguments of `AttributeLook` for the first attribute that means colors, or texture coordinates, or None."""
    found = (
        attribute
        for attribute in mesh.attributes
        if attribute.semantic == semantic and has_look(attribute)
    )
    return next((painted(semantic, at_corners(attribute, mesh.faces)) for attribute in found), None)


def has_look(attribute: Attribute) -> bool:
    """Whether an attribute is seen in pictures: texture coordinates of a plane; and colors, if floats from 0 to 1."""
    kind = attribute.values.dtype.kind
    if attribute.semantic == "color":
        return kind == "u" or (
            kind == "f" and bool(np.abs(attribute.values - 0.5).max(initial=0.0) <= 0.5)
        )
    plane = (
        attribute.semantic == "texcoord"
        and attribute.components == 2
        and attribute.domain != "face"
    )
    return plane and kind == "f" and float(np.abs(attribute.values).max(initial=0.0)) <= MOST_TILES


def painted(semantic: Semantic, corners: npt.NDArray[Any]) -> Matrix:
    """Values of corners as `AttributeLook` takes them, shape (m, 3, c): of colors red, green, blue, from 0 to 1."""
    if semantic == "color":
        # Gray becomes three equal channels, and opacity is left out: what shows through is not known here.
        whole = 1.0 if corners.dtype.kind == "f" else float(np.iinfo(corners.dtype).max)
        corners = (corners[..., :3] if corners.shape[2] > 2 else corners[..., [0, 0, 0]]) / whole
    return corners.astype(np.float64).reshape(len(corners), -1)
