"""Frames of attributes to attributes of a mesh: the decoder's stage behind positions, and what it ends with."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from bsm.bitstream.attributes.seams import Joins, decode_seams
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import CORNER, FACE, RECOMPUTED, Declaration
from bsm.bitstream.container.reader import Signal
from bsm.bitstream.errors import BsmError, CorruptError
from bsm.bitstream.fields.corners import Corners, corners_of
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Levels, Order
from bsm.codec.geometry.attributes import Attribute, Semantic
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static import work
from bsm.codec.static.attributes import surface
from bsm.codec.static.attributes.levels import KINDS, PieceDecoder, Values, from_pieces, restored
from bsm.codec.static.events import AttributeEvent, Losses, LossEvent, unreadable
from bsm.codec.static.numbering import Numbering
from bsm.codec.static.stages import Arrival, Ended, Stage, misplaced

SEMANTICS: tuple[Semantic, ...] = ("generic", "color", "normal", "texcoord")


@dataclass(frozen=True, eq=False)
class DeclaredAttribute:
    """An attribute before its values."""

    index: int
    declaration: Declaration
    joins: Joins | None


@dataclass(frozen=True, eq=False)
class Declarations:
    """The attributes that have been declared, over faces as they were coded."""

    faces: Faces
    vertices: int
    known: tuple[DeclaredAttribute, ...] = ()

    def add(self, packet: packets.Attribute, allowance: work.Allowance) -> Declarations:
        """With one more; its seams are paid for."""
        allowance.spend(work.DECLARED)
        every = [*(one.declaration for one in self.known), packet.declaration]
        allowance.limits.check("attribute_values", sum(numbers_of(one, len(self.faces)) for one in every))
        one = DeclaredAttribute(packet.index, packet.declaration, self._joins(packet, allowance))
        return replace(self, known=(*self.known, one))

    def rows_of(self, one: DeclaredAttribute, numbering: Numbering) -> int:
        """How many values of an attribute are coded (D 1.2), or belong to it, if it is recomputed."""
        declaration = one.declaration
        if declaration.domain == FACE:
            expected = len(self.faces)
        else:
            places = self.vertices if one.joins is None else one.joins.count
            expected = places + surface.loose_of(declaration, numbering)
        if declaration.coding != RECOMPUTED and declaration.rows != expected:
            raise CorruptError(f"attribute {declaration.name!r} has {declaration.rows} values where {expected} belong")
        return expected

    def _joins(self, packet: packets.Attribute, allowance: work.Allowance) -> Joins | None:
        declaration = packet.declaration
        if declaration.domain != CORNER:
            return None
        if declaration.seams_of:
            shared = [one.joins for one in self.known if one.index == declaration.seams_of - 1]
            if not shared or shared[0] is None:
                raise CorruptError(f"the seams of {declaration.name!r} are those of an attribute that is missing")
            return shared[0]
        if len(self.known) < packet.index:
            raise CorruptError(f"the seams of {declaration.name!r} depend on those of an attribute that is missing")
        faces, received = len(self.faces), len(packet.seams)
        allowance.keep(work.seams_kept(self.vertices, faces, first=not self._with_seams), received)
        allowance.afford(work.seams_memory(self.vertices, faces))
        allowance.spend(work.seams_cost(self.vertices, faces, received), received)
        earlier = tuple(one.joins.seams for one in self._with_seams[-2:])
        return Joins(self._corners, decode_seams(packet.seams, self._corners, earlier))

    @property
    def _with_seams(self) -> list[Any]:
        return [one for one in self.known if one.joins is not None and not one.declaration.seams_of]

    @property
    def _corners(self) -> Corners:
        return self._with_seams[0].joins.corners if self._with_seams else corners_of(self.faces, self.vertices)


def numbers_of(declaration: Declaration, faces: int) -> int:
    """Numbers that an attribute has at most, coded or not (F 5.8)."""
    rows = 3 * faces if declaration.coding == RECOMPUTED else declaration.rows
    return rows * max(declaration.words, declaration.components)


class Whole(Protocol):
    """What a decoder has put together before attributes."""

    def mesh(self, checksum: int | None = None) -> TriangleMesh:
        """The mesh in its own unit; where nothing of it is lost, `checksum` must be that of its positions."""

    def losses(self) -> Losses:
        """What of it is missing or less good."""

    def solid(self) -> surface.Solid | None:
        """Decoded positions, in the order of coding; None where some are missing or not as the encoder had them."""


class MeshContext(Protocol):
    """What is known of a mesh when its attributes come; a part of `Structure`."""

    @property
    def declarations(self) -> Declarations: ...
    @property
    def numbering(self) -> Numbering: ...
    @property
    def allowance(self) -> work.Allowance: ...


class AttributeDecoder:
    """One attribute, while its values come."""

    def __init__(self, declared: DeclaredAttribute, structure: MeshContext) -> None:
        declaration, declarations = declared.declaration, structure.declarations
        self.declaration = declaration
        self.complete = declaration.coding == RECOMPUTED
        self._declared = declared
        self._structure = structure
        self._loose = surface.loose_of(declaration, structure.numbering)
        self._surface: surface.Surface = surface.surface_of(
            declaration.domain, declarations.faces, declarations.vertices, self._loose, declared.joins
        )
        expected = self._rows = declarations.rows_of(declared, structure.numbering)
        structure.allowance.keep(work.values_memory(expected, len(declarations.faces), declaration.components))
        if self.complete:
            structure.allowance.afford(work.recomputing_memory(expected, len(declarations.faces)))
        structure.allowance.spend(work.values_cost(expected, len(declarations.faces)))
        self._coder: PieceDecoder | None = None

    def decode(self, packet: packets.Values, places: Levels | None) -> AttributeEvent:
        """Decode a chunk of its values; what decodes them is given up behind the last."""
        if self.complete:
            raise CorruptError("it has all its values already")
        allowance, faces = self._structure.allowance, len(self._surface.faces)
        coding = work.coding_memory(self._rows, faces, self.declaration.components)
        if self._coder is None:
            allowance.keep(coding)
            allowance.spend(work.layer_cost(self._rows, faces, self.declaration.components))
            self._coder = PieceDecoder(self.declaration, self._surface, places, allowance.limits)
        allowance.keep(0.0, len(packet.data))
        allowance.spend(work.chunk_cost(len(packet.data), self._rows), len(packet.data))
        coder = self._coder
        if packet.first != coder.coded:
            raise CorruptError(f"the values before number {packet.first} are missing; others depend on them")
        rows, pieces = coder.chunk(packet.data, packet.count)
        self._values[rows] = restored(self.declaration, from_pieces(self.declaration, pieces))
        self.complete = coder.coded == self._rows
        if self.complete:
            self._coder = None
            allowance.keep(-coding)
        fresh = np.zeros(self._rows, np.bool_)
        fresh[rows] = True
        shown = np.flatnonzero(fresh[self.arrangement.rows]).astype(np.int32)
        return AttributeEvent(
            self.declaration.name,
            self.arrangement.domain,
            SEMANTICS[self.declaration.semantic],
            self.arrangement.indices,
            shown,
            self._values[self.arrangement.rows[shown]],
        )

    def attribute(self, solid: surface.Solid | None) -> Attribute | None:
        """As the user knows it; None where it is not whole."""
        declaration = self.declaration
        values = self._values
        if declaration.coding == RECOMPUTED:
            if solid is None:
                return None
            values = surface.recomputed(self._surface, solid.positions).astype(KINDS[declaration.kind])
        elif not self.complete:
            return None
        arrangement = self.arrangement
        semantic = SEMANTICS[declaration.semantic]
        return Attribute(declaration.name, values[arrangement.rows], arrangement.domain, semantic, arrangement.indices)

    @property
    def first(self) -> Values | None:
        """Its values in the order of coding, shape (k, c); None where it is not whole."""
        return self._values if self.complete else None

    @cached_property
    def arrangement(self) -> surface.Arrangement:
        return surface.arrangement_of(self.declaration, self._surface, self._structure.numbering, self._rows)

    @cached_property
    def _values(self) -> Any:
        return np.zeros((self._rows, self.declaration.components), KINDS[self.declaration.kind])


class AttributeDecoders:
    """The attributes of a mesh, while their values come."""

    def __init__(self, structure: MeshContext) -> None:
        self._valued = {one.index: AttributeDecoder(one, structure) for one in structure.declarations.known}

    @property
    def recomputed(self) -> bool:
        return any(one.declaration.coding == RECOMPUTED for one in self._valued.values())

    def add(self, packet: packets.Values, places: Callable[[], Levels]) -> AttributeEvent:
        """Decode a chunk of values; `places` gives positions, shape (n, 3), if they lean on these."""
        valued = self._valued.get(packet.attribute)
        if valued is None:
            raise CorruptError(f"attribute {packet.attribute} is not declared")
        try:
            return valued.decode(packet, places() if valued.declaration.leans else None)
        except BsmError as error:
            raise type(error)(f"attribute {valued.declaration.name!r}: {error.message}") from error

    def moving(self) -> Iterator[tuple[int, Declaration, Values | None, Order]]:
        """Attributes that move: first values, shape (k, c), and which of them each vertex of the user has."""
        for number, one in self._valued.items():
            if one.declaration.moves:
                yield number, one.declaration, one.first, one.arrangement.rows

    def attribute(self, index: int) -> Attribute | None:
        """One that is not recomputed; None where it is not whole."""
        return self._valued[index].attribute(None)

    def attributes(self, solid: surface.Solid | None) -> tuple[Attribute, ...]:
        """Attributes that are whole; `solid` for those that are recomputed."""
        found = [one.attribute(solid) for one in self._valued.values()]
        return tuple(one for one in found if one is not None)


class AttributedMesh:
    """A mesh with its attributes."""

    def __init__(self, whole: Whole, structure: MeshContext) -> None:
        self._whole = whole
        self._carried = AttributeDecoders(structure)

    def add(self, packet: packets.Values) -> AttributeEvent:
        return self._carried.add(packet, lambda: self._places)

    def attributes(self) -> tuple[Attribute, ...]:
        return self._carried.attributes(self._whole.solid() if self._carried.recomputed else None)

    @cached_property
    def _places(self) -> Levels:
        solid = self._whole.solid()
        if solid is None or solid.places is None:
            raise CorruptError("positions are missing that attributes are predicted from")
        return solid.places


def without_positions() -> Levels:
    """For attributes of sequences: raises `CorruptError` in place of positions, shape (n, 3)."""
    raise CorruptError("attributes of a sequence cannot lean on positions")


@dataclass(frozen=True, eq=False)
class PendingValues:
    """Values of an attribute that wait for the positions before them."""

    packet: packets.Values
    attributed: AttributedMesh


@dataclass(frozen=True, eq=False)
class Complete(Ended):
    """All that is wanted is there, or known to be lost, and what the stream says of it at its end."""

    whole: Whole
    attributed: AttributedMesh | None
    checksum: int | None

    def mesh(self) -> TriangleMesh:
        """The mesh, with the attributes that are whole."""
        mesh = self.whole.mesh(self.checksum)
        return replace(mesh, attributes=self.attributed.attributes()) if self.attributed else mesh


class BodyStage:
    """Positions come, or values: how these follow, and how a stream ends, is the same for all ways."""

    def __init__(self, whole: Whole, structure: MeshContext, tolerant: bool) -> None:
        self._whole = whole
        self._context = structure
        self._tolerant = tolerant
        self._complete: Complete | None = None

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        match arrival:
            case packets.Values():
                self._give_up(queue)
                return ValuesStage(self._whole, self._context, self._tolerant).accept(arrival, queue)
            case packets.Damaged():
                self._lose(arrival, queue)
            case packets.End():
                self._end(queue, arrival.positions)
            case Signal.END_OF_STREAM:
                return self._complete or self._end(queue)  # a tolerant reader may find no END
            case _:
                raise misplaced(arrival)
        return self

    def _give_up(self, queue: deque[Any]) -> None:
        """Say which positions will not come."""

    def _lose(self, damaged: packets.Damaged, queue: deque[Any]) -> None:
        queue.append(LossEvent(None, unreadable(damaged)))

    @property
    def _attributed(self) -> AttributedMesh | None:
        return AttributedMesh(self._whole, self._context) if self._context.declarations.known else None

    def _end(self, queue: deque[Any], checksum: int | None = None) -> Complete:
        self._give_up(queue)
        self._complete = Complete(self._whole, self._attributed, checksum)
        queue.append(self._complete)
        return self._complete


class ValuesStage(BodyStage):
    """All positions are there, or known to be lost; values of attributes come."""

    @cached_property
    def _attributed(self) -> AttributedMesh:
        return AttributedMesh(self._whole, self._context)

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, packets.Values):
            return super().accept(arrival, queue)
        queue.append(PendingValues(arrival, self._attributed))
        return self
