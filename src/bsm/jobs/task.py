"""A job: its task, its outcome, and how it is done."""

import os
import traceback
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, TypeVar

from bsm.files import pipes
from bsm.ground.console import Console
from bsm.ground.exits import behind, is_expected

_Same = TypeVar("_Same", bound="Task")
# The result for an input, ready for JSON; `input_bytes`, `output_bytes` are summed up.
Facts = dict[str, Any]


@dataclass(frozen=True)
class Job:
    input: str
    output: str = ""
    after: tuple[int, ...] = ()  # numbers of the jobs before it whose outputs it needs
    # The user gave the name of the output, or a folder: see `open_output`.
    follow: bool | str = False
    within: str = ""  # the folder in which the input was found


# Frozen and plain, since tasks are pickled for other processes and machines.
@dataclass(frozen=True, kw_only=True)
class Task:
    """The options of a job; each command adds its own fields."""

    input: str = ""
    output: str = ""
    # The user gave the name of the output, or a folder: see `open_output`.
    follow: bool | str = True
    within: str = ""  # the folder in which the input was found
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

    def placing(self, path: str) -> dict[str, Any]:
        """How an output may be put in its place: keywords of `open_output`."""
        return {"overwrite": self.may_replace(path), "follow": self.follow}


Work: TypeAlias = Callable[[Any, Console], Facts]
"""The function of a command that does a task; at the top level of a module, so that processes find it."""


@dataclass(frozen=True)
class Outcome:
    facts: Facts
    error: Exception | None = None
    notes: tuple[str, ...] = ()


class UnexpectedError(Exception):
    """A fault of the program, with its traceback."""


Numbered: TypeAlias = tuple[int, Task]
# Made when needed; None: the next ones wait for others.
Tasks: TypeAlias = Iterator[Numbered | None]
# Numbers of jobs and their outcomes, as they end.
Outcomes: TypeAlias = Generator[tuple[int, Outcome], None, None]


def outcome_of(work: Work, task: Task, console: Console) -> Outcome:
    """Do one job; failures are outcomes, except signals and broken pipes."""
    try:
        with pipes.about(task.input):
            if task.within:
                pipes.refuse_link_out(task.within, task.input)
            return Outcome(work(task, console), notes=tuple(console.kept or ()))
    # A fault of one file is an outcome like any other. Signals and closed pipes concern the whole run, and pass.
    except Exception as error:
        if (
            behind(error) is not error
            or isinstance(error, BrokenPipeError)
            or console.stopped_by(error)
        ):
            raise
        failure = error
        if not is_expected(error):
            # The traceback as text: exceptions of libraries often cannot be pickled, and the process would die of that.
            text = "".join(traceback.format_exception(error)).rstrip()
            failure = UnexpectedError(f"{task.input}: unexpected error, please report it: {text}")
        return Outcome({}, failure, tuple(console.kept or ()))


def anywhere(name: str) -> str:
    """Return an absolute path, which is valid in every process and on machines that share the folders."""
    if not name or pipes.is_url(name):
        return name
    return os.path.abspath(name)


def came_to(taken: int | None, given: int) -> str:
    """Return the bytes of an output, after those of the input if they are known."""
    if not taken or not given:
        return f"{given} bytes"
    ratio = f"{taken / given:.1f} : 1"
    if taken < given:
        ratio = f"1 : {given / taken:.1f}"
    return f"{taken} -> {given} bytes ({ratio})"
