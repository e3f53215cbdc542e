"""A stream to the frames of a sequence, while it arrives."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.container.header import Header
from bsm.bitstream.container.reader import END_OF_STREAM, Signal
from bsm.bitstream.errors import BsmError, CorruptError, FormatError, MeshError, UnsupportedError, public
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.events import Course, DecoderRequest, Event, FrameEvent, Item
from bsm.codec.sequence.run_decoding import FirstFrameStage, GopStage
from bsm.codec.sequence.runs import Shelf
from bsm.codec.signal.chain import AS_SPECIFIED, Overrides
from bsm.codec.static.coding import chain_rules
from bsm.codec.static.events import ConnectivityEvent
from bsm.codec.static.preamble_decoding import DecoderSetup, HeaderStage
from bsm.codec.static.stages import Arrival, Ended, Stage, StreamDecoder
from bsm.codec.static.work import Allowance, run_cost
from bsm.codec.threads import threads_of


@public
class SequenceDecoder(StreamDecoder[Item]):
    """Takes the bytes of a sequence's stream as they come, and gives events as soon as they can be known.

    Memory is bounded by one GOP. An error is raised by `next_event` after the events before it, and by every later
    call.

    Parameters
    ----------
    limits : Limits
        What the stream may ask for.
    threads : int, optional
        None: one per core.
    tolerant : bool
        Report a GOP that is lost or broken as `LossEvent`, and go on behind it, or behind a run where what comes before
        its GOPs is not whole; the stream may begin with any run.
    start : int
        Give no frame before this one; GOPs that it does not need are not decoded.
    overrides : Overrides, optional
        What is tried in place of what the specification says; see `codec.signal.chain`.

    Examples
    --------
    >>> import bsm
    >>> with bsm.SequenceDecoder() as decoder, open("dance.bsm", "rb") as file:
    ...     sum(isinstance(event, bsm.FrameEvent) for event in decoder.events(file))
    6
    """

    def __init__(
        self,
        limits: Limits = DEFAULT_LIMITS,
        threads: int | None = None,
        *,
        tolerant: bool = False,
        start: int = 0,
        overrides: Overrides = AS_SPECIFIED,
    ) -> None:
        threads = threads_of(threads)
        self._attributes: list[Attribute] = []
        request = DecoderRequest(threads, tolerant, start, self._attributes)
        allowance, course = Allowance(limits), Course(tolerant=tolerant)
        setup = DecoderSetup(
            allowance,
            check=lambda header: check_header(header, limits),
            begin=lambda structure: FirstFrameStage(structure, request, course),
            overrides=overrides,
            threads=threads,
        )
        super().__init__(Runs(setup, request, course), allowance, tolerant=tolerant)

    @property
    def attributes(self) -> tuple[Attribute, ...]:
        """Attributes of all frames of the present run, that are whole; all of them when its first frame is."""
        return tuple(self._attributes)

    def close(self) -> None:
        """Give up what was not asked for."""
        self._queue.clear()

    def next_event(self) -> Event:
        """The next event, or `NEED_DATA`; `END_OF_STREAM` after `EndEvent` and `receive_eof`; raises a `BsmError`."""
        while self._queue or self._read():
            if not self._queue:
                continue
            item = self._queue[0]
            event = self._next_frame(item) if isinstance(item, Iterator) else item
            if not isinstance(event, FrameEvent):
                self._queue.popleft()
            if event is not None:
                return event
        return self._signal()

    def _next_frame(self, frames: Iterator[FrameEvent]) -> FrameEvent | None:
        try:
            return next(frames, None)
        except BsmError as error:
            raise self._fail(error) from None


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
        self._shelf: Shelf[GopStage] = Shelf(setup.allowance)
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
        if isinstance(stage, GopStage) and self._mesh not in self._shelf:
            self._shelf.put(self._mesh, stage)
        return stage

    def _turn(self, header: Header, queue: deque[Item]) -> Stage[Item]:
        """The stage of a run that begins."""
        self._leave()
        self._setup.allowance.spend(run_cost(mesh=header.again is None))
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
        if isinstance(self._stage, GopStage):
            self._stage.suspend()
        self._shelf.leave(self._mesh)


def check_header(header: Header, limits: Limits) -> None:
    """Raise what is wrong with the header of a sequence, or beyond `limits`, before anything is done for it."""
    if not header.gop_frames:
        raise FormatError("this is a static mesh and no sequence; decode it with bsm.decode or bsm.Decoder")
    if header.smoothing:
        raise UnsupportedError("smoothing of sequences is unknown to this decoder")
    chain_rules(header)
    limits.check("sequence_bytes", 8.0 * header.vertices * header.coefficients)


def decode_sequence(
    data: bytes, limits: Limits = DEFAULT_LIMITS, threads: int | None = None
) -> tuple[Positions, Faces]:
    """Decode a complete sequence."""
    frames: list[Positions] = []
    faces = np.zeros((0, 3), np.int32)
    vertices = 0
    with SequenceDecoder(limits, threads) as decoder:
        decoder.receive_data(data)
        decoder.receive_eof()
        while (event := decoder.next_event()) is not END_OF_STREAM:
            match event:
                case ConnectivityEvent(received, vertices=count):
                    if frames and not np.array_equal(faces, received):
                        raise MeshError(
                            f"the faces change at frame {len(frames)}: this is no array of frames; "
                            "bsm.decode_frames gives them one by one"
                        )
                    faces, vertices = received, count
                case FrameEvent(_, positions):
                    frames.append(positions)
    return np.array(frames).reshape(-1, vertices, 3), faces
