"""Many jobs: what is written where, who does them, what may be written over, and what is said of them."""

import os
import time
from collections.abc import Callable, Sequence
from contextlib import closing, suppress
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path

from bsm.bitstream.errors import OptionError
from bsm.console import Console, print_json
from bsm.exits import exit_of, tell, worded
from bsm.files.output import default_output, output_inside, refuse_to_overwrite
from bsm.files.pipes import about, expanded, files_behind, is_url, state_of_remote, without_scheme_of_files
from bsm.jobs import report as records

MESH_SUFFIXES = (".obj", ".off", ".ply", ".stl", ".npz", ".glb", ".gltf", ".3mf", ".dae")
"""Of files that are taken for meshes where a folder is searched."""
_STANDARD = {"/dev/stdin": "-", "/dev/fd/0": "-", "/dev/stdout": "-", "/dev/fd/1": "-"}


def plan(
    inputs: Sequence[str], output: str | None, suffix: Callable[[str], str], *, sole_folder: bool = False
) -> list[records.Job]:
    """What is written where."""
    names = input_names(inputs)
    output = without_scheme_of_files(_STANDARD.get(output, output)) if output else None
    folder = output is not None and (output.endswith("/") or (not is_url(output) and Path(output).is_dir()))
    if len(names) > 1:
        if "-" in names or output == "-":
            raise OptionError("a pipe holds one mesh: name files, or one input alone")
        if output and not folder:
            raise OptionError(f"{len(names)} inputs are written to a folder: -o {output}/")
    if output is None:
        jobs = [records.Job(name, default_output(name, suffix(name))) for name in names]
    elif folder and not (sole_folder and len(names) == 1):
        jobs = [records.Job(name, output_inside(output, name, suffix(name))) for name in names]
    else:
        jobs = [records.Job(name, output) for name in names]
    refuse_collisions(names, [job.output for job in jobs])
    if output and folder and not is_url(output):
        Path(output).mkdir(parents=True, exist_ok=True)
    return jobs


def plan_trees(folders: Sequence[str], output: str | None, suffix: str) -> list[records.Job]:
    """What is written where, for all mesh files in folders and below: the same folders again in `output`."""
    jobs = []
    for folder in folders:
        if is_url(folder) or not Path(folder).is_dir():
            raise OptionError(f"{folder} is no folder, and --recursive takes folders of this machine")
        for path in sorted(Path(folder).rglob("*")):
            if path.suffix.lower() in MESH_SUFFIXES and path.is_file():
                place = path if output is None else Path(output, path.relative_to(folder))
                jobs.append(records.Job(str(path), str(place.with_suffix(suffix))))
    if not jobs:
        raise OptionError(f"there are no mesh files in {' or '.join(folders)}, or below ({', '.join(MESH_SUFFIXES)})")
    refuse_collisions([job.input for job in jobs], [job.output for job in jobs])
    for parent in {Path(job.output).parent for job in jobs}:
        parent.mkdir(parents=True, exist_ok=True)
    return jobs


def input_names(inputs: Sequence[str]) -> list[str]:
    """Inputs under the names that we use; URLs with ``*`` name as many as there are."""
    names = [without_scheme_of_files(_STANDARD.get(name, name)) for name in inputs]
    return [found for name in names for found in (expanded(name) if is_url(name) else [name])]


def refuse_collisions(inputs: Sequence[str], outputs: Sequence[str]) -> None:
    """Raise `OptionError` if an output would replace another one or an input, under whatever name or link."""
    found: set[str] = set()
    for output in outputs:
        path = output if is_url(output) else os.path.realpath(output)
        if path in found and output not in ("", "-"):
            raise OptionError(
                f"two outputs would have the name {path}; write them to different folders, or name their folder with -r"
            )
        found.add(path)
    taken = {_identity(file) for name in inputs for file in files_behind(name)} - {None}
    for output in outputs:
        if _identity(output) in taken:
            raise OptionError(f"the output would replace the input {output}; name another with -o")


def _identity(path: str) -> tuple[int, int] | str | None:
    """What is equal for one file under all its names; None: there is no such file."""
    if is_url(path):
        return path
    with suppress(OSError):
        found = os.stat(path)
        return (found.st_dev, found.st_ino) if not os.path.isdir(path) else None
    return None


def run_jobs(
    run: records.Run,
    asked: records.Task,
    console: Console,
    work: records.Work,
    jobs: Sequence[records.Job],
    show: Callable[[records.Facts], str] | None = None,
) -> int:
    """Do all jobs of a command and say what came of them; returns the exit code."""
    if len(jobs) == 1 and run.dask is None and run.report is None and not run.resume:
        with about(jobs[0].input):
            facts = work(task_of(asked, jobs[0]), console)
        if run.json:
            print_json(facts)
        elif show:
            print(show(facts))
        return 0
    begin = time.perf_counter()

    def ended(job: records.Job, outcome: records.Outcome) -> None:
        for line in outcome.notes:
            console.note(line)
        if outcome.error is not None:
            tell(outcome.error)
        elif show and not run.json:
            print(f"{job.input}:\n{show(outcome.facts)}\n", flush=True)

    done = run_many(run, asked, console, work, jobs, ended)
    good = [facts for facts in done if "error" not in facts]
    taken, given = (sum(facts.get(key) or 0 for facts in good) for key in ("input_bytes", "output_bytes"))
    sizes = f", {came_to(taken, given)}" if taken and given else ""
    for line in records.table(done) if run.report is not None else ():
        console.note(line)
    console.note(f"{len(good)} of {len(done)} files{sizes}, {time.perf_counter() - begin:.2f} s")
    if run.json:
        print_json({"files": done})
    return next((facts["exit"] for facts in done if "error" in facts), 0)


def run_many(
    run: records.Run,
    asked: records.Task,
    console: Console,
    work: records.Work,
    jobs: Sequence[records.Job],
    ended: Callable[[records.Job, records.Outcome], None] = lambda job, outcome: None,
) -> list[records.Facts]:
    """Do all jobs; one that fails stops no other. They are told of in their order."""
    if run.dask is not None:
        if any("-" in (job.input, job.output) for job in jobs):
            raise OptionError("a pipe does not reach a cluster: name files")
        jobs = [records.Job(anywhere(job.input), anywhere(job.output)) for job in jobs]
    earlier, report = records.NOTHING, None
    if run.report is not None:
        refuse_to_overwrite(run.report, asked.force or run.resume)
        command, options = work.__name__, records.options_of(asked)
        earlier = records.read_report(run.report, command, options) if run.resume else records.NOTHING
        report = records.Report(run.report, command, options, jobs, earlier.files)
        work = partial(records.recorded, work)
    elif run.resume:
        raise OptionError("--resume goes on from what --report FILE.json says: name it")
    done: list[records.Facts] = [{} for _ in jobs]
    waiting: dict[int, records.Outcome] = {}
    following = 0
    given = ((number, task_of(asked, job, earlier)) for number, job in enumerate(jobs))
    # A cluster may do a job once more whose worker died, and does not say so.
    tasks = ((number, task if run.dask is None else task.repeated()) for number, task in given)
    try:
        with (
            console.progress("files", "files") as progress,
            closing(_outcomes(run, console, work, tasks, len(jobs))) as outcomes,
        ):
            for count, (number, outcome) in enumerate(outcomes, 1):
                done[number] = outcome.facts
                if outcome.error is not None:
                    failed = {"error": worded(outcome.error), "exit": exit_of(outcome.error).code}
                    done[number] = {**asdict(jobs[number]), **failed}
                if report:
                    report.take(number, done[number])
                waiting[number] = outcome
                while following in waiting:
                    ended(jobs[following], waiting.pop(following))
                    following += 1
                progress(count, len(jobs))
    finally:
        if report:
            report.write()
    return done


def task_of(asked: records.Task, job: records.Job, earlier: records.Earlier = records.NOTHING) -> records.Task:
    before = earlier.files.get(job.output)
    replaceable = {job.output, *([before["output"]] if before else [])} - {"", "-"}
    there = {n for n in replaceable if (state_of_remote(n) is not None if is_url(n) else os.path.lexists(n))}
    named = replaceable & earlier.outputs.keys()
    mine = frozenset(name for name in named if name not in there or earlier.outputs[name] == records.digest_of(name))
    return replace(
        asked,
        input=job.input,
        output=job.output,
        before=before,
        replaceable=mine,
        doubtful=frozenset() if asked.force else frozenset(named - mine),
        fresh=frozenset(replaceable - named - there),
    )


def _outcomes(
    run: records.Run, console: Console, work: records.Work, tasks: records.Tasks, count: int
) -> records.Outcomes:
    if run.jobs < 0:
        raise OptionError(f"-j {run.jobs}: at least one input at a time, or 0")
    from bsm.codec.threads import available_threads

    processes = min(run.jobs or available_threads(), count) or 1
    if run.dask is None and processes == 1:
        return ((number, records.outcome_of(work, task, console)) for number, task in tasks)
    # Where there is one process there is no need to load this.
    from bsm.jobs.workers import in_processes, on_cluster

    return in_processes(work, tasks, processes) if run.dask is None else on_cluster(work, tasks, run.dask)


def anywhere(name: str) -> str:
    """A name that means the same in every folder of a machine, and on every machine that has the same folders."""
    return name if not name or is_url(name) else os.path.abspath(name)


def came_to(taken: int | None, given: int) -> str:
    """The bytes of an output, beside those of the input where they are known."""
    if not taken or not given:
        return f"{given} bytes"
    ratio = f"{taken / given:.1f} : 1" if taken >= given else f"1 : {given / taken:.1f}"
    return f"{taken} -> {given} bytes ({ratio})"
