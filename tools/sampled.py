"""Surfaces as sampling leaves them, with the true normals: binary volumes.

A binary volume says of each cell whether its middle is inside, as segmentations of CT and MRI do. Its surface by
marching cubes lies halfway between cells, in stairs.
"""

from collections.abc import Callable

import numpy as np
from scipy import spatial

from bsm.codec.arrays import Faces, Floats, Mask, Positions
from bsm.codec.geometry.metrics import distances_to_surface, face_geometry
from tools.scans import SAMPLES, Scan, isosurface, turning

MARGIN = 3  # cells about a shape
THICK = 5.0  # slices, in cells across
Field = Callable[[Floats], Floats]
"""From places, shape (..., 3), to distances, negative inside."""


def ball(places: Floats) -> Floats:
    return np.asarray(np.linalg.norm(places, axis=-1) - 1.0)


def torus(places: Floats) -> Floats:
    across = np.linalg.norm(places[..., :2], axis=-1) - 0.7
    return np.asarray(np.hypot(across, places[..., 2]) - 0.3)


def box(*sides: float) -> Field:
    """A box about the origin with these half sides, turned so that no side lies along an axis."""
    turn = turning(5)

    def field(places: Floats) -> Floats:
        off = np.abs(places @ turn) - np.array(sides)
        return np.asarray(
            np.linalg.norm(np.maximum(off, 0.0), axis=-1) + np.minimum(off.max(axis=-1), 0.0)
        )

    return field


def voxelized(
    field: Field, cells: int, thick: float = 1.0, reach: float = 1.0, copies: float = 1.0
) -> Scan:
    """The surface of a binary volume of `cells` cells a side, the slices along z `thick` cells thick and stored as
    `copies` thinner ones, which are the nearest slice."""
    step = 2.0 * reach / (cells - 2 * MARGIN)
    steps = step * np.array([1.0, 1.0, thick])
    counts = np.array([cells, cells, round(cells / thick)])
    origin = -0.5 * steps * (counts - 1)
    ticks = [
        low + size * np.arange(count)
        for low, size, count in zip(origin, steps, counts, strict=True)
    ]
    nearest = (
        ((np.arange(round(counts[2] * copies)) + 0.5) / copies).astype(int).clip(max=counts[2] - 1)
    )
    inside = (field(np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1)) < 0.0)[:, :, nearest]
    steps[2] /= copies
    origin[2] -= 0.5 * (copies - 1) * steps[2]
    positions, faces = isosurface(np.where(inside, 0.5, -0.5), steps, origin)
    at, small = positions[faces].mean(axis=1), 1e-5 * reach
    slopes = [field(at + small * way) - field(at - small * way) for way in np.eye(3)]
    normals = np.stack(slopes, axis=1)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    return Scan(positions, faces, normals, field)


def voxelized_mesh(positions: Positions, faces: Faces, cells: int, thick: float = 1.0) -> Scan:
    """The surface of the binary volume of a closed mesh, `cells` cells along its longest side."""
    extent = np.ptp(positions, axis=0)
    steps = float(extent.max()) / cells * np.array([1.0, 1.0, thick])
    counts = np.ceil(extent / steps).astype(int) + 2 * MARGIN
    origin = positions.min(axis=0) - (MARGIN - 0.5) * steps + 0.013 * steps
    made, triangles = isosurface(
        np.where(filled((positions - origin) / steps, faces, counts), 0.5, -0.5), steps, origin
    )
    geometry, random = face_geometry(positions, faces), np.random.default_rng(0)
    chosen = random.choice(len(faces), SAMPLES, p=geometry.areas / geometry.areas.sum())
    points = np.einsum(
        "ij,ijk->ik", random.dirichlet(np.ones(3), SAMPLES), positions[faces[chosen]]
    )
    near = spatial.cKDTree(points).query(face_geometry(made, triangles).centroids)[1]
    return Scan(
        made,
        triangles,
        geometry.normals[chosen[near]],
        lambda moved: distances_to_surface(moved, positions, faces),
    )


def filled(positions: Positions, faces: Faces, counts: np.ndarray) -> Mask:
    """Which whole numbers, up to `counts`, lie inside a closed mesh: those below an odd number of its faces."""
    corners = positions[faces]
    low, high = corners[..., :2].min(axis=1), corners[..., :2].max(axis=1)
    first = np.maximum(np.ceil(low), 0).astype(int)
    sides = np.maximum(np.floor(high).astype(int) - first + 1, 0)
    sizes = sides.prod(axis=1)
    owner = np.repeat(np.arange(len(faces)), sizes)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    place = first[owner] + np.stack([number // sides[owner, 1], number % sides[owner, 1]], axis=1)
    a, b, c = (corners[owner, corner] for corner in range(3))

    def turn(one: Floats, other: Floats, at: Floats) -> Floats:
        return np.asarray(
            (other[:, 0] - one[:, 0]) * (at[:, 1] - one[:, 1])
            - (other[:, 1] - one[:, 1]) * (at[:, 0] - one[:, 0])
        )

    parts = np.stack([turn(b, c, place), turn(c, a, place), turn(a, b, place)], axis=1)
    whole = parts.sum(axis=1)
    crossed = ((parts > 0.0).all(axis=1) | (parts < 0.0).all(axis=1)) & (whole != 0.0)
    height = (parts * np.stack([a[:, 2], b[:, 2], c[:, 2]], axis=1))[crossed].sum(axis=1) / whole[
        crossed
    ]
    flips = np.zeros((*counts[:2], counts[2] + 1), dtype=np.int64)
    at = place[crossed]
    np.add.at(flips, (at[:, 0], at[:, 1], np.clip(np.ceil(height), 0, counts[2]).astype(int)), 1)
    return np.asarray(np.cumsum(flips, axis=2)[..., :-1] % 2 == 1)
