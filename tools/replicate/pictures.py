"""Pictures of a mesh as others judge it: facets, in which more is seen, and smooth shades for FLIP."""

from __future__ import annotations

import numpy as np

from bsm.codec.arrays import Matrix
from bsm.codec.geometry.mesh import TriangleMesh, box_around
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.look.pictures import Canvas, Picture, Shape, averaged, cameras, difference

SIDES = (0, 2, 4, 5)
PIXELS = 256
LIGHT = (0.35, 0.5, 0.79)  # right, up, towards the camera


class Gallery:
    """Pictures of an original, and of what became of it."""

    def __init__(self, mesh: TriangleMesh) -> None:
        low, high = box_around(mesh.positions)
        self._middle, self._diagonal = (low + high) / 2, float(np.linalg.norm(high - low))
        self._cameras = cameras(self._placed(mesh), PIXELS)
        self._facets = [self.drawn(mesh, side, flat=True) for side in SIDES]
        self.smooth = self.drawn(mesh, SIDES[0], flat=False)

    def _placed(self, mesh: TriangleMesh) -> Matrix:
        return np.ascontiguousarray((mesh.positions - self._middle) / self._diagonal)

    def drawn(self, mesh: TriangleMesh, side: int, *, flat: bool) -> Picture:
        """From one side, lit on both sides of faces; each facet in one shade, or smooth."""
        placed, faces = self._placed(mesh), np.ascontiguousarray(mesh.faces, np.int32)
        smooth = Shape.of(placed, faces).normals(placed)
        normals = np.tile(face_normals(placed, faces), 3) if flat else smooth.astype(np.float64)
        camera = self._cameras[side]
        canvas = Canvas(PIXELS)
        canvas.draw(placed, faces, smooth, camera)
        rows, columns = np.nonzero(canvas.owner >= 0)
        face = canvas.owner[rows, columns]
        ends = placed @ camera[:12].reshape(3, 4)[:2, :3].T + camera[[3, 7]]
        a, b, c = (ends[faces[face, k]] for k in range(3))
        at = np.column_stack([columns, rows]) + 0.5
        area = _across(b - a, c - a)
        s, t = _across(at - a, c - a) / area, _across(b - a, at - a) / area
        n = np.einsum("pk,pkd->pd", np.column_stack([1 - s - t, s, t]), normals[face].reshape(-1, 3, 3))
        axes = camera[:12].reshape(3, 4)[:, :3] * ((1,), (-1,), (1,))
        n = n @ (axes / np.linalg.norm(axes, axis=1, keepdims=True)).T
        n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-12)
        picture = np.ones((PIXELS, PIXELS), np.float32)
        picture[rows, columns] = 0.12 + 0.78 * np.abs(n @ LIGHT)
        return picture

    def facets(self, mesh: TriangleMesh) -> float:
        """Mean difference of shades, in facets."""
        drawn = [averaged(self.drawn(mesh, side, flat=True)) for side in SIDES]
        pairs = zip(map(averaged, self._facets), drawn, strict=True)
        return float(np.mean([difference(first, second)[0] for first, second in pairs]))


def _across(first: Matrix, second: Matrix) -> Matrix:
    return np.asarray(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
