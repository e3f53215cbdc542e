"""What the program leaves behind, says and returns when the machine fails it; always in a process of its own."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from bsm import read_mesh, save
from bsm.cli import main
from tests.bsm.program import bound
from tests.bsm.program import process as run
from tests.shapes import knot
from tools.vectors.store import FOLDER as VECTORS

ROOT = Path(__file__).parents[2]
BSM = [sys.executable, "-m", "bsm"]
OPTIONS = {"encode": ("--set", "step=0.004"), "decode": ()}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with sample.ply, its stream sample.bsm, and large.ply, which takes long."""
    folder = tmp_path_factory.mktemp("faults")
    save(knot(900), folder / "sample.ply")
    save(knot(30_000), folder / "large.ply")
    assert (
        main(["encode", str(folder / "sample.ply"), "-q", "--threads", "1", *OPTIONS["encode"]])
        == 0
    )
    return folder


def printed(done):
    """The one line on the standard error output."""
    text = done.stderr.decode()
    assert text.startswith("bsm: ") and text.count("\n") == 1, text
    return text


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT", "SIGKILL"])
def test_killed_in_mid_encode(name, folder, tmp_path):
    output, number = tmp_path / "a.bsm", getattr(signal, name)
    command = [
        *BSM,
        "encode",
        folder / "large.ply",
        "-o",
        output,
        "--set",
        "block-size=300",
        "--set",
        "keep=1",
    ]
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE) as process:
        while not list(tmp_path.iterdir()):  # the temporary file is there from the first block on
            assert process.poll() is None
            time.sleep(0.05)
        process.send_signal(number)
        errors = process.communicate(timeout=120)[1].decode()
    assert (
        process.returncode == {"SIGTERM": 143, "SIGHUP": 143, "SIGINT": 130, "SIGKILL": -9}[name]
    ), errors
    assert not output.exists()
    if name != "SIGKILL":
        assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["encode", "decode"])
def test_no_room_for_the_whole_file(command, folder, tmp_path):
    """A limit on the size of files fails in mid-file, as a full disk does."""
    given, output = ("sample.ply", "a.bsm") if command == "encode" else ("sample.bsm", "a.ply")
    words = (command, folder / given, "-o", tmp_path / output, *OPTIONS[command])
    done = run(*words, preexec_fn=bound("RLIMIT_FSIZE", 512))
    assert done.returncode == 9
    assert printed(done) == f"bsm: {tmp_path / output}: File too large\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["encode", "decode"])
def test_the_reader_of_a_pipe_goes_away(command, folder):
    given = "sample.ply" if command == "encode" else "sample.bsm"
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [*BSM, command, folder / given, "-o", "-", *OPTIONS[command]],
        stdout=writing,
        stderr=subprocess.PIPE,
        timeout=120,
        cwd=ROOT,
        check=False,
    )
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, b"")


def test_a_file_that_is_replaced_is_whole_or_the_old_one(folder, tmp_path):
    output = tmp_path / "a.ply"
    output.write_bytes(b"old")
    done = run(
        "decode", folder / "sample.bsm", "-f", "-o", output, preexec_fn=bound("RLIMIT_FSIZE", 512)
    )
    assert done.returncode == 9 and output.read_bytes() == b"old"
    assert run("decode", folder / "sample.bsm", "-f", "-q", "-o", output).returncode == 0
    assert len(read_mesh(output).mesh.faces) == len(read_mesh(folder / "sample.ply").mesh.faces)


@pytest.mark.parametrize(
    ("name", "code", "places"),
    [
        ("bad-checksum-block", 4, ["checksum", "byte", "section"]),
        ("bad-levels-short", 12, ["ends before", "block 0"]),
        ("bad-block-missing", 4, ["missing", "block 0"]),
        ("bad-connectivity-long", 4, ["left over", "section 1"]),
        ("unsupported-version", 5, ["version 2"]),
        ("bad-limit-vertices", 6, ["vertices", "limit"]),
        ("bad-not-finite", 7, ["not finite"]),
        ("bad-magic", 3, ["not a BSM stream"]),
    ],
)
def test_verify_says_what_is_wrong_and_where(name, code, places, capsys):
    assert main(["verify", str(VECTORS / f"{name}.bsm")]) == code
    message = capsys.readouterr().err
    assert all(place in message for place in places), message


STOPS = """
import signal, sys

class Lost:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)

class Finder:
    def find_spec(self, name, *_):
        if name == "numpy" and {dropped}:
            Lost()
        elif name == "numpy":
            try:
                signal.raise_signal(signal.SIGINT)
            except KeyboardInterrupt:
                pass
            raise ImportError("a module that a signal has stopped")

sys.meta_path.insert(0, Finder())
sys.argv = ["bsm", "encode", {mesh!r}]
from bsm.__main__ import run
run()
"""


@pytest.mark.parametrize("dropped", [False, True])
def test_an_interrupt_is_one_whatever_an_import_makes_of_it(dropped, tmp_path):
    """Extension modules raise an ImportError in its place; where Python drops errors, it is repeated."""
    save(knot(900), tmp_path / "a.ply")
    code = STOPS.format(dropped=dropped, mesh=str(tmp_path / "a.ply"))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (130, "bsm: interrupted\n")
