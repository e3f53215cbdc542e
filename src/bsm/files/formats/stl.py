"""STL: triangles without common vertices, binary or text."""

import re

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError, TruncatedError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import first_of, group_rows
from bsm.files.formats.metadata import Written, face_numbers, left_out
from bsm.files.formats.polygons import Column, Polygons
from bsm.files.room import Doubles, Rows, single_suffices

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_ATTRIBUTE = "attribute"
"""The number of 16 bits that a triangle has beside its corners; some programs keep colours in it."""


def read_stl(data: bytes, limits: Limits) -> Polygons:
    """Read a binary or a text STL; corners with exactly equal coordinates are one vertex, in order of appearance."""
    # Binary files may begin with "solid" too; their length tells.
    claimed = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
    binary = len(data) == 84 + 50 * claimed or not data.lstrip().startswith(b"solid")
    soup = _soup_binary(data) if binary else _soup_text(data)
    corners = group_rows(soup)
    first = first_of(corners)
    note = f"STL knows no vertices: {len(soup)} corners with equal coordinates were joined to {len(first)} vertices"
    records = np.frombuffer(data, _RECORD, len(soup) // 3, 84)["attribute"] if binary else np.zeros(0, np.uint16)
    columns = (Column(_ATTRIBUTE, records[:, None], "face"),) if records.any() else ()
    return Polygons(soup[first], np.full(len(soup) // 3, 3), corners.astype(np.int64), (note,), (), columns)


def _soup_binary(data: bytes) -> Doubles:
    if len(data) < 84:
        raise FormatError("this is not an STL file: it is shorter than the header of one")
    claimed = int.from_bytes(data[80:84], "little")
    if len(data) < 84 + 50 * claimed:
        raise TruncatedError(
            f"the STL file is cut short (or is not an STL file): {claimed} triangles need {84 + 50 * claimed} bytes"
        )
    with np.errstate(invalid="ignore"):  # what is not a number is refused later
        return np.frombuffer(data, _RECORD, claimed, 84)["corners"].reshape(-1, 3).astype(np.float64)


def _soup_text(data: bytes) -> Doubles:
    lines = re.findall(rb"^[ \t]*vertex[ \t]+([^\r\n]*)", data, re.MULTILINE | re.IGNORECASE)
    facets = len(re.findall(rb"^[ \t]*endfacet", data, re.MULTILINE | re.IGNORECASE))
    if len(lines) != 3 * facets or (not re.search(rb"endsolid", data, re.IGNORECASE)):
        raise TruncatedError(f"the STL file is cut short: {len(lines)} corners in {facets} finished triangles")
    return Rows(lines, "corner").columns(0, 3)


def write_stl(mesh: TriangleMesh, stem: str) -> Written:
    if not single_suffices(mesh.positions):
        raise MeshError("the coordinates need double precision, which STL does not have; write PLY, OBJ or OFF")
    triangles = np.zeros(len(mesh.faces), _RECORD)
    corners = mesh.positions[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    triangles["normal"] = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    triangles["corners"] = corners
    attribute = face_numbers(mesh, _ATTRIBUTE)
    if attribute is not None and attribute.values.dtype == np.uint16:
        triangles["attribute"] = attribute.values[:, 0]
    else:
        attribute = None
    data = bytes(80) + len(triangles).to_bytes(4, "little") + triangles.tobytes()
    return Written(data, left_out(mesh, [attribute], tuple(mesh.metadata)))
