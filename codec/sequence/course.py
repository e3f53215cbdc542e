"""How far the decoding of a sequence has come."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from bsm.bitstream.errors import BsmError, CorruptError
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.events import Item
from bsm.codec.static.events import EndEvent, LossEvent


@dataclass(frozen=True)
class DecoderRequest:
    """What the user of a `SequenceDecoder` asks for; see its parameters."""

    threads: int | None
    tolerant: bool
    start: int
    attributes: list[Attribute]
    """Those that have come, for the user."""


class Course:
    """How far a sequence has come, over all of its runs."""

    def __init__(self, *, tolerant: bool) -> None:
        self.next = 0
        self.announced = 0
        self.lossy = False
        self._tolerant = tolerant
        self._lost = 0
        self._damage: BsmError | None = None  # the first since frames were lost

    @property
    def given(self) -> bool:
        return self.next > self._lost

    def lose(self, error: BsmError) -> None:
        """Take note that frames are lost; how many is known when the next ones come."""
        self._damage = self._damage or error.with_traceback(None)  # with which memory would stay

    def report_loss(self, frames: int, queue: deque[Item]) -> None:
        """Say that so many frames are lost, or raise that."""
        if not self._tolerant:
            raise CorruptError(f"{frames} frames from number {self.next} on are missing")
        error = self._damage or CorruptError("a GOP is missing")
        queue.append(LossEvent(None, error, range(self.next, self.next + frames)))
        self._damage = None
        self.next += frames
        self._lost += frames
        self.lossy = True

    def end(self, announced: int, queue: deque[Item]) -> None:
        """Say that nothing follows."""
        missing = announced - self.next if announced else 0
        if missing or (self._damage and not announced):
            self.report_loss(missing, queue)
        queue.append(EndEvent())
