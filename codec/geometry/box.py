"""The box around points."""

from __future__ import annotations

import numpy as np

from bsm.codec.arrays import Matrix, Positions


def box_around(points: Positions) -> tuple[Matrix, Matrix]:
    """Lowest and highest corner of the box around at least one point, shape (n, d); each has shape (d,)."""
    axes = points.T  # three long loops are faster than n short ones
    return np.array([axis.min() for axis in axes]), np.array([axis.max() for axis in axes])


def extent_of(points: Positions) -> Matrix:
    """Lengths of the sides of that box, shape (d,)."""
    low, high = box_around(points)
    return np.asarray(high - low)
