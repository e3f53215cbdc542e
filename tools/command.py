"""Tools of the repository fail as `bsm` does: with a line and an exit code, without a traceback."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable

from bsm.console import Console
from bsm.exits import behind, exit_of, is_expected, tell


def run_command(parser: argparse.ArgumentParser, work: Callable[[argparse.Namespace, Console], None]) -> None:
    """Parse, work, and exit."""
    try:
        work(parser.parse_args(), Console())
    except (Exception, KeyboardInterrupt) as raised:
        error = behind(raised)
        if not is_expected(error):
            raise
        tell(error)
        sys.exit(exit_of(error).code)
