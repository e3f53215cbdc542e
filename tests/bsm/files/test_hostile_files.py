"""Files that claim, hide, repeat, multiply or choke other tools: refused in a sentence, in little time and memory."""

import gzip
import io
import json
import os
import sys
import time
import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import CorruptError, FormatError, LimitError, Limits, MeshError, TruncatedError, read_mesh
from bsm.bitstream import errors
from bsm.cli import main
from bsm.files.parsing import gunzipped
from bsm.files.table import format_of_bytes
from tests.bsm.program import bound, python
from tests.bsm.program import bsm as program
from tests.gltf import Built
from tests.motion import sequence_in
from tests.shapes import file_of, ply_head
from tests.streams import memory_below
from tools.attack.readers import Case, chained_objects, grown, problems, three_mf, warm_up
from tools.vectors.meshes import torus

LITTLE = "binary_little_endian"


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
    few = sequence_in(str(tmp_path / "a.npz"), limits=limits)
    assert len(few.attributes) == 8
    moving(tmp_path / "a.npz", 60, 100_000)
    with memory_below(50e6), pytest.raises(bsm.LimitError, match="compressed bytes"):
        sequence_in(str(tmp_path / "a.npz"), limits=limits)
    moving(tmp_path / "a.npz", 300, 3)
    many = sequence_in(str(tmp_path / "a.npz"), limits=limits)
    assert len(many.attributes) == limits.attributes and "left out" in many.notes[0]


def test_a_vtp_takes_time_as_it_is_long():
    begun = time.process_time()
    with pytest.raises(bsm.FormatError):
        read_mesh(b'<VTKFile type="PolyData">' + b"<AppendedData " * 300_000)
    with pytest.raises((bsm.FormatError, bsm.LimitError), match=r"XML is broken|over the limit"):
        read_mesh(
            b'<VTKFile type="PolyData">' + b"".join(b"<a%d/>" % number for number in range(300_000))
        )
    assert time.process_time() - begun < 5


ENCODINGS = "foo hex zip rot13 mbcs utf-7 shift_jis idna undefined punycode utf-16 cp037"


@pytest.mark.parametrize("encoding", ENCODINGS.split())
def test_strange_encodings_of_xml(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?><VTKFile type="PolyData"/>'
    with pytest.raises(bsm.FormatError):
        read_mesh(text.encode())


@pytest.mark.parametrize("vertex", [2**32 + 2, 2**31, -1, 2**63 + 2])
def test_faces_of_a_pipe_do_not_wrap(vertex):
    given = npy(np.array([[0, 1, vertex]], np.uint64 if vertex > 2**62 else np.int64)) + npy(
        np.eye(3)
    )
    with pytest.raises(bsm.MeshError, match="refers to vertex"):
        sequence_in(given, "npy")


def test_a_side_that_is_true():
    with pytest.raises(bsm.CorruptError, match="shape"):
        sequence_in(
            npy(np.zeros((1, 3), np.int64)).replace(b"(1, 3), }   ", b"(True, 3), }"), "npy"
        )


def test_a_header_of_an_array_is_bounded():
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(
            "positions.npy", b"\x93NUMPY\2\0" + (1 << 25).to_bytes(4, "little") + bytes(1 << 25)
        )
    with memory_below(10e6), pytest.raises(bsm.TruncatedError, match="the header of an npy array"):
        read_mesh(packed.getvalue(), "npz")


def test_rows_of_a_ply_without_properties_take_no_memory():
    head = ply_head(order=LITTLE).replace(
        "element vertex", "element free 999999999999999999\nelement vertex"
    )
    body = np.eye(3, dtype="<f4").tobytes() + b"\3" + np.arange(3, dtype="<i4").tobytes()
    found = read_mesh(head.encode() + body)
    assert found.mesh.faces.tolist() == [[0, 1, 2]] and found.dropped == ("free",)


def test_a_gltf_whose_buffer_is_no_file(tmp_path):
    """A pipe would be waited for, a link to itself be followed for ever."""
    pytest.importorskip("trimesh")
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    built = Built()
    built.nodes(
        {"mesh": built.mesh({"attributes": {"POSITION": built.array(np.eye(3, dtype=np.float32))}})}
    )
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
    "ply": ply_head(20_000_000, order=LITTLE).encode(),
    "off": b"# a scan\nOFF\n20000000 1 0\n",
}


@pytest.mark.parametrize("kind", HEADS)
def test_too_many_vertices_are_refused_from_the_head(tmp_path, kind, capsys):
    path = tmp_path / f"a.{kind}"
    with open(path, "wb") as file:
        file.write(HEADS[kind])
        file.truncate(1_000_000)
    with (
        memory_below(10e6),
        pytest.raises(bsm.LimitError, match=r"over the limit of .*; cut it into parts"),
    ):
        read_mesh(path)
    assert main(["encode", str(path), "-o", str(tmp_path / "a.bsm")]) == 6
    assert "cut it into parts, as bsm tile does" in capsys.readouterr().err


def test_an_npz_of_too_many_vertices(tmp_path):
    moving(tmp_path / "a.npz", 0, 1000)
    with pytest.raises(
        bsm.LimitError, match="vertices = 1,000 is over the limit of 999; cut it into parts"
    ):
        sequence_in(str(tmp_path / "a.npz"), limits=Limits(vertices=999))


LARGE = "ply, quads of bytes", "ply, long polygons of bytes", "glb, accessors of no bytes"


@pytest.mark.skipif(sys.platform != "linux", reason="memory is measured as Linux tells it")
@pytest.mark.parametrize("limits", ["service", "default"])
def test_what_multiplies_is_refused_or_within_the_promised_memory_and_time(limits):
    pytest.importorskip("trimesh")
    warm_up()
    made = grown(1 << 19)
    assert not list(problems([Case(name, made[name]) for name in LARGE], limits))


def test_a_3mf_file_is_read_as_a_whole_or_not_at_all(tmp_path):
    pytest.importorskip("lib3mf")
    path = tmp_path / "a.3mf"
    path.write_bytes(three_mf(chained_objects(3), '<item objectid="3"/>'))
    assert len(read_mesh(path).mesh.faces) == 8
    path.write_bytes(three_mf(chained_objects(3), '<item objectid="3"/><item objectid="0"/>'))
    assert len(read_mesh(path).mesh.faces) == 9
    loop = '<object id="1"><components><component objectid="1"/></components></object>'
    path.write_bytes(three_mf(loop, '<item objectid="1"/>'))
    with pytest.raises(
        FormatError, match=r"lib3mf cannot read this 3MF file: (?!.*(Error|Exception))"
    ):
        read_mesh(path)
    path.write_bytes(three_mf(chained_objects(1), ""))
    with pytest.raises(MeshError, match="places no object"):
        read_mesh(path)


def test_an_element_without_properties_is_no_obstacle_to_tiles(tmp_path):
    head = ply_head(order=LITTLE, more="element nothing 7\n", corners="uchar uchar")
    body = bytes(12) + b"\0\0\x80?" + bytes(12) + b"\0\0\x80?" + bytes(4) + b"\3\0\1\2"
    (tmp_path / "a.ply").write_bytes(head.encode() + body)
    done = program("tile", tmp_path / "a.ply", "-o", tmp_path / "t")
    assert done.returncode == 0, done.stderr


MIB = 1 << 20
SMALL = Limits(memory=8 * MIB)
TEXTS = {
    "vertices": ("obj", b"v 0 0 0\n"),
    "empty lines": ("obj", b"\n"),
    "words": ("obj", b"f" + b" 1" * 200_000 + b"\n"),
    "corners": ("obj", b"f" + b" 1/1/1" * 100_000 + b"\n"),
    "keywords": ("obj", b"a\n"),
    "off": ("off", b"OFF\n1 1\n" + b"0 0 0\n" * 200_000),
    "ply": ("ply", b"ply\nformat ascii 1.0\nelement vertex 1\nend_header\n" + b"1\n" * 300_000),
    "stl": ("stl", b"solid\n" + b"x\n" * 300_000),
}


@pytest.mark.parametrize("name", TEXTS)
def test_texts_take_what_is_granted_or_are_refused(name):
    kind, piece = TEXTS[name]
    data = piece * max(1, 500_000 // len(piece))
    granted = SMALL.memory_for(data.count(b"\n") // 3, len(data))
    refused = LimitError, MeshError, TruncatedError, CorruptError, ValueError
    with memory_below(granted + 4 * MIB), pytest.raises(refused):
        read_mesh(data, kind, SMALL)


def test_more_vertices_than_granted_are_refused_before_they_are_numbers():
    data = b"v 0 0 0\n" * 100_000
    with memory_below(4 * MIB), pytest.raises(LimitError, match="vertices"):
        read_mesh(data, "obj", Limits(vertices=1000))


def test_what_gzip_has_compressed_is_bounded():
    bomb = gzip.compress(b"v 0 0 0\n" * 8_000_000)
    most = 2 * SMALL.memory_for(0, len(bomb)) + 4 * MIB
    with memory_below(most), pytest.raises(LimitError, match="compressed bytes"):
        read_mesh(bomb, limits=SMALL)


def test_gzip_of_several_members():
    text = file_of(torus(6, 6), "obj")
    both = gzip.compress(text[:100]) + gzip.compress(text[100:]) + bytes(10)
    assert gunzipped(both, Limits()) == text
    with pytest.raises(TruncatedError):
        gunzipped(both[:40], Limits())
    with pytest.raises(CorruptError):
        gunzipped(both[:20] + b"\xff" * 40 + both[60:], Limits())


def archive_of(**arrays):
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)
    return buffer.getvalue()


@pytest.mark.parametrize("name", ["positions", "faces", "extra", "metadata"])
def test_arrays_of_an_npz_are_bounded(name):
    mesh = torus(6, 6)
    arrays = {"positions": mesh.positions, "faces": mesh.faces}
    arrays[name] = (
        np.zeros(30_000_000, np.uint8) if name == "metadata" else np.zeros((2_000_000, 3))
    )
    data = archive_of(**arrays)
    with memory_below(SMALL.memory_for(0, len(data))), suppress(LimitError):
        assert read_mesh(data, "npz", SMALL).dropped == (name,)


@pytest.mark.parametrize("piece", [b"\n", b" \n", b"\r\n", b"\n ", b"v", b" v\n"])
def test_looking_at_content_is_linear(piece):
    data = piece * (65536 // len(piece))
    begin = time.thread_time()
    format_of_bytes(data)
    assert time.thread_time() - begin < 0.25


def test_an_obj_is_known_by_its_content():
    assert format_of_bytes(b"# remark\n\n  v 0 0 0\n") == "obj"
    assert format_of_bytes(b"v\t0 0 0") == "obj"
    assert format_of_bytes(b"vt 0 0\n") is None


SECONDS, BYTES = 10, 1 << 30
PROGRAM = f"""
import json, os, signal, sys
from bsm.bitstream.errors import BsmError
from bsm.codec.geometry.mesh import NoFacesError
from bsm.files.mesh import read_mesh
for path in sys.argv[1:]:
    child = os.fork()
    if child == 0:
        signal.alarm({SECONDS})
        try:
            mesh = read_mesh(path).mesh
            result = len(mesh.positions), len(mesh.faces)
        except BsmError as error:
            result = "MeshError" if isinstance(error, NoFacesError) else type(error).__name__
        print(json.dumps([path, result]), flush=True)
        os._exit(0)
    status = os.waitpid(child, 0)[1]
    if status:
        print(json.dumps([path, f"died with status {{status}}"]), flush=True)
"""
# Vertices and faces as each file's own text or header has them, polygons cut into triangles.
EXPECTED = {
    "c3d_beetle_nonmanifold.obj": [1148, 2053],
    "igl_truck.obj": [2956, 4770],
    "cgal_tet-shuffled.off": [4, 4],
    "trimesh_cycloidal.ply": [21384, 43368],
    "made_duplicate_faces.obj": [4, 4],
    "made_offset_1e7.obj": [4, 2],
    "trimesh_quadknot.obj": [1440, 2880],
    "trimesh_joined_tetrahedra.obj": [5, 8],
    "trimesh_two_objects.obj": [12, 16],
    "trimesh_comments.off": [8, 12],
    "draco_extra_vertex.obj": [10, 3],
    "draco_Box.ply": [24, 12],
    "pmp_icosahedron_binary.stl": [12, 20],
    "trimesh_multibody.stl": [20, 32],
    "made_negative_index.off": "MeshError",
    "made_index_out_of_range.ply": "MeshError",
    "made_truncated.ply": "TruncatedError",
    "made_huge_count.ply": "LimitError",
    "draco_inf_nan.obj": "MeshError",
    "draco_int_point_cloud.ply": "MeshError",
    "trimesh_empty.stl": "MeshError",
}


def read_all(paths):
    """Read each file in a process of its own, of limited time and memory: what came of it, by name."""
    single = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    done = python(
        "-c",
        PROGRAM,
        *paths,
        timeout=20 * SECONDS,
        preexec_fn=bound("RLIMIT_AS", BYTES),
        env=single,
    )
    assert done.returncode == 0, done.stderr
    return {Path(path).name: result for path, result in map(json.loads, done.stdout.splitlines())}


def test_the_helper_notices_a_file_that_kills_the_process(tmp_path):
    pipe = tmp_path / "never_written.obj"
    os.mkfifo(pipe)
    program = PROGRAM.replace(f"alarm({SECONDS})", "alarm(1)")
    assert b"died" in python("-c", program, pipe).stdout


@pytest.mark.real
def test_every_hostile_file_loads_or_is_refused(meshes):
    paths = sorted((meshes / "hostile").iterdir())
    results = read_all(paths)
    assert set(results) == {path.name for path in paths}
    refused = {name: result for name, result in results.items() if isinstance(result, str)}
    unknown = {name: result for name, result in refused.items() if not hasattr(errors, result)}
    assert unknown == {}
    assert {name: results[name] for name in EXPECTED} == EXPECTED
    assert len(refused) < 20, f"most of these files hold meshes: {refused}"
