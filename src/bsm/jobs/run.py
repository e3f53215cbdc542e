"""Run many jobs, here, in processes or on a cluster, and report their results."""

import os
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from graphlib import TopologicalSorter
from heapq import heappop, heappush
from typing import TYPE_CHECKING

from bsm.bitstream.errors import OptionError, counted
from bsm.codec.threads import available_threads
from bsm.files import pipes
from bsm.files.output import refuse_collisions, refuse_to_overwrite
from bsm.ground.console import Console, Progress, print_json
from bsm.ground.exits import exit_of, report_error, worded
from bsm.ground.lengths import UnitError
from bsm.jobs.task import (
    Facts,
    Job,
    Outcome,
    Outcomes,
    Task,
    Tasks,
    Work,
    anywhere,
    came_to,
    outcome_of,
)

if TYPE_CHECKING:
    from bsm.jobs.report import Earlier, Report

# A batch of small files takes as long as its number, and not as its bytes.
LEAST = 1 << 16  # bytes that an input counts as, for the work that does not depend on its size
Show = Callable[[Facts], str]  # the result for an input, as it is printed
Ended = Callable[[Job, Outcome], None]


@dataclass(frozen=True, kw_only=True)
class Batch:
    """Number of jobs at a time, cluster, and report of a run."""

    jobs: int = 1
    dask: str | None = None
    dask_wait: float = 60.0
    report: str | None = None
    resume: bool = False

    @property
    def side_by_side(self) -> bool:
        return self.jobs != 1 or self.dask is not None


def run_jobs(
    run: Batch,
    asked: Task,
    console: Console,
    work: Work,
    jobs: Sequence[Job],
    show: Show | None = None,
) -> int:
    """Do all jobs of a command and print their results; return the exit code."""
    # A single job needs neither processes nor a table. Its errors are raised as they are, and end the command.
    if len(jobs) == 1 and run.dask is None and run.report is None and not run.resume:
        with pipes.about(jobs[0].input), console.progress():
            facts = work(task_of(asked, jobs[0]), console)
        if console.json:
            print_json(facts)
        elif show:
            print(show(facts))
        return 0
    from bsm.jobs.report import table, totals  # which a single job need not load

    begin, asked_once = time.perf_counter(), 0

    def ended(job: Job, outcome: Outcome) -> None:
        nonlocal asked_once
        for line in outcome.notes:
            console.note(line)
        asked_once += isinstance(outcome.error, UnitError)
        # A folder of a thousand meshes without a unit would ask the same question a thousand times.
        if isinstance(outcome.error, UnitError) and asked_once > 1:
            return  # the same question for each file
        if outcome.error is not None:
            report_error(outcome.error, as_json=console.json, options=console.options)
        elif show and not console.json:
            print(f"{job.input}:\n{show(outcome.facts)}\n", flush=True)

    done = run_many(run, asked, console, work, jobs, ended)
    good = [facts for facts in done if "error" not in facts]
    summed = totals(good)
    taken, given = summed["input_bytes"], summed["output_bytes"]
    sizes = ""
    if taken and given:
        sizes += f", {came_to(taken, given)}"
    if summed["largest_error"]:
        sizes += f", largest error {summed['largest_error']}"
    if asked_once > 1:
        console.note(f"{asked_once} files in all have no unit")
    if run.report is not None:
        for line in table(done):
            console.note(line)
    console.note(
        f"{len(good)} of {counted(files=len(done))}{sizes}, {time.perf_counter() - begin:.2f} s"
    )
    if console.json:
        print_json({"files": done})
    # One code for the whole run. That of the first failure is the same each time, in whatever order jobs end.
    return next((facts["exit"] for facts in done if "error" in facts), 0)


def run_many(
    run: Batch,
    asked: Task,
    console: Console,
    work: Work,
    jobs: Sequence[Job],
    ended: Ended = lambda job, outcome: None,
) -> list[Facts]:
    """Do all jobs, and report them in order. A failed job stops only the jobs that need it."""
    if run.dask is not None:
        jobs = _on_all_machines(jobs)
    work, earlier, report = _reported(run, asked, work, jobs)
    done: list[Facts] = [{} for _ in jobs]
    # Work is reported in proportion to these.
    sizes, finished = [_size_of_input(job) for job in jobs], 0
    # The library's sorter gives out jobs as soon as those before them have ended, in any order.
    order = TopologicalSorter({number: job.after for number, job in enumerate(jobs)})
    order.prepare()

    def task(number: int) -> Task:
        found = task_of(asked, jobs[number], earlier)
        # A cluster repeats jobs of workers that died.
        if run.dask is not None:
            found = found.repeated()
        return found

    def taken(outcomes: Outcomes, progress: Progress) -> Outcomes:
        nonlocal finished
        for number, outcome in outcomes:
            done[number] = _facts_of(jobs[number], outcome)
            finished += sizes[number]
            progress(finished, sum(sizes))
            # A failed job is never done, so the jobs that need it never start. The others do not notice.
            if outcome.error is None:
                order.done(number)
            if report:
                report.take(number, done[number])
            yield number, outcome

    tasks = _tasks(order, task)
    try:
        # Closed however the loop ends, since processes would otherwise go on working.
        with (
            console.progress() as progress,
            closing(_outcomes(run, console, work, tasks, sizes)) as outcomes,
        ):
            for number, outcome in _in_order(taken(outcomes, progress)):
                ended(jobs[number], outcome)
    # An interrupted run has a report as well, from which --resume goes on.
    finally:
        if report:
            report.write()
    if run.resume:
        console.note(f"{sum('resumed' in facts for facts in done)} of {len(jobs)} were up to date")
    return done


def _on_all_machines(jobs: Sequence[Job]) -> list[Job]:
    """Return jobs by paths that are valid in all processes of a cluster."""
    # A pipe belongs to one process on one machine.
    if any("-" in (job.input, job.output) for job in jobs):
        raise OptionError("a cluster cannot read a pipe; name files")
    return [replace(job, input=anywhere(job.input), output=anywhere(job.output)) for job in jobs]


def _tasks(order: TopologicalSorter[int], task: Callable[[int], Task]) -> Tasks:
    """Yield the tasks of jobs that wait for no other, by their numbers; None where all that are left wait."""
    ready: list[int] = []
    while True:
        for number in order.get_ready():
            # The sorter gives ready jobs in any order. By their numbers, they start in the order that the user gave.
            heappush(ready, number)
        if ready:
            number = heappop(ready)
            yield number, task(number)
        else:
            yield None


def _size_of_input(job: Job) -> int:
    """Return the bytes of an input, as far as a bar needs them: those of a remote file would cost a request."""
    if job.input == "-" or pipes.is_url(job.input):
        return LEAST
    return max(pipes.size_of(job.input) or 0, LEAST)


def _reported(
    run: Batch, asked: Task, work: Work, jobs: Sequence[Job]
) -> "tuple[Work, Earlier | None, Report | None]":
    """Return work that is reported, what an earlier report holds, and the new one, if a report is wanted."""
    if run.report is None:
        if run.resume:
            raise OptionError("--resume needs --report FILE.json")
        return work, None, None
    from bsm.account.overview import load_mesh, load_stream, report_kind
    from bsm.jobs.report import NOTHING, Report, options_of, read_report, recorded

    # A report with the name of an input would replace it.
    refuse_collisions([job.input for job in jobs], [*(job.output for job in jobs), run.report])
    if report_kind(run.report) != "json" and run.resume:
        raise OptionError(f"--resume reads a report in JSON; name it .json, not {run.report}")
    refuse_to_overwrite(run.report, asked.force or run.resume)
    command, options = work.__name__, options_of(asked)
    earlier, load = NOTHING, load_mesh
    if run.resume:
        earlier = read_report(run.report, command, options)
    if getattr(asked, "untrusted", False):
        load = load_stream
    report = Report(run.report, command, options, jobs, earlier.files, load)
    return partial(recorded, work), earlier, report


def _facts_of(job: Job, outcome: Outcome) -> Facts:
    if outcome.error is None:
        return outcome.facts
    failed = {"error": worded(outcome.error), "exit": exit_of(outcome.error).code}
    return {"input": job.input, "output": job.output, **failed}


def _in_order(outcomes: Outcomes) -> Outcomes:
    """Yield outcomes by their numbers, and at the end those after a job that failed."""
    waiting, following = dict[int, Outcome](), 0
    for number, outcome in outcomes:
        waiting[number] = outcome
        # Results are shown in the order of the inputs, whatever ends first, so that two runs print the same.
        while following in waiting:
            yield following, waiting.pop(following)
            following += 1
    for number in sorted(waiting):
        yield number, waiting[number]


def task_of(asked: Task, job: Job, earlier: "Earlier | None" = None) -> Task:
    outputs: Mapping[str, str | None] = {}
    before: Facts | None = None
    if earlier:
        outputs, before = earlier.outputs, earlier.files.get(job.output)
    replaceable = {job.output}
    if before:
        replaceable.add(before["output"])
    replaceable -= {"", "-"}
    # Asked before the work begins. What is made later is the run's own, and may be replaced when a job is repeated.
    there = set(filter(_is_there, replaceable))
    named = replaceable & outputs.keys()
    # A file that an earlier run wrote may be replaced if it has not been changed since. Its digest tells that.
    mine = frozenset(
        name for name in named if name not in there or outputs[name] == pipes.digest_of(name)
    )
    doubtful = frozenset(named - mine)
    if asked.force:
        doubtful = frozenset()
    return replace(
        asked,
        input=job.input,
        output=job.output,
        follow=job.follow,
        within=job.within,
        before=before,
        replaceable=mine,
        doubtful=doubtful,
        fresh=frozenset(replaceable - named - there),
    )


def _is_there(name: str) -> bool:
    """Whether a file, or an object at a URL, has this name."""
    if pipes.is_url(name):
        return pipes.state_of_remote(name) is not None
    return os.path.lexists(name)


def _outcomes(
    run: Batch, console: Console, work: Work, tasks: Tasks, sizes: Sequence[int]
) -> Outcomes:
    """Do jobs on a cluster, in processes, or one after the other here, each as a part of all."""
    finished, count = 0, len(sizes)
    processes = min(run.jobs or available_threads(), count)
    if run.dask is not None or processes > 1:
        # Where there is one process there is no need to load this.
        from bsm.jobs.workers import in_processes, on_cluster

        if run.dask is None:
            yield from in_processes(work, tasks, processes)
        else:
            yield from on_cluster(work, tasks, run.dask, run.dask_wait, console)
        return
    # With one process, tasks never wait for each other, so None means that all are done.
    for number, task in iter(partial(next, tasks), None):
        finished += sizes[number]
        name = ""
        if count > 1:
            name = f"{number + 1} of {count}"
        with console.progress(name, finished / sum(sizes)):
            outcome = outcome_of(work, task, console)
        yield number, outcome
