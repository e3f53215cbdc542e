"""What mesh files hold beside positions and faces, and who can be asked to read them."""

import gzip
import io
import json

import numpy as np
import pytest

from bsm import CorruptError, FormatError, LimitError, Limits, MeshError, TruncatedError
from bsm.files.mesh import read_mesh, written_mesh
from bsm.files.sequence import open_sequence
from tests.gltf import Built
from tests.shapes import tetrahedron, torus

OURS = ("obj", "off", "ply", "stl")


# --------------------------------------------------------------------------------------------------------------- gzip


@pytest.mark.parametrize("kind", [*OURS, "npz"])
def test_compressed_files(kind, tmp_path):
    (tmp_path / f"a.{kind}.gz").write_bytes(gzip.compress(written_mesh(tetrahedron(), kind).data))
    assert len(read_mesh(tmp_path / f"a.{kind}.gz").mesh.faces) == 4


@pytest.mark.parametrize("kind", ["obj", "off", "ply"])
def test_a_byte_order_mark_is_no_part_of_a_file(kind):
    text = {"obj": "v {}\nv {}\nv {}\nf 1 2 3\n", "off": "OFF\n3 1 0\n{}\n{}\n{}\n3 0 1 2\n"}.get(
        kind,
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n{}\n{}\n{}\n3 0 1 2\n",
    )
    data = text.format("5 0 0", "1 0 0", "0 1 0").encode("utf-8-sig")
    assert read_mesh(data).mesh.positions.tolist() == [[5, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_what_is_no_number_is_shown():
    with pytest.raises(MeshError, match=r"a vertex is not made of numbers: '1,5'$"):
        read_mesh(b"v 0 0 0\nv 1,5 0 0\nv 0 1 0\nf 1 2 3\n")


def test_damaged_compressed_files():
    whole = gzip.compress(written_mesh(torus(), "ply").data)
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
    names = "".join(f"property float {name}\n" for name in "xyzuvst")
    head = f"ply\nformat ascii 1.0\nelement vertex 3\n{names}element face 1\nproperty list uchar int vertex_indices\n"
    mesh = read_mesh((head + "end_header\n" + "0 0 0 .1 .2 .3 .4\n" * 3 + "3 0 1 2\n").encode()).mesh
    assert np.allclose([a.values[0] for a in mesh.attributes], [[0.1, 0.2], [0.3, 0.4]])


# ------------------------------------------------------------------------------------------------------------ trimesh


@pytest.fixture
def trimesh():
    return pytest.importorskip("trimesh")


def gltf(folder):
    """A glTF of one triangle whose numbers are in a file beside it, shown twice: once moved, once mirrored."""
    built = Built()
    points = built.array(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32), min=[0, 0, 0], max=[1, 1, 0])
    built.mesh({"attributes": {"POSITION": points}, "indices": built.array(np.arange(3, dtype=np.uint16))})
    built.nodes({"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0, "scale": [-1, 1, 1]})
    (folder / "numbers.bin").write_bytes(built.data)
    built.tree["buffers"] = [{"uri": "numbers.bin", "byteLength": len(built.data)}]
    (folder / "a.gltf").write_text(json.dumps(built.tree))
    return folder / "a.gltf"


def test_a_scene_becomes_one_mesh(trimesh, tmp_path):
    source = read_mesh(gltf(tmp_path))
    triangles = sorted(source.mesh.positions[source.mesh.faces].tolist())
    mirrored = [[0, 1, 0], [-1, 0, 0], [0, 0, 0]]
    assert triangles == [mirrored, [[5, 0, 0], [6, 0, 0], [5, 1, 0]]], "what is mirrored is not inside out"
    assert "2 parts were joined to one mesh" in source.notes


def test_limits_hold_before_parts_are_joined(trimesh, tmp_path):
    with pytest.raises(LimitError):
        read_mesh(gltf(tmp_path), limits=Limits(vertices=5))
    with pytest.raises(LimitError):
        read_mesh(gltf(tmp_path), limits=Limits(faces=1))


@pytest.mark.parametrize("kind", ["glb", "3mf", "dae"])
def test_formats_that_trimesh_writes(trimesh, kind, tmp_path):
    for needed in {"3mf": ("networkx", "lxml"), "dae": ("collada",)}.get(kind, ()):
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


@pytest.mark.parametrize("data", [b"glTF", b"glTF\2\0\0\0\xff\xff\xff\xff\0\0\0\0JSON{}", b"glTF" + bytes(100)])
def test_damaged_scenes(trimesh, data, tmp_path):
    (tmp_path / "a.glb").write_bytes(data)
    with pytest.raises((FormatError, TruncatedError), match=r"not a GLB|this GLB should|a GLB begins"):
        read_mesh(tmp_path / "a.glb")
