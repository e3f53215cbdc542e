"""Small meshes with known properties."""

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bsm import Attribute, TriangleMesh, save
from bsm.codec.geometry.metrics import Reference
from bsm.evaluation.sample import knot
from tools.vectors.meshes import grid_faces, patch, tetrahedron, together, torus

# Names of other modules, for tests.
__all__ = ["grid_faces", "knot", "patch", "tetrahedron", "together", "torus"]
Faces = NDArray[np.int32]


def curved(mesh: TriangleMesh) -> TriangleMesh:
    """With every line of vertices drawn out of line, so that no grid suits it."""
    p = mesh.positions
    return TriangleMesh(
        p + 0.05 * np.sin(3.0 * p[:, [1, 2, 0]] + 1.0) + 0.03 * np.sin(5.0 * p), mesh.faces
    )


def ply_head(
    vertices: int = 3,
    faces: int = 1,
    order: str = "ascii",
    more: str = "",
    corners: str = "uchar int",
    last: str = "",
    kind: str = "float",
) -> str:
    """The header of a PLY with x, y and z, more lines for vertices, and last ones for faces."""
    axes = "".join(f"property {kind} {axis}\n" for axis in "xyz")
    rows = f"element face {faces}\nproperty list {corners} vertex_indices\n{last}end_header\n"
    return f"ply\nformat {order} 1.0\nelement vertex {vertices}\n{axes}{more}{rows}"


def at_corners(mesh: TriangleMesh, attribute: Attribute) -> NDArray[Any]:
    """The value that an attribute has at each corner of each face, shape (m, 3, c)."""
    if attribute.domain == "face":
        return np.repeat(attribute.values[:, None], 3, axis=1)
    return attribute.values[mesh.faces if attribute.indices is None else attribute.indices]


def soup(mesh: TriangleMesh) -> TriangleMesh:
    """Every face with vertices of its own."""
    return TriangleMesh(
        mesh.positions[mesh.faces].reshape(-1, 3), np.arange(mesh.faces.size).reshape(-1, 3)
    )


def boxes(*places: tuple[int, int, int]) -> TriangleMesh:
    """Boxes with sides of 1, each with vertices of its own."""
    faces = np.array([[1, 3, 0], [4, 1, 0], [0, 3, 2], [2, 4, 0], [1, 7, 3], [5, 1, 4],
                      [5, 7, 1], [3, 7, 2], [6, 4, 2], [2, 7, 6], [6, 5, 4], [7, 5, 6]])  # fmt: skip
    corners = np.add(list(np.ndindex(2, 2, 2)), np.array(places)[:, None])
    return TriangleMesh(
        corners.reshape(-1, 3), np.concatenate([faces + 8 * k for k in range(len(places))])
    )


def turned(random: np.random.Generator) -> TriangleMesh:
    """A cone, globe, tube or pinched tube, as many programs make them: rows of quads, also at tips and at seams."""
    around, rows = int(random.integers(3, 200)), int(random.integers(2, 20))
    up = np.linspace(0.0, 1.0, rows + 1)
    radii = [up, np.sin(np.pi * up), np.ones(rows + 1), np.abs(2.0 * up - 1.0)][random.integers(4)]
    radii[radii < 1e-9] = 0.0
    joined = bool(random.integers(2))
    angles = 2.0 * np.pi * (np.arange(around if joined else around + 1) % around) / around
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    flat = np.concatenate(
        [
            np.column_stack([radius * circle, np.full(len(angles), z)])
            for radius, z in zip(radii, up)
        ]
    )
    height = random.choice([0.2, 1.0, 3.0])
    positions = flat * (1.0, 1.0, height) * 10.0 ** random.integers(-3, 4) + random.choice(
        [0.0, 7.0]
    )
    faces = grid_faces(rows + 1, len(angles), (False, joined))
    if random.integers(2):  # a face without area, which reaches far
        positions = np.vstack([positions, positions.max(axis=0) * 3.0])
        faces = np.vstack([faces, [0, 0, len(positions) - 1]]).astype(np.int32)
    if random.integers(2):
        faces = np.vstack([faces, faces[random.integers(0, len(faces), 5)]])
    own = Attribute("normal", random.normal(size=(len(positions), 3)), "vertex", "normal")
    return TriangleMesh(positions, faces, (own,) if not random.integers(4) else ())


def theta(original: NDArray[Any], decoded: NDArray[Any], faces: Faces) -> float:
    return Reference(original, faces).theta(decoded)


def mnd(original: NDArray[Any], decoded: NDArray[Any], faces: Faces) -> float:
    return Reference(original, faces).mnd(decoded)


def in_rows(kind: str, random: np.random.Generator) -> TriangleMesh:
    """A mesh whose vertices are in rows and columns: a wave, a noisy plane, a long strip, or a tray of two sheets."""
    rows, columns = {"wave": (90, 90), "noisy": (60, 50), "strip": (4, 600), "tray": (34, 26)}[kind]
    spacing = random.uniform(0.01, 3.0)
    i, j = (
        axis.ravel() for axis in np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    )
    phase, faces = random.uniform(0.0, 6.0), grid_faces(rows, columns)
    if kind == "wave":
        heights = 4.0 * np.sin(0.08 * i + phase) + 3.0 * np.cos(0.11 * j)
    elif kind == "noisy":
        heights = random.normal(scale=0.05, size=len(i))
    elif kind == "strip":
        heights = 2.0 * np.sin(0.05 * j + phase) + 0.1 * i
    else:
        rim = (i == 0) | (j == 0) | (i == rows - 1) | (j == columns - 1)
        away = np.hypot(i - rows / 2.0, j - columns / 2.0)
        heights = np.where(rim, 3.0 + phase / 6.0, -0.2 * np.sqrt(np.maximum(64.0 - away**2, 0.0)))
    top = spacing * np.column_stack([i, j, heights])
    if kind != "tray":
        return TriangleMesh(top, faces)
    below = top - spacing * np.array([0.0, 0.0, 0.6])
    return TriangleMesh(
        np.vstack([top, below]), np.vstack([faces, faces[:, ::-1] + len(top)]).astype(np.int32)
    )


def file_of(mesh: TriangleMesh, kind: str) -> bytes:
    """A mesh as a file."""
    file = io.BytesIO()
    save(mesh, file, format=kind)
    return file.getvalue()
