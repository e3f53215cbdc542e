"""Many jobs: where they are done, what may be written over, and what is reported."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from functools import partial

from bsm.bitstream.errors import OptionError
from bsm.console import Console
from bsm.exits import exit_of, worded
from bsm.farm.jobs import Facts, Job, Outcome, Outcomes, Task, Tasks, Work, one_by_one
from bsm.farm.report import NOTHING, Earlier, Report, options_of, read_report, recorded
from bsm.files.output import refuse_to_overwrite
from bsm.files.remote import is_url, state_of_remote


def run_many(
    args: argparse.Namespace,
    console: Console,
    work: Work,
    jobs: Sequence[Job],
    hear: Callable[[Job, Outcome], None] = lambda job, outcome: None,
) -> list[Facts]:
    """Do all jobs; one that fails stops no other.

    Parameters
    ----------
    args : Namespace
        What all jobs have in common: `jobs`, `dask`, `report`, `resume`, and what `work` takes.
    hear : callable
        Is told what came of one job after the other, in their order.

    Returns
    -------
    list of dict
        What came of each, in their order; with "error" and "exit" where it failed.
    """
    if args.dask is not None:
        jobs = [_anywhere(job) for job in jobs]
    earlier, report = NOTHING, None
    if args.report is not None:
        refuse_to_overwrite(args.report, args.force or args.resume)
        command = work.__name__
        options = options_of(args)
        earlier = read_report(args.report, command, options) if args.resume else NOTHING
        report = Report(args.report, command, options, jobs, earlier.files)
        work = partial(recorded, work)
    elif args.resume:
        raise OptionError("--resume goes on from what --report FILE.json says: name it")
    done: list[Facts] = [{} for _ in jobs]
    ended: dict[int, Outcome] = {}
    told = 0
    tasks = _tasks(args, jobs, earlier)
    try:
        with console.progress("files", "files") as progress, closing(_outcomes(args, console, work, tasks)) as outcomes:
            for count, (number, outcome) in enumerate(outcomes, 1):
                done[number] = _facts(jobs[number], outcome)
                if report:
                    report.take(number, done[number])
                ended[number] = outcome
                while told in ended:
                    hear(jobs[told], ended.pop(told))
                    told += 1
                progress(count, len(jobs))
    finally:
        if report:
            report.write()
    return done


def task(args: argparse.Namespace, job: Job, earlier: Earlier = NOTHING) -> argparse.Namespace:
    """The arguments of one job: `input`, `output`, `before` (what came of it once) and `replaceable` (outputs that may
    be written over without being asked: what was not there when it began, or was to be made by an earlier run)."""
    before = earlier.files.get(job.output)
    replaceable = {job.output, *([before["output"]] if before else [])} - {"", "-"}
    mine = {name for name in replaceable if name in earlier.outputs or not _is_there(name)}
    more = {"input": job.input, "output": job.output, "before": before, "replaceable": mine}
    return argparse.Namespace(**{**vars(args), **more})


def may_replace(args: argparse.Namespace, path: str) -> bool:
    """Whether a job may write over a file."""
    return args.force or path in args.replaceable


def _tasks(args: argparse.Namespace, jobs: Sequence[Job], earlier: Earlier) -> Iterator[Task]:
    for number, job in enumerate(jobs):
        yield number, task(args, job, earlier)


def _outcomes(args: argparse.Namespace, console: Console, work: Work, tasks: Tasks) -> Outcomes:
    """Where jobs are done."""
    if args.dask is not None:
        from bsm.farm.cluster import on_cluster

        return on_cluster(work, tasks, args.dask)
    if args.jobs < 0:
        raise OptionError(f"-j {args.jobs}: at least one input at a time, or 0")
    processes = args.jobs or _cores()
    if processes == 1:
        return one_by_one(work, tasks, console)
    # Where there is one process there is no need to load this.
    from bsm.farm.processes import in_processes

    return in_processes(work, tasks, processes)


def _facts(job: Job, outcome: Outcome) -> Facts:
    if outcome.error is None:
        return outcome.facts
    code = exit_of(outcome.error).code
    return {"input": job.input, "output": job.output, "error": worded(outcome.error), "exit": code}


def _anywhere(job: Job) -> Job:
    """A job by names that mean the same in every folder.

    Raises
    ------
    OptionError
        If one is a pipe.
    """
    if "-" in (job.input, job.output):
        raise OptionError("a pipe does not reach a cluster: name files")
    return Job(anywhere(job.input), anywhere(job.output))


def anywhere(name: str) -> str:
    """A name that means the same in every folder of a machine, and on every machine that has the same folders."""
    return name if not name or is_url(name) else os.path.abspath(name)


def _is_there(path: str) -> bool:
    if is_url(path):
        return state_of_remote(path) is not None
    return os.path.lexists(path)


def _cores() -> int:
    from bsm.codec.threads import available_threads

    return available_threads()
