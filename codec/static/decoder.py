"""A stream to a mesh, block by block, while it arrives."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import TypeAlias

from bitstream.container import packets
from bitstream.container.header import Header
from bitstream.container.reader import END_OF_STREAM, Signal
from bitstream.errors import BsmError, CorruptError, UnsupportedError
from bitstream.limits import DEFAULT_LIMITS, Limits
from codec.geometry.mesh import TriangleMesh
from codec.signal.predict import MAX_STIFFNESS
from codec.static.assembly import Assembly, DecodedBlock
from codec.static.block_coder import ChainDecoder
from codec.static.events import BlockEvent, ConnectivityEvent, EndEvent, HeaderEvent, LossEvent, unreadable
from codec.static.preamble import Beginning, Body, Structure
from codec.static.rules import chain_rules
from codec.static.stages import Arrival, Ended, Stage, StreamDecoder, misplaced
from codec.static.work import Allowance, check_work
from codec.threads import Lanes, Pending

Event: TypeAlias = HeaderEvent | ConnectivityEvent | BlockEvent | LossEvent | EndEvent | Signal


@dataclass(frozen=True, eq=False)
class PendingBlock:
    """A block that is being decoded, and the assembly that it will become a part of."""

    pending: Pending[DecodedBlock]
    assembly: Assembly


@dataclass(frozen=True, eq=False)
class Complete(Ended):
    """All blocks are there, or known to be lost."""

    assembly: Assembly


Item: TypeAlias = Event | PendingBlock | Complete


class BlockStage:
    """The faces are known; blocks come."""

    def __init__(self, structure: Structure, lanes: Lanes, allowance: Allowance, tolerant: bool) -> None:
        self._scheme = structure.scheme
        self._lanes = lanes
        self._allowance = allowance
        self._tolerant = tolerant
        self._assembly = Assembly(
            structure.scheme.blocks, structure.header.smoothing, structure.units, structure.numbering
        )
        self._chain = ChainDecoder(self._scheme, 0, allowance)
        self._next = 0
        self._ended = False

    def accept(self, arrival: Arrival, queue: deque[Item]) -> Stage[Item]:
        match arrival:
            case packets.Block():
                self._skip_to(arrival.index, queue)
                self._decode(arrival, queue)
            case packets.Damaged():
                queue.append(LossEvent(None, unreadable(arrival)))
            case packets.End():
                self._end(queue)
            case Signal.END_OF_STREAM:
                if not self._ended:  # a tolerant reader may find no END
                    self._end(queue)
                return Complete(self._assembly)
            case _:
                raise misplaced(arrival)
        return self

    def _decode(self, packet: packets.Block, queue: deque[Item]) -> None:
        number = self._scheme.chain_of(packet.index)
        if number != self._chain.number:
            self._chain = ChainDecoder(self._scheme, number, self._allowance)
        chain = self._chain
        queue.append(PendingBlock(self._lanes.submit(number, lambda: chain.decode(packet)), self._assembly))
        self._next = packet.index + 1

    def _skip_to(self, index: int, queue: deque[Item]) -> None:
        """Give up the blocks before `index` that did not come."""
        for lost in range(self._next, index):
            error = CorruptError("the frame of the block is missing", block=lost)
            if not self._tolerant:
                raise error
            self._assembly.lose(lost)
            queue.append(LossEvent(lost, error))
        self._next = index

    def _end(self, queue: deque[Item]) -> None:
        self._skip_to(self._scheme.blocks.count, queue)
        self._ended = True
        queue.append(Complete(self._assembly))


class Decoder(StreamDecoder[Item]):
    """Takes the bytes of a stream as they come, and gives events as soon as they can be known.

    The events do not depend on how the bytes are cut up. An error is raised by `next_event` after the events before
    it, and by every later call.

    Parameters
    ----------
    limits : Limits
        What the stream may ask for.
    threads : int, optional
        For decoding chains whose bytes are there at the same time; None: one per core.
    tolerant : bool
        Report damage to blocks as `LossEvent` and go on with every block that does not depend on what is lost.
        Damage before the first block is raised all the same.
    """

    def __init__(self, limits: Limits = DEFAULT_LIMITS, threads: int | None = None, *, tolerant: bool = False) -> None:
        lanes, allowance = Lanes(threads), Allowance(limits)
        body = Body(
            limits,
            check=lambda header: check_header(header, limits),
            begin=lambda structure: BlockStage(structure, lanes, allowance, tolerant),
        )
        super().__init__(Beginning(body), limits, tolerant=tolerant)
        self._lanes = lanes

    def close(self) -> None:
        """Stop the threads; blocks that were not asked for are given up."""
        self._lanes.close()

    def next_event(self) -> Event:
        """The next event, or `NEED_DATA`; `END_OF_STREAM` after `EndEvent` and `receive_eof`.

        Raises
        ------
        BsmError
            One of the stream's errors, with its place.
        """
        match self._next_item():
            case PendingBlock() as block:
                return self._block_event(block)
            case Complete(assembly):
                return EndEvent(assembly.losses())
            case event:
                return event

    def finish(self) -> TriangleMesh:
        """Decode the rest of a complete stream and return the mesh; faster than asking for events.

        Raises
        ------
        BsmError
            Also `TruncatedError`, if bytes are missing.
        """
        self._reader.receive_eof()
        while (item := self._next_item()) is not END_OF_STREAM:
            if isinstance(item, PendingBlock):
                item.assembly.add(self._result(item))
        match self._stage:
            case Complete(assembly):
                return assembly.mesh()
            case _:
                raise misplaced(END_OF_STREAM)

    def _block_event(self, block: PendingBlock) -> BlockEvent | LossEvent:
        try:
            decoded = self._result(block)
        except BsmError as error:
            if not self._tolerant or error.block is None:
                raise
            block.assembly.lose(error.block)
            return LossEvent(error.block, error)
        try:
            return BlockEvent(decoded.index, block.assembly.changes(decoded))
        except BsmError as error:
            raise self._fail(error.located(block=decoded.index)) from None

    def _result(self, block: PendingBlock) -> DecodedBlock:
        try:
            return block.pending.result()
        except BsmError as error:
            if not self._tolerant:
                self._fail(error)
            raise

    def _next_item(self) -> Item:
        """Read every packet whose bytes are there, so that chains can be decoded side by side, and give the first."""
        while self._read():
            pass
        return self._queue.popleft() if self._queue else self._signal()


def check_header(header: Header, limits: Limits) -> None:
    """Raise what is wrong with the header of a static mesh, or beyond `limits`, before anything is done for it."""
    if header.gop_frames:
        raise UnsupportedError("this is a sequence; decode it with codec.SequenceDecoder")
    rules, width = chain_rules(header), max(header.coefficients, header.details)
    check_work(limits, header.blocks, header.block_size, width, rules.solves, exact=rules.exact)
    if len(header.prediction) > 1 or not all(0 < value < MAX_STIFFNESS for value in header.prediction):
        raise CorruptError(f"the prediction has the parameters {header.prediction}, one stiffness is legal")


def decode(data: bytes, limits: Limits = DEFAULT_LIMITS, threads: int | None = None) -> TriangleMesh:
    """Decode a complete stream.

    Raises
    ------
    BsmError
        `FormatError`, `UnsupportedError`, `CorruptError`, `TruncatedError`, `LimitError` or `NumericError`.
    """
    with Decoder(limits, threads) as decoder:
        decoder.receive_data(data)
        return decoder.finish()
