"""Vertices moved along the surface to the middle of their neighbors: on a grid, they then take fewer bits."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Positions
from bsm.codec.geometry.metrics import face_geometry
from bsm.codec.geometry.welding import row_numbers

# More sweeps save few bits more, and each rounds off a little of the shape.
_SWEEPS, _PART = 2, 0.7  # of the way to the middle, each time
_BENT = 20.0  # from one part in so many on that the normals around a vertex cancel, it stays


def slid(
    points: Positions, faces: npt.NDArray[Any], fixed: npt.NDArray[np.bool_] | None = None
) -> Positions:
    """Return points that have moved; those on creases and borders stay, and those that are `held`."""
    # Copies of a vertex, as in STL, must move together, or the surface tears.
    numbers = row_numbers(points)
    first = np.unique(numbers, return_index=True)[1]
    moved, faces = points[first], numbers[faces]
    corners, following = faces.ravel(), np.roll(faces, -1, axis=1).ravel()

    def sums(values: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
        # bincount adds in the order of the corners, always. Sums are the same in every process, and so are places on
        # borders.
        return np.column_stack([np.bincount(corners, column, len(moved)) for column in values.T])

    # Around an inner vertex, each neighbor follows it in one face, and precedes it in another.
    # The sum of neighbors that follow less those that precede is zero for closed fans, and costs no search for borders.
    turns, count = sums(
        np.column_stack([following - np.roll(faces, 1, axis=1).ravel(), np.ones(len(corners))])
    ).T
    free = turns == 0.0
    if fixed is not None:
        free &= ~fixed[first]
    for _ in range(_SWEEPS):
        _, areas, normals = face_geometry(moved, faces)
        *across, together = sums(
            np.repeat(np.column_stack([areas[:, None] * normals, areas]), 3, axis=0)
        ).T
        normals = np.column_stack(across) / np.maximum(together, np.finfo(float).tiny)[:, None]
        flat = np.linalg.norm(normals, axis=1, keepdims=True)  # 1: all faces around have one normal
        normals /= np.maximum(flat, np.finfo(float).tiny)
        way = sums(moved[following]) / np.maximum(count, 1.0)[:, None] - moved
        # Without the part along the normal: that would shrink the surface, as all averaging of neighbors does.
        way -= (way * normals).sum(axis=1, keepdims=True) * normals
        moved = moved + _PART * free[:, None] * np.maximum(1.0 - _BENT * (1.0 - flat), 0.0) * way
    return moved[numbers]
