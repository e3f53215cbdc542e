"""Choosing levels: what is chosen costs least by the coder's own account, and the trellis saves error."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm import OptionError
from bsm.bitstream.coefficients.adaptive import (
    MAX_LEVEL,
    TARGET_UNIT,
    CoefficientModel,
    choose_levels,
    encode_coefficients,
    points_of_levels,
)

UNITS = st.integers(-5, 5) | st.integers(-3000, 3000) | st.sampled_from([MAX_LEVEL * TARGET_UNIT])


def targets(seed: int, rows: int = 60, mean: float = 1.5) -> np.ndarray:
    """Coefficients that fall with frequency to a tenth of the first."""
    random = np.random.default_rng(seed)
    scale = TARGET_UNIT * mean * np.geomspace(1.0, 0.1, rows)[:, None]
    return random.laplace(0.0, scale, (rows, 3)).astype(np.int64)


def squared_error(levels: np.ndarray, wanted: np.ndarray) -> float:
    """Of levels on the trellis, in squared steps."""
    return float(np.square(points_of_levels(levels) / 2 - wanted / TARGET_UNIT).sum())


def coded_bits(blocks: list[np.ndarray]) -> int:
    model = CoefficientModel(64)
    return 8 * sum(len(encode_coefficients(model, block)) for block in blocks)


def chosen(seeds: range, weight: float) -> list[np.ndarray]:
    model, blocks = CoefficientModel(64), []
    for seed in seeds:
        blocks.append(choose_levels(model, targets(seed), weight)[0])
        encode_coefficients(model, blocks[-1])
    return blocks


@given(st.lists(st.tuples(UNITS, UNITS, UNITS), min_size=1, max_size=12), st.floats(0.0, 4.0))
def test_a_point_is_within_a_step_or_zero(rows: list[tuple[int, int, int]], weight: float) -> None:
    wanted = np.array(rows, np.int64)
    levels, width = choose_levels(CoefficientModel(12), wanted, weight)
    distance = np.abs(points_of_levels(levels).astype(np.int64) * TARGET_UNIT // 2 - wanted)
    assert ((levels == 0) | (distance <= TARGET_UNIT)).all()
    assert (levels * wanted >= 0).all()
    assert 1 <= width <= len(rows)


@pytest.mark.parametrize("seed", range(5))
def test_bits_for_nothing_mean_the_least_error_of_all_ways(seed: int) -> None:
    wanted = np.random.default_rng(seed).integers(-2 * TARGET_UNIT, 2 * TARGET_UNIT, (2, 3))
    levels, _ = choose_levels(CoefficientModel(64), wanted, 0.0)
    every = (np.array(way, np.int32).reshape(2, 3) for way in itertools.product(range(-3, 4), repeat=6))
    assert squared_error(levels, wanted) == pytest.approx(min(squared_error(way, wanted) for way in every))


def test_the_trellis_saves_a_decibel_of_error() -> None:
    wanted = np.random.default_rng(7).integers(20 * TARGET_UNIT, 60 * TARGET_UNIT, (2000, 3))
    levels = choose_levels(CoefficientModel(2000), wanted, 0.0)[0]
    assert 10 * np.log10(squared_error(levels, wanted) / wanted.size * 12) == pytest.approx(-1.09, abs=0.05)


def test_the_trade_beats_plain_rounding_and_a_fixed_dead_zone() -> None:
    weight, seeds = 0.15, range(10)
    wanted = [targets(seed) for seed in seeds]

    def price(blocks: list[np.ndarray], error: float) -> float:
        return weight * coded_bits(blocks) + error

    def rounded(offset: float) -> float:
        scaled = [w / TARGET_UNIT for w in wanted]
        blocks = [(np.sign(x) * np.floor(np.abs(x) + offset)).astype(np.int32) for x in scaled]
        return price(blocks, sum(float(np.square(b - x).sum()) for b, x in zip(blocks, scaled)))

    blocks = chosen(seeds, weight)
    best = price(blocks, sum(squared_error(b, w) for b, w in zip(blocks, wanted)))
    assert best < 0.97 * min(rounded(offset) for offset in (0.5, 0.42, 0.35, 0.28))


def test_what_the_model_is_not_made_for_is_refused() -> None:
    with pytest.raises(OptionError, match="at most 8 rows"):
        choose_levels(CoefficientModel(8), np.zeros((9, 3), np.int64), 0.1)
    with pytest.raises(OptionError, match="levels up to"):
        choose_levels(CoefficientModel(8), np.full((1, 3), (MAX_LEVEL + 1) * TARGET_UNIT), 0.1)
