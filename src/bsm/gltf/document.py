"""A glTF document, binary or not: its tree, its bytes, and the numbers in them, checked before they are used."""

import base64
import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError, FormatError, LimitError, TruncatedError, UnsupportedError
from bsm.bitstream.limits import Limits
from bsm.files.pipes import Input, file_beside
from bsm.files.room import require_count

Array = npt.NDArray[Any]
Tree = dict[str, Any]
KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
COMPONENTS = {np.dtype(kind).name: number for number, kind in KINDS.items()}
VECTORS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_WIDTHS = {**VECTORS, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_MAGIC, _JSON, _BINARY = b"glTF", 0x4E4F534A, 0x004E4942
EXTENSION, WEBP = "EXT_bsm_compression", "EXT_texture_webp"
PER_NUMBER = 48  # bytes that a number of an accessor takes while it is made into what a mesh has
PER_BLANK = 4  # bytes of a number of an accessor without a buffer, whatever uses it
MOST_NESTED = 1000
PER_PAIR = 20.0  # nanoseconds of trimesh, which looks through all nodes so far at each that it climbs
_COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
MOST_NUMBERS = 1 << 27
"""In one accessor, and in all morph targets: those without a buffer are zeros, for which no byte pays."""


@contextmanager
def as_format_error() -> Iterator[None]:
    """Make an error of ours of whatever a tree leads to that holds anything anywhere."""
    try:
        yield
    except BsmError:
        raise
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, RecursionError, OverflowError) as error:
        raise FormatError(f"this glTF makes no sense: {type(error).__name__}: {error}") from error


class Document:
    """A glTF as it was read; `folder` is where it lies."""

    def __init__(self, data: bytes, folder: Path | None = None) -> None:
        self._folder, self._own = folder, len(data)
        text, self._binary = _chunks(data) if data.startswith(_MAGIC) else (data, b"")
        try:
            tree = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise FormatError(f"this is no glTF: {error}") from error
        if not isinstance(tree, dict) or not isinstance(tree.get("asset"), dict):
            raise FormatError("this is no glTF: it says nothing of itself as an asset")
        self.tree: Tree = tree
        self._resources: dict[str, bytes] = {}

    def require_plain(self) -> None:
        """Raise `UnsupportedError` if its meshes are compressed."""
        required = [name for name in _COMPRESSED if name in self.tree.get("extensionsRequired", [])]
        if required:
            how = "take that out first, for instance with gltf-transform copy"
            raise UnsupportedError(f"the meshes are compressed with {required[0]}, which is not read here; {how}")

    @property
    def received(self) -> int:
        """Bytes of the document, and of what was read so far that lies beside it."""
        return self._own + sum(map(len, self._resources.values()))

    def items(self, name: str) -> list[Tree]:
        found = self.tree.get(name, [])
        if not isinstance(found, list) or not all(isinstance(item, dict) for item in found):
            raise FormatError(f"the {name} of this glTF are no list of objects")
        return found

    def item(self, name: str, index: object) -> Tree:
        found = self.tree.get(name, [])
        if not isinstance(found, list) or not isinstance(index, int) or not 0 <= index < len(found):
            raise FormatError(f"this glTF refers to number {index!r} of {len(self.items(name))} {name}")
        if not isinstance(entry := found[index], dict):
            raise FormatError(f"number {index} of the {name} of this glTF is no object")
        return entry

    def primitives(self) -> Iterator[Tree]:
        for mesh in self.items("meshes"):
            yield from mesh["primitives"]

    def buffer(self, index: object) -> bytes:
        buffer = self.item("buffers", index)
        data = self._behind(str(buffer["uri"])) if "uri" in buffer else self._binary if index == 0 else b""
        if len(data) < _count(buffer, "byteLength"):
            claimed = buffer["byteLength"]
            raise TruncatedError(f"buffer {index} of this glTF should have {claimed} bytes, not {len(data)}")
        return data

    def view(self, index: object) -> bytes:
        data, start, size = self._place(index)
        return data[start : start + size]

    def _place(self, index: object) -> tuple[bytes, int, int]:
        view = self.item("bufferViews", index)
        data = self.buffer(view.get("buffer"))
        start, size = _count(view, "byteOffset"), _count(view, "byteLength")
        if start + size > len(data):
            raise TruncatedError(f"bufferView {index} of this glTF ends behind the {len(data)} bytes of its buffer")
        return data, start, size

    def numbers(self, index: object, *, whole: bool = False) -> Array:
        accessor = self.item("accessors", index)
        kind, width = KINDS.get(accessor.get("componentType", 0)), _WIDTHS.get(accessor.get("type", ""))
        if kind is None or width is None:
            raise FormatError(f"accessor {index} of this glTF is of no type that is known")
        count = _count(accessor, "count")
        if count * width > MOST_NUMBERS:
            raise LimitError(f"accessor {index} of this glTF has {count} values; the limit is {MOST_NUMBERS} numbers")
        size = np.dtype(kind).itemsize
        # Columns of matrices begin at multiples of four bytes.
        rows = {"MAT2": 2, "MAT3": 3}.get(accessor["type"], 0) if size < 4 else 0
        if rows and rows * size % 4:
            raise UnsupportedError(f"accessor {index} of this glTF holds small matrices of small numbers")
        if "bufferView" in accessor:
            found = self._strided(accessor, kind, count, width)
        else:
            found = np.zeros((count, width), kind)
        if sparse := accessor.get("sparse"):
            self._replace(found, sparse, kind, width)
        if accessor.get("normalized") and not whole and found.dtype.kind in "iu":
            return np.maximum(found / np.iinfo(found.dtype).max, -1.0)
        return found

    def array(self, index: object) -> Array | None:
        """The values of an accessor, shape (n, c), as they are stored; None if it is sparse or without plain bytes."""
        accessor = self.item("accessors", index)
        if not is_plain(accessor) or self.item("bufferViews", accessor["bufferView"]).get("extensions"):
            return None
        if not self.count(index):
            raise FormatError(f"accessor {index} of this glTF is empty")
        found = self.numbers(index, whole=True)
        return found.astype(found.dtype.newbyteorder("="))

    def count(self, index: object) -> int:
        return _count(self.item("accessors", index), "count")

    def claimed(self, index: object) -> int:
        """How many numbers an accessor claims; those without a buffer are zeros, for which no byte pays."""
        return self.count(index) * _WIDTHS.get(str(self.item("accessors", index).get("type")), 16)

    def image(self, index: object) -> tuple[str, bytes]:
        image = self.item("images", index)
        if "bufferView" in image:
            return str(image.get("name", "")), self.view(image["bufferView"])
        uri = str(image.get("uri", ""))
        name = "" if uri.startswith("data:") else Path(unquote(uri)).name
        return str(image.get("name") or name), self._behind(uri)

    def _strided(self, where: Tree, kind: str, count: int, width: int) -> Array:
        data, start, size = self._place(where["bufferView"])
        offset, item = _count(where, "byteOffset"), np.dtype(kind).itemsize * width
        stride = _count(self.item("bufferViews", where["bufferView"]), "byteStride") or item
        if stride < item or (count and offset + stride * (count - 1) + item > size):
            raise TruncatedError(f"{count} values of {item} bytes do not fit into {size} bytes of their buffer view")
        return np.array(np.ndarray((count, width), kind, data, start + offset, (stride, np.dtype(kind).itemsize)))

    def _replace(self, found: Array, sparse: Tree, kind: str, width: int) -> None:
        count, where = _count(sparse, "count"), sparse["indices"]
        places = self._strided(where, KINDS[where["componentType"]], count, 1)[:, 0]
        if len(places) and places.max() >= len(found):
            raise FormatError(f"a sparse accessor replaces value {places.max()} of {len(found)}")
        found[places] = self._strided(sparse["values"], kind, count, width)

    def _behind(self, uri: str) -> bytes:
        """The bytes of a data URI, or of a file beside the document."""
        if uri in self._resources:
            return self._resources[uri]
        if uri.startswith("data:"):
            try:
                data = base64.b64decode(uri.partition(",")[2], validate=True)
            except ValueError as error:
                raise FormatError(f"a data URI of this glTF makes no sense: {error}") from error
        elif self._folder is None:
            raise FormatError(f"this glTF needs the file {uri[:80]} beside it, and did not come from a folder")
        else:
            data = Input(str(_file(uri, self._folder))).read_all()
        return self._resources.setdefault(uri, data)


def _file(uri: str, folder: Path) -> Path:
    """The regular file in the folder of a document, or below, that is meant."""
    try:
        return file_beside(folder, unquote(uri))
    except FormatError as error:
        raise FormatError(f"this glTF refers to {uri[:80]}, but {error}") from error


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    if len(data) < 20:
        raise TruncatedError("a GLB begins with 20 bytes; this one ends before")
    _, version, length, size, kind = struct.unpack_from("<4sIIII", data)
    if version != 2 or kind != _JSON:
        raise FormatError(f"this is no GLB of version 2 (version {version})")
    if len(data) < max(length, 20 + size):
        raise TruncatedError(f"this GLB should have {max(length, 20 + size)} bytes, not {len(data)}")
    start = 20 + size
    if len(data) < start + 8:
        return data[20:start], b""
    size, kind = struct.unpack_from("<II", data, start)
    return data[20:start], data[start + 8 : start + 8 + size] if kind == _BINARY else b""


def head_of_glb(tree: Tree, size: int) -> bytes:
    """What stands in a .glb before the `size` bytes of its first buffer, a multiple of four."""
    text = json.dumps(tree, separators=(",", ":"), ensure_ascii=False).encode(errors="replace")
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", _MAGIC, 2, 28 + len(text) + size, len(text), _JSON)
    return head + text + struct.pack("<II", size, _BINARY)


def glb(tree: Tree, data: bytes) -> bytes:
    data += b"\0" * (-len(data) % 4)
    return head_of_glb(tree, len(data)) + data


def bounds_of(values: Array) -> Tree:
    return {"min": values.min(axis=0).astype(float).tolist(), "max": values.max(axis=0).astype(float).tolist()}


def is_plain(accessor: Tree) -> bool:
    """Whether its numbers are bytes of a bufferView, and no others."""
    return "sparse" not in accessor and "bufferView" in accessor and accessor["type"] in VECTORS


def span_of(accessor: Tree, view: Tree) -> tuple[int, int]:
    """Where the bytes of an accessor begin and end in its bufferView."""
    size = np.dtype(KINDS[accessor["componentType"]]).itemsize * VECTORS[accessor["type"]]
    start = accessor.get("byteOffset", 0)
    return start, start + (view.get("byteStride") or size) * (accessor["count"] - 1) + size


def _count(where: Tree, name: str) -> int:
    value = where.get(name, 0)
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < 1 << 53:
        raise FormatError(f"{name} of this glTF is {repr(value)[:40]}, not a number of bytes or values")
    return value


def read_document(path: str) -> Document:
    return Document(Input(path).read_all(), Path(path).parent)


def require_room_for_meshes(data: bytes, limits: Limits, folder: Path | None = None) -> None:
    """Count what the meshes of a glTF become, before anybody makes them; its buffers must be files of its folder."""
    document = Document(data)
    uris = (str(buffer.get("uri", "data:")) for buffer in document.items("buffers") if folder)
    beside = sum(_file(uri, folder).stat().st_size for uri in uris if folder and not uri.startswith("data:"))
    with as_format_error():
        numbers, named = 0, set()
        for primitive in document.primitives():
            given = [*primitive["attributes"].values(), primitive.get("indices")]
            given += [index for target in primitive.get("targets", []) for index in target.values()]
            numbers += sum(document.claimed(index) for index in given if index is not None)
            where = primitive["attributes"].get("POSITION")
            if where is not None and ("bufferView" in document.item("accessors", where) or primitive.get("extensions")):
                named.add(where)
        # trimesh makes all accessors, used or not: those without a buffer are zeros.
        blank = sum(
            document.claimed(index)
            for index, accessor in enumerate(document.items("accessors"))
            if "bufferView" not in accessor
        )
        vertices = sum(document.count(index) for index in named)
        depths = _depths(document.items("nodes"))
        climbed = sum(depths[number] ** 2 for number, node in enumerate(document.items("nodes")) if "mesh" in node)
    if (deepest := max(depths.values(), default=0)) > MOST_NESTED:
        raise LimitError(f"the nodes of this glTF are nested {deepest} deep; the limit is {MOST_NESTED}")
    require_count("vertices", vertices, limits)
    limits.check_memory(PER_NUMBER * numbers + PER_BLANK * blank, vertices, len(data) + beside)
    limits.check_work(PER_PAIR * climbed, vertices, len(data) + beside)


def _depths(nodes: list[Tree]) -> dict[int, int]:
    """How many nodes each is below, itself included; a loop is climbed once."""
    parents = {child: number for number, node in enumerate(nodes) for child in node.get("children", [])}
    depths: dict[int, int] = {}
    for number in range(len(nodes)):
        path, at = [], number
        while at in range(len(nodes)) and at not in depths:
            depths[at] = 0
            path.append(at)
            at = parents.get(at, -1)
        depths.update((node, steps) for steps, node in enumerate(reversed(path), depths.get(at, 0) + 1))
    return depths
