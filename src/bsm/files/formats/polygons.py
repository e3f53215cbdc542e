"""What mesh files hold: polygons over points. What becomes of it: triangles."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.bitstream.limits import Limits
from bsm.bitstream.public import public
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.columns import Column, attributes_of
from bsm.files.formats.remarks import fitting
from bsm.files.rows import Doubles, Ints

_MOST_TURNS = 64


@public
@dataclass(frozen=True)
class MeshFile:
    """A mesh as its file has it, and what was changed on the way.

    Parameters
    ----------
    mesh : TriangleMesh
    notes : tuple of str
        One sentence for each thing the reader did to the file's content.
    dropped : tuple of str
        What else the file holds and `mesh` does not: "lines", "parameter space", "animations", ...

    Examples
    --------
    >>> import bsm
    >>> read = bsm.read_mesh("spot.obj")
    >>> mesh, notes = read.mesh, read.notes
    """

    mesh: TriangleMesh
    notes: tuple[str, ...] = ()
    dropped: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Polygons:
    """The points of a file in full precision, and its polygons over them."""

    positions: Doubles
    sizes: Ints
    corners: Ints
    notes: tuple[str, ...] = ()
    dropped: tuple[str, ...] = ()
    columns: tuple[Column, ...] = ()
    metadata: Metadata = field(default_factory=dict)

    def checked(self, limits: Limits) -> MeshFile:
        """The mesh of triangles."""
        positions, sizes, corners = self.positions, self.sizes, self.corners
        limits.check("vertices", len(positions))
        limits.check("faces", int(np.maximum(sizes - 2, 0).sum()))
        if not (sizes > 0).any():
            raise MeshError("the file has no faces; point clouds are not supported")
        outside = (corners < 0) | (corners >= len(positions))
        if outside.any():
            index = int(corners[np.argmax(outside)])
            raise MeshError(f"a face refers to vertex {index}, outside 0..{len(positions) - 1}")
        if not np.isfinite(positions).all():
            row = int(np.argmin(np.isfinite(positions).all(axis=1)))
            raise MeshError(f"vertex {row} has a coordinate that is not finite; remove or repair it")
        notes = list(self.notes)
        if (sizes < 3).any():
            notes.append(f"faces with fewer than three corners were left out: {int((sizes < 3).sum())}")
        if (sizes > 3).any():
            notes.append(f"polygons were cut into triangles: {int((sizes > 3).sum())}")
        places, owner, folded = triangulate(positions, sizes, corners)
        if folded:
            notes.append(f"polygons so far from convex that their triangles overlap: {folded}")
        attributes, refused = attributes_of(self.columns, len(positions), len(sizes), places, owner)
        metadata, too_large = fitting(self.metadata, limits.metadata_bytes)
        dropped = (*self.dropped, *refused, *too_large)
        if self.dropped:
            notes.append(f"left out: {', '.join(self.dropped)}")
        notes += [f"left out: {name}, because {why}" for name, why in (refused | too_large).items()]
        triangles = corners[places].astype(np.int32)
        return MeshFile(TriangleMesh(positions, triangles, attributes, metadata), tuple(notes), dropped)


def triangulate(positions: Doubles, sizes: Ints, corners: Ints) -> tuple[Ints, Ints, int]:
    """Cut polygons into triangles, in the order of the polygons."""
    if (sizes == 3).all():
        return np.arange(len(corners)).reshape(-1, 3), np.arange(len(sizes)), 0
    scaled = positions / max(float(np.abs(positions).max()), 1e-300)  # so that no product overflows
    pieces = np.maximum(sizes - 2, 0)
    first = np.cumsum(sizes) - sizes
    owner = np.repeat(np.arange(len(sizes)), pieces)
    step = np.arange(len(owner)) - np.repeat(np.cumsum(pieces) - pieces, pieces)

    def fans(rows: Ints, turn: int) -> Ints:
        polygon = owner[rows]
        steps: Ints = np.column_stack([np.zeros_like(rows), step[rows] + 1, step[rows] + 2]) + turn
        fan: Ints = first[polygon][:, None] + steps % sizes[polygon][:, None]
        return fan

    places: Ints = fans(np.arange(len(owner)), 0)
    vectors = _area_vectors(scaled, corners[places])
    normals = np.column_stack([np.bincount(owner, weights=axis, minlength=len(sizes)) for axis in vectors.T])

    def folded(rows: Ints, candidates: Ints) -> Ints:
        against = (_area_vectors(scaled, corners[candidates]) * normals[owner[rows]]).sum(axis=1) < 0
        return np.unique(owner[rows[against]])

    bad: Ints = folded(np.arange(len(owner)), places)
    for turn in range(1, min(int(sizes.max(initial=0)), _MOST_TURNS)):
        if len(bad) == 0:
            break
        rows = np.flatnonzero(np.isin(owner, bad[sizes[bad] > turn]))
        candidates = fans(rows, turn)
        good = ~np.isin(owner[rows], folded(rows, candidates))
        places[rows[good]] = candidates[good]
        bad = np.setdiff1d(bad, owner[rows[good]])
    return places, owner, len(bad)


def _area_vectors(positions: Doubles, triangles: Ints) -> Doubles:
    a, b, c = positions[triangles[:, 0]], positions[triangles[:, 1]], positions[triangles[:, 2]]
    return np.cross(b - a, c - a)
