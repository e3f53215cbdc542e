"""One job among many: what is done with an input, and what came of it."""

from __future__ import annotations

import argparse
import traceback
from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

from bsm.console import Console
from bsm.exits import about, behind, is_expected
from bsm.files.output import remove_abandoned

Facts = dict[str, Any]
"""What came of an input, ready for JSON; `input_bytes`, `output_bytes` are summed up."""
Work = Callable[[argparse.Namespace, Console], Facts]
"""What a command does with `input` and `output` of its arguments; a function of a module, so that processes find it."""


@dataclass(frozen=True)
class Job:
    """An input, and where its output goes ("": nowhere)."""

    input: str
    output: str = ""


@dataclass(frozen=True)
class Outcome:
    """What came of a job: facts or an error, and what was said meanwhile."""

    facts: Facts
    error: Exception | None = None
    said: tuple[str, ...] = ()


class UnexpectedError(Exception):
    """A fault of the program, with its traceback."""


Task: TypeAlias = tuple[int, argparse.Namespace]
"""The number of a job, and its arguments."""
Tasks: TypeAlias = Iterable[Task]
"""Made as they are needed."""
Outcomes: TypeAlias = Generator[tuple[int, Outcome], None, None]
"""Numbers of jobs and what came of them, as they end."""


def outcome_of(work: Work, args: argparse.Namespace, console: Console) -> Outcome:
    """Do one job; whatever fails is an outcome too, but for signals and for pipes that nobody reads."""
    try:
        with about(args.input):
            return Outcome(work(args, console), said=tuple(console.kept or ()))
    except Exception as error:
        if behind(error) is not error or isinstance(error, BrokenPipeError):
            raise
        failure = error if is_expected(error) else _fault(args.input, error)
        return Outcome({}, failure, tuple(console.kept or ()))


def far_outcome(work: Work, args: argparse.Namespace) -> Outcome:
    """`outcome_of` where nobody listens and an earlier attempt may have been cut off."""
    for path in args.replaceable:
        remove_abandoned(path)
    return outcome_of(work, args, Console(args.quiet, kept=[]))


def one_by_one(work: Work, tasks: Tasks, console: Console) -> Outcomes:
    """Do all jobs here."""
    for number, args in tasks:
        yield number, outcome_of(work, args, console)


def _fault(name: str, error: Exception) -> UnexpectedError:
    text = "".join(traceback.format_exception(error)).rstrip()
    return UnexpectedError(f"{name}: unexpected error, please report it: {text}")
