"""Runs a stage: a JSON file for each of its jobs, so that a run that was cut goes on, with where and when it ran."""

import datetime
import json
import os
import platform
import subprocess
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Protocol

from threadpoolctl import threadpool_info

from tools.replicate.rates import Row

ROOT = Path(__file__).parents[2]
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


class Job(Protocol):
    """What has a name, by which its file is called."""

    @property
    def name(self) -> str: ...


@contextmanager
def one_thread() -> Iterator[None]:
    """Have processes that start meanwhile load libraries that use one thread each: later is too late."""
    before = dict(os.environ)
    os.environ.update(ONE_THREAD)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


def git(*words: str) -> str:
    """What git says of this checkout; nothing where it fails."""
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True).stdout.strip()


def described(work: Callable[..., Any], *given: Any) -> list[Row]:
    """Rows of one job, each with its `run`: commit, processor, date, seconds, and the threads of libraries."""
    begin, commit = (
        time.monotonic(),
        git("describe", "--always", "--dirty=-changed", "--exclude=*", "--abbrev=8"),
    )
    found = work(*given)
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    name = next(
        (line.split(":")[1].strip() for line in lines if line.startswith("model name")),
        platform.processor(),
    )
    run = {
        "commit": commit,
        "processor": f"{name}, {len(os.sched_getaffinity(0))} cores",
        "date": datetime.date.today().isoformat(),
        "seconds": round(time.monotonic() - begin, 1),
        "threads": max((library["num_threads"] for library in threadpool_info()), default=1),
    }
    return [row | {"run": run} for row in (found if isinstance(found, list) else [found])]


def run_stage(
    work: Callable[..., Row | list[Row]],
    sources: Iterable[Job],
    folder: Path,
    minutes: float,
    note: Callable[[str], None],
    *more: Any,
    workers: int = 2,
) -> list[list[Row]]:
    """Rows of the jobs that fit into the time, in their order; what is left out is named."""
    folder.mkdir(parents=True, exist_ok=True)
    deadline, found, sources = time.monotonic() + 60 * minutes, {}, list(sources)
    left = []
    for source in sources:
        path = folder / f"{source.name}.json"
        if path.exists():
            found[source.name] = json.loads(path.read_text())
    with one_thread(), ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        waiting: dict[Future[list[Row]], Job] = {}
        todo = iter([source for source in sources if source.name not in found])
        while True:
            while len(waiting) < workers and (job := next(todo, None)) is not None:
                if time.monotonic() > deadline:
                    left.append(job.name)
                else:
                    waiting[pool.submit(described, work, job, *more)] = job
            if not waiting:
                break
            done = next(as_completed(waiting))
            source = waiting.pop(done)
            try:
                found[source.name] = done.result()
            except Exception as error:  # one mesh must not end an hour's run
                note(f"{folder.name}: {source.name} failed: {type(error).__name__}: {error}")
                continue
            part = folder / f"{source.name}.part"
            part.write_text(json.dumps(found[source.name]))
            # Whole, or not there, wherever a run is cut.
            part.replace(folder / f"{source.name}.json")
            note(f"{folder.name}: {source.name}, {len(found)} of {len(sources)}")
    if left:
        note(f"{folder.name}: no time was left for {len(left)}: {', '.join(left)}")
    return [found[source.name] for source in sources if source.name in found]
