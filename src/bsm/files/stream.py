"""Streams from files and pipes: as they come, decoded in part or whole, and taken apart for a report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container import packets
from bsm.bitstream.container.gop import frames_of_gop
from bsm.bitstream.container.layout import write_attribute, write_metadata
from bsm.bitstream.container.reader import END_OF_STREAM, NEED_DATA, Reader, read_packets
from bsm.bitstream.container.wire import MAGIC
from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.files.pipes import Source, as_input, is_pipe

if TYPE_CHECKING:
    from bsm.codec.geometry.attributes import Attribute
    from bsm.codec.geometry.mesh import TriangleMesh
    from bsm.codec.static.decoder import Decoder
    from bsm.codec.static.events import AttributeEvent

Progress = Callable[[int, int], None]


def is_stream(source: Source) -> bool:
    """Whether something begins like a stream; nothing is taken from an `Input`, and the path of a pipe is not asked."""
    return not is_pipe(source) and as_input(source).peek(len(MAGIC)) == MAGIC


@dataclass(frozen=True)
class GopInfo:
    """A GOP of a sequence: the number of its first frame, how many it has, and where it lies, in bytes."""

    first: int
    frames: int
    offset: int
    bytes: int


@dataclass(frozen=True)
class RunInfo:
    """A run of a sequence: its first frame, how many it has, its mesh, and the run that brought that."""

    first: int
    frames: int
    vertices: int
    faces: int
    mesh: int


@dataclass(frozen=True)
class AttributeInfo:
    """An attribute: what it is, how many values it has, and its bytes, seams among them."""

    name: str
    domain: str
    semantic: str
    kind: str
    components: int
    values: int
    coding: str
    seams: int
    bytes: int


@dataclass(frozen=True)
class StreamInfo:
    """What a stream consists of, known without decoding it; sizes in bytes."""

    header: packets.Header
    metadata: packets.Metadata
    coefficients: tuple[int, ...]
    gops: tuple[GopInfo, ...]
    attributes: tuple[AttributeInfo, ...]
    connectivity: int
    partition: int
    order: int
    coefficient_bytes: int
    metadata_bytes: int
    total: int
    runs: tuple[RunInfo, ...]

    @property
    def framing(self) -> int:
        """Bytes that carry nothing of all that."""
        coded = self.connectivity + self.partition + self.order + self.coefficient_bytes
        return self.total - coded - self.attribute_bytes - self.metadata_bytes

    @property
    def attribute_bytes(self) -> int:
        """Bytes of all attributes: declarations, seams and values."""
        return sum(attribute.bytes for attribute in self.attributes)

    @property
    def bpv_total(self) -> float:
        """Bits of the whole stream per vertex."""
        return 8 * self.total / self.header.vertices

    @property
    def frames(self) -> int:
        """Frames of a sequence, 0 for a mesh."""
        return sum(gop.frames for gop in self.gops)

    @property
    def bpvf_total(self) -> float | None:
        """Bits of the whole stream per vertex and frame; None for a mesh."""
        samples = sum(run.vertices * run.frames for run in self.runs)
        return 8 * self.total / samples if samples else None

    @property
    def bpv_geometry(self) -> float:
        """Bits of the coefficients per vertex."""
        return 8 * self.coefficient_bytes / self.header.vertices

    @property
    def bits_per_coefficient(self) -> float:
        """q_c: as declared for packed coefficients, on average for adaptive ones."""
        if bits := self.header.constants.bits:
            return bits
        return 8 * self.coefficient_bytes / (3 * max(1, sum(self.coefficients)))

    @property
    def bpv_paper(self) -> float:
        """3 q_c c k / n, the paper's measure: c k as the sum over the blocks, n the vertices of the mesh."""
        return 3 * self.bits_per_coefficient * sum(self.coefficients) / self.header.vertices


def inspect_stream(chunks: Iterator[bytes], limits: Limits = DEFAULT_LIMITS) -> StreamInfo:
    """Read a stream to its end, check every checksum, and count."""
    headers: list[packets.Header] = []
    metadata = packets.Metadata()
    runs: list[RunInfo] = []
    coefficients: list[int] = []
    gops: list[GopInfo] = []
    sizes: Counter[type] = Counter()
    declared: list[packets.Attribute] = []
    lengths: Counter[int] = Counter()
    reader = Reader(limits)
    for packet in read_packets(chunks, reader):
        frame = reader.last_frame
        match packet:
            case packets.Header():
                headers.append(packet)
                mesh = packet.run_number if packet.again is None else packet.again
                runs.append(RunInfo(sum(gop.frames for gop in gops), 0, packet.vertices, packet.faces, mesh))
            case packets.Metadata(entries):
                metadata = packets.Metadata({**metadata.entries, **entries})
                sizes[packets.Metadata] += len(write_metadata(packet))
            case packets.Attribute():
                declared += [packet] if len(runs) == 1 else []
                lengths[packet.index] += len(write_attribute(packet))
            case packets.Values():
                lengths[packet.attribute] += len(packet.data)
            case packets.End() | packets.Damaged():
                pass
            case _:
                sizes[type(packet)] += len(packet.data)
        if isinstance(packet, packets.Block):
            coefficients.append(packet.coefficients)
        if isinstance(packet, packets.Gop) and frame is not None:
            frames = frames_of_gop(packet.data, headers[-1].gop_frames, headers[-1].run_number)
            runs[-1] = replace(runs[-1], frames=runs[-1].frames + frames)
            gops.append(GopInfo(packet.index, frames, frame.offset, frame.length))
    assert reader.last_frame is not None
    return StreamInfo(
        headers[0],
        metadata,
        tuple(coefficients),
        tuple(gops),
        tuple(_attribute_info(packet, lengths[packet.index]) for packet in declared),
        connectivity=sizes[packets.Connectivity],
        partition=sizes[packets.Partition],
        order=sizes[packets.Order],
        coefficient_bytes=sum(sizes[kind] for kind in (packets.Block, packets.Gop, packets.Grid, packets.Refinement)),
        metadata_bytes=sizes[packets.Metadata],
        total=reader.last_frame.offset + reader.last_frame.length,
        runs=tuple(runs) if headers[0].gop_frames else (),
    )


def _attribute_info(packet: packets.Attribute, size: int) -> AttributeInfo:
    declared = packet.declaration
    return AttributeInfo(
        declared.name,
        ("vertex", "corner", "face")[declared.domain],
        ("generic", "color", "normal", "texcoord")[declared.semantic],
        ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")[declared.kind],
        declared.components,
        declared.rows,
        "moving levels" if declared.moves else ("levels", "octahedral", "bits", "recomputed")[declared.coding],
        len(packet.seams),
        size,
    )


def decode_whole(
    chunks: Iterator[bytes], limits: Limits = DEFAULT_LIMITS, threads: int | None = None, *, layers: int | None = None
) -> TriangleMesh:
    """Decode a stream to its end, or to that of so many layers."""
    from bsm.codec.static.decoder import Decoder

    with Decoder(limits, threads, layers=layers) as decoder:
        for chunk in chunks:
            decoder.receive_data(chunk)
        return decoder.finish()


def decode_blocks(
    chunks: Iterator[bytes], count: int, progress: Progress, limits: Limits = DEFAULT_LIMITS
) -> TriangleMesh:
    """Decode the first `count` blocks, read no further, and return the faces whose vertices have all arrived."""
    from bsm.codec.static.decoder import Decoder
    from bsm.codec.static.events import BlockEvent, EndEvent, HeaderEvent

    if count < 1:
        raise OptionError("at least one block must be decoded")
    wanted, done = count, 0

    def enough(event: Any) -> bool:
        nonlocal wanted, done
        if isinstance(event, HeaderEvent):
            wanted = count if event.header.grid else min(count, event.header.blocks)
        elif isinstance(event, BlockEvent):
            done += 1
            progress(done, wanted)
        return done == wanted or isinstance(event, EndEvent)

    return _decode_until(Decoder(limits), chunks, enough)


def decode_what_is_left(
    chunks: Iterator[bytes], report: Callable[[str], None], limits: Limits = DEFAULT_LIMITS
) -> TriangleMesh:
    """Decode every block of a damaged stream that does not depend on what is lost; `report` is told what is."""
    from bsm.codec.static.decoder import Decoder
    from bsm.codec.static.events import EndEvent, LossEvent

    def reported(event: Any) -> bool:
        match event:
            case LossEvent(_, error):
                report(f"lost: {error}")
            case EndEvent(losses) if len(losses.missing) or len(losses.degraded):
                report(f"{len(losses.missing)} vertices are missing, {len(losses.degraded)} less good than they were")
        return False

    return _decode_until(Decoder(limits, tolerant=True), chunks, reported)


def _decode_until(decoder: Decoder, chunks: Iterator[bytes], enough: Callable[[Any], bool]) -> TriangleMesh:
    """Decode until an event is enough, or to the end; the faces whose vertices have all arrived."""
    part = _Part()
    with decoder:
        for event in events(decoder, chunks):
            part.take(event)
            if enough(event):
                break
    return replace(part.mesh(), metadata=decoder.metadata)


class _Receiver(Protocol):
    """What the decoders of meshes and sequences have in common."""

    def receive_data(self, data: bytes) -> None: ...
    def receive_eof(self) -> None: ...
    def next_event(self) -> Any: ...


def events(decoder: _Receiver, chunks: Iterator[bytes]) -> Iterator[Any]:
    """What a decoder says while it is given bytes as it needs them, until the end of the stream."""
    while (event := decoder.next_event()) is not END_OF_STREAM:
        if event is not NEED_DATA:
            yield event
        elif chunk := next(chunks, b""):
            decoder.receive_data(chunk)
        else:
            decoder.receive_eof()


class _Part:
    """What is known of a mesh while its blocks arrive."""

    def __init__(self) -> None:
        self._faces: npt.NDArray[np.int32] = np.empty((0, 3), np.int32)
        self._positions, self._known = np.empty((0, 3)), np.empty(0, np.bool_)
        self._values: dict[str, list[AttributeEvent]] = {}

    def take(self, event: Any) -> None:
        """Add what an event tells."""
        from bsm.codec.static.events import AttributeEvent, BlockEvent, ConnectivityEvent, RefinementEvent

        match event:
            case ConnectivityEvent(faces, vertices):
                self._faces, self._positions, self._known = faces, np.zeros((vertices, 3)), np.zeros(vertices, np.bool_)
            case BlockEvent() | RefinementEvent():
                self._positions[event.vertices] = event.positions
                self._known[event.vertices] = True
            case AttributeEvent(name):
                self._values.setdefault(name, []).append(event)

    def mesh(self) -> TriangleMesh:
        """The faces whose vertices are known, with the attributes that have come as a whole."""
        from bsm.codec.geometry.mesh import TriangleMesh

        complete = np.flatnonzero(self._known[self._faces].all(axis=1))
        if len(complete) == 0:
            raise MeshError("no face is complete in the blocks that are there")
        every_vertex = np.arange(len(self._positions))
        attributes = [
            found.taken(every_vertex, complete) for found in map(self._attribute, self._values.values()) if found
        ]
        return TriangleMesh(self._positions, self._faces[complete], tuple(attributes)).without_isolated_vertices()[0]

    def _attribute(self, events: list[AttributeEvent]) -> Attribute | None:
        """The attribute that events tell of, None if values of it are missing."""
        from bsm.codec.geometry.attributes import Attribute

        first = events[0]
        rows = np.concatenate([event.rows for event in events])
        sizes = {"vertex": len(self._positions), "face": len(self._faces)}
        size = sizes[first.domain] if first.indices is None else int(first.indices.max()) + 1
        if len(np.unique(rows)) < size:
            return None
        values = np.zeros((size, first.values.shape[1]), first.values.dtype)
        values[rows] = np.concatenate([event.values for event in events])
        return Attribute(first.name, values, first.domain, first.semantic, first.indices)
