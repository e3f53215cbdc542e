"""VTP, VTK's XML of surfaces: polygons in one piece, with named values of points and cells, as ParaView shows them.

Arrays are text, base64, or bytes after the XML, compressed by zlib or not. Declared sizes are checked against the bytes
of the file and the limits before any array is allocated.
"""

import base64
import binascii
import re
import warnings
import zlib
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any
from xml.etree import ElementTree

import numpy as np

from bsm.bitstream.errors import CorruptError, FormatError, MeshError, TruncatedError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import Attribute, Domain, Semantic
from bsm.codec.geometry.mesh import Metadata, NoFacesError, TriangleMesh
from bsm.files.formats.metadata import (
    CALLED,
    COMPONENTS,
    Written,
    components_in_file,
    first,
    left_out,
    name_in_file,
    plain_fields,
    split_at_seams,
    unsaid,
    with_none,
)
from bsm.files.formats.polygons import (
    Array,
    Column,
    Part,
    Polygons,
    cut_strips,
    named_column,
    without_hidden,
)
from bsm.files.parsing import (
    AS_NUMBERS,
    TAG,
    Ints,
    require_counts,
    require_inflated,
    single_suffices,
)

_WHOLE = [
    (sign, kind, bits) for sign, kind in (("Int", "i"), ("UInt", "u")) for bits in (8, 16, 32, 64)
]
_TYPES = {f"{sign}{bits}": f"{kind}{bits // 8}" for sign, kind, bits in _WHOLE} | {
    "Float32": "f4",
    "Float64": "f8",
}
_NAMES = {kind: name for name, kind in _TYPES.items()}
_UNDERSCORE, _PADDED, _COUNT = (
    re.compile(rb"\s*_"),
    re.compile(rb"[^=]+={0,2}"),
    re.compile(r"\d{1,18}"),
)
_TAGS = ("VTKFile", "Piece", "PointData", "CellData")  # elements whose attributes are of use
_HEADS = {"UInt32": "u4", "UInt64": "u8"}
_ARRAYS, _MOST_ARRAYS = ("DataArray", "Array"), 1024
_COPIES = 3  # of the bytes of an array that are there at a time while numbers are made of it
_UNPRINTABLE = re.compile("[\x00-\x1f\x7f\ud800-\udfff\ufffe\uffff]")
_CELLS = ("Polys", "Strips")
_OTHERS = {"NumberOfVerts": "points", "NumberOfLines": "lines"}


class _Builder(ElementTree.TreeBuilder):
    """Builds the tree of a file without a DOCTYPE, which could multiply its text, in whatever encoding."""

    # Entities of a DOCTYPE may refer to each other, and ten lines of them become gigabytes.
    def doctype(self, *_: object) -> None:
        raise FormatError("a VTP file has no DOCTYPE")


def elements_of(text: bytes) -> list[ElementTree.Element]:
    try:
        parser = ElementTree.XMLParser(target=_Builder())
        parser.feed(text)
        return list(parser.close().iter())
    # The last two of strange encodings.
    except (ElementTree.ParseError, LookupError, ValueError) as error:
        raise FormatError(f"this is not a file of VTK: its XML is broken: {error}") from error


class _Document:
    """The arrays of a file with the elements that they are in, whose numbers take a limited memory, and its tags."""

    def __init__(self, text: bytes, appended: bytes, raw: bool, limits: Limits, size: int) -> None:
        elements = elements_of(text)
        self.arrays: list[tuple[str, ElementTree.Element]] = []
        for parent in elements:
            self.arrays += [(parent.tag, child) for child in parent if child.tag in _ARRAYS]
        self.tags = {
            element.tag: element.attrib for element in reversed(elements) if element.tag in _TAGS
        }
        if len(self.arrays) > _MOST_ARRAYS:
            raise FormatError(f"this VTP file has more than {_MOST_ARRAYS} arrays")
        if sum(element.tag == "Piece" for element in elements) > 1:
            raise MeshError("this VTP file has several pieces; save it as one")
        file = self.tags.get("VTKFile", {})
        self._order = "<"
        if file.get("byte_order") == "BigEndian":
            self._order = ">"
        head = _HEADS.get(file.get("header_type", "UInt32"))
        if head is None:
            raise FormatError(f"headers of blocks cannot be {file['header_type']}")
        self._head = np.dtype(self._order + head)
        self._compressor = file.get("compressor")
        self._appended, self._raw = appended, raw
        begins: set[int] = set()
        for _, array in self.arrays:
            offset = array.get("offset", "0")
            if _COUNT.fullmatch(offset):  # others may be of arrays that are not read
                begins.add(int(offset))
        # The file does not say where an array in base64 ends, but the next one begins there.
        self._ends = dict(pairwise([*sorted(begins), len(appended)]))
        self._limits, self._size, self._memory = limits, size, 0

    def numbers(self, array: ElementTree.Element) -> Array:
        """The numbers of an array, shape (k, c)."""
        kind = _TYPES.get(array.get("type", ""))
        if array.get("type") == "String":
            kind = "u1"
        if kind is None:
            raise MeshError(f"numbers cannot be {array.get('type')}")
        components = _count(array.attrib, "NumberOfComponents", 1)
        if array.get("format") == "ascii":
            values = self._of_text(array.text or "", np.dtype(kind))
        else:
            data = self._bytes(self._coded(array))
            if len(data) % np.dtype(kind).itemsize:
                raise CorruptError(f"{len(data)} bytes are not {array.get('type')} numbers")
            with np.errstate(invalid="ignore"):  # a later check refuses NaN
                values = np.frombuffer(data, self._order + kind).astype(kind)
        if components < 1 or len(values) % components:
            raise CorruptError(f"{len(values)} numbers are not rows of {components}")
        return values.reshape(-1, components)

    def _of_text(self, text: str, kind: np.dtype) -> Array:
        # A number and the space after it take two letters at least.
        self._require(AS_NUMBERS * (len(text) // 2))
        parsed_kind: Any = np.int64
        if kind.kind == "f":
            parsed_kind = np.float64
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                # Not float() of each word, which takes much longer. It only warns of words that are not numbers, so
                # warnings are errors.
                values = np.fromstring(text, parsed_kind, sep=" ")
            except (ValueError, DeprecationWarning) as error:
                raise MeshError(f"expected numbers: {error}") from error
        with np.errstate(over="ignore", invalid="ignore"):
            return values.astype(kind)

    def _coded(self, array: ElementTree.Element) -> bytes:
        """The header of an array and its numbers, base64 undone: headers may be coded apart from the numbers."""
        if array.get("format") == "appended":
            begin = _count(array.attrib, "offset", 0)
            encoded = self._appended[begin : self._ends[begin]]
            if self._raw:
                return encoded
        else:
            encoded = "".join((array.text or "").split()).encode("ascii", "replace")
        self._require(len(encoded))
        decoded = bytearray()
        try:
            # VTK codes a header and the blocks apart, so that "=" may stand in the middle, where base64.b64decode would
            # stop.
            for part in _PADDED.findall(encoded.split(b"<", 1)[0]):
                whole_groups = len(part) // 4 * 4
                decoded += base64.b64decode(part[:whole_groups])
        except binascii.Error as error:
            raise CorruptError(f"what should be base64 is not: {error}") from error
        return bytes(decoded)

    def _bytes(self, encoded: bytes) -> bytes:
        count = int(self._head_of(encoded, 1)[0])
        if not self._compressor:
            return self._taken(encoded, self._head.itemsize, count)
        if self._compressor != "vtkZLibDataCompressor":
            raise FormatError(
                f"{self._compressor} is not known here; save it with zlib, or uncompressed"
            )
        if count > len(encoded):
            raise TruncatedError("the blocks of an array are not there")
        head = self._head_of(encoded, 3 + count)
        _, size, _, *sizes = head.tolist()
        self._require(count * size)
        packed = self._taken(encoded, head.nbytes, sum(sizes))
        blocks: list[bytes] = []
        begin = 0
        for length in sizes:
            unpacker = zlib.decompressobj()
            try:
                # At most the size that the header says: a block of a few bytes may otherwise fill the memory.
                block = unpacker.decompress(packed[begin : begin + length], max(size, 1))
            except zlib.error as error:
                raise CorruptError(f"a compressed block is damaged: {error}") from error
            if not unpacker.eof:
                raise CorruptError("a compressed block becomes more than it says")
            blocks.append(block)
            begin += length
        return b"".join(blocks)

    def _head_of(self, encoded: bytes, count: int) -> Array:
        data = self._taken(encoded, 0, count * self._head.itemsize)
        return np.frombuffer(data, self._head)

    def _taken(self, encoded: bytes, begin: int, size: int) -> bytes:
        data = encoded[begin : begin + size]
        if len(data) < size:
            raise TruncatedError(f"an array should take {size} bytes, and {len(data)} are there")
        self._require(size)
        return data

    def _require(self, size: int) -> None:
        self._memory += _COPIES * size
        require_inflated(self._memory, self._size, self._limits)


def _count(attrs: dict[str, str], name: str, default: int) -> int:
    """A whole number among what an element says."""
    text = attrs.get(name, str(default))
    if not _COUNT.fullmatch(text):
        raise FormatError(f"{name} should be a number, not {text[:40]!r}")
    return int(text)


def read_vtp(data: bytes, limits: Limits) -> Polygons:
    document = _parse(data, limits)
    piece = document.tags.get("Piece")
    if document.tags.get("VTKFile", {}).get("type") != "PolyData" or piece is None:
        raise FormatError(
            "this VTK file holds no surface; extract one (ParaView's filter Extract Surface); "
            "if it is a list of blocks, call it .vtm"
        )
    points, polygons, strips = (
        _count(piece, f"NumberOf{what}", 0) for what in ("Points", "Polys", "Strips")
    )
    require_counts(limits, vertices=points, faces=polygons + strips)
    arrays: dict[tuple[str, str], ElementTree.Element] = {}
    fields: dict[str, ElementTree.Element] = {}
    for section, array in document.arrays:
        name = array.get("Name", "")
        key = ""
        if section in _CELLS:
            key = name
        arrays[section, key] = array
        if section == "FieldData":
            fields[name] = array
    if ("Points", "") not in arrays or not polygons + strips:
        raise NoFacesError("this VTP file has no faces; point clouds are not supported")
    coordinates = document.numbers(arrays["Points", ""])
    if coordinates.shape != (points, 3):
        raise CorruptError("this VTP file has not as many points as it says")
    sizes, flat = _cells(document, arrays, "Polys", polygons)
    strip_sizes, strip_corners = _cells(document, arrays, "Strips", strips)
    triangles, owner = cut_strips(strip_sizes, strip_corners)
    # Points and lines come first among cells.
    cells_before = _count(piece, "NumberOfVerts", 0) + _count(piece, "NumberOfLines", 0)
    cells = cells_before + np.append(np.arange(polygons), polygons + owner)
    columns, dropped = _columns(document, cells, cells_before + polygons + strips)
    metadata, omitted = plain_fields(
        {name: _field(document.numbers(array), array) for name, array in fields.items()}
    )
    others = [word for name, word in _OTHERS.items() if _count(piece, name, 0)]
    sizes = np.append(sizes, np.full(len(triangles), 3))
    flat = np.append(flat, triangles.ravel())
    with np.errstate(invalid="ignore"):  # as above
        positions = coordinates.astype(np.float64)
    losses = dict.fromkeys((*dropped, *omitted, *others))
    part = without_hidden(
        Part(positions, sizes, flat, columns, np.zeros(len(sizes), np.int64), ""), losses
    )
    return Polygons(
        positions, part.sizes, part.corners, (), tuple(losses), tuple(part.columns), metadata
    )


def _parse(data: bytes, limits: Limits) -> _Document:
    """Return the document of a file, and with it the bytes after the XML."""
    text, appended, is_raw = data, b"", False
    begin = data.find(b"<AppendedData")
    match = None
    if begin >= 0:
        end = data.find(b">", begin)
        if end >= 0:
            match = _UNDERSCORE.match(data, end + 1)
    # The bytes after the XML are not XML. The parser gets the part before them, closed by hand.
    if match is not None:
        text, appended = data[:begin] + b"</VTKFile>", data[match.end() :]
        is_raw = b"raw" in data[begin:end]
    require_inflated(8 * len(text) + 2 * TAG * text.count(b"<"), len(data), limits)
    return _Document(text, appended, is_raw, limits, len(data))


def _cells(
    document: _Document, arrays: Mapping[tuple[str, str], Any], around: str, count: int
) -> tuple[Ints, Ints]:
    """The sizes and the corners of polygons or strips."""
    if not count:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    if (around, "offsets") not in arrays or (around, "connectivity") not in arrays:
        raise CorruptError(f"this VTP file has not the {around} that it says")
    corners, ends = (document.numbers(arrays[around, name]) for name in ("connectivity", "offsets"))
    if len(ends) != count or {corners.dtype.kind, ends.dtype.kind} - {*"iu"}:
        raise CorruptError(f"this VTP file has not as many {around} as it says")
    stops: Ints = ends[:, 0].astype(np.int64)
    sizes: Ints = stops - np.concatenate([[0], stops[:-1]])
    if (sizes < 0).any() or (sizes > corners.size).any() or sizes.sum() != corners.size:
        raise CorruptError("the polygons of this VTP file do not begin where others end")
    return sizes, corners.reshape(-1).astype(np.int64)


def _columns(document: _Document, cells: Ints, count: int) -> tuple[list[Column], list[str]]:
    """Values of points and of polygons, each of which is one of the cells, and the names of others."""
    domains: dict[str, Domain] = {"PointData": "vertex", "CellData": "face"}
    columns, dropped = [], []
    for section, array in document.arrays:
        name = array.get("Name", "")
        if section not in domains:
            continue
        if array.get("type") not in _TYPES:
            dropped.append(name)
            continue
        values = document.numbers(array)
        if section == "CellData" and len(values) == count:
            values = values[cells]
        active = document.tags.get(section, {})
        meanings: dict[str | None, Semantic] = {
            active.get("TCoords"): "texcoord",
            active.get("Normals"): "normal",
        }
        components = [array.get(f"ComponentName{place}", "") for place in range(values.shape[1])]
        if len(components) == 1 or not all(components):
            components = []
        columns.append(named_column(name, values, domains[section], meanings.get(name), components))
    return columns, dropped


def _field(values: Array, array: ElementTree.Element) -> Array:
    """Numbers, or the text that they are the letters of, and the rest as another, since several are left out."""
    if array.get("type") != "String":
        return values
    text = values.tobytes().decode(errors="replace").removesuffix("\0")
    return np.array(text.split("\0", 1))


def _fields(metadata: Metadata) -> Iterator[tuple[str, str, Array]]:
    for name, value in metadata.items():
        if name.startswith((CALLED, COMPONENTS)):
            continue  # arrays have these names
        if isinstance(value, str):
            text = value.replace("\0", "").encode(errors="replace")
            yield name, "String", np.frombuffer(text + b"\0", np.uint8)
        elif isinstance(value, bytes):
            yield name, "UInt8", np.frombuffer(value, np.uint8)
        elif isinstance(value, int):
            yield name, "Int64", np.array([value], np.int64)
        else:
            yield name, "Float64", np.array([value], np.float64)


class _Appended:
    """The arrays that are written as bytes after the XML."""

    def __init__(self) -> None:
        self.blocks: list[bytes] = []
        self._size = 0

    def add(self, name: str, values: Array, kind: str = "", components: Sequence[str] = ()) -> str:
        """Return the element of an array: of a kind, a field of one value; else a row for each thing, with names."""
        data = np.ascontiguousarray(values.astype(values.dtype.newbyteorder("<"))).tobytes()
        tag, count, width = "DataArray", "Components", 1
        if kind == "String":
            tag = "Array"
        if kind:
            count = "Tuples"
        if values.ndim == 2:
            width = values.shape[1]
        names = "".join(
            f"ComponentName{place}={_quoted(word)} " for place, word in enumerate(components)
        )
        element = (
            f'<{tag} type="{kind or _NAMES[values.dtype.str[1:]]}" Name={_quoted(name)} {names}'
            f'NumberOf{count}="{width}" format="appended" offset="{self._size}"/>'
        )
        self.blocks += [len(data).to_bytes(8, "little"), data]
        self._size += 8 + len(data)
        return element

    def add_section(self, tag: str, mesh: TriangleMesh, domain: Domain) -> str:
        lines = [
            self.add(name, values, "", components)
            for name, values, components in _arrays(mesh, domain)
        ]
        return f"<{tag}{_active(mesh, domain)}>{''.join(lines)}</{tag}>\n"


def write_vtp(mesh: TriangleMesh, stem: str) -> Written:
    """Return the VTP of a mesh, with arrays as bytes after the XML; ParaView colors by the first number of vertices."""
    # VTK has values of points and of cells, and none of corners.
    mesh = split_at_seams(mesh, *mesh.attributes)
    kind: Any = np.float64
    if single_suffices(mesh.positions):
        kind = np.float32
    vertices, faces = len(mesh.positions), len(mesh.faces)
    appended = _Appended()
    fields = [
        appended.add(name, values, kind_of_field)
        for name, kind_of_field, values in _fields(mesh.metadata)
    ]
    point_data = appended.add_section("PointData", mesh, "vertex")
    cell_data = appended.add_section("CellData", mesh, "face")
    points = appended.add("Points", mesh.positions.astype(kind))
    corners = appended.add("connectivity", mesh.faces.reshape(-1).astype(np.int64))
    ends = appended.add("offsets", np.arange(3, 3 * faces + 1, 3, dtype=np.int64))
    text = (
        '<?xml version="1.0"?>\n'
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>\n'
        f"<FieldData>{''.join(fields)}</FieldData>\n"
        f'<Piece NumberOfPoints="{vertices}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" '
        f'NumberOfPolys="{faces}">\n{point_data}{cell_data}'
        f"<Points>{points}</Points>\n<Polys>{corners}{ends}</Polys>\n"
        '</Piece></PolyData>\n<AppendedData encoding="raw">_'
    )
    lost = left_out(mesh, mesh.attributes, (), unsaid(mesh.metadata, "VTP"))
    return Written(
        b"".join((text.encode(), *appended.blocks, b"</AppendedData></VTKFile>\n")), lost
    )


def _arrays(mesh: TriangleMesh, domain: Domain) -> Iterator[tuple[str, Array, list[str]]]:
    """The names, values and components of attributes, those together that were one array of many components."""
    values = with_none(attribute for attribute in mesh.attributes if attribute.domain == domain)
    attributes = {
        attribute.name: attribute for attribute in mesh.attributes if attribute.name in values
    }
    for key, words in mesh.metadata.items():
        if not key.startswith(COMPONENTS):
            continue
        name, components = key.removeprefix(COMPONENTS), str(words).split("\n")
        members = [f"{name}.{component}" for component in components]
        if name not in attributes and {*members} <= attributes.keys():
            for member in members:
                attributes.pop(member, None)
            yield name, np.hstack([values[member] for member in members]), components
    for attribute in attributes.values():
        components = components_in_file(mesh.metadata, attribute)
        yield name_in_file(mesh.metadata, attribute), values[attribute.name], components


def _quoted(name: str) -> str:
    from xml.sax.saxutils import quoteattr  # which takes with it all that speaks HTTP

    return quoteattr(_UNPRINTABLE.sub("_", name))


def _active(mesh: TriangleMesh, domain: Domain) -> str:
    """Return the attributes that viewers show, of all those of a domain."""
    shown: dict[str, Attribute | None] = {"Scalars": first(mesh, "generic", (1,), domain)}
    if domain == "vertex":
        shown["Normals"] = first(mesh, "normal", (3,), domain)
        shown["TCoords"] = first(mesh, "texcoord", (2,), domain)
    words: list[str] = []
    for tag, attribute in shown.items():
        if attribute is not None:
            words.append(f" {tag}={_quoted(name_in_file(mesh.metadata, attribute))}")
    return "".join(words)
