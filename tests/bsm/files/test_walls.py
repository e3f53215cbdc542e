"""Files that claim, hide or repeat: refused in a sentence, before they take time or memory."""

import io
import json
import os
import time
import zipfile

import numpy as np
import pytest

import bsm
from bsm import Limits
from bsm.cli import main
from bsm.files.mesh import read_mesh
from bsm.files.sequence import open_sequence
from tests.gltf import Built
from tests.streams import memory_below


def npy(array):
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def moving(path, count, vertices):
    """An npz with arrays that move: zeros, of which deflate makes next to nothing."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("positions.npy", npy(np.zeros((2, vertices, 3))))
        archive.writestr("faces.npy", npy(np.array([[0, 1, 2]])))
        for number in range(count):
            archive.writestr(f"a{number}.npy", npy(np.zeros((2, vertices, 4))))


@pytest.mark.parametrize("limits", [Limits(), Limits.service()])
def test_attributes_that_move_are_counted(tmp_path, limits):
    moving(tmp_path / "a.npz", 8, 100_000)
    few = open_sequence(str(tmp_path / "a.npz"), limits=limits)
    assert len(few.attributes) == 8
    moving(tmp_path / "a.npz", 60, 100_000)
    with memory_below(50e6), pytest.raises(bsm.LimitError, match="compressed bytes"):
        open_sequence(str(tmp_path / "a.npz"), limits=limits)
    moving(tmp_path / "a.npz", 300, 3)
    many = open_sequence(str(tmp_path / "a.npz"), limits=limits)
    assert len(many.attributes) == limits.attributes and "left out" in many.notes[0]


def test_a_vtp_takes_time_as_it_is_long():
    begun = time.process_time()
    with pytest.raises(bsm.FormatError):
        read_mesh(b'<VTKFile type="PolyData">' + b"<AppendedData " * 300_000)
    with pytest.raises((bsm.FormatError, bsm.LimitError), match=r"XML is broken|over the limit"):
        read_mesh(b'<VTKFile type="PolyData">' + b"".join(b"<a%d/>" % number for number in range(300_000)))
    assert time.process_time() - begun < 5


ENCODINGS = "foo hex zip rot13 mbcs utf-7 shift_jis idna undefined punycode utf-16 cp037"


@pytest.mark.parametrize("encoding", ENCODINGS.split())
def test_strange_encodings_of_xml(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?><VTKFile type="PolyData"/>'
    with pytest.raises(bsm.FormatError):
        read_mesh(text.encode())


@pytest.mark.parametrize("vertex", [2**32 + 2, 2**31, -1, 2**63 + 2])
def test_faces_of_a_pipe_do_not_wrap(vertex):
    given = npy(np.array([[0, 1, vertex]], np.uint64 if vertex > 2**62 else np.int64)) + npy(np.eye(3))
    with pytest.raises(bsm.MeshError, match="refers to vertex"):
        open_sequence(given, "npy")


def test_a_side_that_is_true():
    with pytest.raises(bsm.CorruptError, match="shape"):
        open_sequence(npy(np.zeros((1, 3), np.int64)).replace(b"(1, 3), }   ", b"(True, 3), }"), "npy")


def test_a_header_of_an_array_is_bounded():
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("positions.npy", b"\x93NUMPY\2\0" + (1 << 25).to_bytes(4, "little") + bytes(1 << 25))
    with memory_below(10e6), pytest.raises(bsm.TruncatedError, match="the header of an npy array"):
        read_mesh(packed.getvalue(), "npz")


def test_rows_of_a_ply_without_properties_take_no_memory():
    head, vertex = b"ply\nformat binary_little_endian 1.0\nelement free 999999999999999999\n", b"element vertex 3\n"
    axes = b"".join(b"property float %c\n" % axis for axis in b"xyz")
    face = b"element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    body = np.eye(3, dtype="<f4").tobytes() + b"\3" + np.arange(3, dtype="<i4").tobytes()
    found = read_mesh(head + vertex + axes + face + body)
    assert found.mesh.faces.tolist() == [[0, 1, 2]] and found.dropped == ("free",)


def test_a_gltf_whose_buffer_is_no_file(tmp_path):
    """A pipe would be waited for, a link to itself be followed for ever."""
    pytest.importorskip("trimesh")
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    built = Built()
    built.nodes({"mesh": built.mesh({"attributes": {"POSITION": built.array(np.eye(3, dtype=np.float32))}})})
    for uri in ("pipe", "loop"):
        tree = built.tree | {"buffers": [{"uri": uri, "byteLength": 36}]}
        (tmp_path / "a.gltf").write_text(json.dumps(tree))
        with pytest.raises(bsm.FormatError, match=r"no such file|cannot be opened"):
            read_mesh(tmp_path / "a.gltf")


def test_a_gltf_is_not_granted_what_it_claims():
    pytest.importorskip("trimesh")
    tree = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "data:application/octet-stream;base64,", "byteLength": 10**400}],
        "accessors": [{"componentType": 5125, "count": 10**8, "type": "SCALAR"}],
        "meshes": [{"primitives": [{"attributes": {}, "indices": 0}]}],
        "nodes": [{"mesh": 0}],
    }
    with pytest.raises(bsm.LimitError, match="vertices"):
        read_mesh(json.dumps(tree).encode(), "gltf")


HEADS = {
    "ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 20000000\nproperty float x\nproperty float y\n"
    b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n",
    "stl": bytes(80) + (40_000_000).to_bytes(4, "little"),
    "off": b"# a scan\nOFF\n20000000 1 0\n",
}


@pytest.mark.parametrize("kind", HEADS)
def test_too_many_vertices_are_refused_from_the_head(tmp_path, kind, capsys):
    path = tmp_path / f"a.{kind}"
    with open(path, "wb") as file:
        file.write(HEADS[kind])
        file.truncate(300_000_000)
    with memory_below(10e6), pytest.raises(bsm.LimitError, match=r"over the limit of .*; cut it into parts"):
        read_mesh(path)
    assert main(["encode", str(path), "-o", str(tmp_path / "a.bsm")]) == 6
    assert "cut it into parts" in capsys.readouterr().err


def test_an_npz_of_too_many_vertices(tmp_path):
    moving(tmp_path / "a.npz", 0, 1000)
    with pytest.raises(bsm.LimitError, match="vertices = 1,000 is over the limit of 999; cut it into parts"):
        open_sequence(str(tmp_path / "a.npz"), limits=Limits(vertices=999))
