"""What functions and programs report while they work, how they stop and warn, and text that stays harmless."""

import json
import os
import re
import runpy
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import Paper
from bsm.cli import main
from bsm.codec.progress import Stages
from bsm.encoding import options
from bsm.ground.console import Console, printable
from bsm.jobs.encode import clocked
from bsm.viewer.contents import Content, uploaded
from tests.bsm.program import process
from tools.noise import gaussian_along_normals
from tools.vectors.meshes import torus

LOOSE = ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (9, 9, 9)], [(0, 1, 2)])


class Stopped(Exception):
    """What a listener raises."""


MESH = torus(40, 30)
MESH = MESH.moved(gaussian_along_normals(MESH.positions, MESH.faces, 0.2, 1))[0]
FRAMES = np.stack([MESH.positions * (1 + 0.01 * k) for k in range(6)])


@pytest.fixture(scope="module")
def streams():
    return bsm.encode(MESH), bsm.encode_sequence(FRAMES, MESH.faces)


WORKS = {
    "encode": lambda streams, heard: bsm.encode(MESH, progress=heard),
    "quick": lambda streams, heard: bsm.encode(MESH, effort="quick", progress=heard),
    "target": lambda streams, heard: bsm.encode(MESH, size="3kB", progress=heard),
    "decode": lambda streams, heard: bsm.decode(streams[0], progress=heard),
    "encode_sequence": lambda streams, heard: bsm.encode_sequence(
        FRAMES, MESH.faces, progress=heard
    ),
    "encode_frames": lambda streams, heard: bsm.encode_frames([MESH, MESH], progress=heard),
    "decode_sequence": lambda streams, heard: bsm.decode_sequence(streams[1], progress=heard),
    "denoise": lambda streams, heard: bsm.denoise(MESH, progress=heard),
}


@pytest.mark.parametrize("name", WORKS)
def test_a_listener_hears_how_much_is_done_and_nothing_goes_back(name, streams):
    heard = []
    WORKS[name](streams, lambda done, total: heard.append((done, total)))
    done = [done for done, _ in heard]
    assert {total for _, total in heard} == {1000} and done[-1] == 1000
    assert done == sorted(set(done)) and len(done) >= 2


@pytest.mark.parametrize("name", WORKS)
def test_what_a_listener_raises_ends_the_work(name, streams):
    def heard(done, total):
        raise Stopped

    with pytest.raises(Stopped):
        WORKS[name](streams, heard)


@pytest.mark.parametrize("jobs", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_a_batch_that_is_stopped_leaves_whole_files_alone(jobs, tmp_path):
    given, out = tmp_path / "given", tmp_path / "out"
    for folder in (given, out):
        folder.mkdir()
    for number in range(4):
        bsm.save(MESH, given / f"{number}.ply")
    heard = []

    def stop(done, total):
        heard.append(done)
        if done > 300:
            raise Stopped

    with pytest.raises(Stopped):
        bsm.encode_many(sorted(map(str, given.iterdir())), f"{out}/", jobs=jobs, progress=stop)
    left = list(out.iterdir())
    assert heard == sorted(heard) and 0 < len(left) < 4
    assert all(len(bsm.decode(path).positions) == len(MESH.positions) for path in left)


def test_a_save_that_is_stopped_leaves_what_was_there(tmp_path):
    def stop(done, total):
        raise Stopped

    path = tmp_path / "mesh.bsm"
    path.write_bytes(b"before")
    with pytest.raises(Stopped):
        bsm.save(MESH, path, progress=stop)
    assert path.read_bytes() == b"before" and list(tmp_path.iterdir()) == [path]


def test_what_is_left_out_is_a_warning_at_the_line_of_the_call(tmp_path):
    with pytest.warns(bsm.BsmWarning, match="left out 1 vertex that no face uses") as found:
        bsm.encode(LOOSE)
    assert found[0].filename == __file__
    quads = tmp_path / "quads.obj"
    quads.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nmtllib none.mtl\n")
    with pytest.warns(
        bsm.BsmWarning, match=r"quads.obj: polygons were cut into triangles: 1"
    ) as found:
        bsm.load(quads)
    assert {attribute.filename for attribute in found} == {__file__}
    with pytest.warns(bsm.BsmWarning, match="no face uses"):
        bsm.encode_sequence(np.array([LOOSE[0]] * 2, float), LOOSE[1])


def test_a_warning_is_about_the_line_of_the_user_whatever_stands_between():
    with pytest.warns(bsm.BsmWarning, match="no face uses") as found:
        contextmanager(lambda: iter([None]))()(bsm.encode)(LOOSE)
        with ThreadPoolExecutor(1) as pool:
            pool.submit(lambda: bsm.encode(LOOSE)).result()
    assert [note.filename for note in found] == [__file__] * 2


def test_commands_print_no_raw_warnings(tmp_path, capfd):
    """Neither in this process, nor in those of many jobs, nor in that of a mesh that was dropped on the page."""
    for name in ("a.npz", "b.npz"):
        np.savez(tmp_path / name, positions=LOOSE[0], faces=LOOSE[1])
    done = process(
        "encode", tmp_path / "a.npz", tmp_path / "b.npz", "-j", 2, "-o", f"{tmp_path}/out/"
    )
    assert (
        done.returncode == 0 and b"no face uses" in done.stderr and b"Warning" not in done.stderr
    ), done.stderr
    assert isinstance(
        list(uploaded([("a.npz", (tmp_path / "a.npz").read_bytes())], "balanced"))[-1], Content
    )
    assert "Warning" not in capfd.readouterr().err


def test_keywords_are_those_of_the_options():
    keywords = runpy.run_path(str(Path(bsm.__file__).with_name("keywords.pyi")))

    def named(kind):
        return {item.name for item in fields(kind)}

    meshes = named(bsm.EncodeOptions) | named(Paper) | {*options.TARGETS, *options.BOUNDS, "preset"}
    sequences = named(bsm.SequenceOptions) | {
        *options.SEQUENCE_TARGETS,
        *options.BOUNDS,
        "preset",
        "effort",
    }
    assert set(keywords["OptionKeywords"].__annotations__) == meshes
    assert set(keywords["EncodeKeywords"].__annotations__) == meshes | {"progress", "simplify"}
    assert set(keywords["SequenceKeywords"].__annotations__) == sequences
    assert set(keywords["DenoiseKeywords"].__annotations__) == named(bsm.DenoiseOptions)


@pytest.mark.slow
def test_a_type_checker_finds_keywords_that_there_are_not(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "right.py").write_text(
        "import bsm\n\n\ndef heard(done: int, total: int) -> None:\n    print(done / total)\n\n\n"
        'data: bytes = bsm.encode("x.ply", preset="fine", max_error="0.1mm", size="3kB", progress=heard)\n'
        'bsm.save("x.ply", "x.bsm", theta=5.0)\nbsm.encode_many(["x.ply"], threads=1, progress=heard)\n'
        "positions, faces = bsm.decode_sequence(data, progress=heard)\n"
        'bsm.encode_sequence(positions, faces, kg=0.1)\nbsm.denoise("x.ply", iterations=3, progress=heard)\n'
    )
    wrong = [
        'encode("x", presett="fine")',
        'encode("x", max_eror=3)',
        'save("x", "y", treads=1)',
        'encode("x", step="1")',
    ]
    wrong += [
        "encode_sequence([], [], bpv=1)",
        'denoise("x", iteration=3)',
        'decode("x", progress=3)',
    ]
    lines = [f"bsm.{call}\n" for call in wrong]
    (tmp_path / "wrong.py").write_text("import bsm\n" + "".join(lines))
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache")]
    right, found = (
        subprocess.run(
            [*command, f"{name}.py"], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        for name in ("right", "wrong")
    )
    assert right.returncode == 0, right.stdout
    reported = {int(line.split(":")[1]) for line in found.stdout.splitlines() if ": error:" in line}
    assert reported == set(range(2, 2 + len(wrong))), found.stdout


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
    assert (
        main(
            [
                command,
                str(path),
                *(["-o", str(tmp_path / "mesh.ply")] if command == "decode" else []),
            ]
        )
        == 0
    )
    printed = capsys.readouterr()
    assert not set("\x1b\x07\u202e") & set(printed.out + printed.err)
    assert "\nb: forged" not in printed.out + printed.err


@pytest.mark.parametrize("lines", [False, True])
def test_time_is_reported_where_nothing_else_is(lines):
    """A report comes from the first second on; it states the time left once a share of the work is known."""
    pty = pytest.importorskip("pty")
    work = f"import signal; from bsm.ground.console import Console; signal.alarm(60); console = Console(json={lines})\n"
    work += "with console.progress('denoising') as progress: input(); progress.stage('rehearsing', 0.1); input()"
    drawn, said = (b"denoising: 00:0", rb"rehearsing: +\d+%.*<00:"), b""
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-c", work], stdin=subprocess.PIPE, stderr=theirs, bufsize=0
    ) as process:
        os.close(theirs)
        for words in (b'"seconds_left": null', b'"seconds_left": [1-9]') if lines else drawn:
            while not re.search(words, said):
                said += os.read(ours, 1 << 12)  # fails where the process has ended
            process.stdin.write(b"\n")
    os.close(ours)
    shares = [json.loads(line)["share"] for line in said.splitlines()] if lines else [0.0, 0.1]
    assert 0 == shares[0] < 0.1 <= shares[-1] < 1 and shares == sorted(shares)


def test_the_share_never_falls(monkeypatch, capsys):
    """Where work goes on faster than it did, and where a later report of it is lower."""
    monkeypatch.setattr("bsm.ground.console._SECOND", 0.0)
    console = Console(json=True)
    with console.progress("encoding") as progress:
        for done in (10, 60, 40):
            progress(done, 100)
            progress._when *= 0.5  # as if time had passed since
            progress._say(0.0)
        with console.progress("checking", 0.5):
            progress(1, 10)
    shares = [json.loads(line)["share"] for line in capsys.readouterr().err.splitlines()]
    assert shares == sorted(shares) and len(shares) > 6


def test_programs_are_reported_in_lines_of_json(monkeypatch, capsys):
    monkeypatch.setattr("bsm.ground.console._SECOND", 0.0)
    monkeypatch.setattr("bsm.ground.console._LEAST_LEFT", 0.0)
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


def test_stages_count_by_the_seconds_that_they_are_expected_to_take():
    heard = []
    stages = Stages(
        lambda done, total: heard.append(done / total), {"reading": 1.0, "encoding": 3.0}
    )
    stages.report("reading", 0.5)
    stages.report("reading", 1.0)
    stages.of("encoding")(1, 3)
    stages.expect("reading", 5.0)
    stages.report("encoding", 0.2)  # a stage does not go back
    stages.report("encoding", 1.0)
    assert heard == [0.125, 0.25, 0.5, 0.75, 1.0]


@pytest.mark.parametrize("seconds_a_frame", [0.001, 0.02, 0.5])
def test_the_estimate_of_frames_that_are_read_and_encoded_is_near(seconds_a_frame):
    """Read the clock from a list, in which encoding takes three quarters of its expected time."""
    frames, expected, really = 300, 4.0, 3.0
    now = [0.0]
    estimates = []

    def read():
        for number in range(frames):
            now[0] += seconds_a_frame
            yield number

    total = frames * seconds_a_frame + really

    def report(done, parts):
        if now[0] >= 0.2 * total and done:
            estimates.append(now[0] * parts / done)

    stages = Stages(report, {"reading": 0.0, "encoding": expected})
    for number in clocked(read(), frames, stages, lambda: now[0]):
        # Groups of a hundred frames are encoded once they are read.
        if number % 100 == 99:
            for step in range(1, 11):
                now[0] += really / 30
                stages.report("encoding", (number // 100 + step / 10) / 3)
    assert len(estimates) > 20
    assert all(total / 1.5 < estimate < 1.5 * total for estimate in estimates)


def test_frames_of_unknown_number_pass_without_an_estimate():
    heard = []
    stages = Stages(lambda *done: heard.append(done), {"reading": 0.0, "encoding": 0.0})
    assert list(clocked(iter("abc"), 0, stages)) == ["a", "b", "c"] and heard == []
