"""The coefficient coder: exact round trips, cheap levels, the nearest ones."""

import itertools
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import OptionError
from bsm._core.bitstream import constant
from tests.blocks import blocks_of, chain_of
from tests.shapes import patch

MOST = constant("MAX_LEVEL")
UNITS = (
    st.integers(-5, 5)
    | st.integers(-3000, 3000)
    | st.integers(-300 << 8, 300 << 8)
    | st.sampled_from([MOST << 8])
)
ROWS = st.lists(st.tuples(UNITS, UNITS, UNITS), min_size=1, max_size=12)
UNIT = 256
"""Targets are in 1 / UNIT of a step."""
MESH = patch(16, 16)
BLOCKS = blocks_of(MESH, 4, 80)


def coded(blocks: list[np.ndarray], width: int = 60) -> tuple[list[bytes], list[np.ndarray]]:
    """Payloads of blocks of targets, one after the other in a chain, and the points that they decode to, in steps."""
    chain, payloads, points = chain_of(BLOCKS, width), [], []
    for index, targets in enumerate(blocks):
        still = np.zeros((len(chain.begin(index)[0]), 3))
        chain.give(np.eye(len(still), len(targets), dtype=np.float32))
        _, payload, decoded = chain.write(still, targets / UNIT, 1.0, True)
        chain.commit(len(targets), decoded)
        payloads.append(payload)
        points.append(decoded[: len(targets)])
    return payloads, points


@pytest.fixture(scope="module")
def law() -> Any:
    sys.path.insert(0, str(Path(__file__).parents[3] / "spec"))
    yield import_module("reference_decoder")
    sys.path.pop(0)


@settings(max_examples=60)
@given(chain=st.lists(ROWS, min_size=1, max_size=4))
def test_any_chain_of_blocks_round_trips(law: Any, chain: list[list[tuple[int, int, int]]]) -> None:
    payloads, points = coded([np.array(rows) for rows in chain])
    model = law.CoefficientModel(60)
    for payload, expected in zip(payloads, points):
        decoder = law.RangeDecoder(payload)
        np.testing.assert_array_equal(model.block(decoder, len(expected)), 2 * expected)
        decoder.finish()


def test_a_short_chain_costs_little_more_than_its_entropy() -> None:
    random = np.random.default_rng(4)
    blocks = [np.trunc(random.exponential(1 / np.log1p(1 / 20), (60, 3))) for _ in range(4)]
    payloads, _ = coded([UNIT * block * random.choice([-1, 1], block.shape) for block in blocks])
    p = 1 / 21
    # Of a geometric magnitude, and its sign.
    entropy = (-p * np.log2(p) - (1 - p) * np.log2(1 - p)) / p + (1 - p)
    assert 8 * sum(len(payload) - 1 for payload in payloads) <= 1.06 * entropy * 4 * 180


def test_a_block_wider_than_announced_is_refused() -> None:
    with pytest.raises(ValueError, match="11 coefficients are too many"):
        coded([np.ones((11, 3))], width=10)


@pytest.mark.parametrize("step", [0.0, -1.0, np.nan])
def test_a_step_that_is_none_is_refused(step: float) -> None:
    chain = chain_of(BLOCKS, 60)
    still = np.zeros((len(chain.begin(0)[0]), 3))
    chain.dictionary(5)
    for rows, given_step in ((5, step), (6, 1.0)):
        with pytest.raises(OptionError, match="do not fit the block"):
            chain.write(still, np.ones((rows, 3)), given_step, True)


@given(ROWS)
def test_a_point_is_within_a_step(rows: list[tuple[int, int, int]]) -> None:
    wanted = np.array(rows)
    _, (points,) = coded([wanted])
    assert (np.abs(points * UNIT - wanted) <= UNIT).all()
    assert (points * wanted >= 0).all()


@pytest.mark.parametrize("seed", range(2))
def test_nearest_levels_have_the_least_error_of_all_ways(seed: int) -> None:
    wanted = np.random.default_rng(seed).integers(-2 * UNIT, 2 * UNIT, 6)
    _, (points,) = coded([wanted.reshape(2, 3)])

    def error(way: tuple[int, ...]) -> float:
        found, last = 0.0, [0, 0, 0]
        for level, target in zip(way, wanted):
            found += (level - np.sign(level) * last[2] / 2 - target / UNIT) ** 2
            last = [*last[1:], (level + sum(last)) % 2]
        return found

    best = min(map(error, itertools.product(range(-3, 4), repeat=6)))
    assert np.square(points.ravel() - wanted / UNIT).sum() == pytest.approx(best, abs=1e-12)
