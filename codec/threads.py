"""Running independent pieces of work on threads, results in order; and numpy's linear algebra on one thread."""

from __future__ import annotations

import ctypes
import os
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from bsm.bitstream.once import cached_property
from bsm.codec.choices import checked_whole

if TYPE_CHECKING:
    from concurrent.futures import Future, ThreadPoolExecutor

Item = TypeVar("Item")
Result = TypeVar("Result")


def available_threads() -> int:
    # Containers and batch systems grant fewer cores than there are.
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def threads_of(wanted: int | None) -> int:
    """How many threads are asked for; None: one per core."""
    return available_threads() if wanted is None else checked_whole("threads", wanted, 1)


def ordered_map(
    work: Callable[[Item], Result], items: Iterable[Item], threads: int | None
) -> Iterator[Result]:
    """`map(work, items)` on `threads` threads (None: one per core)."""
    count, rest = threads_of(threads), iter(items)
    # A thread for a single item would only add its start.
    first = list(islice(rest, 2))
    items = chain(first, rest)
    if count == 1 or len(first) < 2:
        yield from map(work, items)
        return
    from concurrent.futures import ThreadPoolExecutor

    pool = ThreadPoolExecutor(count)
    pending: deque[Future[Result]] = deque()
    try:
        for item in items:
            pending.append(pool.submit(work, item))
            # Results wait for those before them. Without a bound, a slow first item would pile up all others in memory.
            if len(pending) > 2 * count:
                yield pending.popleft().result()
        while pending:
            yield pending.popleft().result()
    finally:
        # Also when the caller stops taking results: unwanted work must end.
        pool.shutdown(cancel_futures=True)


class _Blas:
    """The number of threads of OpenBLAS, which numpy's wheels bring."""

    def __init__(self, library: Any, read: str, write: str) -> None:
        self._read, self._write = getattr(library, read), getattr(library, write)
        self._lock, self._users, self._before = threading.Lock(), 0, 1

    def enter(self) -> None:
        """Take one thread; the number is common to the process, so the first of several users keeps it."""
        with self._lock:
            if not self._users:
                self._before = self._read()
                self._write(1)
            self._users += 1

    def leave(self) -> None:
        """Give the threads back, as the last of several users."""
        with self._lock:
            self._users -= 1
            if not self._users:
                self._write(self._before)


@lru_cache(1)
def _blas() -> _Blas | None:
    """Find numpy's OpenBLAS; None: numpy has another library."""
    package = Path(np.__file__).parent
    for path in [
        *package.parent.glob("numpy.libs/*openblas*"),
        *package.glob(".dylibs/*openblas*"),
    ]:
        with suppress(OSError):
            library = ctypes.CDLL(str(path))  # which is loaded already
            for prefix in ("scipy_openblas", "openblas"):
                for suffix in ("64_", ""):
                    names = [f"{prefix}_{action}_num_threads{suffix}" for action in ("get", "set")]
                    if all(hasattr(library, name) for name in names):
                        return _Blas(library, *names)
    return None


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Compute with matrices on the caller's thread.

    Those of an encoder are small. The threads of OpenBLAS wait for each other by spinning, which took two thirds of the
    processor time of sequences, and ignores the number of threads that a caller asks for.
    """
    blas = _blas()
    if blas is None:
        yield
        return
    blas.enter()
    try:
        yield
    finally:
        blas.leave()


class Crew:
    """The caller's thread and others, which wait for short pieces of work until the crew is forgotten."""

    def __init__(self, threads: int | None) -> None:
        self._helpers = threads_of(threads) - 1

    def map(self, work: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
        """`list(map(work, items))`."""
        given, results = list(items), dict[int, Result]()
        # One iterator for all threads: a free one takes the next item. `next` of a range is atomic under the
        # interpreter's lock.
        rest = iter(range(len(given)))

        def help_out() -> None:
            for at in rest:
                results[at] = work(given[at])

        helping: list[Future[None]] = []
        try:
            # The caller's thread works, too, so that a crew of one starts no thread at all.
            helping.extend(
                self._pool.submit(help_out) for _ in range(min(self._helpers, len(given) - 1))
            )
            help_out()
        # A thread whose start it interrupts would wait for work when the program ends.
        except KeyboardInterrupt:
            if pool := self.__dict__.pop("_pool", None):
                pool.shutdown(wait=False)
            raise
        finally:
            deque(rest, 0)  # after an error, nothing else begins
            for helper in helping:
                # A helper that has not begun is cancelled; one that has is waited for, and its error raised.
                if not helper.cancel():
                    helper.result()
        return [results[at] for at in range(len(given))]

    @cached_property
    def _pool(self) -> ThreadPoolExecutor:
        # Loading this takes longer than decoding a small mesh.
        from concurrent.futures import ThreadPoolExecutor

        return ThreadPoolExecutor(self._helpers)
