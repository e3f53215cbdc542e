"""What comes before positions, decoded in three stages: header, faces, then labels, order and declarations."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bsm.bitstream.connectivity.faces import decode_connectivity
from bsm.bitstream.connectivity.partition import decode_labels
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.splits import decode_order
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import BsmError, CorruptError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces
from bsm.codec.blocks.overlap import Partition, derive_partition, grow_blocks, partition_of_labels
from bsm.codec.geometry.graph import Graph, graph_of_faces
from bsm.codec.signal.chain import AS_SPECIFIED, Overrides
from bsm.codec.static import work
from bsm.codec.static.attributes.decoding import Declarations
from bsm.codec.static.coding import Scheme, scheme_of
from bsm.codec.static.events import HeaderEvent, LossEvent, unreadable
from bsm.codec.static.numbering import Numbering
from bsm.codec.static.stages import Arrival, Stage, misplaced
from bsm.codec.static.units import Units


@dataclass(frozen=True, eq=False)
class Structure:
    """What a decoder knows before the first block."""

    setup: DecoderSetup
    header: Header
    faces: Faces
    graph: Graph
    numbering: Numbering
    partition: Partition | None
    declarations: Declarations

    @property
    def allowance(self) -> work.Allowance:
        return self.setup.allowance

    @property
    def units(self) -> Units:
        return Units(self.header.center, self.header.scale)

    @cached_property
    def scheme(self) -> Scheme:
        header, setup = self.header, self.setup
        copies = header.blocks * header.block_size
        self.allowance.keep(work.COPY_MEMORY * copies)
        self.allowance.spend(work.partition_cost(self.graph, header.blocks, copies))
        partition = self.partition or derive_partition(self.graph, header.blocks, setup.threads)
        largest = int(np.diff(partition.bounds).max())
        if largest > header.block_size:
            raise CorruptError(f"a part of {largest} vertices in blocks of {header.block_size}")
        return scheme_of(header, grow_blocks(self.graph, partition, header.block_size), setup.overrides)


@dataclass(frozen=True)
class DecoderSetup:
    """Which headers a decoder takes, what it may spend, which stage comes behind, and what is tried."""

    allowance: work.Allowance
    check: Callable[[Header], None]
    begin: Callable[[Structure], Stage[Any]]
    tolerant: bool = False
    overrides: Overrides = AS_SPECIFIED
    threads: int | None = 1


@dataclass(frozen=True, eq=False)
class HeaderStage:
    setup: DecoderSetup

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, Header):
            raise unreadable(arrival) if isinstance(arrival, packets.Damaged) else misplaced(arrival)
        self.setup.check(arrival)
        queue.append(HeaderEvent(arrival))
        return ConnectivityStage(self.setup, arrival)


@dataclass(frozen=True, eq=False)
class ConnectivityStage:
    setup: DecoderSetup
    header: Header

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, packets.Connectivity):
            raise unreadable(arrival) if isinstance(arrival, packets.Damaged) else misplaced(arrival)
        header, allowance, received = self.header, self.setup.allowance, len(arrival.data)
        faces = decode_connectivity(arrival.data, header.vertices, header.faces, allowance.limits)
        allowance.grant(header.vertices)
        allowance.keep(work.mesh_memory(header.vertices, header.faces), received)
        allowance.spend(work.mesh_cost(header.vertices, header.faces, received), received)
        graph = graph_of_faces(faces, header.vertices)
        return PreambleStage(self.setup, header, faces, graph, Numbering(faces), Declarations(faces, header.vertices))


@dataclass(frozen=True, eq=False)
class PreambleStage:
    """Knows the faces, and takes labels, order and declarations of attributes; parts are derived unless labels come."""

    setup: DecoderSetup
    header: Header
    faces: Faces
    graph: Graph
    numbering: Numbering
    declarations: Declarations
    partition: Partition | None = None

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        match arrival:
            case packets.Partition(data):
                graph = self.graph
                self.setup.allowance.spend(work.labels_cost(graph, len(data)), len(data))
                labels = decode_labels(data, graph.offsets, graph.neighbours, self.header.blocks)
                return replace(self, partition=partition_of_labels(labels))
            case packets.Order(data):
                return replace(self, numbering=self._numbering(data))
            case packets.Attribute():
                return self._declared(arrival, queue)
            case packets.Damaged(type=FrameType.BLOCK | FrameType.ATTRIBUTE):
                queue.append(LossEvent(None, unreadable(arrival)))
                return self
            case packets.Damaged():
                raise unreadable(arrival)
            case _:
                structure = Structure(
                    self.setup, self.header, self.faces, self.graph, self.numbering, self.partition, self.declarations
                )
                if not self.setup.tolerant:
                    for declared in self.declarations.known:
                        self.declarations.rows_of(declared, self.numbering)
                following = self.setup.begin(structure)
                queue.append(self.numbering.event(self.graph.size))
                return following.accept(arrival, queue)

    def _declared(self, packet: packets.Attribute, queue: deque[Any]) -> Stage[Any]:
        try:
            return replace(self, declarations=self.declarations.add(packet, self.setup.allowance))
        except BsmError as error:
            if not self.setup.tolerant:
                raise
            queue.append(LossEvent(None, error))
            return self

    def _numbering(self, data: bytes) -> Numbering:
        header, allowance = self.header, self.setup.allowance
        allowance.keep(work.order_memory(header.vertices, header.faces), len(data))
        allowance.spend(work.order_cost(header.vertices, header.faces, len(data)), len(data))
        order, splits = decode_order(data, self.faces, header.vertices, allowance.limits)
        source = np.empty(header.vertices, np.int32)
        source[order.vertex_order] = np.arange(len(source), dtype=np.int32)
        if splits is None:
            return Numbering(order.faces, source, arrangement=order)
        if header.gop_frames and len(splits.loose):
            raise CorruptError("a sequence of frames with vertices in no face")
        given = np.where(splits.source < 0, -1, source[splits.source])
        return Numbering(splits.faces, given, splits.loose, order, splits=True)
