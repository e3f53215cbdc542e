"""Running independent pieces of work on threads, results in order."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, islice
from typing import TYPE_CHECKING, TypeVar

from bsm.bitstream.once import cached_property
from bsm.codec.choices import checked_whole

if TYPE_CHECKING:
    from concurrent.futures import Future, ThreadPoolExecutor

Item = TypeVar("Item")
Result = TypeVar("Result")


def available_threads() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def threads_of(wanted: int | None) -> int:
    """How many threads are asked for; None: one per core."""
    return available_threads() if wanted is None else checked_whole("threads", wanted, 1)


def ordered_map(work: Callable[[Item], Result], items: Iterable[Item], threads: int | None) -> Iterator[Result]:
    """`map(work, items)` on `threads` threads (None: one per core)."""
    count, rest = threads_of(threads), iter(items)
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
            if len(pending) > 2 * count:
                yield pending.popleft().result()
        while pending:
            yield pending.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)


class Crew:
    """The caller's thread and others, which wait for short pieces of work until the crew is forgotten."""

    def __init__(self, threads: int | None) -> None:
        self._helpers = threads_of(threads) - 1

    def map(self, work: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
        """`list(map(work, items))`."""
        given, results = list(items), dict[int, Result]()
        rest = iter(range(len(given)))

        def help_out() -> None:
            for at in rest:
                results[at] = work(given[at])

        helping: list[Future[None]] = []
        try:
            helping.extend(self._pool.submit(help_out) for _ in range(min(self._helpers, len(given) - 1)))
            help_out()
        except KeyboardInterrupt:  # a thread whose start it interrupts would wait for work when the program ends
            if pool := self.__dict__.pop("_pool", None):
                pool.shutdown(wait=False)
            raise
        finally:
            deque(rest, 0)  # after an error, nothing else begins
            for helper in helping:
                if not helper.cancel():
                    helper.result()
        return [results[at] for at in range(len(given))]

    @cached_property
    def _pool(self) -> ThreadPoolExecutor:
        from concurrent.futures import ThreadPoolExecutor

        return ThreadPoolExecutor(self._helpers)
