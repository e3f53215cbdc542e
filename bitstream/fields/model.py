"""The adaptive state that all fields share: of what codes an integer (`value.h`), and of learnt sums (`learner.h`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

PREDICTIONS = 7
TERMS = 7

_CONTEXTS = 6
_CONTEXT_SIZE = 512
_NODES = 66
_WEIGHT_ROWS = _NODES + 3 * 6
_INPUTS = PREDICTIONS + _CONTEXTS + 1
_HIT_CONTEXTS = 32
_SCALE_CONTEXTS = 512

MODEL_BYTES = 4 * (_CONTEXTS * _CONTEXT_SIZE * _NODES + PREDICTIONS * (_HIT_CONTEXTS + 2 * _SCALE_CONTEXTS))
"""About what a model takes."""


class ValueModel(NamedTuple):
    """What is learnt about integers (V 3); the struct of that name in `value.h`."""

    slots: npt.NDArray[np.uint32]
    hits: npt.NDArray[np.uint32]
    weights: npt.NDArray[np.int32]
    scales: npt.NDArray[np.int32]


def make_model() -> ValueModel:
    """A model that has learnt nothing."""
    weights = np.zeros((_WEIGHT_ROWS, _INPUTS), np.int32)
    weights[:_NODES, :PREDICTIONS] = (1 << 16) * 9 // (8 * PREDICTIONS)
    weights[:_NODES, PREDICTIONS:-1] = 6000
    return ValueModel(
        np.full(_CONTEXTS * _CONTEXT_SIZE * _NODES, 1 << 31, np.uint32),
        np.full(PREDICTIONS * _HIT_CONTEXTS, 1 << 28, np.uint32),
        weights,
        np.zeros((PREDICTIONS * _SCALE_CONTEXTS, 2), np.int32),
    )


def make_learners(start: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """Learners that have learnt nothing."""
    weights = np.asarray(start, np.int64)
    empty = np.zeros((len(weights), TERMS * (TERMS + 1)), np.int64)
    return np.ascontiguousarray(np.hstack([empty, weights, weights]))
