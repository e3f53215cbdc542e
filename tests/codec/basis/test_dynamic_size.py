import numpy as np
import pytest

from bsm import Encoder, decode
from bsm.codec.basis.orthogonal_iteration import dynamic_size, residual_norms
from bsm.options import encode_options
from tests.shapes import torus


def test_the_size_grows_over_the_upper_and_shrinks_under_the_lower_threshold():
    positions = np.zeros((10, 3))
    positions[:, 0] = np.arange(1.0, 11.0)[::-1]
    coefficients = positions  # the basis is the identity: residuals are tails of 10, 9, 8, ...
    norms = residual_norms(positions, coefficients)
    for previous in range(1, 11):
        size = dynamic_size(positions, coefficients, previous, norms[6] - 0.1, norms[5] + 0.1)
        assert size == min(max(previous, 5), 6)
    assert dynamic_size(positions, coefficients, 3, 1e-9, 1e-8) == 10


def test_sizes_follow_the_error_and_the_decoder_follows_the_sizes():
    mesh = torus(60, 40, bumps=0.15)
    options = {"block_size": 150, "keep": 0.5, "step": 5e-4, "smoothing": 0.0}
    dynamic = Encoder(mesh, encode_options(**options, doi=(0.02, 0.03)))
    attempt = dynamic.attempt(5e-4)
    assert len(set(attempt.draft.coefficients)) > 2
    decoded = decode(b"".join(attempt.frames))
    error = np.abs(decoded.positions - mesh.positions[dynamic.vertex_order]).max()
    assert error == pytest.approx(attempt.comparison.max_error * mesh.diagonal, rel=0.5)
