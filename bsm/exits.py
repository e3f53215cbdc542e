"""The exit codes of the command line: one table, which the program obeys and its help prints."""

from __future__ import annotations

from dataclasses import dataclass

from bitstream.errors import (
    ArgumentError,
    BsmError,
    CorruptError,
    DependencyError,
    FormatError,
    LimitError,
    MeshError,
    NumericError,
    OptionError,
    TruncatedError,
    UnsupportedError,
)


@dataclass(frozen=True)
class Exit:
    """An exit code, what it means, and the errors that lead to it."""

    code: int
    meaning: str
    errors: tuple[type[BaseException], ...] = ()


UNEXPECTED = Exit(1, "unexpected error: please report it")
USAGE = Exit(2, "wrong usage or option", (OptionError, ArgumentError))
# The first row that fits an error counts.
EXITS = (
    Exit(0, "done"),
    UNEXPECTED,
    USAGE,
    Exit(3, "the input is not the kind of file expected, or no triangle mesh", (FormatError, MeshError)),
    Exit(4, "the input is damaged or cut short", (CorruptError, TruncatedError)),
    Exit(5, "the input is of a version or method that this program does not know", (UnsupportedError,)),
    Exit(6, "the input asks for more memory or work than allowed", (LimitError, MemoryError)),
    Exit(7, "the mathematics broke down", (NumericError,)),
    Exit(8, "an optional package is missing", (DependencyError,)),
    Exit(130, "interrupted", (KeyboardInterrupt,)),
    Exit(141, "the reader of a pipe went away", (BrokenPipeError,)),
    Exit(9, "a file cannot be read or written", (OSError,)),
    Exit(143, "terminated"),
)


def exit_of(error: BaseException) -> Exit:
    """The row that an error leads to."""
    return next((row for row in EXITS if isinstance(error, row.errors)), UNEXPECTED)


def is_expected(error: BaseException) -> bool:
    """Whether an error is the user's business and not a fault of the program."""
    return isinstance(error, BsmError) or exit_of(error) is not UNEXPECTED


def exit_table() -> str:
    """The table as text."""
    return "\n".join(f"  {row.code:>3}  {row.meaning}" for row in sorted(EXITS, key=lambda row: row.code))
