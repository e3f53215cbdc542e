"""Jobs in processes of this machine, which may die."""

from __future__ import annotations

import multiprocessing
import multiprocessing.connection
import os
import signal
import threading
import time
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from itertools import islice

from bsm.exits import exit_of
from bsm.farm.jobs import Numbered, Outcome, Outcomes, Task, Tasks, Work, far_outcome
from bsm.files.output import Terminated, termination_as_exception

AHEAD = 2
"""Jobs handed out for each process."""
GRACE = 3.0
"""Seconds that a process has to clear away, once its parent is gone, and once it was told to end."""

Handed = dict[int, Task]
Ends = Generator[tuple[int, Outcome], None, Handed]


def in_processes(work: Work, tasks: Tasks, processes: int) -> Outcomes:
    """Do jobs in so many processes at a time."""
    waiting = iter(tasks)
    with termination_as_exception():
        while suspects := (yield from _until_one_dies(work, waiting, processes)):
            for task in suspects.items():
                again = (task[0], task[1].repeated())
                for number in (yield from _until_one_dies(work, iter([again]), 1)):
                    yield (
                        number,
                        Outcome({}, MemoryError(f"{task[1].input}: its process died, twice")),
                    )


def _until_one_dies(work: Work, tasks: Iterator[Numbered], processes: int) -> Ends:
    """Do jobs until there are none, or a process dies; returns what was handed out and has not ended."""
    # Not forked: threads of this process may hold locks.
    pool = ProcessPoolExecutor(processes, multiprocessing.get_context("spawn"), initializer=_end_with_parent)
    handed: Handed = {}
    futures: dict[Future[Outcome], int] = {}
    whole = True
    try:
        while whole:
            for number, args in islice(tasks, AHEAD * processes - len(futures)):
                handed[number] = args
                with _interrupts_ignored():
                    futures[pool.submit(_task, work, args)] = number
            if not futures:
                break
            done, _ = wait(futures, return_when=FIRST_COMPLETED)
            whole = not any(isinstance(future.exception(), BrokenProcessPool) for future in done)
            yield from _ended(done if whole else wait(futures).done, futures, handed)
    except BrokenProcessPool:
        yield from _ended(wait(futures).done, futures, handed)
    finally:
        _end(pool, at_once=bool(handed))
    return handed


def _ended(done: set[Future[Outcome]], futures: dict[Future[Outcome], int], handed: Handed) -> Outcomes:
    """What came of jobs, but for those that died with a process."""
    for future in done:
        number = futures.pop(future)
        if not isinstance(future.exception(), BrokenProcessPool):
            outcome = future.result()
            del handed[number]
            yield number, outcome


def _end(pool: ProcessPoolExecutor, *, at_once: bool) -> None:
    processes = list((pool._processes or {}).values())
    pool.shutdown(wait=not at_once, cancel_futures=True)
    if at_once:
        for process in processes:
            process.terminate()
        for process in processes:
            process.join()


def _end_with_parent() -> None:
    """Let this process not outlive the one that began it, however that ends."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        multiprocessing.connection.wait([sentinel])
        # It may have told this process to end, which is then clearing away what it has begun.
        time.sleep(GRACE)
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(GRACE)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _task(work: Work, task: Task) -> Outcome:
    try:
        return far_outcome(work, task)
    except Terminated:
        # What was begun is cleared away; nothing else is to be taken up.
        os._exit(exit_of(Terminated()).code)


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Let processes that begin here leave Ctrl-C to this one from their first moment on."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
