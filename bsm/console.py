"""What the commands say, and where: results to standard output, everything else to standard error."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

_PATIENCE = 0.5
_BAR = 30


@dataclass(frozen=True)
class Console:
    """Speaks to the user.

    Parameters
    ----------
    quiet : bool
        Say nothing but results and errors.
    """

    quiet: bool = False

    def note(self, text: str) -> None:
        """Say something by the way."""
        if not self.quiet:
            print(text, file=sys.stderr)

    def progress(self, what: str) -> Progress:
        """A bar for work that may take long."""
        return Progress(what, shown=not self.quiet and sys.stderr.isatty())


class Progress:
    """A bar on the terminal, from half a second on; call it with how much is done of how much.

    It is erased at the end of the `with` block.
    """

    def __init__(self, what: str, *, shown: bool) -> None:
        self._what = what
        self._shown = shown
        self._next = time.monotonic() + _PATIENCE
        self._drawn = False

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._drawn:
            print("\r\033[K", end="", file=sys.stderr, flush=True)

    def __call__(self, done: int, total: int) -> None:
        now = time.monotonic()
        if not self._shown or now < self._next:
            return
        self._next = now + 0.1
        self._drawn = True
        filled = _BAR * done // max(total, 1)
        bar = "#" * filled + "-" * (_BAR - filled)
        print(f"\r{self._what} [{bar}] {done}/{total}", end="", file=sys.stderr, flush=True)


def print_json(value: Mapping[str, Any]) -> None:
    """Print a result for machines."""
    print(json.dumps(value, indent=2, allow_nan=False))
