"""What the commands say, and where: results to standard output, everything else to standard error."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

_PATIENCE = 0.5
_TYPICAL_ROUNDS = 6


@dataclass(frozen=True)
class Console:
    """Speaks to the user.

    Parameters
    ----------
    quiet : bool
        Say nothing but results and errors.
    kept : list of str, optional
        Takes what is said, instead of the terminal: somebody else will say it.
    """

    quiet: bool = False
    kept: list[str] | None = None

    def note(self, text: str) -> None:
        """Say something by the way, in one line."""
        text = printable(text)
        if self.kept is not None:
            self.kept.append(text)
        elif not self.quiet:
            say(text)

    def progress(self, what: str, unit: str = "blocks") -> Progress:
        """A bar for work that may take long."""
        return Progress(what, unit, shown=not self.quiet and self.kept is None and sys.stderr.isatty())


class Progress:
    """A bar on the terminal, from half a second on, with the time left; call it with how much is done of how much.

    Work that begins anew, as a search does with each step that it tries, goes on in the same bar, which then shows how
    far a search of usual length would be. The bar is erased at the end of the `with` block.
    """

    def __init__(self, what: str, unit: str, *, shown: bool) -> None:
        self._what = what
        self._unit = unit
        self._shown = shown
        self._bar: Any = None
        self._round = 0
        self._last = 0

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def __call__(self, done: int, total: int) -> None:
        if not self._shown:
            return
        if self._bar is None:
            # Not at the top: most runs are over before a bar would be seen.
            try:
                from tqdm import tqdm
            except ImportError:  # A comfort that the core goes without.
                self._shown = False
                return
            tqdm.monitor_interval = 0
            self._bar = tqdm(
                desc=self._what, unit=f" {self._unit}", total=total, delay=_PATIENCE, leave=False, miniters=0
            )
        if done < self._last:
            self._round += 1
            self._bar.set_description(f"{self._what}, attempt {self._round + 1}", refresh=False)
        self._last = done
        if self._round:
            self._bar.total = total * max(_TYPICAL_ROUNDS, self._round + 1)
        self._bar.update(self._round * total + done - self._bar.n)


def printable(text: str) -> str:
    """With escapes in place of what would make a terminal do something, or begin a line of its own.

    Names and texts in files are those of strangers.
    """
    return "".join(char if char.isprintable() else char.encode("unicode_escape").decode() for char in text)


def say(text: str) -> None:
    """Write a text to standard error, above any bar."""
    text = "\n".join(map(printable, text.split("\n")))
    bars = sys.modules.get("tqdm")
    if bars is None:
        print(text, file=sys.stderr)
    else:
        bars.tqdm.write(text, file=sys.stderr)


def finite(value: float) -> float | None:
    """A number for JSON, which has no infinity; equal meshes have no decibels."""
    return value if math.isfinite(value) else None


def print_json(value: Mapping[str, Any]) -> None:
    """Print a result for machines."""
    print(json.dumps(value, indent=2, allow_nan=False))
