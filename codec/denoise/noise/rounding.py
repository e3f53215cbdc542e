"""Coordinates that were rounded to a grid: whether they are, and how coarse it is.

Rounding leaves its trace exactly: along an axis all values are multiples of one step. Nothing else that is known about
noise is as sure, and it says more: the vertex was in the cell about the place where it is now.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.denoise.filters.vertex_update import Floats

FEWEST_VALUES = 16
"""Different values of a coordinate without which a grid is not told from a few planes."""
NEAR = 0.02
"""Distance from a multiple, in steps, that the precision of files explains."""
SAME = 1e-6
"""Values closer together, as a share of the extent, are one value."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells between which positions cannot be told apart."""

    steps: Floats

    def round(self, positions: Positions, offset: Floats) -> Positions:
        """Positions in the middle of their cells, of which one has its middle at `offset`, shape (3,)."""
        safe = np.where(self.steps > 0.0, self.steps, 1.0)
        return np.where(self.steps > 0.0, np.round((positions - offset) / safe) * safe + offset, positions)

    def levels(self, normals: Floats) -> Floats:
        """Standard deviation along normals, shape (n, 3), of what rounding takes away or adds, shape (n,)."""
        return np.asarray(np.sqrt(np.square(normals * self.steps).sum(axis=1) / 12.0))

    def within_cells(self, rounded: Positions, moved: Positions) -> Positions:
        """Moved positions, shape (n, 3), brought back into the cells that the rounded ones stand for."""
        half = np.where(self.steps > 0.0, 0.5 * self.steps, np.inf)
        return np.clip(moved, rounded - half, rounded + half)


def find_grid(positions: Positions) -> Grid | None:
    """The grid that the positions, shape (n, 3), were rounded to, in all coordinates."""
    steps = [_step(positions[:, axis]) for axis in range(3)]
    known = [step for step in steps if step is not None]
    return Grid(np.array(known)) if len(known) == 3 and sum(step > 0.0 for step in known) >= 2 else None


def _step(coordinate: Floats) -> float | None:
    """Size of a cell; 0 where there are too few values to tell, None where they are not rounded."""
    extent = float(np.ptp(coordinate))
    values = np.unique(coordinate)
    gaps = np.diff(values)
    gaps = gaps[gaps > SAME * extent]
    if len(gaps) < FEWEST_VALUES:
        return 0.0
    count = round(extent / float(gaps.min()))
    # One gap alone is known no better than the file's last digits: all of them together say it.
    step = extent / count
    for _ in range(3):
        numbers = np.round((values - values[0]) / step)
        step = float(numbers @ (values - values[0]) / (numbers @ numbers))
    off = np.abs((values - values[0]) / step - np.round((values - values[0]) / step))
    return step if off.max() < NEAR and len(values) * 8 > count else None
