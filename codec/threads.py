"""Running independent pieces of work on threads, results in order."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, islice
from numbers import Integral
from typing import TYPE_CHECKING, TypeVar

from bsm.bitstream.errors import ArgumentError, OptionError

if TYPE_CHECKING:
    from concurrent.futures import Future, ThreadPoolExecutor

Item = TypeVar("Item")
Result = TypeVar("Result")


def available_threads() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def threads_of(wanted: int | None) -> int:
    """How many threads are asked for; None: one per core."""
    if wanted is None:
        return available_threads()
    if isinstance(wanted, bool) or not isinstance(wanted, Integral):
        raise ArgumentError(f"threads must be a whole number or None, not {wanted!r}")
    if wanted < 1:
        raise OptionError(f"threads must be 1 or above, or None for one per core, not {wanted}")
    return int(wanted)


def ordered_map(work: Callable[[Item], Result], items: Iterable[Item], threads: int | None) -> Iterator[Result]:
    """`map(work, items)` on `threads` threads (None: one per core)."""
    count, rest = threads_of(threads), iter(items)
    first = list(islice(rest, 2))
    items = chain(first, rest)
    if count == 1 or len(first) < 2:
        yield from map(work, items)
        return
    pool = pool_of(count)
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


def pool_of(threads: int) -> ThreadPoolExecutor:
    """A pool of threads; who has one thread alone loads nothing for it."""
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(threads)
