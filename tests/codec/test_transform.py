import numpy as np
import pytest

from codec.subspace import hash_columns
from codec.transform import project, reconstruct


@pytest.mark.parametrize(("n", "c"), [(1, 1), (9, 2), (50, 7), (574, 57)])
def test_products_are_those_of_numpy(n, c):
    subspace, positions = hash_columns(n, c), hash_columns(n, 3)
    coefficients = project(subspace, positions)
    assert np.allclose(coefficients, subspace.T @ positions, atol=1e-12)
    assert np.allclose(reconstruct(subspace, coefficients), subspace @ coefficients, atol=1e-11)


def test_fewer_coefficients_take_the_first_columns():
    subspace, coefficients = hash_columns(20, 9), hash_columns(4, 3)
    assert np.array_equal(
        reconstruct(subspace, coefficients), reconstruct(np.ascontiguousarray(subspace[:, :4]), coefficients)
    )
