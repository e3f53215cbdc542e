"""The attributes of a given mesh to the frames of a stream."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._core import Field, GivenMesh, turned_tangents
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import (
    FACE,
    LEVELS,
    MOST_ATTRIBUTES,
    OCTAHEDRAL,
    RECOMPUTED,
    TANGENTS,
    TEXCOORD,
    Declaration,
    entries_of,
    values_of,
)
from bsm.bitstream.container.packets import Packet
from bsm.bitstream.container.wire import with_lengths, write_map
from bsm.bitstream.errors import OptionError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Indices, Levels, Matrix
from bsm.codec.geometry.attributes import DOMAINS, KINDS, SEMANTICS, Attribute
from bsm.codec.geometry.mesh import Metadata
from bsm.codec.look.measure import of_length_1, painted
from bsm.codec.look.pictures import Normals
from bsm.codec.static.attributes.quality import Quality
from bsm.codec.static.preamble_encoding import Draft

Values = npt.NDArray[Any]
CHUNK = 1 << 15  # values of a frame
# As library/bsmenc.h numbers them.
WAYS = ("default", "exact", "bits", "bound", "share", "angle", "recompute", "none")


@dataclass(frozen=True, eq=False)
class Surface:
    """The values of an attribute as vertices of a mesh of their own."""

    faces: Faces
    vertices: Indices


def recomputed(surface: Surface, positions: Matrix) -> Matrix:
    """Normals of the values of a surface: those of the faces around, by area (A 7); shape (k, 3)."""
    a, b, c = positions[surface.vertices][surface.faces.T]
    # The length of the cross product is the area, so large faces count more without a weight.
    across = np.cross(b - a, c - a)
    count = len(surface.vertices)
    sums = (
        np.array([np.bincount(corner, of_axis, count) for of_axis in across.T])
        for corner in surface.faces.T
    )
    normals = sum(sums, np.zeros((3, count))).T
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    has_face = lengths > 0.0
    # Some direction for values of no face, the same everywhere; no viewer shows it.
    return np.where(has_face, normals / np.where(has_face, lengths, 1.0), [0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class GivenTangents:
    """Values that have the form of tangents, shape (k, 4), and which of them each corner has, shape (3 m,)."""

    values: Matrix
    rows: Indices
    bits: int


@dataclass(frozen=True, eq=False)
class PreparedAttribute:
    """An attribute in the order of coding, before positions are known."""

    declaration: Declaration
    seams: bytes
    surface: Surface
    pieces: Levels
    swift: int  # how values are coded, as in the header
    leans: bool  # whether numbers are predicted from positions, should these be there
    values: Values
    """As decoders have them."""
    note: str
    tangents: GivenTangents | None = None

    @property
    def at_corners(self) -> Matrix:
        """What `AttributeLook` is given: the values of a decoder at corners, shape (m, 3 c)."""
        declaration = self.declaration
        if declaration.domain == FACE:
            corners = self.values[:, None].repeat(3, axis=1)
        else:
            corners = self.values[self.surface.faces]
        return painted(SEMANTICS[declaration.semantic], corners)

    # A promise of the look must hold with the normals that viewers will have, which depend on decoded positions.
    def normals(self, positions: Matrix) -> Normals:
        """What normals a decoder will have at corners, shape (m, 9), where it has these positions, shape (n, 3)."""
        values = self.values
        if self.declaration.coding == RECOMPUTED:
            values = recomputed(self.surface, positions)
        return of_length_1(values[self.surface.faces])

    @property
    def size(self) -> int:
        return sum(map(len, (self.seams, *self.plain)))

    @cached_property
    def plain(self) -> tuple[bytes, ...]:
        return self.chunks(None, CHUNK)

    def chunks(self, places: Levels | None, size: int) -> tuple[bytes, ...]:
        """The chunks of its values, `size` each, predicted from `places`, shape (n, 3), if there are any."""
        if self.declaration.coding == RECOMPUTED:
            return ()
        field = field_of(self.declaration, self.surface, self.pieces, places, self.swift)
        return tuple(write_values(field, count) for _, count in ranges(self.declaration.rows, size))


def carry(
    place: GivenMesh, faces: Faces, chosen: Iterable[tuple[Attribute, Quality]], swift: int
) -> tuple[PreparedAttribute, ...]:
    """Attributes in the order of coding, on coded faces; `swift` as in the header."""
    chosen = tuple(chosen)
    if len(chosen) > MOST_ATTRIBUTES:
        raise OptionError(
            f"a stream has {MOST_ATTRIBUTES} attributes at most, not {len(chosen)}: leave some out"
        )
    return tuple(
        _carry(place, faces, not number, swift, *each) for number, each in enumerate(chosen)
    )


def _carry(
    place: GivenMesh, faces: Faces, first: bool, swift: int, attribute: Attribute, quality: Quality
) -> PreparedAttribute:
    """The first attribute, or the next one."""
    kind = KINDS.index(attribute.values.dtype.name)
    semantic = SEMANTICS.index(attribute.semantic)
    domain = DOMAINS.index(attribute.domain)
    way = WAYS.index(quality.way)
    values = np.ascontiguousarray(attribute.values)
    # All in C, where the order of coding is: corners, seams and integers in one pass, as the C encoder has it, too.
    form = kind, domain, semantic
    results = place.carry(
        first, attribute.name, values, *form, attribute.indices, way, quality.amount
    )
    numbers, seams, pieces, decoded, own_faces, at, leans, outcome, directed = results
    declaration = Declaration(name=attribute.name, **values_of(Declaration, numbers))
    if own_faces is not None:
        faces = own_faces
    note = _note(attribute, declaration, outcome)
    tangents = None
    if swift and directed is not None:
        tangents = GivenTangents(*directed, int(quality.amount))
    surface = Surface(faces, at)
    return PreparedAttribute(
        declaration, seams, surface, pieces, swift, leans, decoded, note, tangents
    )


def _note(attribute: Attribute, declaration: Declaration, outcome: tuple[Any, ...]) -> str:
    """What became of an attribute, in words."""
    owner = attribute.name
    semantic = attribute.semantic
    place = f"per {attribute.domain}"
    if semantic not in (owner, "generic"):
        place = f"{semantic} {place}"
    if declaration.coding == RECOMPUTED:
        return f"{owner}: {place}, recomputed from the decoded mesh"
    return f"{owner}: {place}, {noted(*outcome)}"


def with_turns(
    carried: tuple[PreparedAttribute, ...], places: Levels | None
) -> tuple[PreparedAttribute, ...]:
    """The attributes as a stream has them with positions at these places of a grid, if it has one."""
    if places is None:
        return carried
    return tuple(
        _turned(prepared, carried[:number], places) for number, prepared in enumerate(carried)
    )


def _turned(
    prepared: PreparedAttribute, before: Sequence[PreparedAttribute], places: Levels
) -> PreparedAttribute:
    """Tangents as turns about their normals, from where the texture points; others as they are."""
    tangents = prepared.tangents
    surface = prepared.surface
    normals = _number_of(before, _is_normal)
    coordinates = _number_of(before, _is_coordinate)
    if tangents is None or normals is None or coordinates is None:
        return prepared
    if (surface.vertices < 0).any():
        return prepared
    size = 1 << (tangents.bits - 1)
    normal = before[normals]
    coordinate = before[coordinates]
    turned = turned_tangents(
        surface.faces,
        normal.surface.faces,
        coordinate.surface.faces,
        places,
        coordinate.pieces,
        surface.vertices,
        tangents.rows,
        normal.values.astype(np.float64),
        tangents.values,
        size,
    )
    if turned is None:
        return prepared
    words, values, error = turned
    declaration = replace(
        prepared.declaration,
        coding=TANGENTS,
        largest=(4 * size, int(words[:, 1].max(initial=0))),
        offset=(),
        step=(),
        leans=1,
        bases=(normals + 1, coordinates + 1),
    )
    owner = prepared.note.partition(", ")[0]
    note = f"{owner}, {noted(error, 0.0, tangents.bits, 0, False)}"
    kind = prepared.values.dtype
    return replace(
        prepared, declaration=declaration, pieces=words, values=values.astype(kind), note=note
    )


def _number_of(
    attributes: Sequence[PreparedAttribute], holds: Callable[[Declaration], bool]
) -> int | None:
    for number, attribute in enumerate(attributes):
        if holds(attribute.declaration):
            return number
    return None


def _is_normal(declaration: Declaration) -> bool:
    return declaration.coding == OCTAHEDRAL and declaration.domain != FACE


def _is_coordinate(declaration: Declaration) -> bool:
    plain = (
        declaration.coding == LEVELS
        and declaration.semantic == TEXCOORD
        and declaration.domain != FACE
    )
    return plain and len(declaration.largest) == 2 and max(declaration.largest) < 1 << 20


def noted(error: float, step: float, bits: int, zeros: int, scaled: bool) -> str:
    """What became of values, in words."""
    if bits:
        return _noted_directions(error, bits, zeros, scaled)
    if step:
        return f"in steps of {step:g}"
    if error:
        return f"within {error:.3g}"
    return "exact"


def _noted_directions(error: float, bits: int, zeros: int, scaled: bool) -> str:
    """What became of directions, in words; `scaled`: not all were of length one."""
    note = f"{bits} bits, within {error:.2g} degrees"
    if zeros > 0:
        note += f", {zeros} of no length"
    if scaled:
        note += ", all of length one now"
    return note


def with_attributes(
    draft: Draft, carried: tuple[PreparedAttribute, ...], metadata: Metadata, chunk: int = CHUNK
) -> Draft:
    """A draft that carries attributes, `chunk` values a frame, and metadata; images and other bytes come last."""
    shape = packets.Connectivity | packets.Labels | packets.Order
    # After the faces, which seams need, and before positions, so that a page knows what is coming.
    places = [place for place, packet in enumerate(draft.body) if isinstance(packet, shape)]
    before = 1 + places[-1]
    head = draft.body[:before]
    body = draft.body[before:]
    # Names and units come first, and images after everything: the shape can be shown while they arrive.
    entries = sorted(metadata.items(), key=lambda entry: isinstance(entry[1], bytes))
    texts = sum(not isinstance(value, bytes) for value in metadata.values())
    early_metadata = packets.metadata_of(entries[:texts])
    images = packets.metadata_of(entries[texts:])
    declared: list[Packet] = []
    values: list[Packet] = []
    header = draft.header
    if carried:
        for index, prepared in enumerate(with_turns(carried, draft.places)):
            declaration, chunks = cheaper(prepared, draft.places, chunk)
            declared.append(packets.Declared(index, declaration, prepared.seams))
            for (first, count), data in zip(ranges(declaration.rows, chunk), chunks, strict=True):
                values.append(packets.Values(index, first, count, data))
        header = replace(header, attributes=len(carried), swift=carried[0].swift)
    return replace(
        draft, header=header, body=(*early_metadata, *head, *declared, *body, *values, *images)
    )


def cheaper(
    prepared: PreparedAttribute, places: Levels | None, chunk: int
) -> tuple[Declaration, tuple[bytes, ...]]:
    """What an attribute declares, and its chunks."""
    if chunk == CHUNK:
        plain = prepared.plain
    else:
        plain = prepared.chunks(None, chunk)
    # Values may follow the positions on a grid, as painted-on coordinates do, or not. Both are tried; one bit tells.
    if places is not None and prepared.leans and prepared.declaration.coding != TANGENTS:
        chunks = prepared.chunks(places, chunk)
        if sum(map(len, chunks)) < sum(map(len, plain)):
            return replace(prepared.declaration, leans=1), chunks
    return prepared.declaration, plain


def ranges(rows: int, size: int) -> list[tuple[int, int]]:
    """Return the first row and the length of each chunk of rows."""
    return [(first, min(size, rows - first)) for first in range(0, rows, size)]


def field_of(
    declaration: Declaration, surface: Surface, pieces: Levels, places: Levels | None, swift: int
) -> Field:
    """The field of the numbers of an attribute, shape (k, pieces), predicted from `places`, shape (n, 3)."""
    leans = int(places is not None or declaration.coding == TANGENTS)
    declared = write_map(entries_of(replace(declaration, leans=leans)))
    if places is not None:
        vertices = len(places)
    else:
        last_value = surface.faces.max(initial=0)
        last_vertex = surface.vertices.max(initial=0)
        vertices = 1 + int(max(last_value, last_vertex))
    field = Field(surface.faces, pieces)
    field.attribute(declared, vertices, surface.vertices, places, swift)
    return field


def write_values(field: Field, count: int) -> bytes:
    """The next `count` values: where there are several payloads, each with its length before it."""
    payloads = field.write(count)
    if len(payloads) == 1:
        return payloads[0]
    return with_lengths([*payloads, b""])
