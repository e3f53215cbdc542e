"""Meshes whose vertices are numbered differently."""

import numpy as np
import pytest

import bsm
from bsm import EncodeOptions, Encoder, FormatError, MeshError, TriangleMesh, decode
from bsm.comparison import in_order_of, read_permutation, reorder, write_permutation
from bsm.evaluation.sample import knot
from tests.shapes import soup

SAMPLE = knot(600)


def renumbered(mesh, order):
    """Vertex j of the result is vertex order[j] of `mesh`."""
    places = np.argsort(order)
    return TriangleMesh(mesh.positions[order], places[mesh.faces])


@pytest.fixture(scope="module")
def order():
    return np.random.default_rng(0).permutation(len(SAMPLE.positions))


def test_reorder_undoes_a_numbering(order):
    back = reorder(renumbered(SAMPLE, order), order)
    assert np.array_equal(back.positions, SAMPLE.positions)
    assert np.array_equal(back.faces, SAMPLE.faces)


def test_equal_numbering_is_recognized_whatever_the_order_of_faces_and_corners():
    shuffled = np.random.default_rng(1).permutation(np.roll(SAMPLE.faces, 1, axis=1))
    other = TriangleMesh(SAMPLE.positions + 1, shuffled)
    assert np.array_equal(in_order_of(SAMPLE, other), other.positions)


@pytest.mark.parametrize("shift", range(4))
def test_a_symmetric_mesh_is_matched_vertex_by_vertex(shift):
    from bsm.bitstream.connectivity.faces import encode_connectivity

    faces = np.roll(np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]), shift, axis=0)
    mesh = TriangleMesh(np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]]), faces)
    coded = encode_connectivity(faces, 4)
    decoded = TriangleMesh(mesh.positions[coded.vertex_order], coded.faces)
    assert np.array_equal(in_order_of(mesh, decoded), mesh.positions)


def test_other_faces_are_refused(order):
    flipped = TriangleMesh(SAMPLE.positions, SAMPLE.faces[:, ::-1])
    with pytest.raises(MeshError, match="--permutation"):
        in_order_of(SAMPLE, flipped)
    with pytest.raises(MeshError, match="different faces"):
        in_order_of(SAMPLE, renumbered(SAMPLE, order), np.arange(len(order)))
    with pytest.raises(MeshError, match="faces"):
        in_order_of(SAMPLE, TriangleMesh(SAMPLE.positions, SAMPLE.faces[1:]))
    with pytest.raises(MeshError, match="permutation"):
        reorder(SAMPLE, order[1:])


def test_files(tmp_path, order):
    path = tmp_path / "order.npy"
    write_permutation(path, order, overwrite=False)
    assert np.array_equal(read_permutation(path), order)
    for content in (b"", b"no array", path.read_bytes()[:-8]):
        path.write_bytes(content)
        with pytest.raises(FormatError):
            read_permutation(path)
    for wrong in (np.zeros(3), np.zeros(3, int), np.zeros((2, 2), int)):
        np.save(path, wrong)
        with pytest.raises(FormatError):
            read_permutation(path)


def test_vertices_that_were_made_one_are_compared_with_that_one():
    mesh = knot(200)
    apart = soup(mesh)
    encoder = Encoder(apart, EncodeOptions(grid=16))
    decoded = decode(encoder.encode())
    for order in (None, encoder.vertex_order):
        assert np.abs(in_order_of(apart, decoded, order) - apart.positions).max() < 1e-3


def test_an_order_counts_vertices_that_no_face_uses(tmp_path):
    apart, near = np.full((2, 3), 9.0), np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]])
    mesh = TriangleMesh(np.concatenate([apart, near]), [[2, 3, 4], [5, 6, 7]])
    for keep in (False, True):
        encoder = Encoder(mesh, EncodeOptions(grid=10, keep_order=keep))
        decoded, order = decode(encoder.encode()), encoder.vertex_order
        assert bsm.compare(mesh, decoded, order=order).max_error_relative < 1e-3
    for wrong in (order * 0, order + 1, order[1:]):
        with pytest.raises(MeshError, match="permutation"):
            bsm.compare(mesh, decoded, order=wrong)


def test_a_mesh_that_a_file_split_is_compared_where_rounding_merged_vertices():
    decoded = decode(bsm.encode(SAMPLE, grid=4))
    found = bsm.compare(SAMPLE, soup(decoded))
    assert found.merged > 0 and found == bsm.compare(SAMPLE, decoded)
