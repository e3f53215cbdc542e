"""BSM units, and the way back to the unit of the mesh."""

import numpy as np
import pytest

from bsm import NumericError
from bsm.codec.basis.orthogonal_iteration import hash_columns
from bsm.codec.static.units import Units

UNITS = Units((10.0, -20.0, 0.3), 1.7)


@pytest.mark.parametrize("vertices", [0, 1, 7, 8, 9, 50])
def test_positions_come_back_in_the_unit_of_the_mesh(vertices):
    positions = hash_columns(vertices, 3)
    expected = positions * 1.7 + np.array(UNITS.center)
    moved = UNITS.back(positions)
    assert np.array_equal(moved, expected) and moved is not positions
    assert UNITS.back(positions, out=positions) is positions
    assert np.array_equal(positions, expected)


def test_rows_of_a_wider_array_do_as_well():
    wide = hash_columns(20, 7)
    assert np.array_equal(UNITS.back(wide[:, 2:5]), UNITS.back(wide[:, 2:5].copy()))


@pytest.mark.parametrize("row", [0, 13, 16])
@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan, 1.5e308])
def test_a_number_beyond_the_range_is_an_error(row, value):
    positions = hash_columns(17, 3)
    positions[row, row % 3] = value
    with pytest.raises(NumericError, match="not finite"):
        UNITS.back(positions)
