"""The first frame of a run, as its packets come; the twin of `codec.sequence.first_frame_encoding`."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

from bsm.bitstream.container import packets
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import BsmError, CorruptError
from bsm.codec.blocks.overlap import Blend
from bsm.codec.sequence.course import Course, DecoderRequest
from bsm.codec.sequence.events import Item
from bsm.codec.sequence.gop_decoding import Gops
from bsm.codec.sequence.moving import MovingAttribute
from bsm.codec.static.attributes.decoding import AttributeDecoders, without_positions
from bsm.codec.static.events import AttributeEvent, LossEvent, unreadable
from bsm.codec.static.preamble_decoding import Structure
from bsm.codec.static.stages import Arrival, Stage
from bsm.codec.static.ways.block_coder import FRAME, ChainDecoder


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
        moving = tuple(self._moving())
        gops = Gops(self._structure, self._blend.all_positions(), moving, self._request, self._course)
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
