"""OBJ: lines of text, each with a keyword."""

import re
from itertools import chain
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError, MeshError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Mask
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import first_of, group_rows
from bsm.files.formats import metadata as materials
from bsm.files.formats.polygons import PLURALS, Column, Polygons, color_column, compact
from bsm.files.room import Doubles, Ints, Rows, as_integers, point_row, text_table, without_comments

STATES = {"material": "usemtl", "group": "g", "object": "o", "smoothing": "s"}
"""What holds for all faces behind a keyword, and the keyword."""
_OF_CORNERS: dict[bytes, Literal["texcoord", "normal"]] = {b"vt": "texcoord", b"vn": "normal"}
_DROPPED = {b"l": "lines", b"p": "points", b"vp": "parameter space", b"curv": "curves", b"surf": "surfaces"}
_COLORS = 3  # numbers of a colour that every reader takes; some count a fourth as a coordinate
_FEW = 8
_MOST_NUMBERS = 3  # of a texture coordinate or a normal


def read_obj(data: bytes, limits: Limits) -> Polygons:
    """Read an OBJ: points and their colours, faces, texture coordinates, normals, materials and groups."""
    text = without_comments(data)
    if b"\0" in text:
        raise FormatError("this is not an OBJ file: it holds binary data")
    if b"\\" in text:
        text = re.sub(rb"\\[ \t]*\r?\n", b" ", text)
    lines = _Lines(text)
    points = Rows(lines.of(b"v"), "vertex")
    is_face = lines.are(b"f")
    polygons = lines.of(b"f")
    sizes = np.fromiter((len(line.split()) for line in polygons), np.int64, len(polygons))
    references = _References(polygons)
    before = np.flatnonzero(is_face)

    def placed(which: int, keyword: bytes) -> Ints:
        """Indices from 0 on; a negative one counts back from the last line before the face."""
        seen = np.repeat(np.cumsum(lines.are(keyword))[before], sizes)
        written = references.of(which)
        return np.where(written > 0, written - 1, written + seen)

    if (references.of(0) == 0).any():
        raise MeshError("a face refers to vertex 0, but OBJ files count from 1")
    numbers = points.counts.min(initial=100)
    colored = 6 <= numbers <= 7 and points.counts.max() == numbers
    columns = [color_column(points.columns(3, int(numbers) - 3), "vertex")] if colored else []
    notes: list[str] = []
    for which, (keyword, name) in enumerate(_OF_CORNERS.items(), 1):
        if rows := lines.of(keyword):
            column, note = _corner_column(rows, name, references.of(which), placed(which, keyword))
            columns += column
            notes += note
    states, names = _states(lines, is_face)
    metadata: dict[str, materials.Value] = {**names}
    metadata |= {"mtllib": library[0].strip().decode(errors="replace")} if (library := lines.of(b"mtllib")) else {}
    metadata |= materials.parse_remarks(
        comment.decode(errors="replace") for comment in re.findall(rb"^#([^\r\n]*)", data, re.M)
    )
    return Polygons(
        points.columns(0, 3),
        sizes,
        placed(0, b"v"),
        tuple(notes),
        tuple(name for key, name in _DROPPED.items() if lines.are(key).any()),
        (*columns, *states),
        metadata,
    )


class ObjPieces:
    """Points and faces of a text that comes in pieces of whole lines; nothing else of it."""

    def __init__(self) -> None:
        self._seen = 0
        self.left_out: set[str] = set()

    def take(self, text: bytes) -> tuple[Doubles, Doubles, Ints, Ints]:
        """Points, shape (k, 3), colours, if they have some, and of faces how many corners they have, and these."""
        lines = _Lines(without_comments(text))
        polygons, are_points = lines.of(b"f"), lines.are(b"v")
        sizes = np.fromiter((len(line.split()) for line in polygons), np.int64, len(polygons))
        self.left_out |= {name for keyword, name in _OF_CORNERS.items() if lines.are(keyword).any()}
        written = _References(polygons).of(0)[: int(sizes.sum())]
        if (written == 0).any():
            raise MeshError("a face refers to vertex 0, but OBJ files count from 1")
        seen = np.repeat(self._seen + np.cumsum(are_points)[np.flatnonzero(lines.are(b"f"))], sizes)
        self._seen += int(are_points.sum())
        points = Rows(lines.of(b"v"), "vertex")
        colored = len(points.counts) and 6 <= points.counts.min() == points.counts.max() <= 7
        colors = points.columns(3, 3) if colored else np.zeros((0, 3))
        return points.columns(0, 3), colors, sizes, np.where(written > 0, written - 1, written + seen)


class _Lines:
    def __init__(self, text: bytes) -> None:
        self._lines = text.splitlines()
        self._keywords = np.array([(line.split(None, 1) or [b""])[0] for line in self._lines] or [b""], dtype="S8")

    def are(self, keyword: bytes) -> Mask:
        found: Mask = self._keywords == keyword
        return found

    def of(self, keyword: bytes) -> list[bytes]:
        return [b"".join(self._lines[i].split(None, 1)[1:]) for i in np.flatnonzero(self.are(keyword)).tolist()]


class _References:
    """The corners of all faces, each written v, v/vt, v//vn or v/vt/vn."""

    def __init__(self, polygons: list[bytes]) -> None:
        joined = b" ".join(polygons)
        if re.search(rb"(?:^|\s)/", joined):
            raise MeshError("a face has a corner without a vertex")
        corners = re.sub(rb"/(?=[/\s]|\Z)", b"/0", joined).split()  # 0: what is not there
        slashes = np.fromiter((corner.count(b"/") for corner in corners), np.int64, len(corners))
        if slashes.max(initial=0) > 2:
            raise MeshError("a corner of a face has more than three numbers")
        numbers = Rows([corner.replace(b"/", b" ") for corner in corners], "face")
        self._numbers = as_integers(numbers.values, "a vertex index")
        self._starts, self._slashes = numbers.starts, slashes

    def of(self, which: int) -> Ints:
        last = max(len(self._numbers) - 1, 0)
        numbers = self._numbers if len(self._numbers) else np.zeros(1, np.int64)
        there = self._slashes >= which
        return np.where(there, numbers[np.where(there, self._starts + which, 0).clip(0, last)], 0)


def _corner_column(
    rows: list[bytes], name: Literal["texcoord", "normal"], written: Ints, indices: Ints
) -> tuple[list[Column], list[str]]:
    """What the lines `vt` or `vn` hold, for the corners that have them."""
    present = written != 0
    if not present.any():
        return [], []
    table = Rows(rows, name)
    values, notes = table.columns(0, 1 if name == "texcoord" else 3), []
    if name == "texcoord":  # of one to three numbers, those that are not there zero; the third only if it is of use
        values = np.zeros((len(table.counts), _MOST_NUMBERS))
        for place in range(_MOST_NUMBERS):
            there = table.counts > place
            values[there, place] = table.values[table.starts[there] + place]
        values = values if values[:, 2].any() else values[:, :2]
    if not present.all():
        # Corners without a value share one: zeros, behind all others.
        indices = np.where(present, indices, len(values))
        values = np.vstack([values, np.zeros((1, values.shape[1]))])
        notes = [f"corners without {PLURALS[name]} were given zeros: {int((~present).sum())}"]
    return [Column(name, compact(values), "corner", name, indices)], notes


def _states(lines: _Lines, is_face: Mask) -> tuple[list[Column], dict[str, str]]:
    """Materials, groups, objects and smoothing groups of the faces: numbers, and their names as metadata."""
    columns: list[Column] = []
    metadata: dict[str, str] = {}
    for what, keyword in STATES.items():
        names = ["", *(name.strip().decode(errors="replace") for name in lines.of(keyword.encode()))]
        changes, of_face = np.unique(np.cumsum(lines.are(keyword.encode()))[is_face], return_inverse=True)
        used = [names[i] for i in changes.tolist()]
        numbers = {name: number for number, name in enumerate(dict.fromkeys(used))}
        if len(numbers) > 1:
            of_change = np.array([numbers[name] for name in used], np.int32)
            columns.append(Column(what, of_change[of_face], "face"))
        if any(numbers):
            metadata |= materials.named(list(numbers), what)
    return columns, metadata


# ------------------------------------------------------------------------------------------------------------ writing


def write_obj(mesh: TriangleMesh, stem: str) -> materials.Written:
    """The OBJ of a mesh; beside it lie a library of its materials, and their images."""
    color = materials.first(mesh, "color", (3, 4), "vertex")
    texcoord = materials.first(mesh, "texcoord", (1, 2, 3), "vertex", "corner")
    normal = materials.first(mesh, "normal", (3,), "vertex", "corner")
    numbers = {what: materials.face_numbers(mesh, what) for what in STATES}
    names = {what: _names(mesh, what, attribute) for what, attribute in numbers.items()}
    library = materials.Library(mesh, stem)
    mtl = materials.write_mtl(
        {n: m for n, m in library.materials.items() if len(m) > 1}, names["material"], library.images
    )
    library_name = mesh.metadata.get("mtllib")
    if mtl:
        library.beside[f"{stem}.mtl"] = mtl
        library_name = f"{stem}.mtl"
        library.written |= {
            f"material.{n}.{key}" for n, m in library.materials.items() for key in materials.mtl_keywords(m)
        }
    library.written |= {f"{what}.{number}.name" for what in STATES for number in names[what]}
    library.written |= {f"{what}.names" for what in STATES if names[what]}
    lines, omitted = materials.remarks(mesh.metadata, library.written | {"mtllib"})
    parts = [*(f"# {line}\n" for line in lines)]
    parts += [f"mtllib {materials.one_line(str(library_name))}\n"] if library_name else []
    parts.append(_points(mesh, color))
    indices = [mesh.faces]
    for keyword, attribute in (("vt", texcoord), ("vn", normal)):
        if attribute is not None:
            number = " {!r}" if attribute.values.dtype == np.float64 else " {:.9g}"
            rows, corners = attribute.values, mesh.faces
            if attribute.indices is not None:  # seams part rows that are the same
                same = group_rows(rows.astype(np.float64).view(np.int64))
                first, corners = first_of(same), same[attribute.indices]
                by_vertex = np.zeros(len(mesh.positions), np.int64)
                by_vertex[mesh.faces] = corners
                if np.array_equal(by_vertex[mesh.faces], corners):  # without seams: VTK shades only these smoothly
                    first, corners = first[by_vertex], mesh.faces
                rows = rows[first]
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
    held = (color, texcoord, normal, *numbers.values())
    lost = materials.left_out(mesh, held, omitted)
    if color is not None and color.components > _COLORS:
        lost = (f"alpha of {color.name}", *lost)
    return materials.Written("".join(parts).encode(), lost, library.beside)


def _grouped(states: list[npt.NDArray[Any]], faces: int) -> Ints:
    """The order in which faces are written: their own, but grouped by their materials and so on where these change for
    every few faces, as no file has it."""
    order = np.arange(faces)
    if states:
        table = np.column_stack(states[::-1])
        kinds, of_face = np.unique(table, axis=0, return_inverse=True)
        changes = np.count_nonzero(np.diff(of_face.reshape(-1)))
        if changes >= len(kinds) and _FEW * changes > faces:
            order = np.argsort(of_face.reshape(-1), kind="stable")
    return order


def _names(mesh: TriangleMesh, what: str, attribute: Attribute | None) -> dict[int, str]:
    """What the materials (groups, ...) of the faces are called, by their numbers; nothing where none are known."""
    names = materials.names_in(mesh.metadata, what)
    used = [0] if attribute is None else np.unique(attribute.values).tolist()
    if what == "material":  # a library may hold some that no face has
        used = list(dict.fromkeys([*used, *materials.materials_in(mesh.metadata)]))
    known = {number: names.get(number) for number in used}
    spoken_of = (
        attribute is not None or any(known.values()) or (what == "material" and materials.materials_in(mesh.metadata))
    )
    if not spoken_of:
        return {}
    return {
        number: materials.one_line(str(f"{what}_{number}" if name is None else name)) for number, name in known.items()
    }


def _points(mesh: TriangleMesh, color: Attribute | None) -> str:
    row = point_row("v ", mesh.positions)
    if color is None:
        return text_table(row, mesh.positions).decode()
    most = np.iinfo(color.values.dtype).max if color.values.dtype.kind == "u" else 1
    row = row.replace("\n", " {:.6g}" * _COLORS + "\n")
    return text_table(row, np.hstack([mesh.positions, color.values[:, :_COLORS] / most])).decode()
