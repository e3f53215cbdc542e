"""Nothing is left behind: workers whose parent is killed, and files that two runs write at a time."""

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress

import pytest

from bsm.files.output import open_output
from bsm.jobs.plan import plan
from bsm.jobs.run import task_of
from bsm.jobs.task import Task

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
