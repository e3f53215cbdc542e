"""The contents of mesh files, polygons with columns of attributes, and their conversion to a mesh."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, count
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError, imported, public
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import distinct, sealed
from bsm.codec.geometry.attributes import (
    MOST_COMPONENTS,
    MOST_NAME_BYTES,
    Attribute,
    Domain,
    Semantic,
)
from bsm.codec.geometry.mesh import Metadata, NoFacesError, TriangleMesh
from bsm.files.conventions import shares_of
from bsm.files.formats.metadata import CALLED, COMPONENTS, NONE, fitting, named
from bsm.files.parsing import Doubles, Ints, require_counts, single_suffices

Array = npt.NDArray[Any]
PLURALS = {"color": "colors", "normal": "normals", "texcoord": "texture coordinates"}
"""Attributes in words, by their names."""
_COLORS = ("rgb", "rgba", "colors", "colours")
_TEXCOORDS = ("texture coordinates", "uv", "tcoords")


@dataclass(frozen=True, eq=False)
class Column:
    """A value for each point, each polygon, or each corner of the polygons; it may be wrong.

    `file_name` and `components` are names in the file that the name and the meaning do not tell.
    """

    name: str
    values: Array
    domain: Domain = "vertex"
    semantic: Semantic = "generic"
    indices: Ints | None = None
    file_name: str = ""
    components: tuple[str, ...] = ()

    def of_triangles(self, name: str, places: Ints, owner: Ints) -> Attribute:
        """The attribute of triangles whose corners are the polygons' at `places`, and which are of polygon `owner`."""
        # Cut by bytes, as streams bound names so; a letter that is cut through is left out.
        name = name.encode()[:MOST_NAME_BYTES].decode(errors="ignore") or self.domain
        if self.domain == "vertex":
            return Attribute(name, self.values, semantic=self.semantic)
        if self.domain == "face":
            return Attribute(name, self.values[owner], "face", self.semantic)
        indices = np.arange(len(self.values)) if self.indices is None else self.indices
        if places.size and places.max() >= len(indices):
            raise MeshError(f"there are {len(indices)} of them for {places.max() + 1} corners")
        used = indices[places]
        if used.size and not (used.min() >= 0 and used.max() < len(self.values)):
            raise MeshError(
                f"a corner refers to value {used[(used < 0) | (used >= len(self.values))][0]}"
            )
        return Attribute(name, self.values, "corner", self.semantic, used.astype(np.int32))


def attributes_of(
    columns: Iterable[Column], vertices: int, polygons: int, places: Ints, owner: Ints
) -> tuple[tuple[Attribute, ...], dict[str, str], dict[str, str]]:
    """Return columns as attributes, their names in the file as metadata, and why the others are none, by name."""
    rows = {"vertex": vertices, "face": polygons}
    attributes: dict[str, Attribute] = {}
    file_names: dict[str, str] = {}
    refused: dict[str, str] = {}
    for column in columns:
        distinct = _distinct(column, attributes)
        count = len(column.values)
        try:
            if rows.get(column.domain, count) != count:
                raise MeshError(f"there are {count} of them for {rows[column.domain]}")
            attribute = distinct.of_triangles(distinct.name, places, owner)
        except MeshError as error:
            refused[PLURALS.get(column.name, column.name)] = str(error)
            continue
        attributes[distinct.name] = attribute
        if distinct.file_name:
            file_names[f"{CALLED}{attribute.name}"] = distinct.file_name
        component_names = "\n".join(distinct.components)
        if component_names:
            file_names[f"{COMPONENTS}{attribute.name}"] = component_names
    return tuple(attributes.values()), file_names, refused


def _distinct(column: Column, taken_names: Collection[str]) -> Column:
    """Return a column under a name that no other one has; its name in the file is kept."""
    name = unused_name(column.name, column.domain, taken_names)
    if name == column.name:
        return column
    return replace(column, name=name, file_name=column.file_name or column.name)


def joined_columns(parts: Sequence[Part]) -> tuple[list[Column], list[str]]:
    """Return the columns of parts, joined, those of fewer numbers filled up (by an opacity of 1, or zeros); notes."""
    columns_by_name: list[dict[str, Column]] = []
    for part in parts:
        named_columns: dict[str, Column] = {}
        for column in part.columns:
            distinct = _distinct(column, named_columns)
            named_columns[distinct.name] = distinct
        columns_by_name.append(named_columns)
    joined: list[Column] = []
    notes: list[str] = []
    for name in dict.fromkeys(chain.from_iterable(columns_by_name)):
        columns = [named_columns.get(name) for named_columns in columns_by_name]
        alike = _made_alike(parts, columns, notes)
        column = _concatenated(parts, alike)
        joined.append(column)
        missing = alike.count(None)
        if missing:
            filling = "zeros"
            if column.semantic == "color":
                filling = "white"
            notes.append(f"parts without {PLURALS.get(name, name)} were given {filling}: {missing}")
    return joined, notes


def _made_alike(
    parts: Sequence[Part], columns: list[Column | None], notes: list[str]
) -> list[Column | None]:
    """Return the columns of one name in the meaning, the width and the domain that hold those of all parts."""
    present = [column for column in columns if column is not None]
    name = present[0].name
    meanings = {column.semantic for column in present}
    width = max(column.values.shape[1] for column in present)
    is_narrow = any(column.values.shape[1] < width for column in present)
    if is_narrow and meanings - {"color", "texcoord"}:
        notes.append(
            f"parts whose {name} has fewer than {width} numbers were given zeros after them"
        )
    # Zeros would be black holes in every viewer.
    needs_normals = meanings == {"normal"} and None in columns
    if needs_normals:
        notes.append(
            f"parts without normals were given those of their faces: {columns.count(None)}"
        )
    domains = {column.domain for column in present}
    if needs_normals:
        domains.add("face")
    alike: list[Column | None] = []
    for part, column in zip(parts, columns, strict=True):
        if column is None and needs_normals:
            column = Column(name, part.normals(), "face", "normal")
        if column is not None:
            if len(meanings) > 1:
                column = replace(column, semantic="generic")
            column = _widened(column, width)
            if len(domains) > 1:
                column = part.at_corners(column)
        alike.append(column)
    return alike


def _widened(column: Column, width: int) -> Column:
    """Return a column whose values have a number of components, those after its own blank."""
    missing = width - column.values.shape[1]
    if not missing:
        return column
    values = np.pad(column.values, ((0, 0), (0, missing)), constant_values=_blank(column))
    return replace(column, values=values)


def _blank(column: Column) -> int:
    """Return the opacity of an opaque color, or zero."""
    if column.semantic != "color":
        return 0
    return {"uint8": 255, "uint16": 65535}.get(column.values.dtype.name, 1)


def _concatenated(parts: Sequence[Part], columns: list[Column | None]) -> Column:
    """Return the columns of parts as one; parts that have none get zeros, or white."""
    present = [column for column in columns if column is not None]
    if present[0].semantic == "color" and len({column.values.dtype for column in present}) > 1:
        # Bytes here, floats there.
        columns = [column and _with_shares(column) for column in columns]
    model = next(filter(None, columns))
    tables: list[Array] = []
    places: list[Ints] = []
    begin = 0
    for part, column in zip(parts, columns, strict=True):
        if column is None:
            column = _blank_column(part, model)
        indices = np.empty(0, np.int64) if column.indices is None else column.indices
        tables.append(column.values)
        places.append(begin + indices)
        begin += len(column.values)
    indices_of_corners: Ints | None = None
    if model.domain == "corner":
        indices_of_corners = np.concatenate(places)
    return replace(model, values=np.concatenate(tables), indices=indices_of_corners)


def _with_shares(column: Column) -> Column:
    return replace(column, values=shares_of(column.values).astype(np.float32))


def _blank_column(part: Part, model: Column) -> Column:
    """Return a column of blank values for a part: one value for all corners, or one for each vertex or face."""
    counts = {"vertex": len(part.positions), "face": len(part.sizes), "corner": len(part.corners)}
    count = size = counts[model.domain]
    if model.domain == "corner":
        size = min(count, 1)
    values = np.full((size, model.values.shape[1]), _blank(model), model.values.dtype)
    return replace(model, values=values, indices=np.zeros(count, np.int64))


def polygon_normals(positions: Doubles, sizes: Ints, corners: Ints) -> Doubles:
    """The unit normals of polygons; zeros for polygons without area, or whose corners do not exist."""
    first, owner = np.cumsum(sizes) - sizes, np.repeat(np.arange(len(sizes)), sizes)
    if not corners.size or not 0 <= corners.min() <= corners.max() < len(positions):
        return np.zeros((len(sizes), 3))
    after = np.arange(1, len(corners) + 1)
    after[first[sizes > 0] + sizes[sizes > 0] - 1] = first[sizes > 0]
    with np.errstate(over="ignore", invalid="ignore"):  # a later check refuses infinite values
        # From the first corner and not from the origin: far off, the products of coordinates would lose the area in
        # rounding.
        points = positions[corners] - positions[corners[first[owner]]]
        vectors = np.cross(points, points[after])
        sums = [np.bincount(owner, axis, len(sizes)) for axis in vectors.T]
        return unit_rows(np.column_stack(sums))


def unit_rows(vectors: Doubles, blank: Sequence[float] = (0.0, 0.0, 0.0)) -> Doubles:
    """Return vectors at length one; those without a length become `blank`."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    units: Doubles = np.divide(
        vectors, lengths, out=np.broadcast_to(blank, vectors.shape).copy(), where=lengths > 0
    )
    return units


def turned_normals(normals: Doubles, linear: Doubles) -> Doubles:
    """Transform normals, shape (n, 3), by one matrix or by one each; mirrors turn the faces, not the normals."""
    rows = np.swapaxes(linear, -1, -2)
    # The cofactors and not the inverse transposed: they also exist where a matrix flattens a part.
    cofactors = np.stack(
        [np.cross(rows[..., (i + 1) % 3, :], rows[..., (i + 2) % 3, :]) for i in range(3)], axis=-1
    )
    side = np.where(np.linalg.det(linear) < 0, -1.0, 1.0)[..., None]
    return unit_rows(np.einsum("...ij,...j->...i", cofactors, normals) * side)


def grouped(what: str, names: Sequence[str], of_face: Ints) -> tuple[list[Column], dict[str, str]]:
    """Return the groups of faces: numbers if there are several groups, and their names as metadata."""
    changes, places = np.unique(of_face, return_inverse=True)
    used = [names[i] for i in changes.tolist()]
    numbers = {name: number for number, name in enumerate(dict.fromkeys(used))}
    of_change = np.array([numbers[name] for name in used], np.int32)
    columns: list[Column] = []
    metadata: dict[str, str] = {}
    if len(numbers) > 1:
        columns.append(Column(what, of_change[places], "face"))
    if any(numbers):
        metadata = named(list(numbers), what)
    return columns, metadata


def unused_name(name: str, domain: str, taken_names: Collection[str]) -> str:
    if name not in taken_names:
        return name
    longer_name = f"{domain}_{name}"
    if not name.startswith(domain) and longer_name not in taken_names:
        return longer_name
    return next(
        candidate
        for candidate in map(f"{name}{{}}".format, count(2))
        if candidate not in taken_names
    )


def compact(values: Array) -> Array:
    """Return floats in single precision where that moves none by more than a millionth of their range."""
    if (
        values.dtype == np.float64
        and values.size
        and np.isfinite(values).all()
        and single_suffices(values)
    ):
        return values.astype(np.float32)
    return values


def color_column(values: Array, domain: Domain, *, written_whole: bool = False) -> Column:
    """Return colors as a file has them: bytes, or floats from 0 to 1; numbers beyond that mean nothing known."""
    if values.dtype.kind != "f":
        are_colors = values.dtype in (np.uint8, np.uint16)
        return Column("color", values, domain, _semantic_of_colors(are_colors))
    has_color = np.isfinite(values).all(axis=1)
    # Some have no color, and the others tell what they are.
    if has_color.any() and not has_color.all():
        known_colors = color_column(values[has_color], domain, written_whole=written_whole)
        if known_colors.values.dtype == np.uint8 and (written_whole or values[has_color].max() > 1):
            values = values / 255
        return replace(known_colors, values=compact(values))
    if not values.size or not has_color.all():
        return Column("color", values, domain)
    exact = values
    if not written_whole and values.max() <= 1:
        exact = values * 255
    levels = np.rint(exact)
    if levels.min() >= 0 and levels.max() <= 255 and np.abs(levels - exact).max() <= 255e-6:
        return Column("color", levels.astype(np.uint8), domain, "color")
    in_range = bool(values.min() >= 0 and values.max() <= 1)
    return Column("color", compact(values), domain, _semantic_of_colors(in_range))


def _semantic_of_colors(in_range: bool) -> Semantic:
    """The semantic of values that a file calls colors, which mean nothing known beyond the range of colors."""
    if in_range:
        return "color"
    return "generic"


def named_column(
    name: str,
    values: Array,
    domain: Domain,
    meaning: Semantic | None = None,
    components: Sequence[str] = (),
) -> Column:
    """Return values as libraries name them, shape (k, c), and their components; None: their name tells the meaning."""
    lower_name = name.lower()
    if meaning is None and lower_name in _COLORS:
        meaning = meaning_of("color", values.shape[1])
    elif meaning is None and lower_name in _TEXCOORDS:
        meaning = meaning_of("texcoord", values.shape[1])
    elif meaning is None:
        meaning = meaning_of(name, values.shape[1])
    if meaning == "color":
        color = color_column(values, domain)
        values, meaning = color.values, color.semantic
    return Column(name, values, domain, meaning, components=tuple(components))


def meaning_of(name: str, components: int = 3) -> Semantic:
    """Return the meaning of values by their name, if as many components can mean that."""
    widths: dict[Semantic, tuple[int, ...]] = {"color": (3, 4), "normal": (3,), "texcoord": (2, 3)}
    match = re.match(
        r"(?:(?:vertex|corner|face)_)?(color|normal|texcoord)s?(?![a-z])", name.lower()
    )
    for meaning, counts in widths.items():
        if match and match[1] == meaning and components in counts:
            return meaning
    return "generic"


CUT = "polygons were cut into triangles"
CROSSING = "polygons whose sides cross, so that their triangles overlap"
_MOST_TURNS = 16  # fans that are tried for a polygon
_MOST_CORNERS = 1 << 15  # of a polygon whose ears are clipped: that can take the square of it
# Bytes of a triangle, of one that a polygon is cut into, of a corner.
PER_TRIANGLE, PER_CUT, PER_CORNER = 80, 300, 24
# Bytes that parts take while they are joined: of each triangle of a table, and a part.
PER_JOINED, PER_PART = 200, 2000


@public
@dataclass(frozen=True)
class MeshFile:
    """A mesh from a file, and the reader's changes to it.

    Parameters
    ----------
    mesh : TriangleMesh
    notes : tuple of str
        One sentence for each change that the reader made.
    dropped : tuple of str
        Contents of the file that `mesh` does not have: "lines", "parameter space", "animations", ...

    Examples
    --------
    >>> import bsm
    >>> read = bsm.read_mesh("spot.obj")
    >>> mesh, notes = read.mesh, read.notes
    """

    mesh: TriangleMesh
    notes: tuple[str, ...] = ()
    dropped: tuple[str, ...] = ()


_ERRORS_ADD_UP = ": errors add up"


def compression_note(codec: str) -> str:
    """Return the note that a codec has compressed the geometry of a file."""
    return f"compressed already, by {codec}{_ERRORS_ADD_UP}"


def without_compression_notes(notes: Iterable[str]) -> list[str]:
    """Return the notes for a command that does not encode the mesh again."""
    return [note for note in notes if not note.endswith(_ERRORS_ADD_UP)]


@dataclass(frozen=True, eq=False)
class Polygons:
    """The points of a file in full precision, and its polygons over them."""

    positions: Doubles
    sizes: Ints
    corners: Ints
    notes: tuple[str, ...] = ()
    dropped: tuple[str, ...] = ()
    columns: tuple[Column, ...] = ()
    metadata: Metadata = field(default_factory=dict)

    def checked(self, limits: Limits, received: int = 1 << 62, cut: Cut | None = None) -> MeshFile:
        """Return the mesh of triangles, after checks of counts, indices and coordinates."""
        positions, sizes, corners = self.positions, self.sizes, self.corners
        triangles = int(np.maximum(sizes - 2, 0).sum())
        require_counts(limits, vertices=len(positions), faces=triangles)
        per_triangle = PER_CUT
        if (sizes == 3).all():
            per_triangle = PER_TRIANGLE
        # Before any triangle is made.
        limits.check_memory(
            per_triangle * triangles + PER_CORNER * len(corners), len(positions), received
        )
        self._require_sound()
        notes = list(self.notes)
        left_out = list(self.dropped)
        thin = int((sizes < 3).sum())
        if thin:
            left_out.append(f"faces with fewer than three corners ({thin})")
        if (sizes > 3).any():
            notes.append(f"{CUT}: {int((sizes > 3).sum())}")
        cut_polygons = cut or triangulate
        places, owner, folded = cut_polygons(positions, sizes, corners)
        if folded:
            notes.append(f"{CROSSING}: {folded}")
        finite_columns: list[Column] = []
        component_names: dict[str, str] = {}
        for column in self.columns:
            if _is_wide(column):
                component_names[f"{COMPONENTS}{column.name}"] = "\n".join(_component_names(column))
            for narrow_column in _narrow(column):
                finite_columns += _finite(narrow_column, left_out)
        attributes, file_names, refused = attributes_of(
            finite_columns, len(positions), len(sizes), places, owner
        )
        metadata = {**self.metadata, **file_names, **component_names}
        metadata, too_large = fitting(metadata, limits.metadata_bytes)
        reasons = refused | too_large
        if left_out:
            notes.append(f"left out: {', '.join(left_out)}")
        notes += [f"left out: {name}, because {reason}" for name, reason in reasons.items()]
        mesh = TriangleMesh(
            positions, sealed(corners[places].astype(np.int32)), attributes, metadata
        )
        return MeshFile(mesh, tuple(notes), (*left_out, *refused, *too_large))

    def _require_sound(self) -> None:
        """Refuse polygons without faces, or with vertices that are not there or not finite."""
        if not (self.sizes > 0).any():
            reason = "point clouds are not supported"
            if self.dropped:
                reason = f"it has {', '.join(self.dropped)}"
            raise NoFacesError(f"the file has no faces that can be read; {reason}")
        outside = (self.corners < 0) | (self.corners >= len(self.positions))
        if outside.any():
            index = int(self.corners[np.argmax(outside)])
            raise MeshError(
                f"a face refers to vertex {index}, outside 0..{len(self.positions) - 1}"
            )
        finite = np.isfinite(self.positions)
        if not finite.all():
            row = int(np.argmin(finite.all(axis=1)))
            raise MeshError(
                f"vertex {row} has a coordinate that is not finite; remove or repair it"
            )


def turned_corners(sizes: Ints, turned: Array) -> Ints:
    """The order of corners in which the polygons that are turned run the other way round, from the same corner."""
    first = np.repeat(np.cumsum(sizes) - sizes, sizes)
    step = np.arange(len(first)) - first
    size = np.repeat(sizes, sizes)
    return first + np.where(np.repeat(turned, sizes), (size - step) % np.maximum(size, 1), step)


GHOSTS = "vtkGhostType"
_HIDDEN = 1 | 32  # cells of another piece, and those that are switched off


def cut_strips(sizes: Ints, corners: Ints) -> tuple[Ints, Ints]:
    """Return the triangles of strips, shape (k, 3), and the strip of each."""
    pieces = np.maximum(sizes - 2, 0)
    owner = np.repeat(np.arange(len(sizes)), pieces)
    step = np.arange(len(owner)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    first = (np.cumsum(sizes) - sizes)[owner] + step
    # Every second triangle runs the other way round; its corners are exchanged, so that all show the same side.
    odd = step % 2
    return corners[np.column_stack([first, first + 1 + odd, first + 2 - odd])], owner


@dataclass(frozen=True, eq=False)
class Part:
    """Polygons of a scene where it places them, and the number of the material of each."""

    positions: Doubles
    sizes: Ints
    corners: Ints
    columns: Sequence[Column]
    materials: Array
    name: str

    def at_corners(self, column: Column) -> Column:
        """Return a column as values of corners."""
        faces = np.repeat(np.arange(len(self.sizes)), self.sizes)
        indices_by_domain = {"vertex": self.corners, "face": faces, "corner": column.indices}
        return replace(column, domain="corner", indices=indices_by_domain[column.domain])

    def normals(self) -> Array:
        return compact(polygon_normals(self.positions, self.sizes, self.corners))

    def without(self, faces: Ints) -> Part:
        """Return the part without some of its polygons."""
        is_kept = np.ones(len(self.sizes), np.bool_)
        is_kept[faces] = False
        corner_is_kept = np.repeat(is_kept, self.sizes)
        columns: list[Column] = []
        for column in self.columns:
            if column.domain == "face":
                column = replace(column, values=column.values[is_kept])
            elif column.domain == "corner":
                indices = (
                    np.arange(len(corner_is_kept)) if column.indices is None else column.indices
                )
                column = replace(column, indices=indices[corner_is_kept])
            columns.append(column)
        return replace(
            self,
            sizes=self.sizes[is_kept],
            corners=self.corners[corner_is_kept],
            materials=self.materials[is_kept],
            columns=columns,
        )

    def placed(self, matrix: Doubles) -> Part:
        """Return the part where a matrix moves it; mirrors turn its polygons around."""
        linear = matrix[:3, :3]
        order = np.arange(len(self.corners))
        if np.linalg.det(linear) < 0:
            order = turned_corners(self.sizes, np.ones(len(self.sizes), np.bool_))
        columns: list[Column] = []
        for column in self.columns:
            if column.indices is not None:
                column = replace(column, indices=column.indices[order])
            if column.semantic == "normal":
                normals = turned_normals(column.values.astype(np.float64), linear)
                column = replace(column, values=compact(normals))
            columns.append(column)
        with np.errstate(invalid="ignore"):  # a later check refuses infinite values
            positions = self.positions @ linear.T + matrix[:3, 3]
        return replace(self, positions=positions, corners=self.corners[order], columns=columns)


def without_hidden(part: Part, losses: dict[str, None]) -> Part:
    """Return a part without the cells that VTK hides, and without their marks."""
    marks = np.zeros(0, np.uint8)
    columns: list[Column] = []
    for column in part.columns:
        if column.name != GHOSTS:
            columns.append(column)
        elif column.domain == "face" and not len(marks):
            marks = column.values[:, 0]
    part = replace(part, columns=columns)
    if len(marks) != len(part.sizes):
        return part
    hidden = np.flatnonzero(marks.astype(np.int64) & _HIDDEN)
    if not hidden.size:
        return part
    losses[f"hidden cells ({len(hidden)})"] = None
    return part.without(hidden)


def part_of(polygons: Polygons, name: str) -> Part:
    """Return polygons as a part without materials."""
    materials = np.zeros(len(polygons.sizes), np.int64)
    return Part(
        polygons.positions, polygons.sizes, polygons.corners, polygons.columns, materials, name
    )


def joined_parts(
    parts_given: Iterable[Part],
    counts: Sequence[tuple[int, int]] | None,
    limits: Limits,
    received: int,
) -> Polygons:
    """Join the parts of a scene; `counts`, the vertices and triangles of each, are checked before a part is made."""
    if counts is None:  # the parts are there already
        parts_given = list(parts_given)
        counts = [
            (len(part.positions), int(np.maximum(part.sizes - 2, 0).sum())) for part in parts_given
        ]
    vertices = sum(count for count, _ in counts)
    triangles = sum(count for _, count in counts)
    require_counts(limits, vertices=vertices, faces=triangles)
    memory = PER_JOINED * triangles + PER_PART * len(counts)
    limits.check_memory(memory, vertices, received)
    parts: list[Part] = []
    column_kinds: set[tuple[str, Domain]] = set()
    for part in parts_given:
        if len(part.corners) and not 0 <= part.corners.min() <= part.corners.max() < len(
            part.positions
        ):
            raise MeshError(
                f"a face of {part.name or 'a part'} refers to a vertex that it does not have"
            )
        parts.append(part)
        column_kinds |= {(column.name, column.domain) for column in part.columns}
        column_memory = PER_JOINED * len(column_kinds) * max(triangles, vertices // 3)
        limits.check_memory(memory + column_memory, vertices, received)
    columns, notes = joined_columns(parts)
    nothing = np.empty(0, np.int64)
    positions, sizes, corners, materials = [np.empty((0, 3))], [nothing], [nothing], [nothing]
    first = 0
    for part in parts:
        positions.append(part.positions)
        sizes.append(part.sizes)
        corners.append(part.corners + first)
        materials.append(part.materials)
        first += len(part.positions)
    metadata: dict[str, str | int | float | bytes] = {}
    material_numbers = np.concatenate(materials)
    if len(distinct(material_numbers)) > 1:
        columns.append(Column("material", material_numbers.astype(np.int32)[:, None], "face"))
    if len(parts) > 1:
        owner = np.repeat(
            np.arange(len(parts), dtype=np.int32), [len(part.sizes) for part in parts]
        )
        notes = [f"{len(parts)} parts were joined to one mesh", *notes]
        columns.append(Column("part", owner[:, None], "face"))
        metadata |= named([part.name for part in parts], "part")
    elif parts and parts[0].name:
        metadata["name"] = parts[0].name
    return Polygons(
        np.concatenate(positions),
        np.concatenate(sizes),
        np.concatenate(corners),
        tuple(notes),
        (),
        tuple(columns),
        metadata,
    )


def joined_files(files: Sequence[MeshFile], names: Sequence[str], limits: Limits) -> MeshFile:
    """Return the meshes of files as the parts of one."""
    if len(files) == 1:
        return files[0]
    parts = [
        part_of(_polygons_of(file.mesh), Path(name).stem)
        for file, name in zip(files, names, strict=True)
    ]
    joined = joined_parts(parts, None, limits, 1 << 62)
    notes = dict.fromkeys(chain.from_iterable(file.notes for file in files))
    metadata = {**files[0].mesh.metadata, **joined.metadata}
    return replace(joined, notes=(*notes, *joined.notes), metadata=metadata).checked(limits)


def _polygons_of(mesh: TriangleMesh) -> Polygons:
    columns: list[Column] = []
    for attribute in mesh.attributes:
        column = Column(attribute.name, attribute.values, attribute.domain, attribute.semantic)
        if attribute.indices is not None:
            column = replace(column, indices=attribute.indices.ravel().astype(np.int64))
        columns.append(column)
    sizes = np.full(len(mesh.faces), 3)
    return Polygons(
        mesh.positions, sizes, mesh.faces.ravel().astype(np.int64), (), (), tuple(columns)
    )


_MOST_NARROW = 32
_AXES = {6: "xx yy zz xy yz xz", 9: "xx xy xz yx yy yz zx zy zz"}


def _is_wide(column: Column) -> bool:
    return column.values.ndim > 1 and MOST_COMPONENTS < column.values.shape[1] <= _MOST_NARROW


def _component_names(column: Column) -> Sequence[str]:
    """Return the names of the components of a column in its file, or those by axes if it is a tensor, or numbers."""
    width = column.values.shape[1]
    if len({*column.components}) == width:
        return column.components
    if width in _AXES:
        return _AXES[width].split()
    return list(map(str, range(width)))


def _narrow(column: Column) -> list[Column]:
    """Return a column of more numbers than an attribute has as one of each."""
    if not _is_wide(column):
        return [column]
    one = replace(column, components=())
    names = (f"{column.name}.{component}" for component in _component_names(column))
    return [
        replace(one, name=name, values=column.values[:, [place]])
        for place, name in enumerate(names)
    ]


def _finite(column: Column, dropped: list[str]) -> list[Column]:
    """Return a column with the median of the others for values that are not finite, and one that marks these."""
    if column.values.dtype.kind != "f":
        return [column]
    lost = ~np.isfinite(column.values)
    if not lost.any() or lost.all():
        return [column]
    name = PLURALS.get(column.name, column.name)
    dropped.append(
        f"values of {name} that are not numbers ({int(lost.sum())}); {column.name}{NONE} marks them"
    )
    median = column.values.dtype.type(np.median(column.values[~lost]))
    marks = np.asarray(lost.any(axis=1)).astype(np.uint8)[:, None]
    mark_column = replace(
        column,
        name=f"{column.name}{NONE}",
        values=marks,
        semantic="generic",
        file_name="",
        components=(),
    )
    return [replace(column, values=np.where(lost, median, column.values)), mark_column]


def triangulate(positions: Doubles, sizes: Ints, corners: Ints) -> tuple[Ints, Ints, int]:
    """Cut polygons into triangles, in the order of the polygons."""
    if (sizes == 3).all():
        return np.arange(len(corners)).reshape(-1, 3), np.arange(len(sizes)), 0
    scaled = positions / max(float(np.abs(positions).max()), 1e-300)  # so that no product overflows
    pieces = np.maximum(sizes - 2, 0)
    first, starts = np.cumsum(sizes) - sizes, np.cumsum(pieces) - pieces
    owner = np.repeat(np.arange(len(sizes)), pieces)
    step = np.arange(len(owner)) - np.repeat(starts, pieces)

    def fans(rows: Ints, turn: int) -> Ints:
        polygon = owner[rows]
        steps: Ints = np.column_stack([np.zeros_like(rows), step[rows] + 1, step[rows] + 2]) + turn
        return first[polygon][:, None] + steps % sizes[polygon][:, None]

    # Fans first: nearly all polygons are quads or convex, and all of them are cut at once. Others try fans from their
    # next corners, and only what is left is cut one by one.
    places: Ints = fans(np.arange(len(owner)), 0)
    vectors = _area_vectors(scaled, corners[places])
    normals: Doubles = np.column_stack(
        [np.bincount(owner, weights=axis, minlength=len(sizes)) for axis in vectors.T]
    )

    def folded(rows: Ints, candidates: Ints) -> Ints:
        # A triangle whose normal is against that of its polygon lies outside of it, or over another triangle.
        against = (_area_vectors(scaled, corners[candidates]) * normals[owner[rows]]).sum(
            axis=1
        ) < 0
        return np.unique(owner[rows[against]])

    bad: Ints = folded(np.arange(len(owner)), places)
    for turn in range(1, min(int(sizes.max(initial=0)), _MOST_TURNS)):
        if len(bad) == 0:
            break
        rows = np.flatnonzero(np.isin(owner, bad[sizes[bad] > turn]))
        candidates = fans(rows, turn)
        good = ~np.isin(owner[rows], folded(rows, candidates))
        places[rows[good]] = candidates[good]
        bad = np.setdiff1d(bad, owner[rows[good]])
    if len(bad) == 0:
        return places, owner, 0
    polygon_of_corner = np.repeat(np.arange(len(sizes)), sizes)
    rows = np.flatnonzero(np.isin(polygon_of_corner, bad))
    cuts = _ears(scaled[corners[rows]], sizes[bad], normals[bad])
    complete = [place for place, cut in enumerate(cuts) if len(cut) == pieces[bad[place]]]
    for place in complete:
        polygon = bad[place]
        places[starts[polygon] : starts[polygon] + pieces[polygon]] = first[polygon] + cuts[place]
    return places, owner, len(bad) - len(complete)


Cut = Callable[[Doubles, Ints, Ints], tuple[Ints, Ints, int]]


class CutAlike:
    """Cuts polygons as those of the mesh before were cut, if they have the same corners: frames share their faces."""

    def __init__(self) -> None:
        self._sizes, self._corners = np.zeros(0, np.int64), np.zeros(0, np.int64)
        self._cut: tuple[Ints, Ints, int] | None = None

    def __call__(self, positions: Doubles, sizes: Ints, corners: Ints) -> tuple[Ints, Ints, int]:
        same = np.array_equal(sizes, self._sizes) and np.array_equal(corners, self._corners)
        if self._cut is None or not same:
            self._sizes, self._corners, self._cut = (
                sizes,
                corners,
                triangulate(positions, sizes, corners),
            )
        return self._cut


def _ears(points: Doubles, sizes: Ints, normals: Doubles) -> list[Ints]:
    """Cut polygons that are not convex into triangles by clipping ears; one whose sides cross gets too few or many."""
    if sizes.max() > _MOST_CORNERS:
        raise MeshError(
            f"a polygon that is not convex has {sizes.max()} corners; cut it into triangles before"
        )
    flat, clip = _flattened(points, np.repeat(normals, sizes, axis=0)), _clipper()
    spans = zip((np.cumsum(sizes) - sizes).tolist(), sizes.tolist())
    return [_filled(clip(flat[at : at + size], [size]), size) for at, size in spans]


def cut_holes(points: Doubles, ends: Sequence[int]) -> Ints:
    """Cut a polygon with holes into triangles: its corners, then those of each hole; `ends` of these."""
    ring = np.arange(ends[0])
    if len(points) > _MOST_CORNERS:
        raise MeshError(
            f"a polygon with holes has {len(points)} corners; cut it into triangles before"
        )
    normal = polygon_normals(points, np.array([ends[0]]), ring)
    clip = _clipper()
    normals = np.repeat(normal, len(points), axis=0)
    return clip(_flattened(points, normals), ends)


def _flattened(points: Doubles, normals: Doubles) -> Doubles:
    """Return points without the axis along which their normals are longest, counterclockwise as seen from there."""
    # Leaving out one axis rounds nothing, where a projection on the plane would.
    axis = np.argmax(np.abs(normals), axis=1)[:, None]
    axes = np.array([[1, 2], [0, 2], [0, 1]])[axis[:, 0]]
    sign = np.where((np.take_along_axis(normals, axis, 1) < 0) != (axis == 1), -1.0, 1.0)
    return np.ascontiguousarray(
        np.take_along_axis(points, axes, 1) * np.column_stack([sign, np.ones_like(sign)])
    )


def _clipper() -> Callable[[Doubles, Sequence[int]], Ints]:
    """Return what makes triangles of a polygon and its holes, whose corners end at given places."""
    library = imported(
        "mapbox_earcut", "polygons that are not convex are cut with mapbox-earcut", "formats"
    )
    cut = library.triangulate_float64
    return lambda flat, ends: cut(flat, np.array(ends, np.uint32)).reshape(-1, 3).astype(np.int64)


def _filled(triangles: Ints, size: int) -> Ints:
    """Add the corners on a straight line between others, which are left out: faces beside it may have them."""
    if len(triangles) >= size - 2:
        return triangles
    # In the order of the triangles, which JavaScript has, too: that of a set is Python's own.
    sides: dict[tuple[int, int], None] = {}
    for i, j, k in triangles.tolist():
        sides |= dict.fromkeys([(i, j), (j, k), (k, i)])
    more: list[tuple[int, int, int]] = []
    for i, j in sides:
        if (j, i) not in sides:
            steps = range(1, (j - i) % size)
            more += [(i, (i + step) % size, (i + step + 1) % size) for step in steps]
    return np.concatenate([triangles, np.array(more, np.int64).reshape(-1, 3)])


def _area_vectors(positions: Doubles, triangles: Ints) -> Doubles:
    a, b, c = positions[triangles[:, 0]], positions[triangles[:, 1]], positions[triangles[:, 2]]
    return np.cross(b - a, c - a)
