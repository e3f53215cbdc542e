"""The trellis: known points, one point for each level of a grid, and grids that follow from parities."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm.bitstream.coefficients.adaptive import STATES, points_of_levels


def grids_of(levels: list[int]) -> list[int]:
    """Grid 0 first, then the parity of the last level plus the last three grids."""
    grids = [0]
    for level in levels[:-1]:
        grids.append((level + sum(grids[-3:])) % 2)
    return grids


def last_point(levels: list[int]) -> int:
    """Point of the last of six levels."""
    return int(points_of_levels(np.array(levels, np.int32).reshape(2, 3))[1, 2])


PREFIXES = [list(prefix) for prefix in itertools.product(range(2), repeat=5)]


def test_known_points() -> None:
    levels = np.array([[3, -2, 1], [0, 5, -5], [1, 0, -1]], np.int32)
    grids = grids_of(levels.reshape(-1).tolist())
    assert grids == [0, 1, 1, 1, 1, 0, 1, 1, 0]
    expected = [2 * k - g * np.sign(k) for k, g in zip(levels.reshape(-1), grids)]
    np.testing.assert_array_equal(points_of_levels(levels), np.reshape(expected, (3, 3)))


def test_the_beginnings_lead_to_all_states() -> None:
    assert len({tuple(grids_of([*prefix, 0])[-3:]) for prefix in PREFIXES}) == STATES


@pytest.mark.parametrize("prefix", PREFIXES, ids=str)
def test_a_grid_has_one_point_to_a_step_and_zero(prefix: list[int]) -> None:
    points = [last_point([*prefix, level]) for level in range(-4, 5)]
    odd = grids_of([*prefix, 0])[-1]
    assert points == ([-7, -5, -3, -1, 0, 1, 3, 5, 7] if odd else [-8, -6, -4, -2, 0, 2, 4, 6, 8])


def test_parity_decides_and_both_ways_lead_to_other_grids() -> None:
    for prefix in PREFIXES:
        after = [last_point([*prefix[:4], level, 1]) for level in range(-3, 4)]
        assert len(set(after[::2])) == len(set(after[1::2])) == 1
        assert {after[0], after[1]} == {1, 2}


@given(st.lists(st.integers(-9, 9), min_size=3, max_size=30).map(lambda v: v[: len(v) // 3 * 3]))
def test_points_hold_their_levels(values: list[int]) -> None:
    levels = np.array(values, np.int32).reshape(-1, 3)
    points = points_of_levels(levels)
    np.testing.assert_array_equal((points + np.sign(points)) // 2 * (points > 0), levels * (points > 0))
    np.testing.assert_array_equal(points_of_levels(-levels), -points)
