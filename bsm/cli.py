"""The command line `bsm`."""

from __future__ import annotations

import argparse
import gc
import importlib
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from bitstream.errors import BsmError
from bsm.console import Console
from bsm.exits import exit_of, exit_table, is_expected

COMMANDS = {
    "encode": "compress a mesh",
    "decode": "restore a mesh",
    "info": "show what a stream holds",
    "compare": "measure the error of a mesh",
    "verify": "check a stream",
    "denoise": "remove noise from a mesh or a sequence",
    "noise": "add noise to a mesh",
    "demo": "compress a sample and show what became of it",
    "curve": "measure rate against error and draw it",
    "boundary": "measure the error at the boundaries of blocks",
    "bench": "measure speed against exact solvers and Draco",
    "figures": "measure the figures of the README again",
    "paper": "measure the tables and figures of the paper again",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; the return value is the exit code of the table in `bsm.exits`."""
    words = sys.argv[1:] if arguments is None else arguments
    subject = None
    try:
        args = _parser(words).parse_args(words)
        subject = getattr(args, "input", None)
        # Not at the top: it imports numba, and help should come at once.
        from bsm.compilation import announced_compilation

        console = Console(quiet=args.quiet)
        with announced_compilation(console.note):
            args.run(args, console)
        sys.stdout.flush()
    except (Exception, KeyboardInterrupt) as raised:
        error = _behind(raised)
        if not is_expected(error):
            raise
        _report(error, subject)
        return exit_of(error).code
    return 0


def _behind(error: BaseException) -> BaseException:
    """The Ctrl-C behind an error, if there is one: a compiler or a loader that it hits may raise something else."""
    cause: BaseException | None = error
    while cause is not None:
        if isinstance(cause, KeyboardInterrupt):
            return cause
        cause = cause.__cause__ or cause.__context__
    return error


def _report(error: BaseException, subject: str | None) -> None:
    """Say what went wrong, without a traceback."""
    if isinstance(error, BrokenPipeError):
        # Nobody reads what is left in the buffer; flushing it at exit would fail once more.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    elif isinstance(error, KeyboardInterrupt):
        _say("interrupted")
    elif isinstance(error, BsmError):
        _say(f"{subject}: {error}" if subject else str(error))
    elif isinstance(error, OSError):
        _say(f"{error.filename}: {error.strerror}" if error.filename else str(error.strerror or error))
    else:
        _say(f"not enough memory: {error}")


def _say(text: str) -> None:
    print(f"bsm: {text}", file=sys.stderr)


def _parser(words: Sequence[str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="bsm",
        description="Compress triangle meshes to a stream that is decoded block by block.",
        epilog=f"exit codes:\n{exit_table()}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("-f", "--force", action="store_true", help="overwrite files")
    common.add_argument("-q", "--quiet", action="store_true", help="say nothing but results and errors")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name, about in COMMANDS.items():
        command = commands.add_parser(name, parents=[common], help=about, description=f"{about.capitalize()}.")
        if name in words:
            # The others are not imported: most of the time to start goes into that.
            module = importlib.import_module(f"bsm.commands.{name}")
            module.add_arguments(command)
            command.set_defaults(run=module.run)
    return parser


def run() -> NoReturn:
    """Run as a program."""
    # Looking for cycles among the objects of all modules, while they load and again at the end, would take longer than
    # decoding a small mesh.
    gc.set_threshold(100_000)
    code = main()
    gc.freeze()
    sys.exit(code)


if __name__ == "__main__":
    run()
