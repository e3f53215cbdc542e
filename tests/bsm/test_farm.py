"""Many inputs: on clusters and in processes that die, behind URLs, and from where a run has stopped."""

import http.server
import json
import os
import signal
import subprocess
import sys
import threading
import time
from functools import partial
from pathlib import Path

import pytest

import bsm
from bsm import ArgumentError, DependencyError, FormatError, OptionError, read_mesh
from bsm.cli import main
from bsm.files.output import open_output
from bsm.ground.console import Console
from bsm.jobs.run import Batch, run_many
from bsm.jobs.task import Job, Task
from tests.bsm.deadly import deadly
from tests.bsm.program import ROOT, contents
from tests.bsm.program import bsm as program
from tests.shapes import knot, torus

pytest.importorskip("fsspec")


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    """Twelve meshes, each of its own."""
    folder = tmp_path_factory.mktemp("sources")
    for number in range(12):
        bsm.save(torus(30 + number, 20), folder / f"{number:02}.ply")
    return sorted(map(str, folder.iterdir()))


def started(*words):
    return subprocess.Popen(
        [sys.executable, "-m", "bsm", *map(str, words)],
        cwd=ROOT,
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )


def until(condition, process):
    """Wait for something to happen while a process runs."""
    end = time.monotonic() + 100
    while not condition():
        assert process.poll() is None and time.monotonic() < end
        time.sleep(0.01)


# ------------------------------------------------------------------------------------------------------------ clusters


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", silence_logs=50
    ) as cluster:
        yield cluster


def test_a_cluster_without_workers_is_waited_for_and_then_an_error(sources, tmp_path, capsys):
    distributed = pytest.importorskip("distributed")
    options = {"threads_per_worker": 1, "dashboard_address": ":0", "silence_logs": 50}
    with distributed.LocalCluster(n_workers=0, **options) as cluster:
        words = ["encode", *sources[:2], "-o", f"{tmp_path}/", "--dask", cluster.scheduler_address]
        assert main([*words, "--dask-wait", "6"]) == 9
        said = capsys.readouterr().err
        assert "waiting for a worker" in said and "has had no worker for 6 s" in said
        assert not list(tmp_path.iterdir())
        cluster.scale(1)
        assert main(words) == 0
        assert len(list(tmp_path.iterdir())) == 2


@pytest.fixture(scope="module")
def larger(tmp_path_factory):
    """Ten meshes that take a while."""
    folder = tmp_path_factory.mktemp("larger")
    for number in range(10):
        bsm.save(knot(3_000, seed=number), folder / f"{number:02}.npz")
    return sorted(map(str, folder.iterdir()))


@pytest.mark.slow
def test_a_worker_that_is_killed_loses_nothing_and_repeats_nothing(cluster, larger, tmp_path):
    distributed = pytest.importorskip("distributed")
    output, report = tmp_path / "out", tmp_path / "report.json"
    command = (
        "encode",
        *larger,
        "-o",
        f"{output}/",
        "--dask",
        cluster.scheduler_address,
        "--report",
        report,
        "--json",
        "--set",
        "step=0.001",
    )
    with (
        distributed.Client(cluster.scheduler_address, set_as_default=False) as client,
        started(*command) as process,
    ):
        until(lambda: output.exists() and len(list(output.glob("*.bsm"))) >= 2, process)
        before = client.run(os.getpid)
        busy = {worker: tasks for worker, tasks in client.processing().items() if tasks}
        victim = before[next(iter(busy))]
        os.kill(victim, signal.SIGKILL)
        printed, errors = process.communicate(timeout=120)
        assert process.returncode == 0, errors.decode()
        assert victim not in client.run(os.getpid).values()
    content = json.loads(report.read_text())
    assert (
        content["complete"] and content["totals"]["done"] == 10 and content["totals"]["failed"] == 0
    )
    assert [file["input"] for file in content["files"]] == larger
    assert json.loads(printed) == {"files": content["files"]}
    assert sorted(contents(output)) == [Path(file["output"]).name for file in content["files"]]
    for file in content["files"]:
        assert file["bytes"] == os.path.getsize(file["output"])
        assert Path(file["output"]).read_bytes() == bsm.encode(file["input"], threads=1, step=0.001)
    notes = [json.loads(line).get("note", "") for line in errors.decode().splitlines()]
    assert [sum(note.startswith(f"{name} ") for note in notes) for name in larger] == [1] * 10
    assert notes[-1].startswith("10 of 10 files")


def test_a_cluster_goes_on_behind_failures_and_back(cluster, sources, tmp_path):
    (tmp_path / "no.ply").write_text("nothing")
    inputs = [*sources[:2], str(tmp_path / "no.ply"), str(tmp_path / "none.ply")]
    done = bsm.encode_many(inputs, tmp_path / "new", dask=cluster.scheduler_address, grid=8)
    assert [facts.get("exit") for facts in done] == [None, None, 3, 9]
    assert sorted(contents(tmp_path / "new")) == ["00.bsm", "01.bsm"]
    streams = [facts["output"] for facts in done[:2]]
    assert (
        main(
            [
                "decode",
                "-q",
                *streams,
                "-o",
                f"{tmp_path}/back/",
                "--dask",
                cluster.scheduler_address,
            ]
        )
        == 0
    )
    for name, source in zip(("00.ply", "01.ply"), sources):
        assert len(read_mesh(tmp_path / "back" / name).mesh.faces) == len(
            read_mesh(source).mesh.faces
        )


def test_a_job_that_kills_every_worker_has_failed_alone(cluster, tmp_path):
    jobs = [Job(f"/{name}", str(tmp_path / name)) for name in ("a", "always", "b", "c")]
    cluster.scheduler.allowed_failures = 0
    done = run_many(
        Batch(dask=cluster.scheduler_address), Task(quiet=True), Console(quiet=True), deadly, jobs
    )
    cluster.scheduler.allowed_failures = 3
    assert [facts.get("exit") for facts in done] == [None, 6, None, None]
    assert {"a", "b", "c"} == {name for name in contents(tmp_path) if "always" not in name}


def test_no_scheduler(sources, tmp_path, capsys):
    pytest.importorskip("distributed")
    with pytest.MonkeyPatch.context() as patch:
        import dask

        patch.setitem(dask.config.config["distributed"]["comm"]["timeouts"], "connect", "1s")
        assert (
            main(["encode", sources[0], "-o", f"{tmp_path}/", "--dask", "tcp://127.0.0.1:1"]) == 9
        )
    assert "no Dask scheduler answers here" in capsys.readouterr().err
    assert main(["encode", "-", "-o", "-", "--dask", "tcp://127.0.0.1:1"]) == 2


# ----------------------------------------------------------------------------------------------------------- processes


DEADLY_BATCH = """
import json, sys
from pathlib import Path
from bsm.ground.console import Console
from bsm.jobs.run import Batch, run_many
from bsm.jobs.task import Job, Task
from tests.bsm.deadly import deadly

folder, *names = sys.argv[1:]
jobs = [Job(name, str(Path(folder, name))) for name in names]
heard = []
quiet = Task(quiet=True), Console(quiet=True)
done = run_many(Batch(jobs=2), *quiet, deadly, jobs, lambda job, _: heard.append(job.input))
print(json.dumps({"heard": heard, "done": done}))
"""
"""In a process of its own: threads of the cluster above may run in this one."""


def test_a_process_that_dies_takes_only_its_own_job_along(tmp_path):
    names = ["a", "b", "once", "c", "fault", "always", "d", "e"]
    command = [sys.executable, "-c", DEADLY_BATCH, str(tmp_path), *names]
    process = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, timeout=120, check=False
    )
    assert process.returncode == 0, process.stderr
    result = json.loads(process.stdout)
    done = result["done"]
    assert result["heard"] == names == [facts["input"] for facts in done]
    assert {facts["input"]: facts["exit"] for facts in done if "error" in facts} == {
        "fault": 1,
        "always": 6,
    }
    assert "KeyError" in done[4]["error"] and "please report" in done[4]["error"]
    left = {name for name in contents(tmp_path) if not name.endswith(".part")}
    assert left == {*names, "once.mark", "always.mark"} - {"always"}
    pytest.importorskip("fcntl", reason="without locks the files of writers that died stay")
    assert all(".always." in name for name in set(contents(tmp_path)) - left), (
        "only what has no other attempt"
    )


@pytest.mark.parametrize("run", [Batch(), Batch(jobs=2)])
def test_jobs_wait_for_what_they_need_and_are_left_out_where_it_failed(tmp_path, run):
    needs = {"fault": (), "a": (), "b": (1,), "c": (0, 1), "d": (3,), "e": (2,), "f": ()}
    jobs = [Job(name, str(tmp_path / name), after) for name, after in needs.items()]
    heard = []
    done = run_many(
        run,
        Task(quiet=True),
        Console(quiet=True),
        deadly,
        jobs,
        lambda job, _: heard.append(job.input),
    )
    assert heard == [facts["input"] for facts in done if facts] == ["fault", *"abef"]
    assert set(contents(tmp_path)) == {*heard}
    written = [(tmp_path / name).stat().st_mtime_ns for name in "abe"]
    assert written == sorted(written)


# ---------------------------------------------------------------------------------------------------------------- URLs


class Server(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.fixture(scope="module")
def web(sources):
    """The address of a server that has the meshes."""
    handler = partial(Server, directory=str(Path(sources[0]).parent))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_address[1]}"
        server.shutdown()
        thread.join()


def test_inputs_from_the_web(web, sources, tmp_path):
    pytest.importorskip("aiohttp")
    names = [f"{web}/00.ply", f"{web}/01.ply?version=2", f"{web}/none.ply"]
    done = program(
        "encode", *names, "-o", f"{tmp_path}/", "-j", 2, "--json", "--grid", 8, text=True
    )
    files = json.loads(done.stdout)["files"]
    assert done.returncode == 9 and f"{web}/none.ply: No such file" in done.stderr
    assert [file.get("input_bytes") for file in files] == [*map(os.path.getsize, sources[:2]), None]
    for name, source in zip(("00.bsm", "01.bsm"), sources):
        assert (tmp_path / name).read_bytes() == bsm.encode(source, grid=8)
    assert len(bsm.load(names[0]).faces) == len(read_mesh(sources[0]).mesh.faces)


def test_nothing_is_written_to_the_web(web, capsys):
    assert main(["encode", f"{web}/00.ply"]) == 2
    assert "cannot be written to; name another place with -o" in capsys.readouterr().err


def test_there_and_back_in_memory(sources, capsys):
    assert main(["encode", "-q", *sources[:3], "-o", "memory://farm/new/"]) == 0
    assert main(["encode", "-q", sources[0], "-o", "memory://farm/new/00.bsm"]) == 9
    assert "exists already" in capsys.readouterr().err
    assert (
        main(
            [
                "decode",
                "-q",
                "memory://farm/new/*.bsm",
                "-o",
                "memory://farm/back/",
                "--format",
                "obj",
            ]
        )
        == 0
    )
    assert main(["verify", "-q", "memory://farm/new/*.bsm"]) == 0
    assert (
        main(["encode", "memory://farm/back/00.obj", "-o", "memory://farm/back/00.obj", "-f"]) == 2
    )
    mesh = bsm.load("memory://farm/back/00.obj")
    assert (
        mesh.positions == pytest.approx(bsm.decode("memory://farm/new/00.bsm").positions)
    ) or len(mesh.faces)
    with pytest.raises(FileNotFoundError):
        bsm.load("memory://farm/back/none.obj")
    assert main(["decode", "memory://farm/none/*.bsm", "-o", "memory://farm/back/"]) == 9


def test_what_fails_leaves_nothing_behind_a_url():
    with pytest.raises(ValueError, match="half"), open_output("memory://farm/half") as file:
        file.write(b"half")
        raise ValueError("half")
    with pytest.raises(FileNotFoundError):
        bsm.load("memory://farm/half")


def test_files_by_url(sources, tmp_path):
    assert (
        main(["encode", "-q", Path(sources[0]).as_uri(), "-o", f"{tmp_path.as_uri()}/a%20b.bsm"])
        == 0
    )
    assert list(contents(tmp_path)) == ["a b.bsm"]


def test_packages_that_are_missing(monkeypatch):
    with pytest.raises(OptionError, match="nowhere"):
        bsm.load("nowhere://a/b.ply")
    monkeypatch.setitem(sys.modules, "s3fs", None)
    with pytest.raises(
        DependencyError, match=r"s3:// needs a package that is missing: pip install 's3fs'"
    ):
        bsm.load("s3://bucket/a.ply")
    monkeypatch.setitem(sys.modules, "fsspec", None)
    with pytest.raises(DependencyError, match=r"pip install .*\[remote\]'"):
        bsm.load("https://host/a.ply")


# -------------------------------------------------------------------------------------------------------------- resume


def test_only_what_is_not_as_it_was_is_done_again(sources, tmp_path):
    inputs = []
    for source in sources[:6]:
        inputs.append(str(tmp_path / Path(source).name))
        Path(inputs[-1]).write_bytes(Path(source).read_bytes())
    output, report = tmp_path / "out", tmp_path / "report.json"

    def run(names=inputs, grid=8, **more):
        done = bsm.encode_many(names, output, report=report, resume=True, grid=grid, **more)
        content = json.loads(report.read_text())
        assert content["complete"] and content["files"] == done
        return {Path(facts["input"]).stem for facts in done if "resumed" not in facts}

    assert run(inputs[:5]) == {"00", "01", "02", "03", "04"}
    whole = contents(output)
    assert run(inputs[:5]) == set()
    (output / "00.bsm").unlink()
    (output / "01.bsm").write_bytes(whole["01.bsm"][:-1] + b"?")
    pytest.importorskip("fcntl", reason="without locks the file of a writer that died stays")
    (output / ".01.bsm.abcd_123.part").write_bytes(b"cut off")
    os.utime(inputs[2], (1, 1))
    refused = bsm.encode_many(inputs, output, report=report, resume=True, grid=8)
    assert [facts.get("exit") for facts in refused] == [None, 9, None, None, None, None]
    assert "differs from the report" in refused[1]["error"]
    assert (output / "01.bsm").read_bytes().endswith(b"?")
    assert run(overwrite=True) == {"01"}
    assert {name: data for name, data in contents(output).items() if name != "05.bsm"} == whole
    assert run(grid=9, jobs=2) == {"00", "01", "02", "03", "04", "05"}
    assert run(grid=9) == set()


def test_a_run_that_was_killed_goes_on(larger, tmp_path):
    output, report = tmp_path / "out", tmp_path / "report.json"
    command = (
        "encode",
        *larger,
        "-o",
        f"{output}/",
        "--report",
        report,
        "--resume",
        "--set",
        "step=0.001",
    )
    with started(*command) as process:
        until(
            lambda: report.exists() and json.loads(report.read_text())["totals"]["done"] >= 2,
            process,
        )
        process.kill()
    content = json.loads(report.read_text())
    assert not content["complete"] and len(content["files"]) == 10
    done = program(*command, "--json", "-j", 2, text=True)
    assert done.returncode == 0, done.stderr
    files = json.loads(done.stdout)["files"]
    assert sum("resumed" in file for file in files) == content["totals"]["done"]
    assert sorted(contents(output)) == [f"{number:02}.bsm" for number in range(10)]
    assert json.loads(report.read_text())["complete"]


def forged(path, command, options, *files):
    path.write_text(json.dumps({"command": command, "options": options, "files": list(files)}))


def test_a_forged_report_lets_nothing_be_replaced(sources, tmp_path):
    """It may name files, and say of them what it likes: only the very bytes that it tells of are replaced."""
    output, report = tmp_path / "out", tmp_path / "r.json"
    first = bsm.encode_many(sources[:2], output, report=report, grid=8)
    content = json.loads(report.read_text())
    whole = contents(output)
    (output / "00.bsm").write_bytes(b"precious")
    for claim in ({}, {"output_sha256": "0" * 64}, {"error": "?", "exit": 1}, {"input_state": [1]}):
        entries = [{"input": facts["input"], "output": facts["output"], **claim} for facts in first]
        forged(report, content["command"], content["options"], *entries)
        done = bsm.encode_many(sources[:2], output, report=report, resume=True, grid=8)
        assert "differs from the report" in done[0]["error"], claim
        assert "error" not in done[1]  # what is there is what would be made
        assert contents(output) == {"00.bsm": b"precious", "01.bsm": whole["01.bsm"]}
    elsewhere = tmp_path / "elsewhere.txt"
    elsewhere.write_bytes(b"precious")
    forged(
        report,
        content["command"],
        content["options"],
        {"input": sources[0], "output": str(elsewhere)},
    )
    bsm.encode_many(sources[1:2], output, report=report, resume=True, grid=8)
    assert elsewhere.read_bytes() == b"precious"


@pytest.mark.parametrize(
    "claim",
    [
        {"input_bytes": 10**400},
        {"input_bytes": 1e308},
        {"seconds": 10**400},
        {"output_bytes": 5e-324},
        {"kg": float("nan")},
        {"error": ""},
        {"error": "x"},
        {"error": "x", "exit": "a"},
        {"error": "x", "exit": 0},
        {"exit": "a"},
    ],
)
def test_what_no_report_says_is_refused_in_one_sentence(claim, tmp_path, capsys):
    bsm.save(torus(5, 5), tmp_path / "a.ply")
    entry = {"input": str(tmp_path / "a.ply"), "output": str(tmp_path / "a.bsm"), **claim}
    forged(tmp_path / "r.json", "encode_one", {}, entry, {**entry, "output": "b.bsm"})
    words = ("encode", tmp_path / "a.ply", "-q", "--report", tmp_path / "r.json", "--resume")
    assert main([str(word) for word in words]) == 3
    (errors,) = capsys.readouterr().err.splitlines()
    assert "not a report of bsm" in errors and not (tmp_path / "a.bsm").exists()


def test_a_report_holds_bounds_that_are_infinite(sources, tmp_path):
    more = {"contract": bsm.Contract(0.01), "report": tmp_path / "r.json", "resume": True}
    first, again = (bsm.encode_many(sources[:1], tmp_path, **more) for _ in range(2))
    assert "error" not in first[0] and "resumed" in again[0]


NOBODYS = Path("/sys/kernel")
"""A folder in which not even root makes files."""


def test_a_cluster_that_may_not_write_says_where(cluster, sources, tmp_path, capsys):
    """A folder where one file should be costs that file; one that takes no files costs each, with a sentence."""
    where = cluster.scheduler_address
    (tmp_path / "out" / "01.bsm").mkdir(parents=True)
    done = bsm.encode_many(sources[:3], tmp_path / "out", dask=where, grid=8, overwrite=True)
    assert [facts.get("exit") for facts in done] == [None, 9, None]
    assert done[1]["error"] == f"{tmp_path}/out/01.bsm: the output is a folder"
    streams = [tmp_path / "out" / f"{name}.bsm" for name in ("00", "02")]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "00.bsm",
        "01.bsm",
        "02.bsm",
    ]
    if not NOBODYS.is_dir():
        pytest.skip("there is no folder that takes no files")
    before = sorted(NOBODYS.iterdir())
    for command, inputs in (("encode", sources[:2]), ("decode", streams)):
        assert main([command, *map(str, inputs), "-o", f"{NOBODYS}/", "--dask", where]) == 9
        errors = capsys.readouterr().err.splitlines()
        assert sum(line.startswith(f"bsm: {NOBODYS}/") for line in errors) == 2
        assert errors[-1].startswith("0 of 2 files")
    report = NOBODYS / "report.json"
    with pytest.raises(OSError, match=r"report\.json"):
        bsm.encode_many(sources[:2], tmp_path / "late", dask=where, grid=8, report=report)
    assert not list((tmp_path / "late").iterdir()), (
        "work was done for a report that cannot be written"
    )
    assert sorted(NOBODYS.iterdir()) == before


def test_what_is_not_ours_is_not_written_over(sources, tmp_path, capsys):
    (tmp_path / "00.bsm").write_bytes(b"mine")
    done = bsm.encode_many(sources[:2], tmp_path, report=tmp_path / "r.json", resume=True, grid=8)
    assert [facts.get("exit") for facts in done] == [9, None]
    assert (tmp_path / "00.bsm").read_bytes() == b"mine"
    with pytest.raises(FileExistsError):
        bsm.encode_many(sources[:2], tmp_path, report=tmp_path / "r.json", grid=8)
    with pytest.raises(OptionError, match="--report"):
        bsm.encode_many(sources[:2], tmp_path, resume=True, grid=8)
    (tmp_path / "r.json").write_text('{"files": 3}')
    with pytest.raises(FormatError, match="not a report"):
        bsm.encode_many(sources[:2], tmp_path, report=tmp_path / "r.json", resume=True, grid=8)
    with pytest.raises(ArgumentError, match="teta"):
        bsm.encode_many(sources[:2], tmp_path, teta=3)
