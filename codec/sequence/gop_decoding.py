"""GOPs of a run, as they come; the twin of `codec.sequence.gop_encoding`."""

from __future__ import annotations

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
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.cost import gop_cost, gop_memory, loop_memory
from bsm.codec.sequence.course import Course, DecoderRequest
from bsm.codec.sequence.events import FrameEvent, Item
from bsm.codec.sequence.gop import Frame, GopDecoder
from bsm.codec.sequence.moving import MovingAttribute
from bsm.codec.sequence.tracks import make_setting
from bsm.codec.static.events import HeaderEvent, unreadable
from bsm.codec.static.preamble_decoding import Structure
from bsm.codec.static.stages import Arrival, Ended, Stage, misplaced

Result = TypeVar("Result")


class Gops:
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

    def _frames(self, decoder: GopDecoder, body: GopBody, received: int) -> Iterator[Frame]:
        """`_decoded`, if that is allowed."""
        vertices, dictionaries = self._structure.header.vertices, decoder.setting.dictionaries
        again = dictionaries.reserve(
            gop_memory(vertices, body, dictionaries.sites), loop_memory(dictionaries.largest, body)
        )
        cost = gop_cost(dictionaries.sites, vertices, decoder.setting.given, body)
        self._structure.allowance.spend(again + cost, received)
        return self._decoded(decoder, body)

    def _decoded(self, decoder: GopDecoder, body: GopBody) -> Iterator[Frame]:
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

    def _events(self, first: int, frames: Iterator[Frame]) -> Iterator[FrameEvent]:
        numbering, units = self._structure.numbering, self._structure.units
        for index, (positions, *changes) in enumerate(frames, first):
            if index >= self._request.start:
                yield FrameEvent(
                    index, numbering.arranged(units.back(positions)), numbering.faces, self._shown(changes)
                )

    def _shown(self, changes: list[Matrix]) -> tuple[Attribute, ...]:
        """The attributes of a frame in which those that move differ so much from the first, shapes (n, d)."""
        moved = {one.declaration.name: (one, change) for one, change in zip(self._moving, changes, strict=True)}
        return tuple(
            moved[one.name][0].shown(one, moved[one.name][1]) if one.name in moved else one for one in self._attributes
        )

    def _lose(self, error: BsmError) -> None:
        self._course.lose(error)
        self._forget()

    def _forget(self) -> None:
        self._skipped.clear()
        if self._decoder is not None:
            self._decoder.forget()
