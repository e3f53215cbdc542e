"""The same work on one input or on many: what is written where, one after the other or side by side, and a summary."""

from __future__ import annotations

import argparse
import glob
import os
import signal
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bitstream.errors import OptionError
from bsm.console import Console, print_json
from bsm.exits import about, behind, exit_of, is_expected, tell
from bsm.files.naming import default_output, output_inside
from bsm.files.output import Terminated, termination_as_exception

if TYPE_CHECKING:
    from concurrent.futures import Future, ProcessPoolExecutor

Facts = dict[str, Any]
"""What came of an input, ready for JSON; `input_bytes`, `output_bytes` are summed up."""
Work = Callable[[argparse.Namespace, Console], Facts]
"""What a command does with `input` and `output` of its arguments; a function of a module, so that processes find it."""

Outcomes = Generator["Outcome", None, None]

_STANDARD = {"/dev/stdin": "-", "/dev/fd/0": "-", "/dev/stdout": "-", "/dev/fd/1": "-"}


@dataclass(frozen=True)
class Job:
    """An input, and where its output goes ("": nowhere)."""

    input: str
    output: str = ""


@dataclass(frozen=True)
class Outcome:
    """What came of a job: facts or an error, and what was said meanwhile."""

    facts: Facts
    error: Exception | None
    said: tuple[str, ...]


def add_inputs(parser: argparse.ArgumentParser, about_them: str, output: str | None = None) -> None:
    """Declare inputs, how many are worked on at a time, and, where the command writes, its output."""
    parser.add_argument("inputs", metavar="IN", nargs="+", help=about_them)
    if output:
        parser.add_argument("-o", "--output", metavar="OUT", help=output)
    parser.add_argument(
        "-j", "--jobs", type=int, default=1, metavar="N", help="inputs to work on at a time, 0: one per core (1)"
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")


def plan(
    inputs: Sequence[str], output: str | None, suffix: Callable[[str], str], *, sole_folder: bool = False
) -> list[Job]:
    """What is written where.

    Parameters
    ----------
    inputs : sequence of str
    output : str or None
        A file for one input, a folder for any number; None: beside each input.
    suffix : callable
        Tells from an input the suffix of its output, where it has no name of its own.
    sole_folder : bool
        Leave the folder for a sole input as it is: the input may need all of it.

    Raises
    ------
    OptionError
        If outputs would replace one another or an input, or have no name.
    """
    names = [_STANDARD.get(name, name) for name in inputs]
    output = _STANDARD.get(output, output) if output else None
    folder = output is not None and (output.endswith("/") or Path(output).is_dir())
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
    if output and folder:
        Path(output).mkdir(parents=True, exist_ok=True)
    return jobs


def refuse_collisions(inputs: Sequence[str], outputs: Sequence[str]) -> None:
    """Raise `OptionError` if an output would replace another one or an input, under whatever name or link."""
    paths = [os.path.realpath(output) for output in outputs if output not in ("", "-")]
    for path in paths:
        if paths.count(path) > 1:
            raise OptionError(f"two outputs would have the name {path}; write them to different folders")
    taken = {_identity(file) for name in inputs for file in _files(name)} - {None}
    for output in outputs:
        if os.path.isfile(output) and _identity(output) in taken:
            raise OptionError(f"the output would replace the input {output}; name another with -o")


def _files(name: str) -> Iterator[str]:
    """The files behind an input: itself, or what a folder or a pattern names."""
    if os.path.isdir(name):
        yield from (entry.path for entry in os.scandir(name))
    elif glob.has_magic(name) and not os.path.exists(name):
        yield from glob.iglob(name)
    else:
        yield name


def _identity(path: str) -> tuple[int, int] | None:
    with suppress(OSError):
        found = os.stat(path)
        return found.st_dev, found.st_ino
    return None


def run_jobs(
    args: argparse.Namespace,
    console: Console,
    work: Work,
    jobs: Sequence[Job],
    show: Callable[[Facts], str] | None = None,
) -> int:
    """Do all jobs and say what came of them.

    One job fails as its work does. Of many, each failure is told and the others go on.

    Parameters
    ----------
    show : callable, optional
        Words the facts of one input for standard output, where they are the result.

    Returns
    -------
    int
        The exit code: that of the first failure.
    """
    if len(jobs) == 1:
        with about(jobs[0].input):
            facts = work(_for_job(args, jobs[0]), console)
        if args.json:
            print_json(facts)
        elif show:
            print(show(facts))
        return 0
    begin = time.perf_counter()
    done: list[Facts] = []
    code = 0
    with console.progress("files", "files") as progress, closing(_outcomes(args, console, work, jobs)) as outcomes:
        for number, (job, outcome) in enumerate(zip(jobs, outcomes), 1):
            for line in outcome.said:
                console.note(line)
            if outcome.error is not None:
                tell(outcome.error)
                failed = exit_of(outcome.error).code
                code = code or failed
                done.append({"input": job.input, "error": str(outcome.error), "exit": failed})
            else:
                done.append(outcome.facts)
                if show and not args.json:
                    print(f"{job.input}:\n{show(outcome.facts)}\n", flush=True)
            progress(number, len(jobs))
    console.note(_summary(done, time.perf_counter() - begin))
    if args.json:
        print_json({"files": done})
    return code


def _outcomes(args: argparse.Namespace, console: Console, work: Work, jobs: Sequence[Job]) -> Outcomes:
    """What comes of the jobs, in their order."""
    processes = min(args.jobs or _cores(), len(jobs))
    if processes < 0:
        raise OptionError(f"-j {args.jobs}: at least one input at a time, or 0")
    if processes == 1:
        for job in jobs:
            yield _outcome(work, _for_job(args, job), console)
        return
    # Where there is one input there is one process, and no need to load this.
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool

    # Not forked: threads of this process may hold locks.
    pool = ProcessPoolExecutor(processes, multiprocessing.get_context("spawn"))
    with pool, termination_as_exception():
        try:
            for future in _submitted(pool, args, work, jobs):
                yield future.result()
        except BrokenProcessPool as error:
            raise MemoryError("a process was ended from outside; work on fewer inputs at a time") from error
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in multiprocessing.active_children():
                process.terminate()
            raise


def _submitted(
    pool: ProcessPoolExecutor, args: argparse.Namespace, work: Work, jobs: Sequence[Job]
) -> list[Future[Outcome]]:
    """All jobs, handed to processes that leave Ctrl-C to this one from their first moment on."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        return [pool.submit(_silent_outcome, work, _for_job(args, job)) for job in jobs]
    finally:
        signal.signal(signal.SIGINT, before)


def _silent_outcome(work: Work, args: argparse.Namespace) -> Outcome:
    try:
        return _outcome(work, args, Console(args.quiet, kept=[]))
    except Terminated:
        # What was begun is cleared away; nothing else is to be taken up.
        os._exit(exit_of(Terminated()).code)


def _outcome(work: Work, args: argparse.Namespace, console: Console) -> Outcome:
    """Do one job; failures that are the user's business are outcomes too."""
    facts: Facts = {}
    failure = None
    try:
        with about(args.input):
            facts = work(args, console)
    except Exception as error:
        if behind(error) is not error or isinstance(error, BrokenPipeError) or not is_expected(error):
            raise
        failure = error
    return Outcome(facts, failure, tuple(console.kept or ()))


def _for_job(args: argparse.Namespace, job: Job) -> argparse.Namespace:
    return argparse.Namespace(**{**vars(args), "input": job.input, "output": job.output})


def _cores() -> int:
    from codec.threads import available_threads

    return available_threads()


def _summary(done: Sequence[Facts], seconds: float) -> str:
    good = [facts for facts in done if "error" not in facts]
    text = f"{len(good)} of {len(done)} files"
    taken, given = (sum(facts.get(key) or 0 for facts in good) for key in ("input_bytes", "output_bytes"))
    if taken and given:
        text += f", {came_to(taken, given)}"
    return f"{text}, {seconds:.2f} s"


def came_to(taken: int | None, given: int) -> str:
    """The bytes of an output, beside those of the input where they are known."""
    if not taken or not given:
        return f"{given} bytes"
    ratio = f"{taken / given:.1f} : 1" if taken >= given else f"1 : {given / taken:.1f}"
    return f"{taken} -> {given} bytes ({ratio})"


def size_of(path: str) -> int | None:
    """Bytes of the files behind an input or output; None for a pipe."""
    sizes = [os.path.getsize(file) for file in _files(path) if os.path.isfile(file)]
    return sum(sizes) if sizes else None
