"""Levels that are chosen by what they cost, and what the decoder makes of them."""

from __future__ import annotations

import numpy as np
import pytest

from bsm import OptionError
from bsm.bitstream.coefficients.matrices import PRICED, make_level_bank
from bsm.codec.sequence import row_prediction
from bsm.codec.sequence.row_prediction import LevelWriter, Loop

ROWS, COLUMNS, KNOWN, STEP = 80, 30, 3, 0.01


def rows_of(seed: int, scale: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """Known columns, and others that they say something about."""
    random = np.random.default_rng(seed)
    decay = scale / (1 + np.arange(ROWS))[:, None]
    known = random.normal(size=(ROWS, KNOWN)) * decay
    targets = known @ random.normal(size=(KNOWN, COLUMNS)) + 0.3 * random.normal(size=(ROWS, COLUMNS)) * decay
    return known, targets


def free(targets: np.ndarray) -> np.ndarray:
    return np.zeros((*targets.shape, 2, PRICED), np.int16)


def test_two_grids_are_better_than_one_where_bits_are_free() -> None:
    known, targets = rows_of(1)
    _, decoded = Loop(KNOWN, COLUMNS).search(known, targets, STEP, free(targets), 0.0)
    error = np.sqrt(np.mean(np.square(decoded - targets)))
    assert error < 0.9 * STEP / np.sqrt(12)
    assert np.abs(decoded - targets).max() < STEP


def written(weight: float, monkeypatch: pytest.MonkeyPatch) -> tuple[int, float]:
    """Bytes and squared error in steps."""
    monkeypatch.setattr(row_prediction, "WEIGHT", weight)
    writer, error = LevelWriter(make_level_bank(), COLUMNS), 0.0
    for seed in range(4):
        known, targets = rows_of(seed, 0.3)
        error += float(np.square(writer.write(Loop(KNOWN, COLUMNS), known, targets, STEP) - targets).sum())
    return len(writer.finish()), error / STEP**2


def test_a_bit_is_worth_its_price(monkeypatch: pytest.MonkeyPatch) -> None:
    dear, cheap = written(0.2, monkeypatch), written(0.01, monkeypatch)
    assert dear[0] < cheap[0] and dear[1] > cheap[1]
    saved = 8 * (cheap[0] - dear[0])
    assert 0.01 * saved < dear[1] - cheap[1] < 0.2 * saved


def test_what_is_too_far_for_the_step_is_refused() -> None:
    known, targets = rows_of(4)
    with pytest.raises(OptionError, match="too fine"):
        Loop(KNOWN, COLUMNS).search(known, targets * 1e9, STEP, free(targets), 0.1)
