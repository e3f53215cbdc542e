"""Where the coded values of an attribute are, and which of them the user of a mesh knows by which number."""

from dataclasses import dataclass

import numpy as np

from bsm.bitstream.attributes.seams import Joins
from bsm.bitstream.container.header import FACE
from bsm.codec.arrays import Faces, Indices, Levels, Matrix


@dataclass(frozen=True, eq=False)
class Surface:
    """The values of an attribute as vertices of a mesh of their own."""

    faces: Faces
    vertices: Indices

    @property
    def places(self) -> Indices:
        """Equal numbers for values at the same vertex, shape (k,)."""
        apart = np.iinfo(np.int32).max - np.arange(len(self.vertices), dtype=np.int32)
        return np.where(self.vertices < 0, apart, self.vertices).astype(np.int32)

    def geometry(self, places: Levels) -> Levels:
        """Where values are, given where vertices are, shape (n, 3); those of no vertex at the origin."""
        return np.where(self.vertices[:, None] < 0, 0, places[self.vertices]).astype(np.int32)


def surface_of(domain: int, faces: Faces, vertices: int, loose: int, joins: Joins | None) -> Surface:
    """The surface on which values of a domain lie."""
    if domain == FACE:
        return Surface(faces, np.zeros(0, np.int32))
    at = np.arange(vertices, dtype=np.int32) if joins is None else joins.vertices
    corners = faces if joins is None else joins.faces
    return Surface(corners, np.concatenate([at, np.full(loose, -1, np.int32)]).astype(np.int32))


def recomputed(surface: Surface, positions: Matrix) -> Matrix:
    """Normals of the values of a surface: those of the faces around, by area (A 7); shape (k, 3)."""
    places = positions[surface.vertices] if len(surface.vertices) else positions
    a, b, c = (places[surface.faces[:, corner]] for corner in range(3))
    across = np.cross(b - a, c - a)
    normals = np.zeros((len(surface.vertices), 3))
    for corner in range(3):
        for axis in range(3):
            normals[:, axis] += np.bincount(surface.faces[:, corner], weights=across[:, axis], minlength=len(normals))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > 0.0, normals / np.where(lengths > 0.0, lengths, 1.0), [0.0, 0.0, 1.0])
