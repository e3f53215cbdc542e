"""Adaptive coding of quantized coefficients, method 1: what the neighbours let expect, and what was learnt before.

A level is the size of its magnitude in bits (in unary), up to two bits below the leading one, the rest of the bits
and the sign, these last two as they are. Every other decision is predicted from three expectations of the magnitude
(see `bitstream.coefficients.contexts`), each with adaptive probabilities of its own, mixed as
`bitstream.entropy.range_coder` does. Levels stand for points on two grids, by the rule of
`bitstream.coefficients.trellis`, and zeros and ones are told apart by grid, too. A chain starts from the
probabilities and weights of `bitstream.coefficients.priors`. All arithmetic is on integers.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.coefficients.contexts import BINS, NEIGHBOURS, Past, copy_past, make_past
from bsm.bitstream.coefficients.priors import EXPECTATIONS, NODES, SELECTORS, Experience, shipped_experience
from bsm.bitstream.coefficients.trellis import Levels
from bsm.bitstream.entropy.range_coder import (
    Bank,
    Coder,
    copy_bank,
    finish_reading,
    finish_writing,
    make_bank,
    start_reading,
    start_writing,
)
from bsm.bitstream.errors import CorruptError, OptionError

MAX_LEVEL = (1 << 23) - 1
"""Largest magnitude of a quantized coefficient."""

_BYTES_PER_LEVEL = 64  # 24 decisions of at most two bytes each, and bits as they are


@dataclass
class CoefficientModel:
    """What a chain of blocks has taught the coder; encoder and decoder each keep one per chain."""

    width: int
    experience: Experience = field(default_factory=shipped_experience)
    bank: Bank = field(init=False)
    past: Past = field(init=False)
    expectations: npt.NDArray[np.int32] = field(init=False)

    def __post_init__(self) -> None:
        self.bank = make_bank(EXPECTATIONS * BINS * NODES, SELECTORS * NODES, EXPECTATIONS, limit=400, rate=4)
        self.bank.slots[:] = self.experience.first_slots
        self.bank.weights[:] = self.experience.first_weights
        self.past = make_past(self.width)
        self.expectations = self.experience.expectations.astype(np.int32).reshape(-1, NEIGHBOURS)

    def copy(self) -> CoefficientModel:
        """An independent copy of the present state."""
        twin = CoefficientModel(self.width, self.experience)
        twin.bank = copy_bank(self.bank)
        twin.past = copy_past(self.past)
        return twin


def encode_coefficients(model: CoefficientModel, levels: Levels) -> bytes:
    """Code one block's quantized coefficients, shape (c_i, 3), each coordinate a column; updates `model`."""
    _check_levels(model, levels)
    coder = start_writing(_BYTES_PER_LEVEL * levels.size)
    _code_block(coder, model, np.array(levels, np.int32, order="C"))
    return finish_writing(coder)


def decode_coefficients(model: CoefficientModel, payload: bytes, count: int) -> Levels:
    """Twin of `encode_coefficients`: read `count` rows, shape (count, 3)."""
    if count > model.width:
        raise CorruptError(f"{count} coefficients where at most {model.width} are announced")
    levels = np.zeros((count, 3), np.int32)
    coder = start_reading(payload)
    _code_block(coder, model, levels)
    finish_reading(coder)
    return levels


def _code_block(coder: Coder, model: CoefficientModel, levels: Levels) -> None:
    _kernels.code_block(coder, model.bank, model.past, model.expectations, levels)


def _check_levels(model: CoefficientModel, levels: Levels) -> None:
    if len(levels) > model.width or np.abs(levels.astype(np.int64)).max(initial=0) > MAX_LEVEL:
        raise OptionError(f"levels must be at most {model.width} rows of magnitudes up to {MAX_LEVEL}")
