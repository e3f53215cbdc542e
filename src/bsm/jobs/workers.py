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
import warnings
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from typing import Any

from bsm.bitstream.errors import DependencyError, imported
from bsm.files.output import handled, termination_as_exception
from bsm.ground.console import Console
from bsm.ground.exits import Terminated, exit_of
from bsm.jobs.task import Outcome, Outcomes, Task, Tasks, Work, outcome_of

# One more than each process needs, so that it never waits for this one; no more, since tasks are made when needed.
AHEAD = 2  # jobs handed out for each process, and for each thread of a cluster
# Long enough to remove unfinished files, and short enough for someone who waits for the prompt.
# Seconds that a process has to clear away, once its parent is gone, and once it was asked to end.
GRACE = 3.0
# Seconds from one look at a cluster to the next, and until a wait for workers is reported.
_OFTEN, _SILENT = 1.0, 5.0

Handed = dict[int, Task]
Count = Callable[[], int]
# With its number of processes, at times, and the error if one dies.
Pool = tuple[Executor, Count, type[Exception]]
Pools = Callable[[], AbstractContextManager[Pool]]


def in_processes(work: Work, tasks: Tasks, processes: int) -> Outcomes:
    with termination_as_exception():
        yield from _outlived(work, tasks, partial(_processes, processes))


def on_cluster(
    work: Work, tasks: Tasks, address: str, patience: float, console: Console
) -> Outcomes:
    """Do jobs on the workers of a cluster; other workers repeat the jobs of a worker that dies.

    An `OSError` is raised if it has had no worker for `patience` seconds.
    """
    try:
        yield from _outlived(work, tasks, partial(_workers, address, patience, console))
    except CancelledError as error:
        raise OSError(
            errno.ECONNRESET, "the connection to the Dask scheduler was lost", address
        ) from error


def _outlived(work: Work, tasks: Tasks, pools: Pools) -> Outcomes:
    """Do jobs; repeat those that have not ended, each of them alone."""
    # One of the jobs that were running has killed its process, by its memory perhaps. Repeated one by one, only that
    # one dies again, and the others get their results.
    while suspects := (yield from _until_one_dies(work, tasks, pools)):
        for number, task in suspects.items():
            if (yield from _until_one_dies(work, iter([(number, task.repeated())]), pools)):
                # A process dies without a word. Memory is by far the most common cause, so the message names it.
                yield number, Outcome({}, MemoryError(f"{task.input}: its process died twice"))


def _until_one_dies(
    work: Work, tasks: Tasks, pools: Pools
) -> Generator[tuple[int, Outcome], None, Handed]:
    """Do jobs until all are done or a process dies; return the submitted jobs that have not ended."""
    handed: Handed = {}
    futures: dict[Future[Outcome], int] = {}
    whole = True
    with pools() as (pool, processes, died):
        while True:
            most = AHEAD * processes()
            try:
                while whole and len(futures) < most and (given := next(tasks, None)):
                    number, task = given
                    handed[number] = task
                    # Ctrl-C goes to all processes of a terminal. Those that start here ignore it, and this one ends
                    # them in order.
                    with handled((signal.SIGINT,), signal.SIG_IGN):  # by processes that start here
                        futures[pool.submit(_task, work, task)] = number
            # The pool of the standard library refuses everything after one process has died, even jobs that others
            # could do.
            except BrokenProcessPool:
                whole = False
            if not futures:
                return handed
            # With a time limit, since a cluster may get or lose workers while nothing ends.
            for future in wait(futures, _OFTEN, FIRST_COMPLETED).done:
                number = futures.pop(future)
                if isinstance(error := future.exception(), died):
                    whole = False
                    continue
                # A worker without this package fails by an ImportError deep inside of a library. The user needs to know
                # where to install it.
                if missing := [
                    it for it in (error, error and error.__cause__) if isinstance(it, ImportError)
                ]:
                    needed = f"scheduler and workers need this package: pip install bsm-codec ({missing[0]})"
                    raise DependencyError(needed) from error
                del handed[number]
                yield number, future.result()


@contextmanager
def _processes(count: int) -> Iterator[Pool]:
    # Not forked: threads of this process may hold locks.
    pool = ProcessPoolExecutor(
        count, multiprocessing.get_context("spawn"), initializer=_end_with_parent
    )
    try:
        yield pool, lambda: count, BrokenProcessPool
    except BaseException:
        # The list is private, but shutdown() would wait for jobs that run, for minutes perhaps. Without waiting for it,
        # a thread of the pool may close while the interpreter ends, which prints a traceback.
        for process in list((pool._processes or {}).values()):
            process.terminate()
        pool.shutdown(cancel_futures=True)
        raise
    pool.shutdown()


@contextmanager
def _workers(address: str, patience: float, console: Console) -> Iterator[Pool]:
    distributed = imported("distributed", "a cluster needs Dask", "dask")
    try:
        client: Any = distributed.Client(address, set_as_default=False)
    except (OSError, ValueError) as error:
        raise OSError(errno.EHOSTUNREACH, "no Dask scheduler answers here", address) from error
    # Report a scheduler that disconnects here; the library would not.
    logger = logging.getLogger("distributed.client")
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        with client:
            yield (
                client.get_executor(pure=False),
                _cores(client, address, patience, console),
                distributed.KilledWorker,
            )
    finally:
        logger.setLevel(level)


def _cores(client: Any, address: str, patience: float, console: Console) -> Count:
    """Count the cores of the workers of a cluster; without workers 1, for some seconds, and then an error."""
    last, told = time.monotonic(), False

    def count() -> int:
        nonlocal last, told
        if cores := sum(client.ncores().values()):
            last, told = time.monotonic(), False
        waited = time.monotonic() - last
        if waited > patience:
            raise OSError(
                errno.ETIMEDOUT,
                f"this Dask scheduler has had no worker for {patience:g} s",
                address,
            )
        if waited > _SILENT and not told:
            told = True
            console.note(
                f"waiting for a worker of the Dask scheduler at {address}, {patience:g} s at most (--dask-wait)"
            )
        return cores or 1

    return count


def _end_with_parent() -> None:
    """End this process with its parent, however that ends; print no warnings."""
    if not sys.warnoptions:
        warnings.simplefilter("ignore")
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    # A parent that is killed cannot end its children, so they watch it. Its handle tells the system's own view of it.
    sentinel = parent.sentinel

    def watch() -> None:
        multiprocessing.connection.wait([sentinel])
        # The parent may have asked this process to end; it is then removing its unfinished files.
        time.sleep(GRACE)
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(GRACE)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _task(work: Work, task: Task) -> Outcome:
    try:
        return outcome_of(work, task, Console(task.quiet, kept=[]))
    except Terminated:  # unfinished files are removed; do not start another job
        # Not sys.exit, which the pool would catch as the error of a job, and go on.
        os._exit(exit_of(Terminated()).code)
