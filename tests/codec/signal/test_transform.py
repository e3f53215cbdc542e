import numpy as np
import pytest

from bsm.codec.basis.orthogonal_iteration import hash_columns
from bsm.codec.signal.transform import placed, project, reconstruct


def basis(rows, columns):
    return hash_columns(rows, columns).astype(np.float32)


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


@pytest.mark.parametrize(("rows", "levels"), [(50, 10), (49, 3)])
def test_a_block_of_another_shape_is_not_placed(rows, levels):
    with pytest.raises(ValueError, match="fit together"):
        placed(np.zeros((rows, 3)), basis(50, 9), np.zeros((levels, 3), np.int32), 0.25)
