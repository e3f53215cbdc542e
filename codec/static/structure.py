"""What a decoder gets before positions, from what `codec.static.preamble` prepares.

It comes in packets, in three stages (`codec.static.stages`): `Beginning` waits for the header, `Opened` for the faces,
`Connected` for labels and order, until something else comes.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from bitstream.connectivity.faces import decode_connectivity
from bitstream.connectivity.order import decode_arrangement
from bitstream.connectivity.partition import decode_labels
from bitstream.container import packets
from bitstream.container.header import FREE_COPIES, MOST_COPIES, Header
from bitstream.container.splits import decode_splits
from bitstream.container.wire import Cursor, FrameType
from bitstream.errors import BsmError, CorruptError, UnsupportedError
from codec.arrays import Faces
from codec.blocks.overlap import grow_blocks
from codec.blocks.partition import Partition, derive_partition, partition_of_labels
from codec.geometry.graph import Graph, graph_of_faces
from codec.signal.chain import Rounding, unchanged
from codec.static.attributes.decoding import Declarations
from codec.static.events import HeaderEvent, LossEvent, unreadable
from codec.static.numbering import Numbering
from codec.static.preamble import CONNECTIVITY_METHOD, ORDER_METHOD, PARTITION_METHOD, SPLITS_METHOD
from codec.static.rules import Scheme, scheme_of
from codec.static.stages import Arrival, Stage, misplaced
from codec.static.units import Units
from codec.static.work import (
    COPY_MEMORY,
    Allowance,
    labels_cost,
    mesh_cost,
    mesh_memory,
    order_cost,
    order_memory,
    partition_cost,
)


@dataclass(frozen=True, eq=False)
class Structure:
    """What a decoder knows before the first block.

    Parameters
    ----------
    header : Header
    faces : int32 array, shape (m, 3)
        As they were coded.
    graph : Graph
    numbering : Numbering
    partition : Partition, optional
        That was sent; None: it is derived.
    declarations : Declarations
        Attributes.
    allowance : Allowance
        What may still be done.
    rounding : callable
        See `ChainRules`.
    threads : int, optional
        For what does not go block by block; None: one per core.
    """

    header: Header
    faces: Faces
    graph: Graph
    numbering: Numbering
    partition: Partition | None
    declarations: Declarations
    allowance: Allowance
    rounding: Rounding = unchanged
    threads: int | None = 1

    @property
    def units(self) -> Units:
        """What the header says of them."""
        return Units(self.header.center, self.header.scale)

    @cached_property
    def scheme(self) -> Scheme:
        """How blocks are coded.

        Raises
        ------
        CorruptError
            If a part is larger than the header allows for a block.
        """
        header = self.header
        copies = min(header.blocks * header.block_size, MOST_COPIES * header.vertices + FREE_COPIES)
        self.allowance.keep(COPY_MEMORY * copies)
        self.allowance.spend(partition_cost(self.graph, header.blocks, copies))
        partition = self.partition or derive_partition(self.graph, header.blocks, self.threads)
        largest = int(np.diff(partition.bounds).max())
        if largest > header.block_size:
            raise CorruptError(f"a part of {largest} vertices in blocks of {header.block_size}")
        blocks = grow_blocks(self.graph, partition, header.block_size)
        return scheme_of(header, self.faces, blocks, self.rounding)


@dataclass(frozen=True)
class Body:
    """What a decoder is for: which headers it takes, what it may do, what comes behind the preamble, and how numbers
    are rounded.
    """

    allowance: Allowance
    check: Callable[[Header], None]
    begin: Callable[[Structure], Stage[Any]]
    tolerant: bool = False
    rounding: Rounding = unchanged
    threads: int | None = 1


@dataclass(frozen=True, eq=False)
class Beginning:
    """Nothing is known."""

    body: Body

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, Header):
            raise unreadable(arrival) if isinstance(arrival, packets.Damaged) else misplaced(arrival)
        self.body.check(arrival)
        queue.append(HeaderEvent(arrival))
        return Opened(self.body, arrival)


@dataclass(frozen=True, eq=False)
class Opened:
    """The header is known."""

    body: Body
    header: Header

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, packets.Connectivity):
            raise unreadable(arrival) if isinstance(arrival, packets.Damaged) else misplaced(arrival)
        _check_method("connectivity", arrival.method, CONNECTIVITY_METHOD)
        header, allowance, received = self.header, self.body.allowance, len(arrival.data)
        faces = decode_connectivity(arrival.data, header.vertices, header.faces, allowance.limits)
        allowance.grant(header.vertices)
        allowance.keep(mesh_memory(header.vertices, header.faces), received)
        allowance.spend(mesh_cost(header.vertices, header.faces, received), received)
        graph, declarations = graph_of_faces(faces, header.vertices), Declarations(faces, header.vertices)
        return Connected(self.body, header, faces, graph, Numbering(faces), declarations)


@dataclass(frozen=True, eq=False)
class Connected:
    """The faces are known, and what has come of labels, order and attributes; parts are derived unless labels come."""

    body: Body
    header: Header
    faces: Faces
    graph: Graph
    numbering: Numbering
    declarations: Declarations
    partition: Partition | None = None

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        match arrival:
            case packets.Partition(method, data):
                _check_method("partition", method, PARTITION_METHOD)
                self.body.allowance.spend(labels_cost(self.graph, len(data)), len(data))
                labels = decode_labels(data, self.graph.offsets, self.graph.neighbours, self.header.blocks)
                return replace(self, partition=partition_of_labels(labels))
            case packets.Order(method, data):
                return replace(self, numbering=self._numbering(method, data))
            case packets.Attribute():
                return self._declared(arrival, queue)
            case packets.Damaged(type=FrameType.BLOCK | FrameType.ATTRIBUTE):
                queue.append(LossEvent(None, unreadable(arrival)))
                return self
            case packets.Damaged():
                raise unreadable(arrival)
            case _:
                structure = Structure(
                    self.header,
                    self.faces,
                    self.graph,
                    self.numbering,
                    self.partition,
                    self.declarations,
                    self.body.allowance,
                    self.body.rounding,
                    self.body.threads,
                )
                if not self.body.tolerant:
                    for declared in self.declarations.known:
                        self.declarations.rows_of(declared, self.numbering)
                following = self.body.begin(structure)
                queue.append(self.numbering.event(self.header.vertices))
                return following.accept(arrival, queue)

    def _declared(self, packet: packets.Attribute, queue: deque[Any]) -> Stage[Any]:
        try:
            return replace(self, declarations=self.declarations.add(packet, self.body.allowance.limits))
        except BsmError as error:
            if not self.body.tolerant:
                raise
            queue.append(LossEvent(None, error))
            return self

    def _numbering(self, method: int, data: bytes) -> Numbering:
        split = method == SPLITS_METHOD and not self.header.gop_frames
        if not split:
            _check_method("order", method, ORDER_METHOD)
        header, allowance = self.header, self.body.allowance
        allowance.keep(order_memory(header.vertices, header.faces), len(data))
        allowance.spend(order_cost(header.vertices, header.faces, len(data)), len(data))
        cursor = Cursor(data)
        arrangement = cursor.take(cursor.varint()) if split else data
        order = decode_arrangement(arrangement, self.faces, header.vertices)
        source = np.empty(header.vertices, np.int32)
        source[order.vertex_order] = np.arange(len(source), dtype=np.int32)
        if not split:
            return Numbering(order.faces, source, arrangement=order)
        splits = decode_splits(cursor.rest(), order.faces, len(source), allowance.limits)
        given = np.where(splits.source < 0, -1, source[splits.source])
        return Numbering(splits.faces, given, splits.loose, order, splits=True)


def _check_method(what: str, method: int, known: int) -> None:
    if method != known:
        raise UnsupportedError(f"{what} method {method} is unknown to this decoder")
