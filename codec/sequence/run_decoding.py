"""A run: its first frame, and its GOPs as they come; the twin of `codec.sequence.run_encoding`."""

from collections import deque
from collections.abc import Callable, Iterator
from typing import TypeVar

from bsm.bitstream.container import packets
from bsm.bitstream.container.gop import GopBody, parse_gop_body
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.reader import Signal
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import BsmError, CorruptError
from bsm.codec.arrays import Matrix
from bsm.codec.blocks.overlap import Blend
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.attributes import MovingAttribute
from bsm.codec.sequence.events import Course, DecoderRequest, FrameEvent, Item
from bsm.codec.sequence.gop import Fields, GopDecoder
from bsm.codec.sequence.tracks import gop_memory, make_setting
from bsm.codec.static.attributes.decoding import AttributeDecoders, without_positions
from bsm.codec.static.events import AttributeEvent, HeaderEvent, LossEvent, unreadable
from bsm.codec.static.preamble_decoding import Structure
from bsm.codec.static.stages import Arrival, Ended, Stage, misplaced
from bsm.codec.static.units import checksum_of
from bsm.codec.static.ways.block_coder import FRAME, ChainDecoder

Result = TypeVar("Result")


class FirstFrameStage:
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
        moving = tuple(self._moving())
        gops = GopStage(self._structure, self._blend.all_positions(), moving, self._request, self._course)
        return gops.accept(arrival, queue)

    def _values(self, packet: packets.Values) -> AttributeEvent | LossEvent:
        try:
            event = self._carried.add(packet, without_positions)
        except BsmError as error:
            if not self._request.tolerant:
                raise
            return LossEvent(None, error)
        if (whole := self._carried.attribute(packet.attribute)) is not None:
            self._request.attributes.append(whole)
        return event

    def _moving(self) -> Iterator[MovingAttribute]:
        for number, declaration, first, rows in self._carried.moving():
            if declaration.rows != self._structure.header.vertices:
                raise CorruptError(f"attribute {declaration.name!r} moves, and what no face uses has values of it")
            if first is None and not self._request.tolerant:
                raise CorruptError(f"attribute {declaration.name!r} moves, and not all of its first values have come")
            yield MovingAttribute(number, declaration, first, rows)

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


class GopStage:
    """The first frame of a run is known, shape (n, 3), in BSM units; GOPs come, also of later runs of its mesh."""

    def __init__(
        self,
        structure: Structure,
        first_frame: Matrix,
        moving: tuple[MovingAttribute, ...],
        request: DecoderRequest,
        course: Course,
    ) -> None:
        self.header = structure.header
        self._structure = structure
        self._first_frame = first_frame
        self._moving = moving
        self._request = request
        self._course = course
        self._attributes = tuple(request.attributes)
        self._decoder: GopDecoder | None = None  # made when a GOP is there, whose frames and bytes pay for it
        self._skipped: list[GopBody] = []  # since the latest that needs none before it, not decoded

    def suspend(self) -> None:
        """Keep only what a later run of this mesh cannot do without."""
        self._forget()
        if self._decoder is not None:
            self._decoder.setting.dictionaries.release()

    def resume(self, header: Header, queue: deque[Item]) -> None:
        """Begin another run of this mesh."""
        own = self._structure.header
        if (header.vertices, header.faces) != (own.vertices, own.faces):
            raise CorruptError(f"run {header.run_number} has another mesh than the run that it names")
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
            case packets.End():  # what may come behind it, damaged, is a loss that belongs before the end
                self._course.expected = None if self._request.start else arrival.positions
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
        widths = {one.number: one.width for one in self._moving}
        tolerant = self._request.tolerant
        body = parse_gop_body(packet.data, header.gop_frames, header.run_number, widths, tolerant=tolerant)
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
                given=structure.numbering.size(header.vertices),
                width=header.coefficients,
                threads=self._request.threads,
                allowance=structure.allowance,
                moving=[one.start for one in self._moving],
            )
            self._decoder = GopDecoder(setting)
        return self._decoder

    def _frames(self, decoder: GopDecoder, body: GopBody, received: int) -> Iterator[Fields]:
        """`_decoded`, if that is allowed."""
        self._structure.allowance.spend(decoder.setting.reserve(body), received)
        return self._decoded(decoder, body)

    def _decoded(self, decoder: GopDecoder, body: GopBody) -> Iterator[Fields]:
        """Frames of a GOP, or nothing of it where no frame of it is wanted and none that is depends on it."""
        if body.method.begins:
            self._skipped.clear()
        if self._course.next + body.frames <= self._request.start:
            self._skipped.append(body)
            return iter(())
        for earlier in self._skipped:
            decoder.decode(earlier)
        self._skipped.clear()
        return decoder.decode(body)

    def _events(self, first: int, frames: Iterator[Fields]) -> Iterator[FrameEvent]:
        numbering, units = self._structure.numbering, self._structure.units
        for index, (coded, *changes) in enumerate(frames, first):
            if index >= self._request.start:
                positions = units.back(coded)
                self._course.positions = checksum_of(positions, self._course.positions)
                yield FrameEvent(index, numbering.arranged(positions), numbering.faces, self._in_frame(changes))

    def _in_frame(self, changes: list[Matrix]) -> tuple[Attribute, ...]:
        """The attributes of a frame in which those that move differ so much from the first, shapes (n, d)."""
        moved = {one.declaration.name: (one, change) for one, change in zip(self._moving, changes, strict=True)}
        return tuple(
            moved[one.name][0].in_frame(one, moved[one.name][1]) if one.name in moved else one
            for one in self._attributes
        )

    def _lose(self, error: BsmError) -> None:
        self._course.lose(error)
        self._forget()

    def _forget(self) -> None:
        self._skipped.clear()
        if self._decoder is not None:
            self._decoder.forget()
