"""The same work on one input or on many: what is written where, how it is done, and a summary."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from bsm.bitstream.errors import OptionError
from bsm.console import Console, print_json
from bsm.exits import tell
from bsm.farm.jobs import Facts as Facts
from bsm.farm.jobs import Job as Job
from bsm.farm.jobs import Outcome, Run, Task, Work
from bsm.farm.report import table
from bsm.farm.run import run_many, task_of
from bsm.files.about import about
from bsm.files.naming import default_output, output_inside
from bsm.files.remote import expanded, is_url, without_scheme_of_files
from bsm.files.state import files_behind
from bsm.files.state import size_of as size_of

MESH_SUFFIXES = (".obj", ".off", ".ply", ".stl", ".npz", ".glb", ".gltf", ".3mf", ".dae")
"""Of files that are taken for meshes where a folder is searched."""
_STANDARD = {"/dev/stdin": "-", "/dev/fd/0": "-", "/dev/stdout": "-", "/dev/fd/1": "-"}


def plan(
    inputs: Sequence[str], output: str | None, suffix: Callable[[str], str], *, sole_folder: bool = False
) -> list[Job]:
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
        jobs = [Job(name, default_output(name, suffix(name))) for name in names]
    elif folder and not (sole_folder and len(names) == 1):
        jobs = [Job(name, output_inside(output, name, suffix(name))) for name in names]
    else:
        jobs = [Job(name, output) for name in names]
    refuse_collisions(names, [job.output for job in jobs])
    if output and folder and not is_url(output):
        Path(output).mkdir(parents=True, exist_ok=True)
    return jobs


def plan_trees(folders: Sequence[str], output: str | None, suffix: str) -> list[Job]:
    """What is written where, for all mesh files in folders and below: the same folders again in `output`."""
    jobs = []
    for folder in folders:
        if is_url(folder) or not Path(folder).is_dir():
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
    names = [without_scheme_of_files(_STANDARD.get(name, name)) for name in inputs]
    return [found for name in names for found in (expanded(name) if is_url(name) else [name])]


def refuse_collisions(inputs: Sequence[str], outputs: Sequence[str]) -> None:
    """Raise `OptionError` if an output would replace another one or an input, under whatever name or link."""
    found: set[str] = set()
    for output in outputs:
        path = output if is_url(output) else os.path.realpath(output)
        if path in found and output not in ("", "-"):
            raise OptionError(f"two outputs would have the name {path}; write them to different folders")
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
    run: Run,
    asked: Task,
    console: Console,
    work: Work,
    jobs: Sequence[Job],
    show: Callable[[Facts], str] | None = None,
) -> int:
    """Do all jobs and say what came of them."""
    if len(jobs) == 1 and run.dask is None and run.report is None and not run.resume:
        with about(jobs[0].input):
            facts = work(task_of(asked, jobs[0]), console)
        if run.json:
            print_json(facts)
        elif show:
            print(show(facts))
        return 0
    begin = time.perf_counter()

    def hear(job: Job, outcome: Outcome) -> None:
        for line in outcome.said:
            console.note(line)
        if outcome.error is not None:
            tell(outcome.error)
        elif show and not run.json:
            print(f"{job.input}:\n{show(outcome.facts)}\n", flush=True)

    done = run_many(run, asked, console, work, jobs, hear)
    if run.report is not None:
        for line in table(done):
            console.note(line)
    console.note(_summary(done, time.perf_counter() - begin))
    if run.json:
        print_json({"files": done})
    return next((facts["exit"] for facts in done if "error" in facts), 0)


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
