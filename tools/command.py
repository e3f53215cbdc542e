"""Tools of the repository fail as `bsm` does: with a line and an exit code, without a traceback."""

import argparse
import importlib
import sys
from collections.abc import Callable, Mapping

from bsm.ground.console import Console
from bsm.ground.exits import behind, exit_of, is_expected, report_error


def parser_of(words: str | None) -> argparse.ArgumentParser:
    """A parser whose help begins with these words, as they are."""
    return argparse.ArgumentParser(
        description=words, formatter_class=argparse.RawDescriptionHelpFormatter
    )


def run_command(
    parser: argparse.ArgumentParser, work: Callable[[argparse.Namespace, Console], None]
) -> None:
    """Parse, work, and exit."""
    try:
        work(parser.parse_args(), Console())
    except (Exception, KeyboardInterrupt) as raised:
        error = behind(raised)
        if not is_expected(error):
            raise
        report_error(error)
        sys.exit(exit_of(error).code)


def dispatch(package: str, commands: Mapping[str, str], words: str | None) -> None:
    """Do what the first argument asks for by one of `commands`, each a module and a function; or print `words`."""
    what = sys.argv[1] if len(sys.argv) > 1 else "--help"
    if what not in commands:
        print(words)
        sys.exit(0 if what in ("-h", "--help") else 2)
    sys.argv[:2] = [f"python -m {package} {what}"]
    module, function = commands[what].split(":")
    sys.exit(getattr(importlib.import_module(f"{package}.{module}"), function)())
