"""What the command line holds of frames until they have been compared."""

from inspect import getclosurevars

import numpy as np
import pytest

from bsm.codec.basis.orthogonal_iteration import hash_columns
from bsm.jobs.encode import kept


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
@pytest.mark.parametrize("place", [0.0, 1e4])
def test_frames_are_kept_within_what_any_error_is(scale, place):
    positions = scale * (hash_columns(50, 3) * np.array([1.0, 7.0, 0.1]) + place)
    order = np.arange(49, -1, -2)
    rows = kept(positions)
    assert getclosurevars(rows).nonlocals["offsets"].nbytes == positions.nbytes // 2
    assert np.abs(rows(order) - positions[order]).max() <= 1e-6 * 7.0 * scale


def test_a_point_and_what_is_not_finite_are_kept_without_a_word():
    assert np.array_equal(kept(np.full((4, 3), 5.0))(np.arange(4)), np.full((4, 3), 5.0))
    for strange in (np.full((4, 3), np.nan), np.array([[np.inf, 0.0, 0.0], [0.0, 0.0, 0.0]])):
        assert getclosurevars(kept(strange)).nonlocals["offsets"].shape == strange.shape
