"""Pictures of a mesh as others judge it: facets, in which more is seen, and gloss, from sides of their own."""

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh, box_around
from bsm.codec.geometry.metrics import face_geometry, face_normals
from bsm.codec.look.pictures import Canvas, Picture, averaged, cameras, difference

SIDES = (0, 2, 4, 5)
PIXELS = 256
LIGHT = (0.35, 0.5, 0.79)  # right, up, towards the camera
VIEWS = ((4, -10, 3), (-8, 6, 2), (14, 10, -9))
"""Directions of the camera for photographs, from the middle of the mesh."""
PHOTOGRAPH, SAMPLES = 1080, 2  # pixels along a side, and samples along a side of a pixel
SHARP = 30.0  # degrees between faces, above which no normal is shared
LAMPS = ((-0.45, 0.62, 0.64, 0.95), (0.8, -0.1, 0.59, 0.22), (0.1, 0.9, -0.42, 0.25))
"""Right, up, towards the camera, and how bright: key, fill and rim."""
ALBEDO, AMBIENT, GLOSS, SHARPNESS, WALL = (0.62, 0.53, 0.45), 0.06, 0.28, 32, 0.86
Photograph = npt.NDArray[np.uint8]  # shape (PHOTOGRAPH, PHOTOGRAPH, 3), sRGB


def smoothed(mesh: TriangleMesh) -> npt.NDArray[np.int32]:
    """The number of each corner's normal, shape (m, 3): corners share one up to edges that are sharp."""
    unit, corner = face_normals(mesh.positions, mesh.faces), np.arange(mesh.faces.size)
    ends = np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2).reshape(-1, 2)
    after = corner // 3 * 3 + (corner + 1) % 3
    flipped, edges = ends[:, 0] > ends[:, 1], np.sort(ends, axis=1)
    low, high = np.where(flipped, after, corner), np.where(flipped, corner, after)
    order = np.lexsort(edges.T)
    same = (edges[order][1:] == edges[order][:-1]).all(axis=1)
    first, second = order[:-1][same], order[1:][same]
    smooth = (unit[first // 3] * unit[second // 3]).sum(axis=1) > np.cos(np.radians(SHARP))
    first, second = first[smooth], second[smooth]
    pairs = np.concatenate([low[first], high[first]]), np.concatenate([low[second], high[second]])
    joined = coo_array((np.ones(len(pairs[0])), pairs), (len(corner), len(corner)))
    groups: npt.NDArray[np.int32] = connected_components(joined, directed=False)[1]
    return groups.reshape(-1, 3)


class Gallery:
    """Pictures of an original, and of what became of it."""

    def __init__(self, mesh: TriangleMesh) -> None:
        low, high = box_around(mesh.positions)
        self._middle, self._diagonal = (low + high) / 2, float(np.linalg.norm(high - low))
        self._faces = np.ascontiguousarray(mesh.faces, np.int32)
        self._positions = self._placed(mesh.positions)
        self._smooth = smoothed(mesh)

    def _placed(self, positions: Positions) -> Matrix:
        return np.ascontiguousarray((positions - self._middle) / self._diagonal)

    def _facets(self, placed: Matrix) -> list[Picture]:
        """Each facet in one shade, lit on both sides."""
        normals = np.tile(face_normals(placed, self._faces), 3).astype(np.float32)
        every, found, canvas = cameras(self._positions, PIXELS), [], Canvas(PIXELS)
        for camera in (every[side] for side in SIDES):
            rows, columns, n = seen(canvas, placed, self._faces, normals, camera)
            picture = np.ones((PIXELS, PIXELS), np.float32)
            picture[rows, columns] = 0.12 + 0.78 * np.abs(n @ LIGHT)
            found.append(averaged(picture))
        return found

    def facets(self, positions: Positions) -> float:
        """Mean difference of shades, in facets."""
        pairs = zip(
            self._facets(self._positions), self._facets(self._placed(positions)), strict=True
        )
        return float(np.mean([difference(first, second)[0] for first, second in pairs]))

    def photographs(self, positions: Positions) -> list[Photograph]:
        """Glossy in three lights; normals are sums of faces by area, up to edges that are sharp in the original."""
        placed, canvas = self._placed(positions), Canvas(SAMPLES * PHOTOGRAPH)
        _, areas, normals = face_geometry(placed, self._faces)
        weighed = np.repeat(areas[:, None] * normals, 3, axis=0)
        sums = [np.bincount(self._smooth.ravel(), values) for values in weighed.T]
        corners = unit(np.column_stack(sums))[self._smooth].reshape(-1, 9).astype(np.float32)
        views = cameras(self._positions, SAMPLES * PHOTOGRAPH, VIEWS)
        return [photograph(*seen(canvas, placed, self._faces, corners, view)) for view in views]


def seen(
    canvas: Canvas, placed: Matrix, faces: Faces, normals: Picture, camera: Matrix
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], Picture]:
    """Rows and columns of the samples that show a mesh, and their unit normals: right, up, towards the camera."""
    canvas.draw(placed, faces, normals, camera)
    rows, columns = np.nonzero(canvas.owner >= 0)
    face = canvas.owner[rows, columns]
    ends = placed @ camera[:12].reshape(3, 4)[:2, :3].T + camera[[3, 7]]
    a, b, c = (ends[corner] for corner in faces.T)
    first, second = b - a, c - a
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    area[area == 0.0] = 1.0  # seen from their edge, where they show no sample
    # Weights of the second and third corner are linear in the place of a sample.
    slopes = (
        np.column_stack([second[:, 1], -second[:, 0], -first[:, 1], first[:, 0]]) / area[:, None]
    )
    x, y = columns + 0.5 - a[face, 0], rows + 0.5 - a[face, 1]
    s, t = (x * slopes[face, k] + y * slopes[face, k + 1] for k in (0, 2))
    axes = camera[:12].reshape(3, 4)[:, :3] * ((1,), (-1,), (1,))
    turned = normals.reshape(-1, 3) @ unit(axes).T
    p, q, r = (turned[3 * face + k] for k in range(3))
    return rows, columns, unit(p + (q - p) * s[:, None] + (r - p) * t[:, None]).astype(np.float32)


def photograph(
    rows: npt.NDArray[np.intp], columns: npt.NDArray[np.intp], normals: Picture
) -> Photograph:
    """Shade samples by Blinn and Phong in linear light, lit alike on both sides, and average them into pixels."""
    normals = np.where(normals[:, 2:] < 0.0, -normals, normals)
    diffuse, glossy = np.full(len(normals), AMBIENT, np.float32), np.zeros(len(normals), np.float32)
    for *direction, bright in LAMPS:
        lamp = unit(np.array([direction]))
        towards = np.maximum(normals @ lamp[0].astype(np.float32), 0.0)
        between = np.maximum(normals @ unit(lamp + np.eye(3)[2:])[0].astype(np.float32), 0.0)
        diffuse += bright * towards
        glossy += bright * GLOSS * between**SHARPNESS * (towards > 0.0)
    linear = np.full((PHOTOGRAPH * SAMPLES, PHOTOGRAPH * SAMPLES, 3), WALL, np.float32)
    linear[rows, columns] = np.minimum(
        diffuse[:, None] * np.array(ALBEDO, np.float32) + glossy[:, None], 1.0
    )
    pixels = linear.reshape(PHOTOGRAPH, SAMPLES, PHOTOGRAPH, SAMPLES, 3).mean(axis=(1, 3))
    shades = np.where(pixels <= 0.0031308, 12.92 * pixels, 1.055 * pixels ** (1 / 2.4) - 0.055)
    return np.asarray(np.rint(255.0 * shades), np.uint8)


def unit(vectors: Matrix) -> Matrix:
    """Rows over their lengths."""
    lengths: Matrix = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))[:, None]
    return np.asarray(vectors / np.maximum(lengths, 1e-20))
