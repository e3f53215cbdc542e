import math

import numpy as np
import pytest

from bsm.bitstream.coefficients.adaptive import points_of_levels
from bsm.codec.basis.orthogonal_iteration import hash_columns
from bsm.codec.signal.transform import placed, project, reconstruct, targets


def basis(rows, columns):
    return hash_columns(rows, columns).astype(np.float32)


@pytest.mark.parametrize(("n", "c"), [(1, 1), (2, 2), (5, 0), (9, 2), (50, 7), (574, 57)])
@pytest.mark.parametrize("shape", [(), (1,), (3,)])
def test_products_are_those_of_numpy(n, c, shape):
    subspace, values = basis(n, c + 3), hash_columns(n, 3).T[: math.prod(shape)].T.reshape(n, *shape)
    coefficients = project(subspace, values, c)
    assert coefficients.shape == (c, *shape)
    assert np.allclose(coefficients, subspace[:, :c].T.astype(float) @ values, atol=1e-12)
    assert np.allclose(reconstruct(subspace, coefficients), subspace[:, :c].astype(float) @ coefficients, atol=1e-11)


@pytest.mark.parametrize("d", [1, 7, 8, 9, 31, 33, 71])
@pytest.mark.parametrize("n", [1, 3, 8, 21])
def test_a_column_is_the_same_to_the_last_bit_beside_any_others(n, d):
    subspace, coefficients = basis(n, 9), hash_columns(d, 6).T.copy()
    alone = [reconstruct(subspace, coefficients[:, column]) for column in range(d)]
    assert np.array_equal(reconstruct(subspace, coefficients), np.array(alone).T)


def test_later_columns_change_no_bit():
    subspace, values = basis(21, 9), hash_columns(21, 3)
    narrow = np.ascontiguousarray(subspace[:, :4])
    coefficients = project(narrow, values, 4)
    assert np.array_equal(project(subspace, values, 4), coefficients)
    assert np.array_equal(reconstruct(subspace, coefficients), reconstruct(narrow, coefficients))


@pytest.mark.parametrize("count", [0, 1, 9])
def test_a_block_is_placed_where_its_levels_say(count):
    subspace, prediction = basis(50, 9), hash_columns(50, 3)
    levels = (40 * hash_columns(count, 3)).astype(np.int32)
    expected = prediction + reconstruct(subspace, points_of_levels(levels) * 0.125)
    assert np.array_equal(placed(prediction, subspace, levels, 0.25), expected)


@pytest.mark.parametrize(("rows", "levels"), [(50, 10), (49, 3)])
def test_a_block_of_another_shape_is_not_placed(rows, levels):
    with pytest.raises(ValueError, match="fit together"):
        placed(np.zeros((rows, 3)), basis(50, 9), np.zeros((levels, 3), np.int32), 0.25)


def test_targets_are_coefficients_in_parts_of_a_step():
    coefficients = np.array([[0.5, -0.25, 0.001], [1e9, -1e9, 0.0]])
    expected = [[256, -128, 1], [2560, -2560, 0]]
    np.testing.assert_array_equal(targets(coefficients, 0.5, 256, 10), expected)
