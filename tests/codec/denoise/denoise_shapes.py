"""Small meshes with known normals, and noise for them."""

from collections.abc import Callable

import numpy as np

from bsm import TriangleMesh
from bsm.codec.denoise.noise.finding import Finding
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.noise.search import find_noise
from bsm.codec.denoise.surface import Topology
from bsm.codec.geometry.graph import Lists

Partners = Callable[[str, str], tuple[TriangleMesh, TriangleMesh]]


def probe_of(positions: np.ndarray, faces: np.ndarray) -> Probe:
    return Probe(Topology(faces, len(positions)))


def find(positions: np.ndarray, faces: np.ndarray) -> Finding:
    return find_noise(positions, probe_of(positions, faces))


def members(rows: Lists, i: int) -> list[int]:
    return rows.members[rows.starts[i] : rows.starts[i + 1]].tolist()


def grid(size: int) -> tuple[np.ndarray, np.ndarray]:
    """A flat square of size x size quads in the plane z = 0, with its boundary."""
    y, x = np.mgrid[: size + 1, : size + 1]
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1).astype(float)
    corner = (np.arange(size)[:, None] * (size + 1) + np.arange(size)).ravel()
    quads = np.stack([corner, corner + 1, corner + size + 2, corner + size + 1], axis=1)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)
    return positions, faces


def cube(size: int) -> tuple[np.ndarray, np.ndarray]:
    """A closed cube of edge `size`, its sides split into size x size quads; normals point outwards."""
    flat, faces = grid(size)
    x, y = flat[:, 0], flat[:, 1]
    low, high = np.zeros_like(x), np.full_like(x, size)
    sides = [(y, x, low), (x, y, high), (low, y, x), (high, x, y), (x, low, y), (y, high, x)]
    points = np.concatenate([np.stack(side, axis=1) for side in sides])
    joined = np.concatenate([faces + k * len(flat) for k in range(6)])
    positions, number = np.unique(points, axis=0, return_inverse=True)
    return positions, number.ravel()[joined].astype(np.int32)


def sphere(size: int) -> tuple[np.ndarray, np.ndarray]:
    """The cube blown up to a unit sphere."""
    positions, faces = cube(size)
    centerd = positions - size / 2
    return centerd / np.linalg.norm(centerd, axis=1, keepdims=True), faces
