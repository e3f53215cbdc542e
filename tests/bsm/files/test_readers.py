"""Mesh files: what goes in comes out, bad files are refused, and other readers are asked where ours end."""

import gzip
import io
import json
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import (
    BsmError,
    CorruptError,
    FormatError,
    LimitError,
    Limits,
    MeshError,
    TriangleMesh,
    TruncatedError,
    read_mesh,
    save,
)
from bsm.files.sequence import open_sequence
from bsm.files.table import FORMATS, MESH_FORMATS
from tests.gltf import Built
from tests.shapes import file_of, ply_head, tetrahedron, torus

OURS = tuple(kind for kind in MESH_FORMATS if kind not in ("npz", "vtp"))


# --------------------------------------------------------------------------------------------------------------- gzip


@pytest.mark.parametrize("kind", [*OURS, "npz"])
def test_compressed_files(kind, tmp_path):
    (tmp_path / f"a.{kind}.gz").write_bytes(gzip.compress(file_of(tetrahedron(), kind)))
    assert len(read_mesh(tmp_path / f"a.{kind}.gz").mesh.faces) == 4


@pytest.mark.parametrize("kind", ["obj", "off", "ply"])
def test_a_byte_order_mark_is_no_part_of_a_file(kind):
    rows = "{}\n{}\n{}\n3 0 1 2\n"
    text = {"obj": "v {}\nv {}\nv {}\nf 1 2 3\n", "off": "OFF\n3 1 0\n" + rows}.get(
        kind, ply_head() + rows
    )
    data = text.format("5 0 0", "1 0 0", "0 1 0").encode("utf-8-sig")
    assert read_mesh(data).mesh.positions.tolist() == [[5, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_what_is_no_number_is_shown():
    with pytest.raises(MeshError, match=r"vertex 1 is not made of numbers: '1,5'$"):
        read_mesh(b"v 0 0 0\nv 1,5 0 0\nv 0 1 0\nf 1 2 3\n")


def test_damaged_compressed_files():
    whole = gzip.compress(file_of(torus(), "ply"))
    with pytest.raises(TruncatedError, match="cut short"):
        read_mesh(whole[:-20])
    with pytest.raises(CorruptError, match="damaged"):
        read_mesh(whole[:-6] + bytes(6))


def test_an_array_of_an_npz_is_as_long_as_it_says():
    file, faces = io.BytesIO(), np.tile(np.arange(3), (79_202, 1))
    np.savez(file, positions=np.eye(3), faces=faces)
    with pytest.raises(CorruptError, match="more than"):
        read_mesh(file.getvalue().replace(b"(79202, 3)", b"(19202, 3)"))


def test_the_first_places_in_a_texture_of_a_ply_are_u_and_v():
    head = ply_head(more="".join(f"property float {name}\n" for name in "uvst"))
    mesh = read_mesh((head + "0 0 0 .1 .2 .3 .4\n" * 3 + "3 0 1 2\n").encode()).mesh
    assert np.allclose([a.values[0] for a in mesh.attributes], [[0.1, 0.2], [0.3, 0.4]])


# ------------------------------------------------------------------------------------------------------------ trimesh


@pytest.fixture
def trimesh():
    return pytest.importorskip("trimesh")


def gltf(folder):
    """A glTF of one triangle whose numbers are in a file beside it, shown twice: once moved, once mirrored."""
    built = Built()
    points = built.array(
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32), min=[0, 0, 0], max=[1, 1, 0]
    )
    built.mesh(
        {"attributes": {"POSITION": points}, "indices": built.array(np.arange(3, dtype=np.uint16))}
    )
    built.nodes({"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0, "scale": [-1, 1, 1]})
    (folder / "numbers.bin").write_bytes(built.data)
    built.tree["buffers"] = [{"uri": "numbers.bin", "byteLength": len(built.data)}]
    (folder / "a.gltf").write_text(json.dumps(built.tree))
    return folder / "a.gltf"


def test_a_scene_becomes_one_mesh(trimesh, tmp_path):
    source = read_mesh(gltf(tmp_path))
    triangles = sorted(source.mesh.positions[source.mesh.faces].tolist())
    mirrored = [[0, 1, 0], [-1, 0, 0], [0, 0, 0]]
    assert triangles == [mirrored, [[5, 0, 0], [6, 0, 0], [5, 1, 0]]], (
        "what is mirrored is not inside out"
    )
    assert "2 parts were joined to one mesh" in source.notes


def test_limits_hold_before_parts_are_joined(trimesh, tmp_path):
    with pytest.raises(LimitError):
        read_mesh(gltf(tmp_path), limits=Limits(vertices=5))
    with pytest.raises(LimitError):
        read_mesh(gltf(tmp_path), limits=Limits(faces=1))


@pytest.mark.parametrize("kind", ["glb", "3mf", "dae"])
def test_formats_that_trimesh_writes(trimesh, kind, tmp_path):
    for needed in {"3mf": ("networkx", "lxml", "lib3mf"), "dae": ("collada",)}.get(kind, ()):
        pytest.importorskip(needed)
    trimesh.Trimesh(*torus_arrays(), process=False).export(tmp_path / f"a.{kind}")
    assert open_sequence(tmp_path / f"a.{kind}") is None, "a 3MF is a ZIP, as an npz is"
    mesh = read_mesh(tmp_path / f"a.{kind}").mesh
    positions, faces = torus_arrays()
    assert mesh.positions[mesh.faces] == pytest.approx(positions[faces], abs=1e-5)
    assert len(mesh.positions) == len(positions), "neither merged nor split"


def torus_arrays():
    mesh = torus(10, 8)
    return mesh.positions, mesh.faces


@pytest.mark.parametrize(
    "data", [b"glTF", b"glTF\2\0\0\0\xff\xff\xff\xff\0\0\0\0JSON{}", b"glTF" + bytes(100)]
)
def test_damaged_scenes(trimesh, data, tmp_path):
    (tmp_path / "a.glb").write_bytes(data)
    with pytest.raises(
        (FormatError, TruncatedError), match=r"not a GLB|this GLB should|a GLB begins"
    ):
        read_mesh(tmp_path / "a.glb")


TETRAHEDRON = tetrahedron()
SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"


def write(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def ply(body, vertices=4, faces=1, order="ascii"):
    return ply_head(vertices, faces, order) + body


@st.composite
def triangle_meshes(draw):
    """Any faces over points that float32 holds."""
    count = draw(st.integers(3, 12))
    number = st.floats(-100, 100, width=32).map(lambda value: value + 0.0)
    positions = draw(st.lists(st.tuples(number, number, number), min_size=count, max_size=count))
    index = st.integers(0, count - 1)
    faces = draw(st.lists(st.tuples(index, index, index), min_size=1, max_size=20))
    return TriangleMesh(np.array(positions), np.array(faces))


@pytest.mark.parametrize("kind", ["npz", "obj", "off", "ply"])
@settings(max_examples=40)
@given(mesh=triangle_meshes())
def test_any_mesh_survives(kind, mesh, tmp_path_factory):
    path = tmp_path_factory.mktemp("files") / f"mesh.{kind}"
    save(mesh, path)
    back = read_mesh(path).mesh
    assert np.array_equal(back.faces, mesh.faces)
    assert np.array_equal(back.positions, mesh.positions) or np.allclose(
        back.positions, mesh.positions, rtol=1e-8, atol=2e-6 * mesh.diagonal
    )


def test_stl_joins_equal_corners(tmp_path):
    path = tmp_path / "mesh.stl"
    save(TETRAHEDRON, path)
    source = read_mesh(path)
    assert len(path.read_bytes()) == 84 + 4 * 50
    assert np.array_equal(
        source.mesh.positions[source.mesh.faces], TETRAHEDRON.positions[TETRAHEDRON.faces]
    )
    assert len(source.mesh.positions) == 4
    assert "12 corners" in source.notes[0]


@pytest.mark.parametrize("kind", ["npz", "obj", "off", "ply"])
def test_double_precision_is_kept_where_it_matters(kind, tmp_path):
    far = TriangleMesh(TETRAHEDRON.positions * 0.1 + 1e7, TETRAHEDRON.faces)
    path = tmp_path / f"mesh.{kind}"
    save(far, path)
    assert np.array_equal(read_mesh(path).mesh.positions, far.positions)


def test_stl_refuses_to_lose_precision(tmp_path):
    path = tmp_path / "mesh.stl"
    with pytest.raises(MeshError, match="double precision"):
        save(TriangleMesh(TETRAHEDRON.positions * 0.1 + 1e7, TETRAHEDRON.faces), path)
    assert list(tmp_path.iterdir()) == []


def test_obj_counts_back_continues_lines_and_ignores_the_rest(tmp_path):
    text = (
        "# a comment\nmtllib no.mtl\no thing\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 # end\nvn 0 0 nan\nvt 0 0\n"
        "f -3/1/1 -2//1 -1/1\nl 1 2\nv 0 0 1\nf 1 2 \\\n 4\nf 1 2\nusemtl x\n"
    )
    source = read_mesh(write(tmp_path, "a.obj", text))
    assert source.mesh.faces.tolist() == [[0, 1, 2], [0, 1, 3]]
    assert len(source.mesh.positions) == 4
    assert {"lines that begin with l", "faces with fewer than three corners (1)"} <= set(
        source.dropped
    )


@pytest.mark.parametrize("line_end", ["\r\n", "\r"])
@pytest.mark.parametrize("name", ["a.obj", "a.off", "a.ply"])
def test_other_line_ends(name, line_end, tmp_path):
    texts = {
        "a.obj": "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "a.off": "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n",
        "a.ply": ply("0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n", vertices=3),
    }
    assert (
        len(read_mesh(write(tmp_path, name, texts[name].replace("\n", line_end))).mesh.faces) == 1
    )


def test_the_content_tells_the_format_where_the_name_does_not(tmp_path):
    for kind in (kind for kind in MESH_FORMATS if FORMATS[kind].begins):
        source = read_mesh(write(tmp_path, f"{kind}.dat", file_of(TETRAHEDRON, kind)))
        assert len(source.mesh.faces) == 4


@pytest.mark.parametrize("kind", MESH_FORMATS)
def test_no_library_is_needed_for_our_formats(kind, tmp_path, monkeypatch):
    save(TETRAHEDRON, tmp_path / f"a.{kind}")
    monkeypatch.setitem(sys.modules, "trimesh", None)
    assert len(read_mesh(tmp_path / f"a.{kind}").mesh.faces) == 4


NUMBER = "{} 0 0\n1 0 0\n1 1 0\n0 1 0\n"
BAD = {
    "empty.obj": ("", FormatError),
    "words.obj": ("hello, this is no mesh\n", MeshError),
    "binary.obj": (b"v 0 0 0\n\x00\x01\x02", FormatError),
    "nan.obj": ("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", MeshError),
    "zero.obj": ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", MeshError),
    "outside.obj": ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", MeshError),
    "far_back.obj": ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", MeshError),
    "fraction.obj": ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2.5\n", MeshError),
    "corner.obj": ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 /2 3 1\n", MeshError),
    "short.obj": ("v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", MeshError),
    "underscore.obj": ("v 1_0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", MeshError),
    "points.obj": ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", MeshError),
    "magic.off": ("FOO\n4 1 0\n", FormatError),
    "four.off": ("4OFF\n4 1 0\n", MeshError),
    "binary.off": ("OFF BINARY\n4 1 0\n", MeshError),
    "inf.off": ("OFF\n4 1 0\n" + NUMBER.format("inf") + "4 0 1 2 3\n", MeshError),
    "huge.off": ("OFF\n12000000 12000000 0\n" + SQUARE, TruncatedError),
    "cut.off": ("OFF\n4 1 0\n" + SQUARE, TruncatedError),
    "negative.off": ("OFF\n4 1 0\n" + SQUARE + "3 0 1 -2\n", MeshError),
    "negative_size.off": ("OFF\n4 1 0\n" + SQUARE + "-3 0 1 2\n", MeshError),
    "long_list.off": ("OFF\n4 1 0\n" + SQUARE + "400000000 0 1 2\n", MeshError),
    "magic.ply": ("plx\n", FormatError),
    "no_end.ply": ("ply\nformat ascii 1.0\n", TruncatedError),
    "no_format.ply": ("ply\nelement vertex 0\nend_header\n", FormatError),
    "type.ply": (
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n",
        FormatError,
    ),
    "nan.ply": (ply(NUMBER.format("nan") + "4 0 1 2 3\n"), MeshError),
    "large.ply": (ply(NUMBER.format("1e999") + "4 0 1 2 3\n"), MeshError),
    "outside.ply": (ply(SQUARE + "3 0 1 7\n"), MeshError),
    "points.ply": (ply(SQUARE, faces=0), MeshError),
    "huge.ply": (ply("", 12000000, 12000000), TruncatedError),
    "huge_binary.ply": (ply("", 12000000, 12000000, "binary_little_endian"), TruncatedError),
    "strips.ply": (
        ply(SQUARE).replace("element face 1", "element tristrips 1") + "4 0 1 2 3\n",
        MeshError,
    ),
    "flat.ply": (ply(SQUARE + "3 0 1 2\n").replace("float y", "float u"), MeshError),
    "no_list.ply": (ply(SQUARE + "3 0 1 2\n").replace("vertex_indices", "strange"), MeshError),
    "cut.stl": (b"\0" * 80 + (1000).to_bytes(4, "little") + bytes(50), TruncatedError),
    "short.stl": (b"\0" * 20, FormatError),
    "nan.stl": (b"\0" * 80 + (1).to_bytes(4, "little") + b"\xff" * 50, MeshError),
    "cut_text.stl": (
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n",
        TruncatedError,
    ),
    "none.stl": ("solid a\nendsolid a\n", MeshError),
    "magic.npz": (b"PK\x03\x04 and then nothing", FormatError),
    "unknown.xyz": ("0 0 0\n", FormatError),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_refused(name, tmp_path):
    content, error = BAD[name]
    with pytest.raises(error):
        read_mesh(write(tmp_path, name, content))


@pytest.mark.parametrize("kind", [*OURS, "npz"])
def test_every_truncation_is_an_error_or_fewer_faces(kind, tmp_path):
    whole = file_of(TETRAHEDRON, kind)
    for length in range(len(whole)):
        try:
            faces = len(read_mesh(write(tmp_path, f"a.{kind}", whole[:length])).mesh.faces)
        except BsmError:
            continue
        # A text file may lose its last line end, and an OBJ, which has no counts, whole lines.
        assert faces == 4 or kind == "obj", length


def npz(**arrays):
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("arrays", "error"),
    [
        ({"positions": np.zeros((3, 3))}, FormatError),
        ({"positions": np.zeros((3, 3)), "faces": np.array([[0, 1, 2.0]])}, MeshError),
        ({"positions": np.zeros((3, 3)), "faces": np.array([["a", "b", "c"]])}, MeshError),
        ({"positions": np.zeros((5, 3, 3)), "faces": np.array([[0, 1, 2]])}, MeshError),
        ({"positions": np.zeros((3, 3)), "faces": np.array([[0, 1, 3]])}, MeshError),
        ({"positions": np.array([object()]), "faces": np.array([[0, 1, 2]])}, MeshError),
        ({"positions": np.float64(1), "faces": np.array([[0, 1, 2]])}, MeshError),
    ],
)
def test_bad_arrays_are_refused(arrays, error, tmp_path):
    with pytest.raises(error):
        read_mesh(write(tmp_path, "a.npz", npz(**arrays)))


def test_an_array_that_claims_too_much_is_refused_without_allocating(tmp_path):
    content = npz(positions=np.zeros((3, 3)), faces=np.array([[0, 1, 2]], np.int32))
    huge = content.replace(b"'shape': (3, 3), }        ", b"'shape': (3000000000, 3)} ")
    assert len(huge) == len(content) and huge != content
    with pytest.raises(CorruptError):
        read_mesh(write(tmp_path, "a.npz", huge))


def test_limits_bound_the_mesh(tmp_path):
    path = tmp_path / "a.ply"
    save(TETRAHEDRON, path)
    with pytest.raises(LimitError, match="vertices"):
        read_mesh(path, limits=Limits(vertices=3))
    with pytest.raises(LimitError, match="faces"):
        read_mesh(path, limits=Limits(faces=3))
