"""Folders of `bsm tile`: one run at a time, nothing of others is removed, nothing is begun anew without being asked."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress

import numpy as np
import pytest

from bsm import save
from bsm.tiles.work import LOCK
from tests.bsm.program import bsm
from tests.shapes import curved, torus

CELL = 2.0**-14


@pytest.fixture
def source(tmp_path):
    save(curved(torus(40, 30)), tmp_path / "mesh.ply")
    return tmp_path / "mesh.ply"


def tile(source, output, *more, run=bsm):
    return run(
        "tile", source, "-o", output, "--grid-cell", CELL, "--triangles", 300, *more, text=True
    )


def holding(folder):
    """A process that holds a folder until its standard input is closed."""
    pytest.importorskip("fcntl", reason="without locks a folder is not held")
    code = (
        "import sys; from pathlib import Path; from bsm.tiles.work import held\n"
        f"with held(Path({str(folder)!r}), False): print('held', flush=True); sys.stdin.read()"
    )
    other = subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert other.stdout.readline() == b"held\n"
    return other


@pytest.mark.parametrize("option", [(), ("-f",), ("--resume",)])
def test_a_second_run_says_who_holds_the_folder_and_changes_nothing(source, tmp_path, option):
    (tmp_path / "out").mkdir()
    with holding(tmp_path / "out") as other:
        second = tile(source, tmp_path / "out", *option)
        assert second.returncode == 9
        assert (
            f"process {other.pid} on '{socket.gethostname()}' works in this folder" in second.stderr
        )
        assert [path.name for path in (tmp_path / "out").iterdir()] == [LOCK]
        third = tile(source, tmp_path / "else", "--work", tmp_path / "out")
        assert third.returncode == 9 and str(other.pid) in third.stderr
        other.communicate()
    assert tile(source, tmp_path / "out").returncode == 0
    assert not (tmp_path / "out" / LOCK).exists()


def test_a_run_that_died_is_taken_over_when_asked(source, tmp_path):
    (tmp_path / "out").mkdir()
    with holding(tmp_path / "out") as other:
        other.kill()
        other.communicate()
    refused = tile(source, tmp_path / "out")
    assert (
        refused.returncode == 9
        and "left this folder unfinished; --resume continues, -f starts again" in refused.stderr
    )
    assert tile(source, tmp_path / "out", "--resume").returncode == 0


def test_unfinished_tiles_are_not_begun_anew_without_being_asked(source, tmp_path):
    assert tile(source, tmp_path / "out").returncode == 0
    path = tmp_path / "out" / "manifest.json"
    unfinished = json.dumps(
        {
            "format": "bsm tiles",
            "version": 1,
            "stream": 1,
            "source": "a",
            "complete": False,
            "levels": [],
        }
    )
    path.write_text(unfinished)
    (tmp_path / "out" / ".work").mkdir()
    (tmp_path / "out" / ".work" / "asked").write_text("({'triangles': 300}, None)")
    (tmp_path / "out" / ".work" / "plan.json").write_text("{}")
    refused = tile(source, tmp_path / "out")
    assert refused.returncode == 9 and "--resume continues, -f starts again" in refused.stderr
    assert path.read_text() == unfinished
    assert tile(source, tmp_path / "out", "-f").returncode == 0


def test_what_others_have_in_the_work_folder_stays(source, tmp_path):
    work = tmp_path / "work"
    work.mkdir()
    (work / "asked").write_text("\n")
    (work / "thesis.txt").write_text("years of work")
    refused = tile(source, tmp_path / "out", "--work", work)
    assert refused.returncode == 2 and "holds other files" in refused.stderr
    (work / "asked").write_text("({'triangles': 1}, None)")
    (work / "r0").mkdir()
    assert tile(source, tmp_path / "out", "--work", work).returncode == 0
    assert sorted(path.name for path in work.iterdir()) == ["r0", "thesis.txt"]
    assert tile(source, tmp_path / "again", "--work", tmp_path / "new").returncode == 0
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("option", [(), ("-f",), ("--resume",)])
def test_a_manifest_stays_until_the_input_was_read(source, tmp_path, option):
    output = tmp_path / "own"
    output.mkdir()
    for text in ('{"complete": false}', '{"name": "my extension"}', "[]", "no JSON"):
        (output / "manifest.json").write_text(text)
        refused = tile(source, output, *option)
        assert refused.returncode == 3 and "exists and is not a tile manifest" in refused.stderr
        assert tile(tmp_path / "nothere.ply", output, *option).returncode == 9
        assert (output / "manifest.json").read_text() == text
    assert tile(source, tmp_path / "new", "--work", output).returncode == 2
    assert not (tmp_path / "new" / "manifest.json").exists()


@pytest.mark.parametrize(
    "words", [("--grid-cell", "0"), ("--grid-cell", "nan"), ("--grid-cell", "1e-30")]
)
def test_what_is_refused_leaves_nothing_behind(source, tmp_path, words):
    assert tile(source, tmp_path / "out", *words).returncode == 2
    (tmp_path / "empty.ply").touch()
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "thesis.txt").touch()
    for output in ("out", "own"):
        refused = tile(tmp_path / "empty.ply", tmp_path / output, "--work", tmp_path / "work")
        assert refused.returncode == 3 and "empty" in refused.stderr
    assert sorted(path.name for path in tmp_path.rglob("*")) == [
        "empty.ply",
        source.name,
        "own",
        "thesis.txt",
    ]


@pytest.mark.parametrize(
    ("name", "target"),
    [
        *((LOCK, target) for target in ("precious", "new", None)),
        *(("manifest.json", target) for target in ("precious", None)),
        *(
            (".work", ""),
            (".work/plan.json", "precious"),
            (".work/positions", "new"),
            ("00000.tiles", "precious"),
        ),
    ],
)
def test_links_in_a_folder_of_others_are_not_written_through(source, tmp_path, name, target):
    """Neither to a file that is there, nor to one that is not; and a pipe is not waited for."""
    kept, place = tmp_path / "kept", tmp_path / "out" / name
    kept.mkdir()
    (kept / "precious").write_text("precious")
    place.parent.mkdir(parents=True)
    if target is None:
        os.mkfifo(place)
    else:
        place.symlink_to(kept / target)
    for option in ("--resume", "-f"):
        done = tile(source, tmp_path / "out", option)
        assert done.returncode in ((0, 9) if name.endswith("tiles") else (2, 3, 9)), done.stderr
        assert [path.name for path in kept.iterdir()] == ["precious"]
        assert (kept / "precious").read_text() == "precious"


def test_tilesets_are_not_written_through_links(source, tmp_path):
    kept, output = tmp_path / "kept", tmp_path / "out"
    kept.mkdir()
    (kept / "precious").write_text("precious")
    assert tile(source, output).returncode == 0
    (output / "tileset.json").symlink_to(kept / "precious")
    (output / "glb").symlink_to(kept)
    refused = tile(source, output, "-f", "--tileset")
    assert refused.returncode == 2 and "glb is a symbolic link" in refused.stderr
    (output / "glb").unlink()
    assert tile(source, output, "-f", "--tileset").returncode == 0
    assert {*os.listdir(output)} == {"tileset.json", "glb"} and not (
        output / "tileset.json"
    ).is_symlink()
    assert [path.name for path in kept.iterdir()] == ["precious"] and (
        kept / "precious"
    ).read_text() == "precious"


@pytest.mark.slow
def test_a_run_that_is_killed_anywhere_goes_on_to_the_same_tiles(source, tmp_path):
    """With all its processes, at ten places; `--resume` and `-f` end with the files of a run that was left alone."""

    def files_of(folder):
        return {
            path.relative_to(folder): path.read_bytes()
            for path in sorted(folder.rglob("*"))
            if path.is_file()
        }

    words = [
        sys.executable,
        "-m",
        "bsm",
        "tile",
        source,
        "--triangles",
        "100",
        "--grid-cell",
        str(CELL),
        "-j",
        "2",
    ]
    begin = time.monotonic()
    subprocess.run([*words, "-o", tmp_path / "alone"], check=True, capture_output=True)
    seconds, expected = time.monotonic() - begin, files_of(tmp_path / "alone")
    random = np.random.default_rng(8)
    for trial, share in enumerate(random.uniform(0.1, 1.0, 10)):
        output = tmp_path / f"out{trial}"
        run = subprocess.Popen(
            [*words, "-o", output], stderr=subprocess.DEVNULL, start_new_session=True
        )
        time.sleep(share * seconds)
        with suppress(ProcessLookupError):
            os.killpg(run.pid, signal.SIGKILL)
        run.wait()
        left = files_of(output) if output.exists() else {}
        # A lock with nothing in it: killed before it began.
        if any(left.values()) and set(left) != set(expected):
            refused = subprocess.run(
                [*words, "-o", output], capture_output=True, text=True, check=False
            )
            assert refused.returncode == 9 and "--resume" in refused.stderr, refused.stderr
        # Before it was killed.
        finished = output.exists() and set(files_of(output)) == set(expected)
        flag = "-f" if finished or trial % 2 else "--resume"
        done = subprocess.run(
            [*words, "-o", output, flag], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        assert files_of(output) == expected


def test_a_run_that_was_killed_after_its_manifest_can_be_resumed(source, tmp_path):
    output = tmp_path / "out"
    assert tile(source, output).returncode == 0
    whole = {path.name: path.read_bytes() for path in output.iterdir()}
    assert tile(source, output, "--resume").returncode == 9
    (output / LOCK).write_text("999999999 elsewhere\n")
    assert "--resume continues" in tile(source, output).stderr
    assert tile(source, output, "--resume").returncode == 0
    assert {path.name: path.read_bytes() for path in output.iterdir()} == whole


@pytest.mark.skipif(os.geteuid() == 0, reason="for root no folder is read-only")
def test_a_folder_that_is_read_only_is_named(source, tmp_path):
    (tmp_path / "out").mkdir(mode=0o555)
    refused = tile(source, tmp_path / "out")
    assert (
        refused.returncode == 9
        and "out" in refused.stderr
        and not any((tmp_path / "out").iterdir())
    )
