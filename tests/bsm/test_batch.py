"""Many inputs: outputs, names that would meet, messages, and the files that interrupted work leaves."""

import importlib
import json
import os
import re
import signal
import subprocess
import sys
import time
from functools import partial

import numpy as np
import pytest

from bsm import OptionError, TriangleMesh, read_mesh, save
from bsm.cli import main
from bsm.files.pipes import _errors_of
from bsm.jobs.plan import plan
from bsm.jobs.report import table
from tests.bsm import program
from tests.bsm.test_libraries import painted
from tests.shapes import knot
from tools.noise import gaussian_along_normals

ROOT = program.ROOT
SMALL = ["--set", "block-size=150", "--set", "step=0.004", "--threads", "1"]
bsm = partial(program.bsm, text=True)


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    """A folder with a.npz, b.npz and c.npz, of different meshes."""
    folder = tmp_path_factory.mktemp("meshes")
    for name, size in (("a", 400), ("b", 500), ("c", 600)):
        save(knot(size), folder / f"{name}.npz")
    return folder


@pytest.fixture(scope="module")
def streams(meshes, tmp_path_factory):
    folder = tmp_path_factory.mktemp("streams")
    assert (
        main(["encode", "-q", *map(str, sorted(meshes.iterdir())), "-o", str(folder), *SMALL]) == 0
    )
    return folder


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("jobs", [1, 2])
def test_there_and_back(meshes, tmp_path, jobs):
    inputs = sorted(meshes.iterdir())
    done = bsm("encode", *inputs, "-o", f"{tmp_path}/new/", "-j", jobs, "--json", *SMALL)
    assert done.returncode == 0, done.stderr
    files = json.loads(done.stdout)["files"]
    assert [file["input"] for file in files] == list(map(str, inputs))
    for file in files:
        assert file["bytes"] == os.path.getsize(file["output"])
        assert file["input_bytes"] == os.path.getsize(file["input"])
        assert 0 < file["theta_deg"] < 30
    taken, given = (sum(file[key] for file in files) for key in ("input_bytes", "output_bytes"))
    lines = map(json.loads, done.stderr.splitlines())
    *each, summary = (line["note"] for line in lines if "note" in line)
    assert [line.partition(" ->")[0] for line in each if " -> " in line] == list(map(str, inputs))
    assert summary.startswith(f"3 of 3 files, {taken} -> {given} bytes ({taken / given:.1f} : 1), ")
    assert (
        bsm(
            "decode",
            *(file["output"] for file in files),
            "-j",
            jobs,
            "-o",
            tmp_path,
            "--format",
            "npz",
        ).stdout
        == ""
    )
    assert names(tmp_path) == ["a.npz", "b.npz", "c.npz", "new"]
    for path in inputs:
        assert len(read_mesh(tmp_path / path.name).mesh.faces) == len(read_mesh(path).mesh.faces)


def test_processes_write_the_same_bytes(meshes, streams, tmp_path):
    assert (
        bsm(
            "encode", "-q", *sorted(meshes.iterdir()), "-j", 3, "-o", tmp_path, *SMALL[:4]
        ).returncode
        == 0
    )
    assert names(tmp_path) == names(streams)
    assert all(
        (tmp_path / name).read_bytes() == (streams / name).read_bytes() for name in names(tmp_path)
    )


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_failures_are_reported_and_the_others_go_on(streams, tmp_path, jobs):
    (tmp_path / "cut.bsm").write_bytes((streams / "a.bsm").read_bytes()[:-10])
    inputs = [streams / "a.bsm", tmp_path / "cut.bsm", tmp_path / "none.bsm", streams / "b.bsm"]
    done = bsm("verify", *inputs, "--json", "-j", jobs)
    assert done.returncode == 12, "the code of the first failure"
    assert [file.get("exit") for file in json.loads(done.stdout)["files"]] == [None, 12, 9, None]
    lines = map(json.loads, done.stderr.splitlines())
    # How far it has come.
    notes = [line.get("note") or line["error"] for line in lines if "stage" not in line]
    assert (
        f"{tmp_path / 'cut.bsm'}: " in notes[1]
        and f"{tmp_path / 'none.bsm'}: No such file" in notes[2]
    )
    assert notes[-1].startswith("2 of 4 files")


def test_info_of_many(streams, capsys):
    assert main(["info", *(str(streams / name) for name in names(streams))]) == 0
    text = capsys.readouterr().out
    assert [line for line in text.splitlines() if line.endswith(":") and "bsm" in line] == [
        f"{streams / name}:" for name in names(streams)
    ]


# ---------------------------------------------------------------------------------------------------- what is refused


def test_outputs_of_many_inputs(tmp_path):
    for name in ("a.ply", "a.obj", "b.ply"):
        (tmp_path / name).write_bytes(b"x")
    a, b, obj = (str(tmp_path / name) for name in ("a.ply", "b.ply", "a.obj"))

    def outputs(inputs, output, suffix=".bsm"):
        return [job.output for job in plan(inputs, output, lambda _: suffix)]

    with pytest.raises(OptionError, match="replace the input"):
        outputs([a, b], str(tmp_path), ".ply")
    assert outputs([a, obj], None) == [f"{a}.bsm", f"{obj}.bsm"]
    for inputs, output, message in (
        ([a, b], str(tmp_path / "c.bsm"), "need an output folder"),
        ([a, "-"], None, "pipe"),
    ):
        with pytest.raises(OptionError, match=message):
            outputs(inputs, output)
    assert outputs([a, b], None) == [str(tmp_path / "a.bsm"), str(tmp_path / "b.bsm")]


def test_outputs_that_the_user_did_not_name_are_not_written_through_links(
    meshes, streams, tmp_path
):
    precious = tmp_path / "precious"
    precious.write_text("precious")
    (tmp_path / "out").mkdir()
    for name in ("a.bsm", "a.ply", "b.bsm"):
        (tmp_path / "out" / name).symlink_to(precious)
    for words in (
        ("encode", meshes / "a.npz", "-o", tmp_path / "out/"),
        ("encode", meshes / "a.npz", meshes / "b.npz", "-o", tmp_path / "out"),
        ("encode", "--recursive", meshes, "-o", tmp_path / "out"),
        ("decode", streams / "a.bsm", "-o", f"{tmp_path}/out/"),
        ("decode", streams / "a.bsm", "-o", tmp_path / "out"),
    ):
        refused = bsm(*words, "-f")
        assert (refused.returncode, "is a symbolic link" in refused.stderr) == (2, True), (
            words,
            refused.stderr,
        )
        assert precious.read_text() == "precious"
    assert (
        bsm("encode", "-f", meshes / "a.npz", "-o", tmp_path / "out" / "a.bsm", *SMALL).returncode
        == 0
    )
    assert precious.read_bytes().startswith(b"\x89BSM")


# ------------------------------------------------------------------------------------------------------------ signals


@pytest.mark.slow
@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_a_signal_leaves_no_half_file_and_no_process(number, code, tmp_path):
    for name in ("a", "b", "c"):
        save(knot(40_000), tmp_path / f"{name}.npz")
    output = tmp_path / "out"
    command = [
        sys.executable,
        "-m",
        "bsm",
        "encode",
        *sorted(tmp_path.iterdir()),
        "-o",
        f"{output}/",
        "-j",
        "2",
    ]
    with subprocess.Popen(
        [*command, "--set", "block-size=300", "--set", "keep=1"],
        cwd=ROOT,
        stderr=subprocess.PIPE,
        start_new_session=True,
    ) as process:
        while not (output.exists() and list(output.iterdir())):
            assert process.poll() is None
            time.sleep(0.05)
        os.killpg(process.pid, number) if number == signal.SIGINT else process.send_signal(number)
        errors = process.communicate(timeout=60)[1].decode()
    assert process.returncode == code, errors
    assert "Traceback" not in errors
    assert names(output) == []
    with pytest.raises(ProcessLookupError):
        for _ in range(100):
            os.killpg(process.pid, 0)
            time.sleep(0.1)


INTERRUPTED = """
import os, signal, sys

class Finder:
    def find_spec(self, name, *_):
        if name == sys.argv[0]:
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Finder())
sys.argv = sys.argv[1:]
from bsm.__main__ import run
run()
"""


@pytest.mark.parametrize(
    "module",
    [
        "bsm.cli",
        "argparse",
        "bsm.ground.console",
        "bsm.commands.encode",
        "numpy",
        "bsm.codec",
        "msgpack",
    ],
)
def test_an_interrupt_in_the_first_moments(module, meshes):
    """Wherever it hits the imports, it is an interrupt and no traceback."""
    done = program.python("-c", INTERRUPTED, module, "encode", meshes / "a.npz", "-o", "-")
    assert (done.returncode, done.stderr) == (130, b"bsm: interrupted\n")


# -------------------------------------------------------------------------------------------------------------- pipes


def shell(script, *arguments):
    """Run a script of bash, whose $B is the program and $S options for small meshes."""
    environment = {**os.environ, "B": f"{sys.executable} -m bsm", "S": " ".join(SMALL)}
    return subprocess.run(
        ["bash", "-c", f"set -eo pipefail; {script}", "bash", *map(str, arguments)],
        capture_output=True,
        timeout=120,
        cwd=arguments[-1],
        env=environment,
        check=False,
        text=True,
    )


def test_a_pipe_without_a_name_wants_one(meshes, tmp_path):
    done = shell("$B encode <(cat $1)", meshes / "a.npz", tmp_path)
    assert done.returncode == 2 and "name it with -o" in done.stderr


# --------------------------------------------------------------------------------------------------------------- bars


def on_a_terminal(*arguments):
    """What the program shows on a terminal."""
    ours, theirs = os.openpty()
    importlib.import_module("termios").tcsetwinsize(theirs, (24, 120))
    with subprocess.Popen(
        [sys.executable, "-m", "bsm", *map(str, arguments)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=theirs,
    ) as process:
        os.close(theirs)
        shown = b""
        try:
            while piece := os.read(ours, 4096):
                shown += piece
        except OSError:  # the other end is closed
            pass
        assert process.wait(timeout=120) == 0, shown
    os.close(ours)
    return shown.decode()


@pytest.mark.slow
def test_one_bar_for_a_search_with_the_time_left(tmp_path):
    save(knot(80_000), tmp_path / "a.npz")
    words = [
        "encode",
        tmp_path / "a.npz",
        "-o",
        tmp_path / "a.bsm",
        "--set",
        "keep=0.3",
        "--threads",
        "1",
    ]
    shown = on_a_terminal(*words, "--theta", "4")
    assert re.search(r"encoding: +\d+%", shown) and "<00:" in shown
    *frames, result = shown.replace("\r\n", "\n").rstrip("\n").split("\r")
    shares = [int(share) for share in re.findall(r"encoding: +(\d+)%\|", shown)]
    assert len(shares) > 3 and max(shares) <= 100
    assert result.strip() == "", "the bar is gone"
    assert any(frame.strip().startswith(str(tmp_path)) for frame in frames)
    save(knot(2000), tmp_path / "a.npz")
    assert on_a_terminal(*words, "-f", "-q") == ""


@pytest.mark.slow
def test_a_bar_for_sequences(tmp_path):
    mesh = knot(30_000)
    positions, faces = mesh.positions, mesh.faces
    frames = np.array([positions * (1 + 0.1 * np.sin(t / 3)) for t in range(12)])
    np.savez(tmp_path / "a.npz", positions=frames, faces=faces)
    words = [
        "encode",
        tmp_path / "a.npz",
        "-o",
        tmp_path / "a.bsm",
        "--set",
        "keep=1",
        "--set",
        "block-size=200",
    ]
    shown = on_a_terminal(*words, "--threads", "1")
    assert re.search(r"encoding: +\d+%", shown) and "KG error" in shown


def test_stages_are_named_while_a_mesh_is_denoised(tmp_path):
    pytest.importorskip("scipy")
    mesh = knot(2000)
    noisy = gaussian_along_normals(mesh.positions, mesh.faces, 0.2, 0)
    save(TriangleMesh(noisy, mesh.faces), tmp_path / "a.npz")
    shown = on_a_terminal("denoise", tmp_path / "a.npz", "-o", tmp_path / "b.npz")
    # A fast machine may not show every stage.
    assert re.search(r"(rehearsing \d+ of \d+|filtering): +\d+%", shown), shown


TRIANGLE = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


@pytest.fixture
def corpus(tmp_path):
    folder = tmp_path / "scans"
    folder.mkdir()
    (folder / "part.off").write_text(TRIANGLE)
    (folder / "part.obj").write_text(OBJ)
    (folder / "other.off").write_text(TRIANGLE)
    (folder / "broken.off").write_text("OFF\n3 1 0\n")
    return folder


def test_inputs_that_differ_in_their_suffix_alone_keep_it(corpus, tmp_path):
    done = bsm("encode", "-r", corpus, "-o", tmp_path / "out", "--report", corpus / "r.json")
    assert done.returncode == 12
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "other.bsm",
        "part.obj.bsm",
        "part.off.bsm",
    ]
    report = json.loads((corpus / "r.json").read_text())
    outputs = {
        entry["input"].rpartition("/")[2]: entry["output"].rpartition("/")[2]
        for entry in report["files"]
    }
    assert outputs["part.obj"] == "part.obj.bsm" and outputs["other.off"] == "other.bsm"
    lines = done.stderr.splitlines()
    head = next(number for number, line in enumerate(lines) if line.startswith("input "))
    assert "broken.off" in lines[head + 1] and lines[head + 1].count("broken.off") == 1
    assert "failed: the file is cut short" in lines[head + 1]
    again = bsm(
        "encode", "-r", corpus, "-o", tmp_path / "out", "--report", corpus / "r.json", "--resume"
    )
    assert (
        "3 of 4 were up to date" in again.stderr and "as it was" not in again.stderr.splitlines()[0]
    )


def keys_of(facts, listed, before=""):
    """The keys of facts; a dot leads into tables whose keys are listed."""
    for name, value in facts.items():
        yield f"{before}{name}"
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, dict) and any(known.startswith(f"{name}.") for known in listed):
                yield from keys_of(part, listed, f"{name}.")


def test_the_documents_list_all_keys_of_reports_and_of_info(corpus, meshes, tmp_path):
    listed = re.findall(r"^\| `([\w.]+)`", (ROOT / "docs/json.md").read_text(), re.MULTILINE)
    save(painted(knot(100)), corpus / "painted.obj")
    np.savez(
        tmp_path / "moving.npz",
        positions=np.stack([knot(100).positions] * 2),
        faces=knot(100).faces,
    )
    encode = (
        "encode",
        "-r",
        corpus,
        "-o",
        tmp_path / "out",
        "--max-error",
        "0.1mm",
        "--meta",
        "unit=mm",
    )
    moving = ("encode", "-f", tmp_path / "moving.npz", "-o", tmp_path / "out/moving.bsm")
    decode = ("decode", "-f", "-r", tmp_path / "out", "-o", tmp_path / "back")
    denoise = ("denoise", "-f", meshes / "a.npz", "-o", tmp_path / "a.npz", "--look")
    facts = []
    explained = ("encode", "-f", meshes / "a.npz", "-o", tmp_path / "explained.bsm", "--explain")
    for words in (encode, (*encode, "--resume"), moving, decode, denoise, explained):
        bsm(*words, "--report", tmp_path / "r.json")
        facts.append(report := json.loads((tmp_path / "r.json").read_text()))
        facts += report["files"]
    facts.append(program.run_json("glb", meshes / "a.npz", "-o", tmp_path / "a.glb"))
    assert facts[-1]["output_bytes"] == (tmp_path / "a.glb").stat().st_size
    facts += [
        program.run_json("info", tmp_path / name)
        for name in ("out/painted.bsm", "out/moving.bsm", "a.glb")
    ]
    assert {key for each in facts for key in keys_of(each, listed)} == {*listed}


def test_a_table_has_failures_first_and_then_the_largest_errors_in_one_unit():
    files = [
        {"input": f"{n}.ply", "max_error_relative": n / 1e4, "max_error": 2.0, "unit": "mm"}
        for n in range(99)
    ]
    bad = {"input": "x", "output": "", "error": "x: bad"}
    lines = list(table([*files, bad]))
    assert lines[1].endswith("failed: bad") and lines[2].startswith("98.ply") and "2 mm" in lines[2]
    assert len(lines) == 22 and lines[-1] == "and 80 more, with smaller errors, in the report"
    assert "0.98 %" in next(
        line for line in table([*files, {**files[0], "unit": "m"}]) if line.startswith("98.ply")
    )
    assert len(list(table([*files[:9], *[bad] * 50]))) == 1 + 50 + 1


def test_patterns_behind_file_urls_are_expanded(corpus, tmp_path):
    jobs = plan([f"file://{corpus}/*.off"], f"file://{tmp_path}/out/", lambda _: ".bsm")
    assert [job.output.rpartition("/")[2] for job in jobs] == [
        "broken.bsm",
        "other.bsm",
        "part.bsm",
    ]
    with pytest.raises(FileNotFoundError, match="no such file"):
        plan([f"file://{corpus}/*.xyz"], None, lambda _: ".bsm")
    with pytest.raises(OptionError, match="two outputs"):
        plan(
            [str(corpus / "part.off"), str(corpus / "part.off")],
            f"{tmp_path}/out/",
            lambda _: ".bsm",
        )


def test_a_server_that_is_down_differs_from_a_missing_file():
    for cause, message in (
        (ConnectionRefusedError(111, "refused"), "does not answer: Connection refused"),
        (None, "No such"),
    ):
        with pytest.raises(OSError, match=message), _errors_of("http://127.0.0.1:1/a.ply"):
            raise FileNotFoundError("http://127.0.0.1:1/a.ply") from cause


@pytest.mark.parametrize("name", ["other.off", "broken.off", "nothere.off"])
def test_with_json_every_line_of_standard_error_is_json(corpus, tmp_path, name):
    done = bsm("encode", corpus / name, corpus / "part.obj", "-o", f"{tmp_path}/", "--json")
    lines = [json.loads(line) for line in done.stderr.splitlines()]
    assert lines and all(
        {*line} <= {"note", "error", "stage", "share", "seconds", "seconds_left"} for line in lines
    )
    json.loads(done.stdout)
    alone = bsm("encode", corpus / name, "-o", tmp_path / "a.bsm", "--json")
    assert [json.loads(line) for line in alone.stderr.splitlines()]
