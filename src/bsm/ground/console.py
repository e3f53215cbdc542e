"""Output of the commands: results to standard output, everything else to standard error."""

import json
import math
import os
import re
import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from bsm.bitstream.errors import ArgumentError
from bsm.codec.progress import PARTS

# Work that ends within half a second shows no bar, which would only flash.
_PATIENCE, _SECOND = 0.5, 1.0
_OFTEN, _BAR = 0.1, 24  # seconds between two drawings, at least; and letters of a bar
_LEAST_LEFT, _MOST_SHARE = 1.0, 0.99  # shown before the end
# The clock of a bar writes from a thread of its own.
_writing = threading.Lock()
_bar = ""  # on the terminal, below all other lines


@dataclass(frozen=True)
class Console:
    quiet: bool = False
    kept: list[str] | None = None
    json: bool = False
    heard: Callable[[int, int], None] | None = None
    options: frozenset[str] | None = None  # of the command; texts advise no others
    _running: "list[Progress]" = field(default_factory=list, compare=False)

    def note(self, text: str) -> None:
        # Notes quote names from files. An escape sequence in one could rewrite the terminal.
        text = printable(for_command(text, self.options))
        if self.kept is not None:
            self.kept.append(text)
        elif not self.quiet:
            key = "note" if self.json else None
            say(text, key)

    @contextmanager
    def progress(self, what: str = "", until: float = 1.0) -> "Iterator[Progress]":
        """Report a job; within another job, report its part `until` a share of all time."""
        # Jobs inside of jobs report parts of one bar: two bars would fight for one line.
        if self._running:
            with self._running[0].part(what, until) as progress:
                yield progress
            return
        reports = not self.quiet and self.kept is None
        shown = reports and sys.stderr is not None and sys.stderr.isatty() and not self.json
        with Progress(what, shown=shown, lines=reports and self.json, heard=self.heard) as progress:
            self._running.append(progress)
            try:
                yield progress
            finally:
                self._running.pop()

    def stopped_by(self, error: BaseException) -> bool:
        """Whether an error came from the function that hears of progress."""
        return any(progress.stopped is error for progress in self._running)


class Progress:
    """A line on the terminal, lines of JSON, or calls of a function that say what goes on and how much is done."""

    def __init__(
        self,
        what: str,
        *,
        shown: bool = False,
        lines: bool = False,
        heard: Callable[[int, int], None] | None = None,
    ) -> None:
        # What goes on, and which share of the time it is, from the whole inwards.
        self._parts = [(what, 0.0, 1.0)]
        if heard is not None and not callable(heard):
            raise ArgumentError(f"progress must be a function, not {heard!r}")
        self._shown, self._lines, self._heard = shown, lines, heard
        self._begun = self._said_at = time.monotonic()
        # Programs that read lines get the first at once; people see no bar before it is worth one.
        if not lines:
            self._said_at += _PATIENCE - _OFTEN
        self._share, self._when = 0.0, 0.0  # as reported, and after how many seconds
        # Estimates may fall, and a bar that goes back looks like a fault.
        self._most = 0.0  # the largest share that was shown, which never falls
        self._reported = 0
        self.stopped: BaseException | None = None
        self._over = threading.Event()
        self._clock: threading.Thread | None = None

    def __enter__(self) -> "Progress":
        if self._shown or self._lines:
            self._clock = threading.Thread(target=self._tick, daemon=True)
            self._clock.start()
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        self._over.set()
        if self._clock is not None:
            self._clock.join()
        if self._shown:
            _write("")
        # Work that failed never reaches the whole.
        if kind is None:
            self._tell_listener(1.0)

    @contextmanager
    def part(self, what: str, until: float = 1.0) -> "Iterator[Progress]":
        """Report a part of the innermost part, up to a share of its time."""
        _, low, high = self._parts[-1]
        # A part may take more than was foreseen. The share must not fall because of that.
        end = max(low + until * (high - low), self._share)
        self._parts.append((what, self._share, end))
        try:
            yield self
        finally:
            self._parts.pop()
        self._at(end)

    def stage(self, name: str, share: float | None = None) -> None:
        """Name the stage that begins, and the work done before it, if known."""
        _, low, high = self._parts[-1]
        self._parts[-1] = name, low, high
        if share is not None:
            self._at(low + share * (high - low))

    def __call__(self, done: float, total: float) -> None:
        """Report how much of the innermost part is done."""
        _, low, high = self._parts[-1]
        self._at(low + (high - low) * done / max(total, 1))

    def _at(self, share: float) -> None:
        self._share, self._when = max(share, self._share), time.monotonic() - self._begun
        self._tell_listener(self._share)
        interval = _SECOND if self._lines else _OFTEN
        self._say(interval)

    def _tell_listener(self, share: float) -> None:
        """Tell a listener, to whom nothing goes back."""
        if self._heard is None or int(PARTS * share) <= self._reported:
            return
        self._reported = int(PARTS * share)
        try:
            self._heard(self._reported, PARTS)
        # A listener stops the work by an exception. It is kept, so that it can be told from an error of the work.
        except BaseException as error:
            self.stopped = error
            raise

    def _now(self) -> tuple[float, float, float | None]:
        """The share that is done, as far as time tells; seconds since the beginning, and to the end if known."""
        since = time.monotonic() - self._begun
        if not self._share:
            return 0.0, since, None
        # Since the last report work went on as before it, but hardly beyond the part that it was in.
        passed = (since - self._when) * self._share / (self._when or 1e-3)
        rest = max(self._parts[-1][2] - self._share, 1e-3)
        # The exponential nears the end of the part and never reaches it, however long the part takes.
        share = min(self._share + rest * (1.0 - math.exp(-passed / rest)), 1.0)
        left = since / share * (1.0 - share)
        self._most = max(self._most, min(share, _MOST_SHARE))
        return self._most, since, max(left, _LEAST_LEFT)

    def _say(self, interval: float) -> None:
        """Say what goes on, unless that was said less than so many seconds ago."""
        if not (self._shown or self._lines) or time.monotonic() - self._said_at < interval:
            return
        self._said_at = time.monotonic()
        share, since, left = self._now()
        what = ": ".join(what for what, _, _ in self._parts if what)
        if self._lines:
            _say_json({"stage": what, "share": share, "seconds": since, "seconds_left": left})
            return
        done = rest = ""
        if left is not None:
            done = f"{100 * share:3.0f}%|{'█' * int(_BAR * share):{_BAR}}| "
            rest = f"<{int(left) // 60:02d}:{int(left) % 60:02d}"
        # A line as wide as the terminal would wrap, and the next one could not be written over it.
        line = f"{printable(what)}: {done}{int(since) // 60:02d}:{int(since) % 60:02d}{rest}"
        _write("", line[: shutil.get_terminal_size().columns - 1])

    def _tick(self) -> None:
        """Say it again each second, so that silence does not look like the end."""
        interval = _SECOND / 2 if self._lines else 0.0
        # The clock ends at once when the work does, instead of at its next tick.
        while not self._over.wait(self._time_to_tick()):
            self._say(interval)

    def _time_to_tick(self) -> float:
        """Seconds from one tick of the clock to the next."""
        if time.monotonic() - self._begun < _PATIENCE:
            return _PATIENCE
        return max(_SECOND, 0.1)


_CLAUSES = re.compile(r"(; |\? |(?<=\w)\. )")
_OPTION = re.compile(r"(?<![\w/.-])--?[a-z][\w-]*")
# A clause that tells to run another command may name the options of that one.
# Their options are not those of this command.
_OTHER = re.compile(r"\b(?:bsm|pip|python|python3|cc) [a-z-]")


def for_command(text: str, options: frozenset[str] | None) -> str:
    """Return a text without the clauses that advise an option which the command does not have."""
    if options is None:
        return text
    first, *rest = _CLAUSES.split(text)
    pairs = zip(rest[::2], rest[1::2], strict=True)
    kept = [
        (mark, clause)
        for mark, clause in pairs
        if _OTHER.search(clause) or {*_OPTION.findall(clause)} <= options
    ]
    # The first clause is the error itself, and stays whatever it names.
    return first + "".join(mark + clause for mark, clause in kept)


def printable(text: str) -> str:
    """With escapes in place of what would make a terminal do something, or begin a line of its own."""
    return "".join(map(_escaped, text))


def _escaped(char: str) -> str:
    if char.isprintable():
        return char
    return char.encode("unicode_escape").decode()


def say(text: str, key: str | None = None) -> None:
    """Write a text to standard error, above any bar; with `key` as a line of JSON."""
    if key:
        _say_json({key: text})
        return
    _write("\n".join(map(printable, text.split("\n"))) + "\n", _bar)


def _write(text: str, bar: str = "") -> None:
    """Write a text in place of the bar on the terminal, and then another bar."""
    global _bar
    with _writing:
        wiped = ""
        if _bar:
            wiped = f"\r{' ' * len(_bar)}\r"
        _put(f"{wiped}{text}{bar}")
        _bar = bar


def _say_json(line: Mapping[str, Any]) -> None:
    """Write a line at once, since the clock of a bar writes, too."""
    _put(json.dumps(line) + "\n")


def _put(text: str) -> None:
    """Write to standard error, if it is open and has room: no result is lost for a note."""
    try:
        if sys.stderr is not None:
            print(text, end="", file=sys.stderr, flush=True)
    except (OSError, ValueError):
        # A full disk or a closed pipe would fail again with each further note.
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 - as long as the program runs


def finite(value: float) -> float | None:
    """A number for JSON, which has no infinity; equal meshes have no decibels."""
    if not math.isfinite(value):
        return None
    return value


def as_json(value: Mapping[str, Any]) -> str:
    return json.dumps(value, indent=2, allow_nan=False)


def print_json(value: Mapping[str, Any]) -> None:
    print(as_json(value))


def in_notebook() -> bool:
    # Not imported: a notebook has loaded it already.
    library = sys.modules.get("IPython")
    if not library:
        return False
    shell = library.get_ipython()
    return shell is not None and "IPKernelApp" in shell.config


def watched(what: str, heard: Callable[[int, int], None] | None = None) -> Progress:
    """A bar for a function that takes long, in notebooks, where it goes away when the function is done."""
    return Progress(what, shown=in_notebook(), heard=heard)
