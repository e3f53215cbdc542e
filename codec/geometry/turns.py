"""Rotations: by quaternions, and to the axes of a part."""

from itertools import permutations, product

import numpy as np

from bsm.codec.arrays import Faces, Matrix, Positions

SAME, UPRIGHT, WORTH = 2e-3, 2e-3, 0.02
"""Normals nearer to each other are of one plane; the cosine of axes; share of the area that must gain by a turn."""
Turn = tuple[float, ...]  # a quaternion, of which the first entry is 1, less that
UNTURNED: Turn = (0.0, 0.0, 0.0)


def turned_by(places: Positions, turn: Turn, back: bool = False) -> Positions:
    """Places, shape (n, 3), in the axes to which a turn takes their own, or `back` (specification, V 18)."""
    if not any(turn):
        return places
    # Written out in the order of the law: every decoder must round in the same places.
    share = 2.0 / (1.0 + turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2])
    axis = np.array(turn) * (-1.0 if back else 1.0)
    # The rotation of Rodrigues by two cross products. A matrix would be rounded first, and would not be the law's.
    once = cross_of(axis, places)
    return np.asarray(places + share * (once + cross_of(axis, once)))


def cross_of(a: Matrix, b: Matrix) -> Matrix:
    """`np.cross` of the last axes, for few vectors many times quicker."""
    return np.asarray(a[..., [1, 2, 0]] * b[..., [2, 0, 1]] - a[..., [2, 0, 1]] * b[..., [1, 2, 0]])


def quaternion_of(turns: Matrix) -> Matrix:
    """The unit quaternions of rotations, shape (..., 3, 3)."""
    back, trace = np.swapaxes(turns, -1, -2), np.trace(turns, axis1=-2, axis2=-1)[..., None]
    # The largest eigenvector of this matrix is the quaternion, also of half turns, where formulas by the trace divide
    # by zero (Bar-Itzhack 2000).
    products, skew = np.empty((*turns.shape[:-2], 4, 4)), (turns - back)[..., [2, 0, 1], [1, 2, 0]]
    products[..., 0, :] = products[..., :, 0] = np.concatenate([trace, skew], axis=-1)
    products[..., 1:, 1:] = turns + back - trace[..., None] * np.eye(3)
    return np.asarray(np.linalg.eigh(products)[1][..., 3])


def turn_of(positions: Matrix, faces: Faces) -> Turn:
    """The turn, in single precision, to axes along which more of the area lies; `UNTURNED` if that is little more."""
    a, b, c = positions[faces.T]
    normals = cross_of(b - a, c - a)
    # Opposite sides of a box count as one plane.
    normals *= np.sign(np.take_along_axis(normals, np.abs(normals).argmax(axis=1)[:, None], axis=1))
    # Rounded directions make planes by sorting. Comparing all pairs would take quadratic time.
    directions = np.rint(
        normals / (SAME * np.sqrt(np.square(normals).sum(axis=1)) + 1e-300)[:, None]
    )
    _, plane = np.unique(directions @ (1e8, 1e4, 1.0), return_inverse=True)
    normals = np.array([np.bincount(plane, of_axis) for of_axis in normals.T]).T
    areas = np.sqrt(np.square(normals).sum(axis=1))
    normals /= areas[:, None] + 1e-300

    def along(axes: Matrix) -> float:
        return float(areas @ (np.square(normals @ axes.T).max(axis=1) > 1.0 - 0.75 * SAME * SAME))

    # The turn costs bytes, so it must gain something over the axes as they are.
    best, most = np.eye(3), along(np.eye(3)) + WORTH * areas.sum()
    # Axes of a machined part are those of its large planes. Twelve of them make at most 66 pairs to try.
    large = normals[[at for at in np.argsort(-areas, kind="stable")[:12] if areas[at] > 0.0]]
    first, second = large[np.array(np.nonzero(np.triu(np.abs(large @ large.T) < UPRIGHT, 1)))]
    third = cross_of(first, second)
    for axes in np.stack([first, cross_of(third, first), third], axis=1):
        if (found := along(axes)) > most:
            best, most = axes, found
    if (best == np.eye(3)).all():
        return UNTURNED
    signs = np.array(list(product((1.0, -1.0), repeat=3)))[:, :, None]
    # 24 turns lead to the same axes. The nearest to no turn at all moves the mesh least.
    alike = [
        axes
        for order in permutations(best)
        for axes in signs * np.array(order)
        if np.linalg.det(axes) > 0.0
    ]
    whole, *others = map(float, quaternion_of(max(alike, key=np.trace).T))
    # The largest real part is far from zero for the nearest turn, so that dividing by it is safe.
    return tuple(float(np.float32(entry / whole)) for entry in others)
