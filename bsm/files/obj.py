"""OBJ: lines of text, each with a keyword."""

from __future__ import annotations

import re

import numpy as np

from bitstream.errors import FormatError, MeshError
from bsm.files.census import Census, Ints, Rows, as_integers, point_row, text_table, without_comments
from codec.geometry.mesh import TriangleMesh


def census_obj(data: bytes) -> Census:
    """Read an OBJ: the lines `v` and `f`; everything else (normals, textures, groups, lines) is left out."""
    text = without_comments(data)
    if b"\0" in text:
        raise FormatError("this is not an OBJ file: it holds binary data")
    continued = b"\\" in text
    if continued:
        text = re.sub(rb"\\[ \t]*\r?\n", b" ", text)
    lines = [line.strip() for line in text.splitlines()]
    kinds = np.array([line[:2] for line in lines] or [b""], dtype="S2")
    is_vertex, is_face = ((kinds == key + b" ") | (kinds == key + b"\t") for key in (b"v", b"f"))
    points = Rows([lines[i][1:] for i in np.flatnonzero(is_vertex)], "vertex")
    polygons = [lines[i][1:] for i in np.flatnonzero(is_face)]
    sizes = np.fromiter((len(line.split()) for line in polygons), np.int64, len(polygons))

    def corners() -> Ints:
        # A corner is written v, v/vt, v//vn or v/vt/vn; only v matters.
        items = Rows([re.sub(rb"/\S*", b"", line) for line in polygons], "face")
        if not np.array_equal(items.counts, sizes):
            raise MeshError("a face has a corner without a vertex")
        indices = as_integers(items.values, "a vertex index")
        if (indices == 0).any():
            raise MeshError("a face refers to vertex 0, but OBJ files count from 1")
        # A negative index counts back from the last vertex before the face.
        seen = np.repeat(np.cumsum(is_vertex)[is_face], items.counts)
        return np.where(indices > 0, indices - 1, indices + seen)

    return Census(points.columns(0, 3), sizes, corners, plain=not continued)


def write_obj(mesh: TriangleMesh) -> bytes:
    """The lines `v` and `f` of a mesh."""
    return text_table(point_row("v ", mesh.positions), mesh.positions) + text_table("f {} {} {}\n", mesh.faces + 1)
