"""Outputs appear as a whole or not at all, whichever process ends, and workers end with their parent."""

import os
import signal
import stat
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

import pytest

from bsm import encode, save
from bsm.cli import main
from bsm.commands import encode as encode_module
from bsm.files.output import open_output
from bsm.jobs import plan as plan_module
from bsm.jobs.plan import plan
from bsm.jobs.run import task_of
from bsm.jobs.task import Task
from tests.bsm.program import bound, contents, python
from tests.shapes import torus


def test_a_file_is_written(tmp_path):
    name = 125 * "ü" + ".bsm"  # of 254 bytes
    with open_output(tmp_path / name) as file:
        file.write(b"whole")
        assert not (tmp_path / name).exists()
    assert contents(tmp_path) == {name: b"whole"}


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit])
def test_an_error_leaves_nothing_behind(error, tmp_path):
    with pytest.raises(error), open_output(tmp_path / "a") as file:
        file.write(b"half")
        raise error
    assert contents(tmp_path) == {}


def test_an_error_leaves_the_old_file(tmp_path):
    (tmp_path / "a").write_bytes(b"old")
    with pytest.raises(ValueError), open_output(tmp_path / "a", overwrite=True) as file:
        file.write(b"half")
        raise ValueError
    assert contents(tmp_path) == {"a": b"old"}


def test_nothing_is_overwritten_unasked(tmp_path):
    (tmp_path / "a").write_bytes(b"old")
    with pytest.raises(FileExistsError, match="-f overwrites"), open_output(tmp_path / "a") as file:
        file.write(b"new")
    assert contents(tmp_path) == {"a": b"old"}


def test_a_file_that_appears_meanwhile_is_not_overwritten(tmp_path):
    with pytest.raises(FileExistsError), open_output(tmp_path / "a") as file:
        file.write(b"new")
        (tmp_path / "a").write_bytes(b"somebody else's")
    assert contents(tmp_path) == {"a": b"somebody else's"}


def test_what_a_dead_writer_left_goes_with_the_next_write_and_nothing_of_a_living_one(tmp_path):
    pytest.importorskip("fcntl", reason="without locks the file of a writer that died stays")
    (tmp_path / ".a.abcd_123.part").write_bytes(b"cut off")
    (tmp_path / ".ab.abcd_123.part").write_bytes(b"of another name")
    with open_output(tmp_path / "a", overwrite=True) as first:
        first.write(b"first")
        with open_output(tmp_path / "a") as second:
            second.write(b"second")
    assert contents(tmp_path) == {"a": b"first", ".ab.abcd_123.part": b"of another name"}


def test_permissions(tmp_path):
    before = os.umask(0o027)
    try:
        with open_output(tmp_path / "new") as file:
            file.write(b"")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "new").stat().st_mode) == 0o640
    (tmp_path / "old").write_bytes(b"")
    (tmp_path / "old").chmod(0o604)
    with open_output(tmp_path / "old", overwrite=True) as file:
        file.write(b"")
    assert stat.S_IMODE((tmp_path / "old").stat().st_mode) == 0o604


def test_the_file_behind_a_link_is_replaced(tmp_path):
    (tmp_path / "real").write_bytes(b"old")
    (tmp_path / "link").symlink_to("real")
    with open_output(tmp_path / "link", overwrite=True) as file:
        file.write(b"new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_bytes() == b"new"


def test_a_link_that_the_user_did_not_name_is_replaced_itself(tmp_path):
    (tmp_path / "real").write_bytes(b"old")
    (tmp_path / "link").symlink_to("real")
    os.mkfifo(tmp_path / "pipe")
    for name in ("link", "pipe"):
        with pytest.raises(FileExistsError), open_output(tmp_path / name, follow=False) as file:
            file.write(b"new")
        with open_output(tmp_path / name, overwrite=True, follow=False) as file:
            file.write(b"new")
        assert not (tmp_path / name).is_symlink() and (tmp_path / name).read_bytes() == b"new"
    assert (tmp_path / "real").read_bytes() == b"old"


def test_a_link_in_the_place_of_an_unfinished_file_is_not_followed(tmp_path):
    (tmp_path / "real").write_bytes(b"old")
    os.chmod(tmp_path / "real", 0o600)
    with open_output(tmp_path / "a", overwrite=True) as file:
        file.write(b"new")
        (unfinished,) = (path for path in tmp_path.iterdir() if path.name not in ("a", "real"))
        unfinished.unlink()
        unfinished.symlink_to("real")
    assert (
        stat.S_IMODE((tmp_path / "real").stat().st_mode) == 0o600
        and (tmp_path / "real").read_bytes() == b"old"
    )


def test_what_lies_in_the_place_of_a_dead_writers_file_is_not_waited_for(tmp_path):
    """A pipe would be waited for; a file that a link names is not ours."""
    os.mkfifo(tmp_path / ".a.abcd1234.part")
    (tmp_path / "real").write_bytes(b"old")
    (tmp_path / ".a.efgh5678.part").symlink_to("real")
    with open_output(tmp_path / "a") as file:
        file.write(b"new")
    assert (tmp_path / "a").read_bytes() == b"new" and (tmp_path / "real").read_bytes() == b"old"


def test_folders_and_missing_folders(tmp_path):
    with pytest.raises(IsADirectoryError), open_output(tmp_path):
        pass
    with pytest.raises(FileNotFoundError), open_output(tmp_path / "none" / "a"):
        pass


def test_a_device_is_written_to_as_it_is():
    with open_output("/dev/null") as file:
        file.write(b"anything")
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)


@pytest.mark.skipif(sys.platform == "win32", reason="no bounds of processes")
def test_a_file_that_does_not_fit_leaves_nothing_behind(tmp_path):
    save(torus(60, 40), tmp_path / "a.ply")
    before = contents(tmp_path)
    words = ["-B", "-m", "bsm", "encode", tmp_path / "a.ply", "--quiet"]
    done = python(*words, preexec_fn=bound("RLIMIT_FSIZE", 100), text=True)
    assert done.returncode == 9 and "File too large" in done.stderr
    assert contents(tmp_path) == before


def test_threads_do_not_read_the_mask_while_another_does(tmp_path, monkeypatch):
    before, umask = os.umask(0o027), os.umask

    def slow(mask):
        found = umask(mask)
        time.sleep(0.01)
        return found

    def write(name):
        with open_output(tmp_path / name) as file:
            file.write(b"")

    monkeypatch.setattr(os, "umask", slow)
    try:
        with ThreadPoolExecutor(4) as pool:
            list(pool.map(write, "abcd"))
    finally:
        umask(before)
    assert {stat.S_IMODE(path.stat().st_mode) for path in tmp_path.iterdir()} == {0o640}


PROGRAM = """
import os, sys, time
from bsm.jobs.task import Task
from bsm.jobs.workers import in_processes

def sleeping(task, console):
    open(os.path.join(task.input, str(os.getpid())), "w").close()
    time.sleep(120)
    return {}

if __name__ == "__main__":
    list(in_processes(sleeping, ((number, Task(input=sys.argv[1])) for number in range(2)), 2))
"""


def is_running(process):
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def wait_for(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.1)
    assert condition()


@pytest.mark.skipif(sys.platform != "linux", reason="processes are looked for as on Linux")
def test_workers_end_with_a_parent_that_is_killed(tmp_path):
    program, pids = tmp_path / "program.py", tmp_path / "pids"
    program.write_text(PROGRAM)
    pids.mkdir()
    parent = subprocess.Popen([sys.executable, str(program), str(pids)])
    workers = []
    try:
        wait_for(lambda: len(list(pids.iterdir())) == 2)
        workers = [int(path.name) for path in pids.iterdir()]
        assert all(map(is_running, workers))
        parent.send_signal(signal.SIGKILL)
        parent.wait()
        wait_for(lambda: not any(map(is_running, workers)), 20)
    finally:
        parent.kill()
        for worker in workers:
            with suppress(ProcessLookupError):
                os.kill(worker, signal.SIGKILL)


def test_of_two_that_write_one_new_file_the_second_fails(tmp_path):
    (job,) = plan([str(tmp_path / "mesh.obj")], None, lambda _: ".bsm")
    first, second = task_of(Task(), job), task_of(Task(), job)
    with open_output(first.output, overwrite=first.may_replace(first.output)) as file:
        file.write(b"first")
    with (
        pytest.raises(FileExistsError, match="exists already"),
        open_output(second.output, overwrite=second.may_replace(second.output)) as file,
    ):
        file.write(b"second")
    assert (tmp_path / "mesh.bsm").read_bytes() == b"first"


def test_an_attempt_that_was_cut_off_may_be_made_again(tmp_path):
    (job,) = plan([str(tmp_path / "mesh.obj")], None, lambda _: ".bsm")
    task = task_of(Task(), job)
    assert not task.may_replace(task.output)
    assert task.repeated().may_replace(task.output)


@pytest.mark.parametrize("closed", ["2>&-", "2>/dev/full"])
@pytest.mark.parametrize(
    "words", ["encode a.ply -o b.bsm", "encode a.ply -o b.bsm --json", "info a.bsm", "verify a.bsm"]
)
@pytest.mark.skipif(sys.platform != "linux", reason="a shell and a device that is always full")
def test_no_result_is_lost_for_a_note(closed, words, tmp_path):
    save(torus(12, 8), tmp_path / "a.ply")
    (tmp_path / "a.bsm").write_bytes(encode(tmp_path / "a.ply"))
    ended = subprocess.run(
        f"{sys.executable} -m bsm {words} {closed}", shell=True, cwd=tmp_path, capture_output=True
    )
    assert ended.returncode == 0
    assert (
        not words.startswith("encode")
        or (tmp_path / "b.bsm").read_bytes() == (tmp_path / "a.bsm").read_bytes()
    )
    assert bool(ended.stdout) == ("json" in words or "info" in words)


@pytest.mark.parametrize("command", ["encode", "decode", "denoise"])
@pytest.mark.parametrize("there", [True, False])
def test_links_that_appear_after_planning_are_not_followed(command, there, tmp_path, monkeypatch):
    """Of two inputs to a folder, the second output becomes a link while the first one is written."""
    os.symlink("nowhere", tmp_path / "tried")
    victim, out = tmp_path / "victim", tmp_path / "out"
    given = [tmp_path / f"{name}.{'bsm' if command == 'decode' else 'ply'}" for name in "ab"]
    for name in given:
        save(torus(12, 8), tmp_path / "mesh.ply")
        name.write_bytes(
            encode(tmp_path / "mesh.ply")
            if command == "decode"
            else (tmp_path / "mesh.ply").read_bytes()
        )
    suffix = ".bsm" if command == "encode" else ".ply"
    planned = plan_module.refuse_collisions

    def swapped(inputs, outputs):
        outputs = list(outputs)
        planned(inputs, outputs)
        out.mkdir()
        Path(outputs[-1]).symlink_to(victim)

    if there:
        victim.write_bytes(b"precious")
    monkeypatch.setattr(plan_module, "refuse_collisions", swapped)
    words = [command, *map(str, given), "-o", f"{out}/", "-q", "-f", "-j", "1"]
    main([*words, *(["--format", "ply"] if command == "decode" else [])])
    assert victim.exists() == there and (not there or victim.read_bytes() == b"precious")
    assert len(list(out.glob(f"*{suffix}"))) == 2


@pytest.mark.parametrize("beside", [False, True])
def test_a_folder_that_becomes_a_link_is_not_followed(beside, tmp_path, monkeypatch):
    """A folder below the one that the user named is swapped for a link after planning."""
    os.symlink("nowhere", tmp_path / "tried")
    given, victim = tmp_path / "in", tmp_path / "victim"
    (given / "sub").mkdir(parents=True)
    victim.mkdir()
    for name in (given / "a.ply", given / "sub" / "b.ply", victim / "b.ply"):
        save(torus(12, 8), name)
    (victim / "b.bsm").write_bytes(b"precious")
    out = given if beside else tmp_path / "out"

    def swapped(*planned):
        jobs = plan_module.plan_trees(*planned)
        (out / "sub").rename(tmp_path / "away")
        (out / "sub").symlink_to(victim)
        return jobs

    monkeypatch.setattr(encode_module, "plan_trees", swapped)
    assert (
        main(
            [
                "encode",
                "-r",
                str(given),
                *([] if beside else ["-o", str(out)]),
                "-q",
                "-f",
                "-j",
                "1",
            ]
        )
        != 0
    )
    assert (victim / "b.bsm").read_bytes() == b"precious" and len(list(victim.iterdir())) == 2
    assert (out / "a.bsm").exists()
