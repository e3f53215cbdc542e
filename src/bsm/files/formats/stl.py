"""STL: triangles without common vertices, binary or text."""

import re
from codecs import BOM_UTF8

import numpy as np

from bsm._core import GivenMesh
from bsm.bitstream.errors import FormatError, MeshError, TruncatedError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import sealed
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.geometry.welding import group_rows
from bsm.files.formats.appearance import text_of
from bsm.files.formats.metadata import Written, face_numbers, left_out, named
from bsm.files.formats.polygons import Column, Polygons
from bsm.files.parsing import NO_DOUBLES, Doubles, Rows, require_counts, single_suffices
from bsm.files.table import other_kind

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
HEAD = 84  # bytes before the first record, the last four of them the number of triangles
_ATTRIBUTE = "attribute"
"""The number of 16 bits that a triangle has beside its corners; some programs keep colors in it."""
_HEADER = "stl_header"
_UNKNOWN = (0, 0xFFFFFFFF)  # numbers of triangles by programs that did not know it yet


# The word "solid" at the beginning does not tell: several programs write it into the 80 bytes before binary records.
def is_text(head: bytes, size: int | None) -> bool:
    """Return whether an STL is text; binary files that begin with "solid" have zeros or the right size."""
    claimed = -1
    if len(head) >= HEAD:
        claimed = int.from_bytes(head[HEAD - 4 : HEAD], "little")
    if size == HEAD + RECORD.itemsize * claimed or b"\0" in head[:1024]:
        return False
    begins_so = head.removeprefix(BOM_UTF8).lstrip()[:5].lower() == b"solid"
    return (
        begins_so
        or re.search(rb"\b(facet\s+normal|outer\s+loop|vertex)\b", head, re.IGNORECASE) is not None
    )


def binary_triangles(head: bytes, size: int | None) -> tuple[int, str]:
    """Return the number of triangles of a binary STL, by its size where that is known, and a note if they disagree."""
    if len(head) < HEAD:
        raise FormatError(
            f"this is not an STL file: it has {len(head)} bytes, and the header alone has {HEAD}"
        )
    claimed = int.from_bytes(head[HEAD - 4 : HEAD], "little")
    if size is None:
        return claimed, ""
    records, rest = divmod(size - HEAD, RECORD.itemsize)
    if records < claimed and claimed not in _UNKNOWN and (kind := other_kind(head, "stl")):
        raise FormatError(
            f"this is not an STL file: it is {kind}; give it the right name, or name its format"
        )
    if records < claimed and claimed not in _UNKNOWN:
        raise TruncatedError(
            f"the STL file is cut short (or is not one): it has {records} of {claimed} triangles"
        )
    if records == claimed or (claimed not in _UNKNOWN and rest):
        beyond = size - HEAD - RECORD.itemsize * claimed
        if not beyond:
            return claimed, ""
        return claimed, f"{beyond} bytes after the last triangle"
    return (
        records,
        f"the number of triangles in the header ({claimed}; by its size, the file has {records})",
    )


def read_stl(data: bytes, limits: Limits) -> Polygons:
    """Read a binary or a text STL; corners with exactly equal coordinates are one vertex, in order of appearance."""
    columns: list[Column] = []
    metadata: dict[str, str] = {}
    if is_text(data, len(data)):
        soup, columns, metadata, wrong = _of_text(data)
    else:
        count, wrong = binary_triangles(data, len(data))
        require_counts(limits, faces=count)
        records = np.frombuffer(data, RECORD, count, HEAD)
        with np.errstate(invalid="ignore"):  # a later check refuses NaN
            soup = records["corners"].reshape(-1, 3).astype(np.float64)
        header = data[: HEAD - 4].rstrip(b"\0 ")
        if header.strip(b"\0 "):
            key = _HEADER
            if header.startswith(b"bsm "):
                key = "provenance"
            metadata[key] = header.decode("latin-1")
        if records["attribute"].any():
            columns.append(Column(_ATTRIBUTE, records["attribute"][:, None], "face"))
    # Only exactly equal corners: a tolerance would close slits that somebody has drawn.
    faces = np.arange(len(soup), dtype=np.int32).reshape(-1, 3)
    corners, first, *_ = GivenMesh(faces, group_rows(soup)).join(True, True)
    note = f"STL knows no vertices: {len(soup)} corners with equal coordinates were joined to {len(first)} vertices"
    sizes = np.full(len(soup) // 3, 3)
    dropped = tuple(filter(None, [wrong]))
    return Polygons(
        sealed(soup[first]),
        sizes,
        corners.astype(np.int64),
        (note,),
        dropped,
        tuple(columns),
        metadata,
    )


def _of_text(data: bytes) -> tuple[Doubles, list[Column], dict[str, str], str]:
    """The corners of a text, its solids as groups, of which several may have the same name, and lines of no STL."""
    data = re.sub(
        rb"(?i)\bend[ \t]+(solid|facet|loop)\b", rb"end\1", re.sub(rb"\r\n?", b"\n", data)
    )
    # Lines of several words.
    if re.search(rb"(?i)\b(outer[ \t]+loop[ \t]+vertex|endloop[ \t]+endfacet)\b", data):
        data = re.sub(
            rb"(?i)(?<=[ \t])((?:end)?facet|outer|(?:end)?loop|vertex)(?=\s)", rb"\n\1", data
        )
    lines = re.findall(rb"^[ \t]*vertex[ \t]+([^\r\n]*)", data, re.MULTILINE | re.IGNORECASE)
    marks = re.finditer(
        rb"^[ \t]*(?:(endfacet)|solid\b([^\r\n]*))", data, re.MULTILINE | re.IGNORECASE
    )
    names: list[str] = []
    facets: list[int] = []
    for mark in marks:
        if mark[1]:
            facets.append(len(names))
        else:
            names.append(text_of(mark[2]))
    if len(lines) != 3 * len(facets) or not (
        facets or re.search(rb"endsolid", data, re.IGNORECASE)
    ):
        if (
            facets
            and len(lines) > 3 * len(facets)
            and re.search(rb"endfacet[^\n]*\s+endsolid[^\n]*\s*\Z", data, re.I)
        ):
            raise FormatError(
                f"{len(facets)} facets have {len(lines)} corners; cut them into triangles"
            )
        raise TruncatedError(
            f"the STL file is cut short: {len(lines)} corners in {len(facets)} finished triangles"
        )
    used, of_facet = np.unique(np.array(facets, np.int64), return_inverse=True)
    solid_names = [("", *names)[solid] for solid in used.tolist()]
    columns: list[Column] = []
    metadata: dict[str, str] = {}
    if len(used) > 1:
        columns.append(Column("group", of_facet.astype(np.int32), "face"))
    if any(solid_names):
        metadata = named(solid_names, "group")
    corners = Rows(lines, "corner").columns(0, 3)
    return corners, columns, metadata, _foreign_lines(data)


def _foreign_lines(data: bytes) -> str:
    """Say how the lines begin that no STL has; "" if there are none."""
    words = re.findall(
        rb"(?im)^[ \t]*(?!(?:(?:end)?(?:solid|facet|loop)|outer|vertex)\b)(\S+)", data
    )
    if not words:
        return ""
    distinct_words = sorted(set(map(text_of, words)))
    return f"lines that begin with {', '.join(distinct_words)}"[:200]


def write_stl(mesh: TriangleMesh, stem: str) -> Written:
    if not single_suffices(mesh.positions):
        raise MeshError(NO_DOUBLES.format("STL"))
    triangles = np.zeros(len(mesh.faces), RECORD)
    triangles["normal"] = face_normals(mesh.positions, mesh.faces)
    triangles["corners"] = mesh.positions[mesh.faces]
    color = face_numbers(mesh, _ATTRIBUTE)
    if color is not None and color.values.dtype != np.uint16:
        color = None
    if color is not None:
        triangles["attribute"] = color.values[:, 0]
    key = "provenance"
    if _HEADER in mesh.metadata:
        key = _HEADER
    header = str(mesh.metadata.get(key, "")).encode("latin-1", "replace")
    lost = [name for name in mesh.metadata if name != key]
    if len(header) >= HEAD - 3 or header.startswith(b"solid"):  # which would be a text
        header = b""
        lost = list(mesh.metadata)
    data = (
        header.ljust(HEAD - 4, b"\0") + len(triangles).to_bytes(4, "little") + triangles.tobytes()
    )
    return Written(data, left_out(mesh, [color], lost))
