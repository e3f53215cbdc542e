"""What comes before the first block: the faces and everything that follows from them; for meshes and for sequences.

`prepare` makes it from a mesh; the decoder gets the same from packets, in three stages (`codec.static.stages`):
`Beginning` waits for the header, `Opened` for the faces, `Connected` for labels and order, until something else comes.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bitstream.connectivity.faces import decode_connectivity, encode_connectivity
from bitstream.connectivity.order import decode_arrangement, encode_arrangement
from bitstream.connectivity.partition import decode_labels, encode_labels
from bitstream.container import packets
from bitstream.container.header import Header
from bitstream.container.wire import FrameType
from bitstream.errors import CorruptError, UnsupportedError
from bitstream.limits import Limits
from codec.arrays import Faces, Indices, Matrix, Order, Positions
from codec.blocks.overlap import Blocks, block_size, grow_blocks
from codec.blocks.partition import Partition, derive_partition, metis_partition, partition_of_labels
from codec.geometry.graph import Graph, graph_of_faces
from codec.geometry.mesh import TriangleMesh
from codec.static.events import ConnectivityEvent, HeaderEvent, LossEvent, unreadable
from codec.static.rules import Scheme, scheme_of
from codec.static.stages import Arrival, Stage, misplaced
from codec.static.units import Units, units_of

CONNECTIVITY_METHOD = 1
"""The valence-driven coder of `bitstream.connectivity.faces`."""
PARTITION_METHOD = 0
"""The labels of `bitstream.connectivity.partition`."""
ORDER_METHOD = 1
"""The permutations of `bitstream.connectivity.order`."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """A mesh before its positions are coded.

    Parameters
    ----------
    mesh : TriangleMesh
        In the order of coding, without the vertices that no face uses.
    size : int
        n_d.
    blocks : Blocks
    units : Units
    positions : float64 array, shape (n, 3)
        Of `mesh`, in BSM units.
    packets : tuple of packets
        What the stream holds between header and blocks.
    coding_order : int64 array, shape (n,)
        The given vertex that is coded as each vertex.
    vertex_order, face_order : int64 arrays, shapes (n,) and (m,)
        The given vertex and face that the decoder's user will know by each number.
    notes : tuple of str
        What was changed.
    """

    mesh: TriangleMesh
    size: int
    blocks: Blocks
    units: Units
    positions: Matrix
    packets: tuple[packets.Connectivity | packets.Partition | packets.Order, ...]
    coding_order: Order
    vertex_order: Order
    face_order: Order
    notes: tuple[str, ...]

    @property
    def graph(self) -> Graph:
        """Of `mesh`."""
        return self.blocks.graph


def prepare(mesh: TriangleMesh, *, part_size: int, overlap: float, keep_order: bool, metis: bool = False) -> Prepared:
    """Code the connectivity, cut the mesh into parts of about `part_size` vertices, and grow the blocks."""
    used, kept = mesh.without_isolated_vertices()
    dropped = len(mesh.positions) - len(kept)
    connectivity = encode_connectivity(used.faces, len(kept))
    coding_order = kept[connectivity.vertex_order]
    ordered = TriangleMesh(mesh.positions[coding_order], connectivity.faces)
    graph = graph_of_faces(ordered.faces, len(kept))
    parts = max(1, round(len(kept) / part_size))
    partition = metis_partition(graph, parts) if metis else derive_partition(graph, parts)
    sent: list[packets.Connectivity | packets.Partition | packets.Order] = [
        packets.Connectivity(CONNECTIVITY_METHOD, connectivity.payload)
    ]
    if metis:
        labels = encode_labels(graph.offsets, graph.neighbours, partition.labels, partition.parts)
        sent.append(packets.Partition(PARTITION_METHOD, labels))
    if keep_order:
        sent.append(packets.Order(ORDER_METHOD, encode_arrangement(used.faces, connectivity)))
    units, size = units_of(ordered), block_size(partition, overlap)
    return Prepared(
        mesh=ordered,
        size=size,
        blocks=grow_blocks(graph, partition, size),
        units=units,
        positions=units.into(ordered.positions),
        packets=tuple(sent),
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
    order : int32 array, shape (n,), optional
        Number that the user knows each vertex by; None: its own.
    """

    faces: Faces
    order: Indices | None = None

    def of(self, vertices: Indices) -> Indices:
        """The user's numbers of vertices."""
        return vertices if self.order is None else self.order[vertices]

    def arranged(self, positions: Positions) -> Positions:
        """Positions of all vertices, shape (n, 3), as the user numbers them."""
        if self.order is None:
            return positions
        arranged = np.empty_like(positions)
        arranged[self.order] = positions
        return arranged


@dataclass(frozen=True, eq=False)
class Structure:
    """What a decoder knows before the first block.

    Parameters
    ----------
    header : Header
    faces : int32 array, shape (m, 3)
        As they were coded.
    numbering : Numbering
    units : Units
    scheme : Scheme
    """

    header: Header
    faces: Faces
    numbering: Numbering
    units: Units
    scheme: Scheme


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
                _check_method("order", method, ORDER_METHOD)
                order = decode_arrangement(data, self.faces, self.header.vertices)
                return replace(self, numbering=Numbering(order.faces, order.vertex_order))
            case packets.Damaged(type=FrameType.BLOCK):
                queue.append(LossEvent(None, unreadable(arrival)))
                return self
            case packets.Damaged():
                raise unreadable(arrival)
            case _:
                following = self.body.begin(self._structure())
                queue.append(ConnectivityEvent(self.numbering.faces))
                return following.accept(arrival, queue)

    def _structure(self) -> Structure:
        header = self.header
        partition = self.partition or derive_partition(self.graph, header.blocks)
        largest = int(np.diff(partition.bounds).max())
        if largest > header.block_size:
            raise CorruptError(f"a part of {largest} vertices in blocks of {header.block_size}")
        scheme = scheme_of(header, self.faces, grow_blocks(self.graph, partition, header.block_size))
        return Structure(header, self.faces, self.numbering, Units(header.center, header.scale), scheme)


def _check_method(what: str, method: int, known: int) -> None:
    if method != known:
        raise UnsupportedError(f"{what} method {method} is unknown to this decoder")
