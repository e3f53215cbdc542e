"""Adaptive coding of quantized coefficients, method 1: mixed contexts from frequency, neighbours and the block before.

The magnitudes of a block's spectrum fall with frequency, resemble each other between neighbouring frequencies and
coordinates, and resemble those of the previous block. Each of these says something about the next coefficient; the
mixer of `bitstream.entropy` learns how much. All arithmetic is on integers.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.entropy import (
    Bank,
    code_signed,
    finish_reading,
    finish_writing,
    leaf,
    make_bank,
    reset_bank,
    signed_span,
    start_reading,
    start_writing,
)

Levels = npt.NDArray[np.int32]

_INPUTS = 6
_UNARY = 14
_SPAN = signed_span(_UNARY)
_BANDS = 24
_STEPS = 12
_CONTEXTS = (3 * _BANDS, _STEPS * 4, _STEPS * 6, _STEPS * _STEPS, _STEPS * _STEPS, _STEPS * 6)
_BASES = np.concatenate([[0], np.cumsum(_CONTEXTS)]).astype(np.int64) * _SPAN
_SELECTORS = 3 * _SPAN
MAX_LEVEL = (1 << 23) - 1
"""Largest magnitude of a quantized coefficient."""


@dataclass
class CoefficientModel:
    """What a chain of blocks has taught the coder; encoder and decoder each keep one per chain.

    Attributes
    ----------
    bank : Bank
        Adaptive probabilities.
    previous : int32 array, shape (width, 3)
        Magnitudes in the block before, zero where it had fewer coefficients.
    """

    width: int
    bank: Bank = field(init=False)
    previous: Levels = field(init=False)

    def __post_init__(self) -> None:
        self.bank = make_bank(int(_BASES[-1]), _SELECTORS, _INPUTS, limit=400, rate=6)
        reset_bank(self.bank)
        self.previous = np.zeros((self.width + 2, 3), np.int32)


def encode_coefficients(model: CoefficientModel, levels: Levels) -> bytes:
    """Code one block's quantized coefficients, shape (c_i, 3), each coordinate a column; updates `model`."""
    coder = start_writing(16 * levels.size + 64)
    _code_block(coder, model.bank, model.previous, levels)
    return finish_writing(coder)


def decode_coefficients(model: CoefficientModel, payload: bytes, count: int) -> Levels:
    """Twin of `encode_coefficients`: read `count` rows.

    Raises
    ------
    TruncatedError, CorruptError
        If the payload is not exactly one block long.
    """
    levels = np.zeros((count, 3), np.int32)
    coder = start_reading(payload)
    _code_block(coder, model.bank, model.previous, levels)
    finish_reading(coder)
    return levels


@leaf
def _class(value):  # type: ignore[no-untyped-def]
    """Magnitude class 0 .. 11 of a sum of magnitudes."""
    if value < 5:
        return value
    if value < 7:
        return 5
    if value < 10:
        return 6
    if value < 15:
        return 7
    if value < 25:
        return 8
    if value < 50:
        return 9
    if value < 150:
        return 10
    return 11


@leaf
def _band(j):  # type: ignore[no-untyped-def]
    """Frequency band 0 .. 23 of row j."""
    if j < 8:
        return j
    if j < 16:
        return 8 + (j - 8) // 2
    if j < 64:
        return 12 + (j - 16) // 8
    if j < 128:
        return 18 + (j - 64) // 16
    return min(23, 22 + (j - 128) // 128)


@njit(cache=True, nogil=True)
def _code_block(coder, bank, previous, levels):  # type: ignore[no-untyped-def]
    count = levels.shape[0]
    contexts = np.empty(_INPUTS, np.int64)
    recent = np.zeros(3, np.int64)
    for j in range(count):
        band = _band(j)
        for d in range(3):
            one = abs(levels[j - 1, d]) if j > 0 else 0
            two = abs(levels[j - 2, d]) if j > 1 else 0
            three = abs(levels[j - 3, d]) if j > 2 else 0
            e, f = (d + 1) % 3, (d + 2) % 3
            other = abs(levels[j, e]) if e < d else (abs(levels[j - 1, e]) if j > 0 else 0)
            another = abs(levels[j, f]) if f < d else (abs(levels[j - 1, f]) if j > 0 else 0)
            before = 2 * previous[j, d] + previous[j + 1, d] + (previous[j - 1, d] if j > 0 else 0)
            local = 2 * one + two + three
            across = other + another
            slow = recent[d] >> 4
            contexts[0] = _BASES[0] + _SPAN * (3 * band + d)
            contexts[1] = _BASES[1] + _SPAN * (_STEPS * min(3, band // 6) + _class(local))
            contexts[2] = _BASES[2] + _SPAN * (_STEPS * min(5, band // 4) + _class(before))
            contexts[3] = _BASES[3] + _SPAN * (_STEPS * _class(local) + _class(across))
            contexts[4] = _BASES[4] + _SPAN * (_STEPS * _class(before) + _class(slow))
            contexts[5] = _BASES[5] + _SPAN * (
                _STEPS * min(5, band // 4) + _class((local + 2 * across + before + slow + 1) >> 1)
            )
            level = code_signed(
                coder, bank, contexts, _SPAN * (0 if j == 0 else (1 if j < 12 else 2)), _UNARY, levels[j, d]
            )
            levels[j, d] = level
            recent[d] += ((min(abs(level), 4096) << 6) - recent[d]) >> 2
    for j in range(previous.shape[0] - 2):
        for d in range(3):
            previous[j, d] = abs(levels[j, d]) if j < count else 0
