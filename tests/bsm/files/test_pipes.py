"""Input from anything that gives bytes, and what can be known of it beforehand."""

import io
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from bsm import LimitError, read_mesh, save
from bsm.files import pipes
from bsm.files.pipes import Input, as_input, is_pipe
from tests.shapes import knot

ROOT = Path(__file__).parents[3]
DATA = bytes(range(256)) * 5


class Drops(io.RawIOBase):
    """One byte at a time."""

    def __init__(self):
        self.rest = DATA

    def read(self, size=-1):
        byte, self.rest = self.rest[:1], self.rest[1:]
        return byte


@pytest.fixture(params=["file", "buffer", "drops", "fifo", "standard input"])
def source(request, tmp_path, monkeypatch):
    """The same bytes in many forms."""
    path = tmp_path / "a"
    match request.param:
        case "file":
            path.write_bytes(DATA)
            yield Input(path)
        case "buffer":
            yield Input(memoryview(DATA))
        case "drops":
            yield Input(Drops())
        case "standard input":
            monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(DATA)))
            yield Input("-")
        case "fifo":
            os.mkfifo(path)
            thread = threading.Thread(target=path.write_bytes, args=(DATA,))
            thread.start()
            yield Input(path)
            thread.join()


def test_looking_takes_nothing(source):
    assert source.peek(3) == DATA[:3]
    assert source.peek(300) == DATA[:300]
    assert source.peek(10_000) == DATA
    assert b"".join(source.chunks()) == DATA
    assert source.read(5) == b""


def test_reading_in_parts(source):
    assert source.peek(3) == DATA[:3]
    assert source.read(300) == DATA[:300]
    assert source.peek(4) == DATA[300:304] or source.is_file
    assert as_input(source) is source
    assert source.read_all() == DATA[300:]


def test_a_file_that_does_not_wait_is_not_at_its_end():
    reading, writing = os.pipe()
    os.set_blocking(reading, False)
    with (
        open(writing, "wb"),
        open(reading, "rb", buffering=0) as file,
        pytest.raises(BlockingIOError),
    ):
        as_input(file).read_all()


def test_what_is_a_pipe(tmp_path):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "file").write_bytes(b"")
    assert is_pipe("-") and is_pipe(tmp_path / "fifo") and is_pipe("/dev/null")
    assert (
        not is_pipe(tmp_path) and not is_pipe(tmp_path / "file") and not is_pipe(tmp_path / "none")
    )
    assert not is_pipe(io.BytesIO())


@pytest.mark.skipif(not Path("/dev/stdin").exists(), reason="no /dev/stdin on this system")
@pytest.mark.parametrize(
    "line",
    [
        "bsm encode fifo.ply -q -o - < /dev/null | bsm decode - -q -o - --format ply > out.ply",
        "bsm encode /dev/stdin -q -o /dev/stdout < in.ply | bsm decode /dev/stdin -qo - --format ply > out.ply",
        "bsm encode <(cat in.ply) -q -o >(bsm decode - -q -o out.ply; echo done >&3) 3>&1 | cat",
        "bsm encode in.ply -q -o a.bsm; mkfifo b.bsm; cat a.bsm > b.bsm & bsm decode b.bsm -q -f -o out.ply",
        "echo -n before > out; bsm encode in.ply -q -o /dev/fd/4 4>> out; tail -c +7 out | bsm decode - -q -o out.ply",
    ],
)
def test_the_command_line_takes_what_a_shell_gives(line, tmp_path):
    save(knot(300), tmp_path / "in.ply")
    os.mkfifo(tmp_path / "fifo.ply")
    program = f'bsm() {{ "{sys.executable}" -m bsm "$@"; }}\n'
    feed = "cat in.ply > fifo.ply &\n" if "fifo.ply" in line else ""
    command = ["bash", "-c", program + feed + line.replace("encode", "encode --grid 8")]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=120, check=True)
    assert b"Traceback" not in done.stderr
    assert len(read_mesh(tmp_path / "out.ply").mesh.faces) == len(
        read_mesh(tmp_path / "in.ply").mesh.faces
    )


def test_a_pipe_without_end_is_refused_at_its_bound(monkeypatch):
    class Endless(io.RawIOBase):
        taken = 0

        def read(self, size=-1):
            self.taken += 1 << 16
            return bytes(1 << 16)

    monkeypatch.setattr(pipes, "_MAX_BYTES", 1 << 20)
    assert len(as_input(bytes(1 << 20)).read_all()) == 1 << 20
    source = Endless()
    with pytest.raises(LimitError, match="larger than 1048576 bytes"):
        read_mesh(source)
    assert source.taken < 1 << 21
