"""Mesh files of any size, piece by piece: positions, faces, colors and normals as plain arrays on the disk."""

import tempfile
from codecs import BOM_UTF8
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError, LimitError, MeshError, TruncatedError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.console import Console
from bsm.files.formats.metadata import parse_remarks
from bsm.files.formats.obj import read_obj
from bsm.files.formats.ply import IMAGE, MOST_HEADER, Element, parse_header
from bsm.files.formats.polygons import CROSSING, Polygons, triangulate
from bsm.files.formats.stl import HEAD, RECORD, binary_triangles, is_text
from bsm.files.mesh import format_of_name
from bsm.files.output import by_its_own_name
from bsm.files.pipes import Input, size_of
from bsm.files.table import format_of_bytes

Array: TypeAlias = npt.NDArray[Any]
Pieces: TypeAlias = Iterator[tuple[str, Array]]  # some rows of "positions", "faces", "color" or "normal"
Kinds: TypeAlias = Mapping[str, tuple[str, int]]  # of numbers in a table, and how many a row has
ABOUT = ("unit", "up")
CARRIED = {"color": ("red", "green", "blue", "alpha"), "normal": ("nx", "ny", "nz")}
_KNOWN = ("x", "y", "z", "length", "corners")
_TEXTURES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texcoord",), ("texnumber",))
ROWS = 1 << 18  # that are in memory at a time
_HEAD = 1 << 16
_TEXT = 1 << 23
_TEXT_END = 1 << 6  # bytes in which a line that goes on ends
_MOST_INDEX = (1 << 32) - 1
_POINT = np.dtype([("xyz", "<f8", 3)])


class LeftOut(dict[str, None]):
    """Names of contents that tiles do not have, in order; and the unit and the axis of the mesh, which they have."""

    def __init__(self) -> None:
        super().__init__()
        self.about: dict[str, str] = {}


@dataclass(frozen=True)
class Raw:
    """A mesh as tables in files of a folder."""

    folder: Path
    kinds: dict[str, tuple[str, int]] = field(default_factory=dict)
    rows: dict[str, int] = field(default_factory=lambda: {"positions": 0, "faces": 0})
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    left_out: tuple[str, ...] = ()
    about: Mapping[str, str] = field(default_factory=dict)  # the unit, and the axis that points up

    def pieces(self, what: str) -> Iterator[Array]:
        """A table from its beginning to its end."""
        kind, columns = self.kinds[what]
        with (self.folder / what).open("rb") as file:
            while len(piece := np.fromfile(file, kind, columns * ROWS)):
                yield piece.reshape(-1, columns)

    def table(self, what: str) -> Array:
        """A table of which no more gets into memory than is looked at."""
        return mapped(self.folder, what, self.kinds)


@contextmanager
def table_file(path: Path) -> Iterator[BinaryIO]:
    with by_its_own_name(path), path.open("xb") as file:
        yield file


def mapped(folder: Path, what: str, kinds: Kinds) -> Array:
    kind, columns = kinds[what]
    path = folder / what
    return (np.memmap(path, kind, "r") if path.stat().st_size else np.zeros(0, kind)).reshape(-1, columns)


def read_big(name: str, file_format: str | None, folder: Path, console: Console) -> Raw:
    """Read a mesh of any size once; the memory is that of a piece."""
    given = Input(name)
    head = given.peek(_HEAD)
    kind = file_format or format_of_name(name) or format_of_bytes(head)
    if not head:
        raise FormatError("the file is empty")
    if kind not in _READERS:
        raise FormatError(f"tiles are made of binary PLY, binary STL and OBJ files, not of {kind or 'such files'}")
    raw = Raw(folder)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    largest, files = 0, dict[str, BinaryIO]()
    left_out = LeftOut()
    with closing(given), console.progress("reading", until=0.1), ExitStack() as opened:
        for what, piece in _READERS[kind](given, left_out):
            if not len(piece):
                continue
            piece = _checked(what, piece, raw.rows.get(what, 0))
            if what == "positions":
                low, high = np.minimum(low, piece.min(axis=0)), np.maximum(high, piece.max(axis=0))
            elif what == "faces":
                largest = max(largest, int(piece.max()))
            if what not in files:
                files[what] = opened.enter_context(table_file(folder / what))
                raw.kinds[what] = piece.dtype.newbyteorder("<").str, piece.shape[1]
            if raw.kinds[what][1] != piece.shape[1]:
                raise MeshError(
                    f"from {what} {raw.rows[what]} on, they have {piece.shape[1]} numbers each, not as before"
                )
            with by_its_own_name(folder / what):
                files[what].write(np.ascontiguousarray(piece, raw.kinds[what][0]).data)
            raw.rows[what] = raw.rows.get(what, 0) + len(piece)
    vertices = raw.rows["positions"]
    if not raw.rows["faces"]:
        raise MeshError("the mesh has no faces; point clouds are not supported")
    if largest >= vertices:
        raise MeshError(f"a face refers to vertex {largest}, outside 0..{vertices - 1}")
    for what in CARRIED:
        if raw.rows.get(what, vertices) != vertices:
            raise MeshError(f"{raw.rows[what]} of {vertices} vertices have a {what}: give all of them one, or none")
    ends = tuple(map(float, low)), tuple(map(float, high))
    return Raw(folder, raw.kinds, raw.rows, *ends, tuple(left_out), left_out.about)


def _checked(what: str, piece: Array, before: int) -> Array:
    """Rows as they are kept: positions as floats, colors as bytes or words."""
    floats = piece.dtype.kind == "f"
    if floats and not np.isfinite(piece).all():
        row = before + int(np.argmin(np.isfinite(piece).all(axis=1)))
        raise MeshError(f"vertex {row} has a {_WORDS[what]} that is not finite; remove or repair it")
    if what == "positions":
        return piece if floats and piece.dtype.itemsize == 4 else piece.astype("<f8")
    if what == "normal":
        return piece.astype("<f4")
    if what == "color":
        if floats and piece.min() >= 0 and piece.max() <= 1:
            return np.asarray(np.rint(piece * 255), "u1")
        if piece.dtype.kind != "u" or piece.dtype.itemsize > 2:
            raise MeshError(f"colors must be bytes, words, or floats from 0 to 1, not such {piece.dtype}")
        return piece
    if piece.dtype.kind not in "iu":
        raise MeshError(f"faces must be integers, not {piece.dtype}")
    if piece.min() < 0:
        raise MeshError(f"a face refers to vertex {piece.min()}, which does not exist")
    if piece.max() > _MOST_INDEX:
        raise LimitError(f"a face refers to vertex {piece.max()}; tiles are made of up to {_MOST_INDEX}")
    return piece.astype("<u4")


_WORDS = {"positions": "coordinate", "color": "color", "normal": "normal", "faces": "corner"}


def _refuse_textures(names: set[str]) -> None:
    if names:
        message = f"this mesh has a texture ({', '.join(sorted(names))}), and tiles have colors and normals of vertices"
        raise UnsupportedError(f"{message} alone: write it without, or its texture as colors")


def _read_ply(given: Input, left_out: LeftOut) -> Pieces:
    header = parse_header(given.peek(MOST_HEADER))
    if not header.order:
        raise FormatError("this PLY file is text; tiles are made of binary ones")
    given.read(header.size)
    if {"vertex", "face"} - {element.name for element in header.elements}:
        raise FormatError("the PLY file has no vertices, or no faces")
    names = {column.name for element in header.elements for column in element.properties}
    images = {IMAGE for _, line in header.comments if line.startswith(f"{IMAGE} ")}
    _refuse_textures(images | {properties[0] for properties in _TEXTURES if names.issuperset(properties)})
    left_out.about |= {name: str(header.metadata[name]) for name in ABOUT if name in header.metadata}
    others = (keyword for keyword, line in header.comments if not parse_remarks([line]).keys() & {*ABOUT})
    left_out |= dict.fromkeys(f"lines of {keyword}" for keyword in others)
    for element in header.elements:
        if not element.properties and element.name not in ("vertex", "face"):
            continue
        kind = _row_of(element, header.order)
        names = set(kind.names or ())
        carried = {
            what: tuple(column for column in columns if column in names)
            for what, columns in CARRIED.items()
            if element.name == "vertex" and names.issuperset(columns[:3])
        }
        known = {*_KNOWN, *(column for columns in carried.values() for column in columns)}
        left_out |= dict.fromkeys(name for name in kind.names or () if name not in known)
        for first in range(0, element.count, ROWS):
            size = min(ROWS, element.count - first) * kind.itemsize
            data = given.read(size)
            if len(data) < size:
                raise TruncatedError(f"the PLY file is cut short: from {element.name} {first} on all are missing")
            rows = np.frombuffer(data, kind)
            if element.name == "vertex":
                for what, columns in {"positions": ("x", "y", "z"), **carried}.items():
                    yield what, np.stack([rows[column] for column in columns], axis=1)
            elif element.name == "face":
                if (rows["length"] != 3).any():
                    raise MeshError("the faces are not all triangles; triangulate polygons first")
                yield "faces", rows["corners"]


def _row_of(element: Element, order: str) -> np.dtype[Any]:
    """A row as it stands in the file; a list is one of three corners."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for column in element.properties:
        if column.length is None:
            fields.append((column.name, order + column.type))
        elif element.name == "face" and column.name in ("vertex_indices", "vertex_index"):
            fields += [("length", order + column.length), ("corners", order + column.type, (3,))]
        else:
            raise FormatError(f"the list {column.name} of the PLY file cannot be skipped; leave it out")
    names = {field[0] for field in fields}
    needed = {"vertex": {"x", "y", "z"}, "face": {"corners"}}.get(element.name, set())
    if needed - names or len(names) < len(fields):
        raise FormatError(f"the element {element.name} of the PLY file lacks a property, or has it twice")
    return np.dtype(fields)


def _read_stl(given: Input, left_out: LeftOut) -> Pieces:
    head = given.peek(_HEAD)
    size = size_of(given.name) if given.is_file else None
    if is_text(head, size):
        raise FormatError("this STL file is text; tiles are made of binary ones")
    count, note = binary_triangles(head, size)
    left_out |= dict.fromkeys([note] if note else ())
    given.read(HEAD)
    for first in range(0, count, ROWS):
        rows = min(ROWS, count - first)
        data = given.read(RECORD.itemsize * rows)
        if len(data) < RECORD.itemsize * rows:
            raise TruncatedError(f"the STL file is cut short: triangle {first} and those after it are missing")
        records = np.frombuffer(data, RECORD)
        left_out |= dict.fromkeys(["attribute"] if records["attribute"].any() else ())
        yield "positions", records["corners"].reshape(-1, 3)
        yield "faces", np.arange(3 * first, 3 * (first + rows)).reshape(-1, 3)


def _read_obj(given: Input, left_out: LeftOut) -> Pieces:
    rest, seen = given.read(len(BOM_UTF8)).removeprefix(BOM_UTF8), 0
    with tempfile.TemporaryFile() as file:
        while data := given.read(_TEXT):
            text = rest + data
            end = text.rfind(b"\n")
            while end > 0 and text[max(end - _TEXT_END, 0) : end].rstrip().endswith(b"\\"):  # the line goes on
                end = text.rfind(b"\n", 0, end)
            if end < 0 and len(text) > _TEXT:
                raise FormatError("this is not an OBJ file: it has no lines")
            text, rest = text[: end + 1], text[end + 1 :]
            yield from _of_obj(read_obj(text, DEFAULT_LIMITS, seen), file, left_out)
            seen = file.tell() // _POINT.itemsize
        yield from _of_obj(read_obj(rest, DEFAULT_LIMITS, seen), file, left_out)


def _of_obj(piece: Polygons, file: BinaryIO, left_out: LeftOut) -> Pieces:
    """The tables of some lines; `file` holds the points of all lines so far, for the polygons that are cut."""
    left_out.about |= {name: str(piece.metadata[name]) for name in ABOUT if name in piece.metadata}
    named = (key.partition(".")[0] for key in piece.metadata if key not in ABOUT)
    names = {*(column.name for column in piece.columns), *named}
    _refuse_textures(names & {"texcoord"})
    left_out |= dict.fromkeys((*sorted(names - {"color"}), *piece.dropped))
    if (piece.sizes < 3).any():
        raise MeshError("a face has fewer than three corners")
    file.write(piece.positions.tobytes())
    yield "positions", piece.positions
    yield from (("color", column.values) for column in piece.columns if column.name == "color")
    faces = piece.corners.reshape(-1, 3) if (piece.sizes == 3).all() else None
    if faces is None:
        file.flush()
        points = np.memmap(file, _POINT, "r")["xyz"]
        used, corners = np.unique(piece.corners, return_inverse=True)
        if used[0] < 0 or used[-1] >= len(points):
            raise MeshError(f"a face refers to vertex {used[0] if used[0] < 0 else used[-1]}, which comes later")
        places, _, crossing = triangulate(points[used], piece.sizes, corners)
        left_out |= dict.fromkeys([CROSSING] if crossing else ())
        faces = piece.corners[places]
    yield "faces", faces


_READERS = {"ply": _read_ply, "stl": _read_stl, "obj": _read_obj}
