"""Levels that are chosen by what they cost, and what the decoder makes of them."""

from __future__ import annotations

import numpy as np
import pytest

from bsm import OptionError
from bsm.bitstream.coefficients.matrices import PRICED, encode_levels, make_level_bank
from bsm.codec.sequence import row_prediction
from bsm.codec.sequence.row_prediction import LevelWriter, Loop
from tools.payloads import decode_levels

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


def test_a_copy_is_independent() -> None:
    known, targets = rows_of(2)
    loop = Loop(KNOWN, COLUMNS)
    first, _ = loop.copy().search(known, targets, STEP, free(targets), 0.1)
    again, _ = loop.copy().search(known, targets, STEP, free(targets), 0.1)
    assert np.array_equal(first, again)


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


def test_a_reader_finds_what_was_written() -> None:
    writer, bank = LevelWriter(make_level_bank(), COLUMNS), make_level_bank()
    for seed in range(3):
        known, targets = rows_of(seed)
        writer.write(Loop(KNOWN, COLUMNS), known, targets, STEP)
    read = [np.zeros((ROWS, COLUMNS), np.int32) for _ in range(3)]
    decode_levels(bank, writer.finish(), read, [np.zeros((0, COLUMNS), np.int32), *read[:-1]])
    assert all(np.array_equal(a, b) for a, b in zip(read, writer.levels, strict=True))
    same = make_level_bank()
    encode_levels(same, writer.levels, [np.zeros((0, COLUMNS), np.int32), *writer.levels[:-1]])
    assert np.array_equal(same.slots, bank.slots)


def test_what_is_too_far_for_the_step_is_refused() -> None:
    known, targets = rows_of(4)
    with pytest.raises(OptionError, match="too fine"):
        Loop(KNOWN, COLUMNS).search(known, targets * 1e9, STEP, free(targets), 0.1)
