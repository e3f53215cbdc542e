import math

import numpy as np
import pytest

from codec.basis.orthogonal_iteration import hash_columns
from codec.signal.transform import project, reconstruct


@pytest.mark.parametrize(("n", "c"), [(1, 1), (2, 2), (5, 0), (9, 2), (50, 7), (574, 57)])
@pytest.mark.parametrize("shape", [(), (1,), (3,)])
def test_products_are_those_of_numpy(n, c, shape):
    subspace, values = hash_columns(n, c + 3), hash_columns(n, 3).T[: math.prod(shape)].T.reshape(n, *shape)
    coefficients = project(subspace, values, c)
    assert coefficients.shape == (c, *shape)
    assert np.allclose(coefficients, subspace[:, :c].T @ values, atol=1e-12)
    assert np.allclose(reconstruct(subspace, coefficients), subspace[:, :c] @ coefficients, atol=1e-11)


def test_later_columns_change_no_bit():
    subspace, values = hash_columns(21, 9), hash_columns(21, 3)
    narrow = np.ascontiguousarray(subspace[:, :4])
    coefficients = project(narrow, values, 4)
    assert np.array_equal(project(subspace, values, 4), coefficients)
    assert np.array_equal(reconstruct(subspace, coefficients), reconstruct(narrow, coefficients))
