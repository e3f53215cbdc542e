"""Choosing levels: what is chosen costs least by the coder's own account, and the account is right."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bitstream.adaptive import MAX_LEVEL, CoefficientModel, encode_coefficients
from bitstream.choice import TARGET_UNIT, choose_levels
from bitstream.errors import OptionError

UNITS = st.integers(-5, 5) | st.integers(-3000, 3000) | st.sampled_from([MAX_LEVEL * TARGET_UNIT])


def targets(seed: int, rows: int = 60, mean: float = 1.5) -> np.ndarray:
    """Coefficients that fall with frequency to a tenth of the first."""
    random = np.random.default_rng(seed)
    scale = TARGET_UNIT * mean * np.geomspace(1.0, 0.1, rows)[:, None]
    return random.laplace(0.0, scale, (rows, 3)).astype(np.int64)


def squared_error(levels: np.ndarray, wanted: np.ndarray) -> float:
    """In squared steps."""
    return float(np.square(levels - wanted / TARGET_UNIT).sum())


def coded_bits(blocks: list[np.ndarray]) -> int:
    model = CoefficientModel(64)
    return 8 * sum(len(encode_coefficients(model, block)) for block in blocks)


def chosen(seeds: range, weight: float) -> list[np.ndarray]:
    model, blocks = CoefficientModel(64), []
    for seed in seeds:
        blocks.append(choose_levels(model, targets(seed), weight).levels)
        encode_coefficients(model, blocks[-1])
    return blocks


@settings(deadline=None)
@given(st.lists(st.tuples(UNITS, UNITS, UNITS), min_size=1, max_size=12), st.floats(0.0, 4.0))
def test_a_level_is_one_of_the_two_around_the_target_or_zero(rows: list[tuple[int, int, int]], weight: float) -> None:
    wanted = np.array(rows, np.int64)
    choice = choose_levels(CoefficientModel(12), wanted, weight)
    magnitude = np.abs(choice.levels.astype(np.int64))
    assert ((magnitude == 0) | (np.abs(magnitude * TARGET_UNIT - np.abs(wanted)) <= TARGET_UNIT)).all()
    assert (choice.levels * wanted >= 0).all()
    assert 1 <= choice.width <= len(rows)


def test_bits_for_nothing_mean_the_nearest_level() -> None:
    wanted = targets(1)
    error = np.abs(choose_levels(CoefficientModel(64), wanted, 0.0).levels * TARGET_UNIT - wanted)
    assert error.max() <= TARGET_UNIT // 2


def test_the_model_stays_as_it_is() -> None:
    model = CoefficientModel(64)
    encode_coefficients(model, chosen(range(1), 0.1)[0])
    before = model.copy()
    choose_levels(model, targets(2), 0.2)
    for one, other in zip((*model.bank, *model.past), (*before.bank, *before.past)):
        if one is not model.bank.inputs:
            np.testing.assert_array_equal(one, other)


def test_dearer_bits_make_fewer_of_them() -> None:
    sizes = [coded_bits(chosen(range(6), weight)) for weight in (0.0, 0.1, 0.3, 1.0)]
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[-1] < 0.6 * sizes[0]


def test_the_trade_beats_plain_rounding_and_a_fixed_dead_zone() -> None:
    weight, seeds = 0.2, range(10)

    def price(blocks: list[np.ndarray]) -> float:
        return weight * coded_bits(blocks) + sum(squared_error(b, targets(s)) for s, b in zip(seeds, blocks))

    def rounded(offset: float) -> list[np.ndarray]:
        wanted = [targets(seed) / TARGET_UNIT for seed in seeds]
        return [(np.sign(w) * np.floor(np.abs(w) + offset)).astype(np.int32) for w in wanted]

    best = price(chosen(seeds, weight))
    assert best < min(price(rounded(offset)) for offset in (0.5, 0.42, 0.35, 0.28))


def test_rows_that_are_not_worth_their_bits_are_left_out() -> None:
    wanted = targets(3)
    wanted[25:] = np.sign(wanted[25:]) * TARGET_UNIT // 10
    wanted[30, 1] = TARGET_UNIT * 6 // 10
    assert choose_levels(CoefficientModel(64), wanted, 0.3).width <= 25
    assert choose_levels(CoefficientModel(64), np.zeros((9, 3), np.int64), 0.3).width == 1
    wanted[59] = 20 * TARGET_UNIT
    assert choose_levels(CoefficientModel(64), wanted, 0.3).width == 60


def test_what_the_model_is_not_made_for_is_refused() -> None:
    with pytest.raises(OptionError, match="at most 8 rows"):
        choose_levels(CoefficientModel(8), np.zeros((9, 3), np.int64), 0.1)
    with pytest.raises(OptionError, match="levels up to"):
        choose_levels(CoefficientModel(8), np.full((1, 3), (MAX_LEVEL + 1) * TARGET_UNIT), 0.1)
