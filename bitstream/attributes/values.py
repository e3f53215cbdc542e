"""Normals as levels on an octahedron."""

import numpy as np
import numpy.typing as npt

Longs = npt.NDArray[np.int64]


def octahedral_normals(levels: npt.ArrayLike, size: int) -> npt.NDArray[np.float64]:
    """The unit vectors, shape (n, 3), of levels, shape (n, 2): points on an octahedron (Meyer et al., EGSR 2010)."""
    points = _unfolded(np.asarray(levels, np.int64), size).astype(np.float64)
    unit: npt.NDArray[np.float64] = points / np.sqrt((points * points).sum(axis=1, keepdims=True))
    return unit


def _unfolded(levels: Longs, size: int) -> Longs:
    flat = levels - size
    height = size - np.abs(flat).sum(axis=1, keepdims=True)
    inside = np.where(flat < 0, -1, 1) * (size - np.abs(flat[:, ::-1]))
    return np.hstack([np.where(height < 0, inside, flat), height])
