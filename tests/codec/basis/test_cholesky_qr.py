from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm.codec import _kernels
from bsm.codec.basis.orthogonal_iteration import ONCE, hash_columns, householder_orthonormalize

SHAPES = [(1, 1), (5, 3), (9, 8), (40, 31), (64, 32), (65, 33), (90, 90), (200, 97), (200, 121)]


def factorized(columns, once=ONCE):
    """Q by Cholesky QR, and how independent the columns are; a second pass only below `once`."""
    q = np.empty(columns.shape)
    scratch = np.full(_kernels.iteration_space(*columns.shape), np.nan)
    return q, _kernels.cholesky_onorm(np.ascontiguousarray(columns), once, scratch, q)


@pytest.mark.parametrize(("n", "c"), SHAPES)
def test_q_is_that_of_householder_reflections(n, c):
    columns = hash_columns(n, c) + 2.0 * np.eye(n, c)
    q, independence = factorized(columns)
    assert 0 < independence <= 1
    assert np.allclose(q, householder_orthonormalize(columns), atol=1e-11)


def test_independence_is_the_least_squared_sine_whatever_the_lengths():
    angle = 0.03
    columns = np.array([[1.0, np.cos(angle), 0], [0, np.sin(angle), 0], [0, 0, 1], [0, 0, 0]]) * [1.0, 1e-6, 1e5]
    assert np.isclose(factorized(columns)[1], np.sin(angle) ** 2, rtol=1e-9)


def test_a_second_pass_makes_nearly_dependent_columns_orthogonal():
    columns = hash_columns(300, 20)
    columns[:, 7] = columns[:, 3] + 1e-4 * columns[:, 7]
    once, twice = factorized(columns, 0.0)[0], factorized(columns)[0]
    error = [np.abs(q.T @ q - np.eye(20)).max() for q in (once, twice)]
    assert error[1] < 1e-14 < error[0]


@pytest.mark.parametrize("value", [0.0, np.nan, np.inf])
def test_a_column_that_is_zero_or_not_finite_has_no_triangle(value):
    columns = hash_columns(12, 4)
    columns[:, 2] = value
    assert factorized(columns)[1] == 0.0


@settings(max_examples=30)
@given(st.integers(1, 70), st.integers(1, 70), st.integers(0, 2**31))
def test_columns_to_the_right_change_no_bit(c, more, seed):
    columns = np.random.default_rng(seed).standard_normal((150, c + more))
    narrow, wide = factorized(columns[:, :c], 0.0)[0], factorized(columns, 0.0)[0]
    assert np.array_equal(narrow, wide[:, :c])


def test_products_are_fused_with_sums():
    a, b = 1 + 2.0**-30, 2.0**-10
    square = float(Fraction(a * a) + Fraction(b) ** 2)
    pivot = float(Fraction(square) - Fraction(a) ** 2)
    assert pivot != square - a * a
    assert factorized(np.array([[1.0, a], [0.0, b]]))[1] == pivot / square
