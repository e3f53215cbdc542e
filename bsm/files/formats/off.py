"""OFF: a line with the counts, then points, then faces, all as text."""

from __future__ import annotations

import re

from bitstream.errors import FormatError, MeshError
from bsm.files.formats.polygons import Polygons
from bsm.files.rows import Rows, point_row, require_lines, text_table, without_comments
from codec.geometry.mesh import TriangleMesh

_OFF_HEADER = re.compile(
    rb"\s*(?P<extras>(?:ST|C|N)*)(?P<dimension>4?n?)OFF(?P<binary>[ \t]+BINARY)?"
    rb"\s*(?P<vertices>\d{1,18})\s+(?P<faces>\d{1,18})(?:[ \t]+-?\d+)?[ \t]*(?:[\r\n]|\Z)"
)

_EXTRAS = {b"N": "normals", b"C": "colours", b"ST": "texture coordinates"}


def read_off(data: bytes) -> Polygons:
    """Read a text OFF."""
    text = without_comments(data)
    header = _OFF_HEADER.match(text)
    if header is None:
        raise FormatError("this is not an OFF file: it does not begin with OFF and the numbers of vertices and faces")
    if header["dimension"]:
        raise MeshError("the vertices of this OFF file are not three-dimensional")
    if header["binary"]:
        raise MeshError("binary OFF files are not supported; save it as text, or as PLY")
    vertices, faces = int(header["vertices"]), int(header["faces"])
    lines = [line for line in text[header.end() :].splitlines() if line.strip()]
    require_lines(len(lines), vertices + faces)
    points = Rows(lines[:vertices], "vertex")
    polygons = Rows(lines[vertices : vertices + faces], "face")
    sizes, corners = polygons.lists(0)
    dropped = {name: key in header["extras"] for key, name in _EXTRAS.items()}
    dropped["colours"] |= bool((polygons.counts > 1 + sizes).any())
    if not header["extras"] and (points.counts > 3).any():
        dropped["numbers behind the coordinates"] = True
    return Polygons(points.columns(0, 3), sizes, corners, dropped=tuple(name for name, held in dropped.items() if held))


def write_off(mesh: TriangleMesh) -> bytes:
    """The text OFF of a mesh."""
    header = f"OFF\n{len(mesh.positions)} {len(mesh.faces)} 0\n".encode()
    return header + text_table(point_row("", mesh.positions), mesh.positions) + text_table("3 {} {} {}\n", mesh.faces)
