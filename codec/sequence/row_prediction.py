"""The mathematics of sequences: the temporal transform, and the closed loop that predicts and quantizes rows."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.bitstream.coefficients.adaptive import STATES, points_of_levels
from bsm.bitstream.coefficients.matrices import Lead, Prices
from bsm.bitstream.errors import NumericError, OptionError
from bsm.codec import _kernels
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.basis.orthogonal_iteration import cosine_columns
from bsm.codec.sequence.reflections import columns_of, free_of

LEADING = 24
"""Columns of a row that help to predict the columns behind them."""
FORGETTING = 0.985
"""How much the past counts, per row, in the weights of the prediction."""
RIDGE = 0.004
"""Regularisation of the weights."""
NOISE = 30.0
"""Energy in squared steps that is added to that of a row before the row is weighed by the inverse of it;
half costs 0.3 %, twice saves 0.1 %."""
AROUND = 30.0
"""As many rows the vertices around a block count for, together, before its first row."""
DENSE_ROWS = 16
"""First rows of a block, each with weights of its own; behind them the weights are renewed every `RENEWAL` rows."""
RENEWAL = 8
RULES = (FORGETTING, RIDGE, NOISE, AROUND, DENSE_ROWS, RENEWAL)
LARGEST_LEVEL = (1 << 23) - 1
OCTAVE = 4
"""Exponents of the steps of a basis are in units of 1 / OCTAVE octaves."""


def basis_leads(width: int) -> list[Lead]:
    """Leads of the levels of a basis, one for each of so many numbers: column i has i levels that are not free."""
    return [(coordinate + 1, width) for coordinate in range(width)]


def trajectories(frames: Matrix) -> Matrix:
    """Frames, shape (T, n, d), as a matrix of its own, shape (n, dT)."""
    frame_last = frames.transpose(1, 2, 0)
    matrix = np.empty(frame_last.shape)  # of a single frame, reshaping would give the frame itself
    matrix[...] = frame_last
    return matrix.reshape(len(matrix), -1)


def time_cosines(frames: int) -> Matrix:
    """The orthonormal cosine transform (DCT-II), shape (T, T): row t, column frequency."""
    columns = cosine_columns(frames, 0, frames) * np.sqrt(2.0 / frames)
    columns[:, :1] = np.sqrt(1.0 / frames)
    return np.asarray(columns)


def basis_steps(exponents: npt.NDArray[np.int32]) -> Matrix:
    """Quantization step of each component of a learnt basis, shape (r,): 2^(-exponent / OCTAVE)."""
    return np.exp2(-exponents.astype(np.float64) / OCTAVE)


def spectrum_of(basis: Matrix, exponents: npt.NDArray[np.int32], width: int) -> Matrix:
    """What is free in a basis, shape (dT, r), d being `width`, as cosines over time in steps: shape (d, T, r)."""
    rows, components = basis.shape
    cosines = time_cosines(rows // width).T @ basis.reshape(width, rows // width, components)
    free = free_of(cosines.transpose(1, 0, 2).reshape(rows, components)) / basis_steps(exponents)
    return np.ascontiguousarray(free.reshape(rows // width, width, components).transpose(1, 0, 2))


def basis_of(levels: Levels, exponents: npt.NDArray[np.int32]) -> Matrix:
    """The basis, shape (dT, r), that levels, shape (d, T, r), stand for; its columns are at right angles."""
    width, frames, components = levels.shape
    points = np.array([points_of_levels(np.ascontiguousarray(matrix)) for matrix in levels])
    free = (0.5 * points * basis_steps(exponents)).transpose(1, 0, 2).reshape(width * frames, components)
    basis = time_cosines(frames) @ columns_of(free).reshape(frames, width, components).transpose(1, 0, 2)
    return np.ascontiguousarray(basis.reshape(width * frames, components))


class Loop:
    """Predicts the rows of a block in closed loop."""

    def __init__(self, known: int, targets: int, leading: int = LEADING) -> None:
        self._known = known
        self._moments = np.zeros((known + min(targets, leading), known + targets))

    def begin(self, known: Matrix, field: Matrix, step: float) -> Loop:
        """Learn, before the first row, from vertices around: what is known there, shape (m, k), and a field, (m, r)."""
        if known.shape != (len(field), self._known) or field.shape[1] != self._moments.shape[1] - self._known:
            raise ValueError(f"{known.shape} known and {field.shape} columns, of {self._moments.shape[1]}")
        width = self._moments.shape[1]
        _kernels.learn_around(
            np.ascontiguousarray(known),
            np.ascontiguousarray(field),
            self._moments,
            step,
            RULES,
            np.empty(width),
            np.empty(width),
        )
        return self

    def search(
        self, known: Matrix, targets: Matrix, step: float, prices: Prices, weight: float
    ) -> tuple[Levels, Matrix]:
        """Choose levels for `targets`, shape (c, r), given `known`, shape (c, k)."""
        levels, decoded = np.zeros(targets.shape, np.int32), np.empty(targets.shape)
        coded, width = targets.shape[1], self._moments.shape[1]
        self._check(known, levels)
        _kernels.search_rows(
            np.ascontiguousarray(known),
            np.ascontiguousarray(targets),
            prices.reshape(-1),
            weight,
            levels,
            decoded,
            self._moments,
            step,
            RULES,
            np.zeros(self._moments.shape),
            np.empty(width),
            np.empty((2 * STATES + 1, width)),
            np.empty((coded, STATES)),
            np.empty((coded, STATES), np.int32),
            np.zeros((coded, STATES), np.uint8),
        )
        if levels.size and max(levels.max(), -levels.min()) >= LARGEST_LEVEL:
            raise OptionError(f"a step of {step:g} is too fine for motion that far; choose a coarser one")
        return levels, decoded

    def decode(self, known: Matrix, levels: Levels, step: float) -> Matrix:
        """What the levels, shape (c, r), stand for."""
        self._check(known, levels)
        decoded, width = np.empty(levels.shape), self._moments.shape[1]
        _kernels.follow_rows(
            np.ascontiguousarray(known),
            np.ascontiguousarray(levels),
            decoded,
            self._moments,
            step,
            RULES,
            np.zeros(self._moments.shape),
            np.empty(width),
            np.empty(width),
        )
        if not np.isfinite(decoded).all():
            raise NumericError("the levels reconstruct to coefficients that are not finite")
        return decoded

    def copy(self) -> Loop:
        """An independent copy of the present state."""
        twin = Loop(self._known, 0)
        twin._moments = self._moments.copy()
        return twin

    def _check(self, known: Matrix, levels: Levels) -> None:
        if known.shape != (len(levels), self._known) or levels.shape[1] != self._moments.shape[1] - self._known:
            raise ValueError(f"{known.shape} known and {levels.shape} unknown columns, of {self._moments.shape[1]}")
