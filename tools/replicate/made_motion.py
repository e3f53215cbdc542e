"""Moving meshes made by formulas, which no choice of the codec was made on: cloth in the wind, and violent motion."""

from itertools import pairwise

import numpy as np

from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh

SPRINGS = ((0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (2, 0))
"""Return the edges between vertices of a grid that are some rows and columns apart."""
TIMES, RELAXATIONS = 12, 8
"""Steps of time in a frame, and rounds over all springs in each."""


def cloth(frames: int = 120, rows: int = 60, columns: int = 80) -> tuple[Positions, Faces]:
    """Cloth that hangs at three points, loses one, and is blown at, shape (T, n, 3): Verlet's steps, stiff springs."""
    y, x = np.mgrid[0:rows, 0:columns].astype(np.float64)
    rough = 0.02 * np.random.default_rng(7).standard_normal((rows, columns))
    place: Matrix = np.stack([1.33 * x / (columns - 1), -y / (rows - 1), rough], axis=-1)
    before, home = place.copy(), place.copy()
    springs = [_spring(place, down, right) for down, right in SPRINGS]
    corners = ((0, 1.0, frames), (columns - 1, -1.0, frames), (columns // 2, 1.0, frames // 3))
    step = 1.0 / 25.0 / TIMES
    found = []
    for time in np.arange(frames * TIMES) / TIMES:
        speed, before = 0.999 * (place - before), place.copy()
        place = place + speed + step**2 * _pull(place, time)
        for _ in range(RELAXATIONS):
            for first, second, length in springs:
                apart = place[second] - place[first]
                now = np.maximum(np.linalg.norm(apart, axis=-1), 1e-9)
                move = 0.25 * (1.0 - length / now)[..., None] * apart
                place[first] += move
                place[second] -= move
            for column, side, until in corners:
                if time <= until:
                    sway = (0.2 * np.sin(0.07 * time) * side, 0.0, 0.1 * np.sin(0.13 * time))
                    place[0, column] = home[0, column] + sway
        if time % 1.0 == 0.0:
            found.append(place.reshape(-1, 3).copy())
    return np.array(found), _grid_faces(rows, columns, closed=False)


def _spring(
    place: Matrix, down: int, right: int
) -> tuple[tuple[slice, slice], tuple[slice, slice], Matrix]:
    """Both ends and the lengths, in the plane, of springs between vertices so far apart in the grid."""
    rows, columns = place.shape[:2]
    first = (
        slice(max(0, -down), rows - max(0, down)),
        slice(max(0, -right), columns - max(0, right)),
    )
    second = slice(max(0, down), rows + min(0, down)), slice(max(0, right), columns + min(0, right))
    return first, second, np.linalg.norm((place[second] - place[first])[..., :2], axis=-1)


def _pull(place: Matrix, time: float) -> Matrix:
    """Acceleration by weight and by wind that comes in waves."""
    normals = np.cross(np.gradient(place, axis=0), np.gradient(place, axis=1))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True) + 1e-12
    gusts = (
        6.0 * np.sin(0.17 * time)
        + 4.0 * np.sin(0.53 * time)
        + 2.0 * np.sin(3.0 * place[..., 0] + 0.4 * time)
    )
    across = np.full_like(gusts, 1.5 * np.sin(0.11 * time))
    wind = np.stack([across, np.full_like(gusts, 0.3 * np.sin(0.31 * time)), gusts], axis=-1)
    pushed: Matrix = 1.2 * normals * np.einsum("...i,...i", normals, wind)[..., None]
    pushed += np.array([0.0, -4.0, 0.0])
    return pushed


def violent(frames: int = 90, rows: int = 96, columns: int = 60) -> tuple[Positions, Faces]:
    """A torus that is twisted, bent, dented and thrown: shape (T, n, 3)."""
    random = np.random.default_rng(7)
    u, v = np.meshgrid(
        2 * np.pi * np.arange(rows) / rows, 2 * np.pi * np.arange(columns) / columns, indexing="ij"
    )
    ring = 1.0 + 0.4 * np.cos(v)
    shape = 0.35 * np.stack([ring * np.cos(u), ring * np.sin(u), 0.4 * np.sin(v)], axis=-1).reshape(
        -1, 3
    )
    directions, middles = (
        random.standard_normal((14, 3)),
        shape[random.integers(len(shape), size=14)],
    )
    phases, pace, widths = (
        6.3 * random.random(14),
        random.uniform(0.15, 0.9, 14),
        random.uniform(0.08, 0.3, 14),
    )
    reach = np.exp(-np.square(shape[:, None] - middles).sum(axis=2) / widths**2)
    found = []
    for t in np.arange(frames, dtype=np.float64):
        frame = _turned(shape, 1, 5.0 * np.sin(0.21 * t) * shape[:, 1] + 0.8 * np.sin(0.5 * t))
        frame = _turned(frame, 0, 3.0 * np.sin(0.13 * t + 1.0) * frame[:, 0])
        frame = frame + 0.06 * (reach * np.sin(pace * t + phases)) @ directions
        frame[:, 1] += 0.01 * np.sin(30.0 * shape[:, 0] + 0.9 * t)
        for axis, angle in enumerate((0.1 * t, 0.07 * t * np.sin(0.05 * t), 0.03 * t)):
            frame = _turned(frame, axis, np.full(len(frame), angle))
        found.append(
            frame * (1.0 + 0.3 * np.sin(0.37 * t)) + [0.05 * t, 0.4 * abs(np.sin(0.3 * t)), 0.0]
        )
    return np.array(found), _grid_faces(rows, columns, closed=True)


def limbs(mesh: TriangleMesh, frames: int, bones: int = 12, seed: int = 7) -> Positions:
    """A mesh that bones turn, each smoothly by itself, as players of games and film do, shape (T, n, 3)."""
    random, places = np.random.default_rng(seed), mesh.positions
    joints = places[[0]]
    while len(joints) < bones:  # each as far as possible from the others
        joints = np.vstack(
            [joints, places[np.square(places[:, None] - joints).sum(axis=2).min(axis=1).argmax()]]
        )
    share = (
        np.exp(-np.square(places[:, None] - joints).sum(axis=2) / (0.1 * mesh.diagonal) ** 2)
        + 1e-12
    )
    share /= share.sum(axis=1, keepdims=True)
    time, found = np.arange(frames)[:, None, None, None], np.zeros((frames, len(places), 3))
    paces, phases, reach = (
        random.uniform(0.03, 0.25, (1, bones, 3, 4)),
        random.uniform(0, 6.3, (1, bones, 3, 4)),
        0.2,
    )
    angles = reach * np.sin(paces * time + phases).sum(axis=3)
    for bone, joint in enumerate(joints):
        for number, turn in enumerate(angles[:, bone]):
            moved = places - joint
            for axis in range(3):
                moved = _turned(moved, axis, np.full(len(places), turn[axis]))
            found[number] += share[:, [bone]] * (moved + joint)
    return found


def _turned(positions: Positions, axis: int, angles: Matrix) -> Positions:
    """Each position by an angle of its own about an axis."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    turned = positions.copy()
    turned[:, first] = np.cos(angles) * positions[:, first] - np.sin(angles) * positions[:, second]
    turned[:, second] = np.sin(angles) * positions[:, first] + np.cos(angles) * positions[:, second]
    return turned


def _grid_faces(rows: int, columns: int, *, closed: bool) -> Faces:
    """Two triangles for each square of a grid, which may be closed to a torus."""
    index = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    if closed:
        index = np.pad(index, ((0, 1), (0, 1)), mode="wrap")
    faces = [
        corner
        for low, high in pairwise(index)
        for corner in (
            np.stack([low[:-1], high[:-1], low[1:]], axis=1),
            np.stack([low[1:], high[:-1], high[1:]], axis=1),
        )
    ]
    return np.concatenate(faces)


MADE = {"made cloth": cloth, "made violence": violent}
