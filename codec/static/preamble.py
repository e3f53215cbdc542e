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
from bitstream.errors import CorruptError, OptionError, UnsupportedError
from bitstream.limits import Limits
from codec.arrays import Faces, Indices, Matrix, Order, Positions
from codec.blocks.overlap import Blocks, block_size, grow_blocks
from codec.blocks.partition import Partition, derive_partition, metis_partition, partition_of_labels
from codec.geometry.graph import Graph, component_sizes, graph_of_faces
from codec.geometry.mesh import TriangleMesh
from codec.static.events import Changes, ConnectivityEvent, HeaderEvent, LossEvent, unreadable
from codec.static.rules import Scheme, scheme_of
from codec.static.stages import Arrival, Stage, misplaced
from codec.static.units import Units, units_of

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
    notes : tuple of str
        What was changed.
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
    notes: tuple[str, ...]

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

    def cut(self, graph: Graph) -> Partition:
        """The partition of a graph."""
        parts = max(1, round(graph.size / self.size))
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
        notes=(f"{dropped} vertices that no face uses were left out",) if dropped else (),
    )


@dataclass(frozen=True, eq=False)
class Numbering:
    """How the user of a mesh numbers what was coded.

    Parameters
    ----------
    faces : int32 array, shape (m, 3)
        As the user knows them.
    source : int32 array, shape (k,), optional
        What each of the user's vertices was coded as, -1: not at all; None: as what has its number.
    loose : float64 array, shape (l, 3)
        Positions of the user's vertices that were not coded.
    """

    faces: Faces
    source: Indices | None = None
    loose: Positions = field(default_factory=lambda: np.zeros((0, 3)))

    def event(self, coded: int) -> ConnectivityEvent:
        """What a user has to know of it, where so many vertices are coded."""
        if self.source is None:
            loose = np.zeros(0, np.int32)
        else:
            loose = np.flatnonzero(self.source < 0).astype(np.int32)
        size = coded if self.source is None else len(self.source)
        return ConnectivityEvent(self.faces, size, Changes(loose, self.loose, np.ones(len(loose), np.bool_)))

    def of(self, vertices: Indices) -> Indices:
        """The user's numbers of coded vertices, of all copies of each."""
        return self.spread(vertices)[0]

    def spread(self, vertices: Indices) -> tuple[Indices, Order | slice]:
        """The user's numbers of coded vertices, and for each the row of `vertices` that it is a copy of."""
        if self._rows is None:
            return vertices, slice(None)
        starts, members = self._rows
        counts = starts[vertices + 1] - starts[vertices]
        rows = np.repeat(np.arange(len(vertices)), counts)
        within = np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
        return members[starts[vertices][rows] + within], rows

    def arranged(self, positions: Positions) -> Positions:
        """Positions of all coded vertices, shape (n, 3), as the user numbers them, shape (k, 3)."""
        if self.source is None:
            return positions
        arranged = positions[self.source]
        arranged[self.source < 0] = self.loose
        return arranged

    @cached_property
    def _rows(self) -> tuple[Order, Indices] | None:
        """Where each coded vertex's numbers begin, and all of these."""
        if self.source is None:
            return None
        order = np.argsort(self.source, kind="stable").astype(np.int32)[len(self.loose) :]
        coded = self.source[order]
        return np.searchsorted(coded, np.arange(coded.max(initial=-1) + 2)), order


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
    """

    header: Header
    faces: Faces
    graph: Graph
    numbering: Numbering
    partition: Partition | None

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
        partition = self.partition or derive_partition(self.graph, header.blocks)
        largest = int(np.diff(partition.bounds).max())
        if largest > header.block_size:
            raise CorruptError(f"a part of {largest} vertices in blocks of {header.block_size}")
        return scheme_of(header, self.faces, grow_blocks(self.graph, partition, header.block_size))


@dataclass(frozen=True)
class Body:
    """What a decoder is for: which headers it takes, and what comes behind the preamble."""

    limits: Limits
    check: Callable[[Header], None]
    begin: Callable[[Structure], Stage[Any]]


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
        header = self.header
        faces = decode_connectivity(arrival.data, header.vertices, header.faces, self.body.limits)
        return Connected(self.body, header, faces, graph_of_faces(faces, header.vertices), Numbering(faces))


@dataclass(frozen=True, eq=False)
class Connected:
    """The faces are known, and what has come of labels and order; the parts are derived unless labels come."""

    body: Body
    header: Header
    faces: Faces
    graph: Graph
    numbering: Numbering
    partition: Partition | None = None

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        match arrival:
            case packets.Partition(method, data):
                _check_method("partition", method, PARTITION_METHOD)
                labels = decode_labels(data, self.graph.offsets, self.graph.neighbours, self.header.blocks)
                return replace(self, partition=partition_of_labels(labels))
            case packets.Order(method, data):
                return replace(self, numbering=self._numbering(method, data))
            case packets.Damaged(type=FrameType.BLOCK):
                queue.append(LossEvent(None, unreadable(arrival)))
                return self
            case packets.Damaged():
                raise unreadable(arrival)
            case _:
                following = self.body.begin(
                    Structure(self.header, self.faces, self.graph, self.numbering, self.partition)
                )
                queue.append(self.numbering.event(self.header.vertices))
                return following.accept(arrival, queue)

    def _numbering(self, method: int, data: bytes) -> Numbering:
        split = method == SPLITS_METHOD and not self.header.gop_frames
        if not split:
            _check_method("order", method, ORDER_METHOD)
        cursor = Cursor(data)
        arrangement = cursor.take(cursor.varint()) if split else data
        order = decode_arrangement(arrangement, self.faces, self.header.vertices)
        source = np.empty(self.header.vertices, np.int32)
        source[order.vertex_order] = np.arange(len(source), dtype=np.int32)
        if not split:
            return Numbering(order.faces, source)
        splits = decode_splits(cursor.rest(), order.faces, len(source), self.body.limits)
        return Numbering(splits.faces, np.where(splits.source < 0, -1, source[splits.source]), splits.loose)


def _check_method(what: str, method: int, known: int) -> None:
    if method != known:
        raise UnsupportedError(f"{what} method {method} is unknown to this decoder")
