"""Stand-ins for the paper's models where there are no real meshes: closed surfaces made by formula."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import ConvexHull

from bsm.codec.geometry.mesh import TriangleMesh

Doubles = npt.NDArray[np.float64]


def box(vertices: int, sides: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> TriangleMesh:
    """A box, for CAD models: six grids of triangles, joined along the edges."""
    size = max(2, round((vertices / 6) ** 0.5))
    v, u = np.mgrid[: size + 1, : size + 1].reshape(2, -1)
    corner = (np.arange(size)[:, None] * (size + 1) + np.arange(size)).ravel()
    flat = np.concatenate(
        [
            np.stack([corner, corner + 1, corner + size + 2], axis=1),
            np.stack([corner, corner + size + 2, corner + size + 1], axis=1),
        ]
    )
    low, high = np.zeros_like(u), np.full_like(u, size)
    grids = [(v, u, low), (u, v, high), (low, v, u), (high, u, v), (u, low, v), (v, high, u)]
    points = np.concatenate([np.stack(grid, axis=1) for grid in grids])
    faces = np.concatenate([flat + index * len(u) for index in range(6)])
    positions, number = np.unique(points, axis=0, return_inverse=True)
    return TriangleMesh(positions * np.array(sides) / size, number.ravel()[faces])


def ball(vertices: int, spikes: float = 0.0) -> TriangleMesh:
    """A sphere of Fibonacci's points; `spikes` above 0 makes it a star of as much depth."""
    index = np.arange(vertices) + 0.5
    height, angle = 1 - 2 * index / vertices, np.pi * (1 + 5**0.5) * index
    ring = np.sqrt(1 - height**2)
    points = np.stack([ring * np.cos(angle), ring * np.sin(angle), height], axis=1)
    faces = ConvexHull(points).simplices
    corners = points[faces]
    inwards = np.einsum(
        "ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]
    )
    faces[inwards < 0] = faces[inwards < 0][:, ::-1]
    radius = 1 + spikes * np.cos(5 * np.arctan2(points[:, 1], points[:, 0])) * ring**2
    return TriangleMesh(points * radius[:, None], faces)


def swaying(mesh: TriangleMesh, frames: int) -> Doubles:
    """Frames, shape (T, n, 3), in which a mesh twists to and fro about its z axis."""
    turns = 0.6 * np.sin(np.linspace(0, 2 * np.pi, frames, endpoint=False))
    height = mesh.positions[:, 2] / (np.ptp(mesh.positions[:, 2]) or 1.0)
    angle = turns[:, None] * height
    x, y, z = mesh.positions.T
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([cos * x - sin * y, sin * x + cos * y, np.broadcast_to(z, angle.shape)], axis=-1)
