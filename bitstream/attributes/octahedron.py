"""Directions as pairs of integers, on an octahedron."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError, OptionError

Ints = npt.NDArray[np.int32]
Longs = npt.NDArray[np.int64]

LARGEST_SIZE = (1 << 19) - 1
"""Levels are as large as those of other values may be, at most."""


def octahedral_levels(normals: npt.ArrayLike, size: int) -> Ints:
    """Directions as pairs of integers: points on an octahedron, its lower half folded outwards.

    Q. Meyer et al., "On floating-point normal vectors", EGSR 2010.
    """
    if not 1 <= size <= LARGEST_SIZE:
        raise OptionError(f"the size of an octahedron must be from 1 to {LARGEST_SIZE}, not {size}")
    given = np.asarray(normals, np.float64)
    if given.ndim != 2 or given.shape[1] != 3:
        raise MeshError(f"normals must have shape (n, 3), not {given.shape}")
    largest = np.abs(given).max(axis=1, keepdims=True)
    if not (np.isfinite(largest).all() and (largest > 0).all()):
        raise MeshError("a normal without a direction has no place on an octahedron")
    scaled = given / largest
    scaled *= size / np.abs(scaled).sum(axis=1, keepdims=True)
    points = np.rint(scaled).astype(np.int64)
    rows = np.arange(len(points))
    for _ in range(3):  # what rounding has added or taken, where that changes least
        missing = size - np.abs(points).sum(axis=1)
        change = np.sign(missing)
        slack = (np.abs(scaled) - np.abs(points)) * change[:, None]
        slack[(points == 0) & (change < 0)[:, None]] = -2
        axis = slack.argmax(axis=1)
        points[rows, axis] += np.where(scaled[rows, axis] < 0, -change, change)
    return _folded(points, size)


def octahedral_normals(levels: npt.ArrayLike, size: int) -> npt.NDArray[np.float64]:
    """The unit vectors, shape (n, 3), of levels, shape (n, 2): twin of `octahedral_levels`."""
    points = _unfolded(np.asarray(levels, np.int64), size).astype(np.float64)
    unit: npt.NDArray[np.float64] = points / np.sqrt((points * points).sum(axis=1, keepdims=True))
    return unit


def canonical_levels(levels: npt.ArrayLike, size: int) -> Ints:
    """The pairs, shape (n, 2), that a decoder gives for the directions of `levels`, shape (n, 2)."""
    return _folded(_unfolded(np.asarray(levels, np.int64), size), size)


def _folded(points: Longs, size: int) -> Ints:
    flat = points[:, :2]
    outside = np.where(flat < 0, -1, 1) * (size - np.abs(flat[:, ::-1]))
    return (np.where(points[:, 2:] < 0, outside, flat) + size).astype(np.int32)


def _unfolded(levels: Longs, size: int) -> Longs:
    flat = levels - size
    height = size - np.abs(flat).sum(axis=1, keepdims=True)
    inside = np.where(flat < 0, -1, 1) * (size - np.abs(flat[:, ::-1]))
    return np.hstack([np.where(height < 0, inside, flat), height])
