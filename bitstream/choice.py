"""Choosing levels by what they cost: the encoder's side of the adaptive coder, no part of the format.

For each coefficient the levels around it are weighed, squared error plus a weight times the bits that the model in its
present state would spend. What a choice does to the cost of later levels is left aside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.adaptive import (
    MAX_LEVEL,
    CoefficientModel,
    Levels,
    code_level,
    first_node,
    second_node,
    set_contexts,
    size_node,
)
from bitstream.entropy import ONE, leaf, mixed_probability, start_writing
from bitstream.errors import OptionError
from bitstream.experience import EXPECTATIONS
from bitstream.neighbourhood import NEIGHBOURS, note_level

TARGET_UNIT = 256
"""Targets are in 1 / TARGET_UNIT of a level."""

_BIT = 256
_SHIFT = 4
_COSTS = np.array(
    [round(_BIT * -np.log2(min(max(i, 0.5) * (1 << _SHIFT) / ONE, 1.0))) for i in range((ONE >> _SHIFT) + 1)], np.int64
)


@dataclass(frozen=True, eq=False)
class Choice:
    """Levels for one block.

    Attributes
    ----------
    levels : int32 array, shape (c, 3)
        For all rows.
    width : int
        Rows that are worth their bits, at least 1: with the rows behind left out, error and bits together are least.
    """

    levels: Levels
    width: int


def choose_levels(model: CoefficientModel, targets: npt.NDArray[np.int64], weight: float) -> Choice:
    """Choose the levels that `encode_coefficients` should code next; `model` stays as it is.

    Parameters
    ----------
    model : CoefficientModel
        As it is before the block.
    targets : int64 array, shape (c, 3)
        Coefficients in units of 1 / TARGET_UNIT of the quantization step.
    weight : float
        Squared steps that a bit is worth.

    Raises
    ------
    OptionError
        If there are more rows than the model is made for, or a target beyond MAX_LEVEL.
    """
    if len(targets) > model.width or (targets.size and np.abs(targets).max() > MAX_LEVEL * TARGET_UNIT):
        raise OptionError(f"targets must be at most {model.width} rows of levels up to {MAX_LEVEL}")
    state = model.copy()
    levels = np.zeros(targets.shape, np.int32)
    kept = np.zeros(len(targets))
    price = weight * TARGET_UNIT**2 / _BIT
    coder = start_writing(64 * targets.size)
    _choose(coder, state.bank, state.past, state.expectations, targets, price, levels, kept)
    dropped = np.square(targets.astype(np.float64)).sum(axis=1)
    width = 1 + int(np.argmin(np.cumsum(kept - dropped))) if len(targets) else 0
    return Choice(levels, width)


@njit(cache=True, nogil=True)
def _choose(coder, bank, past, expectations, targets, price, levels, kept):  # type: ignore[no-untyped-def]
    contexts = np.empty(EXPECTATIONS, np.int64)
    inputs = np.empty(NEIGHBOURS, np.int64)
    for row in range(targets.shape[0]):
        for coordinate in range(3):
            selector = set_contexts(past, expectations, row, coordinate, inputs, contexts)
            target = abs(targets[row, coordinate])
            below = target // TARGET_UNIT
            level, least = 0, np.inf
            for candidate in (below, min(below + 1, MAX_LEVEL), 0):
                error = float(target - TARGET_UNIT * candidate)
                cost = error * error + price * _bits(bank, contexts, selector, candidate)
                if cost < least:
                    level, least = candidate, cost
            if targets[row, coordinate] < 0:
                level = -level
            levels[row, coordinate] = level
            kept[row] += least
            code_level(coder, bank, contexts, selector, level)
            note_level(past, row, coordinate, level)


@leaf
def _bits(bank, contexts, selector, magnitude):  # type: ignore[no-untyped-def]
    """What `code_level` would spend on a magnitude, in 1 / _BIT bits, with the sign."""
    size = 0
    total = np.int64(0)
    while magnitude >> size > 0:
        total += _decision(bank, contexts, size_node(size), selector, 1)
        size += 1
    total += _decision(bank, contexts, size_node(size), selector, 0)
    if size > 0:
        total += _BIT
    if size > 1:
        first = (magnitude >> (size - 2)) & 1
        total += _decision(bank, contexts, first_node(size), selector, first)
        if size > 2:
            bit = (magnitude >> (size - 3)) & 1
            total += _decision(bank, contexts, second_node(size, first), selector, bit) + _BIT * (size - 3)
    return total


@leaf
def _decision(bank, contexts, node, selector, bit):  # type: ignore[no-untyped-def]
    probability = mixed_probability(bank, contexts, node, selector)
    return _COSTS[(probability if bit != 0 else ONE - probability) >> _SHIFT]
