"""Running independent pieces of work on threads, results in order."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
from threading import Lock
from typing import Any, Generic, TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def available_threads() -> int:
    """Cores this process may run on."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def _controller() -> Any:
    # Not needed by streams whose dictionaries are made by orthogonal iterations, so not imported before it is.
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


def _take_control() -> None:
    """Let this thread set the limit: threadpoolctl lets only one do so, and for the others silently does nothing."""
    from threadpoolctl import OpenBLASController

    OpenBLASController.clear_controlling_thread(force=True)


class _SingleBlasThread:
    """Limits BLAS to one thread while anybody is inside; entering is counted, since the limit is the process's."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._inside = 0
        self._limiter: Any = None

    def __enter__(self) -> None:
        with self._lock:
            self._inside += 1
            if self._inside == 1:
                _take_control()
                self._limiter = _controller().limit(limits=1)

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._inside -= 1
            if self._inside == 0:
                _take_control()
                self._limiter.restore_original_limits()


SINGLE_BLAS_THREAD = _SingleBlasThread()
"""Enter it around calls of BLAS and LAPACK: blocks are too small to share among BLAS threads."""


def ordered_map(work: Callable[[Item], Result], items: Iterable[Item], threads: int | None) -> Iterator[Result]:
    """`map(work, items)` on `threads` threads (None: one per core), each piece of work with one BLAS thread.

    Works a few items ahead of the consumer, so that results do not pile up.
    """
    count = threads or available_threads()

    def limited(item: Item) -> Result:
        with SINGLE_BLAS_THREAD:
            return work(item)

    if count == 1:
        yield from map(limited, items)
        return
    pool = ThreadPoolExecutor(count)
    pending: deque[Future[Result]] = deque()
    try:
        for item in items:
            pending.append(pool.submit(limited, item))
            if len(pending) > 2 * count:
                yield pending.popleft().result()
        while pending:
            yield pending.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)


class Pending(Generic[Result]):
    """A result that may still be on its way."""

    def __init__(self, work: Callable[[], Result]) -> None:
        self._work: Callable[[], Result] | None = work
        self._future: Future[Result] = Future()

    def run(self) -> None:
        """Do the work."""
        assert self._work is not None
        try:
            self._future.set_result(self._work())
        except BaseException as error:
            self._future.set_exception(error)
        self._work = None

    def result(self) -> Result:
        """The result, or the error, once it is there."""
        return self._future.result()


class Lanes:
    """Work in lanes: what is submitted to one lane runs in order, different lanes run side by side."""

    def __init__(self, threads: int | None) -> None:
        self._count = threads or available_threads()
        self._pool: ThreadPoolExecutor | None = None
        self._lock = Lock()
        self._waiting: dict[int, deque[Pending[Any]]] = {}

    def submit(self, lane: int, work: Callable[[], Result]) -> Pending[Result]:
        """Queue `work` behind everything submitted to the same lane."""
        pending = Pending(work)
        if self._count == 1:
            pending.run()
            return pending
        with self._lock:
            if lane in self._waiting:
                self._waiting[lane].append(pending)
                return pending
            self._waiting[lane] = deque([pending])
        if self._pool is None:
            self._pool = ThreadPoolExecutor(self._count)
        self._pool.submit(self._drain, lane)
        return pending

    def close(self) -> None:
        """Give up what has not started, wait for what has."""
        with self._lock:
            for waiting in self._waiting.values():
                waiting.clear()
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)

    def _drain(self, lane: int) -> None:
        while True:
            with self._lock:
                waiting = self._waiting[lane]
                if not waiting:
                    del self._waiting[lane]
                    return
                pending = waiting.popleft()
            pending.run()
