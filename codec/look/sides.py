"""The sides that a mesh is looked at from, and the frames that it fills there."""

import math

import numpy as np

from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import box_around

TOWARDS = (
    *((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)),
    *((7, 0, 401), (7, 0, -401)),
    *((x, y, z) for x, y in ((101, 101), (-101, 101), (-101, -101), (101, -101)) for z in (100, -100)),
)
"""Where the camera is, from the middle of the mesh: around it, above and below, and at the corners of a cube."""
FEW = (0, 3, 6, 9, 12)  # those from which a mesh looks about as it does from all
LIGHT = (0.35, 0.5, 0.79)  # where the light is: right, up, towards the camera
AIR = 1.03  # the side of the picture over the longer side of what it shows
LEAST_PIXELS, MOST_PIXELS = 512, 2048
EDGE_PIXELS = 2.0  # what a mean edge has, where `MOST_PIXELS` allow it


def axes(towards: tuple[int, int, int]) -> Matrix:
    """The camera's axes as rows, shape (3, 3): right, up, towards the camera; z is up in the mesh."""
    x, y, z = towards
    flat, length = math.sqrt(x * x + y * y), math.sqrt(x * x + y * y + z * z)
    right = (-y / flat, x / flat, 0.0)
    ahead = (x / length, y / length, z / length)
    up = (-ahead[2] * right[1], ahead[2] * right[0], ahead[0] * right[1] - ahead[1] * right[0])
    return np.array([right, up, ahead])


def cameras(positions: Positions, pixels: int) -> list[Matrix]:
    """What `draw_shaded` takes for each side, shape (15,), so that the positions, shape (n, 3), fill the picture."""
    found = []
    across, deep, high_up = np.ascontiguousarray(positions.T)
    for towards in TOWARDS:
        rows = axes(towards)
        seen = [across * x + deep * y + high_up * z for x, y, z in rows]
        low, high = (np.array([values.min() for values in seen]), np.array([values.max() for values in seen]))
        side = AIR * float((high - low)[:2].max()) or 1.0
        scale = np.array([pixels / side, -pixels / side, 2.0**22])  # as many depths in the box's diagonal
        offset = np.array([pixels / 2, pixels / 2, 0.0]) - scale * (low + high) / 2
        light = LIGHT[0] * rows[0] + LIGHT[1] * rows[1] + LIGHT[2] * rows[2]
        found.append(np.concatenate([np.column_stack([rows * scale[:, None], offset]).ravel(), light]))
    return found


def pixels_for(positions: Positions, faces: Faces) -> int:
    """Pixels of a side of the pictures: enough that the mean edge has `EDGE_PIXELS`."""
    first, second, third = (positions[corner] for corner in np.ascontiguousarray(faces.T))
    sides = [first - second, second - third, third - first]
    edge = float(sum(np.sqrt(np.einsum("fd,fd->f", side, side)).sum() for side in sides)) / (3 * len(faces))
    ends = np.array([box_around(corner) for corner in (first, second, third)])
    side = AIR * float((ends[:, 1].max(axis=0) - ends[:, 0].min(axis=0)).max())
    if not edge * MOST_PIXELS > EDGE_PIXELS * side:
        return MOST_PIXELS
    return max(LEAST_PIXELS, math.ceil(EDGE_PIXELS * side / edge))
