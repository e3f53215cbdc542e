"""Dependent quantization: two grids, and a rule by which the levels so far say which of them the next one is on.

References
----------
M. W. Marcellin and T. R. Fischer, "Trellis coded quantization of memoryless and Gauss-Markov sources", 1990; H. Schwarz
et al., "Hybrid video coding with trellis-coded quantization", 2019 (grids that share zero, adaptive coding of levels).
The rule here is a feedback form of the eight-state code.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels

Levels = npt.NDArray[np.int32]

STATES = 8
"""A state is the numbers of the last three grids, the latest in the lowest bit (`trellis.h`)."""


def points_of_levels(levels: Levels) -> Levels:
    """Coefficients of a block in half steps, shape (c, 3); levels follow each other row by row."""
    points = np.empty_like(levels)
    _kernels.points_of_levels(levels, points)
    return points
