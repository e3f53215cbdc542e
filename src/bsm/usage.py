"""Wrong usage: one line on what is wrong and what may have been meant, one on how it is right."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NoReturn

FILES = ("IN", "OUT", "FILE", "FILE.npy", "FILE.json", "REPORT.html", "MESH", "FOLDER", "A", "B")
"""What files and folders are called in the help."""


def suggestion(word: str, known: Iterable[str]) -> str:
    """A question whether something similar was meant; "" if there is nothing."""
    names = list(known)
    begun = [name for name in names if name.startswith(word)]
    found = begun if len(begun) == 1 else difflib.get_close_matches(word, names, n=1, cutoff=0.6)
    return f"; did you mean {found[0]}?" if found else ""


class Formatter(argparse.RawDescriptionHelpFormatter):
    """Help of one line where one is enough."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=27)

    def _format_action_invocation(self, action: argparse.Action) -> str:
        """The value is named once: `-o, --output OUT`."""
        if not action.option_strings or action.nargs == 0:
            return super()._format_action_invocation(action)
        value = self._format_args(action, action.dest.upper())
        return f"{', '.join(action.option_strings)} {value}"


class Parser(argparse.ArgumentParser):
    """An argument parser that is short about errors and takes options anywhere between inputs."""

    def __init__(self, **keywords: Any) -> None:
        super().__init__(**{"formatter_class": Formatter, **keywords})

    def format_usage(self) -> str:
        """The usage in one line."""
        return f"usage: {self.prog}{self._inputs()}\n"

    def format_help(self) -> str:
        """The usage in one line, then all options."""
        self.usage = f"{self.prog}{self._inputs()}"
        return super().format_help()

    def _inputs(self) -> str:
        inputs = [action for action in self._actions if not action.option_strings and action.nargs != argparse.PARSER]
        names = "".join(f" {action.metavar}{'...' if action.nargs in ('+', '*') else ''}" for action in inputs)
        return f"{names} [options]" if inputs else " COMMAND ..."

    def parse_command(self, words: Sequence[str]) -> argparse.Namespace:
        """Parse the words behind a command."""
        # argparse forgets a "--" between the two passes that mixed words take it.
        parse = self.parse_known_args if "--" in words else self.parse_known_intermixed_args
        args, unknown = parse(words)
        if unknown:
            word = next((word for word in unknown if word.startswith("-")), unknown[0])
            name = word.partition("=")[0]
            if not name.startswith("-"):
                self.error(f"{word}: one input too many")
            self.error(f"there is no option {name}{suggestion(name, self._option_string_actions)}")
        return args

    def error(self, message: str) -> NoReturn:
        """Say what is wrong, and one line of usage; exit with code 2."""
        self.exit(2, f"{self.prog}: {message}\nusage: {self.prog}{self._inputs()}; {self.prog} --help tells more\n")

    def file_arguments(self) -> Iterator[argparse.Action]:
        """All that are names of files, those of commands included."""
        for action in self._actions:
            if action.nargs == argparse.PARSER and isinstance(action.choices, dict):
                for command in action.choices.values():
                    yield from command.file_arguments()
            elif action.metavar in FILES:
                yield action
