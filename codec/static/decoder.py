"""A stream to a mesh, block by block, while it arrives."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from types import TracebackType
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bitstream.coefficients.adaptive import CoefficientModel, decode_coefficients, decode_layers
from bitstream.coefficients.packed import unpack_coefficients
from bitstream.coefficients.priors import detail_experience
from bitstream.coefficients.trellis import points_of_levels
from bitstream.connectivity.faces import decode_connectivity
from bitstream.connectivity.order import Arrangement, decode_arrangement
from bitstream.connectivity.partition import decode_labels
from bitstream.container import packets
from bitstream.container.header import Header
from bitstream.container.reader import END_OF_STREAM, NEED_DATA, Reader, Signal
from bitstream.container.tolerant import TolerantReader
from bitstream.container.wire import FrameType
from bitstream.errors import BsmError, CorruptError, NumericError, UnsupportedError
from bitstream.limits import DEFAULT_LIMITS, Limits
from codec.blocks.blend import degree_weights
from codec.blocks.overlap import Block, Blocks, grow_blocks
from codec.blocks.partition import Partition, derive_partition, partition_of_labels
from codec.geometry.graph import Graph, graph_of_faces
from codec.geometry.mesh import Faces, TriangleMesh
from codec.signal.chain import Chain, ChainRules
from codec.signal.detail import Normals, Surface, displace, make_surface, unfold_details
from codec.signal.predict import MAX_STIFFNESS, extend
from codec.signal.quantize import dequantize, unsigned_to_levels
from codec.signal.transform import reconstruct
from codec.static.assembly import Assembly, Changes, DecodedBlock, Frame, Losses
from codec.static.work import Allowance, block_work, check_work
from codec.threads import Lanes, Pending

Matrix = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]

CONNECTIVITY_METHOD = 1
"""The valence-driven coder of `bitstream.connectivity.faces`."""

ORDER_METHOD = 1
"""The permutations of `bitstream.connectivity.order`."""


@dataclass(frozen=True)
class HeaderEvent:
    """The header has arrived."""

    header: Header


@dataclass(frozen=True, eq=False)
class ConnectivityEvent:
    """The faces have arrived, shape (m, 3), with all that is needed to decode blocks.

    Where the stream stores the order that the mesh had, faces and all vertex numbers are in that order.
    """

    faces: Faces


@dataclass(frozen=True, eq=False)
class BlockEvent:
    """A block has been decoded.

    Parameters
    ----------
    index : int
        Of the block.
    changes : Changes
        Vertices that this block moved or finished, their positions in the mesh's unit, and which of them no later
        block will move.
    """

    index: int
    changes: Changes

    @property
    def vertices(self) -> Indices:
        """Vertices that this block moved or finished, shape (v,)."""
        return self.changes.vertices

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """Where they are now, in the mesh's unit, shape (v, 3)."""
        return self.changes.positions

    @property
    def final(self) -> npt.NDArray[np.bool_]:
        """Which of them no later block will move, shape (v,)."""
        return self.changes.final


@dataclass(frozen=True)
class LossEvent:
    """A tolerant decoder could not decode something, and goes on.

    Parameters
    ----------
    block : int, optional
        The block that is lost; None for bytes that belong to no block that is known.
    error : BsmError
        Why, and where in the stream.
    """

    block: int | None
    error: BsmError


@dataclass(frozen=True, eq=False)
class EndEvent:
    """The stream has come to its end.

    Parameters
    ----------
    losses : Losses
        Vertices that are missing or less good; none, and the checksum of the stream right, unless the decoder is
        tolerant.
    """

    losses: Losses = field(default_factory=Losses)


Event: TypeAlias = HeaderEvent | ConnectivityEvent | BlockEvent | LossEvent | EndEvent | Signal


def chain_rules(header: Header) -> ChainRules:
    """What a header says about chains and dictionaries."""
    return ChainRules(
        exact=header.basis == 1,
        independent=header.seeding == 1,
        key_interval=header.key_interval,
        power=header.power,
        iterations=header.iterations,
        key_iterations=header.key_iterations,
        shift=header.shift,
        stiffness=header.prediction[0] if header.prediction else None,
    )


def detail_rows(header: Header) -> int:
    """Rows of three that the largest detail layer takes."""
    return -(-header.details // 3)


def half_steps(header: Header, levels: npt.NDArray[np.signedinteger]) -> npt.NDArray[np.signedinteger]:
    """Levels in half steps: on one grid if they are packed, on the two of the trellis otherwise."""
    return 2 * levels if header.coding == 0 else points_of_levels(levels)


def copy_weights(header: Header, blocks: Blocks, index: int, block: Block) -> Matrix:
    """Weight of each row of a block in the blend."""
    if header.blend == 0:
        return degree_weights(block.degrees)
    if header.blend == 1:
        return np.ones(block.size)
    return np.isin(block.vertices, blocks.core(index)).astype(np.float64)


class ChainDecoder:
    """Decodes the blocks of one chain, in their order."""

    def __init__(
        self,
        header: Header,
        rules: ChainRules,
        blocks: Blocks,
        first: int,
        allowance: Allowance,
        surface: Surface | None = None,
    ) -> None:
        self._header = header
        self._rules = rules
        self._allowance = allowance
        self._blocks = blocks
        self._next = first
        self._chain = Chain(rules, blocks.graph)
        self._model = CoefficientModel(header.coefficients)
        self._details = CoefficientModel(detail_rows(header), detail_experience()) if header.details else None
        self._normals = Normals(surface) if surface is not None else None

    def decode(self, packet: packets.Block) -> DecodedBlock:
        """Decode the chain's next block; once one is missing or broken, the rest of the chain cannot be decoded."""
        header, blocks = self._header, self._blocks
        try:
            if packet.index != self._next:
                raise CorruptError(f"the block depends on block {self._next}, which is lost")
            block = blocks.block(packet.index)
            levels, details = self._levels(packet, block)
            around, width = self._chain.around(block), max(len(levels), len(details))
            self._allowance.spend(block_work(block, width, self._rules.solves, self._rules.exact))
            subspace = self._chain.dictionary(block, around, width)
            coarse = dequantize(half_steps(header, levels), header.step / 2)
            positions = extend(block, around) + reconstruct(subspace, coarse)
            if self._normals is not None:
                heights = dequantize(details, header.detail_step / 2)
                positions = displace(positions, self._normals.of(block, positions), subspace, heights)
            self._chain.commit(block, subspace, positions)
            if not np.isfinite(positions).all():
                raise NumericError("the coefficients reconstruct to positions that are not finite")
        except BsmError as error:
            raise error.located(block=packet.index) from None
        self._next += 1
        return DecodedBlock(packet.index, block.vertices, positions, copy_weights(header, blocks, packet.index, block))

    def _levels(
        self, packet: packets.Block, block: Block
    ) -> tuple[npt.NDArray[np.signedinteger], npt.NDArray[np.signedinteger]]:
        """Levels of x, y and z, shape (c_i, 3), and the detail layer in half steps, shape (d_i,)."""
        nothing = np.zeros(0, np.int32)
        width = packet.coefficients
        if not 1 <= width <= block.size:
            raise CorruptError(f"{width} coefficients for a block of {block.size} vertices")
        if self._header.coding == 0:
            values = unpack_coefficients(packet.data, 3 * width, self._header.bits)
            return unsigned_to_levels(values, self._header.bits, self._header.coarser), nothing
        if self._details is None:
            return decode_coefficients(self._model, packet.data, width), nothing
        levels, folded = decode_layers(self._model, self._details, packet.data, width)
        details = half_steps(self._header, folded)
        return levels, unfold_details(details, min(self._header.details, block.size))


class Decoder:
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
        self._limits = limits
        self._tolerant = tolerant
        self._reader = TolerantReader(limits) if tolerant else Reader(limits)
        self._allowance = Allowance(limits)
        self._lanes = Lanes(threads)
        self._queue: deque[Event | Pending[DecodedBlock]] = deque()
        self._error: BsmError | None = None
        self._ended = False
        self._complete = False
        self._next_index = 0
        self._header: Header | None = None
        self._faces: Faces | None = None
        self._graph: Graph | None = None
        self._surface: Surface | None = None
        self._partition: Partition | None = None
        self._arrangement: Arrangement | None = None
        self._blocks: Blocks | None = None
        self._chains: dict[int, ChainDecoder] = {}
        self._assembly: Assembly | None = None

    def __enter__(self) -> Decoder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Stop the threads; blocks that were not asked for are given up."""
        self._lanes.close()

    def receive_data(self, data: bytes | bytearray | memoryview) -> None:
        """Take more bytes of the stream."""
        self._reader.receive_data(data)

    def receive_eof(self) -> None:
        """Take note that no more bytes will come."""
        self._reader.receive_eof()

    def next_event(self) -> Event:
        """The next event, or `NEED_DATA`; `END_OF_STREAM` after `EndEvent` and `receive_eof`.

        Raises
        ------
        BsmError
            One of the stream's errors, with its place.
        """
        item = self._next_item()
        if not isinstance(item, Pending):
            return item
        assert self._assembly is not None
        try:
            decoded = self._result(item)
        except BsmError as error:
            if not self._tolerant or error.block is None:
                raise
            self._assembly.lose(error.block)
            return LossEvent(error.block, error)
        try:
            return BlockEvent(decoded.index, self._assembly.changes(decoded))
        except BsmError as error:
            self._give_up(error.located(block=decoded.index))
            raise

    def finish(self) -> TriangleMesh:
        """Decode the rest of a complete stream and return the mesh; faster than asking for events.

        Raises
        ------
        BsmError
            Also `TruncatedError`, if bytes are missing.
        """
        self._reader.receive_eof()
        while (item := self._next_item()) is not END_OF_STREAM:
            if isinstance(item, Pending):
                decoded = self._result(item)
                assert self._assembly is not None
                self._assembly.add(decoded)
        assert self._assembly is not None and self._faces is not None
        return TriangleMesh(self._assembly.positions(), self._faces)

    def _result(self, pending: Pending[DecodedBlock]) -> DecodedBlock:
        try:
            return pending.result()
        except BsmError as error:
            if not self._tolerant:
                self._give_up(error)
            raise

    def _give_up(self, error: BsmError) -> None:
        self._queue.clear()
        self._error = error

    def _next_item(self) -> Event | Pending[DecodedBlock]:
        self._look_ahead()
        if self._queue:
            item = self._queue.popleft()
            if isinstance(item, EndEvent) and self._assembly is not None:
                return EndEvent(self._assembly.losses())
            return item
        if self._error is not None:
            raise self._error
        return END_OF_STREAM if self._ended else NEED_DATA

    def _look_ahead(self) -> None:
        """Read every packet whose bytes are there, so that chains can be decoded side by side."""
        while self._error is None and not self._ended:
            try:
                packet = self._reader.next_packet()
                if packet is NEED_DATA:
                    return
                if packet is END_OF_STREAM:
                    self._ended = True
                    if not self._complete:  # a tolerant reader may find no END
                        self._accept_end()
                else:
                    self._accept(packet)
            except BsmError as error:
                span = self._reader.last_frame
                self._error = error.located(offset=span.offset, frame=span.number) if span else error

    def _accept(self, packet: object) -> None:
        match packet:
            case Header():
                self._accept_header(packet)
            case packets.Connectivity():
                self._accept_connectivity(packet)
            case packets.Partition():
                self._accept_partition(packet)
            case packets.Order():
                self._accept_order(packet)
            case packets.Block():
                self._accept_block(packet)
            case packets.End():
                self._accept_end()
            case packets.Damaged():
                self._accept_damage(packet)

    def _accept_header(self, header: Header) -> None:
        if header.gop_frames:
            raise UnsupportedError("this is a sequence; decode it with codec.SequenceDecoder")
        solves = chain_rules(header).solves
        width = max(header.coefficients, header.details)
        check_work(self._limits, header.blocks, header.block_size, width, solves, exact=header.basis == 1)
        if len(header.prediction) > 1 or not all(0 < value < MAX_STIFFNESS for value in header.prediction):
            raise CorruptError(f"the prediction has the parameters {header.prediction}, one stiffness is legal")
        self._header = header
        self._queue.append(HeaderEvent(header))

    def _accept_connectivity(self, packet: packets.Connectivity) -> None:
        assert self._header is not None
        if packet.method != CONNECTIVITY_METHOD:
            raise UnsupportedError(f"connectivity method {packet.method} is unknown to this decoder")
        self._faces = decode_connectivity(packet.data, self._header.vertices, self._header.faces, self._limits)
        self._graph = graph_of_faces(self._faces, self._header.vertices)
        if self._header.details:
            self._surface = make_surface(self._faces, self._header.vertices)

    def _accept_partition(self, packet: packets.Partition) -> None:
        assert self._header is not None and self._graph is not None
        if packet.method != 0:
            raise UnsupportedError(f"partition method {packet.method} is unknown to this decoder")
        labels = decode_labels(packet.data, self._graph.offsets, self._graph.neighbours, self._header.blocks)
        self._partition = partition_of_labels(labels)

    def _accept_order(self, packet: packets.Order) -> None:
        assert self._header is not None and self._faces is not None
        if packet.method != ORDER_METHOD:
            raise UnsupportedError(f"order method {packet.method} is unknown to this decoder")
        self._arrangement = decode_arrangement(packet.data, self._faces, self._header.vertices)
        self._faces = self._arrangement.faces

    def _accept_block(self, packet: packets.Block) -> None:
        blocks = self._built()
        assert self._header is not None
        self._skip_to(packet.index)
        self._next_index += 1
        rules = chain_rules(self._header)
        number = packet.index // rules.chain_length(blocks.count)
        if number not in self._chains:
            self._chains.clear()
            first = number * rules.chain_length(blocks.count)
            self._chains[number] = ChainDecoder(self._header, rules, blocks, first, self._allowance, self._surface)
        chain = self._chains[number]
        self._queue.append(self._lanes.submit(number, lambda: chain.decode(packet)))

    def _skip_to(self, index: int) -> None:
        """Give up the blocks before `index` that did not come."""
        for lost in range(self._next_index, index):
            error = CorruptError("the frame of the block is missing", block=lost)
            if not self._tolerant:
                raise error
            assert self._assembly is not None
            self._assembly.lose(lost)
            self._queue.append(LossEvent(lost, error))
        self._next_index = index

    def _accept_damage(self, packet: packets.Damaged) -> None:
        error = CorruptError(f"{packet.length} bytes cannot be read: {packet.reason}", offset=packet.offset)
        if self._graph is None or (self._blocks is None and packet.type is not FrameType.BLOCK):
            raise error
        self._queue.append(LossEvent(None, error))

    def _accept_end(self) -> None:
        assert self._header is not None
        self._built()
        self._skip_to(self._header.blocks)
        self._complete = True
        self._queue.append(EndEvent())

    def _built(self) -> Blocks:
        """The blocks, built when the first of them is needed."""
        if self._blocks is None:
            assert self._header is not None and self._graph is not None
            partition = self._partition or derive_partition(self._graph, self._header.blocks)
            largest = int(np.diff(partition.bounds).max())
            if not largest <= self._header.block_size:
                raise CorruptError(f"a part of {largest} vertices in blocks of {self._header.block_size}")
            self._blocks = grow_blocks(self._graph, partition, self._header.block_size)
            order = self._arrangement.vertex_order if self._arrangement else None
            frame = Frame(self._header.center, self._header.scale)
            self._assembly = Assembly(self._graph, self._blocks, self._header.smoothing, frame, order)
            assert self._faces is not None
            self._queue.append(ConnectivityEvent(self._faces))
        return self._blocks


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
