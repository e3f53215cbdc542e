"""The mathematics of sequences: the temporal transform, and the closed loop that predicts and quantizes rows.

A sequence of T frames of n vertices is a matrix of n rows and 3T columns, the x of all frames, then y, then z. In
space it is transformed by the dictionaries of the blocks, which makes its rows frequencies; in time by a temporal basis
B of r columns (components), learnt from the frames and sent. What is left is a small matrix per block,
one row per spatial frequency, one column per component.

The columns of such a row are predicted from what the decoder knows: the same row of the first frame, whose shape
moves with every rigid motion of the block, and the columns before. The weights of this prediction are those that would
have predicted the rows before best, so that none are sent.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import NumericError, OptionError
from bsm.codec import _kernels
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.basis.orthogonal_iteration import cosine_columns

LEADING = 24
"""Columns of a row that help to predict the columns behind them."""
FORGETTING = 0.985
"""How much the past counts, per row, in the weights of the prediction."""
RIDGE = 0.005
"""Regularisation of the weights; half or twice of it costs 0.1 and 0.8 % (tools.constants)."""
NOISE = 30.0
"""Energy in squared steps that is added to that of a row before the row is weighed by the inverse of it;
half costs 0.3 %, twice saves 0.1 % (tools.constants)."""
DENSE_ROWS = 16
"""First rows of a block, each with weights of its own; behind them the weights are renewed every `RENEWAL` rows."""
RENEWAL = 8
LARGEST_LEVEL = (1 << 23) - 1
OCTAVE = 4
"""Exponents of the steps of a basis are in units of 1 / OCTAVE octaves."""


def trajectories(frames: Matrix) -> Matrix:
    """Frames, shape (T, n, 3), as a matrix of shape (n, 3T)."""
    return np.ascontiguousarray(frames.transpose(1, 2, 0).reshape(frames.shape[1], -1))


def frames_of(matrix: Matrix) -> Matrix:
    """Inverse of `trajectories`."""
    return np.ascontiguousarray(matrix.reshape(len(matrix), 3, -1).transpose(2, 0, 1))


def time_cosines(frames: int) -> Matrix:
    """The orthonormal cosine transform (DCT-II), shape (T, T): row t, column frequency."""
    columns = cosine_columns(frames, 0, frames) * np.sqrt(2.0 / frames)
    columns[:, :1] = np.sqrt(1.0 / frames)
    return np.asarray(columns)


def basis_steps(exponents: npt.NDArray[np.int32]) -> Matrix:
    """Quantization step of each component of a learnt basis: 2^(-exponent / OCTAVE)."""
    return np.exp2(-exponents.astype(np.float64) / OCTAVE)


def quantize_basis(basis: Matrix, exponents: npt.NDArray[np.int32], rounding: float) -> Levels:
    """Levels of a basis, shape (3T, r), as cosines over time: shape (3, T, r)."""
    rows, components = basis.shape
    spectrum = time_cosines(rows // 3).T @ basis.reshape(3, rows // 3, components) / basis_steps(exponents)
    magnitude = np.minimum(np.floor(np.abs(spectrum) + rounding), LARGEST_LEVEL)
    return np.ascontiguousarray(np.copysign(magnitude, spectrum).astype(np.int32))


def dequantize_basis(levels: Levels, exponents: npt.NDArray[np.int32]) -> Matrix:
    """The basis of `quantize_basis`, shape (3T, r), as the decoder has it; its columns are nearly orthonormal."""
    _, frames, components = levels.shape
    basis = time_cosines(frames) @ (levels * basis_steps(exponents))
    return np.ascontiguousarray(basis.reshape(3 * frames, components))


class Loop:
    """Predicts the rows of one block after the other, or of one block frame after frame, in closed loop.

    Encoder and decoder call the same kernel, `encode` and `decode` differ in who brings the levels.

    Parameters
    ----------
    known : int
        Columns k that the decoder knows of every row.
    targets : int
        Columns r to be coded.
    """

    def __init__(self, known: int, targets: int) -> None:
        self._known = known
        self._moments = np.zeros((known + min(targets, LEADING), known + targets))

    def encode(self, known: Matrix, targets: Matrix, step: float, rounding: float) -> tuple[Levels, Matrix]:
        """Quantize `targets`, shape (c, r), given `known`, shape (c, k).

        Returns
        -------
        levels : int32 array, shape (c, r)
        decoded : float64 array, shape (c, r)
            What `decode` makes of the levels.

        Raises
        ------
        OptionError
            If a level is larger than can be coded.
        """
        levels = np.zeros(targets.shape, np.int32)
        decoded = self._run(known, np.ascontiguousarray(targets), levels, step, rounding, True)
        if levels.size and max(levels.max(), -levels.min()) >= LARGEST_LEVEL:
            raise OptionError(f"a step of {step:g} is too fine for motion that far; choose a coarser one")
        return levels, decoded

    def decode(self, known: Matrix, levels: Levels, step: float) -> Matrix:
        """Twin of `encode`.

        Raises
        ------
        NumericError
            If the levels reconstruct to something that is not finite.
        """
        levels = np.array(levels, np.int32, order="C")
        decoded = self._run(known, np.zeros(levels.shape), levels, step, 0.0, False)
        if not np.isfinite(decoded).all():
            raise NumericError("the levels reconstruct to coefficients that are not finite")
        return decoded

    def _run(
        self, known: Matrix, targets: Matrix, levels: Levels, step: float, rounding: float, encoding: bool
    ) -> Matrix:
        decoded = np.empty(targets.shape)
        size, width = self._moments.shape
        if known.shape != (len(targets), self._known) or targets.shape[1] != width - self._known:
            raise ValueError(f"{known.shape} known and {targets.shape} unknown columns, of {width}")
        _kernels.follow_rows(
            np.ascontiguousarray(known),
            targets,
            levels,
            decoded,
            self._moments,
            step,
            rounding,
            encoding,
            (FORGETTING, RIDGE, NOISE, float(LARGEST_LEVEL), DENSE_ROWS, RENEWAL),
            np.zeros((size, width)),
            np.empty(width),
            np.empty(width),
        )
        return decoded
