"""Fewer triangles, and the smallest stream of them that keeps the promise to the original."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm import _core as _kernels
from bsm.bitstream.errors import OptionError, TargetError
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Indices, Mask, Matrix, Positions
from bsm.codec.decoding import decode
from bsm.codec.geometry.attributes import Attribute, at_corners
from bsm.codec.geometry.graph import edges_of
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import distances_to_surface, surface_distance
from bsm.codec.geometry.welding import degenerate
from bsm.codec.look.measure import AttributeLook, Look, LookMetric, look_values
from bsm.codec.static.choice.attributes import Sent
from bsm.codec.static.choice.bounds import gaps, reaches
from bsm.codec.static.encoder import Attempt, Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import ANY_ANGLE
from bsm.console import Progress

_TERMS, _BUCKETS = 10, 1 << 15  # of the scratch memory of the kernel
_SEAM, _FIXED, _STEADY = 2, 4, 8  # states of vertices in the kernel
SHARES = tuple(2.0 ** (-k / 4) for k in range(1, 17))  # of the triangles of the original
TRIES = 3  # streams of one simplified mesh, each under the promise that the one before calls for
MOST, NEAR = 1.5, 1.03
"""Triangles to encode, over the original's; and guessed bytes over the least so far, up to which a mesh is encoded."""
POWER = 0.6  # of the share of the look that is left: about the median of seven scans
AIM = 0.98  # the share of a bound that is aimed at
ENOUGH = 1.2  # times the triangles that were asked for, above which simplifying has failed


@dataclass(frozen=True, eq=False)
class Chosen:
    """The chosen stream; the original, and how far the surfaces are apart, if it has fewer triangles."""

    encoder: Encoder
    attempt: Attempt
    original: TriangleMesh
    apart: float | None = None
    decoded: TriangleMesh | None = None
    notes: tuple[str, ...] = ()  # about the original


def encode_source(mesh: TriangleMesh, options: EncodeOptions, progress: Progress, *, simplify: bool) -> Chosen:
    """Encode a mesh; to `simplify`, also with fewer and fewer triangles: the smallest stream that keeps the promise."""
    if not simplify:
        encoder = Encoder(mesh, options)
        return Chosen(encoder, encoder.result(progress), mesh)
    source = Source(mesh, options)
    with progress.part("encoding all triangles", 0.3):
        encoder = Encoder(mesh, options)
        best = Chosen(encoder, encoder.result(progress), source.whole)
    found = source.stand_ins(progress)
    whole = Sent(source.whole, options).prepared.connectivity.data
    shape, power, work = best.attempt.size - len(whole), POWER, 0.0
    while found:
        # As many bytes for the faces as there are, for the places a share of all; more of them where less look is left.
        plain = {one: one.of_faces + one.share * shape for one in found}
        guessed = {size * one.left**-power: one for one, size in plain.items()}
        one = guessed[min(guessed)]
        work += one.share
        if min(guessed) > NEAR * best.attempt.size or work > MOST:
            break
        found.remove(one)
        with progress.part(f"encoding {one.share:.0%} of the triangles", 0.5):
            made = source.encoded(one, progress)
        if made is None:
            continue
        power = math.log(max(made.attempt.size / plain[one], 1.0)) / -math.log(one.left)
        best = min(best, made, key=lambda made: made.attempt.size)
    return best if best.decoded is None else replace(best, apart=source.distance(best.decoded))


@dataclass(frozen=True, eq=False)
class StandIn:
    """A mesh with a share of the triangles of another one."""

    mesh: TriangleMesh
    reach: Matrix  # how far each vertex may be off
    share: float
    of_faces: int  # bytes
    left: float  # of the bound that must be kept


class _Encoder(Encoder):
    """Encodes a mesh that stands for another one, of which pictures are shown."""

    def __init__(self, mesh: TriangleMesh, options: EncodeOptions, shown: LookMetric | None) -> None:
        super().__init__(mesh, options)
        self._input = self._input.but(shown=shown)


class Source:
    """An original to simplify, and how its results are measured."""

    def __init__(self, mesh: TriangleMesh, options: EncodeOptions) -> None:
        promise = options.promise
        if promise is None:
            raise OptionError("simplify needs a promise to keep; it excludes grids, lossless, steps and preset none")
        if options.keep_order:
            raise OptionError("simplify changes vertices and faces; it excludes keep_order")
        if options.target or promise.angle < ANY_ANGLE or promise.visual < math.inf:
            raise OptionError("simplify keeps the look and the largest error; it excludes targets and other bounds")
        self.options, self.promise, self._given = options, promise, mesh
        self._input = Sent(mesh, options)
        joined, prepared = self._input.joined, self._input.prepared
        sent = (attribute for attribute, _ in self._input.wanted)
        found = (_of_vertices(attribute, mesh, joined.mesh.faces, joined.kept) for attribute in sent)
        attributes = tuple(replace(one, values=one.values[prepared.coding_order]) for one in found)
        # In the order of coding, in which neighbors are near each other.
        self.whole = replace(prepared.mesh, attributes=attributes, metadata=mesh.metadata)

    @cached_property
    def _reach(self) -> Matrix:
        """How far each vertex may be from the decoded surface, in the unit of the mesh, shape (n,)."""
        prepared = self._input.prepared
        return gaps(prepared, self.promise).kept(reaches(prepared, self.promise)) * prepared.units.scale

    @cached_property
    def _metric(self) -> LookMetric | None:
        return None if self.promise.look == math.inf else LookMetric(self.whole, threads=self.options.threads)

    @cached_property
    def _looks(self) -> list[Callable[[TriangleMesh], Look | float | None]]:
        if self._metric is None:
            return []
        colors, threads = look_values(self.whole, "color"), self.options.threads
        painted = [] if colors is None else [AttributeLook(self.whole, "color", colors, threads=threads).compare]
        return [self._metric.compare, *painted]

    def look(self, other: TriangleMesh) -> float:
        """The look distance of another mesh from the original, also in colors, as a share of the promise."""
        looks = (look(other) for look in self._looks)
        found = (look.distance if isinstance(look, Look) else math.inf if look is None else look for look in looks)
        return max(found, default=0.0) / self.promise.look

    def apart(self, other: TriangleMesh, reach: Matrix) -> float:
        """The largest distance of both surfaces as a share of the bound (others: `reach`); exact if above 1."""
        shares = []
        for one, two, bound in ((self.whole, other, self._reach), (other, self.whole, reach)):
            allowed = np.concatenate([bound, *_of_sides(bound[one.faces], np.min)])
            places = np.concatenate([one.positions, *_of_sides(one.positions[one.faces], np.mean)])
            far = distances_to_surface(places, two.positions, two.faces, enough=allowed)
            shares.append(float((far / allowed).max()))
        return max(shares)

    def distance(self, other: TriangleMesh) -> float:
        """The largest distance of both surfaces where `bsm compare` measures, in the unit of the mesh."""
        return surface_distance(self._given.positions, self._given.faces, other.positions, other.faces).hausdorff

    def _moved(self, other: TriangleMesh, reach: Matrix) -> float:
        """About the same as `apart`: of the vertices only."""
        whole = self.whole
        there = distances_to_surface(whole.positions, other.positions, other.faces)
        back = distances_to_surface(other.positions, whole.positions, whole.faces)
        return max(float((there / self._reach).max()), float((back / reach).max()))

    def simplified(self, target: int) -> tuple[TriangleMesh, Matrix]:
        """The mesh with about `target` triangles and attributes of nearest vertices; and how far each may be off."""
        whole = self.whole
        low, scale = whole.positions.min(axis=0), whole.diagonal or 1.0
        placed = (whole.positions - low) / scale
        new, faces, owners, _ = collapsed(placed, whole.faces, np.zeros(len(placed), np.bool_), target)
        kept = np.flatnonzero(owners >= 0)
        kept = kept[np.lexsort((np.square(new[owners] - placed).sum(axis=1)[kept], owners[kept]))]
        nearest = kept[np.unique(owners[kept], return_index=True)[1]]
        reach = np.full(len(new), np.inf)
        np.minimum.at(reach, owners[kept], self._reach[kept])
        attributes = tuple(replace(attribute, values=attribute.values[nearest]) for attribute in whole.attributes)
        return TriangleMesh(new * scale + low, faces, attributes, whole.metadata), reach

    def stand_ins(self, progress: Progress) -> list[StandIn]:
        """Meshes of fewer and fewer triangles that could keep the promise."""
        found = list[StandIn]()
        for share in SHARES if not degenerate(self.whole.faces).all() else ():
            with progress.part("simplifying", 0.1):
                mesh, reach = self.simplified(round(share * len(self.whole.faces)))
                left = 1.0 - (self.look(mesh) if self._looks else self._moved(mesh, reach))
            if left <= 1.0 - AIM or len(mesh.faces) > ENOUGH * share * len(self.whole.faces):
                break
            faces = Sent(mesh, self.options).prepared.connectivity.data
            found.append(StandIn(mesh, reach, len(mesh.faces) / len(self.whole.faces), len(faces), min(left, AIM)))
        return found

    def encoded(self, one: StandIn, progress: Progress) -> Chosen | None:
        """Return the smallest stream of a stand-in that was found to keep the promise, if any."""
        promise, look, off, reach = self.promise, self.promise.look, self._moved(one.mesh, one.reach), one.reach
        for _ in range(TRIES):
            if not off < AIM:
                break
            near = AIM - off
            asked = replace(promise, look=look, farthest=near * promise.farthest, by_part=near * promise.by_part)
            encoder = _Encoder(one.mesh, replace(self.options, contract=asked), self._metric)
            try:
                with progress.part("", 0.5):
                    attempt = encoder.result(progress)
            except TargetError:
                break
            decoded = decode(b"".join(attempt.frames), NAMED_LIMITS[self.options.limits](), self.options.threads)
            placed = np.full(len(decoded.positions), np.inf)
            np.minimum.at(placed, encoder.vertex_index, reach)
            share, seen = self.apart(decoded, placed), self.look(decoded)
            if max(share, seen) <= 1.0:
                encoder.look = seen * promise.look if self._metric else None
                return Chosen(encoder, attempt, self.whole, None, decoded, self._input.joined.notes)
            off, look = max(off, share - near), look * min(AIM / seen, 1.0)
        return None


def _of_vertices(attribute: Attribute, mesh: TriangleMesh, faces: Faces, kept: npt.NDArray[Any]) -> Attribute:
    """An attribute with one value for each vertex of joined faces, or an error that says why it has not."""
    name = attribute.name
    advice = f"leave it out (--attribute {name}=none), or encode without --simplify"
    if attribute.semantic not in ("normal", "color") or attribute.domain == "face":
        raise OptionError(f"simplify carries normals and colors of vertices, but not {name}: {advice}")
    corners = at_corners(attribute, mesh.faces)[kept]
    values = np.zeros((int(faces.max(initial=-1)) + 1, attribute.components), corners.dtype)
    values[faces[::-1]] = corners[::-1]
    if not np.array_equal(values[faces], corners):
        raise OptionError(f"{name} has seams, where a vertex has several values; simplify cannot keep them: {advice}")
    return Attribute(name, values, "vertex", attribute.semantic)


def collapsed(
    positions: Positions, faces: Faces, locked: Mask, target: int, wedges: Faces | None = None
) -> tuple[Positions, Faces, Indices, Faces]:
    """Simplify to about `target` triangles; locked and border vertices stay. Also return new numbers, or -1, and the
    `wedges` left: numbers of the values of corners. With these, vertices stay or vanish, and seams stay seams."""
    count, sides, own = len(positions), 3 * len(faces), faces if wedges is None else wedges
    sides_of, _, uses = edges_of(faces)
    stay = np.where(locked, _FIXED, 0 if wedges is None else _STEADY).astype(np.uint8)
    # At open borders, and where more than two triangles meet at an edge.
    stay[sides_of[uses != 2]] = _FIXED
    if wedges is not None:
        vertices = faces.ravel()[np.unique(wedges, return_index=True)[1]]  # of the wedges
        stay[np.bincount(vertices, minlength=count) > 1] |= _SEAM
    moved, left, own = np.array(positions, np.float64), np.array(faces, np.int32), np.array(own, np.int32)
    ends, marks, owners = np.empty((3, count), np.int32)
    scratch = np.empty((count, _TERMS)), np.empty(count + 1, np.int64), np.empty(sides, np.int32), ends, marks
    joins = np.empty(int(own.max(initial=-1)) + 1, np.int32)
    buckets = np.empty(sides // 2, np.float32), np.empty(_BUCKETS, np.int32)
    size = _kernels.simplify(moved, left, own, stay, *scratch, joins, owners, *buckets, target)
    kept, corners, numbers = compact(moved, left[:size])
    return kept, corners, numbers[owners], own[:size]


def compact(rows: npt.NDArray[Any], faces: Faces) -> tuple[npt.NDArray[Any], Faces, Indices]:
    """Vertices that faces have, those faces, and the new number of each vertex, or -1."""
    used = np.zeros(len(rows), bool)
    used[faces] = True
    numbers = np.where(used, np.cumsum(used, dtype=np.int32) - 1, -1).astype(np.int32)
    return rows[used], numbers[faces], numbers


def _of_sides(corners: Matrix, each: Callable[..., Matrix]) -> list[Matrix]:
    """One value for each side of triangles, and one for each triangle."""
    return [each(corners[:, side], axis=1) for side in ([0, 1], [1, 2], [2, 0], [0, 1, 2])]
