"""What strangers have written into files does nothing to a terminal; what takes long is seen on any."""

import json
import os
import re
import subprocess
import sys

import pytest

from bsm.cli import main
from bsm.console import Console, printable
from tools.vectors.meshes import torus

HOSTILE = "a\nb: forged\x1b]0;title\x07\x1b[2J\u202e"


def test_what_is_not_printable_is_escaped():
    assert printable("plain, größer 網") == "plain, größer 網"
    assert printable(HOSTILE) == r"a\nb: forged\x1b]0;title\x07\x1b[2J\u202e"


def test_a_note_is_one_line(capsys):
    Console().note(f"left out: {HOSTILE}")
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize("command", ["info", "decode"])
def test_commands_escape_names_and_metadata(command, tmp_path, capsys):
    import bsm

    path = tmp_path / "mesh.bsm"
    path.write_bytes(bsm.encode(torus(6, 6), grid=8, metadata={HOSTILE: HOSTILE}))
    assert main([command, str(path), *(["-o", str(tmp_path / "mesh.ply")] if command == "decode" else [])]) == 0
    printed = capsys.readouterr()
    assert not set("\x1b\x07\u202e") & set(printed.out + printed.err)
    assert "\nb: forged" not in printed.out + printed.err


@pytest.mark.parametrize("lines", [False, True])
def test_time_is_reported_where_nothing_else_is(lines):
    """From the first second on, and with what is left from when a share was known."""
    pty = pytest.importorskip("pty")
    work = f"import signal; from bsm.console import Console; signal.alarm(60); console = Console(json={lines})\n"
    work += "with console.progress('denoising') as progress: input(); progress.stage('rehearsing', 0.1); input()"
    drawn, said = (b"denoising: 00:0", rb"rehearsing: +\d+%.*<00:"), b""
    ours, theirs = pty.openpty()
    with subprocess.Popen([sys.executable, "-c", work], stdin=subprocess.PIPE, stderr=theirs, bufsize=0) as process:
        os.close(theirs)
        for words in (b'"seconds_left": null', b'"seconds_left": [1-9]') if lines else drawn:
            while not re.search(words, said):
                said += os.read(ours, 1 << 12)  # fails where the process has ended
            process.stdin.write(b"\n")
    os.close(ours)
    shares = [json.loads(line)["share"] for line in said.splitlines()] if lines else [0.0, 0.1]
    assert 0 == shares[0] < 0.1 <= shares[-1] < 1 and shares == sorted(shares)


def test_programs_are_reported_in_lines_of_json(monkeypatch, capsys):
    monkeypatch.setattr("bsm.console._SECOND", 0.0)
    monkeypatch.setattr("bsm.console._LEAST_LEFT", 0.0)
    with Console(json=True).progress("encoding") as progress:
        progress(0, 4)
        progress(3, 4)
    first, last = (json.loads(line) for line in capsys.readouterr().err.splitlines())
    assert first["share"] == 0.0 and first["seconds_left"] is None
    assert last["stage"] == "encoding" and last["share"] == pytest.approx(0.75, abs=0.01)
    assert last["seconds_left"] == pytest.approx(last["seconds"] / 3, rel=0.1)
    with Console(quiet=True, json=True).progress("encoding") as progress:
        progress(3, 4)
    assert not capsys.readouterr().err
