"""Telling the user why the first run takes so long: numba compiles what no cache holds yet."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from numba.core import event

NOTICE = "compiling for this processor, which happens once and takes up to a minute"


class _Announcer(event.Listener):
    def __init__(self, note: Callable[[str], None]) -> None:
        self._note = note
        self._said = False

    def on_start(self, _: event.Event) -> None:
        if not self._said:
            self._said = True
            self._note(NOTICE)

    def on_end(self, _: event.Event) -> None:
        pass


@contextmanager
def announced_compilation(note: Callable[[str], None]) -> Iterator[None]:
    """Say `NOTICE`, once, if anything is compiled inside."""
    with event.install_listener("numba:compile", _Announcer(note)):
        yield
