"""Runs, as they come, and the meshes that are kept for later ones; the twin of `codec.sequence.runs_encoding`."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from bsm.bitstream.container.header import Header
from bsm.bitstream.container.reader import Signal
from bsm.bitstream.errors import BsmError, CorruptError
from bsm.codec.sequence.course import Course, DecoderRequest
from bsm.codec.sequence.events import Item
from bsm.codec.sequence.gop_decoding import Gops
from bsm.codec.sequence.runs import Shelf
from bsm.codec.static.preamble_decoding import DecoderSetup, HeaderStage
from bsm.codec.static.stages import Arrival, Ended, Stage


@dataclass(frozen=True, eq=False)
class LostRun:
    """What is before the GOPs of a run cannot be decoded; the next run is waited for."""

    error: BsmError
    course: Course

    def accept(self, arrival: Arrival, queue: deque[Item]) -> Stage[Item]:
        if arrival is not Signal.END_OF_STREAM:
            return self
        if not self.course.given:
            raise self.error
        self.course.end(self.course.announced, queue)
        return Ended()


class Runs:
    """Runs come, one behind the other; each has a mesh of its own or one that an earlier run has had."""

    def __init__(self, setup: DecoderSetup, request: DecoderRequest, course: Course) -> None:
        self._setup = setup
        self._request = request
        self._course = course
        self._stage: Stage[Item] = HeaderStage(setup)
        self._shelf: Shelf[Gops] = Shelf(setup.allowance)
        self._mesh = 0  # the run that brought the present mesh

    def accept(self, arrival: Arrival, queue: deque[Item]) -> Stage[Item]:
        try:
            self._stage = self._turn(arrival, queue) if isinstance(arrival, Header) else self._next(arrival, queue)
        except BsmError as error:
            lost = isinstance(self._stage, LostRun) and not isinstance(arrival, Header)
            if not self._request.tolerant or lost or isinstance(self._stage, HeaderStage):
                raise
            self._course.lose(error)
            self._leave()
            self._stage = LostRun(error, self._course)
        return self._stage if isinstance(self._stage, Ended) else self

    def _next(self, arrival: Arrival, queue: deque[Item]) -> Stage[Item]:
        stage = self._stage.accept(arrival, queue)
        if isinstance(stage, Gops) and self._mesh not in self._shelf:
            self._shelf.put(self._mesh, stage)
        return stage

    def _turn(self, header: Header, queue: deque[Item]) -> Stage[Item]:
        """The stage of a run that begins."""
        self._leave()
        self._course.announced = header.frames
        self._mesh = header.run_number if header.again is None else header.again
        if header.again is None:
            self._shelf.make_room()
            self._request.attributes.clear()
            return HeaderStage(self._setup).accept(header, queue)
        gops = self._shelf.take(self._mesh)
        if gops is None:
            raise CorruptError(f"run {header.run_number} has the mesh of run {self._mesh}, which is not there any more")
        gops.resume(header, queue)
        return gops

    def _leave(self) -> None:
        if isinstance(self._stage, Gops):
            self._stage.suspend()
        self._shelf.leave(self._mesh)
