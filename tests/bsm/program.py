"""The program as a user runs it, in a process of its own."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def bsm(*arguments, **keywords):
    """What came of `bsm` with these words; bytes, or with `text=True` strings."""
    return subprocess.run(
        [sys.executable, "-m", "bsm", *map(str, arguments)],
        capture_output=True,
        timeout=120,
        cwd=ROOT,
        check=False,
        **keywords,
    )
