import numpy as np
import pytest

from bsm import Encoder, decode
from bsm._core import Cut
from bsm.codec.basis.orthogonal_iteration import DynamicSize
from bsm.codec.signal.chain import Chain, ChainRules
from bsm.encoding.options import encode_options
from tests.blocks import blocks_of
from tests.shapes import patch, torus
from tools.laplacians import dense_laplacian

RULES = ChainRules(
    exact=True, key_interval=1, power=2, iterations=1, key_iterations=1, shift=0.125, springs=False
)


@pytest.mark.parametrize("mesh", [patch(17, 23), torus(20, 20)])
def test_the_exact_basis_is_exact_to_the_tolerance_that_it_states(mesh):
    """Its Rayleigh quotients against LAPACK's eigenvalues, of a torus with many equal ones too."""
    blocks = blocks_of(mesh)
    chain, matrix = Chain(RULES, blocks), dense_laplacian(blocks.block(0))
    chain.begin(0)
    basis = chain.dictionary(57)
    assert np.allclose(basis.T @ basis, np.eye(57), atol=1e-5)
    quotients = np.cumsum(np.einsum("ij,ij->j", basis, matrix @ basis) + 0.01)
    least = np.cumsum(np.linalg.eigvalsh(matrix)[:57] + 0.01)
    assert np.all(quotients >= least * (1 - 1e-4))
    assert np.all(quotients <= 1.001 * least)


def test_the_size_grows_over_the_upper_and_shrinks_under_the_lower_threshold():
    positions = np.zeros((10, 3))
    positions[:, 0] = np.arange(1.0, 11.0)[::-1]
    coefficients = positions  # the basis is the identity: residuals are tails of 10, 9, 8, ...
    norms = [np.linalg.norm(positions[size:]) for size in range(10)]
    for previous in range(1, 11):
        size = DynamicSize(norms[6] - 0.1, norms[5] + 0.1, previous).follow(0.0, coefficients)
        assert size == min(max(previous, 5), 6)
    assert DynamicSize(1e-9, 1e-8, 3).follow(0.0, coefficients) == 10
    rule = DynamicSize(1e-9, 1e-8, 3)
    assert rule.follow(1e-15, coefficients) == 10 and not rule.met


def test_sizes_follow_the_error_and_the_decoder_follows_the_sizes():
    mesh = torus(60, 40, bumps=0.15)
    options = {"block_size": 150, "keep": 0.5, "step": 5e-4, "smoothing": 0.0}
    dynamic = Encoder(mesh, encode_options(**options, doi=(0.03, 0.04)))
    attempt = dynamic.attempt(5e-4)
    assert (
        len(
            {
                packet.coefficients
                for packet in attempt.draft.body
                if hasattr(packet, "coefficients")
            }
        )
        > 2
    )
    decoded = decode(b"".join(attempt.frames))
    error = np.abs(decoded.positions - mesh.positions[dynamic.vertex_order]).max()
    assert error == pytest.approx(attempt.comparison.max_error, rel=0.5)


@pytest.mark.parametrize("value", [0.0, np.nan, np.inf])
def test_a_column_that_is_zero_or_not_finite_is_replaced(value):
    """Without a solution, an iteration gives the Q of its columns, in single precision."""
    columns = np.random.default_rng(0).uniform(-1.0, 1.0, (12, 4)).astype(np.float32)
    columns[:, 2] = value
    alone = Cut(np.zeros(13, np.int32), np.empty(0, np.int32))
    for most in (1e-3, 2e-6):
        columns = alone.iterate(1.0, columns, 0, 1, 0)
        assert np.abs(columns.T.astype(float) @ columns - np.eye(4)).max() < most
