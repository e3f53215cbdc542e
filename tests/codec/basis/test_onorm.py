"""Onorm: orthonormal whatever it is given, and nested to the last bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm.codec.basis.laplacian import factorize, laplacian_of
from bsm.codec.basis.orthogonal_iteration import hash_columns, orthogonal_iteration
from bsm.codec.blocks.overlap import Block

SHAPES = [(1, 1), (5, 3), (9, 8), (40, 31), (64, 32), (65, 33), (90, 90), (200, 97), (200, 121)]


def onorm(columns):
    """Q of columns, which are rounded to single precision: an iteration without any solution."""
    size = len(columns)
    alone = Block(np.arange(size, dtype=np.int32), np.zeros(size + 1, np.int32), np.empty(0, np.int32))
    factor = factorize(laplacian_of(alone), 1.0)
    return orthogonal_iteration(factor, columns.astype(np.float32), power=0, iterations=1).astype(float)


def off(q):
    return np.abs(q.T @ q - np.eye(q.shape[1])).max()


@pytest.mark.parametrize(("n", "c"), SHAPES)
def test_q_is_that_of_a_qr_factorisation_with_positive_diagonal(n, c):
    columns = hash_columns(n, c) + 2.0 * np.eye(n, c)
    q, r = np.linalg.qr(columns)
    assert off(onorm(columns)) < 1e-3 and off(onorm(onorm(columns))) < 2e-6
    assert np.allclose(onorm(columns), q * np.sign(np.diag(r)), atol=1e-3)


@pytest.mark.parametrize("decades", [3, 9, 15])
def test_columns_that_are_close_to_dependent_are_made_orthonormal_one_by_one(decades):
    columns = hash_columns(80, 70) * np.logspace(0, -decades, 70)
    columns[:, 1:] += columns[:, :1]
    assert off(onorm(onorm(columns))) < 2e-6


@pytest.mark.parametrize("value", [0.0, np.nan, np.inf])
def test_a_column_that_is_zero_or_not_finite_is_replaced(value):
    columns = hash_columns(12, 4)
    columns[:, 2] = value
    assert off(onorm(columns)) < 1e-3 and off(onorm(onorm(columns))) < 2e-6


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 70), st.integers(1, 70), st.integers(0, 2**31), st.booleans())
def test_columns_to_the_right_change_no_bit(c, more, seed, dependent):
    columns = np.random.default_rng(seed).standard_normal((150, c + more))
    if dependent:
        columns[:, c - 1] = columns[:, c // 2]
    assert np.array_equal(onorm(columns[:, :c]), onorm(columns)[:, :c])


def test_products_are_not_fused_with_sums():
    a, b = np.float32(1 + 2.0**-12), np.float32(2.0**-9)
    found = onorm(np.array([[a, 1.0], [b, 0.0]]))
    square = a * a + b * b
    once = np.array([a, b]) * (np.float32(1) / np.sqrt(square))
    assert np.array_equal(found[:, 0].astype(np.float32), once)
