"""Mesh files of any size, piece by piece: positions, faces, colors and normals as plain arrays on the disk."""

import re
from codecs import BOM_UTF8
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any, BinaryIO, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError, LimitError, MeshError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.geometry.mesh import Metadata
from bsm.files.formats.metadata import (
    Beside,
    Value,
    fetched,
    images_in,
    materials_in,
    names_in,
    parse_remarks,
)
from bsm.files.formats.obj import read_obj
from bsm.files.formats.ply import MOST_HEADER, Element, parse_header
from bsm.files.formats.polygons import CROSSING, triangulate
from bsm.files.formats.stl import HEAD, RECORD, binary_triangles, is_text
from bsm.files.mesh import kind_of, read_mesh
from bsm.files.output import by_its_own_name
from bsm.files.pipes import Input, is_url, size_of
from bsm.ground.console import Console
from bsm.tiles.atlas import checked

Array: TypeAlias = npt.NDArray[Any]
# Some rows of "positions", "faces", "color", "normal" or "texcoord".
Pieces: TypeAlias = Iterator[tuple[str, Array]]
Kinds: TypeAlias = Mapping[str, tuple[str, int]]  # of numbers in a table, and how many a row has
ABOUT = ("unit", "up", "provenance")
CARRIED = {"color": ("red", "green", "blue", "alpha"), "normal": ("nx", "ny", "nz")}
_CORNERS = ("vertex_indices", "vertex_index")
_KNOWN = ("x", "y", "z", "length", "corners")
# A piece of this many positions takes 6 MB as doubles, and all that is derived from it (cells, codes, corners) is in
# memory at the same time.
ROWS = 1 << 18  # that are in memory at a time
_HEAD = 1 << 16
_TEXT = 1 << 23
# A backslash at the end of a line of OBJ joins it with the next one. A piece of text must not end there, or the reader
# would take the rest for a line of its own.
_TEXT_END = 1 << 6  # bytes in which a line that goes on ends
_MOST_INDEX = (1 << 32) - 1
# A piece of an OBJ file inherits the material that was named last, so its line is put before the next piece.
_USED = re.compile(rb"^[ \t]*usemtl[ \t][^\r\n]*[^\s\\]", re.MULTILINE)
_WHITE = b"P6 1 1 255 \xff\xff\xff"  # the picture of a material that has none


# The tables are files, not arrays, since a mesh may be larger than memory. Each is written once from start to end,
# which any disk does fast, and is mapped afterwards, so that the system drops pages when memory gets short.
@dataclass(frozen=True)
class Raw:
    """A mesh as tables in files of a folder."""

    folder: Path
    kinds: dict[str, tuple[str, int]] = field(default_factory=dict)
    rows: dict[str, int] = field(default_factory=lambda: {"positions": 0, "faces": 0})
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    # Names of contents that tiles do not have, in order.
    left_out: dict[str, None] = field(default_factory=dict)
    about: dict[str, str] = field(default_factory=dict)  # the entries of ABOUT
    # With materials and images, of a file read as a whole.
    metadata: dict[str, Value] = field(default_factory=dict)
    libraries: dict[str, None] = field(default_factory=dict)
    materials: dict[str, int] = field(default_factory=dict)  # their numbers, by their names
    textures: int = 0  # pictures of materials, in files of the folder

    def pieces(self, what: str) -> Iterator[Array]:
        """A table from its beginning to its end."""
        kind, columns = self.kinds[what]
        with (self.folder / what).open("rb") as file:
            # Mapped pages would count as memory of this process for as long as the map lives. A pass from start to end
            # reads instead.
            while len(piece := np.fromfile(file, kind, columns * ROWS)):
                yield piece.reshape(-1, columns)

    def table(self, what: str) -> Array:
        """A table of which no more gets into memory than is looked at."""
        return mapped(self.folder, what, self.kinds)

    def leave_out(self, *names: str) -> None:
        self.left_out.update(dict.fromkeys(names))

    def keep_about(self, metadata: Metadata) -> None:
        """Keep the entries of ABOUT."""
        for name in ABOUT:
            if name in metadata:
                self.about[name] = str(metadata[name])


@contextmanager
def table_file(path: Path) -> Iterator[BinaryIO]:
    with by_its_own_name(path), path.open("xb") as file:
        yield file


def mapped(folder: Path, what: str, kinds: Kinds) -> Array:
    kind, columns = kinds[what]
    path = folder / what
    # mmap refuses empty files.
    if not path.stat().st_size:
        return np.zeros((0, columns), kind)
    return np.memmap(path, kind, "r").reshape(-1, columns)


def read_big(name: str, file_format: str | None, folder: Path, console: Console) -> Raw:
    """Read a mesh of any size once; the memory is that of a piece."""
    source_input = Input(name)
    head = source_input.peek(_HEAD)
    kind = kind_of(source_input, file_format)
    if not head:
        raise FormatError("the file is empty")
    # Text, and polygons in binary files, have rows of unknown sizes. Such files are read as a whole, which needs
    # memory, but is right for every file that the ordinary readers know.
    read = _READERS.get(kind, partial(_read_whole, kind or None))
    raw = Raw(folder)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    largest, files = 0, dict[str, BinaryIO]()
    with closing(source_input), console.progress("reading", until=0.1), ExitStack() as opened:
        for what, rows in read(source_input, raw):
            if not len(rows):
                continue
            piece = _checked(what, rows, raw.rows.get(what, 0))
            if what == "positions":
                low = np.minimum(low, piece.min(axis=0))
                high = np.maximum(high, piece.max(axis=0))
            elif what == "faces":
                largest = max(largest, int(piece[:, :3].max()))
            if what not in files:
                files[what] = opened.enter_context(table_file(folder / what))
                # The order of bytes is fixed, so that processes on other machines of a cluster read the same numbers.
                raw.kinds[what] = piece.dtype.newbyteorder("<").str, piece.shape[1]
            number_type, columns = raw.kinds[what]
            if columns != piece.shape[1]:
                raise MeshError(
                    f"from {what} {raw.rows[what]} on, they have {piece.shape[1]} numbers each, not as before"
                )
            with by_its_own_name(folder / what):
                files[what].write(np.ascontiguousarray(piece, number_type).data)
                files[what].flush()
            raw.rows[what] = raw.rows.get(what, 0) + len(piece)
    vertices = raw.rows["positions"]
    if not raw.rows["faces"]:
        raise MeshError("the mesh has no faces; point clouds are not supported")
    if largest >= vertices:
        raise MeshError(f"a face refers to vertex {largest}, outside 0..{vertices - 1}")
    for what in CARRIED:
        # An OBJ file may give some vertices a color and others none. Rows of a table are found by the number of the
        # vertex, so a gap would move the colors of all vertices after it.
        count = raw.rows.get(what, vertices)
        if count != vertices:
            raise MeshError(
                f"{count} of {vertices} vertices have a {what}: give all of them one, or none"
            )
    parent = None
    if not is_url(name) and name != "-":
        parent = Path(name).parent
    textures = _textures(raw, Beside(parent, DEFAULT_LIMITS))
    return replace(raw, low=tuple(low.tolist()), high=tuple(high.tolist()), textures=textures)


def _textures(raw: Raw, beside: Beside) -> int:
    """Write the picture of each material; return how many there are, or 0 without any image."""
    if raw.rows.get("texcoord", 0) <= 1:
        return 0
    names = {f"material.{number}.name": name for name, number in raw.materials.items()}
    contents, notes, lost = fetched(
        {**raw.metadata, **names, "mtllib": "\n".join(raw.libraries)}, beside.read
    )
    images, materials = images_in(contents), materials_in(contents)
    sound_images: dict[Any, bytes] = {}
    pictures: list[bytes] = []
    for number in raw.materials.values():
        words = materials[number]
        image = words.get("map_Kd", words.get("baseColorTexture"))
        if image in images and image not in sound_images:
            image_name, data = images[int(image)]
            sound_images[image] = data and checked(data, image_name)
        pictures.append(sound_images.get(image, b""))
    has_picture = any(pictures)
    if has_picture:
        for what in ("material", "mtllib", "image"):
            raw.left_out.pop(what, None)
    else:
        raw.leave_out("texcoord")
    raw.leave_out(*notes, *lost)
    if not has_picture:
        return 0
    # A material without an image gets a white picture: faces with and without textures can then share one atlas.
    for number, picture in enumerate(pictures):
        (raw.folder / f"texture.{number}").write_bytes(picture or _WHITE)
    return len(pictures)


def _checked(what: str, piece: Array, before: int) -> Array:
    """Rows as they are kept: positions as floats, colors as bytes or words."""
    floats = piece.dtype.kind == "f"
    if floats and not np.isfinite(piece).all():
        row = before + int(np.argmin(np.isfinite(piece).all(axis=1)))
        raise MeshError(
            f"vertex {row} has a {_WORDS[what]} that is not finite; remove or repair it"
        )
    if what == "positions":
        if floats and piece.dtype.itemsize == 4:
            return piece
        return piece.astype("<f8")
    if what in ("normal", "texcoord"):
        return piece.astype("<f4")
    if what == "color":
        # Tiles are encoded one by one, and each would find a range of its own for floats. Bytes mean the same in all of
        # them.
        if floats and piece.min() >= 0 and piece.max() <= 1:
            return np.asarray(np.rint(piece * 255), "u1")
        if piece.dtype.kind != "u" or piece.dtype.itemsize > 2:
            raise MeshError(
                f"colors must be bytes, words, or floats from 0 to 1, not such {piece.dtype}"
            )
        return piece
    return _checked_faces(piece)


def _checked_faces(piece: Array) -> Array:
    if piece.dtype.kind not in "iu":
        raise MeshError(f"faces must be integers, not {piece.dtype}")
    if piece.min() < 0:
        raise MeshError(f"a face refers to vertex {piece.min()}, which does not exist")
    if piece.max() > _MOST_INDEX:
        raise LimitError(
            f"a face refers to vertex {piece.max()}; tiles are made of up to {_MOST_INDEX}"
        )
    return piece.astype("<u4")


_WORDS = {
    **{"positions": "coordinate", "color": "color", "normal": "normal", "faces": "corner"},
    "texcoord": "texture coordinate",
}


def _read_ply(source_input: Input, raw: Raw) -> Pieces:
    header = parse_header(source_input.peek(MOST_HEADER))
    lists = [
        c.name for element in header.elements for c in element.properties if c.length is not None
    ]
    if not header.order or not {*lists} <= {*_CORNERS}:  # text, or rows of different sizes
        # The position in a text file does not tell the number of the row, and lists of two elements could differ in
        # length.
        yield from _read_whole("ply", source_input, raw)
        return
    source_input.read(header.size)
    raw.keep_about(header.metadata)
    # Comments of unit, axis and provenance are read as metadata. All other lines are lost, and the user hears of it.
    for keyword, line in header.comments:
        if parse_remarks([line]).keys().isdisjoint(ABOUT):
            raw.leave_out(f"lines of {keyword}")
    for element in header.elements:
        if element.properties or element.name in ("vertex", "face"):
            yield from _rows_of(element, header.order, source_input, raw)


def _rows_of(element: Element, order: str, source_input: Input, raw: Raw) -> Pieces:
    """The tables of an element of a PLY file; the rows of others than vertices and faces are passed over."""
    kind = _row_of(element, order)
    names = kind.names or ()
    tables: dict[str, tuple[str, ...]] = {"positions": ("x", "y", "z")}
    if element.name == "vertex":
        for what, columns in CARRIED.items():
            if {*columns[:3]} <= {*names}:
                tables[what] = tuple(column for column in columns if column in names)
    taken_columns = {*_KNOWN, *chain.from_iterable(tables.values())}
    raw.leave_out(*(name for name in names if name not in taken_columns))
    for first in range(0, element.count, ROWS):
        size = min(ROWS, element.count - first) * kind.itemsize
        data = source_input.read(size)
        if len(data) < size:
            raise TruncatedError(
                f"the PLY file is cut short: from {element.name} {first} on all are missing"
            )
        rows = np.frombuffer(data, kind)
        if element.name == "vertex":
            for what, columns in tables.items():
                yield what, np.stack([rows[column] for column in columns], axis=1)
        elif element.name == "face":
            # The row type has room for three corners. A polygon would shift all bytes after it, and the rest would
            # be garbage.
            if (rows["length"] != 3).any():
                raise MeshError("the faces are not all triangles; triangulate polygons first")
            yield "faces", rows["corners"]


def _row_of(element: Element, order: str) -> np.dtype[Any]:
    """A row as it stands in the file; a list is one of three corners."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for column in element.properties:
        if column.length is None:
            fields.append((column.name, order + column.type))
        else:
            fields += [("length", order + column.length), ("corners", order + column.type, (3,))]
    names = {field[0] for field in fields}
    needed = {"vertex": {"x", "y", "z"}, "face": {"corners"}}.get(element.name, set())
    if needed - names or len(names) < len(fields):
        raise FormatError(
            f"the element {element.name} of the PLY file lacks a property, or has it twice"
        )
    return np.dtype(fields)


def _read_stl(source_input: Input, raw: Raw) -> Pieces:
    head = source_input.peek(_HEAD)
    # The word "solid" at the beginning does not prove that an STL file is text. The size does, where it is known.
    size = size_of(source_input.name) if source_input.is_file else None
    if is_text(head, size):
        yield from _read_whole("stl", source_input, raw)
        return
    count, note = binary_triangles(head, size)
    if note:
        raw.leave_out(note)
    source_input.read(HEAD)
    for first in range(0, count, ROWS):
        rows = min(ROWS, count - first)
        data = source_input.read(RECORD.itemsize * rows)
        if len(data) < RECORD.itemsize * rows:
            raise TruncatedError(
                f"the STL file is cut short: triangle {first} and those after it are missing"
            )
        records = np.frombuffer(data, RECORD)
        if records["attribute"].any():
            raw.leave_out("attribute")
        yield "positions", records["corners"].reshape(-1, 3)
        # STL repeats the corners of each triangle. They stay apart here; the lattice of the tiles joins equal places
        # later.
        yield "faces", np.arange(3 * first, 3 * (first + rows)).reshape(-1, 3)


def _read_obj(source_input: Input, raw: Raw) -> Pieces:
    rest = source_input.read(len(BOM_UTF8)).removeprefix(BOM_UTF8)
    # Row 0 stands for corners without texture coordinates, so that all rows of faces have the same number of columns.
    yield "texcoord", np.zeros((1, 2), np.float32)
    while data := source_input.read(_TEXT):
        text = rest + data
        end = text.rfind(b"\n")
        # The line goes on.
        while end > 0 and text[max(end - _TEXT_END, 0) : end].rstrip().endswith(b"\\"):
            end = text.rfind(b"\n", 0, end)
        if end < 0 and len(text) > _TEXT:
            raise FormatError("this is not an OBJ file: it has no lines")
        lines, rest = text[: end + 1], text[end + 1 :]
        yield from _of_obj(lines, raw)
        last_material = _USED.findall(lines)[-1:]
        rest = b"\n".join([*last_material, rest])
    yield from _of_obj(rest, raw)


def _of_obj(text: bytes, raw: Raw) -> Pieces:
    """The tables of some lines. Corners are followed by their rows of texture coordinates, and a material."""
    # Relative indices count back from the present end of the lists, so the reader must know how many rows came before.
    counts_before = (raw.rows["positions"], raw.rows["texcoord"] - 1, 0)
    piece = read_obj(text, DEFAULT_LIMITS, counts_before)
    raw.keep_about(piece.metadata)
    raw.libraries.update(dict.fromkeys(str(piece.metadata.get("mtllib", "")).split("\n")))
    columns = {column.name: column for column in piece.columns}
    attribute_names = {key.partition(".")[0] for key in piece.metadata if key not in ABOUT}
    lost = (columns.keys() | attribute_names) - {"color", "texcoord"}
    raw.leave_out(*sorted(lost), *piece.dropped)
    if (piece.sizes < 3).any():
        raise MeshError("a face has fewer than three corners")
    texcoord = columns["texcoord"]
    yield "positions", piece.positions
    yield "texcoord", texcoord.values[:, :2]
    if "color" in columns:
        yield "color", columns["color"].values
    if not len(piece.sizes):
        return
    points, corners = piece.positions, piece.corners
    if (piece.sizes != 3).any():
        used, corners = np.unique(piece.corners, return_inverse=True)
        # A triangle may use vertices of later pieces: it only needs their numbers. To cut a polygon, their places are
        # needed.
        later = used[(used < 0) | (used >= raw.rows["positions"])]
        if later.size:
            raise MeshError(f"a face refers to vertex {later[0]}, which comes later")
        points = raw.table("positions")[used]
    # The ordinary reader cuts polygons by the same function, so that `bsm tile` and `bsm encode` give the same
    # triangles.
    places, owner, crossing = triangulate(points, piece.sizes, corners)
    if crossing:
        raw.leave_out(CROSSING)
    names = names_in(piece.metadata, "material")
    numbers: list[int] = []
    for place in range(1 + max(names, default=0)):
        number = raw.materials.setdefault(names.get(place, ""), len(raw.materials))
        numbers.append(number)
    face_materials = np.zeros(len(places), np.int32)
    if "material" in columns:
        face_materials = columns["material"].values[owner]
    texcoord_rows = np.asarray(texcoord.indices)[places]
    rows = np.maximum(texcoord_rows + 1, 0)
    yield "faces", np.column_stack([piece.corners[places], rows, np.array(numbers)[face_materials]])


def _read_whole(kind: str | None, source_input: Input, raw: Raw) -> Pieces:
    """A file of any other format, in memory as a whole."""
    file = read_mesh(source_input, kind)
    mesh = file.mesh
    raw.metadata.update(mesh.metadata)
    raw.keep_about(mesh.metadata)
    attributes = {attribute.name: attribute for attribute in mesh.attributes}
    yield "positions", mesh.positions
    for what in CARRIED:
        if what in attributes and attributes[what].domain == "vertex":
            yield what, attributes.pop(what).values
    rows = np.zeros_like(mesh.faces)
    texcoord = attributes.pop("texcoord", None)
    if texcoord is not None:
        indices = mesh.faces if texcoord.indices is None else texcoord.indices
        rows = 1 + indices
        # First, that of corners without.
        yield "texcoord", np.pad(texcoord.values[:, :2], ((1, 0), (0, 0)))
    numbers = np.zeros(len(rows), np.int32)
    if "material" in attributes:
        numbers = attributes["material"].values[:, 0].astype(np.int32)
    for number in range(1 + int(numbers.max(initial=0))):
        raw.materials[str(number)] = number
    keys = {key.partition(".")[0] for key in mesh.metadata} - {*ABOUT}
    raw.leave_out(*attributes, *sorted(keys), *file.dropped)
    yield "faces", np.column_stack([mesh.faces, rows, numbers])


_READERS = {"ply": _read_ply, "stl": _read_stl, "obj": _read_obj}
