"""Choosing levels by Viterbi: squared error and a weight times the adaptive coder's bits; no part of the format."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.coefficients.adaptive import MAX_LEVEL, STATES, CoefficientModel, Levels
from bsm.bitstream.entropy.range_coder import ONE
from bsm.bitstream.errors import OptionError

TARGET_UNIT = 256  # targets are in 1 / TARGET_UNIT of a quantization step

_BIT = 256
_SHIFT = 4
_PROBABILITIES = np.maximum(np.arange((ONE >> _SHIFT) + 1), 0.5) * (1 << _SHIFT) / ONE
COSTS = np.rint(_BIT * -np.log2(np.minimum(_PROBABILITIES, 1.0))).astype(np.int64)
"""What a decision costs by its probability, in 1 / 256 bit."""


@dataclass(frozen=True, eq=False)
class Choice:
    levels: Levels
    width: int


def choose_levels(model: CoefficientModel, targets: npt.NDArray[np.int64], weight: float) -> Choice:
    """Choose the levels that `encode_coefficients` should code next; `model` stays as it is."""
    if len(targets) > model.width or np.abs(targets).max(initial=0) > MAX_LEVEL * TARGET_UNIT:
        raise OptionError(f"targets must be at most {model.width} rows of levels up to {MAX_LEVEL}")
    price = weight * TARGET_UNIT**2 / _BIT
    rows, targets = len(targets), np.ascontiguousarray(targets, np.int64)
    levels, kept = np.empty((rows, 3), np.int32), np.empty(rows)
    ways, origins = np.empty((3 * rows, STATES), np.int32), np.empty((3 * rows, STATES), np.uint8)
    _kernels.search_levels(
        model.bank, model.past, model.expectations, targets, price, COSTS, ways, origins, levels, kept
    )
    dropped = np.square(targets[::-1].astype(np.float64)).sum(axis=1).cumsum()[::-1]
    return Choice(levels, 1 + int(np.argmin(kept + np.append(dropped[1:], 0.0))) if len(targets) else 0)
