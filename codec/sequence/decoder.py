"""A stream to the frames of a sequence, while it arrives."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np

from bsm.bitstream.container import packets
from bsm.bitstream.container.gop import GopBody, GopMethod, parse_gop_body
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.reader import END_OF_STREAM, Signal
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import BsmError, CorruptError, FormatError, MeshError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.bitstream.public import public
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.blocks.blend import Blend
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.cost import gop_cost, gop_memory, loop_memory
from bsm.codec.sequence.gop import GopDecoder, make_setting
from bsm.codec.sequence.runs import Shelf
from bsm.codec.signal.chain import AS_SPECIFIED, Trial
from bsm.codec.static.attributes.decoding import AttributeDecoders, without_positions
from bsm.codec.static.events import AttributeEvent, ConnectivityEvent, EndEvent, HeaderEvent, LossEvent, unreadable
from bsm.codec.static.preamble_decoding import DecoderSetup, HeaderStage, Structure
from bsm.codec.static.rules import chain_rules
from bsm.codec.static.stages import Arrival, Ended, Stage, StreamDecoder, misplaced
from bsm.codec.static.ways.block_coder import FRAME, ChainDecoder
from bsm.codec.static.work import Allowance
from bsm.codec.threads import threads_of


@public
@dataclass(frozen=True, eq=False)
class FrameEvent:
    """A frame has been decoded.

    Parameters
    ----------
    index : int
        Its number, from 0.
    positions : float64 array, shape (n, 3)
        In the mesh's unit.
    faces : int32 array, shape (m, 3)
        Its faces; another array only where they may have changed.

    Examples
    --------
    >>> import bsm
    >>> with bsm.SequenceDecoder(start=2) as decoder, open("dance.bsm", "rb") as file:
    ...     decoder.receive_data(file.read())
    ...     decoder.receive_eof()
    ...     while (event := decoder.next_event()) is not bsm.END_OF_STREAM:
    ...         if isinstance(event, bsm.FrameEvent):
    ...             print(event.index, end=" ")
    2 3 4 5
    """

    index: int
    positions: Positions
    faces: Faces

    def __repr__(self) -> str:
        return f"FrameEvent(frame {self.index}, {len(self.positions)} vertices)"


Event: TypeAlias = HeaderEvent | ConnectivityEvent | AttributeEvent | FrameEvent | LossEvent | EndEvent | Signal
Item: TypeAlias = Event | Iterator[FrameEvent]
Result = TypeVar("Result")


@dataclass(frozen=True)
class DecoderRequest:
    """What the user of a `SequenceDecoder` asks for; see its parameters."""

    threads: int | None
    tolerant: bool
    start: int
    attributes: list[Attribute]
    """Those that have come, for the user."""


class FirstFrame:
    """The faces are known; blocks of a run's first frame come, which is coded as a static mesh is."""

    def __init__(self, structure: Structure, request: DecoderRequest, course: Course) -> None:
        self._structure = structure
        self._request = request
        self._course = course
        self._blend = Blend(structure.header.vertices)
        self._chain = ChainDecoder(structure.scheme, 0, structure.allowance)
        self._next = 0
        self._carried = AttributeDecoders(structure)

    def accept(self, arrival: Arrival, queue: deque[Item]) -> Stage[Item]:
        count = self._structure.scheme.blocks.count
        match arrival:
            case packets.Block():
                self._add(arrival)
                return self
            case packets.Values() if self._next == count:
                queue.append(self._values(arrival))
                return self
            case packets.Damaged() if self._next < count:
                raise unreadable(arrival)
            case packets.Damaged(type=FrameType.VALUES):
                queue.append(LossEvent(None, unreadable(arrival)))
                return self
        if self._next < count:
            raise CorruptError(f"the first frame ends after {self._next} of {count} blocks")
        gops = Gops(self._structure, self._blend.all_positions(), self._request, self._course)
        return gops.accept(arrival, queue)

    def _values(self, packet: packets.Values) -> AttributeEvent | LossEvent:
        try:
            event = self._carried.add(packet, without_positions)
        except BsmError as error:
            if not self._request.tolerant:
                raise
            return LossEvent(None, error)
        self._request.attributes[:] = self._carried.attributes(None)
        return event

    def _add(self, packet: packets.Block) -> None:
        """Decode the next block."""
        if packet.index != self._next:
            raise CorruptError(f"block {packet.index} of the first frame where block {self._next} belongs")
        self._structure.allowance.keep(0.0, len(packet.data) + FRAME)
        scheme = self._structure.scheme
        if scheme.chain_of(packet.index) != self._chain.number:
            self._chain = ChainDecoder(scheme, scheme.chain_of(packet.index), self._structure.allowance)
        decoded = self._chain.decode(packet)
        self._blend.add(decoded.vertices, decoded.positions, decoded.weights)
        self._next += 1


class Gops:
    """The first frame of a run is known, shape (n, 3), in BSM units; GOPs come, also of later runs of its mesh."""

    def __init__(self, structure: Structure, first_frame: Matrix, request: DecoderRequest, course: Course) -> None:
        self.header = structure.header
        self._structure = structure
        self._first_frame = first_frame
        self._request = request
        self._course = course
        self._attributes = tuple(request.attributes)
        self._decoder: GopDecoder | None = None  # made when a GOP is there, whose frames and bytes pay for it
        self._skipped: list[GopBody] = []  # low-delay frames since the latest key frame, not decoded

    def suspend(self) -> None:
        """Keep only what a later run of this mesh cannot do without."""
        self._forget()
        if self._decoder is not None:
            self._decoder.setting.dictionaries.release()

    def resume(self, header: Header, queue: deque[Item]) -> None:
        """Begin another run of this mesh.

        Raises
        ------
        CorruptError
            If its header speaks of another mesh.
        """
        own = self._structure.header
        if (header.vertices, header.faces) != (own.vertices, own.faces):
            raise CorruptError(f"run {header.run} has another mesh than the run that it names")
        self.header = header
        self._request.attributes[:] = self._attributes
        queue.append(HeaderEvent(header))
        queue.append(self._structure.numbering.event(own.vertices))

    def accept(self, arrival: Arrival, queue: deque[Item]) -> Stage[Item]:
        match arrival:
            case packets.Gop():
                self._accept_gop(arrival, queue)
            case packets.Damaged():
                if arrival.type is not FrameType.END or not self._course.lossy:
                    self._lose(unreadable(arrival))
            case packets.End():
                pass  # what may come behind it, damaged, is a loss that belongs before the end
            case Signal.END_OF_STREAM:
                self._course.end(self.header.frames, queue)
                return Ended()
            case _ if self._request.tolerant:
                self._lose(misplaced(arrival))
            case _:
                raise misplaced(arrival)
        return self

    def _accept_gop(self, packet: packets.Gop, queue: deque[Item]) -> None:
        if packet.index > self._course.next:
            self._course.report_loss(packet.index - self._course.next, queue)
            self._forget()
        body = self._tolerated(lambda: self._parsed(packet))
        if body is None:
            return
        decoder = self._paid_for(body, len(packet.data))
        frames = self._tolerated(lambda: self._frames(decoder, body, len(packet.data)))
        if frames is None:
            self._structure.allowance.show(-self._structure.header.vertices * body.frames)
            return
        queue.append(self._events(self._course.next, frames))
        self._course.next += body.frames

    def _parsed(self, packet: packets.Gop) -> GopBody:
        header, limits = self.header, self._structure.allowance.limits
        if packet.index < self._course.next:
            raise CorruptError(f"frame {packet.index} comes again behind frame {self._course.next - 1}")
        body = parse_gop_body(packet.data, header.gop_frames, header.run)
        limits.check("sequence_bytes", gop_memory(header.vertices, body))
        last = packet.index + body.frames - 1
        if 0 < header.frames <= last:
            raise CorruptError(f"frames {packet.index} to {last} of {header.frames}")
        return body

    def _tolerated(self, work: Callable[[], Result]) -> Result | None:
        """What `work` gives, or None if a loss is what it gives."""
        try:
            return work()
        except BsmError as error:
            if not self._request.tolerant:
                raise
            self._lose(error)
            return None

    def _paid_for(self, body: GopBody, received: int) -> GopDecoder:
        """The decoder, made when a GOP is there: it may do what the GOP's bytes and frames grant."""
        structure, header = self._structure, self._structure.header
        structure.allowance.keep(0.0, received)
        structure.allowance.show(header.vertices * body.frames)
        if self._decoder is None:
            setting = make_setting(
                structure.scheme,
                structure.faces,
                self._first_frame,
                width=header.coefficients,
                threads=self._request.threads,
                allowance=structure.allowance,
            )
            self._decoder = GopDecoder(setting)
        return self._decoder

    def _frames(self, decoder: GopDecoder, body: GopBody, received: int) -> Iterator[Matrix]:
        """`_decoded`, if that is allowed."""
        vertices, dictionaries = self._structure.header.vertices, decoder.setting.dictionaries
        again = dictionaries.reserve(gop_memory(vertices, body), loop_memory(dictionaries.largest, body))
        self._structure.allowance.spend(again + gop_cost(dictionaries.sites, vertices, body), received)
        return self._decoded(decoder, body)

    def _decoded(self, decoder: GopDecoder, body: GopBody) -> Iterator[Matrix]:
        """Frames of a GOP, or nothing of it where no frame of it is wanted and none that is depends on it."""
        if body.method is not GopMethod.NEXT_FRAME:
            self._skipped.clear()
        if self._course.next + body.frames <= self._request.start:
            if body.method >= GopMethod.KEY_FRAME:
                self._skipped.append(body)
            return iter(())
        for earlier in self._skipped:
            decoder.decode(earlier)
        self._skipped.clear()
        return decoder.decode(body)

    def _events(self, first: int, frames: Iterator[Matrix]) -> Iterator[FrameEvent]:
        numbering, units = self._structure.numbering, self._structure.units
        for index, frame in enumerate(frames, first):
            if index >= self._request.start:
                yield FrameEvent(index, numbering.arranged(units.back(frame)), numbering.faces)

    def _lose(self, error: BsmError) -> None:
        """Take note that frames are lost; how many is known when the next ones come."""
        self._course.lose(error)
        self._forget()

    def _forget(self) -> None:
        """No frame refers to one that has come."""
        self._skipped.clear()
        if self._decoder is not None:
            self._decoder.forget()


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
    """Runs come, one behind the other; each has a mesh of its own or one that an earlier run has had.

    Parameters
    ----------
    setup : DecoderSetup
        How the mesh of a run is read.
    request : DecoderRequest
    course : Course
    """

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
        self._mesh = header.again - 1 if header.again else header.run
        if not header.again:
            self._shelf.make_room()
            self._request.attributes.clear()
            return HeaderStage(self._setup).accept(header, queue)
        gops = self._shelf.take(self._mesh)
        if gops is None:
            raise CorruptError(f"run {header.run} has the mesh of run {self._mesh}, which is not there any more")
        gops.resume(header, queue)
        return gops

    def _leave(self) -> None:
        """Keep of the present run what later ones may need, and give back all else."""
        if isinstance(self._stage, Gops):
            self._stage.suspend()
        self._shelf.leave(self._mesh)


class Course:
    """How far a sequence has come, over all of its runs.

    Attributes
    ----------
    next : int
        The frame that comes next in the stream.
    announced : int
        How many there are in all; 0: the stream does not say.
    given : bool
        Whether any frame has come.
    lossy : bool
        Whether a loss was reported, so that an END that counts more frames is no news.
    """

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
    trial : Trial, optional
        What is tried in place of what the specification says; see `codec.signal.chain`.

    Examples
    --------
    >>> import bsm
    >>> with bsm.SequenceDecoder() as decoder, open("dance.bsm", "rb") as file:
    ...     decoder.receive_data(file.read())
    ...     decoder.receive_eof()
    ...     frames = 0
    ...     while (event := decoder.next_event()) is not bsm.END_OF_STREAM:
    ...         frames += isinstance(event, bsm.FrameEvent)
    >>> frames
    6
    """

    def __init__(
        self,
        limits: Limits = DEFAULT_LIMITS,
        threads: int | None = None,
        *,
        tolerant: bool = False,
        start: int = 0,
        trial: Trial = AS_SPECIFIED,
    ) -> None:
        threads = threads_of(threads)
        self._attributes: list[Attribute] = []
        request = DecoderRequest(threads, tolerant, start, self._attributes)
        allowance, course = Allowance(limits), Course(tolerant=tolerant)
        setup = DecoderSetup(
            allowance,
            check=lambda header: check_header(header, limits),
            begin=lambda structure: FirstFrame(structure, request, course),
            trial=trial,
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
        """The next event, or `NEED_DATA`; `END_OF_STREAM` after `EndEvent` and `receive_eof`.

        Raises
        ------
        BsmError
            One of the stream's errors, with its place.
        """
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


def check_header(header: Header, limits: Limits) -> None:
    """Raise what is wrong with the header of a sequence, or beyond `limits`, before anything is done for it."""
    if not header.gop_frames:
        raise FormatError("this is a static mesh and no sequence; decode it with bsm.decode or bsm.Decoder")
    if header.smoothing or header.details:
        raise UnsupportedError("smoothing and details of sequences are unknown to this decoder")
    chain_rules(header)
    limits.check("sequence_bytes", 8.0 * header.vertices * header.coefficients)


def decode_sequence(
    data: bytes, limits: Limits = DEFAULT_LIMITS, threads: int | None = None
) -> tuple[Positions, Faces]:
    """Decode a complete sequence.

    Returns
    -------
    positions : float64 array, shape (T, n, 3)
    faces : int32 array, shape (m, 3)

    Raises
    ------
    BsmError
        `FormatError`, `UnsupportedError`, `CorruptError`, `TruncatedError`, `LimitError` or `NumericError`; `MeshError`
        if the faces change.
    """
    frames: list[Positions] = []
    faces = np.zeros((0, 3), np.int32)
    vertices = 0
    with SequenceDecoder(limits, threads) as decoder:
        decoder.receive_data(data)
        decoder.receive_eof()
        while (event := decoder.next_event()) is not END_OF_STREAM:
            match event:
                case HeaderEvent(header):
                    vertices = header.vertices
                case ConnectivityEvent(received):
                    if frames and not np.array_equal(faces, received):
                        raise MeshError(
                            f"the faces change at frame {len(frames)}: this is no array of frames; "
                            "bsm.decode_frames gives them one by one"
                        )
                    faces = received
                case FrameEvent(_, positions):
                    frames.append(positions)
    return np.array(frames).reshape(-1, vertices, 3), faces
