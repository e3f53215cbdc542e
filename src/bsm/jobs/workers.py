"""Run jobs in processes of this machine or on a Dask cluster, and survive their death."""

import errno
import logging
import multiprocessing
import multiprocessing.connection
import os
import signal
import sys
import threading
import time
import uuid
import warnings
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any

from bsm.bitstream.errors import DependencyError, imported
from bsm.exits import exit_of
from bsm.files.output import Terminated, termination_as_exception
from bsm.jobs.task import Numbered, Outcome, Outcomes, Task, Tasks, Work, far_outcome

AHEAD = 2  # jobs handed out for each process, and for each thread of a cluster
GRACE = 3.0  # seconds that a process has to clear away, once its parent is gone, and once it was asked to end

Handed = dict[int, Task]


def in_processes(work: Work, tasks: Tasks, processes: int) -> Outcomes:
    with termination_as_exception():
        while suspects := (yield from _until_one_dies(work, tasks, processes)):
            for number, task in suspects.items():
                if (yield from _until_one_dies(work, iter([(number, task.repeated())]), 1)):
                    yield number, Outcome({}, MemoryError(f"{task.input}: its process died twice"))


def _until_one_dies(work: Work, tasks: Tasks, processes: int) -> Generator[tuple[int, Outcome], None, Handed]:
    """Do jobs until all are done or a process dies; return the submitted jobs that have not ended."""
    # Not forked: threads of this process may hold locks.
    pool = ProcessPoolExecutor(processes, multiprocessing.get_context("spawn"), initializer=_end_with_parent)
    handed: Handed = {}
    futures: dict[Future[Outcome], int] = {}
    whole = True
    try:
        while whole:
            try:
                while len(futures) < AHEAD * processes and (given := next(tasks, None)):
                    number, task = given
                    handed[number] = task
                    with _interrupts_ignored():
                        futures[pool.submit(_task, work, task)] = number
            except BrokenProcessPool:
                whole = False
            if not futures:
                break
            done = wait(futures, return_when=FIRST_COMPLETED).done
            if not whole or any(isinstance(future.exception(), BrokenProcessPool) for future in done):
                whole, done = False, wait(futures).done
            for future in done:
                number = futures.pop(future)
                if not isinstance(future.exception(), BrokenProcessPool):
                    del handed[number]
                    yield number, future.result()
    finally:
        alive = list((pool._processes or {}).values()) if handed else []
        pool.shutdown(wait=not handed, cancel_futures=True)
        for process in alive:
            process.terminate()
        for process in alive:
            process.join()
    return handed


def _end_with_parent() -> None:
    """End this process with its parent, however that ends; print no warnings."""
    if not sys.warnoptions:
        warnings.simplefilter("ignore")
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        multiprocessing.connection.wait([sentinel])
        # The parent may have asked this process to end; it is then removing its unfinished files.
        time.sleep(GRACE)
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(GRACE)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Make processes that are started here ignore Ctrl-C from their first moment on."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def on_cluster(work: Work, tasks: Tasks, address: str) -> Outcomes:
    """Do jobs on the workers of a cluster; other workers repeat the jobs of a worker that dies."""
    distributed = imported("distributed", "a cluster needs Dask", "dask")
    try:
        client: Any = distributed.Client(address, set_as_default=False)
    except (OSError, ValueError) as error:
        raise OSError(errno.EHOSTUNREACH, "no Dask scheduler answers here", address) from error
    run = uuid.uuid4().hex
    handed: dict[str, Numbered] = {}
    suspects: list[Numbered] = []
    # Report a scheduler that disconnects here; the library would not.
    logger = logging.getLogger("distributed.client")
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        with client:
            running: Any = distributed.as_completed(loop=client.loop)
            try:
                while True:
                    while len(handed) < AHEAD * max(1, sum(client.ncores().values())) and (task := next(tasks, None)):
                        key = f"bsm-{run}-{task[0]}"
                        handed[key] = task
                        running.add(client.submit(far_outcome, work, task[1], key=key))
                    if not handed:
                        break
                    future = next(running)
                    number, args = handed.pop(future.key)
                    if outcome := _of_cluster(future):
                        yield number, outcome
                    else:
                        suspects.append((number, args))
                for number, args in suspects:
                    keys = (f"bsm-{run}-{number}-{attempt}" for attempt in ("alone", "again"))
                    attempts = (_of_cluster(client.submit(far_outcome, work, args, key=key)) for key in keys)
                    died = MemoryError(f"{args.input}: its workers died repeatedly")
                    yield number, next(filter(None, attempts), Outcome({}, died))
            except distributed.CancelledError as error:
                raise OSError(errno.ECONNRESET, "the connection to the Dask scheduler was lost", address) from error
            finally:
                # If the caller stops listening, cancel the rest.
                client.cancel(list(running.futures))
    finally:
        logger.setLevel(level)


def _of_cluster(future: Any) -> Outcome | None:
    """Return the outcome of a job; None if several workers died that had it, or another job."""
    from distributed import KilledWorker

    try:
        outcome: Outcome = future.result()
    except KilledWorker:
        return None
    except Exception as error:
        # From a worker, or as the cause of the scheduler's error.
        missing = next((it for it in (error, error.__cause__) if isinstance(it, ImportError)), None)
        if missing is None:
            raise
        raise DependencyError(f"scheduler and workers need this package: pip install bsm-codec ({missing})") from error
    return outcome


def _task(work: Work, task: Task) -> Outcome:
    try:
        return far_outcome(work, task)
    except Terminated:  # unfinished files are removed; do not start another job
        os._exit(exit_of(Terminated()).code)
