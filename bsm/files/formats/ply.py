"""PLY: a header that declares elements and their properties, then the elements, binary or as text."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bitstream.errors import FormatError, MeshError, TruncatedError
from bsm.files.formats.polygons import Polygons
from bsm.files.rows import Ints, Rows, as_integers, ranges, require_lines, single_suffices
from codec.geometry.mesh import TriangleMesh

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "double": "f8", "float32": "f4", "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_LIST_NAMES = ("vertex_indices", "vertex_index")
_MAX_ELEMENTS = 64

_KNOWN = {
    "nx": "normals", "ny": "normals", "nz": "normals",
    "red": "colours", "green": "colours", "blue": "colours", "alpha": "colours",
    "diffuse_red": "colours", "diffuse_green": "colours", "diffuse_blue": "colours",
    "s": "texture coordinates", "t": "texture coordinates", "u": "texture coordinates", "v": "texture coordinates",
    "texture_u": "texture coordinates", "texture_v": "texture coordinates", "texcoord": "texture coordinates",
    "texnumber": "materials", "material_index": "materials",
}  # fmt: skip
"""What properties beside coordinates and corners hold; others are called by their own names."""


@dataclass(frozen=True)
class Property:
    """One column of an element: a number, or a list of numbers behind its length (of the type `length`)."""

    name: str
    type: str
    length: str | None = None


@dataclass(frozen=True)
class Element:
    """A table of `count` rows."""

    name: str
    count: int
    properties: tuple[Property, ...]

    def index(self, *names: str) -> int:
        """The place of the first property that has one of the names, or -1."""
        return next((i for i, column in enumerate(self.properties) if column.name in names), -1)


@dataclass(frozen=True)
class Header:
    """The order of the bytes ("" for text), the elements, and where the body begins."""

    order: str
    elements: tuple[Element, ...]
    size: int

    @property
    def dropped(self) -> tuple[str, ...]:
        """What the elements hold beside points and faces."""
        needed = {"vertex": ("x", "y", "z"), "face": _LIST_NAMES}
        found = [
            _KNOWN.get(column.name, column.name)
            for element in self.elements
            for column in element.properties
            if element.name in needed and column.name not in needed[element.name]
        ]
        others = [element.name for element in self.elements if element.name not in needed and element.count]
        return tuple(dict.fromkeys(found + others))


def read_ply(data: bytes) -> Polygons:
    """Read a PLY with points and faces, of any byte order."""
    header = parse_header(data)
    names = [element.name for element in header.elements]
    if "tristrips" in names:
        raise MeshError("this PLY file holds triangle strips; convert it to faces (MeshLab does when it saves)")
    if "vertex" not in names or "face" not in names:
        raise MeshError("this PLY file has no faces; point clouds are not supported")
    body = data[header.size :]
    return _read_binary(header, body) if header.order else _read_text(header, body)


def parse_header(data: bytes) -> Header:
    """Parse the lines up to `end_header`."""
    begin = re.match(rb"ply[ \t]*(\r\n|\n|\r)", data)
    if begin is None:
        raise FormatError("this is not a PLY file: it does not begin with ply")
    line_end = begin[1]  # old Macintosh files have \r alone
    end = re.compile(rb"[\r\n][ \t]*end_header[ \t]*(?:" + line_end + rb"|\Z)").search(data, begin.end() - 1, 1 << 16)
    if end is None:
        raise TruncatedError("the PLY header has no end_header")
    order: str | None = None
    elements: list[Element] = []
    for line in re.split("[\r\n]+", data[begin.end() : end.start()].decode("latin-1")):
        words = line.split()
        try:
            match words:
                case [] | ["comment", *_] | ["obj_info", *_]:
                    pass
                case ["format", name, *_]:
                    order = _ORDERS[name]
                case ["element", name, count]:
                    elements.append(Element(name, _count(count), ()))
                case ["property", "list", length, kind, name]:
                    _extend(elements, Property(name, _TYPES[kind], _TYPES[length]))
                case ["property", kind, name]:
                    _extend(elements, Property(name, _TYPES[kind]))
                case _:
                    raise KeyError
        except (KeyError, IndexError, ValueError):
            raise FormatError(f"the PLY header has a line that makes no sense: {line[:80]!r}") from None
    if order is None or len(elements) > _MAX_ELEMENTS:
        raise FormatError("the PLY header names no format, or too many elements")
    return Header(order, tuple(elements), end.end())


def _count(text: str) -> int:
    if not re.fullmatch(r"\d{1,18}", text):
        raise ValueError
    return int(text)


def _extend(elements: list[Element], column: Property) -> None:
    last = elements[-1]
    elements[-1] = Element(last.name, last.count, (*last.properties, column))


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


# --------------------------------------------------------------------------------------------------------------- text


def _read_text(header: Header, body: bytes) -> Polygons:
    """Elements as text: one row, one line."""
    lines = [line for line in body.splitlines() if line.strip()]
    require_lines(len(lines), sum(element.count for element in header.elements))
    ends = np.cumsum([element.count for element in header.elements]).tolist()
    tables = {element.name: (element, lines[end - element.count : end]) for element, end in zip(header.elements, ends)}
    vertex, vertex_lines = tables["vertex"]
    face, face_lines = tables["face"]
    points, polygons = Rows(vertex_lines, "vertex"), Rows(face_lines, "face")
    positions = np.column_stack([points.columns(place, 1) for place in _coordinates(vertex)])
    before = _corner_list(face)
    if any(column.length for column in face.properties[:before]):
        raise MeshError("the faces of this PLY file have another list before vertex_indices")
    sizes, corners = polygons.lists(before)
    return Polygons(positions, sizes, corners, dropped=header.dropped)


# ------------------------------------------------------------------------------------------------------------- binary


def _read_binary(header: Header, body: bytes) -> Polygons:
    """Elements as bytes, one behind the other."""
    positions, faces, offset = np.empty((0, 3)), None, 0
    for element in header.elements:
        if not any(column.length for column in element.properties):
            table = np.dtype([(str(i), header.order + column.type) for i, column in enumerate(element.properties)])
            _require_bytes(body, offset, element.count * table.itemsize)
            if element.name == "vertex":
                rows = np.frombuffer(body, table, element.count, offset)
                positions = np.column_stack([rows[str(i)].astype(np.float64) for i in _coordinates(element)])
            offset += element.count * table.itemsize
        elif element.name == "vertex":
            _coordinates(element)
        else:
            first = next(i for i, column in enumerate(element.properties) if column.length)
            place = _corner_list(element) if element.name == "face" else first
            lists = _uniform_lists(element, header.order, body, offset, place)
            if lists is None:
                lists = _ragged_lists(element, header.order, body, offset, place)
            offset = lists.end
            faces = lists if element.name == "face" else faces
    if faces is None:
        _corner_list(next(element for element in header.elements if element.name == "face"))
        raise MeshError("the faces of this PLY file are not lists")
    return Polygons(positions, faces.sizes, faces.items(), dropped=header.dropped)


@dataclass(frozen=True)
class _Lists:
    """The lists of one property: their lengths, a function that reads their items, and where the element ends."""

    sizes: Ints
    items: Callable[[], Ints]
    end: int


def _require_bytes(body: bytes, offset: int, needed: int) -> None:
    if offset + needed > len(body):
        missing = offset + needed - len(body)
        raise TruncatedError(f"the PLY file is cut short: its header claims {missing} bytes more than there are")


def _uniform_lists(element: Element, order: str, body: bytes, offset: int, place: int) -> _Lists | None:
    """Lists that all have the lengths of the first row's (a mesh of triangles only), else None."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    cursor = offset
    for i, column in enumerate(element.properties):
        if column.length is not None:
            kind = np.dtype(order + column.length)
            fields.append((f"length{i}", kind.str))
            if element.count and cursor + kind.itemsize <= len(body):
                length = int(np.frombuffer(body, kind, 1, cursor)[0])
            else:
                length = 0
            cursor += kind.itemsize
            if not 0 <= length <= len(body):
                return None
            fields.append((f"items{i}", order + column.type, (length,)))
            cursor += np.dtype(column.type).itemsize * length
        else:
            fields.append((str(i), order + column.type))
            cursor += np.dtype(column.type).itemsize
    if offset + element.count * (cursor - offset) > len(body):
        return None
    rows = np.frombuffer(body, np.dtype(fields), element.count, offset)
    lengths = [rows[f"length{i}"] for i, column in enumerate(element.properties) if column.length]
    if any((column != column[:1]).any() for column in lengths):
        return None
    items = rows[f"items{place}"]
    sizes = np.full(element.count, items.shape[1], dtype=np.int64)
    end = offset + element.count * (cursor - offset)
    return _Lists(sizes, lambda: as_integers(items.reshape(-1), "a vertex index"), end)


def _ragged_lists(element: Element, order: str, body: bytes, offset: int, place: int) -> _Lists:
    """Lists of different lengths, found by walking over the bytes."""
    from bsm.files.formats.walk import walk_rows

    # Every row is at least as long as its numbers and the lengths of its lists.
    widths = [
        (np.dtype(column.length).itemsize if column.length else 0, np.dtype(column.type).itemsize)
        for column in element.properties
    ]
    _require_bytes(body, offset, element.count * sum(length or width for length, width in widths))
    raw = np.frombuffer(body, np.uint8)
    starts, sizes, end = walk_rows(raw, offset, element.count, np.array(widths), place, order == ">")
    if end < 0:
        raise TruncatedError("the PLY file is cut short: a list runs over its end", offset=-end)
    kind = np.dtype(order + element.properties[place].type)

    def items() -> Ints:
        picked: npt.NDArray[np.uint8] = raw[ranges(starts, sizes * kind.itemsize)]
        return as_integers(picked.view(kind), "a vertex index")

    return _Lists(sizes, items, end)


# ------------------------------------------------------------------------------------------------------------ writing


def write_ply(mesh: TriangleMesh) -> bytes:
    """The binary PLY of a mesh: coordinates as float where that moves no vertex visibly, else as double."""
    name, kind = ("float", "<f4") if single_suffices(mesh.positions) else ("double", "<f8")
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.positions)}\n"
        f"property {name} x\nproperty {name} y\nproperty {name} z\n"
        f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(mesh.faces), [("length", "u1"), ("corners", "<i4", 3)])
    faces["length"] = 3
    faces["corners"] = mesh.faces
    return header.encode() + mesh.positions.astype(kind).tobytes() + faces.tobytes()
