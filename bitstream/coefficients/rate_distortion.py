"""Choosing levels by what they cost: the encoder's side of the adaptive coder, no part of the format.

The trellis leaves many ways to quantize a block. The one with the least sum of squared error and a weight times the
bits is found by dynamic programming (Viterbi): for each state of the trellis the best way there survives. Bits are
those that the model in its present state would spend; each survivor has its own neighbours as contexts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.coefficients.adaptive import (
    MAX_LEVEL,
    CoefficientModel,
    Levels,
    first_node,
    second_node,
    set_contexts,
    size_node,
)
from bitstream.coefficients.contexts import NEIGHBOURS, Past, note_level, take_over
from bitstream.coefficients.priors import EXPECTATIONS
from bitstream.coefficients.trellis import STATES, following, grid, point_of_level
from bitstream.entropy.range_coder import ONE, leaf, mixed_probability
from bitstream.errors import OptionError

TARGET_UNIT = 256
"""Targets are in 1 / TARGET_UNIT of a quantization step."""

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
        If there are more rows than the model is made for, or a target is beyond MAX_LEVEL steps.
    """
    if len(targets) > model.width or np.abs(targets).max(initial=0) > MAX_LEVEL * TARGET_UNIT:
        raise OptionError(f"targets must be at most {model.width} rows of levels up to {MAX_LEVEL}")
    price = weight * TARGET_UNIT**2 / _BIT
    levels, kept = _search(model.bank, model.past, model.expectations, targets, price)
    dropped = np.square(targets[::-1].astype(np.float64)).sum(axis=1).cumsum()[::-1]
    return Choice(levels, 1 + int(np.argmin(kept + np.append(dropped[1:], 0.0))) if len(targets) else 0)


@njit(cache=True, nogil=True)
def _search(bank, past, expectations, targets, price):  # type: ignore[no-untyped-def]
    """The best levels for all rows, and the least error and bits together up to each row."""
    rows = targets.shape[0]
    ways = np.zeros((rows, 3, STATES), np.int64)
    origins = np.zeros((rows, 3, STATES), np.int64)
    survivors = np.zeros((2, STATES, *past.current.shape), np.int64)
    costs = np.full((2, STATES), np.inf)
    contexts = np.empty(EXPECTATIONS, np.int64)
    inputs = np.empty(NEIGHBOURS, np.int64)
    new, old = 0, 1
    costs[new, 0] = 0.0
    kept = np.zeros(rows)
    for row in range(rows):
        for coordinate in range(3):
            new, old = old, new
            costs[new] = np.inf
            target = abs(targets[row, coordinate])
            for state in range(STATES):
                if costs[old, state] == np.inf:
                    continue
                around = Past(survivors[old, state], past.before, past.usual, past.blocks)
                selector = set_contexts(around, expectations, row, coordinate, inputs, contexts)
                below = (2 * target + TARGET_UNIT * grid(state)) // (2 * TARGET_UNIT)
                for candidate in range(3 if target > 0 else 1):  # what is zero stays zero: flat meshes stay flat
                    level = min(below + candidate, MAX_LEVEL) if candidate < 2 else 0
                    error = target - 0.5 * TARGET_UNIT * point_of_level(state, level)
                    cost = error * error + price * _bits(bank, contexts, selector, grid(state), level)
                    after = following(state, level)
                    if costs[old, state] + cost < costs[new, after]:
                        costs[new, after] = costs[old, state] + cost
                        ways[row, coordinate, after] = level
                        origins[row, coordinate, after] = state
            for state in range(STATES):
                if costs[new, state] < np.inf:
                    origin = origins[row, coordinate, state]
                    now = Past(survivors[new, state], past.before, past.usual, past.blocks)
                    take_over(now, Past(survivors[old, origin], past.before, past.usual, past.blocks), row)
                    note_level(now, row, coordinate, ways[row, coordinate, state])
        kept[row] = costs[new].min()
    levels = np.zeros((rows, 3), np.int32)
    last = np.argmin(costs[new])
    for row in range(rows - 1, -1, -1):
        for coordinate in range(2, -1, -1):
            level = ways[row, coordinate, last]
            levels[row, coordinate] = level if targets[row, coordinate] >= 0 else -level
            last = origins[row, coordinate, last]
    return levels, kept


@leaf
def _bits(bank, contexts, selector, grid, magnitude):  # type: ignore[no-untyped-def]
    """What `code_level` would spend on a magnitude, in 1 / _BIT bits, with the sign."""
    size = 0
    total = np.int64(0)
    while magnitude >> size > 0:
        total += _decision(bank, contexts, size_node(size, grid), selector, 1)
        size += 1
    total += _decision(bank, contexts, size_node(size, grid), selector, 0)
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
