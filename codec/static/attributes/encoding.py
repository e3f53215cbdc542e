"""The attributes of a given mesh to the frames of a stream."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from bsm._core import Corners
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import (
    AS_CODED,
    CORNER,
    FACE,
    MOST_ATTRIBUTES,
    OTHERWISE,
    RECOMPUTED,
    VERTEX,
    Declaration,
)
from bsm.bitstream.container.packets import Packet
from bsm.bitstream.errors import OptionError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Indices, Levels, Matrix, Order
from bsm.codec.geometry.attributes import KINDS, Attribute, Semantic
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.geometry.welding import row_numbers
from bsm.codec.look.measure import of_length_1, painted
from bsm.codec.look.pictures import Normals
from bsm.codec.static.attributes.levels import (
    Surface,
    Words,
    field_of,
    leans,
    quantized,
    recomputed,
    restored,
    surface_of,
    to_pieces,
    write_values,
)
from bsm.codec.static.attributes.quality import Quality
from bsm.codec.static.preamble_encoding import Draft, JoinedMesh, Prepared

Flags = npt.NDArray[np.uint8]
CHUNK = 1 << 15  # values of a frame
AGAIN = Quality("bits", 8)  # normals that are the same so are made as one
SEMANTICS: tuple[Semantic, ...] = ("generic", "color", "normal", "texcoord")


@dataclass(frozen=True, eq=False)
class Place:
    """Where a given mesh's vertices, faces and corners are in the order of coding."""

    given: TriangleMesh
    coded: Faces
    vertices: int
    faces: Order
    turns: Order
    loose: Order

    @cached_property
    def corners(self) -> Corners:
        return Corners(self.coded, self.vertices)

    def of_corners(self, rows: Indices) -> Indices:
        """What corners of the given faces have, shape (m', 3), in the order of coding, shape (m, 3)."""
        ordered = rows[self.faces]
        return np.take_along_axis(ordered, (self.turns[:, None] + np.arange(3)) % 3, axis=1)


def place_of(given: TriangleMesh, joined: JoinedMesh, prepared: Prepared) -> Place:
    """Where values of a mesh lie that was joined and prepared."""
    held = joined.splits is not None and len(joined.splits.loose)
    loose = np.flatnonzero(joined.index < 0) if held else np.zeros(0, np.int64)
    vertices, kept = len(prepared.mesh.positions), joined.kept[prepared.coding_faces]
    return Place(given, prepared.mesh.faces, vertices, kept, prepared.turns, loose)


@dataclass(frozen=True, eq=False)
class PreparedAttribute:
    """An attribute in the order of coding, before positions are known."""

    declaration: Declaration
    seams: bytes
    surface: Surface
    levels: Words
    note: str

    @property
    def at_corners(self) -> Matrix:
        """What `AttributeLook` is given: the values of a decoder at corners, shape (m, 3 c)."""
        values, declaration = restored(self.declaration, self.levels), self.declaration
        corners = values[:, None].repeat(3, axis=1) if declaration.domain == FACE else values[self.surface.faces]
        return painted(SEMANTICS[declaration.semantic], corners)

    def normals(self, positions: Matrix) -> Normals:
        """What normals a decoder will have at corners, shape (m, 9), where it has these positions, shape (n, 3)."""
        recompute = self.declaration.coding == RECOMPUTED
        values = recomputed(self.surface, positions) if recompute else restored(self.declaration, self.levels)
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
        pieces = to_pieces(self.declaration, self.levels)
        field = field_of(self.declaration, self.surface, pieces, places)
        return tuple(write_values(field, count) for _, count in ranges(self.declaration.rows, size))


def carry(place: Place, wanted: Iterable[tuple[Attribute, Quality]]) -> tuple[PreparedAttribute, ...]:
    """Attributes in the order of coding."""
    wanted = tuple(wanted)
    if len(wanted) > MOST_ATTRIBUTES:
        raise OptionError(f"a stream has {MOST_ATTRIBUTES} attributes at most, not {len(wanted)}: leave some out")
    carried: list[PreparedAttribute] = []
    known: dict[int, Flags] = {}
    for attribute, quality in wanted:
        carried.append(_carry(place, attribute, quality, known, len(carried)))
    return tuple(carried)


def _carry(
    place: Place, attribute: Attribute, quality: Quality, known: dict[int, Flags], number: int
) -> PreparedAttribute:
    """The attribute of a number; `known` has the seams of those before it, and gets its own."""
    used, rows, loose = _rows(place, attribute)
    values = attribute.values[used]
    result = quantized(values, attribute.semantic, quality, attribute.name)
    recompute = result.fields["coding"] == RECOMPUTED
    domain, origin, seams, seams_of = FACE, AS_CODED, b"", 0
    faces, at = place.coded, np.arange(place.vertices, dtype=np.int32)
    chosen: Order
    if attribute.domain == "face":
        chosen = rows.astype(np.int64)
    else:
        apart = quantized(values, "normal", AGAIN, attribute.name).levels if recompute else result.levels
        numbers = row_numbers(apart)[rows]
        chosen = np.zeros(place.vertices, np.int64)
        chosen[faces.ravel()] = rows.ravel()
        differ = numbers != row_numbers(apart)[chosen][faces]
        domain = CORNER if differ.any() else VERTEX
        origin = AS_CODED if domain == {"vertex": VERTEX, "corner": CORNER}[attribute.domain] else OTHERWISE
        if domain == CORNER:
            own, faces, first = place.corners.join(np.ascontiguousarray(numbers))
            same = [index for index, other in known.items() if (other == own).all()]
            seams_of = same[0] + 1 if same else 0
            if not same:
                seams = place.corners.seams(own, *list(known.values())[:-3:-1])
                known[number] = own
            chosen, at = rows.ravel()[first], place.coded.ravel()[first]
        chosen = np.concatenate([chosen, loose])
    levels = result.levels[:0] if recompute else result.levels[chosen]
    declaration = Declaration(
        name=attribute.name,
        domain=domain,
        origin=origin,
        semantic=SEMANTICS.index(attribute.semantic),
        kind=KINDS.index(attribute.values.dtype.name),
        components=attribute.components,
        rows=len(levels),
        seams_of=seams_of,
        **result.fields,
    )
    surface = surface_of(domain, faces, at, len(loose))
    what = "" if attribute.semantic in (attribute.name, "generic") else f"{attribute.semantic} "
    note = f"{attribute.name}: {what}per {attribute.domain}, {result.note}"
    return PreparedAttribute(declaration, seams, surface, levels, note)


def _rows(place: Place, attribute: Attribute) -> tuple[Order, Order, Order]:
    """The rows of an attribute's values that are coded; which of these faces or corners have, and loose vertices."""
    loose = place.loose if attribute.domain == "vertex" else np.zeros(0, np.int64)
    rows: Indices | Order
    if attribute.domain == "face":
        rows = place.faces
    else:
        rows = place.of_corners(place.given.faces if attribute.indices is None else attribute.indices)
    every = np.concatenate([rows.ravel(), loose])
    used, inverse = np.unique(every, return_inverse=True)
    numbers = np.asarray(inverse, np.int64).ravel()
    return used, numbers[: rows.size].reshape(rows.shape), numbers[rows.size :]


def with_attributes(draft: Draft, carried: tuple[PreparedAttribute, ...], metadata: Metadata) -> Draft:
    """A draft that carries attributes and metadata, too; images and other bytes come last."""
    shape = packets.Connectivity | packets.Partition | packets.Order
    before = 1 + max(place for place, packet in enumerate(draft.body) if isinstance(packet, shape))
    head, body = draft.body[:before], draft.body[before:]
    entries = sorted(metadata.items(), key=lambda entry: isinstance(entry[1], bytes))
    texts = sum(not isinstance(value, bytes) for value in metadata.values())
    early_metadata, images = map(packets.metadata_of, (entries[:texts], entries[texts:]))
    declared: list[Packet] = []
    values: list[Packet] = []
    header = draft.header
    if carried:
        for index, prepared in enumerate(carried):
            declaration, chunks = cheaper(prepared, draft.places)
            declared.append(packets.Attribute(index, declaration, prepared.seams))
            for (first, count), data in zip(ranges(declaration.rows, CHUNK), chunks, strict=True):
                values.append(packets.Values(index, first, count, data))
        header = replace(header, attributes=len(carried))
    return replace(draft, header=header, body=(*early_metadata, *head, *declared, *body, *values, *images))


def cheaper(prepared: PreparedAttribute, places: Levels | None) -> tuple[Declaration, tuple[bytes, ...]]:
    """What an attribute declares, and its chunks."""
    if places is not None and leans(prepared.declaration):
        chunks = prepared.chunks(places, CHUNK)
        if sum(map(len, chunks)) < sum(map(len, prepared.plain)):
            return replace(prepared.declaration, leans=1), chunks
    return prepared.declaration, prepared.plain


def ranges(rows: int, size: int) -> list[tuple[int, int]]:
    """Return the first row and the length of each chunk of rows."""
    return [(first, min(size, rows - first)) for first in range(0, rows, size)]
