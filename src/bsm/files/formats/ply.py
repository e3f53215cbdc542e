"""PLY: a header that declares elements and their properties, then the elements, binary or as text."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import count, takewhile

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import MOST_COMPONENTS, Attribute, Domain, Semantic
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes
from bsm.files.formats.metadata import one_line, remarks
from bsm.files.formats.ply_tables import COMMENTS, IMAGE, Element, Table, parse_header, tables_of
from bsm.files.formats.polygons import Array, Column, Polygons, color_column, unused_name
from bsm.files.formats.written import Library, Written, left_out
from bsm.files.rows import Ints, as_integers, single_suffices

_LIST_NAMES = ("vertex_indices", "vertex_index")

_GROUPS: tuple[tuple[Semantic, tuple[str, ...]], ...] = (
    ("normal", ("nx", "ny", "nz")),
    ("color", ("red", "green", "blue", "alpha")),
    ("color", ("red", "green", "blue")),
    ("color", ("diffuse_red", "diffuse_green", "diffuse_blue")),
    ("color", ("r", "g", "b")),
    ("texcoord", ("u", "v")),
    ("texcoord", ("s", "t")),
    ("texcoord", ("texture_u", "texture_v")),
    ("texcoord", ("texture_s", "texture_t")),
)
"""Properties that are one value together."""
_NAMES = {"texnumber": "material", "material_index": "material"}
"""What properties are called here, unless by their own names."""


def read_ply(data: bytes, limits: Limits) -> Polygons:
    """Read a PLY with points and faces, of any byte order, and whatever numbers they have."""
    header = parse_header(data)
    names = [element.name for element in header.elements]
    if "tristrips" in names:
        raise MeshError("this PLY file holds triangle strips; convert it to faces (MeshLab does when it saves)")
    if "vertex" not in names or "face" not in names:
        raise MeshError("this PLY file has no faces; point clouds are not supported")
    body = data[header.size :]
    tables = tables_of(header, body)
    vertex, face = tables["vertex"], tables["face"]
    with np.errstate(invalid="ignore"):  # what is not a number is refused later
        places = _coordinates(vertex.element)
        positions = np.column_stack([vertex.numbers(place).astype(np.float64) for place in places])
    sizes, items = face.lists(corners := _corner_list(face.element))
    wedges, dropped = _wedges(face, corners, sizes)
    columns = (*_columns(vertex, "vertex", "xyz"), *_columns(face, "face", ()), *wedges)
    others = [element.name for element in header.elements if element.name not in ("vertex", "face") and element.count]
    return Polygons(
        positions, sizes, as_integers(items, "a vertex index"), (), (*dropped, *others), columns, header.metadata
    )


def _columns(table: Table, domain: Domain, needed: Sequence[str]) -> Iterator[Column]:
    """The properties that are numbers, those together that are one value."""
    properties = table.element.properties
    places = {
        column.name: place
        for place, column in enumerate(properties)
        if column.length is None and column.name not in needed
    }
    for semantic, names in _GROUPS:
        types = {properties[places[name]].type for name in names if name in places}
        if all(name in places for name in names) and len(types) == 1:
            values = np.column_stack([table.numbers(places.pop(name)) for name in names])
            yield color_column(values, domain) if semantic == "color" else Column(semantic, values, domain, semantic)
    for name, together in _series({name: properties[place].type for name, place in places.items()}):
        values = np.column_stack([table.numbers(places[one]) for one in together])
        yield Column(_NAMES.get(name, name), values, domain)


def _series(types: dict[str, str]) -> Iterator[tuple[str, list[str]]]:
    """Names of properties, those that only differ in a number at the end together: a_0, a_1, ... are a."""
    left = dict(types)
    while left:
        name = next(iter(left))
        stem = name.removesuffix("_0")
        like_it = {one for one, kind in left.items() if kind == types[name]}
        run = list(takewhile(like_it.__contains__, (f"{stem}_{i}" for i in count())))
        together = run if name.endswith("_0") and 2 <= len(run) <= MOST_COMPONENTS else [name]
        yield (stem if len(together) > 1 else name), together
        left = {one: kind for one, kind in left.items() if one not in together}


def _wedges(table: Table, corners: int, sizes: Ints) -> tuple[list[Column], list[str]]:
    """Texture coordinates of corners, in a list beside that of the vertices; and the lists that mean nothing known."""
    found, dropped = [], []
    for place, column in enumerate(table.element.properties):
        if column.length is None or place == corners:
            continue
        lengths, values = table.lists(place)
        present = lengths == 2 * sizes
        if column.name != "texcoord" or not (present | (lengths == 0)).all() or not present.any():
            dropped.append(column.name)
            continue
        pairs = np.zeros((int(sizes.sum()), 2), values.dtype)  # a face without any gets zeros
        pairs[np.repeat(present, sizes)] = values.reshape(-1, 2)
        found.append(Column("texcoord", pairs, "corner", "texcoord"))
    return found, dropped


def _coordinates(element: Element) -> list[int]:
    places = [element.index(name) for name in "xyz"]
    if min(places) < 0 or any(column.length for column in element.properties):
        raise MeshError("the vertices of this PLY file are not made of numbers with an x, a y and a z")
    return places


def _corner_list(element: Element) -> int:
    place = element.index(*_LIST_NAMES)
    if place < 0 or element.properties[place].length is None:
        raise MeshError("the faces of this PLY file have no list vertex_indices")
    return place


# ------------------------------------------------------------------------------------------------------------ writing


_PLY_TYPES = {
    "int8": "char", "uint8": "uchar", "int16": "short", "uint16": "ushort", "int32": "int", "uint32": "uint",
    "float32": "float", "float64": "double",
}  # fmt: skip
_MOST_TEXT = 1 << 13
"""Characters of a comment; readers look for the end of a header in its first 64 KiB."""
_PROPERTIES = {
    ("normal", 3): ("nx", "ny", "nz"),
    ("color", 3): ("red", "green", "blue"),
    ("color", 4): ("red", "green", "blue", "alpha"),
    ("texcoord", 2): ("s", "t"),
}


def write_ply(mesh: TriangleMesh, stem: str) -> Written:
    """The binary PLY of a mesh: coordinates as float where that moves no vertex visibly, else as double."""
    library = Library(mesh, stem)
    mesh = split_by_attributes(mesh)
    images = [f"{IMAGE} {name}" for name in library.images.values()]
    texts = {word: text for word in COMMENTS if isinstance(text := mesh.metadata.get(word), str)}
    texts = {word: text for word, text in texts.items() if len(text) < _MOST_TEXT}
    free = [f"{word} {one_line(line)}" for word, text in texts.items() for line in text.split("\n")]
    comments, unsaid = remarks(mesh.metadata, library.said | texts.keys())
    columns = {"vertex": _vertex_fields(mesh), "face": [("vertex_indices", mesh.faces)]}
    for attribute in mesh.attributes:
        fields = columns[attribute.domain]
        names = _property_names(attribute, [name for name, _ in fields])
        fields += zip(names, attribute.values.T)
    lines = ["ply", "format binary_little_endian 1.0"]
    lines += [*free, *(f"comment {line}" for line in (*images, *comments))]
    body = []
    for element, fields in columns.items():
        length = len(fields[0][1])
        lines.append(f"element {element} {length}")
        rows = np.empty(length, _row_type(fields))
        for name, values in fields:
            if values.ndim == 2:
                rows[f"{name} length"] = values.shape[1]
                lines.append(f"property list uchar {_PLY_TYPES[values.dtype.name]} {name}")
            else:
                lines.append(f"property {_PLY_TYPES[values.dtype.name]} {name}")
            rows[name] = values
        body.append(rows.tobytes())
    header = "".join(f"{line}\n" for line in (*lines, "end_header"))
    return Written(header.encode() + b"".join(body), left_out(mesh, mesh.attributes, unsaid), library.beside)


def _vertex_fields(mesh: TriangleMesh) -> list[tuple[str, Array]]:
    kind = np.float32 if single_suffices(mesh.positions) else np.float64
    return list(zip("xyz", mesh.positions.astype(kind).T))


def _row_type(fields: Sequence[tuple[str, Array]]) -> list[tuple[str, str] | tuple[str, str, int]]:
    row: list[tuple[str, str] | tuple[str, str, int]] = []
    for name, values in fields:
        kind = values.dtype.newbyteorder("<").str
        row += [(f"{name} length", "u1"), (name, kind, values.shape[1])] if values.ndim == 2 else [(name, kind)]
    return row


def _property_names(attribute: Attribute, taken: list[str]) -> list[str]:
    """The names of an attribute's properties: those that everybody knows, or its own."""
    known = _PROPERTIES.get((attribute.semantic, attribute.components))
    if known and not set(known) & set(taken):
        return list(known)
    own = re.sub(r"\s", "_", attribute.name)
    names: list[str] = []
    for place in range(attribute.components):
        wanted = own if attribute.components == 1 else f"{own}_{place}"
        names.append(unused_name(wanted, attribute.domain, [*taken, *names]))
    return names
