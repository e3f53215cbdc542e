"""What a part of a mesh may bend by: powers of the positions of its first frame.

A part that moves as a rigid body moves by linear functions of where its vertices were. Joints and muscles bend and
twist it, by what is well told by squares and cubes of the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np

from bsm.codec.arrays import Matrix

SQUARES, CUBES = 0.5, 0.3
"""How much powers count beside positions; half and twice cost 0.2 to 0.5 %."""
SMALLEST = 2.0**-24
"""Added to the squared radius of a part, in BSM units."""
PRODUCTS = tuple(
    (factor, axes)
    for degree, factor in ((2, SQUARES), (3, CUBES))
    for axes in combinations_with_replacement(range(3), degree)
)
BENDING_COLUMNS = 3 + len(PRODUCTS)


@dataclass(frozen=True, eq=False)
class Bending:
    """The powers that belong to a part."""

    centre: Matrix
    radius: float

    @classmethod
    def of(cls, positions: Matrix) -> Bending:
        """How a part bends that has the positions, shape (n_i, 3), in its first frame, in BSM units."""
        centre = positions.mean(axis=0)
        return cls(centre, float(np.sqrt(np.square(positions - centre).sum() / len(positions) + SMALLEST)))

    def columns(self, positions: Matrix) -> Matrix:
        """Positions, shape (m, 3), and behind them their squares and cubes about the part: shape (m, 19)."""
        own = (positions - self.centre) / self.radius
        powers = [factor * self.radius * own[:, list(axes)].prod(axis=1) for factor, axes in PRODUCTS]
        return np.column_stack([positions, *powers])
