"""Jobs on a Dask cluster, whose workers may die."""

from __future__ import annotations

import errno
import logging
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from bsm.bitstream.errors import DependencyError
from bsm.bitstream.extras import how_to_install
from bsm.farm.jobs import Numbered, Outcome, Outcomes, Tasks, Work, far_outcome

AHEAD = 2
"""Jobs handed out for each thread of the cluster."""


def on_cluster(work: Work, tasks: Tasks, address: str) -> Outcomes:
    """Do jobs on the workers of a cluster; those of a worker that dies are taken up by others."""
    try:
        import distributed
    except ImportError as error:
        raise DependencyError(f"a cluster needs Dask: {how_to_install('dask')}") from error
    try:
        client: Any = distributed.Client(address, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise OSError(errno.EHOSTUNREACH, "no Dask scheduler answers here", address) from error
    waiting, run = iter(tasks), uuid.uuid4().hex
    handed: dict[str, Numbered] = {}
    suspects: list[Numbered] = []
    with _silence("distributed.client"), client:
        running: Any = distributed.as_completed(loop=client.loop)  # type: ignore[no-untyped-call]
        try:
            while True:
                while len(handed) < AHEAD * max(1, sum(client.ncores().values())) and (task := next(waiting, None)):
                    key = f"bsm-{run}-{task[0]}"
                    handed[key] = task
                    running.add(client.submit(far_outcome, work, task[1], key=key))
                if not handed:
                    break
                future = next(running)
                number, args = handed.pop(future.key)
                outcome = _outcome(future)
                if outcome is None:
                    suspects.append((number, args))
                else:
                    yield number, outcome
            for number, args in suspects:
                for attempt in ("alone", "again"):
                    outcome = _outcome(client.submit(far_outcome, work, args, key=f"bsm-{run}-{number}-{attempt}"))
                    if outcome:
                        break
                yield number, outcome or Outcome({}, MemoryError(f"{args.input}: its workers died, again and again"))
        except distributed.CancelledError as error:
            raise OSError(errno.ECONNRESET, "the Dask scheduler went away", address) from error
        finally:
            # Whoever stops listening wants no more work done.
            client.cancel(list(running.futures))


@contextmanager
def _silence(name: str) -> Iterator[None]:
    """Let a library not log what is told here."""
    logger = logging.getLogger(name)
    before = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        logger.setLevel(before)


def _outcome(future: Any) -> Outcome | None:
    """What came of a job; None: several workers died that had it, or another one."""
    from distributed import KilledWorker

    try:
        outcome: Outcome = future.result()
    except KilledWorker:
        return None
    except Exception as error:
        # From a worker, or as the cause of what the scheduler says.
        missing = next((it for it in (error, error.__cause__) if isinstance(it, ImportError)), None)
        if missing is None:
            raise
        raise DependencyError(f"scheduler and workers need this package: pip install bsm-codec ({missing})") from error
    return outcome
