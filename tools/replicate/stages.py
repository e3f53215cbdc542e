"""Runs a stage: a JSON file for each of its meshes, so that a run that was cut goes on."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any, Protocol, TypeVar

Result = TypeVar("Result")


class Job(Protocol):
    """What has a name, by which its file is called."""

    @property
    def name(self) -> str: ...


def run_stage(
    work: Callable[..., Result],
    sources: Iterable[Job],
    folder: Path,
    minutes: float,
    note: Callable[[str], None],
    *more: Any,
    workers: int = 2,
) -> list[Result]:
    """Rows of the meshes that fit into the time, in their order; what is left out is named."""
    folder.mkdir(parents=True, exist_ok=True)
    deadline, found, sources = time.monotonic() + 60 * minutes, {}, list(sources)
    left = []
    for source in sources:
        path = folder / f"{source.name}.json"
        if path.exists():
            found[source.name] = json.loads(path.read_text())
    with ProcessPoolExecutor(workers) as pool:
        waiting: dict[Future[Result], Job] = {}
        todo = iter([source for source in sources if source.name not in found])
        while True:
            while len(waiting) < workers and (job := next(todo, None)) is not None:
                if time.monotonic() > deadline:
                    left.append(job.name)
                else:
                    waiting[pool.submit(work, job, *more)] = job
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
            part.replace(folder / f"{source.name}.json")  # whole, or not there, wherever a run is cut
            note(f"{folder.name}: {source.name}, {len(found)} of {len(sources)}")
    if left:
        note(f"{folder.name}: no time was left for {len(left)}: {', '.join(left)}")
    return [found[source.name] for source in sources if source.name in found]
