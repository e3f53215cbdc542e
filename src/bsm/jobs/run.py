"""Many jobs: what is written where, who does them, what may be written over, and what is said of them."""

import errno
import json
import os
import tempfile
import time
import traceback
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing, suppress
from dataclasses import asdict, dataclass, replace
from functools import partial
from heapq import heappop, heappush
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from bsm import __version__
from bsm.bitstream.errors import FormatError, OptionError, counted
from bsm.console import Console, print_json
from bsm.exits import behind, exit_of, is_expected, tell, worded
from bsm.files import pipes
from bsm.files.output import default_output, output_inside, refuse_to_overwrite, write_output

_Same = TypeVar("_Same", bound="Task")
Facts = dict[str, Any]  # what came of an input, ready for JSON; `input_bytes`, `output_bytes` are summed up


@dataclass(frozen=True)
class Job:
    input: str
    output: str = ""
    after: tuple[int, ...] = ()  # numbers of the jobs before it whose outputs it needs


@dataclass(frozen=True, kw_only=True)
class Task:
    """What is asked for an input; each command adds fields of its own."""

    input: str = ""
    output: str = ""
    force: bool = False
    quiet: bool = False
    before: Facts | None = None  # what an earlier report says of it
    replaceable: frozenset[str] = frozenset()  # files that are as that report says
    doubtful: frozenset[str] = frozenset()  # files that it names and that are not
    fresh: frozenset[str] = frozenset()  # files that were not there when the run began

    def repeated(self: _Same) -> _Same:
        return replace(self, replaceable=self.replaceable | self.fresh)

    def may_replace(self, path: str) -> bool:
        return self.force or path in self.replaceable


@dataclass(frozen=True, kw_only=True)
class Run:
    """How many jobs are done at a time, where, and what is written of them."""

    jobs: int = 1
    dask: str | None = None
    report: str | None = None
    resume: bool = False
    json: bool = False

    @property
    def side_by_side(self) -> bool:
        return self.jobs != 1 or self.dask is not None


Work: TypeAlias = Callable[[Any, Console], Facts]
"""What a command does with a `Task` of its own; a function of a module, so that processes find it."""


@dataclass(frozen=True)
class Outcome:
    facts: Facts
    error: Exception | None = None
    notes: tuple[str, ...] = ()


class UnexpectedError(Exception):
    """A fault of the program, with its traceback."""


Numbered: TypeAlias = tuple[int, Task]
Tasks: TypeAlias = Iterator[Numbered | None]  # made as they are needed; None: none is ready before others end
Outcomes: TypeAlias = Generator[tuple[int, Outcome], None, None]  # numbers of jobs and what came of them, as they end


def outcome_of(work: Work, task: Task, console: Console) -> Outcome:
    """Do one job; whatever fails is an outcome too, but for signals and for pipes that nobody reads."""
    try:
        with pipes.about(task.input):
            return Outcome(work(task, console), notes=tuple(console.kept or ()))
    except Exception as error:
        if behind(error) is not error or isinstance(error, BrokenPipeError):
            raise
        failure = error
        if not is_expected(error):
            text = "".join(traceback.format_exception(error)).rstrip()
            failure = UnexpectedError(f"{task.input}: unexpected error, please report it: {text}")
        return Outcome({}, failure, tuple(console.kept or ()))


def far_outcome(work: Work, task: Task) -> Outcome:
    return outcome_of(work, task, Console(task.quiet, kept=[]))


# ----------------------------------------------------------------------------------------------------------- the record


_OF_ONE_RUN = {"quiet", "force", "threads", "input", "output", "replaceable", "doubtful", "fresh", "before"}
_EVERY = 1.0  # seconds between two versions of a report, at least
_SHARE = 0.02  # of all time that goes into writing them, at most
_ROWS = 60


def options_of(task: Task) -> Facts:
    """What outputs depend on beside their inputs."""
    given = {name: value for name, value in asdict(task).items() if name not in _OF_ONE_RUN}
    options: Facts = json.loads(json.dumps({"version": __version__, **given}, default=str, sort_keys=True))
    return options


class Report:
    """The record of a run, rewritten as a whole while it goes on."""

    def __init__(
        self, path: str, command: str, options: Facts, jobs: Sequence[Job], earlier: Mapping[str, Facts]
    ) -> None:
        self._path = path
        self._head = {"command": command, "options": options}
        self._files = [earlier.get(job.output) or {"input": job.input, "output": job.output} for job in jobs]
        self._open = set(range(len(jobs)))
        self._begin = time.perf_counter()
        self._next = 0.0
        self.write()

    def take(self, number: int, facts: Facts) -> None:
        self._files[number] = facts
        self._open.discard(number)
        if time.perf_counter() >= self._next:
            self.write()

    def write(self) -> None:
        begin = time.perf_counter()
        state = {"complete": not self._open, "seconds": begin - self._begin, "totals": totals(self._files)}
        text = json.dumps({**self._head, **state, "files": self._files}, indent=1, allow_nan=False)
        write_output(self._path, text.encode() + b"\n", overwrite=True)
        end = time.perf_counter()
        self._next = end + max(_EVERY, (end - begin) / _SHARE)


@dataclass(frozen=True)
class Earlier:
    outputs: Mapping[str, str | None]
    files: Mapping[str, Facts]


NOTHING = Earlier({}, {})


def read_report(path: str, command: str, options: Facts) -> Earlier:
    """Read a report to go on from; nothing is known where there is none."""
    try:
        report = json.loads(pipes.read_bytes(path))
        files = {entry["output"]: entry for entry in map(_entry, report["files"])}
        same = (report["command"], report["options"]) == (command, options)
        json.dumps({**report, "totals": totals(list(files.values()))}, allow_nan=False)
    except FileNotFoundError:
        return NOTHING
    except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
        raise FormatError(f"{path}: this is no report of ours to go on from; name another with --report") from error
    return Earlier({name: entry.get("output_sha256") for name, entry in files.items()}, files if same else {})


_MOST_BYTES = 1 << 63
_FIELDS: Mapping[str, Callable[[Any], bool]] = {
    **dict.fromkeys(("input_bytes", "output_bytes"), lambda value: type(value) is int and 0 <= value < _MOST_BYTES),
    **dict.fromkeys(("seconds", "max_error_relative", "kg"), lambda value: type(value) in (int, float)),
    **dict.fromkeys(("input", "output", "output_sha256"), lambda value: isinstance(value, str)),
    "error": lambda value: isinstance(value, str) and bool(value.strip()),
    "exit": lambda value: type(value) is int and 0 < value < 256,
}


def _entry(given: Any) -> Facts:
    """What a report says of a file; raises as `read_report` catches."""
    entry = dict(given)
    needed = ("input", "output", *(("error", "exit") if "error" in entry else ()))
    for name, fits in _FIELDS.items():
        if (name in needed or entry.get(name) is not None) and not fits(entry[name]):
            raise ValueError(f"{name} is {entry[name]!r}")
    _cells(entry)
    return entry


def recorded(work: Work, task: Task, console: Console) -> Facts:
    """Work that says what it read and wrote; it is not done again where both are still as `task.before` says."""
    state, before = pipes.state_of(task.input), task.before
    as_before = before is not None and state is not None and before.get("input_state") == state
    if before and as_before and before.get("output_sha256") == digest_of(before["output"]):
        console.note(f"{task.input} -> {before['output']}: as it was")
        return {**before, "resumed": True}
    facts = _compared(work, task, console) if task.output in task.doubtful else work(task, console)
    return {**facts, "input_state": state, "output_sha256": digest_of(facts["output"])}


def _compared(work: Work, task: Task, console: Console) -> Facts:
    """Work whose output is there already: it may be what a run wrote that was killed before it said so."""
    path = Path(task.output)
    refuse = FileExistsError(
        errno.EEXIST, "the output is not what the report says was written; -f overwrites it", task.output
    )
    if not path.is_file() or path.is_symlink():
        raise refuse
    with tempfile.TemporaryDirectory() as folder:
        again = str(Path(folder, path.name))
        facts = work(replace(task, output=again), console)
        if digest_of(again) != digest_of(task.output):
            raise refuse
    return {**facts, "output": task.output}


def digest_of(path: str) -> str | None:
    from hashlib import sha256

    found = sha256()
    try:
        for file in pipes.files_behind(path):
            for chunk in pipes.read_chunks(file):
                found.update(chunk)
    except OSError:
        return None
    return found.hexdigest()


def totals(files: Sequence[Facts]) -> Facts:
    done = [facts for facts in files if "output_sha256" in facts]
    taken, given = (sum(facts.get(key) or 0 for facts in done) for key in ("input_bytes", "output_bytes"))
    return {
        "files": len(files),
        "done": len(done),
        "resumed": sum("resumed" in facts for facts in done),
        "failed": sum("error" in facts for facts in files),
        "input_bytes": taken,
        "output_bytes": given,
        "ratio": taken / given if given else None,
    }


def table(files: Sequence[Facts]) -> Iterator[str]:
    """Bytes, ratio, error and time of each file, failures first; lines of text."""
    rows = sorted(files, key=lambda facts: "error" not in facts)[:_ROWS]
    width = max([len(facts["input"]) for facts in rows] + [5])
    yield f"{'input':{width}} {'bytes':>12} {'to':>12} {'ratio':>7} {'error':>10} {'seconds':>8}"
    for facts in rows:
        yield f"{facts['input']:{width}} {_cells(facts)}"
    if len(files) > len(rows):
        yield f"... and {len(files) - len(rows)} more"


def _cells(facts: Facts) -> str:
    if "error" in facts:
        return f"failed: {facts['error'].splitlines()[-1]}"
    taken, given, farthest, kg = map(facts.get, ("input_bytes", "output_bytes", "max_error_relative", "kg"))
    sizes = " ".join(f"{'' if size is None else size:>12}" for size in (taken, given))
    ratio = f"{taken / given:.2f}" if taken and given else ""
    error = f"{100 * farthest:.3g} %" if farthest is not None else f"KG {kg:.3g} %" if kg is not None else ""
    seconds = "as it was" if "resumed" in facts else f"{facts.get('seconds') or 0.0:.2f}"
    return f"{sizes} {ratio:>7} {error:>10} {seconds:>8}"


MESH_SUFFIXES = (".obj", ".off", ".ply", ".stl", ".npz", ".glb", ".gltf", ".3mf", ".dae")
"""Of files that are taken for meshes where a folder is searched."""
_STANDARD = {"/dev/stdin": "-", "/dev/fd/0": "-", "/dev/stdout": "-", "/dev/fd/1": "-"}


def plan(
    inputs: Sequence[str], output: str | None, suffix: Callable[[str], str], *, sole_folder: bool = False
) -> list[Job]:
    """What is written where."""
    names = input_names(inputs)
    output = pipes.without_scheme_of_files(_STANDARD.get(output, output)) if output else None
    folder = output is not None and (output.endswith("/") or (not pipes.is_url(output) and Path(output).is_dir()))
    if len(names) > 1:
        if "-" in names or output == "-":
            raise OptionError("a pipe holds one mesh: name files, or one input alone")
        if output and not folder:
            raise OptionError(f"{len(names)} inputs are written to a folder: -o {output}/")
    if output is None:
        jobs = [Job(name, default_output(name, suffix(name))) for name in names]
    elif folder and not (sole_folder and len(names) == 1):
        jobs = [Job(name, output_inside(output, name, suffix(name))) for name in names]
    else:
        jobs = [Job(name, output) for name in names]
    refuse_collisions(names, [job.output for job in jobs])
    if output and folder and not pipes.is_url(output):
        Path(output).mkdir(parents=True, exist_ok=True)
    return jobs


def plan_trees(folders: Sequence[str], output: str | None, suffix: str) -> list[Job]:
    """What is written where, for all mesh files in folders and below: the same folders again in `output`."""
    jobs = []
    for folder in folders:
        if pipes.is_url(folder) or not Path(folder).is_dir():
            raise OptionError(f"{folder} is no folder, and --recursive takes folders of this machine")
        for path in sorted(Path(folder).rglob("*")):
            if path.suffix.lower() in MESH_SUFFIXES and path.is_file():
                place = path if output is None else Path(output, path.relative_to(folder))
                jobs.append(Job(str(path), str(place.with_suffix(suffix))))
    if not jobs:
        raise OptionError(f"there are no mesh files in {' or '.join(folders)}, or below ({', '.join(MESH_SUFFIXES)})")
    refuse_collisions([job.input for job in jobs], [job.output for job in jobs])
    for parent in {Path(job.output).parent for job in jobs}:
        parent.mkdir(parents=True, exist_ok=True)
    return jobs


def input_names(inputs: Sequence[str]) -> list[str]:
    """Inputs under the names that we use; URLs with ``*`` name as many as there are."""
    names = [pipes.without_scheme_of_files(_STANDARD.get(name, name)) for name in inputs]
    return [found for name in names for found in (pipes.expanded(name) if pipes.is_url(name) else [name])]


def refuse_collisions(inputs: Sequence[str], outputs: Sequence[str]) -> None:
    """Raise `OptionError` if an output would replace another one or an input, under whatever name or link."""
    found: set[str] = set()
    for output in outputs:
        path = output if pipes.is_url(output) else os.path.realpath(output)
        if path in found and output not in ("", "-"):
            raise OptionError(
                f"two outputs would have the name {path}; give each its own -o, or name the folder above both with -r"
            )
        found.add(path)
    taken = {_identity(file) for name in inputs for file in pipes.files_behind(name)} - {None}
    for output in outputs:
        if _identity(output) in taken:
            raise OptionError(f"the output would replace the input {output}; name another with -o")


def _identity(path: str) -> tuple[int, int] | str | None:
    """What is equal for one file under all its names; None: there is no such file."""
    if pipes.is_url(path):
        return path
    with suppress(OSError):
        found = os.stat(path)
        return (found.st_dev, found.st_ino) if not os.path.isdir(path) else None
    return None


def run_jobs(
    run: Run, asked: Task, console: Console, work: Work, jobs: Sequence[Job], show: Callable[[Facts], str] | None = None
) -> int:
    """Do all jobs of a command and say what came of them; returns the exit code."""
    if len(jobs) == 1 and run.dask is None and run.report is None and not run.resume:
        with pipes.about(jobs[0].input):
            facts = work(task_of(asked, jobs[0]), console)
        if run.json:
            print_json(facts)
        elif show:
            print(show(facts))
        return 0
    begin = time.perf_counter()

    def ended(job: Job, outcome: Outcome) -> None:
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
    for line in table(done) if run.report is not None else ():
        console.note(line)
    console.note(f"{len(good)} of {counted(files=len(done))}{sizes}, {time.perf_counter() - begin:.2f} s")
    if run.json:
        print_json({"files": done})
    return next((facts["exit"] for facts in done if "error" in facts), 0)


def run_many(
    run: Run,
    asked: Task,
    console: Console,
    work: Work,
    jobs: Sequence[Job],
    ended: Callable[[Job, Outcome], None] = lambda job, outcome: None,
) -> list[Facts]:
    """Do all jobs; one that fails stops those alone that need it. They are told of in their order."""
    if run.dask is not None:
        if any("-" in (job.input, job.output) for job in jobs):
            raise OptionError("a pipe does not reach a cluster: name files")
        jobs = [replace(job, input=anywhere(job.input), output=anywhere(job.output)) for job in jobs]
    earlier, report = NOTHING, None
    if run.report is not None:
        refuse_to_overwrite(run.report, asked.force or run.resume)
        command, options = work.__name__, options_of(asked)
        earlier = read_report(run.report, command, options) if run.resume else NOTHING
        report = Report(run.report, command, options, jobs, earlier.files)
        work = partial(recorded, work)
    elif run.resume:
        raise OptionError("--resume goes on from what --report FILE.json says: name it")
    done: list[Facts] = [{} for _ in jobs]
    waiting: dict[int, Outcome] = {}
    following = 0
    needs, users = [len(job.after) for job in jobs], dict[int, list[int]]()
    for number, job in enumerate(jobs):
        for needed in job.after:
            users.setdefault(needed, []).append(number)
    ready = [number for number, missing in enumerate(needs) if not missing]

    def given() -> Tasks:
        while True:
            while ready:
                task = task_of(asked, jobs[number := heappop(ready)], earlier)
                # A cluster may do a job once more whose worker died, and does not say so.
                yield number, task if run.dask is None else task.repeated()
            yield None

    try:
        with (
            console.progress("files", "files") as progress,
            closing(_outcomes(run, console, work, given(), len(jobs))) as outcomes,
        ):
            for count, (number, outcome) in enumerate(outcomes, 1):
                done[number] = outcome.facts
                if outcome.error is not None:
                    failed = {"error": worded(outcome.error), "exit": exit_of(outcome.error).code}
                    done[number] = {"input": jobs[number].input, "output": jobs[number].output, **failed}
                else:
                    for user in users.get(number, ()):
                        needs[user] -= 1
                        if not needs[user]:
                            heappush(ready, user)
                if report:
                    report.take(number, done[number])
                waiting[number] = outcome
                while following in waiting:
                    ended(jobs[following], waiting.pop(following))
                    following += 1
                progress(count, len(jobs))
        for number in sorted(waiting):  # behind one that lacks what it needs
            ended(jobs[number], waiting[number])
    finally:
        if report:
            report.write()
    return done


def task_of(asked: Task, job: Job, earlier: Earlier = NOTHING) -> Task:
    before = earlier.files.get(job.output)
    replaceable = {job.output, *([before["output"]] if before else [])} - {"", "-"}
    there = {
        n for n in replaceable if (pipes.state_of_remote(n) is not None if pipes.is_url(n) else os.path.lexists(n))
    }
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


def _outcomes(run: Run, console: Console, work: Work, tasks: Tasks, count: int) -> Outcomes:
    if run.jobs < 0:
        raise OptionError(f"-j {run.jobs}: at least one input at a time, or 0")
    from bsm.codec.threads import available_threads

    processes = min(run.jobs or available_threads(), count) or 1
    if run.dask is None and processes == 1:
        return ((number, outcome_of(work, task, console)) for number, task in iter(partial(next, tasks), None))
    # Where there is one process there is no need to load this.
    from bsm.jobs.workers import in_processes, on_cluster

    return in_processes(work, tasks, processes) if run.dask is None else on_cluster(work, tasks, run.dask)


def anywhere(name: str) -> str:
    """A name that means the same in every folder of a machine, and on every machine that has the same folders."""
    return name if not name or pipes.is_url(name) else os.path.abspath(name)


def came_to(taken: int | None, given: int) -> str:
    """The bytes of an output, beside those of the input where they are known."""
    if not taken or not given:
        return f"{given} bytes"
    ratio = f"{taken / given:.1f} : 1" if taken >= given else f"1 : {given / taken:.1f}"
    return f"{taken} -> {given} bytes ({ratio})"
