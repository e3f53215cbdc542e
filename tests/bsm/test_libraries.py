"""Meshes of other libraries: which are taken, with what they show; trimesh and pyvista open and write .bsm."""

import importlib
import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bsm
from bsm import ArgumentError, Attribute, MeshError, TriangleMesh, read_mesh
from bsm.files.libraries import as_mesh
from tests.bsm.files.test_file_attributes import attribute, dressed, png
from tests.bsm.program import declare_entry_points, python
from tests.shapes import at_corners, tetrahedron, torus

EXACT = {"preset": "grid14", "keep_order": True, "attributes": {"*": "exact"}}
SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


def painted(mesh=None, **more):
    """A mesh with texture coordinates that have a seam, normals, a number for each vertex and face, and an image."""
    mesh = mesh or torus(12, 9)
    m, n = len(mesh.faces), len(mesh.positions)
    uv = mesh.positions[:, :2].astype(np.float32) / 3
    indices = mesh.faces.copy()
    indices[: m // 2] += n  # the first half has texture coordinates of its own
    attributes = (
        Attribute("texcoord", np.vstack([uv, uv + 0.5]), "corner", "texcoord", indices),
        Attribute("height", mesh.positions[:, 2].astype(np.float32)),
        Attribute("label", np.arange(m) % 7, "face"),
    )
    metadata = {
        "name": "ring",
        "unit": "mm",
        "material.0.name": "skin",
        "material.0.map_Kd": 0,
        "image.0.data": png(),
        **more,
    }
    return TriangleMesh(mesh.positions, mesh.faces, attributes, metadata)


# ------------------------------------------------------------------------------------------------------------ trimesh


@pytest.fixture
def trimesh():
    pytest.importorskip("PIL")
    library = pytest.importorskip("trimesh")
    importlib.import_module("bsm.trimesh")
    return library


@pytest.mark.parametrize("names", ["bsm, trimesh", "trimesh, bsm"])
def test_trimesh_knows_streams_once_both_are_imported(names):
    code = f"import {names}; assert 'bsm' in trimesh.available_formats()"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_trimesh_loads_a_stream(trimesh, tmp_path):
    mesh = painted()
    bsm.save(mesh, tmp_path / "a.bsm", **EXACT)
    for loaded in (
        trimesh.load_mesh(tmp_path / "a.bsm"),
        trimesh.load(str(tmp_path / "a.bsm"), force="mesh"),
    ):
        assert isinstance(loaded, trimesh.Trimesh)
        assert loaded.triangles == pytest.approx(mesh.positions[mesh.faces], abs=1e-3)
        assert np.array_equal(
            loaded.visual.uv[loaded.faces], at_corners(mesh, attribute(mesh, "texcoord"))
        )
        assert loaded.visual.material.name == "skin"
        assert loaded.visual.material.baseColorTexture.getpixel((0, 0)) == (200, 10, 20)
        assert np.array_equal(loaded.face_attributes["label"], np.arange(len(mesh.faces)) % 7)
        assert loaded.vertex_attributes["height"].shape == (len(loaded.vertices),)
        assert (loaded.units, loaded.metadata["name"]) == ("mm", "ring")
    scene = trimesh.load_scene(tmp_path / "a.bsm")
    assert len(scene.geometry) == 1


def test_trimesh_exports_a_stream(trimesh, tmp_path):
    mesh = painted()
    theirs = bsm.trimesh.to_trimesh(mesh)
    theirs.export(tmp_path / "b.bsm", **EXACT)
    assert theirs.export(file_type="bsm", **EXACT) == (tmp_path / "b.bsm").read_bytes()
    again = bsm.load(tmp_path / "b.bsm")
    assert again.positions[again.faces] == pytest.approx(mesh.positions[mesh.faces], abs=1e-3)
    for name in ("texcoord", "height", "label"):
        assert np.array_equal(
            at_corners(again, attribute(again, name)), at_corners(mesh, attribute(mesh, name))
        )
    assert again.metadata["image.0.data"] == png()
    assert (again.metadata["unit"], again.metadata["name"]) == ("mm", "ring")


@pytest.mark.parametrize("domain", ["vertex", "face"])
def test_colors_of_trimesh(trimesh, domain):
    sphere = trimesh.creation.icosphere(subdivisions=2)
    size = len(sphere.vertices if domain == "vertex" else sphere.faces)
    colors = np.random.default_rng(1).integers(0, 256, (size, 4), np.uint8)
    sphere.visual = trimesh.visual.ColorVisuals(sphere, **{f"{domain}_colors": colors})
    ours = bsm.trimesh.from_trimesh(sphere)
    assert (
        np.array_equal(attribute(ours, "color").values, colors)
        and attribute(ours, "color").domain == domain
    )
    back = bsm.trimesh.to_trimesh(bsm.decode(bsm.encode(sphere, **EXACT)))
    assert (
        np.array_equal(getattr(back.visual, f"{domain}_colors"), colors)
        and back.visual.kind == domain
    )


def test_several_materials_of_trimesh(trimesh):
    mesh = dressed()
    loaded = bsm.trimesh.to_trimesh(mesh)
    assert [material.name for material in loaded.visual.material.materials] == ["red", "painted"]
    again = bsm.trimesh.from_trimesh(loaded)
    assert np.array_equal(attribute(again, "material").values, attribute(mesh, "material").values)
    assert (
        again.metadata["material.1.name"] == "painted" and again.metadata["image.0.data"] == png()
    )


def test_a_mesh_of_parts_is_a_scene_of_trimesh(trimesh):
    first, second = bsm.trimesh.to_trimesh(painted()), trimesh.creation.box()
    second.metadata["maker"] = "somebody"
    ours = bsm.trimesh.from_trimesh(trimesh.Scene({"ring": first, "box": second}))
    scene = bsm.trimesh.to_scene(bsm.decode(bsm.encode(ours, **EXACT)))
    assert set(scene.geometry) == {"ring", "box"} and scene.metadata["maker"] == "somebody"
    ring, box = scene.geometry["ring"], scene.geometry["box"]
    assert len(ring.faces) == len(first.faces) and len(box.faces) == len(second.faces)
    assert ring.visual.material.baseColorTexture is not None
    assert not hasattr(box.visual, "material") or box.visual.material.baseColorTexture is None
    np.testing.assert_allclose(ring.bounds, first.bounds, atol=1e-3)
    assert np.bincount(
        attribute(bsm.trimesh.from_trimesh(scene), "part").values[:, 0]
    ).tolist() == [len(first.faces), len(second.faces)]
    alone = bsm.trimesh.to_scene(trimesh.creation.box())
    assert len(alone.geometry) == 1


def test_parts_without_a_material_get_none(trimesh, tmp_path):
    first, second = bsm.trimesh.to_trimesh(painted()), trimesh.creation.box()
    trimesh.Scene({"box": second, "ring": first, "other": second}).export(tmp_path / "a.glb")
    ours = bsm.load(tmp_path / "a.glb")
    for again in (ours, bsm.decode(bsm.encode(ours))):
        bsm.save(again, tmp_path / "b.glb")
        shown = trimesh.load_scene(tmp_path / "b.glb").geometry
        images = {name: part.visual.material.baseColorTexture for name, part in shown.items()}
        assert images["ring"] is not None and images["box"] is None and images["other"] is None
        found = bsm.load(tmp_path / "b.glb")
        kinds = [
            sorted(name.split(".")[::2] for name in mesh.metadata if name[0] in "mi")
            for mesh in (found, ours)
        ]
        assert kinds[0] == kinds[1]
        skin = next(
            name.split(".")[1] for name in found.metadata if name.endswith("baseColorTexture")
        )
        numbers = attribute(found, "material").values[:, 0]
        assert (numbers == int(skin)).sum() == len(first.faces) and len(numbers) == len(
            first.faces
        ) + 2 * len(second.faces)
    whole = bsm.trimesh.to_trimesh(ours).visual
    assert len(whole.material.materials) == 2 and np.bincount(whole.face_materials)[1] == 2 * len(
        second.faces
    )


def test_hostile_images_and_materials(trimesh):
    mesh = painted(
        **{
            "image.0.data": b"\x89PNG\r\n\x1a\n" + bytes(20),
            "material.0.Kd": "a b c",
            "material.5.d": "x",
        }
    )
    loaded = bsm.trimesh.to_trimesh(mesh)
    assert loaded.visual.uv is not None


# ------------------------------------------------------------------------------------------------------------ pyvista


@pytest.fixture
def pyvista():
    library = pytest.importorskip("pyvista", minversion="0.48")
    importlib.import_module("bsm.pyvista")
    return library


def test_pyvista_and_back(pyvista):
    mesh = painted()
    theirs = bsm.pyvista.to_pyvista(mesh)
    assert theirs.is_all_triangles and theirs.n_cells == len(mesh.faces)
    assert set(theirs.point_data) == {"texcoord", "height"} and set(theirs.cell_data) == {"label"}
    assert theirs.active_texture_coordinates.shape == (theirs.n_points, 2)
    again = bsm.pyvista.from_pyvista(theirs)
    assert again.metadata == mesh.metadata
    for name in ("texcoord", "height", "label"):
        found = attribute(again, name)
        assert np.array_equal(at_corners(again, found), at_corners(mesh, attribute(mesh, name)))
        assert found.semantic == attribute(mesh, name).semantic


def test_what_pyvista_shows_is_taken(pyvista):
    sphere = pyvista.Sphere(theta_resolution=8, phi_resolution=6)
    sphere["quality"] = np.arange(sphere.n_points)
    sphere.point_data["RGB"] = np.full((sphere.n_points, 3), 7, np.uint8)
    ours = as_mesh(sphere)
    assert {(a.name, a.semantic) for a in ours.attributes} == {
        ("Normals", "normal"),
        ("quality", "generic"),
        ("RGB", "color"),
    }
    quads = pyvista.PolyData(SQUARE, [4, 0, 1, 2, 3, 3, 0, 2, 1], lines=[2, 0, 1])
    quads.cell_data["kind"] = [5, 6, 7]  # of the line, the square, the triangle
    assert attribute(as_mesh(quads), "kind").values[:, 0].tolist() == [6, 6, 7]


SCRIPT = """
import sys
import numpy, pyvista
mesh = pyvista.read(sys.argv[1])
assert set(mesh.point_data) == {"texcoord", "height"}, mesh
mesh["twice"] = 2 * mesh["height"]
mesh.save(sys.argv[2], preset="near-lossless")
again = pyvista.read(sys.argv[2])
assert numpy.allclose(again["twice"], 2 * again["height"], atol=1e-2)
try:
    pyvista.read(sys.argv[3])
except Exception as error:
    print(type(error).__name__)
"""


def test_pyvista_by_its_entry_points(pyvista, tmp_path):
    """As it is when the package is installed: by the entry points of pyproject.toml, and nothing else is imported."""
    site = declare_entry_points(tmp_path / "site")
    bsm.save(painted(), tmp_path / "a.bsm", **EXACT)
    (tmp_path / "c.bsm").write_bytes(b"nothing")
    streams = (tmp_path / f"{name}.bsm" for name in "abc")
    path = os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")])
    done = python("-c", SCRIPT, *streams, env={**os.environ, "PYTHONPATH": path}, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "FormatError"
    assert bsm.load(tmp_path / "b.bsm").metadata["unit"] == "mm"


# ------------------------------------------------------------------------------------------------------------- others


def test_open3d():
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    theirs = open3d.geometry.TriangleMesh.create_sphere(resolution=6)
    theirs.compute_vertex_normals()
    theirs.vertex_colors = open3d.utility.Vector3dVector(
        np.full((len(theirs.vertices), 3), 51 / 255)
    )
    theirs.triangle_uvs = open3d.utility.Vector2dVector(
        np.random.default_rng(0).random((3 * len(theirs.triangles), 2))
    )
    theirs.triangle_material_ids = open3d.utility.IntVector(
        [i % 3 for i in range(len(theirs.triangles))]
    )
    ours = as_mesh(theirs)
    assert [(a.name, a.domain) for a in ours.attributes] == [
        ("normal", "vertex"),
        ("color", "vertex"),
        ("texcoord", "corner"),
        ("material", "face"),
    ]
    assert (attribute(ours, "color").values == 51).all()
    uv = np.asarray(theirs.triangle_uvs).reshape(-1, 3, 2)
    assert at_corners(ours, attribute(ours, "texcoord")) == pytest.approx(uv, abs=1e-6)


def test_meshio_data():
    meshio = pytest.importorskip("meshio")
    cells = [
        ("line", [[0, 1]]),
        ("quad", [[0, 1, 2, 3]]),
        ("triangle", np.array([[0, 1, 2]], np.uint64)),
    ]
    theirs = meshio.Mesh(
        SQUARE, cells, {"height": [1.0, 2, 3, 4]}, {"kind": [[1], [2], [3]]}, info=["by hand"]
    )
    with pytest.warns(bsm.BsmWarning, match=r"cells of the type line \(1\), info \(by hand\)"):
        ours = as_mesh(theirs)
    assert len(ours.faces) == 3
    ragged = meshio.Mesh(SQUARE, [("polygon", [[0, 1, 2, 3]]), ("polygon", [[0, 1, 2]])])
    # It has a `read`, too.
    assert len(as_mesh(ragged).faces) == 3 and bsm.look(ragged, ragged).distance == 0.0
    with pytest.raises(bsm.MeshError, match="cells of the type tetra20"):
        as_mesh(meshio.Mesh(SQUARE, [("tetra20", [[0] * 20])]))


@pytest.mark.parametrize("library", ["trimesh", "pyvista"])
def test_where_a_library_is_missing_the_way_out_is_reported(library, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    monkeypatch.delitem(sys.modules, f"bsm.{library}", raising=False)
    with pytest.raises(bsm.DependencyError, match=r"pip install .*\[\w+\]"):
        importlib.import_module(f"bsm.{library}").to_pyvista(painted())


def same(mesh, other):
    return np.array_equal(mesh.positions, other.positions) and np.array_equal(
        mesh.faces, other.faces
    )


def test_our_own_are_taken_as_they_are(tmp_path):
    mesh = torus(6, 5)
    assert as_mesh(mesh) is mesh
    bsm.save(mesh, tmp_path / "a.npz")
    assert same(as_mesh(read_mesh(tmp_path / "a.npz")), mesh)
    assert same(as_mesh(tmp_path / "a.npz"), mesh)


def test_trimesh(trimesh):
    sphere = trimesh.creation.icosphere(subdivisions=1)
    mesh = as_mesh(sphere)
    assert np.array_equal(mesh.positions, sphere.vertices) and np.array_equal(
        mesh.faces, sphere.faces
    )
    scene = trimesh.Scene([sphere, sphere])
    scene.add_geometry(sphere, transform=trimesh.transformations.scale_matrix(-2, [0, 0, 0]))
    joined = as_mesh(scene)
    assert joined.faces.shape == (3 * len(sphere.faces), 3)
    assert np.array_equal(joined.positions[-len(sphere.vertices) :], -2 * sphere.vertices)
    corners = joined.positions[joined.faces].reshape(3, -1, 3, 3)
    volumes = np.linalg.det(corners).sum(axis=1) / 6
    assert volumes == pytest.approx([sphere.volume, sphere.volume, 8 * sphere.volume]), (
        "mirrored, yet not inside out"
    )


@pytest.mark.parametrize("points", ["vertices", "points", "positions"])
@pytest.mark.parametrize("faces", ["faces", "triangles"])
def test_any_object_with_points_and_faces(points, faces):
    mesh = tetrahedron()
    found = as_mesh(
        SimpleNamespace(**{points: mesh.positions.tolist(), faces: mesh.faces.tolist()})
    )
    assert same(found, mesh)


def test_pairs_of_arrays():
    mesh = tetrahedron()
    for pair in (
        (mesh.positions, mesh.faces),
        [mesh.positions.tolist(), mesh.faces.astype(np.uint64)],
    ):
        assert same(as_mesh(pair), mesh)


@settings(max_examples=50)
@given(st.lists(st.integers(3, 9), min_size=1, max_size=40), st.integers(0, 1000))
def test_flat_faces_are_polygons_one_behind_the_other(sizes, seed):
    random = np.random.default_rng(seed)
    points, polygons = (
        random.normal(size=(31, 3)),
        [random.integers(0, 31, size).tolist() for size in sizes],
    )
    flat = np.concatenate([[len(polygon), *polygon] for polygon in polygons])
    expected = as_mesh((points, [*polygons, [0, 1, 2], [0, 1, 2, 3]])).faces[:-3]
    assert np.array_equal(as_mesh((points, flat)).faces, expected)


@pytest.mark.parametrize(
    "flat", [[3, 0, 1], [3, 0, 1, 2, 3], [-1, 0, 1, 2], [3, 0, 1, 2, -3, 0, 1], [3, 0, 1, 9]]
)
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


@pytest.mark.parametrize(
    "faces", [[[0, 1, 2.5]], [[0, 1, 2, 3.5]], [["a", "b", "c"]], [[0, 1]], [], [[0, 1], [0]]]
)
def test_faces_that_are_none(faces):
    with pytest.raises(MeshError):
        as_mesh((SQUARE, faces))


@pytest.mark.parametrize(
    "positions", [[[0, 0], [1, 0], [1, 1], [0, 1]], [1, 2, 3], [["x", 0, 0]] * 4]
)
def test_positions_that_are_none(positions):
    for faces in ([[0, 1, 2]], [[0, 1, 2, 3]]):
        with pytest.raises(MeshError):
            as_mesh((positions, faces))


# ----------------------------------------------------------------------------------------------------------- openmesh


def test_openmesh_gives_and_takes_what_it_shows():
    pytest.importorskip("openmesh")
    from bsm.openmesh import from_openmesh, to_openmesh

    with pytest.warns(bsm.BsmWarning, match="height"):
        made = to_openmesh(painted())
    back = from_openmesh(made)
    assert {a.name: a.domain for a in back.attributes} == {"texcoord": "vertex"}
    split = bsm.decode(bsm.encode(made, **EXACT))
    assert np.array_equal(split.faces, back.faces) and np.allclose(
        split.positions, back.positions, atol=1e-4
    )
    again = to_openmesh(back)
    for name in ("points", "fv_indices", "vertex_texcoords2D"):
        assert np.array_equal(getattr(again, name)(), getattr(made, name)())
    fan = TriangleMesh(np.eye(5, 3), np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]], np.int32))
    with pytest.raises(MeshError, match="2 of 3 faces"):
        to_openmesh(fan)


def test_corners_and_polygons_of_openmesh():
    openmesh = pytest.importorskip("openmesh")
    polygons = openmesh.PolyMesh(
        np.vstack([SQUARE, [[2.0, 0, 0]]]), np.array([[0, 1, 2, 3], [1, 4, 2, -1]])
    )
    assert as_mesh(polygons).faces.tolist() == [[0, 1, 2], [0, 2, 3], [1, 4, 2]]
    mesh = openmesh.TriMesh(SQUARE, np.array([[0, 1, 2], [0, 2, 3]]))
    ends = mesh.halfedge_to_vertex_indices()
    for face, row in enumerate(mesh.fh_indices()):
        mesh.halfedge_texcoords2D()[row] = SQUARE[ends[row], :2] + face
    (uv,) = as_mesh(mesh).attributes
    expected = SQUARE[mesh.fv_indices(), :2] + np.arange(2)[:, None, None]
    assert uv.semantic == "texcoord" and np.array_equal(uv.values[uv.indices], expected)
    mesh.delete_face(mesh.face_handle(0))
    with pytest.raises(MeshError, match=r"garbage_collection\(\)"):
        bsm.encode(mesh)
    mesh.garbage_collection()
    assert len(as_mesh(mesh).faces) == 1
