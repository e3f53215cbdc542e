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
_KNOWN, _NEARLY = "{desc}: {percentage:3.0f}%|{bar}| {elapsed}<LEFT", 0.99
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
            say(text, "note" if self.json else None)

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
        self._share, self._whole, self._seen = 0.0, 0.0, 0.0  # for certain; all, in seconds, 0: unknown; what is shown
        self._bar: Any = None
        self._round = 0
        self._last = 0
        self._over = threading.Event()
        self._opening = threading.Lock()
        self._clock: threading.Thread | None = None

    def __enter__(self) -> Progress:
        if self._shown or self._lines:
            self._clock = threading.Thread(target=self._tick, daemon=True)
            self._clock.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        if self._clock is not None:
            self._clock.join()
        if self._bar is not None:
            self._bar.clear()  # which closing alone leaves out where nothing but refreshes have drawn it
            self._bar.close()

    def stage(self, name: str, share: float = 0.0) -> None:
        """Name what begins; what is done before it, if that is known."""
        self._what, self._round, self._last = name, 0, 0
        self._at(share)
        if self._bar is not None:
            self._draw(name)

    def __call__(self, done: int, total: int) -> None:
        self._round += done < self._last
        self._last = done
        rounds = max(_TYPICAL_ROUNDS, self._round + 1) if self._round else 1
        self._at((self._round + done / max(total, 1)) / rounds)
        if self._lines and time.monotonic() - self._said >= _SECOND:
            self._tell()
        if self._shown and time.monotonic() - self._begun >= _PATIENCE and self._opened() is not None:
            self._draw(f"{self._what}, attempt {self._round + 1}" if self._round else self._what)

    def _at(self, share: float) -> None:
        if share > 0.0:
            self._share, self._whole = share, (time.monotonic() - self._begun) / share

    def _now(self) -> tuple[float, float, float | None]:
        """The share that is done, as far as time tells; seconds since the beginning, and to the end if known."""
        since = time.monotonic() - self._begun
        if not self._whole:
            return self._share, since, None
        self._seen = max(self._seen, self._share, min(since / self._whole, _NEARLY))  # and never goes back
        return self._seen, since, self._whole * (1.0 - self._seen)

    def _tell(self) -> None:
        self._said = time.monotonic()
        share, since, left = self._now()
        line = {"stage": self._what, "share": share, "seconds": since, "seconds_left": left}
        print(json.dumps(line), file=sys.stderr, flush=True)

    def _draw(self, what: str = "") -> None:
        share, _, left = self._now()
        if what:
            self._bar.set_description_str(what, refresh=False)
        if left is not None:
            self._bar.total, self._bar.n = 100, int(100 * share)
            self._bar.bar_format = _KNOWN.replace("LEFT", f"{int(left) // 60:02d}:{int(left) % 60:02d}")
        self._bar.refresh()

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
                    # The usual columns and lines where the terminal knows none, and tqdm would draw nothing.
                    size = (0, 0)
                    with suppress(OSError, ValueError):
                        size = os.get_terminal_size(sys.stderr.fileno())
                    more["ncols"], more["nrows"] = size[0] or _USUAL_SHAPE[0], size[1] or _USUAL_SHAPE[1]
                self._bar = bars.tqdm(desc=self._what, unit=f" {self._unit}", **more)
            return self._bar

    def _tick(self) -> None:
        """Draw and tell anew each second, so that nobody takes silence for the end."""
        while not self._over.wait(_PATIENCE if time.monotonic() - self._begun < _PATIENCE else max(_SECOND, 0.1)):
            if self._lines and time.monotonic() - self._said >= _SECOND / 2:
                self._tell()
            if self._shown and self._opened() is not None:
                self._draw()


def printable(text: str) -> str:
    """With escapes in place of what would make a terminal do something, or begin a line of its own."""
    return "".join(char if char.isprintable() else char.encode("unicode_escape").decode() for char in text)


def say(text: str, key: str | None = None) -> None:
    """Write a text to standard error, above any bar; with `key` as a line of JSON."""
    if key:
        print(json.dumps({key: text}), file=sys.stderr, flush=True)
        return
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
