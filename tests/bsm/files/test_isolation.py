"""Readers in processes of their own: the same meshes and errors, and a system that ends what takes too much."""

import os
import signal
import sys
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import FormatError, LimitError, Limits, MeshError, UnsupportedError
from bsm.cli import main
from bsm.files import wall
from bsm.files.mesh import read_mesh, write_mesh
from tests.shapes import torus

pytestmark = pytest.mark.skipif(not wall.AVAILABLE, reason="only Linux has the wall")
TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def same(first, second):
    one, other = first.mesh, second.mesh
    assert np.array_equal(one.positions, other.positions) and np.array_equal(one.faces, other.faces)
    assert dict(one.metadata) == dict(other.metadata) and (first.notes, first.dropped) == (second.notes, second.dropped)
    for a, b in zip(one.attributes, other.attributes, strict=True):
        assert (a.name, a.domain, a.semantic, a.values.dtype) == (b.name, b.domain, b.semantic, b.values.dtype)
        assert np.array_equal(a.values, b.values)
        assert (a.indices is None and b.indices is None) or np.array_equal(a.indices, b.indices)


@pytest.mark.parametrize("kind", ["obj", "off", "ply", "stl", "vtp", "npz", "glb"])
def test_the_mesh_is_the_same(kind, tmp_path):
    colors = bsm.Attribute("color", np.arange(3 * 2400, dtype=np.uint8).reshape(-1, 3), "vertex", "color")
    places = bsm.Attribute("texcoord", np.random.default_rng(0).random((7200, 2)), "corner", "texcoord")
    mesh = torus(40, 30)
    attributes = (replace(colors, values=colors.values[: len(mesh.positions)]), replace(places, indices=None))
    mesh = replace(mesh, attributes=attributes if kind != "off" else (), metadata={"unit": "mm"})
    write_mesh(tmp_path / f"a.{kind}", mesh)
    same(read_mesh(tmp_path / f"a.{kind}", isolated=True), read_mesh(tmp_path / f"a.{kind}"))
    data = (tmp_path / f"a.{kind}").read_bytes()
    same(read_mesh(data, kind, isolated=True), read_mesh(data, kind))


def test_errors_are_the_same(tmp_path):
    for bad in (b"", b"v 0 0 0\n", b"solid", b"BSM", TRIANGLE + b"f 9 9 9\n", tmp_path / "none.ply", tmp_path):
        with pytest.raises((bsm.BsmError, OSError)) as plain:
            read_mesh(bad)
        with pytest.raises(type(plain.value)) as apart:
            read_mesh(bad, isolated=True)
        assert str(apart.value) == str(plain.value)


def test_files_beside_are_read_and_others_are_not(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.obj").write_bytes(b"mtllib a.mtl\nusemtl red\n" + TRIANGLE)
    (tmp_path / "in" / "a.mtl").write_text("newmtl red\nKd 1 0 0\n")
    found = read_mesh(tmp_path / "in" / "a.obj", isolated=True)
    same(found, read_mesh(tmp_path / "in" / "a.obj"))
    assert any("red" in str(value) for value in found.mesh.metadata.values())


def acting(monkeypatch, tmp_path, act):
    """What reading does if a library behind the wall is taken over by a file."""
    (tmp_path / "library").mkdir(exist_ok=True)
    (tmp_path / "library" / "evil.py").write_text(f"import os, socket\ndef act(here):\n    {act}\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "library"))
    monkeypatch.setitem(wall._LIBRARIES, "own", ("bsm.files.mesh",))
    code = (
        "from bsm.files import mesh, wall; import evil; plain = mesh.read_mesh\n"
        "def taken(source, *given, **more):\n"
        "    if not isinstance(source, bytes): evil.act(source)\n"
        "    return plain(source, *given, **more)\n"
        "mesh.read_mesh = taken; wall.serve({number})"
    )
    monkeypatch.setattr(wall, "_COMMAND", code)
    wall._server.cache_clear()


@pytest.fixture(autouse=True)
def _fresh():
    yield
    wall._server.cache_clear()


@pytest.mark.parametrize(
    ("act", "error", "words"),
    [
        ("x = bytearray(3 << 30)", LimitError, "bytes of memory"),
        ("[0 for _ in iter(int, 1)]", LimitError, "s of processor time"),
        ("os.kill(os.getpid(), 11)", FormatError, "SIGSEGV"),
        ("os.abort()", FormatError, "SIGABRT"),
        ("os._exit(3)", FormatError, "left no mesh"),
        ("raise KeyError(here)", FormatError, "KeyError"),
    ],
)
def test_the_parent_goes_on(act, error, words, monkeypatch, tmp_path):
    acting(monkeypatch, tmp_path, act)
    for _ in range(2):
        with pytest.raises(error, match=words):
            read_mesh(TRIANGLE, limits=replace(Limits.service(), most_work=1e8))


def test_nothing_is_written_and_no_other_folder_read(monkeypatch, tmp_path):
    victim = tmp_path / "victim"
    victim.write_bytes(b"secret")
    probes = (
        f"os.write(os.open({str(victim)!r}, os.O_WRONLY), b'x')",
        f"os.write(os.open({str(tmp_path / 'new')!r}, os.O_WRONLY | os.O_CREAT), b'x')",
        *([f"open({str(victim)!r}).read()", "socket.create_connection(('127.0.0.1', 9))"] if landlocked() else []),
    )
    for probe in probes:
        acting(monkeypatch, tmp_path, probe)
        with pytest.raises((OSError, FormatError)) as refused:
            read_mesh(TRIANGLE, isolated=True)
        assert "ermission" in str(refused.value) or "too large" in str(refused.value), probe
    if landlocked():
        assert victim.read_bytes() == b"secret" and not (tmp_path / "new").exists()
    assert victim.stat().st_size <= 6


def landlocked():
    try:
        import landlockpy
    except ImportError:
        return False
    return bool(landlockpy.supported())


def test_lies_about_arrays_are_refused(monkeypatch, tmp_path):
    for lie in (
        '{"positions": 0, "faces": 1, "attributes": [], "metadata": {}, "notes": [], "dropped": [], '
        '"arrays": [["float64", [1 << 40, 3]], ["int32", [1, 3]]]}',
        '{"arrays": [["object", [1]]]}',
        '{"error": ["Exception", "x"], "arrays": []}',
        '{"error": ["__builtins__", "x"], "arrays": []}',
        '{"arrays": []}',
    ):
        with wall._shared(1 << 16) as memory:
            message = wall.msgpack.packb(eval(lie))
            os.pwrite(memory, len(message).to_bytes(8, "little") + message, 0)
            with pytest.raises(FormatError, match="left no mesh"):
                wall._mesh_in(memory, Limits())
    with wall._shared(1 << 16) as memory:
        os.pwrite(memory, b"\xff" * 8, 0)
        with pytest.raises(FormatError, match="left no mesh"):
            wall._mesh_in(memory, Limits())


def test_many_threads_read_at_a_time():
    found: list[int] = []

    def work():
        found.append(len(read_mesh(TRIANGLE, isolated=True).mesh.faces))

    threads = [threading.Thread(target=work) for _ in range(12)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [1] * 12


def test_a_server_that_was_ended_is_started_again():
    read_mesh(TRIANGLE, isolated=True)
    os.kill(wall._server().number, signal.SIGKILL)
    assert len(read_mesh(TRIANGLE, isolated=True).mesh.faces) == 1


def test_other_systems_refuse(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "platform", "darwin")
    Path(tmp_path / "a.dae").write_text("<COLLADA/>")
    with pytest.raises(UnsupportedError, match="needs Linux"):
        read_mesh(tmp_path / "a.dae", limits=Limits.service())
    with pytest.raises(UnsupportedError, match="needs Linux"):
        read_mesh(TRIANGLE, isolated=True)
    assert len(read_mesh(TRIANGLE, limits=Limits.service()).mesh.faces) == 1
    with pytest.raises(MeshError):
        read_mesh(b"v 0 0 0\n", limits=Limits.service())


def test_the_command_reads_untrusted_files_behind_the_wall(tmp_path, capsys):
    write_mesh(tmp_path / "a.ply", torus(20, 16))
    assert main(["encode", str(tmp_path / "a.ply"), "--untrusted", "-q"]) == 0
    assert bsm.decode(tmp_path / "a.bsm").faces.shape == (640, 3)
    (tmp_path / "b.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 2000000\n")
    assert main(["encode", str(tmp_path / "b.ply"), "--untrusted", "-q"]) == 6
    assert main(["encode", str(tmp_path / "a.ply"), "--untrusted", "-q", "-f", "--kg", "1"]) == 2
    assert "single meshes" in capsys.readouterr().err
