"""Small meshes for the vectors; coordinates by sines, so that no file is needed."""

import numpy as np
import numpy.typing as npt

from bsm.codec.geometry.mesh import TriangleMesh


def grid_faces(
    rows: int, columns: int, closed: tuple[bool, bool] = (False, False)
) -> npt.NDArray[np.int32]:
    """Triangles of a rectangular grid of vertices, of which rows and columns may be closed."""
    i, j = np.meshgrid(
        np.arange(rows - (not closed[0])), np.arange(columns - (not closed[1])), indexing="ij"
    )
    a, b = i * columns + j, (i + 1) % rows * columns + j
    c, d = (i + 1) % rows * columns + (j + 1) % columns, i * columns + (j + 1) % columns
    halves = [np.stack([a, b, c], -1), np.stack([a, c, d], -1)]
    return np.concatenate([half.reshape(-1, 3) for half in halves]).astype(np.int32)


def patch(rows: int, columns: int) -> TriangleMesh:
    """A wavy rectangle: a disc with a boundary."""
    x, y = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1.3, columns), indexing="ij")
    z = 0.1 * np.sin(5 * x) * np.cos(4 * y) + 0.02 * np.sin(17 * x + 9 * y)
    return TriangleMesh(np.stack([x, y, z], -1).reshape(-1, 3), grid_faces(rows, columns))


def torus(
    rows: int = 40, columns: int = 24, phase: float = 0.0, bumps: float = 0.05
) -> TriangleMesh:
    """A bumpy torus: closed, genus one; its graph is so regular that eigenvalues repeat."""
    angles = [np.linspace(0, 2 * np.pi, count, endpoint=False) for count in (rows, columns)]
    u, v = np.meshgrid(*angles, indexing="ij")
    r = 0.35 * (1 + bumps * np.sin(6 * u + phase) * np.sin(4 * v))
    x, y, z = (
        (1 + r * np.cos(v)) * np.cos(u),
        (1 + r * np.cos(v)) * np.sin(u),
        r * np.sin(v + phase),
    )
    return TriangleMesh(
        np.stack([x, y, z], -1).reshape(-1, 3), grid_faces(rows, columns, (True, True))
    )


def tetrahedron() -> TriangleMesh:
    """Four vertices, four faces."""
    positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    return TriangleMesh(
        np.array(positions, float), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    )


def triangle() -> TriangleMesh:
    """A mesh of one face."""
    return TriangleMesh(np.array([[0, 0, 0], [4, 0, 0], [0, 3, 0]], float), np.array([[0, 1, 2]]))


def together(*meshes: TriangleMesh) -> TriangleMesh:
    """Several meshes as one, side by side."""
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    positions = [mesh.positions + np.array([3.0 * k, 0.0, 0.0]) for k, mesh in enumerate(meshes)]
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts[:-1], strict=True)]
    return TriangleMesh(np.concatenate(positions), np.concatenate(faces))


def tangled() -> TriangleMesh:
    """All that a list of triangles may be: an edge of three faces, faces turned around, repeated, and degenerate."""
    base = patch(7, 6)
    last = len(base.positions)
    positions = np.concatenate(
        [base.positions, [[0.5, 0.5, 1.0], [0.2, 0.9, -0.5], [2.0, 2.0, 2.0]]]
    )
    inner = base.faces[20]
    extra = [
        [inner[0], inner[1], last],
        [inner[0], inner[1], last + 1],
        [inner[1], inner[0], last + 1],
        inner[[0, 2, 1]],
        base.faces[3],
        [inner[2], inner[2], last],
        [last + 2, last + 2, last + 2],
    ]
    faces = np.concatenate([base.faces, np.array(extra)])
    faces[5] = faces[5][[1, 0, 2]]
    return TriangleMesh(positions, faces)


def hub() -> TriangleMesh:
    """A cone over a ring of 40 vertices: one vertex is the neighbor of all others."""
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle), 0.1 * np.sin(5 * angle)], -1)
    k = np.arange(40)
    faces = np.stack([np.full(40, 40), k, (k + 1) % 40], -1)
    return TriangleMesh(np.concatenate([ring, [[0.0, 0.0, 0.5]]]), faces)


def tent(side: int = 19) -> TriangleMesh:
    """A patch, and two vertices over every second edge along its boundary, which come last, with as many corners.

    All edges to the first of them are its own, so it sees no flap when it comes, and the second one sees all.
    """
    base, size = patch(side, side), side * side
    number = np.arange(size).reshape(side, side)
    around = np.concatenate([number[0, :-1], number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0]])
    upper = np.stack([np.full(len(around), size), around, np.roll(around, -2)], -1)
    lower = np.stack([np.full(len(around), size + 1), np.roll(around, -2), around], -1)
    tips = [[0.5, 0.6, 1.0], [0.4, 0.7, -0.8]]
    return TriangleMesh(
        np.concatenate([base.positions, tips]),
        np.concatenate([base.faces, upper, lower]).astype(np.int32),
    )


def shuffled(mesh: TriangleMesh) -> TriangleMesh:
    """A mesh with its vertices, faces and first corners in another order."""
    n, m = len(mesh.positions), len(mesh.faces)
    number = np.arange(n) * 7 % n if n % 7 else np.arange(n)[::-1]
    positions = np.empty_like(mesh.positions)
    positions[number] = mesh.positions
    faces = number.astype(np.int32)[mesh.faces][
        np.arange(m) * 11 % m if m % 11 else np.arange(m)[::-1]
    ]
    turns: npt.NDArray[np.int64] = (np.arange(m)[:, None] + np.arange(3)) % 3
    return TriangleMesh(positions, faces[np.arange(m)[:, None], turns])
