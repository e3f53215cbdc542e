"""Many jobs: where they are done, what may be written over, and what is reported."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from functools import partial

from bsm.bitstream.errors import OptionError
from bsm.console import Console
from bsm.exits import exit_of, worded
from bsm.farm.jobs import Facts, Job, Numbered, Outcome, Outcomes, Run, Task, Tasks, Work, one_by_one
from bsm.farm.report import NOTHING, Earlier, Report, digest_of, options_of, read_report, recorded
from bsm.files.output import refuse_to_overwrite
from bsm.files.remote import is_url, state_of_remote


def run_many(
    run: Run,
    asked: Task,
    console: Console,
    work: Work,
    jobs: Sequence[Job],
    hear: Callable[[Job, Outcome], None] = lambda job, outcome: None,
) -> list[Facts]:
    """Do all jobs; one that fails stops no other."""
    if run.dask is not None:
        jobs = [_anywhere(job) for job in jobs]
    earlier, report = NOTHING, None
    if run.report is not None:
        refuse_to_overwrite(run.report, asked.force or run.resume)
        command = work.__name__
        options = options_of(asked)
        earlier = read_report(run.report, command, options) if run.resume else NOTHING
        report = Report(run.report, command, options, jobs, earlier.files)
        work = partial(recorded, work)
    elif run.resume:
        raise OptionError("--resume goes on from what --report FILE.json says: name it")
    done: list[Facts] = [{} for _ in jobs]
    ended: dict[int, Outcome] = {}
    told = 0
    tasks = _tasks(asked, jobs, earlier, repeats=run.dask is not None)
    try:
        with console.progress("files", "files") as progress, closing(_outcomes(run, console, work, tasks)) as outcomes:
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


def task_of(asked: Task, job: Job, earlier: Earlier = NOTHING) -> Task:
    """What is asked, for one job."""
    before = earlier.files.get(job.output)
    replaceable = {job.output, *([before["output"]] if before else [])} - {"", "-"}
    there = {name for name in replaceable if _is_there(name)}
    named = replaceable & earlier.outputs.keys()
    mine = frozenset(name for name in named if name not in there or earlier.outputs[name] == digest_of(name))
    return replace(
        asked,
        input=job.input,
        output=job.output,
        before=before,
        replaceable=mine,
        doubtful=frozenset() if asked.force else frozenset(named - mine),
        fresh=frozenset(replaceable - named - there),
    )


def _tasks(asked: Task, jobs: Sequence[Job], earlier: Earlier, *, repeats: bool) -> Iterator[Numbered]:
    for number, job in enumerate(jobs):
        task = task_of(asked, job, earlier)
        # A cluster may do a job once more whose worker died, and does not say so.
        yield number, task.repeated() if repeats else task


def _outcomes(run: Run, console: Console, work: Work, tasks: Tasks) -> Outcomes:
    """Where jobs are done."""
    if run.dask is not None:
        from bsm.farm.cluster import on_cluster

        return on_cluster(work, tasks, run.dask)
    if run.jobs < 0:
        raise OptionError(f"-j {run.jobs}: at least one input at a time, or 0")
    processes = run.jobs or _cores()
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
