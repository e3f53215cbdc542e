"""The trellis: known points, one point for each level of a grid, and grids that follow from parities."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bitstream.coefficients.trellis import STATES, following, grid, point_of_level, points_of_levels


def test_known_points() -> None:
    levels = np.array([[3, -2, 1], [0, 5, -5], [1, 0, -1]], np.int32)
    # grids: 0, then the parity of the last level plus the last three grids
    grids = [0]
    for level in levels.reshape(-1)[:-1]:
        grids.append((int(level) + sum(grids[-3:])) % 2)
    assert grids == [0, 1, 1, 1, 1, 0, 1, 1, 0]
    expected = [2 * k - g * np.sign(k) for k, g in zip(levels.reshape(-1), grids)]
    np.testing.assert_array_equal(points_of_levels(levels), np.reshape(expected, (3, 3)))


def test_a_grid_has_one_point_to_a_step_and_zero() -> None:
    for state in range(STATES):
        points = [point_of_level(state, level) for level in range(-4, 5)]
        assert points == ([-8, -6, -4, -2, 0, 2, 4, 6, 8] if grid(state) == 0 else [-7, -5, -3, -1, 0, 1, 3, 5, 7])


def test_parity_decides_and_both_ways_lead_to_other_grids() -> None:
    for state in range(STATES):
        for level in range(-3, 4):
            assert following(state, level) == following(state, level & 1)
        assert grid(following(state, 0)) != grid(following(state, 1))
        assert 0 <= following(state, 1) < STATES


@given(st.lists(st.integers(-9, 9), min_size=3, max_size=30).map(lambda v: v[: len(v) // 3 * 3]))
def test_points_hold_their_levels(values: list[int]) -> None:
    levels = np.array(values, np.int32).reshape(-1, 3)
    points = points_of_levels(levels)
    np.testing.assert_array_equal((points + np.sign(points)) // 2 * (points > 0), levels * (points > 0))
    np.testing.assert_array_equal(points_of_levels(-levels), -points)
