"""Frames of the components of a field."""

import numpy as np
import pytest

from bsm.codec.basis.orthogonal_iteration import hash_columns
from bsm.codec.sequence.temporal import frames_of


@pytest.mark.parametrize("vertices", [0, 1, 4, 37])
@pytest.mark.parametrize(("first", "components"), [(0, 20), (3, 9), (12, 0)])
@pytest.mark.parametrize(("width", "frames"), [(3, 13), (3, 8), (1, 1), (2, 7), (4, 16), (5, 9), (11, 17)])
def test_frames_are_components_times_the_basis(vertices, first, components, width, frames):
    field = hash_columns(vertices, 20)
    basis = hash_columns(width * frames, components).reshape(width, frames, components)
    expected = np.einsum("vk,dtk->tvd", field[:, first : first + components], basis)
    shown = np.array(list(frames_of(field, first, basis))).reshape(frames, vertices, width)
    assert np.allclose(shown, expected, atol=1e-14)
