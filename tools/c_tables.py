"""Tables of integers as C files that are committed: how they look, and the command that writes or checks one."""

from __future__ import annotations

import argparse
import sys
import textwrap
from collections.abc import Sequence
from pathlib import Path

WIDTH = 120


def rows(table: Sequence[int]) -> str:
    """The entries of a table, as they stand between the braces of C."""
    return textwrap.indent(textwrap.fill(", ".join(map(str, table)) + ",", WIDTH - 4), "    ") + "\n"


def write_or_check(path: Path, source: str, module: str, about: str) -> int:
    """Write a file, or with --check see that it is up to date; the exit code."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if the file is not up to date")
    if not parser.parse_args().check:
        path.write_text(source)
    elif path.read_text() != source:
        print(f"{path} is not what python -m {module} writes", file=sys.stderr)
        return 1
    return 0
