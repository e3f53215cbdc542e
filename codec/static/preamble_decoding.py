"""What a decoder gets before positions, from what `codec.static.preamble_encoding` prepares.

They pass three stages (`codec.static.stages`): `HeaderStage` takes the header, `ConnectivityStage` the faces, and
`PreambleStage` labels, order and declarations, until something else comes. Each further section of a mesh begins at
`ConnectivityStage` again.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bsm.bitstream.connectivity.faces import ConnectivityDecoder
from bsm.bitstream.connectivity.partition import decode_labels
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import FREE_COPIES, MOST_COPIES, Header, Span
from bsm.bitstream.container.splits import decode_order
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import BsmError, CorruptError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces
from bsm.codec.blocks.overlap import grow_blocks
from bsm.codec.blocks.partition import Partition, derive_last_parts, partition_of_labels
from bsm.codec.geometry.graph import Graph, graph_of_faces
from bsm.codec.signal.chain import AS_SPECIFIED, Trial
from bsm.codec.static.assembly import Assembly
from bsm.codec.static.attributes.decoding import Declarations
from bsm.codec.static.events import HeaderEvent, LossEvent, unreadable
from bsm.codec.static.numbering import Numbering
from bsm.codec.static.rules import Scheme, scheme_of
from bsm.codec.static.stages import Arrival, Stage, misplaced
from bsm.codec.static.units import Units
from bsm.codec.static.work import (
    COPY_MEMORY,
    Allowance,
    MeshMemory,
    labels_cost,
    mesh_cost,
    order_cost,
    order_memory,
    partition_cost,
)


@dataclass(frozen=True, eq=False)
class Section:
    """What has come of the mesh with one more section; most have but one."""

    number: int
    count: int
    span: Span
    first: int
    faces: Faces
    graph: Graph

    @property
    def is_last(self) -> bool:
        """Whether the mesh is whole."""
        return self.number == self.count - 1


class SectionReader:
    """The mesh, section by section, as CONNECTIVITYs come."""

    def __init__(self, header: Header, allowance: Allowance) -> None:
        self._header = header
        self._allowance = allowance
        self._spans = deque(enumerate(header.spans))
        self._count = len(self._spans)
        cuts = [span.faces.stop for span in header.spans[:-1]]
        self._decoder = ConnectivityDecoder(header.vertices, header.faces, allowance.limits, cuts)
        self._memory = MeshMemory(allowance)
        self._vertices = 0

    def take(self, packet: packets.Connectivity) -> Section:
        """The next section."""
        allowance, received = self._allowance, len(packet.data)
        known = self._decoder.take(packet.data)
        number, span = self._spans.popleft()
        self._check(number, span, known.vertices)
        first, self._vertices, faces = self._vertices, known.vertices, len(known.faces)
        self._memory.grow(known.vertices, faces, received)
        before = (first, span.faces.start)
        allowance.spend(mesh_cost(known.vertices, faces, received, before), received)
        graph = graph_of_faces(known.faces, known.vertices)
        return Section(number, self._count, span, first, known.faces, graph)

    def _check(self, number: int, span: Span, vertices: int) -> None:
        """Raise `CorruptError` if a section, with which there are so many vertices, has too few for its blocks."""
        own, rows = vertices - self._vertices, span.blocks.stop * self._header.block_size
        if own < len(span.blocks):
            raise CorruptError(f"{len(span.blocks)} blocks in section {number} of {own} vertices")
        if rows > MOST_COPIES * vertices + FREE_COPIES:
            raise CorruptError(f"blocks of {rows} rows at section {number}, where there are {vertices} vertices")


@dataclass(frozen=True, eq=False)
class Structure:
    """What a decoder knows before the first block, of the mesh or of one more section."""

    connectivity: ConnectivityStage
    section: Section
    numbering: Numbering
    partition: Partition | None
    declarations: Declarations

    @property
    def header(self) -> Header:
        """What is said of the whole mesh."""
        return self.connectivity.header

    @property
    def faces(self) -> Faces:
        """As far as they have come, shape (m, 3), as they were coded."""
        return self.section.faces

    @property
    def graph(self) -> Graph:
        """The graph of the decoded faces."""
        return self.section.graph

    @property
    def allowance(self) -> Allowance:
        """What may still be done."""
        return self.connectivity.setup.allowance

    @property
    def units(self) -> Units:
        """What the header says of them."""
        return Units(self.header.center, self.header.scale)

    @cached_property
    def scheme(self) -> Scheme:
        """How blocks are coded."""
        header, section, setup = self.header, self.section, self.connectivity.setup
        blocks = len(section.span.blocks)
        copies = blocks * min(header.block_size, self.graph.size)
        self.allowance.keep(COPY_MEMORY * copies)
        self.allowance.spend(partition_cost(self.graph, section.first, blocks, copies))
        partition = self.partition or derive_last_parts(self.graph, section.first, blocks, setup.threads)
        largest = int(np.diff(partition.bounds).max())
        if largest > header.block_size:
            raise CorruptError(f"a part of {largest} vertices in blocks of {header.block_size}")
        grown = grow_blocks(self.graph, partition, header.block_size)
        return scheme_of(header, self.faces, grown, setup.trial, section.span.blocks.start)

    def following(self, assembly: Assembly) -> ConnectivityStage:
        """What takes the next section, which is added to `assembly`."""
        return replace(self.connectivity, before=assembly)


@dataclass(frozen=True)
class DecoderSetup:
    """How a decoder reads the preamble: which headers it takes, what it may spend, which stage comes behind, and what
    is tried."""

    allowance: Allowance
    check: Callable[[Header], None]
    begin: Callable[[Structure], Stage[Any]]
    tolerant: bool = False
    trial: Trial = AS_SPECIFIED
    threads: int | None = 1


@dataclass(frozen=True, eq=False)
class HeaderStage:
    """Waits for the header."""

    setup: DecoderSetup

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, Header):
            raise unreadable(arrival) if isinstance(arrival, packets.Damaged) else misplaced(arrival)
        self.setup.check(arrival)
        queue.append(HeaderEvent(arrival))
        return ConnectivityStage(self.setup, arrival, SectionReader(arrival, self.setup.allowance))


@dataclass(frozen=True, eq=False)
class ConnectivityStage:
    """Waits for connectivity: of the mesh, or of its next section once the one before is put together."""

    setup: DecoderSetup
    header: Header
    sections: SectionReader
    before: Assembly | None = None

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, packets.Connectivity):
            raise unreadable(arrival) if isinstance(arrival, packets.Damaged) else misplaced(arrival)
        section = self.sections.take(arrival)
        return PreambleStage(self, section, Numbering(section.faces), Declarations(section.faces, section.graph.size))


@dataclass(frozen=True, eq=False)
class PreambleStage:
    """Knows the faces, and takes labels, order and declarations of attributes; parts are derived unless labels come."""

    connectivity: ConnectivityStage
    section: Section
    numbering: Numbering
    declarations: Declarations
    partition: Partition | None = None

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        match arrival:
            case packets.Partition(data):
                graph = self.section.graph
                self._body.allowance.spend(labels_cost(graph, len(data)), len(data))
                labels = decode_labels(data, graph.offsets, graph.neighbours, self.connectivity.header.blocks)
                return replace(self, partition=partition_of_labels(labels))
            case packets.Order(data):
                return replace(self, numbering=self._numbering(data))
            case packets.Attribute() if self.section.is_last:
                return self._declared(arrival, queue)
            case packets.Damaged(type=FrameType.BLOCK | FrameType.ATTRIBUTE):
                queue.append(LossEvent(None, unreadable(arrival)))
                return self
            case packets.Damaged():
                raise unreadable(arrival)
            case _:
                section = self.section
                structure = Structure(self.connectivity, section, self.numbering, self.partition, self.declarations)
                if not self._body.tolerant:
                    for declared in self.declarations.known:
                        self.declarations.rows_of(declared, self.numbering)
                following = self._body.begin(structure)
                known = section.span.faces.start
                queue.append(self.numbering.event(section.graph.size, known, section.number, section.count))
                return following.accept(arrival, queue)

    @property
    def _body(self) -> DecoderSetup:
        return self.connectivity.setup

    def _declared(self, packet: packets.Attribute, queue: deque[Any]) -> Stage[Any]:
        try:
            return replace(self, declarations=self.declarations.add(packet, self._body.allowance))
        except BsmError as error:
            if not self._body.tolerant:
                raise
            queue.append(LossEvent(None, error))
            return self

    def _numbering(self, data: bytes) -> Numbering:
        header, allowance = self.connectivity.header, self._body.allowance
        allowance.keep(order_memory(header.vertices, header.faces), len(data))
        allowance.spend(order_cost(header.vertices, header.faces, len(data)), len(data))
        order, splits = decode_order(data, self.section.faces, header.vertices, allowance.limits)
        source = np.empty(header.vertices, np.int32)
        source[order.vertex_order] = np.arange(len(source), dtype=np.int32)
        if splits is None:
            return Numbering(order.faces, source, arrangement=order)
        if header.gop_frames and len(splits.loose):
            raise CorruptError("a sequence of frames with vertices in no face")
        given = np.where(splits.source < 0, -1, source[splits.source])
        return Numbering(splits.faces, given, splits.loose, order, splits=True)
