"""What comes before positions: the faces and everything that follows from them; for meshes and for sequences.

`prepare` makes it from a mesh; the decoder's half is `codec.static.preamble_decoding`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from bsm.bitstream.connectivity.faces import Cut, encode_connectivity
from bsm.bitstream.connectivity.partition import encode_labels
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import FREE_COPIES, MOST_COPIES
from bsm.bitstream.container.packets import Packet
from bsm.bitstream.container.splits import Splits, encode_order
from bsm.bitstream.errors import OptionError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Indices, Matrix, Order
from bsm.codec.blocks.overlap import Blocks, block_size, grow_blocks
from bsm.codec.blocks.partition import Partition, derive_last_parts, derive_partition, metis_partition
from bsm.codec.geometry.graph import Graph, component_sizes, graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.signal.bandwidth import MeasuredSpectrum
from bsm.codec.static.sections import choose_cuts, possible_cuts
from bsm.codec.static.units import Units, units_of

FEW_VERTICES = 300
"""Meshes of fewer have no low frequencies worth speaking of."""
SMALL_COMPONENT = 150
"""Vertices; a component of fewer has none either."""


@dataclass(frozen=True, eq=False)
class Area:
    """What the blocks of a section are made on."""

    faces: Faces
    graph: Graph
    first: int
    partition: Partition


@dataclass(frozen=True, eq=False)
class Prepared:
    """A mesh before its positions are coded."""

    mesh: TriangleMesh
    graph: Graph
    parts: Parts
    units: Units
    connectivity: packets.Connectivity
    cuts: tuple[Cut, ...]
    pieces: tuple[packets.Connectivity, ...]
    order: tuple[packets.Order, ...]
    coding_order: Order
    vertex_order: Order
    face_order: Order
    coding_faces: Order
    given: int
    notes: tuple[str, ...]
    joined_faces: Faces
    light: bool
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
        """Positions of `mesh` in BSM units, shape (n, 3)."""
        return self.units.into(self.mesh.positions)

    @cached_property
    def component_sizes(self) -> Indices:
        """Vertices of each connected component, shape (k,)."""
        return component_sizes(self.graph)

    @property
    def has_low_frequencies(self) -> bool:
        """Whether most vertices are in components that are large enough to have any."""
        large = self.component_sizes >= SMALL_COMPONENT
        return self.graph.size >= FEW_VERTICES and self.component_sizes[large].sum() >= 0.9 * self.graph.size

    @cached_property
    def areas(self) -> tuple[Area, ...]:
        """Where the blocks of each section come from."""
        if not self.cuts:
            return (Area(self.mesh.faces, self.graph, 0, self.parts.cut(self.graph)),)
        faces = [self.mesh.faces[: cut.faces] for cut in self.cuts]
        graphs = [graph_of_faces(some, cut.vertices) for some, cut in zip(faces, self.cuts, strict=True)]
        return tuple(
            Area(some, graph, own.start, derive_last_parts(graph, own.start, self.parts.count(len(own))))
            for some, graph, own in zip([*faces, self.mesh.faces], [*graphs, self.graph], self._own, strict=True)
        )

    @property
    def block_count(self) -> int:
        """How many blocks there are, of all sections."""
        return sum(self.parts.count(len(own)) for own in self._own)

    @property
    def _own(self) -> list[range]:
        return [range(*ends) for ends in pairwise((0, *(cut.vertices for cut in self.cuts), self.graph.size))]

    @property
    def size(self) -> int:
        """Vertices of the largest block, n_d."""
        size, parts = max(block_size(area.partition, self.parts.overlap) for area in self.areas), 0
        for area in self.areas:
            parts, vertices = parts + area.partition.parts, area.graph.size
            if parts * size > MOST_COPIES * vertices + FREE_COPIES:
                raise OptionError(
                    f"{parts} blocks of {size} of {vertices} vertices overlap too much; take a smaller one"
                )
        return size

    @cached_property
    def blocks(self) -> tuple[Blocks, ...]:
        """The blocks that the parts of each section grow to."""
        return tuple(grow_blocks(area.graph, area.partition, self.size) for area in self.areas)

    @property
    def sections(self) -> tuple[int, ...]:
        """What the header says of them: faces and blocks of each but the last."""
        ends = pairwise((0, *(cut.faces for cut in self.cuts)))
        pairs = zip((last - first for first, last in ends), self.blocks[:-1], strict=True)
        return tuple(number for faces, blocks in pairs for number in (faces, blocks.count))

    @property
    def before_blocks(self) -> tuple[packets.Connectivity | packets.Partition | packets.Order, ...]:
        """What the stream holds between header and blocks, those of the first section."""
        labels = self.parts.labels(self.graph, self.areas[0].partition)
        return (self.pieces[0], *labels, *self.order)

    def with_blocks(self, blocks: Sequence[packets.Block]) -> tuple[Packet, ...]:
        """All of the stream behind the header, up to the last block."""
        body: list[Packet] = [*self.before_blocks]
        done = self.blocks[0].count
        body.extend(blocks[:done])
        for piece, some in zip(self.pieces[1:], self.blocks[1:], strict=True):
            body.extend((piece, *blocks[done : done + some.count]))
            done += some.count
        return tuple(body)

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
        return (packets.Partition(labels),)


def prepare(
    mesh: TriangleMesh,
    parts: Parts,
    *,
    keep_order: bool,
    splits: Splits | None = None,
    sections: int | None = 1,
    light: bool = False,
) -> Prepared:
    """Code the connectivity of a mesh."""
    used, kept = mesh.without_isolated_vertices()
    dropped = len(mesh.positions) - len(kept)
    vertices = len(kept)
    connectivity = encode_connectivity(used.faces, vertices, possible_cuts(len(used.faces), vertices, sections))
    size = len(connectivity.payload)
    cuts = choose_cuts(connectivity.cuts, vertices, parts.count(vertices), size, sections)
    coding_order = kept[connectivity.vertex_order]
    ordered = TriangleMesh(mesh.positions[coding_order], connectivity.faces)
    order = (packets.Order(encode_order(used.faces, connectivity, splits)),) if keep_order else ()
    return Prepared(
        mesh=ordered,
        graph=graph_of_faces(ordered.faces, len(kept)),
        parts=parts,
        units=units_of(ordered),
        connectivity=packets.Connectivity(connectivity.payload),
        cuts=cuts,
        pieces=tuple(packets.Connectivity(piece) for piece in connectivity.pieces(cuts)),
        order=order,
        coding_order=coding_order,
        vertex_order=kept if keep_order else coding_order,
        face_order=np.arange(len(used.faces)) if keep_order else connectivity.face_order.astype(np.int64),
        coding_faces=connectivity.face_order.astype(np.int64),
        given=vertices if splits is None else len(splits.source),
        notes=(f"{dropped} vertices that no face uses were left out",) if dropped else (),
        joined_faces=mesh.faces,
        light=light,
    )
