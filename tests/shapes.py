"""Small meshes with known properties."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from bsm import Attribute, TriangleMesh
from bsm.codec.geometry.metrics import Reference

Faces = NDArray[np.int32]


def grid_faces(rows: int, columns: int, *, close_rows: bool = False, close_columns: bool = False) -> Faces:
    """Triangles of a rectangular grid of vertices; closing both directions makes a torus."""
    i, j = np.meshgrid(
        np.arange(rows if close_rows else rows - 1), np.arange(columns if close_columns else columns - 1), indexing="ij"
    )
    a = i * columns + j
    b = (i + 1) % rows * columns + j
    c = (i + 1) % rows * columns + (j + 1) % columns
    d = i * columns + (j + 1) % columns
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)]).astype(
        np.int32
    )


def patch(rows: int, columns: int) -> TriangleMesh:
    """A wavy rectangle, open."""
    x, y = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1.3, columns), indexing="ij")
    z = 0.1 * np.sin(5 * x) * np.cos(4 * y) + 0.02 * np.sin(17 * x + 9 * y)
    return TriangleMesh(np.stack([x, y, z], -1).reshape(-1, 3), grid_faces(rows, columns))


def curved(mesh: TriangleMesh) -> TriangleMesh:
    """With every line of vertices drawn out of line, so that no grid suits it."""
    p = mesh.positions
    return TriangleMesh(p + 0.05 * np.sin(3.0 * p[:, [1, 2, 0]] + 1.0) + 0.03 * np.sin(5.0 * p), mesh.faces)


def torus(rows: int = 40, columns: int = 24, bumps: float = 0.05) -> TriangleMesh:
    """A bumpy torus, closed, genus one."""
    u, v = np.meshgrid(
        np.linspace(0, 2 * np.pi, rows, endpoint=False),
        np.linspace(0, 2 * np.pi, columns, endpoint=False),
        indexing="ij",
    )
    r = 0.35 * (1 + bumps * np.sin(6 * u) * np.sin(4 * v))
    x, y, z = (1 + r * np.cos(v)) * np.cos(u), (1 + r * np.cos(v)) * np.sin(u), r * np.sin(v)
    faces = grid_faces(rows, columns, close_rows=True, close_columns=True)
    return TriangleMesh(np.stack([x, y, z], -1).reshape(-1, 3), faces)


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
    return TriangleMesh(mesh.positions[mesh.faces].reshape(-1, 3), np.arange(mesh.faces.size).reshape(-1, 3))


def tetrahedron() -> TriangleMesh:
    """Four vertices, four faces."""
    positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    return TriangleMesh(np.array(positions, float), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))


def together(*meshes: TriangleMesh) -> TriangleMesh:
    """Several meshes as one, side by side."""
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    positions = [mesh.positions + np.array([3.0 * k, 0.0, 0.0]) for k, mesh in enumerate(meshes)]
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    return TriangleMesh(np.concatenate(positions), np.concatenate(faces))


def turned(random: np.random.Generator) -> TriangleMesh:
    """A cone, globe, tube or pinched tube, as many programs make them: rows of quads, also at tips and at seams."""
    around, rows = int(random.integers(3, 200)), int(random.integers(2, 20))
    up = np.linspace(0.0, 1.0, rows + 1)
    radii = [up, np.sin(np.pi * up), np.ones(rows + 1), np.abs(2.0 * up - 1.0)][random.integers(4)]
    radii[radii < 1e-9] = 0.0
    joined = bool(random.integers(2))
    angles = 2.0 * np.pi * (np.arange(around if joined else around + 1) % around) / around
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    flat = np.concatenate([np.column_stack([radius * circle, np.full(len(angles), z)]) for radius, z in zip(radii, up)])
    height = random.choice([0.2, 1.0, 3.0])
    positions = flat * (1.0, 1.0, height) * 10.0 ** random.integers(-3, 4) + random.choice([0.0, 7.0])
    faces = grid_faces(rows + 1, len(angles), close_columns=joined)
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
