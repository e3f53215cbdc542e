"""Adaptive coding of quantized coefficients, method 1: what the neighbours let expect, and what was learnt before.

A level is the size of its magnitude in bits (in unary), up to two bits below the leading one, the rest of the bits
and the sign, these last two as they are. Every other decision is predicted from three expectations of the magnitude
(see `bitstream.coefficients.contexts`), each with adaptive probabilities of its own, mixed as
`bitstream.entropy.range_coder` does. Levels stand for points on two grids, by the rule of
`bitstream.coefficients.trellis`, and zeros and ones are told apart by grid, too. A chain starts from the
probabilities and weights of `bitstream.coefficients.priors`. All arithmetic is on integers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.coefficients.contexts import BINS, NEIGHBOURS, Past, copy_past, make_past
from bsm.bitstream.coefficients.priors import EXPECTATIONS, NODES, SELECTORS, Experience, coordinate_experience
from bsm.bitstream.coefficients.trellis import Levels
from bsm.bitstream.entropy.range_coder import (
    Bank,
    Coder,
    copy_bank,
    finish_reading,
    finish_writing,
    make_bank,
    overran,
    start_reading,
    start_writing,
    unsigned_span,
)
from bsm.bitstream.errors import CorruptError, OptionError

MAX_LEVEL = (1 << 23) - 1
"""Largest magnitude of a quantized coefficient."""

_ROWS_UNARY = 8
_ROWS_SPAN = unsigned_span(_ROWS_UNARY)
_BYTES_PER_LEVEL = 64  # 24 decisions of at most two bytes each, and bits as they are


@dataclass
class CoefficientModel:
    """What a chain of blocks has taught the coder; encoder and decoder each keep one per chain."""

    width: int
    experience: Experience = field(default_factory=coordinate_experience)
    bank: Bank = field(init=False)
    rows: Bank = field(init=False)
    past: Past = field(init=False)
    missing: npt.NDArray[np.int64] = field(init=False)
    expectations: npt.NDArray[np.int32] = field(init=False)

    def __post_init__(self) -> None:
        self.bank = make_bank(EXPECTATIONS * BINS * NODES, SELECTORS * NODES, EXPECTATIONS, limit=400, rate=4)
        self.bank.slots[:] = self.experience.first_slots
        self.bank.weights[:] = self.experience.first_weights
        self.rows = make_bank(17 * _ROWS_SPAN, _ROWS_SPAN, 2, limit=60)
        self.past = make_past(self.width)
        self.missing = np.zeros(1, np.int64)
        self.expectations = self.experience.expectations.astype(np.int32).reshape(-1, NEIGHBOURS)

    @property
    def parts(self) -> tuple[Bank, Bank, Past, npt.NDArray[np.int32], npt.NDArray[np.int64], int]:
        """All of it as a kernel takes it; `expectations` and `missing` have the shapes (e, NEIGHBOURS) and (1,)."""
        return self.bank, self.rows, self.past, self.expectations, self.missing, self.width

    def copy(self) -> CoefficientModel:
        """An independent copy of the present state."""
        twin = CoefficientModel(self.width, self.experience)
        twin.bank, twin.rows = copy_bank(self.bank), copy_bank(self.rows)
        twin.past = copy_past(self.past)
        twin.missing = self.missing.copy()
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


def encode_blocks(model: CoefficientModel, blocks: Sequence[Levels]) -> bytes:
    """Code consecutive blocks, each of shape (c_i, 3), into one payload, with the number of rows of each."""
    coder = start_writing(sum(_BYTES_PER_LEVEL * (levels.size + 1) for levels in blocks))
    for levels in blocks:
        _check_levels(model, levels)
        _kernels.code_rows(coder, model.rows, model.missing, model.width, len(levels))
        _code_block(coder, model, np.array(levels, np.int32, order="C"))
    return finish_writing(coder)


def decode_blocks(model: CoefficientModel, payload: bytes, count: int) -> list[Levels]:
    """Twin of `encode_blocks`: read `count` blocks, each of shape (c_i, 3)."""
    coder = start_reading(payload)
    blocks: list[Levels] = []
    for _ in range(count):
        blocks.append(np.zeros((_read_rows(coder, model, 1), 3), np.int32))
        _code_block(coder, model, blocks[-1])
        if overran(coder):
            break
    finish_reading(coder)
    return blocks


def encode_layers(model: CoefficientModel, levels: Levels, over: CoefficientModel, above: Levels) -> bytes:
    """Code the levels of a block, shape (c, 3), and those of a layer above them, shape (r, 3), into one payload."""
    _check_levels(model, levels)
    _check_levels(over, above)
    coder = start_writing(_BYTES_PER_LEVEL * (levels.size + above.size + 1))
    coded, over_it = np.array(levels, np.int32, order="C"), np.array(above, np.int32, order="C")
    _kernels.code_layers(coder, model.parts, coded, over.parts, len(over_it), over_it)
    return finish_writing(coder)


def decode_layers(model: CoefficientModel, over: CoefficientModel, payload: bytes, count: int) -> tuple[Levels, Levels]:
    """Twin of `encode_layers`: read `count` rows, shape (count, 3), and the layer above them, shape (r, 3)."""
    if count > model.width:
        raise CorruptError(f"{count} coefficients where at most {model.width} are announced")
    coder = start_reading(payload)
    levels, above = np.zeros((count, 3), np.int32), np.zeros((over.width, 3), np.int32)
    rows = _kernels.code_layers(coder, model.parts, levels, over.parts, 0, above)
    if overran(coder) or 0 <= rows <= over.width:
        finish_reading(coder)
        return levels, above[:rows]
    raise _too_many_rows(over, rows, 0)


def _code_block(coder: Coder, model: CoefficientModel, levels: Levels) -> None:
    _kernels.code_block(coder, model.bank, model.past, model.expectations, levels)


def _read_rows(coder: Coder, model: CoefficientModel, least: int) -> int:
    rows = _kernels.code_rows(coder, model.rows, model.missing, model.width, 0)
    if overran(coder):
        finish_reading(coder)
    if not least <= rows <= model.width:
        raise _too_many_rows(model, rows, least)
    return rows


def _too_many_rows(model: CoefficientModel, rows: int, least: int) -> CorruptError:
    return CorruptError(f"{rows} rows of levels where {least} to {model.width} are announced")


def _check_levels(model: CoefficientModel, levels: Levels) -> None:
    if len(levels) > model.width or np.abs(levels.astype(np.int64)).max(initial=0) > MAX_LEVEL:
        raise OptionError(f"levels must be at most {model.width} rows of magnitudes up to {MAX_LEVEL}")
