"""A stream to the frames of a sequence, while it arrives."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bitstream.connectivity.faces import decode_connectivity
from bitstream.connectivity.order import Arrangement, decode_arrangement
from bitstream.connectivity.partition import decode_labels
from bitstream.container import packets
from bitstream.container.gop import GopBody, GopMethod, parse_gop_body
from bitstream.container.header import Header
from bitstream.container.reader import END_OF_STREAM, NEED_DATA, Reader, Signal
from bitstream.container.tolerant import TolerantReader
from bitstream.container.wire import FrameType
from bitstream.errors import BsmError, CorruptError, FormatError, UnsupportedError
from bitstream.limits import DEFAULT_LIMITS, Limits
from codec.blocks.blend import Blend
from codec.blocks.overlap import grow_blocks
from codec.blocks.partition import Partition, derive_partition, partition_of_labels
from codec.geometry.graph import graph_of_faces
from codec.geometry.mesh import Faces, Positions
from codec.sequence.gop_decoder import GopDecoder, Setting, make_setting
from codec.static.decoder import (
    CONNECTIVITY_METHOD,
    ORDER_METHOD,
    ChainDecoder,
    ConnectivityEvent,
    EndEvent,
    HeaderEvent,
    chain_rules,
)
from codec.static.work import Allowance, check_work

Matrix = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FrameEvent:
    """A frame: its number from 0, and its positions, shape (n, 3), in the mesh's unit."""

    index: int
    positions: Positions


@dataclass(frozen=True)
class GopLost:
    """Frames that cannot be decoded (tolerant mode): `frames` of them from number `index` on, 0 if not known."""

    index: int
    frames: int
    reason: str


Event: TypeAlias = HeaderEvent | ConnectivityEvent | FrameEvent | GopLost | EndEvent | Signal


class SequenceDecoder:
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
        Go on behind a GOP that is lost or broken, and give a `GopLost` for it, instead of raising. What comes before
        the GOPs must be whole in any case.
    start : int
        Give no frame before this one; GOPs that it does not need are not decoded.
    """

    def __init__(
        self, limits: Limits = DEFAULT_LIMITS, threads: int | None = None, tolerant: bool = False, start: int = 0
    ) -> None:
        self._limits = limits
        self._threads = threads
        self._tolerant = tolerant
        self._start = start
        self._reader = TolerantReader(limits) if tolerant else Reader(limits)
        self._queue: deque[Event] = deque()
        self._frames: Iterator[Positions] = iter(())
        self._error: BsmError | None = None
        self._ended = False
        self._header: Header | None = None
        self._faces: Faces | None = None
        self._arrangement: Arrangement | None = None
        self._partition: Partition | None = None
        self._opening: Opening | None = None
        self._gops: GopDecoder | None = None
        self._next_frame = 0  # the frame that comes next in the stream
        self._given = 0  # the frame that is given next
        self._skipped: list[GopBody] = []  # low-delay frames since the latest key frame, not decoded
        self._lost: str | None = None
        self._lossy = False  # whether a loss was reported, so that an END that counts more frames is no news

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
        while True:
            if self._queue:
                return self._queue.popleft()
            positions = next(self._frames, None)
            if positions is not None:
                self._given += 1
                if self._given > self._start:
                    return FrameEvent(self._given - 1, self._arranged(positions))
                continue
            if self._ended:
                return END_OF_STREAM
            if self._error is not None:
                raise self._error
            if not self._read():
                return NEED_DATA

    def _read(self) -> bool:
        """Read one packet, if it is there."""
        try:
            packet = self._reader.next_packet()
            if packet is NEED_DATA:
                return False
            if packet is END_OF_STREAM:
                self._finish()
            else:
                self._accept(packet)
        except BsmError as error:
            span = self._reader.last_frame
            self._error = error.located(offset=span.offset, frame=span.number) if span else error
        return True

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
                self._opened().add(packet)
            case packets.Gop():
                self._accept_gop(packet)
            case packets.Damaged():
                self._accept_damage(packet)

    def _accept_header(self, header: Header) -> None:
        if not header.gop_frames:
            raise FormatError("this is a static mesh and no sequence; decode it with codec.Decoder")
        if header.smoothing or header.details:
            raise UnsupportedError("smoothing and details of sequences are unknown to this decoder")
        solves = chain_rules(header).solves
        check_work(self._limits, header.blocks, header.block_size, header.coefficients, solves, exact=True)
        self._limits.check("sequence_bytes", 8.0 * header.blocks * header.block_size * header.coefficients)
        self._header = header
        self._queue.append(HeaderEvent(header))

    def _accept_connectivity(self, packet: packets.Connectivity) -> None:
        assert self._header is not None
        if packet.method != CONNECTIVITY_METHOD:
            raise UnsupportedError(f"connectivity method {packet.method} is unknown to this decoder")
        self._faces = decode_connectivity(packet.data, self._header.vertices, self._header.faces, self._limits)

    def _accept_partition(self, packet: packets.Partition) -> None:
        assert self._header is not None and self._faces is not None
        if packet.method != 0:
            raise UnsupportedError(f"partition method {packet.method} is unknown to this decoder")
        graph = graph_of_faces(self._faces, self._header.vertices)
        self._partition = partition_of_labels(
            decode_labels(packet.data, graph.offsets, graph.neighbours, self._header.blocks)
        )

    def _accept_order(self, packet: packets.Order) -> None:
        assert self._header is not None and self._faces is not None
        if packet.method != ORDER_METHOD:
            raise UnsupportedError(f"order method {packet.method} is unknown to this decoder")
        self._arrangement = decode_arrangement(packet.data, self._faces, self._header.vertices)

    def _arranged(self, positions: Positions) -> Positions:
        """Positions in the order that the vertices had before coding, if that was kept."""
        if self._arrangement is None:
            return positions
        arranged = np.empty_like(positions)
        arranged[self._arrangement.vertex_order] = positions
        return arranged

    def _opened(self) -> Opening:
        if self._opening is None:
            assert self._header is not None and self._faces is not None
            self._opening = Opening(self._header, self._faces, self._partition, self._limits)
            self._queue.append(ConnectivityEvent(self._arrangement.faces if self._arrangement else self._faces))
        return self._opening

    def _gop_decoder(self) -> GopDecoder:
        if self._gops is None:
            self._gops = GopDecoder(self._opened().setting(self._threads))
        return self._gops

    def _accept_gop(self, packet: packets.Gop) -> None:
        assert self._header is not None
        decoder = self._gop_decoder()
        if packet.index > self._next_frame:
            self._report_loss(packet.index - self._next_frame)
        try:
            if packet.index < self._next_frame:
                raise CorruptError(f"frame {packet.index} comes again behind frame {self._next_frame - 1}")
            body = parse_gop_body(packet.data, self._header.gop_frames)
            columns = 3 * body.frames if body.method is GopMethod.COSINES else body.components
            self._limits.check("sequence_bytes", 16.0 * columns * (self._header.vertices + 3 * body.frames))
            if 0 < self._header.frames < packet.index + body.frames:
                raise CorruptError(
                    f"frames {packet.index} to {packet.index + body.frames - 1} of {self._header.frames}"
                )
            self._given = self._next_frame
            self._frames = self._decoded(decoder, body)
            self._next_frame += body.frames
        except BsmError as error:
            if not self._tolerant:
                raise
            self._lose(error.message)

    def _decoded(self, decoder: GopDecoder, body: GopBody) -> Iterator[Positions]:
        """Frames of a GOP, or nothing of it where no frame of it is wanted and none that is depends on it."""
        if body.method is not GopMethod.NEXT_FRAME:
            self._skipped.clear()
        if self._next_frame + body.frames <= self._start:
            if body.method >= GopMethod.KEY_FRAME:
                self._skipped.append(body)
            return iter(())
        for earlier in self._skipped:
            decoder.decode(earlier)
        self._skipped.clear()
        return decoder.decode(body)

    def _accept_damage(self, packet: packets.Damaged) -> None:
        if self._opening is None or not self._opening.complete:
            raise CorruptError(f"the beginning of a sequence must be whole: {packet.reason}")
        if packet.type is not FrameType.END or not self._lossy:
            self._lose(packet.reason)

    def _lose(self, reason: str) -> None:
        """Take note that frames are lost; how many is known when the next ones come."""
        self._lost = self._lost or reason
        self._skipped.clear()
        self._gop_decoder().forget()

    def _report_loss(self, frames: int) -> None:
        reason = self._lost or "a GOP is missing"
        if not self._tolerant:
            raise CorruptError(f"{frames} frames from number {self._next_frame} on are missing")
        self._queue.append(GopLost(self._next_frame, frames, reason))
        self._gop_decoder().forget()
        self._skipped.clear()
        self._next_frame += frames
        self._lost = None
        self._lossy = True

    def _finish(self) -> None:
        assert self._header is not None
        if not self._opened().complete:
            raise CorruptError("the stream ends before its first frame is complete")
        missing = self._header.frames - self._next_frame if self._header.frames else 0
        if missing or (self._lost and not self._header.frames):
            self._report_loss(missing)
        self._ended = True
        self._queue.append(EndEvent())


class Opening:
    """The first frame, coded as a static mesh is: what every GOP builds upon."""

    def __init__(self, header: Header, faces: Faces, partition: Partition | None, limits: Limits) -> None:
        graph = graph_of_faces(faces, header.vertices)
        partition = partition or derive_partition(graph, header.blocks)
        largest = int(np.diff(partition.bounds).max())
        if largest > header.block_size:
            raise CorruptError(f"a part of {largest} vertices in blocks of {header.block_size}")
        self._header = header
        self._faces = faces
        self._blocks = grow_blocks(graph, partition, header.block_size)
        self._blend = Blend(header.vertices)
        self._allowance = Allowance(limits)
        self._chain: ChainDecoder | None = None
        self._next_index = 0

    @property
    def complete(self) -> bool:
        """Whether all blocks are there."""
        return self._next_index == self._blocks.count

    def add(self, packet: packets.Block) -> None:
        """Decode the next block."""
        if packet.index != self._next_index:
            raise CorruptError(f"block {packet.index} of the first frame where block {self._next_index} belongs")
        rules = chain_rules(self._header)
        if self._chain is None or packet.index % rules.chain_length(self._blocks.count) == 0:
            self._chain = ChainDecoder(self._header, rules, self._blocks, packet.index, self._allowance)
        decoded = self._chain.decode(packet)
        self._blend.add(decoded.vertices, decoded.positions, decoded.weights)
        self._next_index += 1

    def setting(self, threads: int | None) -> Setting:
        """What the GOPs are decoded with."""
        if not self.complete:
            raise CorruptError(f"GOPs begin after {self._next_index} of {self._blocks.count} blocks of the first frame")
        first = self._blend.positions(np.arange(self._header.vertices, dtype=np.int32))
        return make_setting(self._header, self._faces, self._blocks, first, threads)


def decode_sequence(
    data: bytes, limits: Limits = DEFAULT_LIMITS, threads: int | None = None
) -> tuple[npt.NDArray[np.float64], Faces]:
    """Decode a complete sequence.

    Returns
    -------
    positions : float64 array, shape (T, n, 3)
    faces : int32 array, shape (m, 3)

    Raises
    ------
    BsmError
        `FormatError`, `UnsupportedError`, `CorruptError`, `TruncatedError`, `LimitError` or `NumericError`.
    """
    decoder = SequenceDecoder(limits, threads)
    decoder.receive_data(data)
    decoder.receive_eof()
    frames: list[Positions] = []
    faces = np.zeros((0, 3), np.int32)
    vertices = 0
    while (event := decoder.next_event()) is not END_OF_STREAM:
        match event:
            case HeaderEvent(header):
                vertices = header.vertices
            case ConnectivityEvent(received):
                faces = received
            case FrameEvent(_, positions):
                frames.append(positions)
    return np.array(frames).reshape(-1, vertices, 3), faces
