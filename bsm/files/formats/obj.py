"""OBJ: lines of text, each with a keyword."""

from __future__ import annotations

import re

import numpy as np

from bitstream.errors import FormatError, MeshError
from bsm.files.formats.polygons import Polygons
from bsm.files.rows import Rows, as_integers, point_row, text_table, without_comments
from codec.geometry.mesh import TriangleMesh

_DROPPED = {
    b"vn": "normals",
    b"vt": "texture coordinates",
    b"us": "materials",
    b"g ": "groups",
    b"o ": "names of objects",
    b"l ": "lines",
    b"p ": "points",
}
"""What lines with other keywords hold, by the first two bytes."""


def read_obj(data: bytes) -> Polygons:
    """Read an OBJ: the lines `v` and `f`."""
    text = without_comments(data)
    if b"\0" in text:
        raise FormatError("this is not an OBJ file: it holds binary data")
    if b"\\" in text:
        text = re.sub(rb"\\[ \t]*\r?\n", b" ", text)
    lines = [line.strip() for line in text.splitlines()]
    kinds = np.array([line[:2] for line in lines] or [b""], dtype="S2")
    is_vertex, is_face = ((kinds == key + b" ") | (kinds == key + b"\t") for key in (b"v", b"f"))
    points = Rows([lines[i][1:] for i in np.flatnonzero(is_vertex)], "vertex")
    polygons = [lines[i][1:] for i in np.flatnonzero(is_face)]
    sizes = np.fromiter((len(line.split()) for line in polygons), np.int64, len(polygons))
    # A corner is written v, v/vt, v//vn or v/vt/vn; only v matters.
    items = Rows([re.sub(rb"/\S*", b"", line) for line in polygons], "face")
    if not np.array_equal(items.counts, sizes):
        raise MeshError("a face has a corner without a vertex")
    indices = as_integers(items.values, "a vertex index")
    if (indices == 0).any():
        raise MeshError("a face refers to vertex 0, but OBJ files count from 1")
    # A negative index counts back from the last vertex before the face.
    seen = np.repeat(np.cumsum(is_vertex)[is_face], sizes)
    corners = np.where(indices > 0, indices - 1, indices + seen)
    present = set(np.unique(kinds).tolist())
    dropped = [name for key, name in _DROPPED.items() if key in present]
    if (points.counts >= 6).any():
        dropped.append("colours")
    return Polygons(points.columns(0, 3), sizes, corners, dropped=tuple(dropped))


def write_obj(mesh: TriangleMesh) -> bytes:
    """The lines `v` and `f` of a mesh."""
    return text_table(point_row("v ", mesh.positions), mesh.positions) + text_table("f {} {} {}\n", mesh.faces + 1)
