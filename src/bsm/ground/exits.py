"""The exit codes of the command line, and how errors are printed."""

import errno
import os
import sys
from dataclasses import dataclass

from bsm.bitstream import errors as failures
from bsm.ground.console import for_command, say


class Terminated(SystemExit):
    """Raised when SIGTERM comes."""


@dataclass(frozen=True)
class Exit:
    """An exit code, its meaning, and the errors that lead to it."""

    code: int
    meaning: str
    errors: tuple[type[BaseException], ...] = ()


UNEXPECTED = Exit(1, "unexpected error: please report it")
USAGE = Exit(2, "wrong usage or option", (failures.OptionError, failures.ArgumentError))
# BrokenPipeError is an OSError, and our errors derive from builtins as well, so the order matters. The first row that
# fits an error counts.
EXITS = (
    Exit(0, "done"),
    UNEXPECTED,
    USAGE,
    Exit(
        3,
        "the input is not a file of the expected kind, or not a triangle mesh",
        (failures.FormatError, failures.MeshError),
    ),
    Exit(4, "the input is damaged", (failures.CorruptError,)),
    Exit(
        5,
        "the input uses a version or method that this program does not know",
        (failures.UnsupportedError,),
    ),
    Exit(
        6, "the input asks for more memory or work than allowed", (failures.LimitError, MemoryError)
    ),
    Exit(7, "a computation failed numerically", (failures.NumericError,)),
    Exit(8, "an optional package is missing", (failures.DependencyError,)),
    Exit(
        10,
        "the requested quality or size cannot be reached, or the decoded result does not meet it",
        (failures.TargetError, failures.VerificationError),
    ),
    Exit(
        11,
        "the result would be worse than the input; --force writes it anyway",
        (failures.HarmError,),
    ),
    Exit(12, "the input ends too early", (failures.TruncatedError,)),
    Exit(130, "interrupted", (KeyboardInterrupt,)),
    Exit(141, "broken pipe", (BrokenPipeError,)),
    Exit(9, "a file cannot be read or written, or exists already", (OSError,)),
    Exit(143, "terminated", (Terminated,)),
)
# A compiler or a loader that they hit may raise something else on top of them.
_SIGNALS = (KeyboardInterrupt, Terminated)


def exit_of(error: BaseException) -> Exit:
    return next((row for row in EXITS if isinstance(error, row.errors)), UNEXPECTED)


def is_expected(error: BaseException) -> bool:
    """Return whether an error is caused by the user or the input, not by a fault of the program."""
    return isinstance(error, failures.BsmError) or exit_of(error) is not UNEXPECTED


def behind(error: BaseException) -> BaseException:
    """Return the signal that caused an error, if any; otherwise the error."""
    cause: BaseException | None = error
    # Libraries catch everything, KeyboardInterrupt included, and raise errors of their own from it.
    while cause is not None:
        if isinstance(cause, _SIGNALS):
            return cause
        cause = cause.__cause__ or cause.__context__
    return error


def report_error(
    error: BaseException,
    *,
    as_json: bool = False,
    options: frozenset[str] | None = None,
    advice: str = "",
) -> None:
    """Write an error to standard error, as a line of JSON if all lines are; `options` are those of the command."""
    if isinstance(error, BrokenPipeError):
        # The rest of the buffer has no reader; flushing it at exit would fail again.
        # Python's own advice for SIGPIPE. Without it the interpreter prints a second error when it ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return
    if isinstance(error, _SIGNALS):
        text = exit_of(error).meaning
    else:
        text = for_command(worded(error), options)
    if advice:
        text += f"; {advice}"
    if as_json:
        say(text, "error")
    else:
        say(f"bsm: {text}")


def worded(error: BaseException) -> str:
    if isinstance(error, OSError):
        reason, name = error.strerror or str(error), str(error.filename)
        # "No such file" is misleading for an output whose folder is missing.
        if reason == os.strerror(errno.ENOENT) and "://" not in name:
            folder = os.path.dirname(name)
            if folder and not os.path.isdir(folder):
                reason = f"the folder {folder} does not exist"
        if error.filename is None:
            return reason
        return f"{error.filename or repr('')}: {reason}"
    if isinstance(error, MemoryError):
        return f"not enough memory: {error}"
    return str(error)
