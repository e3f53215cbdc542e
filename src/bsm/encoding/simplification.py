"""Fewer triangles, and the smallest stream of them that keeps the promise to the original."""

import math
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
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
from bsm.codec.geometry.graph import edges_of, graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import distances_to_surface, surface_distance
from bsm.codec.geometry.welding import degenerate
from bsm.codec.look.measure import AttributeLook, Look, LookMetric, look_values
from bsm.codec.signal.smooth import smooth
from bsm.codec.static.choice.attributes import Sent
from bsm.codec.static.choice.bounds import gaps, reaches
from bsm.codec.static.encoder import Attempt, Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import ANY_ANGLE
from bsm.ground.console import Progress

# Ten numbers hold a symmetric quadric of four dimensions (Garland and Heckbert 1997). Costs are sorted into buckets
# instead of a heap: about the cheapest is good enough, and takes constant time.
_TERMS, _BUCKETS = 10, 1 << 15  # of the scratch memory of the kernel
_SEAM, _FIXED, _STEADY = 2, 4, 8  # states of vertices in the kernel
# Rungs and not any number: results are kept by rung, and the searches meet the same ones again and again.
# Triangles over those of the rung before; rungs, down to a sixteenth.
RUNG, RUNGS = 2.0 ** (-1 / 16), 64
NEAREST, CHEAPEST = (1e-4, 0.0), (3e-4, 0.2)
"""Costs of moving along the surface, over leaving it, and of vertices without six neighbors: for the nearest surface,
and for the fewest bytes."""
# What it costs to be rough over leaving the surface: most, each over the last.
LOOSEST, LOOSER, LADDER = 0.1, 0.4, 9
# Of vertices that slide: the filter, how often, and how much of the way.
SMOOTHING, SWEEPS, PACE = 0.5, 8, 0.7
SLID = 0.25  # of the promise, what sliding may take before any triangle is left out
# Simplifying and coding share one promise. How to divide it best depends on the mesh, so a few shares are tried, as
# long as the bytes fall.
SPENT = {False: (0.65, 0.8), True: (0.25, 0.4, 0.55, 0.7)}
"""Of the promise, what fewer triangles may take, and sliding if vertices slide: more as long as bytes get fewer."""
TRIES = 3  # streams of one simplified mesh, each under the promise that the one before calls for
AIM = 0.98  # the share of a bound that is aimed at
NEAR = 0.1  # the share of a bound on distances within which it does not matter how far
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


def encode_source(
    mesh: TriangleMesh, options: EncodeOptions, progress: Progress, *, simplify: bool
) -> Chosen:
    """Encode a mesh; to `simplify`, also with fewer and fewer triangles: the smallest stream that keeps the promise."""
    if not simplify:
        encoder = Encoder(mesh, options)
        return Chosen(encoder, encoder.result(progress), mesh)
    source = Source(mesh, options)
    with progress.part("encoding all triangles", 0.3):
        # All triangles come first: each later attempt must beat this stream, so no file is larger for having
        # asked.
        encoder = Encoder(mesh, options)
        best = Chosen(encoder, encoder.result(progress), source.full_mesh)
    if encoder.unseen or degenerate(source.full_mesh.faces).all():
        return best
    # Smooth positions save most where blocks are refined; on grids, those that were regular may take fewer bytes.
    # Where blocks win, smooth positions are what saves; on grids both ways must be tried.
    ways = tuple(SPENT)
    if best.attempt.header.refinement:
        ways = (True,)
    for slides in ways:
        for share in SPENT[slides]:
            with progress.part("encoding fewer triangles", 0.4):
                made = source.encoded(source.taking(share, slides), best.attempt.size, progress)
            # Less of the promise did not save bytes, so more of it will not either: the tries go from careful to bold.
            if made is None:
                break
            best = made
    if best.decoded is None:
        return best
    return replace(best, apart=source.distance(best.decoded))


@dataclass(frozen=True, eq=False)
class StandIn:
    """A mesh with fewer triangles than another one, whose vertices have slid along the surface."""

    mesh: TriangleMesh
    reach: Matrix  # how far each vertex may be off
    spent: float  # of the promise


# The encoder must compare with the original, whose pictures are made already, and not with its stand-in.
class _Encoder(Encoder):
    """Encodes a mesh that stands for another one, of which pictures are shown."""

    def __init__(
        self, mesh: TriangleMesh, options: EncodeOptions, shown: LookMetric | None
    ) -> None:
        super().__init__(mesh, options)
        self._input = self._input.but(drawn=shown)


class Source:
    """An original to simplify, and how its results are measured."""

    def __init__(self, mesh: TriangleMesh, options: EncodeOptions) -> None:
        # Without a promise there is no measure of how much may be left out.
        promise = options.promise
        if promise is None:
            raise OptionError(
                "simplify needs a promise to keep; it excludes grids, lossless, steps and preset none"
            )
        if options.keep_order:
            raise OptionError("simplify changes vertices and faces; it excludes keep_order")
        if options.target or promise.angle < ANY_ANGLE or promise.visual < math.inf:
            raise OptionError(
                "simplify keeps the look and the largest error; it excludes targets and other bounds"
            )
        self.promise, self._given = promise, mesh
        self._input = Sent(mesh, options)
        joined, prepared = self._input.joined, self._input.prepared
        sent = (attribute for attribute, _ in self._input.qualities)
        found = (
            _of_vertices(attribute, mesh, joined.mesh.faces, joined.coded_faces)
            for attribute in sent
        )
        attributes = tuple(replace(one, values=one.values[prepared.coding_order]) for one in found)
        # In the order of coding, in which neighbors are near each other.
        self.full_mesh = replace(prepared.mesh, attributes=attributes, metadata=mesh.metadata)
        kept = {"*", *(attribute.name for attribute in attributes)}
        asked = {
            name: quality for name, quality in dict(options.attributes).items() if name in kept
        }
        self.options = replace(options, attributes=asked)
        # Two searches over the same rungs. A stand-in takes long to make, and as much memory as the mesh, so a few are
        # kept.
        self.stand_in = lru_cache(16)(self._stand_in)

    @cached_property
    def _reach(self) -> Matrix:
        """How far each vertex may be from the decoded surface, in the unit of the mesh, shape (n,)."""
        prepared = self._input.prepared
        return (
            gaps(prepared, self.promise).kept(reaches(prepared, self.promise))
            * prepared.units.scale
        )

    @cached_property
    def _metric(self) -> LookMetric | None:
        if self.promise.look == math.inf:
            return None
        return LookMetric(self.full_mesh, threads=self.options.threads)

    @cached_property
    def _looks(self) -> list[Callable[[TriangleMesh], Look | float | None]]:
        if self._metric is None:
            return []
        colors, threads = look_values(self.full_mesh, "color"), self.options.threads
        if colors is None:
            return [self._metric.compare]
        painted = AttributeLook(self.full_mesh, "color", colors, threads=threads)
        return [self._metric.compare, painted.compare]

    def look(self, other: TriangleMesh) -> float:
        """The look distance of another mesh from the original, also in colors, as a share of the promise."""
        distances = []
        for compare in self._looks:
            look = compare(other)
            if look is None:
                look = math.inf
            elif isinstance(look, Look):
                look = look.distance
            distances.append(look)
        return max(distances, default=0.0) / self.promise.look

    def apart(self, other: TriangleMesh, reach: Matrix, enough: float = 1.0) -> float:
        """The largest distance of both surfaces as a share of the bound (others: `reach`); exact if above `enough`."""
        shares = []
        for one, two, bound in (
            (self.full_mesh, other, self._reach),
            (other, self.full_mesh, reach),
        ):
            # Vertices alone would miss a fold between them, so middles of sides and faces are measured, with the
            # stricter bound of their ends.
            allowed = np.concatenate([bound, *_of_sides(bound[one.faces], np.min)])
            places = np.concatenate([one.positions, *_of_sides(one.positions[one.faces], np.mean)])
            far = distances_to_surface(places, two.positions, two.faces, enough=enough * allowed)
            shares.append(float((far / allowed).max()))
        return max(shares)

    def distance(self, other: TriangleMesh) -> float:
        """The largest distance of both surfaces where `bsm compare` measures, in the unit of the mesh."""
        return surface_distance(
            self._given.positions, self._given.faces, other.positions, other.faces
        ).hausdorff

    def _stand_in(self, rung: int, loose: int | None) -> StandIn:
        """A mesh on a rung, of which vertices may be as loose as another one says, with attributes of nearest ones."""
        whole = self.full_mesh
        low, scale, target = (
            whole.positions.min(axis=0),
            whole.diagonal or 1.0,
            RUNG**rung * len(whole.faces),
        )
        placed = (whole.positions - low) / scale
        new, faces, owners, _, quadrics = collapsed(
            # In a unit cube, since costs are compared with numbers that do not know the size of the mesh.
            placed,
            whole.faces,
            np.zeros(len(placed), np.bool_),
            round(target),
            costs=CHEAPEST,
        )
        if loose is not None:
            new = slid(new, faces, quadrics, LOOSEST * LOOSER**loose)
        kept = np.flatnonzero(owners >= 0)
        # Of all vertices that became one, the nearest gives it its attributes. A mean of colors would be a color that
        # the mesh does not have.
        kept = kept[np.lexsort((np.square(new[owners] - placed).sum(axis=1)[kept], owners[kept]))]
        nearest = kept[np.unique(owners[kept], return_index=True)[1]]
        reach = np.full(len(new), np.inf)
        # A vertex that stands for several must keep the strictest of their bounds.
        np.minimum.at(reach, owners[kept], self._reach[kept])
        attributes = tuple(
            replace(attribute, values=attribute.values[nearest]) for attribute in whole.attributes
        )
        mesh = TriangleMesh(new * scale + low, faces, attributes, whole.metadata)
        spent = math.inf
        if len(faces) <= ENOUGH * target:
            spent = self.look(mesh)
        if not self._looks:
            spent = max(spent, self.apart(mesh, reach, NEAR))
        return StandIn(mesh, reach, spent)

    @cached_property
    def _loose(self) -> int:
        """The rung on which vertices are as loose as they may be."""
        return bisect_left(
            range(LADDER), True, key=lambda loose: self.stand_in(0, loose).spent <= SLID
        )

    def taking(self, share: float, slides: bool) -> StandIn:
        """The stand-in of fewest triangles that takes such a share of the promise at most."""
        loose = None
        if slides:
            loose = self._loose
        rung = bisect_left(
            range(RUNGS), True, key=lambda rung: self.stand_in(rung + 1, loose).spent > share
        )
        return self.stand_in(rung, loose)

    def encoded(self, one: StandIn, most: int, progress: Progress) -> Chosen | None:
        """Return a stream of a stand-in in fewer bytes than `most` that was found to keep the promise, if any."""
        promise, look, off = self.promise, self.promise.look, one.spent
        if self._looks:
            off = 0.0
        for _ in range(TRIES):
            # Nothing of the promise is left for the coder.
            if not off < AIM:
                break
            near = AIM - off
            # The second stream is asked for what the first one missed, in proportion. Three tries find it, or nothing
            # does.
            asked = replace(
                promise, look=look, farthest=near * promise.farthest, by_part=near * promise.by_part
            )
            encoder = _Encoder(one.mesh, replace(self.options, contract=asked), self._metric)
            try:
                with progress.part("", 0.5):
                    attempt = encoder.result(progress)
            except TargetError:
                break
            if attempt.size >= most:
                break
            # Measured on the decoded mesh, as always: the encoder's own promise is about the stand-in, not about the
            # original.
            decoded = decode(
                b"".join(attempt.frames), NAMED_LIMITS[self.options.limits](), self.options.threads
            )
            placed = np.full(len(decoded.positions), np.inf)
            np.minimum.at(placed, encoder.vertex_index, one.reach)
            share, seen = self.apart(decoded, placed), self.look(decoded)
            if max(share, seen) <= 1.0:
                encoder.look = None
                if self._metric:
                    encoder.look = seen * promise.look
                return Chosen(
                    encoder, attempt, self.full_mesh, None, decoded, self._input.joined.notes
                )
            off, look = max(off, share - near), look * min(AIM / seen, 1.0)
        return None


def _of_vertices(
    attribute: Attribute, mesh: TriangleMesh, faces: Faces, kept: npt.NDArray[Any]
) -> Attribute:
    """An attribute with one value for each vertex of joined faces, or an error that says why it has not."""
    name = attribute.name
    advice = f"leave it out (--attribute {name}=none), or encode without --simplify"
    if attribute.semantic not in ("normal", "color") or attribute.domain == "face":
        raise OptionError(
            f"simplify carries normals and colors of vertices, but not {name}: {advice}"
        )
    corners = at_corners(attribute, mesh.faces)[kept]
    values = np.zeros((int(faces.max(initial=-1)) + 1, attribute.components), corners.dtype)
    values[faces[::-1]] = corners[::-1]
    # Collapsing edges across a seam would have to choose one of two values. Refused, since either would be seen.
    if not np.array_equal(values[faces], corners):
        raise OptionError(
            f"{name} has seams, where a vertex has several values; simplify cannot keep them: {advice}"
        )
    return Attribute(name, values, "vertex", attribute.semantic)


def collapsed(
    positions: Positions,
    faces: Faces,
    locked: Mask,
    target: int,
    wedges: Faces | None = None,
    costs: tuple[float, float] = NEAREST,
) -> tuple[Positions, Faces, Indices, Faces, Matrix]:
    """Simplify to about `target` triangles; locked and border vertices stay. Also return new numbers, or -1, the
    `wedges` left: numbers of the values of corners, and quadrics of vertices that may move. With wedges, vertices stay
    or vanish, and seams stay seams."""
    count, sides = len(positions), 3 * len(faces)
    own, usual_state = faces, 0
    if wedges is not None:
        own, usual_state = wedges, _STEADY
    sides_of, _, uses = edges_of(faces)
    stay = np.where(locked, _FIXED, usual_state).astype(np.uint8)
    # At open borders, and where more than two triangles meet at an edge.
    # An open border that moves changes the outline, which eyes notice first.
    stay[sides_of[uses != 2]] = _FIXED
    if wedges is not None:
        vertices = faces.ravel()[np.unique(wedges, return_index=True)[1]]  # of the wedges
        # A vertex with several wedges is on a seam; it may only move along it.
        stay[np.bincount(vertices, minlength=count) > 1] |= _SEAM
    moved, left, own = (
        np.array(positions, np.float64),
        np.array(faces, np.int32),
        np.array(own, np.int32),
    )
    ends, marks, owners = np.empty((3, count), np.int32)
    joins, quadrics = np.empty(int(own.max(initial=-1)) + 1, np.int32), np.empty((count, _TERMS))
    around = np.empty(count + 1, np.int64), np.empty(sides, np.int32)
    edges = np.empty(sides // 2, np.float32), np.empty(_BUCKETS, np.int32)
    room = quadrics, *around, ends, marks, joins, owners, *edges
    size = _kernels.simplify(moved, left, own, stay, room, target, *costs)
    kept, corners, numbers = compact(moved, left[:size])
    quadrics[stay & _FIXED > 0] = 0.0
    return kept, corners, numbers[owners], own[:size], quadrics[numbers >= 0]


def compact(rows: npt.NDArray[Any], faces: Faces) -> tuple[npt.NDArray[Any], Faces, Indices]:
    """Vertices that faces have, those faces, and the new number of each vertex, or -1."""
    used = np.zeros(len(rows), bool)
    used[faces] = True
    numbers = np.where(used, np.cumsum(used, dtype=np.int32) - 1, -1).astype(np.int32)
    return rows[used], numbers[faces], numbers


def slid(positions: Positions, faces: Faces, quadrics: Matrix, worth: float) -> Positions:
    """Positions that have slid along the surface to where they are smooth on the graph, and take fewer bytes."""
    graph = graph_of_faces(faces, len(positions))
    # The kernel keeps the upper half of each symmetric matrix.
    squares, places = quadrics[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3), -quadrics[:, 6:9]
    areas = np.trace(squares, axis1=1, axis2=2)
    loose = worth * (areas[:, None, None] * np.eye(3) - squares)  # but across the surface
    solved = np.linalg.inv(np.where(areas[:, None, None] > 0.0, squares + loose, np.eye(3)))
    for _ in range(SWEEPS):
        wanted = places + np.einsum("nij,nj->ni", loose, smooth(graph, positions, SMOOTHING))
        moved = positions + PACE * (np.einsum("nij,nj->ni", solved, wanted) - positions)
        positions = np.where(areas[:, None] > 0.0, moved, positions)
    return positions


def _of_sides(corners: Matrix, each: Callable[..., Matrix]) -> list[Matrix]:
    """One value for each side of triangles, and one for each triangle."""
    return [each(corners[:, side], axis=1) for side in ([0, 1], [1, 2], [2, 0], [0, 1, 2])]
