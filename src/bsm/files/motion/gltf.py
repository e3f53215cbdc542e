"""A glTF document, binary or not: its tree, its buffers, and the numbers in them, checked before they are used."""

from __future__ import annotations

import base64
import binascii
import json
import struct
import urllib.parse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError, LimitError, TruncatedError, UnsupportedError
from bsm.bitstream.limits import Limits
from bsm.files.pipes import Input

Array = npt.NDArray[Any]
Tree = dict[str, Any]
KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
MAGIC = b"glTF"
NONSENSE = (KeyError, TypeError, ValueError, IndexError, AttributeError, RecursionError, OverflowError)
"""What a tree that may hold anything anywhere leads to."""
PER_NUMBER = 48
"""Bytes that a number of an accessor takes while it is made into what a mesh has."""
_COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
MOST_NUMBERS = 1 << 27
"""In one accessor, and in all morph targets: those without a buffer are zeros, for which no byte pays."""


class Document:
    """A glTF as it was read."""

    def __init__(self, data: bytes, folder: Path | None = None) -> None:
        self._folder = folder
        self._received = len(data)
        text, self._binary = _chunks(data) if data.startswith(MAGIC) else (data, b"")
        try:
            tree = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise FormatError(f"this is no glTF: {error}") from error
        if not isinstance(tree, dict) or not isinstance(tree.get("asset"), dict):
            raise FormatError("this is no glTF: it says nothing of itself as an asset")
        self.tree: Tree = tree
        self._buffers: dict[int, bytes] = {}
        self._lists: dict[str, list[Tree]] = {}

    def require_plain(self) -> None:
        """Raise `UnsupportedError` if its meshes are compressed."""
        required = [name for name in _COMPRESSED if name in self.tree.get("extensionsRequired", [])]
        if required:
            raise UnsupportedError(
                f"the meshes are compressed with {required[0]}, which is not read here; "
                "take that out first, for instance with gltf-transform copy"
            )

    @property
    def received(self) -> int:
        """Bytes of the document, and of the buffers that were read so far."""
        return self._received + sum(map(len, self._buffers.values()))

    def items(self, name: str) -> list[Tree]:
        """A list of the tree; empty if there is none."""
        if name not in self._lists:
            found = self.tree.get(name, [])
            if not isinstance(found, list) or not all(isinstance(item, dict) for item in found):
                raise FormatError(f"the {name} of this glTF are no list of objects")
            self._lists[name] = found
        return self._lists[name]

    def item(self, name: str, index: object) -> Tree:
        """One of a list of the tree."""
        found = self.items(name)
        if not isinstance(index, int) or not 0 <= index < len(found):
            raise FormatError(f"this glTF refers to number {index!r} of {len(found)} {name}")
        return found[index]

    def view(self, index: object) -> tuple[bytes, int, int]:
        """The buffer, the beginning and the length of a buffer view."""
        view = self.item("bufferViews", index)
        data = self._buffer(view.get("buffer"))
        start, size = _count(view, "byteOffset"), _count(view, "byteLength")
        if start + size > len(data):
            raise TruncatedError(f"buffer view {index} of this glTF ends behind the {len(data)} bytes of its buffer")
        return data, start, size

    def bytes_of(self, index: object) -> bytes:
        """What a buffer view holds."""
        data, start, size = self.view(index)
        return data[start : start + size]

    def numbers(self, index: object, *, whole: bool = False) -> Array:
        """The numbers of an accessor, shape (count, width); normalized ones as floats unless `whole`."""
        accessor = self.item("accessors", index)
        kind, width = KINDS.get(accessor.get("componentType", 0)), WIDTHS.get(accessor.get("type", ""))
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
            found = self._strided(accessor, accessor["bufferView"], kind, count, width)
        else:
            found = np.zeros((count, width), kind)
        if sparse := accessor.get("sparse"):
            found = self._replaced(found, sparse, kind, width)
        if accessor.get("normalized") and not whole and found.dtype.kind in "iu":
            return np.maximum(found / np.iinfo(found.dtype).max, -1.0)
        return found

    def count(self, index: object) -> int:
        """How many values an accessor claims."""
        return _count(self.item("accessors", index), "count")

    def claimed(self, index: object) -> int:
        """How many numbers an accessor claims; those without a buffer are zeros, for which no byte pays."""
        return self.count(index) * WIDTHS.get(str(self.item("accessors", index).get("type")), 16)

    def primitives(self) -> Iterator[Tree]:
        """The primitives of all meshes."""
        for mesh in self.items("meshes"):
            yield from mesh["primitives"]

    def image(self, index: object) -> tuple[str, bytes]:
        """Name and bytes of an image."""
        image = self.item("images", index)
        if "bufferView" in image:
            return str(image.get("name", "")), self.bytes_of(image["bufferView"])
        uri = str(image.get("uri", ""))
        name = "" if uri.startswith("data:") else Path(urllib.parse.unquote(uri)).name
        return str(image.get("name") or name), self._behind(uri)

    def _strided(self, where: Tree, view: object, kind: str, count: int, width: int) -> Array:
        data, start, size = self.view(view)
        offset, item = _count(where, "byteOffset"), np.dtype(kind).itemsize * width
        stride = _count(self.item("bufferViews", view), "byteStride") or item
        if stride < item or (count and offset + stride * (count - 1) + item > size):
            raise TruncatedError(
                f"{count} values of {item} bytes do not fit into the {size} bytes of their buffer view"
            )
        raw = np.ndarray((count, width), kind, data, start + offset, (stride, np.dtype(kind).itemsize))
        return np.array(raw)

    def _replaced(self, found: Array, sparse: Tree, kind: str, width: int) -> Array:
        count = _count(sparse, "count")
        where, values = sparse["indices"], sparse["values"]
        places = self._strided(where, where["bufferView"], KINDS[where["componentType"]], count, 1)[:, 0]
        if len(places) and places.max() >= len(found):
            raise FormatError(f"a sparse accessor replaces value {places.max()} of {len(found)}")
        found[places] = self._strided(values, values["bufferView"], kind, count, width)
        return found

    def _buffer(self, index: object) -> bytes:
        buffer = self.item("buffers", index)
        assert isinstance(index, int)
        if index not in self._buffers:
            uri = buffer.get("uri")
            data = self._behind(str(uri)) if uri is not None else self._binary
            if len(data) < _count(buffer, "byteLength"):
                raise TruncatedError(
                    f"buffer {index} of this glTF should have {buffer['byteLength']} bytes, not {len(data)}"
                )
            self._buffers[index] = data
        return self._buffers[index]

    def _behind(self, uri: str) -> bytes:
        """The bytes of a data URI, or of a file beside the document."""
        if uri.startswith("data:"):
            try:
                return base64.b64decode(uri.partition(",")[2], validate=True)
            except (ValueError, binascii.Error) as error:
                raise FormatError(f"a data URI of this glTF makes no sense: {error}") from error
        if self._folder is None:
            raise FormatError(f"this glTF needs the file {uri} beside it, and did not come from a folder")
        path = Path(self._folder, urllib.parse.unquote(uri)).resolve()
        if not path.is_relative_to(self._folder.resolve()):
            raise FormatError(f"this glTF refers to {uri}, which is not in its folder")
        return Input(str(path)).read_all()


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    """The JSON and the binary chunk of a GLB."""
    if len(data) < 20:
        raise TruncatedError("a GLB begins with 20 bytes; this one ends before")
    _, version, length, size, kind = struct.unpack_from("<4sIIII", data)
    if version != 2 or kind != 0x4E4F534A:
        raise FormatError(f"this is no GLB of version 2 (version {version})")
    if len(data) < max(length, 20 + size):
        raise TruncatedError(f"this GLB should have {max(length, 20 + size)} bytes, not {len(data)}")
    start = 20 + size
    if len(data) < start + 8:
        return data[20:start], b""
    size, kind = struct.unpack_from("<II", data, start)
    binary = data[start + 8 : start + 8 + size] if kind == 0x004E4942 else b""
    return data[20:start], binary


def _count(where: Tree, name: str) -> int:
    value = where.get(name, 0)
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise FormatError(f"{name} of this glTF is {value!r}, not a number of bytes or values")
    return value


def open_document(path: str) -> Document:
    """The document in a file."""
    given = Input(path)
    document = Document(given.read_all(), Path(path).parent)
    document.require_plain()
    return document


def require_room_for_meshes(data: bytes, limits: Limits) -> None:
    """Count what the meshes of a glTF become, before anybody makes them."""
    document = Document(data)
    try:
        numbers, named = 0, set()
        for primitive in document.primitives():
            given = [*primitive["attributes"].values(), primitive.get("indices")]
            numbers += sum(document.claimed(index) for index in given if index is not None)
            numbers += sum(
                document.claimed(index) for target in primitive.get("targets", []) for index in target.values()
            )
            where = primitive["attributes"].get("POSITION")
            if where is not None and ("bufferView" in document.item("accessors", where) or primitive.get("extensions")):
                named.add(where)
        vertices = sum(document.count(index) for index in named)
    except NONSENSE as error:
        raise FormatError(f"this glTF makes no sense: {type(error).__name__}: {error}") from error
    beside = sum(_count(buffer, "byteLength") for buffer in document.items("buffers") if "uri" in buffer)
    limits.check("vertices", vertices)
    limits.check_memory(PER_NUMBER * numbers, vertices, len(data) + beside)
