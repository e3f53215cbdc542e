"""OBJ: lines of text, each with a keyword."""

import re
from collections import Counter
from itertools import chain
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from bsm import _core as _kernels
from bsm.bitstream.errors import FormatError, MeshError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Mask, distinct, sealed
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.conventions import shares_of
from bsm.files.formats import metadata as materials
from bsm.files.formats.appearance import Material, is_mtl, one_line, text_of, write_mtl
from bsm.files.formats.polygons import (
    PLURALS,
    Column,
    Polygons,
    color_column,
    compact,
    grouped,
    polygon_normals,
)
from bsm.files.parsing import (
    Doubles,
    EvenRows,
    Ints,
    Rows,
    as_integers,
    continued,
    point_row,
    require_counts,
    text_table,
)

STATES = {"material": "usemtl", "group": "g", "object": "o", "smoothing": "s"}
"""The value of a keyword for the faces after it, and the keyword."""
_OF_CORNERS: dict[bytes, Literal["texcoord", "normal"]] = {b"vt": "texcoord", b"vn": "normal"}
_NUMBERS = (b"v", b"vt", b"vn", b"f")
_KNOWN = {b"", b"mtllib", *_NUMBERS, *(keyword.encode() for keyword in STATES.values())}
_COLORS = 3  # numbers of a color that every reader takes; some count a fourth as a coordinate
_COUNTED = {"vertices": b"\nv ", "faces": b"\nf "}
_FEW = 8
_OF_EXPORTERS = re.compile(
    r"(?i)\W*(\d+ |object|group|mesh|material|vert|texture|normal|face|end|total|smooth|$)"
)
"""Comments amid the data that exporters write."""
_MOST_NAME = 1 << 10  # characters: a name is repeated wherever a group of faces begins
_MOST_NUMBERS = 3  # of a texture coordinate or a normal
_NOWHERE = _kernels.NO_REFERENCE  # the index of a corner without a texture coordinate or normal
# While lines are counted.
_NOTHING = (*3 * [((0, 0), np.float64)], *4 * [(0, np.int64)], *2 * [((0, 0), np.int64)])
_ENDS = (b"", b"\n")  # before the beginning of a line


def read_obj(
    data: bytes, limits: Limits, counts_before: tuple[int, int, int] | None = None
) -> Polygons:
    """Read an OBJ, or lines of one after some vertices, texture coordinates and normals: their corners, -1 for none,
    may refer to values elsewhere."""
    if b"\0" in data:
        raise FormatError("this is not an OBJ file: it holds binary data")
    # Before lines are objects.
    require_counts(limits, **{name: data.count(begin) for name, begin in _COUNTED.items()})
    text = continued(data)
    before = counts_before or (0, 0, 0)
    lines = _plain_lines(text, before) or _Lines(text, before)
    dropped: list[str] = []
    notes: list[str] = []
    unread = b", ".join(sorted(lines.keywords - _KNOWN)[:_FEW]).decode(errors="replace")
    if unread:
        dropped.append(f"lines that begin with {unread}")
    points, sizes = lines.rows(b"v", "vertex"), lines.sizes
    columns = _colors(points, dropped)
    if b"#MRGB " in data and re.search(rb"^#MRGB ", data, re.M):
        dropped.append("colors in comments (#MRGB)")
    positions, corners = points.columns(0, 3), lines.places(0)
    for which, (keyword, name) in enumerate(_OF_CORNERS.items(), 1):
        rows = lines.rows(keyword, name)
        if counts_before is not None and name == "texcoord":
            indices = lines.places(which)
            indices = np.where(indices == _NOWHERE, -1, indices)
            columns.append(Column(name, _texcoords(rows), "corner", name, indices))
        elif len(rows.counts):
            flat: tuple[Doubles, Ints, Ints] | None = None
            if name == "normal":
                flat = positions, sizes, corners
            column, note = _corner_column(rows, name, lines.places(which), flat)
            columns += column
            notes += note
    states, names, again = _states(lines)
    if again:
        notes.append(f"objects of one name became one: {', '.join(again)}")
    metadata: dict[str, materials.Value] = {**names}
    libraries = dict.fromkeys(text_of(library) for library in lines.values_of(b"mtllib"))
    if libraries:
        metadata["mtllib"] = "\n".join(libraries)
    metadata |= _comments(data, dropped)
    all_columns = (*columns, *states)
    return Polygons(
        sealed(positions), sizes, corners, tuple(notes), tuple(dropped), all_columns, metadata
    )


def _colors(points: Rows, dropped: list[str]) -> list[Column]:
    """Return the colors after the coordinates of vertices, if those are colors."""
    numbers = int(points.counts.min(initial=100))
    most = int(points.counts.max(initial=0))
    # A color is only taken for one if all vertices have it, with or without an opacity.
    if 6 <= numbers == most <= 7:
        return [color_column(points.columns(3, numbers - 3), "vertex")]
    has_more = points.counts > 3
    fourth = points.values[points.starts[has_more] + 3]
    # A fourth number alone is a weight.
    if most > 4 or (fourth != 1).any():
        dropped.append(f"numbers after the coordinates ({int(has_more.sum())} vertices have some)")
    return []


def _comments(data: bytes, dropped: list[str]) -> dict[str, materials.Value]:
    """Return what comments say: metadata of ours, and the text ahead of the first line of data."""
    if b"#" not in data:
        return {}
    begin = re.search(rb"^[ \t]*[^#\s]", data, re.M)
    body = len(data) if begin is None else begin.start()
    lines: list[str] = []
    ahead: list[str] = []
    later = 0
    # The sign first: a search for beginnings of lines looks at each of them.
    for sign in re.finditer(rb"#([^\r\n]*)", data):
        place = sign.start()
        if data[place - 1 : place] not in _ENDS:
            continue
        line = text_of(sign[1])
        lines.append(line)
        if not line or line.startswith(("meta ", "MRGB ")):
            continue
        if place < body:
            ahead.append(line)
        elif not _OF_EXPORTERS.match(line):
            later += 1
    # Asked only where there are other number signs: it takes as long as all else.
    if data.count(b"#") > len(lines):
        later += len(re.findall(rb"^[ \t]*(?:v[nt]?|f)[ \t][^\r\n#]*#", data, re.M))
    if later:
        dropped.append(f"comments amid the data ({later})")
    metadata: dict[str, materials.Value] = {}
    comment = "\n".join(ahead)
    if 0 < len(comment) < materials.MOST_TEXT:
        metadata["comment"] = comment
    return metadata | materials.parse_remarks(lines)


class _PlainLines:
    """The lines of a text that the kernel reads."""

    def __init__(self, text: bytes, counts: Ints, counts_before: Ints) -> None:
        *shapes, faces, corners, others, words, with_texcoords, with_normals = counts.tolist()
        positions, texcoords, normals = map(np.empty, zip(shapes[::2], shapes[1::2], strict=True))
        tables = positions, texcoords, normals
        self.sizes: Ints = np.empty(faces, np.int64)
        self._corners = corners
        places_of_texcoords = places_of_normals = np.empty(0, np.int64)
        if with_texcoords:
            places_of_texcoords = np.empty(corners, np.int64)
        if with_normals:
            places_of_normals = np.empty(corners, np.int64)
        self._places = np.empty(corners, np.int64), places_of_texcoords, places_of_normals
        lines, hard = np.empty((others, 3), np.int64), np.empty((words, 4), np.int64)
        arrays = (*tables, self.sizes, *self._places, lines, hard)
        _kernels.scan_obj(
            np.frombuffer(text, np.uint8), counts_before, True, np.empty_like(counts), arrays
        )
        for table, place, begin, end in hard.tolist():
            tables[table].reshape(-1)[place] = float(text[begin:end])
        self._rows = dict(zip((b"v", b"vt", b"vn"), tables, strict=True))
        self._others: dict[bytes, list[tuple[int, bytes]]] = {}
        for before, begin, end in lines.tolist():
            keyword, *rest = text[begin:end].split(None, 1)
            self._others.setdefault(keyword, []).append((before, b"".join(rest).strip()))
        self.keywords = {*self._others}

    def rows(self, keyword: bytes, what: str) -> Rows:
        return EvenRows(self._rows[keyword], what)

    def places(self, which: int) -> Ints:
        places = self._places[which]
        if len(places) != self._corners:
            return np.full(self._corners, _NOWHERE)
        return places

    def values_of(self, keyword: bytes) -> list[bytes]:
        return [name for _, name in self._others.get(keyword, ())]

    def before_faces(self, keyword: bytes) -> Ints:
        begins = [before for before, _ in self._others.get(keyword, ())]
        return np.cumsum(np.bincount(begins, minlength=len(self.sizes) + 1))[: len(self.sizes)]


def _plain_lines(text: bytes, counts_before: tuple[int, int, int]) -> _PlainLines | None:
    """Read the lines as nearly all programs write them; None: some need another reader, or an error in words."""
    counts = np.empty(_kernels.OBJ_COUNTS, np.int64)
    before = np.array(counts_before, np.int64)
    nothing: Any = tuple(np.empty(shape, kind) for shape, kind in _NOTHING)
    if _kernels.scan_obj(np.frombuffer(text, np.uint8), before, False, counts, nothing):
        return None
    return _PlainLines(text, counts, before)


class _Lines:
    """The lines of any text by their keywords; # begins a comment at the start of a line, and after numbers."""

    def __init__(self, text: bytes, counts_before: tuple[int, int, int]) -> None:
        self._counts_before = counts_before
        self._lines = text.splitlines()
        keywords = [(line.split(None, 1) or [b""])[0] for line in self._lines] or [b""]
        self.keywords = {word for word in set(keywords) if not word.startswith(b"#")}
        self._keywords = np.array(keywords, dtype="S8")
        self._commented = b"#" in text

        polygons = self.values_of(b"f")
        self.sizes: Ints = np.fromiter(
            (len(line.split()) for line in polygons), np.int64, len(polygons)
        )
        self._references = _References(polygons)
        if (self._references.of(0) == 0).any():
            raise MeshError("a face refers to vertex 0, but OBJ files count from 1")

    def _are(self, keyword: bytes) -> Mask:
        mask: Mask = self._keywords == keyword
        return mask

    def rows(self, keyword: bytes, what: str) -> Rows:
        """Return the numbers of the lines with a keyword."""
        return Rows(self.values_of(keyword), what)

    def places(self, which: int) -> Ints:
        """Return the indices of corners, from 0 on; a negative one counts back from the last line before the face."""
        present = (
            np.repeat(self.before_faces(_NUMBERS[which]), self.sizes) + self._counts_before[which]
        )
        written = self._references.of(which)
        indices = np.where(written > 0, written - 1, written + present)
        return np.where(written == 0, _NOWHERE, indices)

    def before_faces(self, keyword: bytes) -> Ints:
        """Return how many lines with a keyword are before each face."""
        return np.cumsum(self._are(keyword), dtype=np.int64)[self._are(b"f")]

    def values_of(self, keyword: bytes) -> list[bytes]:
        """Return the rest of each line with a keyword."""
        names = [
            b"".join(self._lines[i].split(None, 1)[1:])
            for i in np.flatnonzero(self._are(keyword)).tolist()
        ]
        if self._commented and keyword in _NUMBERS:
            return [line.partition(b"#")[0] for line in names]
        return [line.strip() for line in names]


class _References:
    """The corners of all faces, each written v, v/vt, v//vn or v/vt/vn."""

    def __init__(self, polygons: list[bytes]) -> None:
        joined = b" ".join(polygons)
        if re.search(rb"(?:^|\s)/", joined):
            raise MeshError("a face has a corner without a vertex")
        # Made rows of numbers all at once: splitting each corner in Python takes much longer than all else.
        corners = re.sub(rb"/(?=[/\s]|\Z)", b"/0", joined).split()  # 0: what is not there
        self._rows = Rows([corner.replace(b"/", b" ") for corner in corners], "corner")
        if self._rows.counts.max(initial=0) > 3:
            raise MeshError("a corner of a face has more than three numbers")
        self._numbers = as_integers(self._rows.values, "a vertex index")

    def of(self, which: int) -> Ints:
        has_number = self._rows.counts > which
        numbers = np.zeros(len(has_number), np.int64)
        numbers[has_number] = self._numbers[self._rows.starts[has_number] + which]
        return numbers


def _corner_column(
    table: Rows,
    name: Literal["texcoord", "normal"],
    indices: Ints,
    flat: tuple[Doubles, Ints, Ints] | None,
) -> tuple[list[Column], list[str]]:
    """Return the values of `vt` or `vn` lines, for the corners that have them."""
    missing = indices == _NOWHERE
    if missing.all():
        return [], []
    if name == "texcoord":
        values = _texcoords(table)
    else:
        values = table.columns(0, 3)
    notes: list[str] = []
    if missing.any():  # after all other values there are those of the faces, or zeros
        substitute = "zeros"
        more, owner = np.zeros((1, values.shape[1])), np.zeros(len(indices), np.int64)
        if flat is not None:
            substitute = "those of their faces"
            _, sizes, _ = flat
            more, owner = polygon_normals(*flat), np.repeat(np.arange(len(sizes)), sizes)
        indices = np.where(missing, len(values) + owner, indices)
        values = np.vstack([values, more])
        notes.append(
            f"corners without {PLURALS[name]} were given {substitute}: {int(missing.sum())}"
        )
    return [Column(name, compact(values), "corner", name, indices)], notes


def _texcoords(table: Rows) -> Doubles:
    """Lines of one to three numbers, those that are not there zero; the third only if it is of use."""
    table.require(1)
    values = np.zeros((len(table.counts), _MOST_NUMBERS))
    for place in range(_MOST_NUMBERS):
        has_number = table.counts > place
        values[has_number, place] = table.values[table.starts[has_number] + place]
    if not values[:, 2].any():
        values = values[:, :2]
    return values


def _states(lines: _Lines | _PlainLines) -> tuple[list[Column], dict[str, str], list[str]]:
    """Materials, groups, ... of the faces: numbers, their names as metadata, and names that several objects have."""
    columns: list[Column] = []
    metadata: dict[str, str] = {}
    again: list[str] = []
    for what, keyword in STATES.items():
        names = ["", *map(text_of, lines.values_of(keyword.encode()))]
        of_face = lines.before_faces(keyword.encode())
        column, group_names = grouped(what, names, of_face)
        columns += column
        metadata |= group_names
        if what == "object":
            counts = Counter(names[place] for place in distinct(of_face).tolist())
            again = [name for name, count in counts.items() if name and count > 1]
    return columns, metadata, again[:_FEW]


# ------------------------------------------------------------------------------------------------------------ writing


def write_obj(mesh: TriangleMesh, stem: str) -> materials.Written:
    """The OBJ of a mesh; beside it lie a library of its materials, and their images."""
    original, color = mesh, materials.first(mesh, "color", (3, 4), "vertex", "corner")
    if color is not None and color.domain == "corner":
        mesh = materials.split_at_seams(mesh, color)
        color = materials.first(mesh, "color", (3, 4), "vertex")
    texcoord = materials.first(mesh, "texcoord", (1, 2, 3), "vertex", "corner")
    normal = materials.first(mesh, "normal", (3,), "vertex", "corner")
    numbers = {what: materials.face_numbers(mesh, what) for what in STATES}
    names = {what: _names(mesh, what, attribute) for what, attribute in numbers.items()}
    library = materials.Library(mesh, stem)
    unsaid = [
        name for name in materials.unsaid(mesh.metadata, "MTL") if not is_mtl(name.split(".", 2)[2])
    ]
    described_materials = {n: m for n, m in library.materials.items() if m.keys() - {"name"}}
    mtl = write_mtl(described_materials, names["material"], library.images)
    libraries = str(mesh.metadata.get("mtllib", "")).split("\n")
    if mtl:
        library.beside[f"{stem}.mtl"] = mtl
        libraries = [f"{stem}.mtl"]
        library.written |= materials.described(library.materials).keys() - {*unsaid}
    group_metadata: dict[str, str] = {}
    for what in STATES:
        group_metadata |= {f"{what}.{number}.name": name for number, name in names[what].items()}
        if names[what]:
            library.written.add(f"{what}.names")
    library.written |= {*group_metadata, "mtllib"}
    lines: list[str] = []
    comment = mesh.metadata.get("comment")
    if isinstance(comment, str):
        lines = [one_line(line) for line in comment.split("\n")]
        library.written.add("comment")
    remarks, omitted = materials.remarks(mesh.metadata, library.written)
    parts = [f"# {line}\n" for line in (*lines, *remarks)]
    parts += [f"mtllib {one_line(name)}\n" for name in libraries if name]
    parts.append(_points(mesh, color))
    indices, corner = [mesh.faces], "{}"
    for keyword, attribute in (("vt", texcoord), ("vn", normal)):
        if attribute is not None:
            number = " {:.9g}"
            if attribute.values.dtype == np.float64:
                number = " {!r}"
            joined = materials.without_seams(attribute, mesh)  # VTK shades only these smoothly
            parts.append(
                text_table(f"{keyword}{number * attribute.components}\n", joined.values).decode()
            )
            corner_indices = mesh.faces if joined.indices is None else joined.indices
            indices.append(corner_indices)
            if keyword == "vn" and texcoord is None:
                corner += "/"
            corner += "/{}"
    columns = np.stack(indices, axis=2).reshape(len(mesh.faces), -1) + 1
    nothing = np.zeros(len(mesh.faces), np.int64)
    states: dict[str, npt.NDArray[Any]] = {}
    for what, attribute in numbers.items():
        if names[what]:
            states[what] = nothing
            if attribute is not None:
                states[what] = attribute.values[:, 0]
    order = _grouped(list(states.values()), len(mesh.faces))
    faces = map(f"f {corner} {corner} {corner}\n".format, *columns[order].T.tolist())
    before = np.full(len(mesh.faces), "", dtype=object)
    for what, values in states.items():
        ordered = values[order]
        changes = np.flatnonzero(np.diff(ordered, prepend=ordered[0] - 1))
        before[changes] += [
            f"{STATES[what]} {names[what][number]}\n" for number in ordered[changes].tolist()
        ]
    parts += chain.from_iterable(zip(before.tolist(), faces))
    renamed = [key for key, name in group_metadata.items() if mesh.metadata.get(key, name) != name]
    written_attributes = (color, texcoord, normal, *numbers.values())
    in_remarks = [word for word in unsaid if word not in omitted]
    lost = materials.left_out(original, written_attributes, (*omitted, *renamed), in_remarks)
    if color is not None and color.components > _COLORS:
        lost = (f"alpha of {color.name}", *lost)
    return materials.Written("".join(parts).encode(), lost, library.beside)


def _grouped(states: list[npt.NDArray[Any]], faces: int) -> Ints:
    """The order in which faces are written: grouped by their materials where these change for every few faces."""
    order = np.arange(faces)
    if not states:
        return order
    table = np.column_stack(states[::-1])
    kinds, inverse = np.unique(table, axis=0, return_inverse=True)
    of_face = inverse.reshape(-1)
    changes = np.count_nonzero(np.diff(of_face))
    # A line before every few faces makes a file much longer; where there are fewer, the order of faces is worth more.
    if changes >= len(kinds) and _FEW * changes > faces:
        return np.argsort(of_face, kind="stable")
    return order


def _names(mesh: TriangleMesh, what: str, attribute: Attribute | None) -> dict[int, str]:
    """Return the names of the materials (groups, ...) of the faces, by number; empty if none are known."""
    names = materials.names_in(mesh.metadata, what)
    used = [0] if attribute is None else np.unique(attribute.values).tolist()
    library_materials: dict[int, Material] = {}
    # A library may hold some of no face.
    if what == "material":
        library_materials = materials.materials_in(mesh.metadata)
    names_by_number = {number: names.get(number) for number in (*used, *library_materials)}
    if attribute is None and not library_materials and not any(names_by_number.values()):
        return {}
    unique_names: dict[int, str] = {}
    uses: dict[str, int] = {}
    for number, name in names_by_number.items():
        known_name = f"{what}_{number}" if name is None else name
        text = unique = one_line(known_name)[:_MOST_NAME]
        while unique in uses:
            uses[text] += 1
            unique = f"{text}_{uses[text]}"
        uses[unique] = 1
        unique_names[number] = unique
    return unique_names


def _points(mesh: TriangleMesh, color: Attribute | None) -> str:
    row, table = point_row("v ", mesh.positions), mesh.positions
    if color is not None:
        # Six digits: bytes and even words of 16 bits come back from shares with as many.
        row = row.replace("\n", " {:.6g}" * _COLORS + "\n")
        table = np.hstack([table, shares_of(color.values[:, :_COLORS])])
    return text_table(row, table).decode()
