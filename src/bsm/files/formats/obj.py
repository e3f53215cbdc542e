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
from bsm.codec.arrays import Mask, sealed
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.conventions import shares_of
from bsm.files.formats import metadata as materials
from bsm.files.formats.appearance import is_mtl, one_line, text_of, write_mtl
from bsm.files.formats.polygons import PLURALS, Column, Polygons, color_column, compact, grouped, polygon_normals
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
_OF_EXPORTERS = re.compile(r"(?i)\W*(\d+ |object|group|mesh|material|vert|texture|normal|face|end|total|smooth|$)")
"""Comments amid the data that exporters write."""
_MOST_NAME = 1 << 10  # characters: a name is repeated wherever a group of faces begins
_MOST_NUMBERS = 3  # of a texture coordinate or a normal
_NOWHERE = _kernels.NO_REFERENCE  # the index of a corner without a texture coordinate or normal
_NOTHING = (*3 * [((0, 0), np.float64)], *4 * [(0, np.int64)], *2 * [((0, 0), np.int64)])  # while lines are counted
_ENDS = (b"", b"\n")  # before the beginning of a line


def read_obj(data: bytes, limits: Limits, counts_before: tuple[int, int, int] | None = None) -> Polygons:
    """Read an OBJ, or lines of one after `seen` vertices, texture coordinates and normals: their corners, -1 for none,
    may refer to values elsewhere."""
    if b"\0" in data:
        raise FormatError("this is not an OBJ file: it holds binary data")
    require_counts(limits, **{name: data.count(begin) for name, begin in _COUNTED.items()})  # before lines are objects
    text = continued(data)
    lines = _plain_lines(text, counts_before or (0, 0, 0)) or _Lines(text, counts_before or (0, 0, 0))
    points, sizes = lines.rows(b"v", "vertex"), lines.sizes
    numbers, most = int(points.counts.min(initial=100)), int(points.counts.max(initial=0))
    # A fourth number alone is a weight. A color is only taken for one if all vertices have it, with or without an
    # opacity.
    colored = 6 <= numbers == most <= 7
    columns = [color_column(points.columns(3, numbers - 3), "vertex")] if colored else []
    unread = b", ".join(sorted(lines.keywords - _KNOWN)[:_FEW]).decode(errors="replace")
    dropped = [f"lines that begin with {unread}"] if unread else []
    if most > 3 and not colored and (most > 4 or (points.values[(points.starts + 3)[points.counts > 3]] != 1).any()):
        dropped.append(f"numbers after the coordinates ({int((points.counts > 3).sum())} vertices have some)")
    dropped += ["colors in comments (#MRGB)"] if b"#MRGB " in data and re.search(rb"^#MRGB ", data, re.M) else []
    notes: list[str] = []
    positions, corners = points.columns(0, 3), lines.places(0)
    for which, (keyword, name) in enumerate(_OF_CORNERS.items(), 1):
        rows = lines.rows(keyword, name)
        if counts_before is not None and name == "texcoord":
            indices = lines.places(which)
            indices = np.where(indices == _NOWHERE, -1, indices)
            columns.append(Column(name, _texcoords(rows), "corner", name, indices))
        elif len(rows.counts):
            flat = (positions, sizes, corners) if name == "normal" else None
            column, note = _corner_column(rows, name, lines.places(which), flat)
            columns += column
            notes += note
    states, names, again = _states(lines)
    notes += [f"objects of one name became one: {', '.join(again)}"] if again else []
    metadata: dict[str, materials.Value] = {**names}
    libraries = dict.fromkeys(text_of(library) for library in lines.values_of(b"mtllib"))
    metadata |= {"mtllib": "\n".join(libraries)} if libraries else {}
    metadata |= _comments(data, dropped)
    all_columns = (*columns, *states)
    return Polygons(sealed(positions), sizes, corners, tuple(notes), tuple(dropped), all_columns, metadata)


def _comments(data: bytes, dropped: list[str]) -> dict[str, materials.Value]:
    """Return what comments say: metadata of ours, and the text ahead of the first line of data."""
    if b"#" not in data:
        return {}
    begin = re.search(rb"^[ \t]*[^#\s]", data, re.M)
    # The sign first: a search for beginnings of lines looks at each of them.
    signs = re.finditer(rb"#([^\r\n]*)", data)
    comments = (sign for sign in signs if data[sign.start() - 1 : sign.start()] in _ENDS)
    lines = [(entries.start(), text_of(entries[1])) for entries in comments]
    entries = materials.parse_remarks(line for _, line in lines)
    others = [(at, line) for at, line in lines if line and not line.startswith(("meta ", "MRGB "))]
    ahead = "\n".join(line for at, line in others if begin is None or at < begin.start())
    later = sum(at >= (begin.start() if begin else 0) and not _OF_EXPORTERS.match(line) for at, line in others)
    # Asked only where there are other number signs: it takes as long as all else.
    if data.count(b"#") > len(lines):
        later += len(re.findall(rb"^[ \t]*(?:v[nt]?|f)[ \t][^\r\n#]*#", data, re.M))
    dropped += [f"comments amid the data ({later})"] if later else []
    return {**({"comment": ahead} if 0 < len(ahead) < materials.MOST_TEXT else {}), **entries}


class _PlainLines:
    """The lines of a text that the kernel reads."""

    def __init__(self, text: bytes, counts: Ints, counts_before: Ints) -> None:
        points, point_numbers, texcoords, texcoord_numbers, normals, normal_numbers = counts[:6].tolist()
        faces, corners, others, words, with_texcoords, with_normals = counts[6:].tolist()
        tables = (
            np.empty((points, point_numbers)),
            np.empty((texcoords, texcoord_numbers)),
            np.empty((normals, normal_numbers)),
        )
        self.sizes: Ints = np.empty(faces, np.int64)
        point: Ints = np.empty(corners, np.int64)
        texcoord: Ints = np.empty(corners if with_texcoords else 0, np.int64)
        normal: Ints = np.empty(corners if with_normals else 0, np.int64)
        self._places = (point, texcoord, normal)
        lines, hard = np.empty((others, 3), np.int64), np.empty((words, 4), np.int64)
        arrays = (*tables, self.sizes, point, texcoord, normal, lines, hard)
        _kernels.scan_obj(np.frombuffer(text, np.uint8), counts_before, True, np.empty_like(counts), arrays)
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
        return places if len(places) == len(self._places[0]) else np.full(len(self._places[0]), _NOWHERE)

    def values_of(self, keyword: bytes) -> list[bytes]:
        return [name for _, name in self._others.get(keyword, ())]

    def before_faces(self, keyword: bytes) -> Ints:
        begins = [before for before, _ in self._others.get(keyword, ())]
        return np.cumsum(np.bincount(begins, minlength=len(self.sizes) + 1))[: len(self.sizes)]


def _plain_lines(text: bytes, counts_before: tuple[int, int, int]) -> _PlainLines | None:
    """Read the lines as nearly all programs write them; None: some need another reader, or an error in words."""
    counts, before = np.empty(_kernels.OBJ_COUNTS, np.int64), np.array(counts_before, np.int64)
    nothing: Any = tuple(np.empty(shape, kind) for shape, kind in _NOTHING)
    if _kernels.scan_obj(np.frombuffer(text, np.uint8), before, False, counts, nothing):
        return None
    return _PlainLines(text, counts, before)


class _Lines:
    """The lines of any text by their keywords; # begins a comment at the start of a line, and after numbers."""

    def __init__(self, text: bytes, counts_before: tuple[int, int, int]) -> None:
        self._seen = counts_before
        self._lines = text.splitlines()
        keywords = [(line.split(None, 1) or [b""])[0] for line in self._lines] or [b""]
        self.keywords = {word for word in set(keywords) if not word.startswith(b"#")}
        self._keywords = np.array(keywords, dtype="S8")
        self._commented = b"#" in text

        polygons = self.values_of(b"f")
        self.sizes: Ints = np.fromiter((len(line.split()) for line in polygons), np.int64, len(polygons))
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
        present = np.repeat(self.before_faces(_NUMBERS[which]), self.sizes) + self._seen[which]
        written = self._references.of(which)
        return np.where(written > 0, written - 1, np.where(written < 0, written + present, _NOWHERE))

    def before_faces(self, keyword: bytes) -> Ints:
        """Return how many lines with a keyword are before each face."""
        return np.cumsum(self._are(keyword), dtype=np.int64)[self._are(b"f")]

    def values_of(self, keyword: bytes) -> list[bytes]:
        """Return the rest of each line with a keyword."""
        names = [b"".join(self._lines[i].split(None, 1)[1:]) for i in np.flatnonzero(self._are(keyword)).tolist()]
        numbers = self._commented and keyword in _NUMBERS
        return [line.partition(b"#")[0] for line in names] if numbers else [line.strip() for line in names]


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
        there = self._rows.counts > which
        numbers = np.zeros(len(there), np.int64)
        numbers[there] = self._numbers[self._rows.starts[there] + which]
        return numbers


def _corner_column(
    table: Rows, name: Literal["texcoord", "normal"], indices: Ints, flat: tuple[Doubles, Ints, Ints] | None
) -> tuple[list[Column], list[str]]:
    """Return the values of `vt` or `vn` lines, for the corners that have them."""
    present = indices != _NOWHERE
    if not present.any():
        return [], []
    values, notes = _texcoords(table) if name == "texcoord" else table.columns(0, 3), []
    if not present.all():  # after all other values there are those of the faces, or zeros
        more = np.zeros((1, values.shape[1])) if flat is None else polygon_normals(*flat)
        owner = 0 if flat is None else np.repeat(np.arange(len(flat[1])), flat[1])
        indices = np.where(present, indices, len(values) + owner)
        values = np.vstack([values, more])
        substitute = "zeros" if flat is None else "those of their faces"
        notes = [f"corners without {PLURALS[name]} were given {substitute}: {int((~present).sum())}"]
    return [Column(name, compact(values), "corner", name, indices)], notes


def _texcoords(table: Rows) -> Doubles:
    """Lines of one to three numbers, those that are not there zero; the third only if it is of use."""
    table.require(1)
    values = np.zeros((len(table.counts), _MOST_NUMBERS))
    for place in range(_MOST_NUMBERS):
        there = table.counts > place
        values[there, place] = table.values[table.starts[there] + place]
    return values if values[:, 2].any() else values[:, :2]


def _states(lines: _Lines | _PlainLines) -> tuple[list[Column], dict[str, str], list[str]]:
    """Materials, groups, ... of the faces: numbers, their names as metadata, and names that several objects have."""
    columns: list[Column] = []
    metadata: dict[str, str] = {}
    again = dict[str, None]()
    for what, keyword in STATES.items():
        names = ["", *map(text_of, lines.values_of(keyword.encode()))]
        of_face = lines.before_faces(keyword.encode())
        column, group_names = grouped(what, names, of_face)
        columns += column
        metadata |= group_names
        if what == "object":
            counts = Counter(names[place] for place in np.unique(of_face).tolist())
            again |= {name: None for name, count in counts.items() if name and count > 1}
    return columns, metadata, [*again][:_FEW]


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
    unsaid = [name for name in materials.unsaid(mesh.metadata, "MTL") if not is_mtl(name.split(".", 2)[2])]
    described_materials = {n: m for n, m in library.materials.items() if m.keys() - {"name"}}
    mtl = write_mtl(described_materials, names["material"], library.images)
    libraries = str(mesh.metadata.get("mtllib", "")).split("\n")
    if mtl:
        library.beside[f"{stem}.mtl"] = mtl
        libraries = [f"{stem}.mtl"]
        library.written |= {f"material.{n}.{word}" for n, m in library.materials.items() for word in m} - {*unsaid}
    library.written |= {f"{what}.{number}.name" for what in STATES for number in names[what]}
    library.written |= {f"{what}.names" for what in STATES if names[what]}
    comment = mesh.metadata.get("comment")
    free = comment.split("\n") if isinstance(comment, str) else []
    lines, omitted = materials.remarks(mesh.metadata, library.written | {"mtllib"} | ({"comment"} if free else set()))
    lines = [*(one_line(line) for line in free), *lines]
    parts = [*(f"# {line}\n" for line in lines)]
    parts += [f"mtllib {one_line(name)}\n" for name in libraries if name]
    parts.append(_points(mesh, color))
    indices = [mesh.faces]
    for keyword, attribute in (("vt", texcoord), ("vn", normal)):
        if attribute is not None:
            number = " {!r}" if attribute.values.dtype == np.float64 else " {:.9g}"
            joined = materials.without_seams(attribute, mesh)  # VTK shades only these smoothly
            rows, corners = joined.values, mesh.faces if joined.indices is None else joined.indices
            parts.append(text_table(f"{keyword}{number * attribute.components}\n", rows).decode())
            indices.append(corners)
    corner = "{}/{}/{}" if texcoord and normal else "{}//{}" if normal else "{}/{}" if texcoord else "{}"
    columns = np.stack(indices, axis=2).reshape(len(mesh.faces), -1) + 1
    nothing = np.zeros(len(mesh.faces), np.int64)
    states = {what: nothing if a is None else a.values[:, 0] for what, a in numbers.items() if names[what]}
    order = _grouped(list(states.values()), len(mesh.faces))
    faces = map(f"f {corner} {corner} {corner}\n".format, *columns[order].T.tolist())
    before = np.full(len(mesh.faces), "", dtype=object)
    for what, values in states.items():
        changes = np.flatnonzero(np.diff(values[order], prepend=values[order[0]] - 1))
        before[changes] += [f"{STATES[what]} {names[what][number]}\n" for number in values[order[changes]].tolist()]
    parts += chain.from_iterable(zip(before.tolist(), faces))
    attributes_held = (color, texcoord, normal, *numbers.values())
    group_metadata = {f"{what}.{number}.name": name for what in STATES for number, name in names[what].items()}
    renamed = [key for key, name in group_metadata.items() if mesh.metadata.get(key, name) != name]
    lost = materials.left_out(original, attributes_held, (*dict.fromkeys((*omitted, *unsaid)), *renamed))
    if color is not None and color.components > _COLORS:
        lost = (f"alpha of {color.name}", *lost)
    return materials.Written("".join(parts).encode(), lost, library.beside)


def _grouped(states: list[npt.NDArray[Any]], faces: int) -> Ints:
    """The order in which faces are written: grouped by their materials where these change for every few faces."""
    order = np.arange(faces)
    if states:
        table = np.column_stack(states[::-1])
        kinds, of_face = np.unique(table, axis=0, return_inverse=True)
        changes = np.count_nonzero(np.diff(of_face.reshape(-1)))
        # A line before every few faces makes a file much longer; where there are fewer, the order of faces is worth
        # more.
        if changes >= len(kinds) and _FEW * changes > faces:
            order = np.argsort(of_face.reshape(-1), kind="stable")
    return order


def _names(mesh: TriangleMesh, what: str, attribute: Attribute | None) -> dict[int, str]:
    """Return the names of the materials (groups, ...) of the faces, by number; empty if none are known."""
    names = materials.names_in(mesh.metadata, what)
    used = [0] if attribute is None else np.unique(attribute.values).tolist()
    has = materials.materials_in(mesh.metadata) if what == "material" else {}  # a library may hold some of no face
    names_by_number = {number: names.get(number) for number in (*used, *has)}
    if attribute is None and not any(names_by_number.values()) and not has:
        return {}
    unique_names: dict[int, str] = {}
    uses: dict[str, int] = {}
    for number, name in names_by_number.items():
        text = unique = one_line(str(f"{what}_{number}" if name is None else name))[:_MOST_NAME]
        while unique in uses:
            uses[text] += 1
            unique = f"{text}_{uses[text]}"
        uses[unique] = 1
        unique_names[number] = unique
    return unique_names


def _points(mesh: TriangleMesh, color: Attribute | None) -> str:
    row = point_row("v ", mesh.positions)
    if color is None:
        return text_table(row, mesh.positions).decode()
    # Six digits: bytes and even words of 16 bits come back from shares with as many.
    row = row.replace("\n", " {:.6g}" * _COLORS + "\n")
    return text_table(row, np.hstack([mesh.positions, shares_of(color.values[:, :_COLORS])])).decode()
