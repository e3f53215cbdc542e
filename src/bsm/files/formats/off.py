"""OFF: a line with the counts, then points, then faces, all as text."""

import re
from collections.abc import Sequence

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import Attribute, Semantic
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.metadata import (
    Written,
    first,
    left_out,
    parse_remarks,
    remarks,
    split_at_seams,
    unsaid,
)
from bsm.files.formats.polygons import Column, Polygons, color_column, compact
from bsm.files.parsing import (
    Doubles,
    Ints,
    Rows,
    point_row,
    require_counts,
    require_lines,
    text_table,
)

_OFF_HEADER = re.compile(
    rb"\s*(?P<extras>(?:ST|C|N)*)(?P<dimension>4?n?)OFF"
    rb"(?:(?P<binary>[ \t]+BINARY)|\s*(?P<vertices>\d{1,18})\s+(?P<faces>\d{1,18})(?:[ \t]+-?\d+)?[ \t]*(?:[\r\n]|\Z))"
)


def read_off(data: bytes, limits: Limits) -> Polygons:
    # Comments may stand anywhere, and lines are counted from the header on.
    text = re.sub(rb"#[^\n\r]*", b"", data)
    header = _OFF_HEADER.match(text)
    if header is None:
        raise FormatError(
            "this is not an OFF file: it does not begin with OFF and the numbers of vertices and faces"
        )
    if header["dimension"]:
        raise MeshError("the vertices of this OFF file are not three-dimensional")
    if header["binary"]:
        raise MeshError("binary OFF files are not supported; save it as text, or as PLY")
    vertices, faces = int(header["vertices"]), int(header["faces"])
    require_counts(limits, vertices=vertices, faces=faces)
    lines = [line for line in text[header.end() :].splitlines() if line.strip()]
    require_lines(len(lines), vertices + faces)
    points = Rows(lines[:vertices], "vertex")
    polygons = Rows(lines[vertices : vertices + faces], "face")
    sizes, corners = polygons.lists(0)
    columns, dropped = _vertex_columns(header["extras"], points, lines[:vertices])
    behind = polygons.counts - sizes - 1
    if (behind >= 3).all() and (behind == behind[:1]).all() and len(behind):
        first_behind = polygons.starts + sizes + 1
        colors = polygons.values[first_behind[:, None] + np.arange(min(int(behind[0]), 4))]
        columns.append(
            color_column(
                colors, "face", written_whole=_are_whole(colors, lines[vertices : vertices + faces])
            )
        )
    elif (behind > 0).any():
        dropped.append("colors of faces")  # numbers of a map of colors, or of some faces only
    metadata = parse_remarks(
        line.decode(errors="replace") for line in re.findall(rb"^#([^\r\n]*)", data, re.M)
    )
    return Polygons(
        points.columns(0, 3), sizes, corners, (), tuple(dropped), tuple(columns), metadata
    )


def _color_width(extras: bytes, points: Rows, place: int) -> int:
    """How many numbers a color has that begins at a place; normals and texture coordinates may follow it."""
    numbers = int(points.counts.min(initial=100)) - place
    if b"ST" in extras:
        numbers -= 2
    if b"NC" in extras:
        numbers -= 3
    if numbers >= 4:
        return 4
    return 3


def _vertex_columns(
    extras: bytes, points: Rows, lines: Sequence[bytes]
) -> tuple[list[Column], list[str]]:
    """Normals, colors and texture coordinates, in this order (NC: colors first, by MeshLab); and unknown letters."""
    columns: list[Column] = []
    place = 3
    kinds = [b"N", b"C"]
    if b"NC" in extras:
        kinds.reverse()
    for kind in kinds:
        if kind not in extras:
            continue
        if kind == b"N":
            normals = compact(points.columns(place, 3))
            columns.append(Column("normal", normals, semantic="normal"))
            place += 3
            continue
        width = _color_width(extras, points, place)
        values = points.columns(place, width)
        words = [b" ".join(line.split()[place : place + width]) for line in lines]
        columns.append(color_column(values, "vertex", written_whole=_are_whole(values, words)))
        place += width
    if b"ST" in extras:
        texcoords = compact(points.columns(place, 2))
        columns.append(Column("texcoord", texcoords, semantic="texcoord"))
        place += 2
    if (points.counts > place).any():
        return columns, ["numbers after the coordinates"]
    return columns, []


def _are_whole(colors: Doubles, lines: Sequence[bytes]) -> bool:
    if colors.size == 0 or (colors != np.rint(colors)).any():
        return False
    if colors.max() > 1 or colors.shape[1] == 4:  # with an opacity of 1 they are shares
        return bool(colors.max() > 1)
    # A color "1 1 0" is yellow as shares and nearly black as bytes: only the point tells which is meant.
    return not any(b"." in b" ".join(line.split()[-colors.shape[1] :]) for line in lines)


def write_off(mesh: TriangleMesh, stem: str) -> Written:
    """The text OFF of a mesh: with normals, colors and texture coordinates of vertices, and colors of faces."""
    widths: dict[Semantic, tuple[int, ...]] = {"normal": (3,), "color": (3, 4), "texcoord": (2,)}
    original = mesh
    mesh = split_at_seams(
        mesh, *(first(mesh, kind, width, "vertex", "corner") for kind, width in widths.items())
    )
    normal, color, texcoord = (first(mesh, kind, width, "vertex") for kind, width in widths.items())
    of_faces = first(mesh, "color", (3, 4), "face")
    comments, omitted = remarks(mesh.metadata)
    keyword = ""
    for prefix, attribute in (("ST", texcoord), ("C", color), ("N", normal)):
        if attribute is not None:
            keyword += prefix
    keyword += "OFF"
    head = "".join([f"{keyword}\n", *(f"# {line}\n" for line in comments)])
    counts = f"{len(mesh.positions)} {len(mesh.faces)} 0\n"
    point, behind = _row([normal, color, texcoord])
    points = text_table(
        point_row("", mesh.positions)[:-1] + point, np.hstack([mesh.positions, *behind])
    )
    face, behind = _row([of_faces])
    columns = mesh.faces.T.tolist()
    for table in behind:
        columns += table.T.tolist()
    faces = "".join(map(("3 {} {} {}" + face).format, *columns))
    attributes_held = (normal, color, texcoord, of_faces)
    in_remarks = [word for word in unsaid(mesh.metadata, "OFF") if word not in omitted]
    lost = left_out(original, attributes_held, omitted, in_remarks)
    return Written((head + counts).encode() + points + faces.encode(), lost)


def _row(attributes: Sequence[Attribute | None]) -> tuple[str, list[Doubles | Ints]]:
    """Return the format of the numbers after the coordinates or indices, and their columns."""
    row = ""
    columns: list[Doubles | Ints] = []
    for attribute in filter(None, attributes):
        values = attribute.values
        if values.dtype == np.uint16:
            values = values / 65535
        if values.dtype.kind in "iu":
            number = " {:.0f}"
        elif values.dtype == np.float32:
            # "#" keeps the point in 1.0, by which readers tell shares from bytes.
            number = " {:#.9g}"
        else:
            number = " {!r}"
        row += number * attribute.components
        columns.append(values)
    return row + "\n", columns
