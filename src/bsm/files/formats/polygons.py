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
from bsm.codec.arrays import sealed
from bsm.codec.geometry.attributes import MOST_COMPONENTS, MOST_NAME_BYTES, Attribute, Domain, Semantic
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
            raise MeshError(f"a corner refers to value {used[(used < 0) | (used >= len(self.values))][0]}")
        return Attribute(name, self.values, "corner", self.semantic, used.astype(np.int32))


def attributes_of(
    columns: Iterable[Column], vertices: int, polygons: int, places: Ints, owner: Ints
) -> tuple[tuple[Attribute, ...], dict[str, str], dict[str, str]]:
    """The attributes that columns are, their names in the file as metadata, and why the others are none, by name."""
    rows = {"vertex": vertices, "face": polygons}
    attributes: dict[str, Attribute] = {}
    file_names: dict[str, str] = {}
    refused: dict[str, str] = {}
    for column in columns:
        distinct = _distinct(column, attributes)
        try:
            if rows.get(column.domain, len(column.values)) != len(column.values):
                raise MeshError(f"there are {len(column.values)} of them for {rows[column.domain]}")
            attribute = distinct.of_triangles(distinct.name, places, owner)
        except MeshError as error:
            refused[PLURALS.get(column.name, column.name)] = str(error)
            continue
        attributes[distinct.name] = attribute
        names = {CALLED: distinct.file_name, COMPONENTS: "\n".join(distinct.components)}
        file_names |= {f"{kind}{attribute.name}": words for kind, words in names.items() if words}
    return tuple(attributes.values()), file_names, refused


def _distinct(column: Column, names_taken: Collection[str]) -> Column:
    """Return a column under a name that no other one has; what its file calls it is kept."""
    name = unused_name(column.name, column.domain, names_taken)
    return column if name == column.name else replace(column, name=name, file_name=column.file_name or column.name)


def joined_columns(parts: Sequence[Part]) -> tuple[list[Column], list[str]]:
    """Return the columns of parts, joined, those of fewer numbers filled up (by an opacity of 1, or zeros); notes."""
    by_name: list[dict[str, Column]] = [{} for _ in parts]
    for part, named_so in zip(parts, by_name, strict=True):
        for column in part.columns:
            distinct = _distinct(column, named_so)
            named_so[distinct.name] = distinct
    columns: list[Column] = []
    notes: list[str] = []
    for name in dict.fromkeys(name for named_so in by_name for name in named_so):
        alike = _made_alike(parts, [named_so.get(name) for named_so in by_name], notes)
        columns.append(_concatenated(parts, alike))
        if lacking := alike.count(None):
            filled = "white" if columns[-1].semantic == "color" else "zeros"
            notes.append(f"parts without {PLURALS.get(name, name)} were given {filled}: {lacking}")
    return columns, notes


def _made_alike(parts: Sequence[Part], columns: list[Column | None], notes: list[str]) -> list[Column | None]:
    """Return the columns of one name in the meaning, the width and the domain that hold those of all parts."""
    every = [column for column in columns if column is not None]
    name, meanings, most = every[0].name, {c.semantic for c in every}, max(c.values.shape[1] for c in every)
    if len(meanings) > 1:
        columns = [c and replace(c, semantic="generic") for c in columns]
    if any(c.values.shape[1] < most for c in every):
        more = [((0, 0), (0, most - c.values.shape[1])) if c else () for c in columns]
        columns = [
            c and replace(c, values=np.pad(c.values, m, constant_values=_blank(c))) for c, m in zip(columns, more)
        ]
        if meanings - {"color", "texcoord"}:
            notes.append(f"parts whose {name} has fewer than {most} numbers were given zeros after them")
    # Zeros would be black holes in every viewer.
    if meanings == {"normal"} and None in columns:
        notes.append(f"parts without normals were given those of their faces: {columns.count(None)}")
        columns = [c or Column(name, part.normals(), "face", "normal") for part, c in zip(parts, columns, strict=True)]
    if len({column.domain for column in columns if column}) > 1:
        columns = [column and part.at_corners(column) for part, column in zip(parts, columns, strict=True)]
    return columns


def _blank(column: Column) -> int:
    """The opacity of a color, or zero."""
    return {"uint8": 255, "uint16": 65535}.get(column.values.dtype.name, 1) if column.semantic == "color" else 0


def _concatenated(parts: Sequence[Part], columns: list[Column | None]) -> Column:
    """Return the columns of parts as one; parts that have none get zeros, or white."""
    there = [column for column in columns if column is not None]
    if there[0].semantic == "color" and len({c.values.dtype for c in there}) > 1:  # bytes here, floats there
        columns = [c and replace(c, values=shares_of(c.values).astype(np.float32)) for c in columns]
    model = next(filter(None, columns))
    tables, places, begin = [], [], 0
    for part, column in zip(parts, columns, strict=True):
        if column is None:
            count = {"vertex": len(part.positions), "face": len(part.sizes), "corner": len(part.corners)}[model.domain]
            size = min(count, 1) if model.domain == "corner" else count
            values = np.full((size, model.values.shape[1]), _blank(model), model.values.dtype)
            column = replace(model, values=values, indices=np.zeros(count, np.int64))
        tables.append(column.values)
        places.append(begin + (np.empty(0, np.int64) if column.indices is None else column.indices))
        begin += len(column.values)
    at_corners = np.concatenate(places) if model.domain == "corner" else None
    return replace(model, values=np.concatenate(tables), indices=at_corners)


def polygon_normals(positions: Doubles, sizes: Ints, corners: Ints) -> Doubles:
    """The unit normals of polygons; zeros for polygons without area, or whose corners do not exist."""
    first, owner = np.cumsum(sizes) - sizes, np.repeat(np.arange(len(sizes)), sizes)
    if corners.size and not 0 <= corners.min() <= corners.max() < len(positions):
        return np.zeros((len(sizes), 3))
    after = np.arange(1, len(corners) + 1)
    after[first[sizes > 0] + sizes[sizes > 0] - 1] = first[sizes > 0]
    with np.errstate(over="ignore", invalid="ignore"):  # a later check refuses infinite values
        # From the first corner and not from the origin: far off, the products of coordinates would lose the area in
        # rounding.
        points = positions[corners] - positions[corners[first[owner]]]
        vectors = np.cross(points, points[after]) if len(corners) else points
        return unit_rows(np.column_stack([np.bincount(owner, axis, len(sizes)) for axis in vectors.T]))


def unit_rows(vectors: Doubles, blank: Sequence[float] = (0.0, 0.0, 0.0)) -> Doubles:
    """Return vectors at length one; those without a length become `blank`."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    units: Doubles = np.divide(vectors, lengths, out=np.broadcast_to(blank, vectors.shape).copy(), where=lengths > 0)
    return units


def turned_normals(normals: Doubles, linear: Doubles) -> Doubles:
    """Transform normals, shape (n, 3), by one matrix or by one each; mirrors turn the faces, not the normals."""
    rows = np.swapaxes(linear, -1, -2)
    # The cofactors and not the inverse transposed: they also exist where a matrix flattens a part.
    cofactors = np.stack([np.cross(rows[..., (i + 1) % 3, :], rows[..., (i + 2) % 3, :]) for i in range(3)], axis=-1)
    side = np.where(np.linalg.det(linear) < 0, -1.0, 1.0)[..., None]
    return unit_rows(np.einsum("...ij,...j->...i", cofactors, normals) * side)


def grouped(what: str, names: Sequence[str], of_face: Ints) -> tuple[list[Column], dict[str, str]]:
    """Return the groups of faces: numbers if there are several groups, and their names as metadata."""
    changes, places = np.unique(of_face, return_inverse=True)
    used = [names[i] for i in changes.tolist()]
    numbers = {name: number for number, name in enumerate(dict.fromkeys(used))}
    of_change = np.array([numbers[name] for name in used], np.int32)
    columns = [Column(what, of_change[places], "face")] if len(numbers) > 1 else []
    return columns, named(list(numbers), what) if any(numbers) else {}


def unused_name(name: str, domain: str, names_taken: Collection[str]) -> str:
    longer = name if name.startswith(domain) else f"{domain}_{name}"
    candidates = chain((name, longer), (f"{name}{number}" for number in count(2)))
    return next(candidate for candidate in candidates if candidate not in names_taken)


def compact(values: Array) -> Array:
    """Floats in single precision where that moves none by more than a millionth of their range."""
    wide = values.dtype == np.float64 and values.size and np.isfinite(values).all() and single_suffices(values)
    return values.astype(np.float32) if wide else values


def color_column(values: Array, domain: Domain, *, written_whole: bool = False) -> Column:
    """Colors as a file has them: bytes, or floats from 0 to 1; numbers beyond that mean nothing known."""
    has_color = np.isfinite(values).all(axis=1) if values.dtype.kind == "f" else np.ones(len(values), np.bool_)
    if has_color.any() and not has_color.all():  # some have no color, and the others tell what they are
        known_colors = color_column(values[has_color], domain, written_whole=written_whole)
        is_bytes = known_colors.values.dtype == np.uint8 and (written_whole or values[has_color].max() > 1)
        return replace(known_colors, values=compact(values / 255 if is_bytes else values))
    if values.dtype.kind == "f" and values.size and np.isfinite(values).all():
        exact = values if written_whole or values.max() > 1 else values * 255
        bytes_ = np.rint(exact)
        if bytes_.min() >= 0 and bytes_.max() <= 255 and np.abs(bytes_ - exact).max() <= 255e-6:
            return Column("color", bytes_.astype(np.uint8), domain, "color")
        in_range = values.min() >= 0 and values.max() <= 1
        return Column("color", compact(values), domain, "color" if in_range else "generic")
    return Column("color", values, domain, "color" if values.dtype in (np.uint8, np.uint16) else "generic")


def named_column(
    name: str, values: Array, domain: Domain, meaning: Semantic | None = None, components: Sequence[str] = ()
) -> Column:
    """Values as libraries name them, shape (k, c), and their components; None: their name gives their meaning."""
    lower = name.lower()
    if meaning is None:
        kind = "color" if lower in _COLORS else "texcoord" if lower in _TEXCOORDS else name
        meaning = meaning_of(kind, values.shape[1])
    column = color_column(values, domain) if meaning == "color" else Column(name, values, domain, meaning)
    return Column(name, column.values, domain, column.semantic, components=tuple(components))


def meaning_of(name: str, components: int = 3) -> Semantic:
    """Return the meaning of values by their name, if as many components can mean that."""
    widths: dict[Semantic, tuple[int, ...]] = {"color": (3, 4), "normal": (3,), "texcoord": (2, 3)}
    match = re.match(r"(?:(?:vertex|corner|face)_)?(color|normal|texcoord)s?(?![a-z])", name.lower())
    fits = (meaning for meaning in widths if match and match[1] == meaning and components in widths[meaning])
    return next(fits, "generic")


CUT = "polygons were cut into triangles"
CROSSING = "polygons whose sides cross, so that their triangles overlap"
_MOST_TURNS = 16  # fans that are tried for a polygon
_MOST_CORNERS = 1 << 15  # of a polygon whose ears are clipped: that can take the square of it
PER_TRIANGLE, PER_CUT, PER_CORNER = 80, 300, 24  # bytes of a triangle, of one that a polygon is cut into, of a corner
PER_JOINED, PER_PART = 200, 2000  # bytes that parts take while they are joined: of each triangle of a table, and a part


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
        positions, sizes, corners = self.positions, self.sizes, self.corners
        triangles = int(np.maximum(sizes - 2, 0).sum())
        require_counts(limits, vertices=len(positions), faces=triangles)
        memory = PER_TRIANGLE if (sizes == 3).all() else PER_CUT
        # Before any triangle is made.
        limits.check_memory(memory * triangles + PER_CORNER * len(corners), len(positions), received)
        if not (sizes > 0).any():
            reason = f"; it has {', '.join(self.dropped)}" if self.dropped else "; point clouds are not supported"
            raise NoFacesError(f"the file has no faces that can be read{reason}")
        outside = (corners < 0) | (corners >= len(positions))
        if outside.any():
            index = int(corners[np.argmax(outside)])
            raise MeshError(f"a face refers to vertex {index}, outside 0..{len(positions) - 1}")
        if not np.isfinite(positions).all():
            row = int(np.argmin(np.isfinite(positions).all(axis=1)))
            raise MeshError(f"vertex {row} has a coordinate that is not finite; remove or repair it")
        notes = list(self.notes)
        thin = int((sizes < 3).sum())
        left_out = [*self.dropped, *([f"faces with fewer than three corners ({thin})"] if thin else [])]
        if (sizes > 3).any():
            notes.append(f"{CUT}: {int((sizes > 3).sum())}")
        places, owner, folded = (cut or triangulate)(positions, sizes, corners)
        if folded:
            notes.append(f"{CROSSING}: {folded}")
        without = list[str]()
        narrow = (one for column in self.columns for one in _narrow(column))
        finite = [one for column in narrow for one in _finite(column, without)]
        attributes, file_names, refused = attributes_of(finite, len(positions), len(sizes), places, owner)
        wide = {column.name: [*_component_names(column)] for column in self.columns if _is_wide(column)}
        file_names |= {f"{COMPONENTS}{name}": "\n".join(names) for name, names in wide.items()}
        metadata, too_large = fitting({**self.metadata, **file_names}, limits.metadata_bytes)
        left_out += without
        dropped = (*left_out, *refused, *too_large)
        notes += [f"left out: {', '.join(left_out)}"] if left_out else []
        notes += [f"left out: {name}, because {why}" for name, why in (refused | too_large).items()]
        faces = corners[places].astype(np.int32)
        return MeshFile(TriangleMesh(positions, sealed(faces), attributes, metadata), tuple(notes), dropped)


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
        of_corners = np.repeat(is_kept, self.sizes)
        columns = [
            c if c.domain == "vertex" else replace(c, values=c.values[is_kept]) if c.domain == "face"
            else replace(c, indices=(np.arange(len(of_corners)) if c.indices is None else c.indices)[of_corners])
            for c in self.columns
        ]  # fmt: skip
        sizes, corners, materials = self.sizes[is_kept], self.corners[of_corners], self.materials[is_kept]
        return replace(self, sizes=sizes, corners=corners, materials=materials, columns=columns)

    def placed(self, matrix: Doubles) -> Part:
        """Return the part where a matrix moves it; mirrors turn its polygons around."""
        linear, order = matrix[:3, :3], np.arange(len(self.corners))
        if np.linalg.det(linear) < 0:
            order = turned_corners(self.sizes, np.ones(len(self.sizes), np.bool_))
        columns = [c if c.indices is None else replace(c, indices=c.indices[order]) for c in self.columns]
        for place, column in enumerate(columns):
            if column.semantic == "normal":
                values = turned_normals(column.values.astype(np.float64), linear)
                columns[place] = replace(column, values=compact(values))
        with np.errstate(invalid="ignore"):  # a later check refuses infinite values
            positions = self.positions @ linear.T + matrix[:3, 3]
        return replace(self, positions=positions, corners=self.corners[order], columns=columns)


def without_hidden(part: Part, losses: dict[str, None]) -> Part:
    """Return a part without the cells that VTK hides, and without their marks."""
    of_faces = (column.values[:, 0] for column in part.columns if (column.name, column.domain) == (GHOSTS, "face"))
    marks = next(of_faces, np.zeros(0, np.uint8))
    part = replace(part, columns=[column for column in part.columns if column.name != GHOSTS])
    if len(marks) != len(part.sizes) or not (hidden := np.flatnonzero(marks.astype(np.int64) & _HIDDEN)).size:
        return part
    losses[f"hidden cells ({len(hidden)})"] = None
    return part.without(hidden)


def part_of(polygons: Polygons, name: str) -> Part:
    """Return polygons as a part without materials."""
    materials = np.zeros(len(polygons.sizes), np.int64)
    return Part(polygons.positions, polygons.sizes, polygons.corners, polygons.columns, materials, name)


def joined_parts(
    parts_given: Iterable[Part], counts: Sequence[tuple[int, int]] | None, limits: Limits, received: int
) -> Polygons:
    """Join the parts of a scene; `counts`, the vertices and triangles of each, are checked before a part is made."""
    if counts is None:  # the parts are there already
        parts_given = list(parts_given)
        counts = [(len(part.positions), int(np.maximum(part.sizes - 2, 0).sum())) for part in parts_given]
    vertices, triangles = (sum(count[place] for count in counts) for place in range(2))
    require_counts(limits, vertices=vertices, faces=triangles)
    memory = PER_JOINED * triangles + PER_PART * len(counts)
    limits.check_memory(memory, vertices, received)
    parts: list[Part] = []
    kinds: set[tuple[str, Domain]] = set()
    for part in parts_given:
        if len(part.corners) and not 0 <= part.corners.min() <= part.corners.max() < len(part.positions):
            raise MeshError(f"a face of {part.name or 'a part'} refers to a vertex that it does not have")
        parts.append(part)
        kinds |= {(column.name, column.domain) for column in part.columns}
        limits.check_memory(memory + PER_JOINED * len(kinds) * max(triangles, vertices // 3), vertices, received)
    begin = np.cumsum([0, *(len(part.positions) for part in parts)])
    nothing = np.empty(0, np.int64)
    columns, notes = joined_columns(parts)
    corners = np.concatenate([nothing, *(part.corners + first for part, first in zip(parts, begin))])
    sizes = np.concatenate([nothing, *(part.sizes for part in parts)])
    materials = np.concatenate([nothing, *(part.materials for part in parts)])
    metadata: dict[str, str | int | float | bytes] = {}
    if len(np.unique(materials)) > 1:
        columns.append(Column("material", materials.astype(np.int32)[:, None], "face"))
    if len(parts) > 1:
        owner = np.repeat(np.arange(len(parts), dtype=np.int32), [len(part.sizes) for part in parts])
        notes = [f"{len(parts)} parts were joined to one mesh", *notes]
        columns.append(Column("part", owner[:, None], "face"))
        metadata |= named([part.name for part in parts], "part")
    elif parts and parts[0].name:
        metadata["name"] = parts[0].name
    positions = np.concatenate([np.empty((0, 3)), *(part.positions for part in parts)])
    return Polygons(positions, sizes, corners, tuple(notes), (), tuple(columns), metadata)


def joined_files(files: Sequence[MeshFile], names: Sequence[str], limits: Limits) -> MeshFile:
    """Return the meshes of files as the parts of one."""
    if len(files) == 1:
        return files[0]
    parts = []
    for name, mesh in zip(names, (file.mesh for file in files), strict=True):
        columns = [
            Column(
                a.name,
                a.values,
                a.domain,
                a.semantic,
                None if a.indices is None else a.indices.ravel().astype(np.int64),
            )
            for a in mesh.attributes
        ]
        corners = mesh.faces.ravel().astype(np.int64)
        polygons = Polygons(mesh.positions, np.full(len(mesh.faces), 3), corners, (), (), tuple(columns))
        parts.append(part_of(polygons, Path(name).stem))
    joined = joined_parts(parts, None, limits, 1 << 62)
    notes = dict.fromkeys(note for file in files for note in file.notes)
    metadata = {**files[0].mesh.metadata, **joined.metadata}
    return replace(joined, notes=(*notes, *joined.notes), metadata=metadata).checked(limits)


_MOST_NARROW = 32
_AXES = {6: "xx yy zz xy yz xz", 9: "xx xy xz yx yy yz zx zy zz"}


def _is_wide(column: Column) -> bool:
    return column.values.ndim > 1 and MOST_COMPONENTS < column.values.shape[1] <= _MOST_NARROW


def _component_names(column: Column) -> Sequence[str]:
    """The names of the components of a column in its file, or those by axes if it is a tensor, or numbers."""
    width = column.values.shape[1]
    if len({*column.components}) == width:
        return column.components
    return _AXES[width].split() if width in _AXES else [str(place) for place in range(width)]


def _narrow(column: Column) -> list[Column]:
    """Return a column of more numbers than an attribute has as one of each."""
    if not _is_wide(column):
        return [column]
    one = replace(column, components=())
    names = (f"{column.name}.{component}" for component in _component_names(column))
    return [replace(one, name=name, values=column.values[:, [place]]) for place, name in enumerate(names)]


def _finite(column: Column, dropped: list[str]) -> list[Column]:
    """A column with the median of the others for values that are not finite, and one that marks these."""
    lost = ~np.isfinite(column.values) if column.values.dtype.kind == "f" else np.zeros(0, np.bool_)
    if not lost.any() or lost.all():
        return [column]
    name = PLURALS.get(column.name, column.name)
    dropped.append(f"values of {name} that are not numbers ({int(lost.sum())}); {column.name}{NONE} marks them")
    usual = column.values.dtype.type(np.median(column.values[~lost]))
    rows = np.asarray(lost.any(axis=1))
    marks = replace(column, name=f"{column.name}{NONE}", values=rows.astype(np.uint8)[:, None])
    marks = replace(marks, semantic="generic", file_name="", components=())
    return [replace(column, values=np.where(lost, usual, column.values)), marks]


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
    normals: Doubles = np.column_stack([np.bincount(owner, weights=axis, minlength=len(sizes)) for axis in vectors.T])

    def folded(rows: Ints, candidates: Ints) -> Ints:
        # A triangle whose normal is against that of its polygon lies outside of it, or over another triangle.
        against = (_area_vectors(scaled, corners[candidates]) * normals[owner[rows]]).sum(axis=1) < 0
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
    rows = np.flatnonzero(np.isin(np.repeat(np.arange(len(sizes)), sizes), bad))
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
            self._sizes, self._corners, self._cut = sizes, corners, triangulate(positions, sizes, corners)
        return self._cut


def _ears(points: Doubles, sizes: Ints, normals: Doubles) -> list[Ints]:
    """Cut polygons that are not convex into triangles by clipping ears; one whose sides cross gets too few or many."""
    if sizes.max() > _MOST_CORNERS:
        raise MeshError(f"a polygon that is not convex has {sizes.max()} corners; cut it into triangles before")
    flat, clip = _flattened(points, np.repeat(normals, sizes, axis=0)), _clipper()
    spans = zip((np.cumsum(sizes) - sizes).tolist(), sizes.tolist())
    return [_filled(clip(flat[at : at + size], [size]), size) for at, size in spans]


def cut_holes(points: Doubles, ends: Sequence[int]) -> Ints:
    """Cut a polygon with holes into triangles: its corners, then those of each hole; `ends` of these."""
    ring = np.arange(ends[0])
    if len(points) > _MOST_CORNERS:
        raise MeshError(f"a polygon with holes has {len(points)} corners; cut it into triangles before")
    normal = polygon_normals(points, np.array([ends[0]]), ring)
    return _clipper()(_flattened(points, np.repeat(normal, len(points), axis=0)), ends)


def _flattened(points: Doubles, normals: Doubles) -> Doubles:
    """Return points without the axis along which their normals are longest, counterclockwise as seen from there."""
    # Leaving out one axis rounds nothing, where a projection on the plane would.
    axis = np.argmax(np.abs(normals), axis=1)[:, None]
    axes = np.array([[1, 2], [0, 2], [0, 1]])[axis[:, 0]]
    sign = np.where((np.take_along_axis(normals, axis, 1) < 0) != (axis == 1), -1.0, 1.0)
    return np.ascontiguousarray(np.take_along_axis(points, axes, 1) * np.column_stack([sign, np.ones_like(sign)]))


def _clipper() -> Callable[[Doubles, Sequence[int]], Ints]:
    """Return what makes triangles of a polygon and its holes, whose corners end at given places."""
    library = imported("mapbox_earcut", "polygons that are not convex are cut with mapbox-earcut", "formats")
    cut = library.triangulate_float64
    return lambda flat, ends: cut(flat, np.array(ends, np.uint32)).reshape(-1, 3).astype(np.int64)


def _filled(triangles: Ints, size: int) -> Ints:
    """Add the corners on a straight line between others, which are left out: faces beside it may have them."""
    if len(triangles) >= size - 2:
        return triangles
    # In the order of the triangles, which JavaScript has, too: that of a set is Python's own.
    sides = dict.fromkeys(side for i, j, k in triangles.tolist() for side in ((i, j), (j, k), (k, i)))
    more = [
        (i, (i + k) % size, (i + k + 1) % size)
        for i, j in sides
        if (j, i) not in sides
        for k in range(1, (j - i) % size)
    ]
    return np.concatenate([triangles, np.array(more, np.int64).reshape(-1, 3)])


def _area_vectors(positions: Doubles, triangles: Ints) -> Doubles:
    a, b, c = positions[triangles[:, 0]], positions[triangles[:, 1]], positions[triangles[:, 2]]
    return np.cross(b - a, c - a)
