"""Choosing the temporal basis of a GOP: the encoder's own business."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Matrix
from bsm.codec.sequence.row_prediction import OCTAVE

WORTH = 0.4
"""A component is kept if its energy is above WORTH * dT * step^2: below, it costs more than it brings. 0.35 and 0.5
cost 0.3 % more, 0.8 costs 1 %."""
PRECISION = 1.0
"""Error of a column of the basis, times the root of the energy that it multiplies, in steps. A bit of the basis and one
of the components are worth the same from 1 to 1.4; the finer, the less the error changes from frame to frame."""
FINEST_EXPONENT = OCTAVE * 23 - 1
"""With a finer step the levels of a column of length one could not be coded."""


@dataclass(frozen=True, eq=False)
class LearntBasis:
    """Principal components of trajectories."""

    columns: Matrix
    exponents: npt.NDArray[np.int32]


def learn_basis(motion: Matrix, step: float, limit: int) -> LearntBasis:
    """Eigenvectors of the covariance of trajectories, all coordinates coupled."""
    energies, vectors = np.linalg.eigh(motion.T @ motion)
    width = len(energies)
    count = int(np.count_nonzero(energies > WORTH * width * step**2))
    kept = energies[: -count - 1 : -1]
    exponents = np.round(OCTAVE * np.log2(np.sqrt(kept) / (PRECISION * step)))
    columns = np.ascontiguousarray(vectors[:, : -count - 1 : -1])
    return LearntBasis(columns, np.clip(exponents, 0, min(limit, FINEST_EXPONENT)).astype(np.int32))


def projection(basis: Matrix) -> Matrix:
    """Pseudo-inverse of a decoded basis, transposed, shape (dT, r), as the basis has it."""
    return np.ascontiguousarray(np.linalg.pinv(basis).T)
