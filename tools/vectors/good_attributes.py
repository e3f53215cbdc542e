"""Streams with attributes: of vertices, corners and faces, with and without seams, of every kind and coding."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh


def charts(mesh: TriangleMesh, kind: str = "float32") -> Attribute:
    """Texture coordinates in two charts, and one corner for itself."""
    at = mesh.positions[mesh.faces]
    right = at.mean(axis=1)[:, 0] > mesh.positions[:, 0].mean()
    corners = np.where(right[:, None, None], at[:, :, :2], 2.0 - at[:, :, 1:])
    corners[0, 0] += 0.5
    return Attribute("uv", corners.reshape(-1, 2).astype(kind), "corner", "texcoord")


def creases(mesh: TriangleMesh) -> Attribute:
    """Normals: of faces on one side, of vertices on the other."""
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    flat = np.cross(b - a, c - a) + np.array([0.0, 0.0, 1e-9])
    smooth = np.zeros_like(mesh.positions)
    for k in range(3):
        np.add.at(smooth, mesh.faces[:, k], flat)
    sharp = (mesh.positions[mesh.faces].mean(axis=1)[:, 1] > mesh.positions[:, 1].mean())[
        :, None, None
    ]
    corners = np.where(sharp, flat[:, None], smooth[mesh.faces])
    return Attribute("normal", corners.reshape(-1, 3).astype(np.float32), "corner", "normal")


def colors(mesh: TriangleMesh, kind: str = "uint8") -> Attribute:
    """Smooth ones of vertices."""
    shades = 0.5 + 0.45 * np.sin(
        3 * mesh.positions @ np.array([[1, 2, 0, 1], [0, 1, 3, 1], [2, 0, 1, 1.0]])
    )
    shades *= {"uint8": 255, "uint16": 65535}.get(kind, 1)
    return Attribute("color", shades.astype(kind), "vertex", "color")


def groups(mesh: TriangleMesh) -> Attribute:
    """Numbers of faces."""
    return Attribute("group", (np.arange(len(mesh.faces)) // 9 * 7 % 5).astype(np.int32), "face")


def with_attributes(mesh: TriangleMesh, *make: Callable[[TriangleMesh], Attribute]) -> TriangleMesh:
    """A mesh with attributes."""
    return replace(mesh, attributes=tuple(maker(mesh) for maker in make))
