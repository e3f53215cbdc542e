"""What counts as a mesh: objects of other libraries, arrays, files."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import ArgumentError, MeshError, TriangleMesh
from bsm.files.mesh import read_mesh, write_mesh
from bsm.libraries import as_mesh
from tests.shapes import tetrahedron, torus

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


def same(mesh, other):
    return np.array_equal(mesh.positions, other.positions) and np.array_equal(mesh.faces, other.faces)


def test_our_own_are_taken_as_they_are(tmp_path):
    mesh = torus(6, 5)
    assert as_mesh(mesh) is mesh
    write_mesh(tmp_path / "a.npz", mesh)
    assert same(as_mesh(read_mesh(tmp_path / "a.npz")), mesh)
    assert same(as_mesh(tmp_path / "a.npz"), mesh)
    assert same(as_mesh(str(tmp_path / "a.npz")), mesh)


def test_trimesh():
    trimesh = pytest.importorskip("trimesh")
    sphere = trimesh.creation.icosphere(subdivisions=1)
    mesh = as_mesh(sphere)
    assert np.array_equal(mesh.positions, sphere.vertices) and np.array_equal(mesh.faces, sphere.faces)
    scene = trimesh.Scene([sphere, sphere])
    scene.add_geometry(sphere, transform=trimesh.transformations.scale_matrix(-2, [0, 0, 0]))
    joined = as_mesh(scene)
    assert joined.faces.shape == (3 * len(sphere.faces), 3)
    assert np.array_equal(joined.positions[-len(sphere.vertices) :], -2 * sphere.vertices)
    corners = joined.positions[joined.faces].reshape(3, -1, 3, 3)
    volumes = np.linalg.det(corners).sum(axis=1) / 6
    assert volumes == pytest.approx([sphere.volume, sphere.volume, 8 * sphere.volume]), "mirrored, yet not inside out"


@pytest.mark.parametrize("points", ["vertices", "points", "positions"])
@pytest.mark.parametrize("faces", ["faces", "triangles"])
def test_any_object_with_points_and_faces(points, faces):
    mesh = tetrahedron()
    found = as_mesh(SimpleNamespace(**{points: mesh.positions.tolist(), faces: mesh.faces.tolist()}))
    assert same(found, mesh)


def test_pairs_of_arrays():
    mesh = tetrahedron()
    for pair in ((mesh.positions, mesh.faces), [mesh.positions.tolist(), mesh.faces.astype(np.uint64)]):
        assert same(as_mesh(pair), mesh)


@settings(max_examples=50)
@given(st.lists(st.integers(3, 9), min_size=1, max_size=40), st.integers(0, 1000))
def test_flat_faces_are_polygons_one_behind_the_other(sizes, seed):
    random = np.random.default_rng(seed)
    points, polygons = random.normal(size=(31, 3)), [random.integers(0, 31, size).tolist() for size in sizes]
    flat = np.concatenate([[len(polygon), *polygon] for polygon in polygons])
    expected = as_mesh((points, [*polygons, [0, 1, 2], [0, 1, 2, 3]])).faces[:-3]
    assert np.array_equal(as_mesh((points, flat)).faces, expected)


@pytest.mark.parametrize("flat", [[3, 0, 1], [3, 0, 1, 2, 3], [-1, 0, 1, 2], [3, 0, 1, 2, -3, 0, 1], [3, 0, 1, 9]])
def test_flat_faces_that_do_not_work_out(flat):
    with pytest.raises(MeshError):
        as_mesh((SQUARE, flat))


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (None, "NoneType"),
        (7, "not int"),
        (SQUARE, "ndarray"),
        ({"vertices": SQUARE}, "dict"),
        ((SQUARE, SQUARE, SQUARE), "tuple"),
        (SimpleNamespace(vertices=SQUARE), "SimpleNamespace"),
        (TriangleMesh, "type"),
    ],
)
def test_what_is_no_mesh_is_named(mesh, words):
    with pytest.raises(ArgumentError, match=f"a mesh is expected: .*{words}"):
        as_mesh(mesh)


@pytest.mark.parametrize("faces", [[[0, 1, 2.5]], [[0, 1, 2, 3.5]], [["a", "b", "c"]], [[0, 1]], [], [[0, 1], [0]]])
def test_faces_that_are_none(faces):
    with pytest.raises(MeshError):
        as_mesh((SQUARE, faces))


@pytest.mark.parametrize("positions", [[[0, 0], [1, 0], [1, 1], [0, 1]], [1, 2, 3], [["x", 0, 0]] * 4])
def test_positions_that_are_none(positions):
    for faces in ([[0, 1, 2]], [[0, 1, 2, 3]]):
        with pytest.raises(MeshError):
            as_mesh((positions, faces))
