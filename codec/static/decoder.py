"""A stream to a mesh, block by block, while it arrives."""

from collections import deque
from dataclasses import dataclass, replace
from numbers import Integral
from typing import TypeAlias, TypeVar

from bsm.bitstream.container import packets
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.reader import END_OF_STREAM, Signal
from bsm.bitstream.errors import ArgumentError, BsmError, CorruptError, OptionError, UnsupportedError, public
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.signal.chain import AS_SPECIFIED, Overrides
from bsm.codec.static.assembly import Assembly, DecodedBlock
from bsm.codec.static.attributes.decoding import BodyStage, Complete, PendingValues
from bsm.codec.static.coding import chain_rules
from bsm.codec.static.events import (
    AttributeEvent,
    BlockEvent,
    ConnectivityEvent,
    EndEvent,
    HeaderEvent,
    LossEvent,
    RefinementEvent,
)
from bsm.codec.static.preamble_decoding import DecoderSetup, HeaderStage, Structure
from bsm.codec.static.stages import Arrival, Stage, StreamDecoder, misplaced
from bsm.codec.static.ways.block_coder import ChainDecoder
from bsm.codec.static.ways.grid import GridStage
from bsm.codec.static.ways.refinement import PendingLevels, RefinementStage
from bsm.codec.static.work import Allowance
from bsm.codec.threads import Lanes, Pending

Result = TypeVar("Result")
ROWS_AHEAD = 1 << 16
"""Rows of blocks, besides one for each vertex, that may wait to be asked for: what is decoded has to be kept."""

Event: TypeAlias = (
    HeaderEvent | ConnectivityEvent | BlockEvent | RefinementEvent | AttributeEvent | LossEvent | EndEvent | Signal
)


@dataclass(frozen=True, eq=False)
class PendingBlock:
    """A block that is being decoded, and the assembly that it will become a part of."""

    pending: Pending[DecodedBlock]
    assembly: Assembly


Item: TypeAlias = Event | PendingBlock | PendingLevels | PendingValues | Complete


@dataclass(frozen=True)
class DecoderRequest:
    """What the user of a `Decoder` asks for; see its parameters."""

    tolerant: bool
    refined: bool


class BlockStage(BodyStage):
    """The faces are known; blocks come."""

    def __init__(self, structure: Structure, request: DecoderRequest, lanes: Lanes) -> None:
        self._structure = structure
        self._request = request
        self._scheme = structure.scheme
        self._lanes = lanes
        self._blocks = structure.header.blocks
        self._assembly = Assembly(
            structure.scheme.blocks,
            structure.header.smoothing,
            structure.units,
            structure.numbering,
            structure.allowance.spend,
        )
        self._chain = ChainDecoder(self._scheme, 0, structure.allowance)
        self._next = 0
        super().__init__(self._assembly, structure, request.tolerant)

    def accept(self, arrival: Arrival, queue: deque[Item]) -> Stage[Item]:
        match arrival:
            case packets.Block():
                self._skip_to(arrival.index, queue)
                self._decode(arrival, queue)
                if self._next == self._blocks and self._structure.header.refinement and not self._request.refined:
                    return self._end(queue)
                return self
            case packets.Refinement():
                self._give_up(queue)
                if not self._request.refined:
                    return self._end(queue)
                refinement = RefinementStage(self._assembly, self._structure, self._lanes, self._request.tolerant)
                return refinement.accept(arrival, queue)
        return super().accept(arrival, queue)

    def _decode(self, packet: packets.Block, queue: deque[Item]) -> None:
        number = self._scheme.chain_of(packet.index)
        if number != self._chain.number:
            self._chain = ChainDecoder(self._scheme, number, self._structure.allowance)
        chain = self._chain
        queue.append(PendingBlock(self._lanes.submit(number, lambda: chain.decode(packet)), self._assembly))
        self._next = packet.index + 1

    def _skip_to(self, index: int, queue: deque[Item]) -> None:
        """Give up the blocks before `index` that did not come."""
        for lost in range(self._next, index):
            error = CorruptError("the frame of the block is missing", block=lost)
            if not self._request.tolerant:
                raise error
            self._assembly.lose(lost)
            queue.append(LossEvent(lost, error))
        self._next = index

    def _give_up(self, queue: deque[Item]) -> None:
        self._skip_to(self._blocks, queue)


@public
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
    layers : int, optional
        How many to decode: 1 is the base alone, 2 or None the layer of refinement, too. What comes behind them is not
        waited for.
    overrides : Overrides, optional
        What is tried in place of what the specification says; see `codec.signal.chain`.

    Examples
    --------
    >>> import bsm
    >>> with bsm.Decoder() as decoder, open("bunny.bsm", "rb") as file:
    ...     for event in decoder.events(iter(lambda: file.read(1000), b"")):
    ...         if isinstance(event, bsm.BlockEvent):
    ...             moved = event.vertices, event.positions
    """

    def __init__(
        self,
        limits: Limits = DEFAULT_LIMITS,
        threads: int | None = None,
        *,
        tolerant: bool = False,
        layers: int | None = None,
        overrides: Overrides = AS_SPECIFIED,
    ) -> None:
        if layers is not None and (isinstance(layers, bool) or not isinstance(layers, Integral)):
            raise ArgumentError(f"layers must be a whole number or None, not {layers!r}")
        if layers is not None and layers < 1:
            raise OptionError("at least one layer must be decoded")
        lanes = Lanes(threads)
        self._most_ahead = 1
        request = DecoderRequest(tolerant, layers is None or layers > 1)

        def begin(structure: Structure) -> Stage[Item]:
            if structure.header.grid:
                return GridStage(structure, tolerant)
            self._most_ahead = most_ahead(structure.graph.size, structure.header.block_size)
            return BlockStage(structure, request, lanes)

        allowance = Allowance(limits)
        setup = DecoderSetup(
            allowance,
            check=lambda header: check_header(header, limits),
            begin=begin,
            tolerant=tolerant,
            overrides=overrides,
            threads=threads,
        )
        super().__init__(HeaderStage(setup), allowance, tolerant=tolerant)
        self._lanes = lanes

    def close(self) -> None:
        """Stop the threads; blocks that were not asked for are given up."""
        self._lanes.close()

    def next_event(self) -> Event:
        """The next event, or `NEED_DATA`; `END_OF_STREAM` after `EndEvent` and `receive_eof`; raises a `BsmError`."""
        match self._next_item():
            case PendingBlock() as block:
                return self._block_event(block)
            case PendingLevels() as levels:
                return self._refinement_event(levels)
            case PendingValues() as values:
                return self._attribute_event(values)
            case Complete() as complete:
                return self._end_event(complete)
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
            match item:
                case PendingBlock(pending, assembly):
                    assembly.add(self._result(pending))
                case PendingLevels(levels, refined):
                    refined.add(*self._result(levels))
                case PendingValues() as values:
                    self._attribute_event(values)
        match self._stage:
            case Complete() as complete:
                mesh = complete.mesh()
                return replace(mesh, metadata=self.metadata) if self.metadata else mesh
            case _:
                raise misplaced(END_OF_STREAM)

    def _end_event(self, complete: Complete) -> EndEvent | LossEvent:
        end = EndEvent(complete.whole.losses())
        if complete.checksum is None:
            return end
        try:
            complete.whole.mesh(complete.checksum)
        except BsmError as error:
            if not self._tolerant:
                raise self._fail(error) from None
            self._queue.append(end)
            return LossEvent(None, error)
        return end

    def _block_event(self, block: PendingBlock) -> BlockEvent | LossEvent:
        try:
            decoded = self._result(block.pending)
        except BsmError as error:
            if not self._tolerant or error.block is None:
                raise
            block.assembly.lose(error.block)
            return LossEvent(error.block, error)
        try:
            return BlockEvent(decoded.index, block.assembly.changes(decoded))
        except BsmError as error:
            raise self._fail(error.located(block=decoded.index)) from None

    def _refinement_event(self, levels: PendingLevels) -> RefinementEvent | LossEvent:
        try:
            vertices, values = self._result(levels.pending)
        except BsmError as error:
            if not self._tolerant:
                raise
            levels.refined.lose()
            return LossEvent(None, error)
        try:
            return levels.refined.event(levels.refined.add(vertices, values))
        except BsmError as error:
            raise self._fail(error) from None

    def _attribute_event(self, values: PendingValues) -> AttributeEvent | LossEvent:
        try:
            return values.attributed.add(values.packet)
        except BsmError as error:
            if not self._tolerant:
                raise self._fail(error) from None
            return LossEvent(None, error)

    def _result(self, pending: Pending[Result]) -> Result:
        try:
            return pending.result()
        except BsmError as error:
            if not self._tolerant:
                self._fail(error)
            raise

    def _next_item(self) -> Item:
        while len(self._queue) < self._most_ahead and self._read():
            pass
        return self._queue.popleft() if self._queue else self._signal()


def most_ahead(vertices: int, block_size: int) -> int:
    """How many blocks may be read before the first of them is asked for: as many rows as vertices, and `ROWS_AHEAD`."""
    return 1 + (vertices + ROWS_AHEAD) // block_size


def check_header(header: Header, limits: Limits) -> None:
    """Raise what is wrong with the header of a static mesh, or beyond `limits`, before anything is done for it."""
    if header.gop_frames:
        raise UnsupportedError("this is a sequence; decode it with bsm.decode_sequence or bsm.SequenceDecoder")
    if not header.grid:
        chain_rules(header)


def decode(data: bytes, limits: Limits = DEFAULT_LIMITS, threads: int | None = None) -> TriangleMesh:
    """Decode a complete stream."""
    with Decoder(limits, threads) as decoder:
        decoder.receive_data(data)
        return decoder.finish()
