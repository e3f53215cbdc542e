"""The coefficient coder: exact round trips, cheap levels, learnt numbers."""

import hashlib
import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import OptionError
from bsm.bitstream.coefficients.adaptive import (
    MAX_LEVEL,
    TARGET_UNIT,
    CoefficientModel,
    encode_coefficients,
    nearest_levels,
    shipped_experience,
)
from bsm.codec.signal.transform import placed
from tools.payloads import decode_coefficients

HASH = "2a093067f31fc03a6ec865ebc6193347d2b21ff18e6f4903e80cfc3af97c39d0"

LEVELS = st.integers(-3, 3) | st.integers(-300, 300) | st.sampled_from([MAX_LEVEL, -MAX_LEVEL, MAX_LEVEL // 3])
CHAINS = st.lists(st.lists(st.tuples(LEVELS, LEVELS, LEVELS), min_size=1, max_size=20), min_size=1, max_size=4)


def spectrum(random: np.random.Generator, rows: int, mean: float = 6.0) -> np.ndarray:
    """Levels as a smooth patch has them: falling with frequency, of a scale that differs from block to block."""
    scale = mean * random.lognormal(0.0, 0.5) * (1.0 + np.arange(rows)) ** -0.3
    return random.laplace(0.0, scale[:, None], (rows, 3)).astype(np.int32)


def entropy_of_laplace(mean: float) -> float:
    """Bits of a geometric magnitude and its sign."""
    p = 1 / (1 + mean)
    return (-p * np.log2(p) - (1 - p) * np.log2(1 - p)) / p + (1 - p)


@settings(max_examples=60)
@given(CHAINS)
def test_any_chain_of_blocks_round_trips(chain: list[list[tuple[int, int, int]]]) -> None:
    blocks = [np.array(block, np.int32) for block in chain]
    writer, reader = CoefficientModel(20), CoefficientModel(20)
    payloads = [encode_coefficients(writer, block) for block in blocks]
    for payload, block in zip(payloads, blocks):
        np.testing.assert_array_equal(decode_coefficients(reader, payload, len(block)), block)


@pytest.mark.parametrize("mean, ratio", [(4.0, 1.1), (20.0, 1.06)])
def test_a_short_chain_costs_little_more_than_its_entropy(mean: float, ratio: float) -> None:
    random = np.random.default_rng(4)
    blocks = [np.trunc(random.exponential(1 / np.log1p(1 / mean), (60, 3))).astype(np.int32) for _ in range(4)]
    blocks = [block * random.choice([-1, 1], block.shape).astype(np.int32) for block in blocks]
    model = CoefficientModel(60)
    bits = 8 * sum(len(encode_coefficients(model, block)) - 1 for block in blocks)
    assert bits <= ratio * entropy_of_laplace(mean) * 4 * 180


def test_a_block_wider_than_announced_is_refused() -> None:
    levels = np.ones((11, 3), np.int32)
    with pytest.raises(OptionError, match="at most 10 rows"):
        encode_coefficients(CoefficientModel(10), levels)


def test_levels_beyond_the_largest_are_refused() -> None:
    with pytest.raises(OptionError, match="magnitudes up to"):
        encode_coefficients(CoefficientModel(1), np.array([[0, MAX_LEVEL + 1, 0]], np.int32))


def test_the_shipped_experience_is_that_of_the_format() -> None:
    shipped = shipped_experience()
    assert hashlib.sha256(b"".join(array.tobytes() for array in shipped)).hexdigest() == HASH
    assert (CoefficientModel(1).bank.slots >> 20 == shipped.slots >> 4).all()


UNITS = st.integers(-5, 5) | st.integers(-3000, 3000) | st.sampled_from([MAX_LEVEL * TARGET_UNIT])


def points_of_levels(levels: np.ndarray) -> np.ndarray:
    """Coefficients of a block in half steps."""
    return placed(np.zeros(levels.shape), np.eye(len(levels), dtype=np.float32), levels, 2.0)


def squared_error(levels: np.ndarray, wanted: np.ndarray) -> float:
    """Of levels on the trellis, in squared steps."""
    return float(np.square(points_of_levels(levels) / 2 - wanted / TARGET_UNIT).sum())


@given(st.lists(st.tuples(UNITS, UNITS, UNITS), min_size=1, max_size=12))
def test_a_point_is_within_a_step(rows: list[tuple[int, int, int]]) -> None:
    wanted = np.array(rows, np.int64)
    levels = nearest_levels(wanted)
    assert (np.abs(points_of_levels(levels).astype(np.int64) * TARGET_UNIT // 2 - wanted) <= TARGET_UNIT).all()
    assert (levels * wanted >= 0).all()


@pytest.mark.parametrize("seed", range(2))
def test_nearest_levels_have_the_least_error_of_all_ways(seed: int) -> None:
    wanted = np.random.default_rng(seed).integers(-2 * TARGET_UNIT, 2 * TARGET_UNIT, (2, 3))
    every = (np.array(way, np.int32).reshape(2, 3) for way in itertools.product(range(-3, 4), repeat=6))
    assert squared_error(nearest_levels(wanted), wanted) == min(squared_error(way, wanted) for way in every)


def test_targets_beyond_the_largest_level_are_refused() -> None:
    with pytest.raises(OptionError, match="levels up to"):
        nearest_levels(np.full((1, 3), (MAX_LEVEL + 1) * TARGET_UNIT))
