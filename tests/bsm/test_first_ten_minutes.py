"""What somebody tries in the first ten minutes, one step after another, and must not stumble over.

A stumble is an exit code or a message other than expected, a traceback, a warning, a text of several lines where one
says it all, a path in the text of an error, prose between lines of JSON, or a file that is left behind.
"""

import asyncio
import json
import subprocess
import sys
import warnings

import numpy as np
import pytest

import bsm
from bsm.evaluation.sample import knot
from bsm.files.mesh import read_mesh, write_mesh
from tools.noise import gaussian_along_normals

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder of scans, one of them noisy, one damaged, one no mesh, with a sequence beside them."""
    folder = tmp_path_factory.mktemp("mine")
    mesh = knot(1500)
    (folder / "scans").mkdir()
    write_mesh(folder / "bunny.ply", mesh)
    for name in ("part.stl", "prop.obj", "scan.ply"):
        write_mesh(folder / "scans" / name, mesh)
    write_mesh(folder / "noisy.ply", mesh.moved(gaussian_along_normals(mesh.positions, mesh.faces, 0.2, 0))[0])
    (folder / "scans/cut.ply").write_bytes((folder / "bunny.ply").read_bytes()[:2000])
    (folder / "scans/letter.ply").write_text("Dear reader,\n")
    frames = np.stack([mesh.positions * (1 + 0.1 * np.sin(k / 2)) for k in range(8)])
    np.savez(folder / "dance.npz", positions=frames, faces=mesh.faces)
    return folder


def bsm_command(folder, *words, code=0):
    """Run a command; returns what it printed to both streams."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-m", "bsm", *words], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == code, f"{words}: {done.returncode}\n{done.stderr}"
    assert "Traceback" not in done.stderr and "Warning" not in done.stderr, done.stderr
    return done.stdout, done.stderr


STEPS = (
    ("--help",),
    ("demo", "-f", "-o", "out", "--vertices", "1500"),
    ("encode", "bunny.ply"),
    ("info", "bunny.bsm"),
    ("verify", "bunny.bsm"),
    ("decode", "bunny.bsm", "-o", "back.ply"),
    ("compare", "bunny.ply", "bunny.bsm", "--look"),
    ("encode", "bunny.ply", "--preset", "lossless", "-o", "exact.bsm"),
    ("encode", "bunny.ply", "--size", "5kB", "-o", "small.bsm"),
    ("denoise", "noisy.ply", "-o", "clean.ply"),
    ("encode", "dance.npz"),
    ("decode", "dance.bsm", "-o", "dance.glb"),
    ("decode", "dance.bsm", "-o", "frames/", "--format", "obj", "-q"),
    ("tile", "bunny.ply", "-o", "tiles", "--triangles", "1000"),
    ("info", "tiles"),
    ("untile", "tiles", "-o", "whole.ply"),
)


def test_the_command_line_has_no_stumble(folder):
    for words in STEPS:
        printed, errors = bsm_command(folder, *words)
        assert printed or errors or "-q" in words, f"{words} says nothing"
        assert all(len(line) < 300 for line in (printed + errors).splitlines() if not line.startswith("{")), words
    exact = bsm.load(folder / "exact.bsm")
    assert len(exact.positions) == len(read_mesh(folder / "bunny.ply").mesh.positions)
    assert (folder / "small.bsm").stat().st_size <= 5000
    assert len(list((folder / "frames").glob("*.obj"))) == 8


def test_a_batch_has_no_stumble(folder):
    """One that fails stops no other, is reported in a sentence, and is all that a second run does again."""
    words = ("encode", "-r", "scans", "-o", "streams/", "--report", "report.json")
    _, errors = bsm_command(folder, *words, code=12)
    failed = [line for line in errors.splitlines() if line.startswith("bsm: ")]
    assert len(failed) == 2 and "cut.ply" in failed[0] and "letter.ply" in failed[1]
    assert {path.suffix for path in (folder / "streams").iterdir()} == {".bsm"}
    _, errors = bsm_command(folder, *words, "--resume", code=12)
    assert "3 of 5 were up to date" in errors
    _, errors = bsm_command(folder, *words, "-f", "--json", code=12)
    lines = [json.loads(line) for line in errors.splitlines()]
    assert sum("error" in line for line in lines) == 2
    left = [line["seconds_left"] for line in lines if "seconds_left" in line]
    assert all(seconds is not None and seconds > 0 for seconds in left)


MISTAKES = (
    (("encode", "nobody.ply"), 9, "nobody.ply: No such file or directory"),
    (("encode", "bunny.ply"), 9, "the output exists already; -f overwrites it"),
    (("encode", "bunny.ply", "--preset", "finest", "-f"), 2, "finest"),
    (("encode", "bunny.ply", "--sise", "3kB"), 2, "did you mean --size?"),
    (("decode", "bunny.ply", "-o", "y.ply"), 3, "bunny.ply: "),
    (("encode", "scans/letter.ply", "-o", "x.bsm"), 3, "scans/letter.ply: "),
    (("encode", "bunny.ply", "--size", "10", "-o", "x.bsm"), 10, "cannot be"),
    (("frobnicate",), 2, "frobnicate"),
)


def test_mistakes_are_reported_in_a_sentence(folder):
    (folder / "bunny.bsm").touch()
    for words, code, expected in MISTAKES:
        _, errors = bsm_command(folder, *words, code=code)
        assert expected in errors and len(errors.splitlines()) <= 2, f"{words}: {errors}"
        assert not (folder / "x.bsm").exists()


def test_python_has_no_stumble(folder):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        heard = []
        data = bsm.encode(folder / "bunny.ply", preset="fine", progress=lambda done, total: heard.append(done / total))
        assert heard[-1] == 1.0
        mesh = bsm.decode(data)
        assert bsm.compare(folder / "bunny.ply", data).max_error_relative <= 0.005
        assert bsm.save(mesh, folder / "saved.obj") == () and len(bsm.load(folder / "saved.obj").faces) == len(
            mesh.faces
        )
        positions, faces = bsm.decode_sequence(bsm.encode_sequence(np.stack([mesh.positions] * 3), mesh.faces))
        assert positions.shape == (3, *mesh.positions.shape) and faces.shape == mesh.faces.shape
        bsm.denoise(folder / "noisy.ply", strength=0.5)
        with bsm.Decoder() as decoder:
            assert all("\n" not in repr(event) and len(repr(event)) < 120 for event in decoder.events([data]))
        again = asyncio.run(asyncio.to_thread(bsm.encode, mesh, threads=1))
        assert bsm.decode(again).faces.shape == mesh.faces.shape


def test_wrong_uploads_are_reported_in_a_sentence_without_a_path(folder):
    data = bsm.encode(knot(600))
    broken = bytearray(data)
    broken[len(data) // 2] ^= 255
    head = b"ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n"
    for work, upload, kind in (
        (bsm.decode, b"", bsm.BsmError),
        (bsm.decode, b"\0" * 1000, bsm.FormatError),
        (bsm.decode, data[:-20], bsm.TruncatedError),
        (bsm.decode, bytes(broken), bsm.BsmError),
        (bsm.read_mesh, b"\0" * 1000, bsm.FormatError),
        (bsm.read_mesh, b"", bsm.FormatError),
        (bsm.read_mesh, head, bsm.BsmError),
    ):
        with pytest.raises(kind) as found:
            work(upload)
        text = str(found.value)
        assert text and "\n" not in text and "/" not in text and "pip install" not in text, text
    for call, expected in (
        (lambda: bsm.encode(knot(600), presett="fine"), "did you mean preset"),
        (lambda: bsm.encode(knot(600), preset="finest"), "not 'finest'"),
        (lambda: bsm.encode("nobody.ply"), "nobody.ply"),
    ):
        with pytest.raises((bsm.BsmError, OSError), match=expected):
            call()
