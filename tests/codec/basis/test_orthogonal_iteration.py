from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import Encoder, TriangleMesh, decode
from bsm._core import Solver
from bsm.codec.basis.laplacian import dense_laplacian, solver_of
from bsm.codec.basis.orthogonal_iteration import DynamicSize, cosine_columns
from bsm.codec.blocks.overlap import derive_partition, grow_blocks
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import Chain, ChainRules
from bsm.options import encode_options
from tests.codec.basis.test_laplacian import unordered as whole
from tests.shapes import patch, torus

RULES = ChainRules(exact=False, key_interval=1, power=2, iterations=1, key_iterations=1, shift=0.125, springs=False)


def hash_columns(rows, columns):
    return np.random.default_rng(0).uniform(-1.0, 1.0, (rows, columns))


def cosines(rows, width):
    return cosine_columns(rows, width).astype(np.float32)


def chain_of(mesh, rules):
    """A chain of one block, begun; and its Laplacian."""
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    blocks = grow_blocks(graph, derive_partition(graph, 1), graph.size)
    chain = Chain(rules, blocks)
    chain.begin(0)
    return chain, dense_laplacian(blocks.block(0))


def test_iterations_converge_to_the_lowest_eigenvectors():
    mesh = patch(17, 23)
    block = whole(mesh.faces, len(mesh.positions))
    values, vectors = scipy.linalg.eigh(dense_laplacian(block))
    width = 10 + int(np.argmax(np.diff(values)[9:30]))
    subspace = solver_of(block, 0.01).iterate(cosines(block.size, width), 4, 60)
    exact = vectors[:, :width]
    assert np.linalg.norm(subspace - exact @ (exact.T @ subspace)) < 1e-4


@pytest.mark.parametrize("mesh", [patch(17, 23), torus(20, 20)])
def test_the_exact_basis_is_exact_to_the_tolerance_that_it_states(mesh):
    """Its Rayleigh quotients against LAPACK's eigenvalues, of a torus with many equal ones too."""
    chain, matrix = chain_of(mesh, replace(RULES, exact=True))
    basis = chain.dictionary(57)
    assert np.allclose(basis.T @ basis, np.eye(57), atol=1e-5)
    quotients = np.cumsum(np.einsum("ij,ij->j", basis, matrix @ basis) + 0.01)
    least = np.cumsum(np.linalg.eigvalsh(matrix)[:57] + 0.01)
    assert np.all(quotients >= least * (1 - 1e-4))
    assert np.all(quotients <= 1.001 * least)


def test_a_truncated_start_gives_the_truncated_subspace():
    block = whole(patch(15, 15).faces, 225)
    solver = solver_of(block, 0.125)
    wide, narrow = solver.iterate(cosines(225, 30), 2, 1), solver.iterate(cosines(225, 12), 2, 1)
    assert np.array_equal(wide[:, :12], narrow)


@pytest.mark.parametrize(("rows", "width"), [(3, 3), (20, 20), (48, 37), (225, 225), (224, 150)])
def test_columns_are_completed_by_orthogonal_ones(rows, width):
    first = -(-rows // 2)
    fan = TriangleMesh(np.zeros((rows, 3)), np.array([[0, i, i + 1] for i in range(1, rows - 1)], np.int32))
    chain, _ = chain_of(fan, replace(RULES, whole=rows))
    found = chain.dictionary(width).astype(float)
    columns = found[:, :first]
    assert np.allclose(found.T @ found, np.eye(width), rtol=0, atol=1e-5)
    both = columns + np.eye(rows, first)
    reflected = np.eye(rows) - both @ np.linalg.solve(both[:first].T, both.T)
    assert np.allclose(found[:, first:], reflected[:, first:width], rtol=0, atol=1e-5)
    assert np.allclose(chain.dictionary(first + 1), found[:, : first + 1], rtol=0, atol=0)


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
    assert len({packet.coefficients for packet in attempt.draft.body if hasattr(packet, "coefficients")}) > 2
    decoded = decode(b"".join(attempt.frames))
    error = np.abs(decoded.positions - mesh.positions[dynamic.vertex_order]).max()
    assert error == pytest.approx(attempt.comparison.max_error, rel=0.5)


SHAPES = [(1, 1), (5, 3), (9, 8), (40, 31), (64, 32), (65, 33), (90, 90), (200, 97), (200, 121)]


def onorm(columns):
    """Q of columns, which are rounded to single precision: an iteration without any solution."""
    size = len(columns)
    alone = Solver(np.zeros(size + 1, np.int32), np.empty(0, np.int32), np.ones(size))
    return alone.iterate(columns.astype(np.float32), 0, 1).astype(float)


def off(q):
    return np.abs(q.T @ q - np.eye(q.shape[1])).max()


@pytest.mark.parametrize(("n", "c"), SHAPES)
def test_q_is_that_of_a_qr_factorisation_with_positive_diagonal(n, c):
    columns = hash_columns(n, c) + 2.0 * np.eye(n, c)
    q, r = np.linalg.qr(columns)
    assert off(onorm(columns)) < 1e-3 and off(onorm(onorm(columns))) < 2e-6
    assert np.allclose(onorm(columns), q * np.sign(np.diag(r)), atol=1e-3)


@pytest.mark.parametrize("decades", [3, 9, 15])
def test_columns_that_are_close_to_dependent_are_made_orthonormal_one_by_one(decades):
    columns = hash_columns(80, 70) * np.logspace(0, -decades, 70)
    columns[:, 1:] += columns[:, :1]
    assert off(onorm(onorm(columns))) < 2e-6


@pytest.mark.parametrize("value", [0.0, np.nan, np.inf])
def test_a_column_that_is_zero_or_not_finite_is_replaced(value):
    columns = hash_columns(12, 4)
    columns[:, 2] = value
    assert off(onorm(columns)) < 1e-3 and off(onorm(onorm(columns))) < 2e-6


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 70), st.integers(1, 70), st.integers(0, 2**31), st.booleans())
def test_columns_to_the_right_change_no_bit(c, more, seed, dependent):
    columns = np.random.default_rng(seed).standard_normal((150, c + more))
    if dependent:
        columns[:, c - 1] = columns[:, c // 2]
    assert np.array_equal(onorm(columns[:, :c]), onorm(columns)[:, :c])


def test_products_are_not_fused_with_sums():
    a, b = np.float32(1 + 2.0**-12), np.float32(2.0**-9)
    found = onorm(np.array([[a, 1.0], [b, 0.0]]))
    square = a * a + b * b
    once = np.array([a, b]) * (np.float32(1) / np.sqrt(square))
    assert np.array_equal(found[:, 0].astype(np.float32), once)
