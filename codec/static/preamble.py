"""What comes before positions: the faces and everything that follows from them; for meshes and for sequences.

`prepare` makes it from a mesh; the decoder gets the same from packets, in three stages (`codec.static.stages`):
`Beginning` waits for the header, `Opened` for the faces, `Connected` for labels and order, until something else comes.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from bitstream.connectivity.faces import decode_connectivity, encode_connectivity
from bitstream.connectivity.order import decode_arrangement, encode_arrangement
from bitstream.connectivity.partition import decode_labels, encode_labels
from bitstream.container import packets
from bitstream.container.header import FREE_COPIES, MOST_COPIES, Header
from bitstream.container.splits import Splits, decode_splits, encode_splits
from bitstream.container.wire import Cursor, FrameType, write_varint
from bitstream.errors import BsmError, CorruptError, OptionError, UnsupportedError
from codec.arrays import Faces, Indices, Matrix, Order
from codec.blocks.overlap import Blocks, block_size, grow_blocks
from codec.blocks.partition import Partition, derive_partition, metis_partition, partition_of_labels
from codec.geometry.graph import Graph, component_sizes, graph_of_faces
from codec.geometry.mesh import TriangleMesh
from codec.signal.bandwidth import MeasuredSpectrum
from codec.signal.chain import Rounding, unchanged
from codec.static.attributes.decoding import Declarations
from codec.static.events import HeaderEvent, LossEvent, unreadable
from codec.static.numbering import Numbering
from codec.static.rules import Scheme, scheme_of
from codec.static.stages import Arrival, Stage, misplaced
from codec.static.units import Units, units_of
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

CONNECTIVITY_METHOD = 1
"""The valence-driven coder of `bitstream.connectivity.faces`."""
FEW_VERTICES = 300
"""Meshes of fewer have no low frequencies worth speaking of."""
SMALL_COMPONENT = 150
"""Vertices; a component of fewer has none either."""
PARTITION_METHOD = 0
"""The labels of `bitstream.connectivity.partition`."""
ORDER_METHOD = 1
"""The permutations of `bitstream.connectivity.order`."""
SPLITS_METHOD = 2
"""The same, and behind it what `bitstream.container.splits` says."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """A mesh before its positions are coded.

    Parameters
    ----------
    mesh : TriangleMesh
        In the order of coding, without the vertices that no face uses.
    graph : Graph
        Of `mesh`.
    parts : Parts
        How it is cut, should it be.
    units : Units
    connectivity : packets.Connectivity
    order : tuple of packets.Order
        One, or none.
    coding_order : int64 array, shape (n,)
        The given vertex that is coded as each vertex.
    vertex_order, face_order : int64 arrays, shapes (n,) and (m,)
        The given vertex and face that the decoder's user will know by each number.
    coding_faces : int64 array, shape (m,)
        The given face that is coded as each face.
    notes : tuple of str
        What was changed.
    joined_faces : int32 array, shape (m, 3)
        The given faces.
    """

    mesh: TriangleMesh
    graph: Graph
    parts: Parts
    units: Units
    connectivity: packets.Connectivity
    order: tuple[packets.Order, ...]
    coding_order: Order
    vertex_order: Order
    face_order: Order
    coding_faces: Order
    notes: tuple[str, ...]
    joined_faces: Faces
    _spectra: dict[float, MeasuredSpectrum] = field(default_factory=dict, init=False, repr=False)

    def spectrum(self, shift: float) -> MeasuredSpectrum:
        """How energy falls with frequency, by dictionaries with a delta; measured once."""
        if shift not in self._spectra:
            self._spectra[shift] = MeasuredSpectrum(self.blocks, self.positions, shift=shift)
        return self._spectra[shift]

    @cached_property
    def turns(self) -> Order:
        """The corner of its joined face that is the first of each coded one, shape (m,)."""
        numbers = np.empty(int(self.joined_faces.max(initial=-1)) + 1, np.int64)
        numbers[self.coding_order] = np.arange(len(self.coding_order))
        given = numbers[self.joined_faces[self.coding_faces]]
        turned = [(np.roll(given, -k, axis=1) == self.mesh.faces).all(axis=1) for k in range(3)]
        return np.asarray(np.argmax(turned, axis=0))

    @cached_property
    def positions(self) -> Matrix:
        """Of `mesh`, in BSM units, shape (n, 3)."""
        return self.units.into(self.mesh.positions)

    @cached_property
    def component_sizes(self) -> Indices:
        """Vertices of each connected component."""
        return component_sizes(self.graph)

    @property
    def has_low_frequencies(self) -> bool:
        """Whether most vertices are in components that are large enough to have any."""
        large = self.component_sizes >= SMALL_COMPONENT
        return self.graph.size >= FEW_VERTICES and self.component_sizes[large].sum() >= 0.9 * self.graph.size

    @cached_property
    def partition(self) -> Partition:
        """Where blocks come from."""
        return self.parts.cut(self.graph)

    @property
    def size(self) -> int:
        """n_d.

        Raises
        ------
        OptionError
            If blocks of this size would hold more copies of each vertex than a stream may.
        """
        size, parts, vertices = block_size(self.partition, self.parts.overlap), self.partition.parts, self.graph.size
        if parts * size > MOST_COPIES * vertices + FREE_COPIES:
            raise OptionError(f"{parts} blocks of {size} of {vertices} vertices overlap too much; take a smaller one")
        return size

    @cached_property
    def blocks(self) -> Blocks:
        """The blocks that the parts grow to."""
        return grow_blocks(self.graph, self.partition, self.size)

    @property
    def before_blocks(self) -> tuple[packets.Connectivity | packets.Partition | packets.Order, ...]:
        """What the stream holds between header and blocks."""
        return (self.connectivity, *self.parts.labels(self.graph, self.partition), *self.order)

    @property
    def before_grid(self) -> tuple[packets.Connectivity | packets.Order, ...]:
        """What the stream holds between header and positions on a grid."""
        return (self.connectivity, *self.order)


@dataclass(frozen=True)
class Parts:
    """How a mesh is cut into blocks: parts of about `size` vertices, grown by `overlap`; by METIS or as derived."""

    size: int
    overlap: float
    metis: bool = False

    def count(self, vertices: int) -> int:
        """How many parts a mesh of so many vertices has."""
        return max(1, round(vertices / self.size))

    def cut(self, graph: Graph) -> Partition:
        """The partition of a graph."""
        parts = self.count(graph.size)
        return metis_partition(graph, parts) if self.metis else derive_partition(graph, parts)

    def labels(self, graph: Graph, partition: Partition) -> tuple[packets.Partition, ...]:
        """The labels of parts, where a decoder cannot derive them."""
        if not self.metis:
            return ()
        labels = encode_labels(graph.offsets, graph.neighbours, partition.labels, partition.parts)
        return (packets.Partition(PARTITION_METHOD, labels),)


def prepare(mesh: TriangleMesh, parts: Parts, *, keep_order: bool, splits: Splits | None = None) -> Prepared:
    """Code the connectivity of a mesh; `splits` are what a mesh whose order is kept needs to become the given one."""
    used, kept = mesh.without_isolated_vertices()
    dropped = len(mesh.positions) - len(kept)
    connectivity = encode_connectivity(used.faces, len(kept))
    coding_order = kept[connectivity.vertex_order]
    ordered = TriangleMesh(mesh.positions[coding_order], connectivity.faces)
    order: tuple[packets.Order, ...] = ()
    if keep_order:
        arrangement = encode_arrangement(used.faces, connectivity)
        order = (packets.Order(ORDER_METHOD, arrangement),)
        if splits is not None:
            order = (
                packets.Order(SPLITS_METHOD, write_varint(len(arrangement)) + arrangement + encode_splits(splits)),
            )
    return Prepared(
        mesh=ordered,
        graph=graph_of_faces(ordered.faces, len(kept)),
        parts=parts,
        units=units_of(ordered),
        connectivity=packets.Connectivity(CONNECTIVITY_METHOD, connectivity.payload),
        order=order,
        coding_order=coding_order,
        vertex_order=kept if keep_order else coding_order,
        face_order=np.arange(len(used.faces)) if keep_order else connectivity.face_order.astype(np.int64),
        coding_faces=connectivity.face_order.astype(np.int64),
        notes=(f"{dropped} vertices that no face uses were left out",) if dropped else (),
        joined_faces=mesh.faces,
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
