import numpy as np
import pytest
import scipy.linalg

from bsm import NumericError
from bsm.codec.basis.laplacian import dense_laplacian, factorize, laplacian_of
from bsm.codec.basis.orthogonal_iteration import (
    completed,
    cosine_columns,
    exact_basis,
    first_columns,
    hash_columns,
    orthogonal_iteration,
)
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import graph_of_faces
from tests.shapes import patch, torus


def whole(faces, size):
    graph = graph_of_faces(faces, size)
    return Block(np.arange(size, dtype=np.int32), graph.offsets, graph.neighbors)


def span_distance(a, b):
    return np.linalg.norm(a - b @ (b.T @ a))


def test_iterations_converge_to_the_lowest_eigenvectors():
    mesh = patch(17, 23)
    block = whole(mesh.faces, len(mesh.positions))
    values, vectors = scipy.linalg.eigh(dense_laplacian(block))
    width = 10 + int(np.argmax(np.diff(values)[9:30]))
    subspace = orthogonal_iteration(
        factorize(laplacian_of(block), 0.01), first_columns(block.size, width, noisy=False), power=4, iterations=60
    )
    assert span_distance(subspace, vectors[:, :width]) < 1e-4


@pytest.mark.parametrize("mesh", [patch(17, 23), torus(20, 20)])
def test_the_exact_basis_is_exact_to_the_tolerance_that_it_states(mesh):
    """Its Rayleigh quotients against LAPACK's eigenvalues, of a torus with many equal ones too."""
    block = whole(mesh.faces, len(mesh.positions))
    matrix = dense_laplacian(block)
    basis = exact_basis(laplacian_of(block), first_columns(block.size, 57, noisy=True), 0.01)
    assert np.allclose(basis.T @ basis, np.eye(57), atol=1e-5)
    quotients = np.cumsum(np.einsum("ij,ij->j", basis, matrix @ basis) + 0.01)
    least = np.cumsum(np.linalg.eigvalsh(matrix)[:57] + 0.01)
    assert np.all(quotients >= least * (1 - 1e-4))
    assert np.all(quotients <= 1.001 * least)


def test_a_truncated_start_gives_the_truncated_subspace():
    block = whole(patch(15, 15).faces, 225)
    factor = factorize(laplacian_of(block), 0.125)
    wide = orthogonal_iteration(factor, first_columns(225, 30, noisy=False), power=2, iterations=1)
    narrow = orthogonal_iteration(factor, first_columns(225, 12, noisy=False), power=2, iterations=1)
    assert np.array_equal(wide[:, :12], narrow)


@pytest.mark.parametrize(
    ("rows", "first", "width"), [(2, 1, 2), (5, 2, 5), (33, 11, 30), (321, 107, 321), (322, 108, 200)]
)
def test_columns_are_completed_by_orthogonal_ones(rows, first, width):
    columns = np.linalg.qr(cosine_columns(rows, first) + 0.3 * hash_columns(rows, first))[0].astype(np.float32)
    columns *= np.sign(columns[:1])
    found = completed(columns, width)
    assert np.array_equal(found[:, :first], columns)
    assert np.allclose(found.T @ found, np.eye(width), rtol=0, atol=1e-5)
    both = columns + np.eye(rows, first)
    reflected = np.eye(rows) - both @ np.linalg.solve(both[:first].T, both.T)
    assert np.allclose(found[:, first:], reflected[:, first:width], rtol=0, atol=1e-5)
    assert np.allclose(completed(columns, first + 1), found[:, : first + 1], rtol=0, atol=0)


def test_what_cannot_be_completed_is_an_error():
    with pytest.raises(NumericError, match="completed"):
        completed(-np.eye(6, 2, dtype=np.float32), 5)
