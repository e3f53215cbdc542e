"""Everything before positions: the faces and all that follows from them; for meshes and sequences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._core import Cut, Field, GivenMesh
from bsm._core.bitstream import constant
from bsm.bitstream.connectivity.faces import WHERE_SMALLER, EncodedConnectivity
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.packets import Packet, SectionWriter, write_brief
from bsm.bitstream.container.wire import FrameType, write_frame
from bsm.bitstream.errors import MeshError, OptionError, TargetError, counted
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Indices, Levels, Matrix, Order, Positions, sealed
from bsm.codec.blocks import overlap
from bsm.codec.blocks.overlap import (
    Blocks,
    Partition,
    block_size,
    derive_partition,
    grow_blocks,
    metis_partition,
)
from bsm.codec.geometry.graph import Graph, components, graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.codec.geometry.welding import group_rows
from bsm.codec.signal.transform import MeasuredSpectrum
from bsm.codec.static.units import Units, checksum_of, units_of

MERGED = "merged"


@dataclass(frozen=True, eq=False)
class JoinedMesh:
    """A given mesh after joining; `coder` has it in the order of coding as well, once that is known."""

    mesh: TriangleMesh
    index: Indices
    first: Order
    coded_faces: Indices  # the given faces that are coded
    splits: Order | None  # the given vertices that come back; None: the joined ones do
    notes: tuple[str, ...]
    coder: GivenMesh | None  # None: nothing is coded from it anymore
    original_positions: Positions

    @property
    def coding(self) -> GivenMesh:
        """The coder, where something is still coded from it."""
        assert self.coder is not None
        return self.coder

    @property
    def losses(self) -> tuple[str, ...]:
        """The notes that say what does not come back; a vertex that was merged does, at its place."""
        return tuple(note for note in self.notes if not note.startswith(MERGED))


def join(mesh: TriangleMesh, *, keep: bool, exact: bool = False) -> JoinedMesh:
    """Make vertices at one position one, and see what `joined` says."""
    notes: tuple[str, ...] = ()
    if exact:
        mesh, notes = _single(mesh)
    rows = mesh.positions
    if exact:  # such streams keep the sign of zero, so positions that differ only there stay two
        rows = mesh.positions.view(np.int64)
    mesh_of_joined = joined(mesh, group_rows(rows), keep=keep)
    return replace(mesh_of_joined, notes=(*notes, *mesh_of_joined.notes))


def joined(
    mesh: TriangleMesh, index: Indices, *, keep: bool, keep_loose: bool = True
) -> JoinedMesh:
    # The object in C keeps what joining finds. Connectivity, order and attributes are coded from it without another
    # pass.
    notes, splits = [], None
    coder = GivenMesh(mesh.faces, index)
    index, first, coded_faces, merged, loose = coder.join(keep, keep and keep_loose)
    # A stream that keeps the order gives back the vertices as they were, copies included.
    if keep and (merged or (loose and keep_loose)):
        splits = np.flatnonzero((index >= 0) | keep_loose)
    if merged and not keep:
        notes.append(f"{MERGED} {counted(vertices=merged)} with others at the same position")
    collapsed = len(mesh.faces) - len(coded_faces)
    if collapsed:
        notes.append(f"left out {counted(faces=collapsed)} without area")
    if loose and not (keep and keep_loose):
        notes.append(f"left out {counted(vertices=loose)} that no face uses")
    return JoinedMesh(
        _coded_mesh(mesh, index, first, coded_faces),
        index,
        first.astype(np.int64),
        coded_faces,
        splits,
        tuple(notes),
        coder,
        mesh.positions,
    )


def _coded_mesh(
    mesh: TriangleMesh, index: Indices, first: Indices, coded_faces: Indices
) -> TriangleMesh:
    """The faces that are coded, on joined vertices; it shares the arrays of a mesh that joining does not change."""
    same_sizes = len(first) == len(mesh.positions) and len(coded_faces) == len(mesh.faces)
    if same_sizes and (np.diff(first) > 0).all():
        return TriangleMesh(mesh.positions, mesh.faces)
    positions = sealed(mesh.positions[first])
    return TriangleMesh(positions, sealed(index[mesh.faces[coded_faces]]))


MOST_CELLS = 1 << 20  # along an axis of a grid
LOST_OF_DIAGONAL, LOST_OF_EDGE = 1e-6, 1e-3  # by rounding to single precision, at most


def _single(mesh: TriangleMesh) -> tuple[TriangleMesh, tuple[str, ...]]:
    """Return the mesh in single precision, as doubles, and notes; `TargetError` if that moves it visibly."""
    with np.errstate(over="ignore"):
        # Files hold single precision nearly always, and then nothing is lost here.
        single = mesh.positions.astype(np.float32).astype(np.float64)
    if not np.isfinite(single).all():
        raise MeshError(
            "a coordinate is beyond the range of single precision, which lossless keeps; scale the mesh"
        )
    error = float(np.abs(single - mesh.positions).max(initial=0.0))
    if error == 0.0:
        return mesh, ()
    # Of the edge as well: a mesh far from the origin, or a long one with fine detail, loses its detail before its
    # diagonal notices.
    if error > LOST_OF_DIAGONAL * mesh.diagonal or error > LOST_OF_EDGE * _usual_edge(mesh):
        share = 100 * error / (mesh.diagonal or error)
        raise TargetError(
            f"lossless keeps single precision, which moves a vertex by {error:.3g}, "
            f"{share:.2g} % of the diagonal; a grid is more exact: in place of the preset, "
            f"give {_grid_options(mesh, error)}"
        )
    changed = int((single != mesh.positions).sum())
    note = f"{changed} coordinates were rounded to single precision, by {error:.2g}"
    return replace(mesh, positions=single), (note,)


def _usual_edge(mesh: TriangleMesh) -> float:
    """The median length of edges that have any; infinite where none has."""
    begins = mesh.positions[mesh.faces[:, 0]]
    ends = mesh.positions[mesh.faces[:, 1]]
    edges = np.linalg.norm(begins - ends, axis=1)
    if not edges.any():
        return math.inf
    return float(np.median(edges[edges > 0.0]))


def _grid_options(mesh: TriangleMesh, error: float) -> str:
    """Advice that can be typed in: a power of ten that is fine enough, and an origin of whole numbers."""
    extent = float(np.ptp(mesh.positions, axis=0).max()) or error
    cell = 10.0 ** math.ceil(math.log10(extent / MOST_CELLS))
    corner = np.floor(mesh.positions.min(axis=0)).tolist()
    origin = ",".join(f"{value:.12g}" for value in corner)
    return f"--grid-cell {cell:g} --grid-origin={origin}"


# Below these, an encoder need not try blocks at all.
FEW_VERTICES = 300  # meshes of fewer have no low frequencies worth speaking of
SMALL_COMPONENT = 150  # vertices; a component of fewer has none either


@dataclass(frozen=True, eq=False)
class Prepared:
    """A mesh before its positions are coded."""

    mesh: TriangleMesh
    graph: Graph
    parts: Parts
    units: Units
    connectivity: packets.Connectivity
    repeats: int  # how faces that repeat a corner are coded, as in the header
    order: tuple[packets.Order, ...]
    coding_order: Order
    vertex_order: Order
    face_order: Indices
    coding_faces: Indices
    first_corners: npt.NDArray[np.uint8]
    joined_faces: Faces
    light: bool
    congruence: bool
    # Results that do not change a mesh are kept in it. A search comes back to them for each candidate.
    motions: dict[float, Matrix] = field(default_factory=dict, init=False, repr=False)
    """Transforms between parts, shape (k, 13), by the step for which they were sought."""
    _spectra: dict[float, MeasuredSpectrum] = field(default_factory=dict, init=False, repr=False)

    def spectrum(self, shift: float) -> MeasuredSpectrum:
        """How energy falls with frequency, by dictionaries with a delta; measured once."""
        if shift not in self._spectra:
            self._spectra[shift] = MeasuredSpectrum(self.blocks, self.positions, shift=shift)
        return self._spectra[shift]

    def of_coded(self, corners: Indices) -> Indices:
        """Return the values of corners of joined faces, shape (m, 3), in coding order."""
        # The coder turns faces so that they begin with the vertex that it met first. Values of corners must follow.
        columns = (self.first_corners[:, None] + np.arange(3)) % 3
        return np.take_along_axis(corners[self.coding_faces], columns, axis=1)

    @cached_property
    def positions(self) -> Matrix:
        return self.units.into(self.mesh.positions)

    @cached_property
    def reference(self) -> Reference:
        return Reference(self.positions, self.mesh.faces)

    @cached_property
    def components(self) -> Indices:
        """The connected component of each vertex, shape (n,)."""
        return components(self.graph)

    @property
    def has_low_frequencies(self) -> bool:
        """Whether most vertices are in components that are large enough to have any."""
        # A thousand screws have a million vertices, and none of them has low frequencies.
        if self.graph.size < FEW_VERTICES:
            return False
        sizes = np.bincount(self.components)
        in_large_ones = int(sizes[sizes >= SMALL_COMPONENT].sum())
        return in_large_ones >= 0.9 * self.graph.size

    @cached_property
    def partition(self) -> Partition:
        return self.parts.cut(self.graph)

    @cached_property
    def size(self) -> int:
        """Vertices of the largest block, n_d."""
        parts = self.partition.parts
        vertices = self.graph.size
        size = block_size(self.partition, self.parts.overlap)
        # Decoders refuse more copies, so that a short stream cannot ask for much memory.
        if parts * size > constant("MOST_COPIES") * vertices + constant("FREE_COPIES"):
            raise OptionError(
                f"{parts} blocks of {size} of {vertices} vertices overlap too much; take a smaller one"
            )
        return size

    @cached_property
    def blocks(self) -> Blocks:
        return grow_blocks(self.graph, self.partition, self.size)

    @property
    def fields(self) -> dict[str, Any]:
        """The fields of the header that every stream of this mesh has."""
        return {"vertices": self.graph.size, "faces": len(self.mesh.faces), "repeats": self.repeats}

    @property
    def before_blocks(self) -> tuple[packets.Connectivity | packets.Labels | packets.Order, ...]:
        """Return the packets between header and blocks."""
        return (self.connectivity, *self.parts.labels(self.graph, self.partition), *self.order)

    @property
    def before_grid(self) -> tuple[packets.Connectivity | packets.Order, ...]:
        """Return the packets between header and positions on a grid."""
        return (self.connectivity, *self.order)

    @cached_property
    def linked(self) -> Field:
        """A field on the faces: others share what follows from them."""
        # Linking the corners of faces takes a large part of the time of a small grid, and a search codes many.
        field = Field(self.mesh.faces, np.zeros((self.graph.size, 3), np.int32))
        field.grid(np.zeros(3, np.int32), 0, np.zeros(3), 1.0, None)
        return field


@dataclass(frozen=True)
class Parts:
    """How a mesh is cut into blocks: parts of about `size` vertices, grown by `overlap`; by METIS or as derived."""

    size: int
    overlap: float
    metis: bool = False

    @classmethod
    def of(cls, size: int, growth: float, rule: str) -> Parts:
        """Parts by a rule's name; without METIS those that decoders derive, so that nothing passes for METIS's."""
        # A reader who reproduces the paper must be able to trust a stream that says METIS.
        return cls(size, growth, rule == "metis" and overlap.HAS_METIS)

    def count(self, vertices: int) -> int:
        return max(1, round(vertices / self.size))

    def cut(self, graph: Graph) -> Partition:
        parts = self.count(graph.size)
        if self.metis:
            return metis_partition(graph, parts)
        return derive_partition(graph, parts)

    def labels(self, graph: Graph, partition: Partition) -> tuple[packets.Labels, ...]:
        """The labels of parts, where a decoder cannot derive them."""
        if not self.metis:
            return ()
        cut = Cut(graph.offsets, graph.neighbors)
        return (packets.Labels(cut.write(partition.labels, partition.parts)),)


def prepare(
    joined: JoinedMesh,
    parts: Parts,
    *,
    keep_order: bool,
    light: bool = False,
    congruence: bool = False,
    repeats: int = WHERE_SMALLER,
) -> Prepared:
    """Code the connectivity of a mesh."""
    mesh = joined.mesh
    connectivity = EncodedConnectivity(*joined.coding.code(repeats=repeats))
    coding_order = connectivity.vertex_order.astype(np.int64)
    coding_faces = np.ascontiguousarray(connectivity.face_order, np.int32)
    ordered = TriangleMesh(sealed(mesh.positions[coding_order]), sealed(connectivity.faces))
    prepared = Prepared(
        mesh=ordered,
        graph=graph_of_faces(ordered.faces, len(coding_order)),
        parts=parts,
        units=units_of(ordered),
        connectivity=packets.Connectivity(connectivity.payload),
        repeats=connectivity.repeats,
        order=(),
        coding_order=coding_order,
        vertex_order=coding_order,
        face_order=coding_faces,
        coding_faces=coding_faces,
        first_corners=connectivity.first_corners,
        joined_faces=mesh.faces,
        light=light,
        congruence=congruence,
    )
    if keep_order:
        return _in_given_order(prepared, joined)
    return prepared


def _in_given_order(prepared: Prepared, joined: JoinedMesh) -> Prepared:
    """Put the given order into a stream: it is decoded in that order, so for callers nothing has moved."""
    order = joined.coding.order(joined.original_positions)
    return replace(
        prepared,
        order=(packets.Order(order),),
        vertex_order=np.arange(len(prepared.coding_order)),
        face_order=np.arange(len(prepared.face_order), dtype=np.int32),
    )


@dataclass(frozen=True, eq=False)
class Draft:
    """A stream that might be written."""

    header: Header
    body: tuple[Packet, ...]
    decoded: Positions
    places: Levels | None = None
    may_be_brief: bool = False  # in format 1.1

    @cached_property
    def frames(self) -> tuple[bytes, ...]:
        return tuple(self._write())

    @property
    def size(self) -> int:
        return sum(map(len, self.frames))

    def _write(self) -> Iterator[bytes]:
        writer = SectionWriter()
        brief = None
        if self.may_be_brief and not self.header.light:
            # Framing takes about thirty bytes, a tenth of a stream of a small part.
            brief = write_brief(self.header, self.body)
        yield writer.start(self._minor_version(is_brief=brief is not None))
        if brief is not None:
            yield write_frame(FrameType.HEADER, brief)
            return
        for packet in (self.header, *self.body):
            yield writer.write(packet)
        # The sum of decoded positions tells a decoder that its arithmetic is that of the law: on a broken compiler it
        # says so.
        yield writer.end(checksum_of(self.decoded))

    def _minor_version(self, *, is_brief: bool) -> int:
        """The lowest version that knows everything in the stream, so that the oldest decoders still read what they
        can."""
        header = self.header
        if header.swift or header.repeats:
            return 3
        if header.base:
            return 2
        if is_brief or header.congruence > 0 or header.onorm > 0 or any(header.turn):
            return 1
        return 0
