"""Predicting a block's coefficients from the vertices it shares with blocks decoded before it.

Not in the paper. With S the rows whose positions y are known, a Gaussian prior of variance s_j^2 = a j^-p for
coefficient j = 1, 2, ... and observation noise of variance s_n^2, the expectation of the coefficients is
(U_S^T U_S / s_n^2 + diag(1 / s_j^2))^-1 U_S^T y / s_n^2. Both sides compute it, and only the difference is coded.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
import numpy.typing as npt

Matrix = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PriorModel:
    """What the prediction assumes, in units of the bounding box's diagonal.

    Parameters
    ----------
    amplitude, decay : float
        a and p: coefficient j has variance a j^-p.
    noise : float
        s_n: standard deviation of known positions about their reconstruction from the subspace.
    """

    amplitude: float
    decay: float
    noise: float

    def as_floats(self) -> tuple[float, ...]:
        """As the header carries it."""
        return astuple(self)


def predict_coefficients(subspace: Matrix, rows: npt.NDArray[np.int64], known: Matrix, prior: PriorModel) -> Matrix:
    """Expected coefficients of a block, given some of its positions.

    Parameters
    ----------
    subspace : float64 array, shape (n, c)
        U.
    rows : int64 array, shape (s,)
        Rows whose positions are known.
    known : float64 array, shape (s, 3)
        Those positions.
    prior : PriorModel

    Returns
    -------
    float64 array, shape (c, 3)
        Zero where nothing is known.
    """
    width = subspace.shape[1]
    if len(rows) == 0:
        return np.zeros((width, 3))
    # Solved for the coefficients over their standard deviations, which keeps the system well conditioned.
    deviation = np.sqrt(prior.amplitude) * np.arange(1, width + 1, dtype=np.float64) ** (-prior.decay / 2)
    seen = subspace[rows] * (deviation / prior.noise)
    system = seen.T @ seen
    system[np.diag_indices(width)] += 1.0
    return deviation[:, None] * np.linalg.solve(system, seen.T @ (known / prior.noise))
