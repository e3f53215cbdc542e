"""What strangers have written into files does nothing to a terminal; what takes long is seen on any."""

import json
import os
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


def test_time_is_reported_where_nothing_else_is():
    """From the first second on, and with what is left from when a share was known."""
    pty = pytest.importorskip("pty")
    work = "import time; from bsm.console import Console\nwith Console(json={}).progress('denoising') as progress:\n"
    work += " time.sleep(1.5); progress.stage('rehearsing', 0.1); time.sleep(2.2)"
    ours, theirs = pty.openpty()
    with subprocess.Popen([sys.executable, "-c", work.format(False)], stderr=theirs):
        done = subprocess.run([sys.executable, "-c", work.format(True)], capture_output=True, text=True, check=True)
    os.close(theirs)
    drawn = os.read(ours, 1 << 14).decode()
    assert drawn.index("denoising: 00:0") < drawn.index("rehearsing:  10%|") and "<00:" in drawn
    os.close(ours)
    lines = done.stderr.splitlines()
    first, second = ([json.loads(line) for line in lines if name in line] for name in ("denoising", "rehearsing"))
    assert first and all(line["seconds_left"] is None for line in first)
    assert 0.1 <= second[0]["share"] < second[-1]["share"] < 1 and second[-1]["seconds_left"] > 0


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
