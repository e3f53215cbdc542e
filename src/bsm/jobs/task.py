"""One job among many: what is done with an input, and what came of it."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, TypeVar

from bsm.console import Console
from bsm.exits import behind, is_expected
from bsm.files.pipes import about

_Same = TypeVar("_Same", bound="Task")
Facts = dict[str, Any]
"""What came of an input, ready for JSON; `input_bytes`, `output_bytes` are summed up."""


@dataclass(frozen=True)
class Job:
    """An input, and where its output goes ("": nowhere)."""

    input: str
    output: str = ""


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
        """This task after an attempt that was cut off."""
        return replace(self, replaceable=self.replaceable | self.fresh)

    def may_replace(self, path: str) -> bool:
        """Whether this job may write over a file."""
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
        """Whether several jobs may be done at a time."""
        return self.jobs != 1 or self.dask is not None


Work: TypeAlias = Callable[[Any, Console], Facts]
"""What a command does with a `Task` of its own; a function of a module, so that processes find it."""


@dataclass(frozen=True)
class Outcome:
    """What came of a job: facts or an error, and notes made meanwhile."""

    facts: Facts
    error: Exception | None = None
    notes: tuple[str, ...] = ()


class UnexpectedError(Exception):
    """A fault of the program, with its traceback."""


Numbered: TypeAlias = tuple[int, Task]
Tasks: TypeAlias = Iterable[Numbered]
"""Made as they are needed."""
Outcomes: TypeAlias = Generator[tuple[int, Outcome], None, None]
"""Numbers of jobs and what came of them, as they end."""


def outcome_of(work: Work, task: Task, console: Console) -> Outcome:
    """Do one job; whatever fails is an outcome too, but for signals and for pipes that nobody reads."""
    try:
        with about(task.input):
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
    """`outcome_of` in another process."""
    return outcome_of(work, task, Console(task.quiet, kept=[]))
