"""What the commands say, and where: results to standard output, everything else to standard error."""

from __future__ import annotations

import importlib
import importlib.util
import json
import math
import os
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

_PATIENCE, _SECOND = 0.5, 1.0
_RUNNING = "{desc}: {elapsed}"  # of a line of which nobody knows how long it will be
_TYPICAL_ROUNDS = 6
_USUAL_SHAPE = (80, 24)


@dataclass(frozen=True)
class Console:
    quiet: bool = False
    kept: list[str] | None = None
    json: bool = False

    def note(self, text: str) -> None:
        text = printable(text)
        if self.kept is not None:
            self.kept.append(text)
        elif not self.quiet:
            say(text)

    def progress(self, what: str, unit: str = "blocks") -> Progress:
        told = not self.quiet and self.kept is None
        return Progress(what, unit, shown=told and sys.stderr.isatty() and not self.json, lines=told and self.json)


class Progress:
    """A line on the terminal, from half a second on: what goes on and for how long, and where that is known how much is
    done, with the time left; or lines of JSON that say the same to programs."""

    def __init__(self, what: str, unit: str, *, shown: bool, lines: bool = False) -> None:
        self._what = what
        self._unit = unit
        self._shown = shown
        self._lines = lines
        self._begun = self._said = time.monotonic()
        self._bar: Any = None
        self._round = 0
        self._last = 0
        self._over = threading.Event()
        self._opening = threading.Lock()
        self._clock: threading.Thread | None = None

    def __enter__(self) -> Progress:
        if self._shown:
            self._clock = threading.Thread(target=self._tick, daemon=True)
            self._clock.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        if self._clock is not None:
            self._clock.join()
        if self._bar is not None:
            self._bar.close()

    def stage(self, name: str) -> None:
        self._what, self._round, self._last = name, 0, 0
        if self._bar is not None:
            self._bar.total = None
            self._bar.bar_format = _RUNNING
            self._bar.set_description_str(name, refresh=True)

    def __call__(self, done: int, total: int) -> None:
        now = time.monotonic()
        if self._lines and now - self._said >= _SECOND:
            self._said, share = now, done / max(total, 1)
            left = (now - self._begun) * (1.0 - share) / share if share else None
            line = {"stage": self._what, "share": share, "seconds": now - self._begun, "seconds_left": left}
            print(json.dumps(line), file=sys.stderr, flush=True)
        if not self._shown or self._opened() is None:
            return
        self._bar.bar_format = None
        if done < self._last:
            self._round += 1
            self._bar.set_description_str(f"{self._what}, attempt {self._round + 1}", refresh=False)
        self._last = done
        self._bar.total = total * (max(_TYPICAL_ROUNDS, self._round + 1) if self._round else 1)
        self._bar.update(self._round * total + done - self._bar.n)

    def _opened(self) -> Any:
        """The bar; None where there is no library to draw it."""
        with self._opening:
            if self._bar is None and self._shown:
                # Not at the top: most runs are over before a bar would be seen.
                try:
                    widgets = in_notebook() and importlib.util.find_spec("ipywidgets") is not None
                    bars = importlib.import_module("tqdm.notebook" if widgets else "tqdm")
                except ImportError:  # A comfort that the core goes without.
                    self._shown = False
                    return None
                bars.tqdm.monitor_interval = 0
                more: dict[str, Any] = {"delay": _PATIENCE, "leave": False, "miniters": 0, "bar_format": _RUNNING}
                if not widgets:
                    more["ncols"], more["nrows"] = _shape()
                self._bar = bars.tqdm(desc=self._what, unit=f" {self._unit}", **more)
            return self._bar

    def _tick(self) -> None:
        """Draw anew each second, so that nobody takes silence for the end."""
        while not self._over.wait(_SECOND if self._bar is not None else _PATIENCE):
            if self._opened() is None:
                return
            self._bar.refresh()


def _shape() -> tuple[int, int]:
    """Columns and lines of the terminal; the usual ones where it knows none, and tqdm would draw nothing."""
    size = (0, 0)
    with suppress(OSError, ValueError):
        size = os.get_terminal_size(sys.stderr.fileno())
    return size[0] or _USUAL_SHAPE[0], size[1] or _USUAL_SHAPE[1]


def printable(text: str) -> str:
    """With escapes in place of what would make a terminal do something, or begin a line of its own."""
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


def as_json(value: Mapping[str, Any]) -> str:
    return json.dumps(value, indent=2, allow_nan=False)


def print_json(value: Mapping[str, Any]) -> None:
    print(as_json(value))


def in_notebook() -> bool:
    library = sys.modules.get("IPython")
    shell = library.get_ipython() if library else None
    return shell is not None and "IPKernelApp" in shell.config


def watched(what: str) -> Progress:
    """A bar for a function that takes long: in notebooks, where it goes away when the function is done."""
    return Progress(what, "blocks", shown=in_notebook())
