"""Fewer triangles, and the smallest stream of them that keeps the promise to the original."""

from __future__ import annotations

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
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import distances_to_surface
from bsm.codec.geometry.welding import degenerate
from bsm.codec.look.measure import AttributeLook, Look, LookMetric, look_values
from bsm.codec.static.choice.attributes import Input
from bsm.codec.static.choice.bounds import reaches
from bsm.codec.static.encoder import Attempt, Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import ANY_ANGLE
from bsm.console import Progress

_TERMS, _BUCKETS = 10, 1 << 15  # of the scratch memory of the kernel
TIMES = (2, 4, 8, 16)  # fewer triangles than in the original
TRIES = 3  # streams of one simplified mesh, each under the promise that the one before calls for
AIM, CLOSE = 0.98, 0.95  # shares of a bound that are aimed at, and that are near enough
ENOUGH = 1.2  # times the triangles that were asked for, above which simplifying has failed


@dataclass(frozen=True, eq=False)
class Encoded:
    """The chosen stream; the original, and how far the surfaces are apart, if it has fewer triangles."""

    encoder: Encoder
    attempt: Attempt
    original: TriangleMesh
    apart: float | None = None
    notes: tuple[str, ...] = ()  # about the original


def encode_source(mesh: TriangleMesh, options: EncodeOptions, progress: Progress, *, simplify: bool) -> Encoded:
    """Encode a mesh; to `simplify`, also with fewer and fewer triangles: the smallest stream that keeps the promise."""
    if not simplify:
        encoder = Encoder(mesh, options)
        return Encoded(encoder, encoder.result(progress), mesh)
    source = Source(mesh, options)
    with progress.part("encoding all triangles", 0.3):
        encoder = Encoder(mesh, options)
        best = Encoded(encoder, encoder.result(progress), source.whole)
    for times in TIMES if not degenerate(source.whole.faces).all() else ():
        with progress.part(f"encoding 1 of {times} triangles", 0.5):
            found = source.encoded(len(source.whole.faces) // times, progress)
        if found is None or found.attempt.size >= best.attempt.size:
            break
        best = found
    return best


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
        self.options, self.promise, self._input = options, promise, Input(mesh, options, options)
        joined = self._input.joined
        sent = (attribute for attribute, _ in self._input.wanted)
        attributes = tuple(_of_vertices(attribute, mesh, joined.mesh.faces, joined.kept) for attribute in sent)
        self.whole = replace(joined.mesh, attributes=attributes, metadata=mesh.metadata)

    @cached_property
    def _reach(self) -> Matrix:
        """How far each vertex may be from the decoded surface, in the unit of the mesh, shape (n,)."""
        prepared = self._input.prepared
        return (reaches(prepared, self.promise) * prepared.units.scale)[np.argsort(prepared.coding_order)]

    @cached_property
    def _looks(self) -> list[Callable[[TriangleMesh], Look | float | None]]:
        whole, threads = self.whole, self.options.threads
        if self.promise.look == math.inf:
            return []
        colors = look_values(whole, "color")
        painted = [] if colors is None else [AttributeLook(whole, "color", colors, threads=threads).compare]
        return [LookMetric(whole, threads=threads).compare, *painted]

    def look(self, other: TriangleMesh) -> float:
        """The look distance of another mesh from the original, also in colors, as a share of the promise."""
        looks = (look(other) for look in self._looks)
        found = (look.distance if isinstance(look, Look) else math.inf if look is None else look for look in looks)
        return max(found, default=0.0) / self.promise.look

    def apart(self, other: TriangleMesh, reach: Matrix) -> tuple[float, float]:
        """The largest distance of both surfaces as a share of the bound (others: `reach`), and in the mesh's unit."""
        whole = self.whole
        points, allowed = _samples(whole, self._reach)
        there = distances_to_surface(points, other.positions, other.faces)
        share = float((there / allowed).max())
        points, allowed = _samples(other, reach)
        back = distances_to_surface(points, whole.positions, whole.faces)
        share = max(share, float((back / allowed).max()))
        return share, max(float(there.max()), float(back.max()))

    def simplified(self, target: int) -> tuple[TriangleMesh, Matrix]:
        """The mesh with about `target` triangles and attributes of nearest vertices; and how far each may be off."""
        whole = self.whole
        low, scale = whole.positions.min(axis=0), whole.diagonal or 1.0
        placed = (whole.positions - low) / scale
        new, faces, owners = collapsed(placed, whole.faces, np.zeros(len(placed), np.bool_), target)
        kept = np.flatnonzero(owners >= 0)
        kept = kept[np.lexsort((np.square(new[owners] - placed).sum(axis=1)[kept], owners[kept]))]
        nearest = kept[np.unique(owners[kept], return_index=True)[1]]
        reach = np.full(len(new), np.inf)
        np.minimum.at(reach, owners[kept], self._reach[kept])
        attributes = tuple(replace(attribute, values=attribute.values[nearest]) for attribute in whole.attributes)
        return TriangleMesh(new * scale + low, faces, attributes, whole.metadata), reach

    def encoded(self, target: int, progress: Progress) -> Encoded | None:
        """Return the smallest stream of about `target` triangles that was found to keep the promise, if any."""
        mesh, reach = self.simplified(target)
        if len(mesh.faces) > ENOUGH * target:
            return None
        best: Encoded | None = None
        promise, lost, off = self.promise, self.look(mesh), self.apart(mesh, reach)[0]
        for _ in range(TRIES):
            if not (lost < AIM and off < AIM):
                break
            # Squared differences of shades add up, and look distances grow with the 4/3rd power of their roots.
            look, near = promise.look * (AIM**1.5 - lost**1.5) ** (2.0 / 3.0), AIM - off
            asked = replace(promise, look=look, farthest=near * promise.farthest, by_part=near * promise.by_part)
            encoder = Encoder(mesh, replace(self.options, contract=asked))
            try:
                with progress.part("", 0.5):
                    attempt = encoder.result(progress)
            except TargetError:
                break
            decoded = decode(b"".join(attempt.frames), NAMED_LIMITS[self.options.limits](), self.options.threads)
            placed = np.full(len(decoded.positions), np.inf)
            np.minimum.at(placed, encoder.vertex_index, reach)
            (share, apart), seen = self.apart(decoded, placed), self.look(decoded)
            lost = max(seen**1.5 - ((encoder.look or 0.0) / promise.look) ** 1.5, 0.0) ** (2.0 / 3.0)
            off = max(off, share - near)
            if max(share, seen) > 1.0:
                continue
            if best is None or attempt.size < best.attempt.size:
                encoder.look = seen * promise.look if self._looks else None
                best = Encoded(encoder, attempt, self.whole, apart, self._input.joined.notes)
            if seen >= CLOSE or not self._looks:
                break
        return best


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


def collapsed(positions: Positions, faces: Faces, locked: Mask, target: int) -> tuple[Positions, Faces, Indices]:
    """Simplify to about `target` triangles; locked and border vertices stay. Also return new numbers, or -1."""
    count, sides = len(positions), 3 * len(faces)
    ends_of = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, uses = np.unique(ends_of @ np.array([count, 1]), return_counts=True)
    stay = locked.astype(np.uint8)
    # At open borders, and where more than two triangles meet at an edge.
    stay[np.stack(np.divmod(edges[uses != 2], count))] = 1
    moved, left = np.array(positions, np.float64), np.array(faces, np.int32)
    starts, ends, marks, owners = (np.empty(count + more, np.int32) for more in (1, 0, 0, 0))
    scratch = np.empty((count, _TERMS)), starts, np.empty(sides, np.int32), ends, marks
    buckets = np.empty(sides // 2, np.float32), np.empty(_BUCKETS, np.int32)
    size = _kernels.simplify(moved, left, stay, *scratch, owners, *buckets, target)
    kept, corners, numbers = compact(moved, left[:size])
    return kept, corners, numbers[owners]


def compact(rows: npt.NDArray[Any], faces: Faces) -> tuple[npt.NDArray[Any], Faces, Indices]:
    """Vertices that faces have, those faces, and the new number of each vertex, or -1."""
    used = np.zeros(len(rows), bool)
    used[faces] = True
    numbers = np.where(used, np.cumsum(used, dtype=np.int32) - 1, -1).astype(np.int32)
    return rows[used], numbers[faces], numbers


def _samples(mesh: TriangleMesh, reach: Matrix) -> tuple[Matrix, Matrix]:
    """The vertices and the middles of edges and faces, and the bound of each."""
    corners, of_corners = mesh.positions[mesh.faces], reach[mesh.faces]
    sides = [(0, 1), (1, 2), (2, 0), (0, 1, 2)]
    points = np.concatenate([mesh.positions, *(corners[:, side].mean(axis=1) for side in sides)])
    return points, np.concatenate([reach, *(of_corners[:, side].min(axis=1) for side in sides)])
