import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from codec.basis.orthogonal_iteration import hash_columns, householder_orthonormalize
from codec.basis.solver.panels import factorize_gram, gram, invert_triangle, multiply, pack, unpack
from codec.basis.solver.simd import LANES, add_scaled, aligned, filled, load, scaled, store

SHAPES = [(1, 1), (5, 3), (40, 31), (64, 32), (65, 33), (200, 97)]


def dense(triangle, c):
    """The first c rows and columns of a matrix in panels."""
    return np.concatenate(list(triangle), axis=1)[:c, :c]


@njit
def _lanes_of_everything(x, factor):
    out = aligned(LANES)
    store(out, 0, add_scaled(scaled(load(x, 3), 2.0), factor, filled(0.1)))
    return out


def test_lanes_compute_like_scalars_and_round_once():
    x = hash_columns(LANES + 3, 1)[:, 0]
    found = _lanes_of_everything(x, 1.0 / 3.0)
    # The product of two doubles is exact in long double (64 bits more than suffice for these).
    exact = 2 * x[3:].astype(np.longdouble) + np.longdouble(1.0 / 3.0) * np.longdouble(0.1)
    assert np.allclose(found, exact.astype(float), rtol=2.3e-16, atol=0)


def test_aligned_arrays_begin_at_cache_lines():
    assert {aligned(size).ctypes.data % 64 for size in range(1, 400, 13)} == {0}


@pytest.mark.parametrize(("n", "c"), SHAPES)
def test_packing_is_undone_and_pads_with_zeros(n, c):
    columns, order = hash_columns(n, c), np.random.default_rng(n).permutation(n)
    panels = pack(columns, order)
    assert panels.shape[1] % 4 == 0 and panels.shape[1] > n
    flat = np.concatenate(list(panels), axis=1)
    assert np.array_equal(flat[:n, :c], columns[order])
    assert not flat[n:].any() and not flat[:, c:].any()
    assert np.array_equal(unpack(panels, order, c), columns)


@pytest.mark.parametrize(("n", "c"), SHAPES)
def test_products_are_those_of_numpy(n, c):
    columns, order = hash_columns(n, c), np.arange(n)
    panels = pack(columns, order)
    products = gram(panels)
    assert np.allclose(np.triu(dense(products, c)), np.triu(columns.T @ columns), atol=1e-12)
    triangle = np.triu(hash_columns(c, c))
    packed = np.zeros_like(products)
    for b in range(len(products)):
        width = min(LANES, c - b * LANES)
        packed[b, :c, :width] = triangle[:, b * LANES : b * LANES + width]
    assert np.allclose(unpack(multiply(panels, packed), order, c), columns @ triangle, atol=1e-12)


@pytest.mark.parametrize(("n", "c"), SHAPES)
def test_the_triangle_is_the_r_of_a_qr_factorisation_and_its_inverse_the_inverse(n, c):
    columns = hash_columns(n, c)
    triangle = gram(pack(columns, np.arange(n)))
    assert factorize_gram(triangle, c) > 0
    r = np.triu(dense(triangle, c))
    assert np.allclose(r, householder_orthonormalize(columns).T @ columns, atol=1e-10)
    inverse = dense(invert_triangle(triangle, c), c)
    assert np.array_equal(inverse, np.triu(inverse))
    assert np.allclose(inverse @ r, np.eye(c), atol=1e-9)


def test_independence_is_the_least_squared_sine_whatever_the_lengths():
    angle = 0.03
    columns = np.array([[1.0, np.cos(angle), 0], [0, np.sin(angle), 0], [0, 0, 1], [0, 0, 0]]) * [1.0, 1e-6, 1e5]
    assert np.isclose(factorize_gram(gram(pack(columns, np.arange(4))), 3), np.sin(angle) ** 2, rtol=1e-9)


@pytest.mark.parametrize("value", [0.0, np.nan, np.inf])
def test_a_column_that_is_zero_or_not_finite_has_no_triangle(value):
    columns = hash_columns(12, 4)
    columns[:, 2] = value
    assert factorize_gram(gram(pack(columns, np.arange(12))), 4) == 0.0


@settings(deadline=None, max_examples=30)
@given(st.integers(1, 70), st.integers(1, 70), st.integers(0, 2**31))
def test_padding_columns_changes_no_bit(c, more, seed):
    columns = np.random.default_rng(seed).standard_normal((80, c + more))
    narrow, wide = gram(pack(columns[:, :c].copy(), np.arange(80))), gram(pack(columns, np.arange(80)))
    factorize_gram(narrow, c)
    factorize_gram(wide, c)
    assert np.array_equal(np.triu(dense(narrow, c)), np.triu(dense(wide, c)))
