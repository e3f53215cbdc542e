"""Adaptive coding of quantized coefficients (M 9), by expectations from their neighbors and by learnt statistics."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm._core import bitstream as _kernels
from bsm._core.bitstream import bank_plan, constant, priors
from bsm.bitstream.entropy import range_coder as entropy
from bsm.bitstream.errors import OptionError

TARGET_UNIT = constant("TARGET_UNIT")  # targets are in 1 / TARGET_UNIT of a quantization step


def nearest_levels(targets: npt.NDArray[np.int64]) -> Levels:
    """Return the levels nearest to targets, shape (c, 3), on the trellis's two grids."""
    if np.abs(targets).max(initial=0) > MAX_LEVEL * TARGET_UNIT:
        raise OptionError(f"targets must be levels up to {MAX_LEVEL}")
    levels = np.empty(targets.shape, np.int32)
    ways, origins = np.empty((levels.size, STATES), np.int32), np.empty((levels.size, STATES), np.uint8)
    _kernels.nearest_levels(np.ascontiguousarray(targets, np.int64).reshape(-1), ways, origins, levels.reshape(-1))
    return levels


Magnitudes = npt.NDArray[np.int32]
_ABOVE, _BEYOND = constant("ABOVE"), constant("BEYOND")  # rows of zeros around those of the frequencies


class Past(NamedTuple):
    """Magnitudes of a chain's coefficients so far; row _ABOVE is the lowest frequency, each column a coordinate."""

    current: Magnitudes
    before: Magnitudes
    usual: Magnitudes
    blocks: npt.NDArray[np.int64]


Levels = npt.NDArray[np.int32]
STATES = constant("TRELLIS_STATES")  # the numbers of the last three grids, the latest in the lowest bit


class Experience(NamedTuple):
    """Learned numbers, in the order of the specification."""

    expectations: npt.NDArray[np.uint16]
    mixing: npt.NDArray[np.int16]
    slots: npt.NDArray[np.uint16]


@cache
def shipped_experience() -> Experience:
    """Return the statistics of coefficients before the first one; part of the format."""
    slot_count, selectors, inputs, *_ = bank_plan("code_block")
    places = [-slot_count - selectors * inputs, -slot_count]
    expectations, mixing, slots = np.split(np.frombuffer(priors(), "<u2"), places)
    return Experience(expectations, mixing.view(np.int16), slots)


MAX_LEVEL = constant("MAX_LEVEL")  # largest magnitude of a quantized coefficient
_BYTES_PER_LEVEL = 64  # 24 decisions of at most two bytes each, and bits as they are


@dataclass
class CoefficientModel:
    """Statistics that a chain of blocks has taught the coder; encoder and decoder each keep one per chain."""

    width: int
    experience: Experience = field(default_factory=shipped_experience)

    def __post_init__(self) -> None:
        self.bank = entropy.bank_of("code_block")
        expectations, mixing, slots = (array.astype(np.int64) for array in self.experience)
        self.bank.slots[:] = (slots >> 4) << 20 | 1 << 19 | (slots & 15) << 2
        self.bank.weights[:] = mixing.reshape(self.bank.weights.shape) << 4
        blank = np.zeros((_ABOVE + self.width + _BEYOND, 3), np.int32)
        self.past = Past(blank, blank.copy(), blank.copy(), np.zeros(1, np.int64))
        self.expectations = expectations.astype(np.int32).reshape(-1, constant("NEIGHBORS"))


def encode_coefficients(model: CoefficientModel, levels: Levels) -> bytes:
    """Code one block's quantized coefficients, shape (c_i, 3), each coordinate a column; updates `model`."""
    if len(levels) > model.width or np.abs(levels.astype(np.int64)).max(initial=0) > MAX_LEVEL:
        raise OptionError(f"levels must be at most {model.width} rows of magnitudes up to {MAX_LEVEL}")
    coder = entropy.start_writing(_BYTES_PER_LEVEL * levels.size)
    own = np.array(levels, np.int32, order="C")
    _kernels.code_block(coder, model.bank, model.past, model.expectations, own)
    return entropy.finish_writing(coder)
