"""A glTF document: its tree and its bytes, from and to files."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError
from bsm.files.motion.gltf import NONSENSE

Tree = dict[str, Any]

_MAGIC, _JSON, _BIN = b"glTF", 0x4E4F534A, 0x004E4942
_TYPES: dict[int, type[np.generic]] = {
    5120: np.int8,
    5121: np.uint8,
    5122: np.int16,
    5123: np.uint16,
    5125: np.uint32,
    5126: np.float32,
}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


@dataclass(frozen=True, eq=False)
class Document:
    """A document."""

    tree: Tree
    buffers: list[bytes]
    images: dict[int, bytes]

    def view(self, index: int) -> bytes:
        """The bytes of a bufferView."""
        view = self._entry("bufferViews", index)
        start, length = view.get("byteOffset", 0), view["byteLength"]
        data = self.buffers[view["buffer"]]
        if min(start, length) < 0 or start + length > len(data):
            raise FormatError(f"bufferView {index} ends behind its buffer")
        return data[start : start + length]

    def array(self, index: int) -> npt.NDArray[Any] | None:
        """The values of an accessor, shape (n, c), as they are stored; None if it is sparse or without bytes."""
        accessor = self._entry("accessors", index)
        if not is_plain(accessor):
            return None
        view = self._entry("bufferViews", accessor["bufferView"])
        if view.get("extensions"):
            return None
        kind, width = np.dtype(_TYPES[accessor["componentType"]]).newbyteorder("<"), _WIDTHS[accessor["type"]]
        count, stride, data = accessor["count"], _stride(accessor, view), self.view(accessor["bufferView"])
        start, end = span_of(accessor, view)
        if count < 1 or min(start, stride) < 0 or end > len(data):
            raise FormatError(f"accessor {index} is not inside of its bufferView")
        rows: npt.NDArray[Any] = np.ndarray((count, width), kind, data, start, (stride, kind.itemsize))
        return np.ascontiguousarray(rows)

    def claimed(self, index: int) -> int:
        """How many numbers an accessor says that it has."""
        accessor = self._entry("accessors", index)
        return int(accessor["count"]) * _WIDTHS.get(accessor["type"], 1)

    @property
    def received(self) -> int:
        """Bytes of all buffers."""
        return sum(map(len, self.buffers))

    def _entry(self, kind: str, index: int) -> Tree:
        try:
            entry: Tree = self.tree[kind][index]
        except (KeyError, IndexError) as error:
            raise FormatError(f"this glTF has no {kind}[{index}]") from error
        return entry


def _size(accessor: Tree) -> int:
    return np.dtype(_TYPES[accessor["componentType"]]).itemsize * _WIDTHS[accessor["type"]]


def _stride(accessor: Tree, view: Tree) -> int:
    stride: int = view.get("byteStride") or _size(accessor)
    return stride


def span_of(accessor: Tree, view: Tree) -> tuple[int, int]:
    """Where the bytes of an accessor begin and end in its bufferView."""
    start = accessor.get("byteOffset", 0)
    return start, start + _stride(accessor, view) * (accessor["count"] - 1) + _size(accessor)


def is_plain(accessor: Tree) -> bool:
    """Whether its numbers are bytes of a bufferView, and no others."""
    return "sparse" not in accessor and "bufferView" in accessor and accessor["type"] in _WIDTHS


def read_document(path: str) -> Document:
    """A document from a .glb, or from a .gltf and the files beside it."""
    data = Path(path).read_bytes()
    folder = Path(path).parent.resolve()
    try:
        return _document(data, folder)
    except (*NONSENSE, struct.error) as error:
        if isinstance(error, FormatError):
            raise
        raise FormatError(f"{path} is no glTF: {type(error).__name__}: {error}") from error


def _document(data: bytes, folder: Path) -> Document:
    chunk = b""
    if data.startswith(_MAGIC):
        chunks = dict(_chunks(data))
        data, chunk = chunks.get(_JSON, b""), chunks.get(_BIN, b"")
    tree: Tree = json.loads(data)
    tree["asset"]["version"]
    buffers = [
        _resource(buffer["uri"], folder) if "uri" in buffer else chunk if number == 0 else b""
        for number, buffer in enumerate(tree.get("buffers", []))
    ]
    images = {
        number: _resource(image["uri"], folder)
        for number, image in enumerate(tree.get("images", []))
        if "uri" in image and not _is_remote(image["uri"])
    }
    return Document(tree, buffers, images)


def _chunks(data: bytes) -> Iterator[tuple[int, bytes]]:
    at = 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        if at + 8 + length > len(data):
            raise ValueError("a chunk ends behind the file")
        yield kind, data[at + 8 : at + 8 + length]
        at += 8 + length + -length % 4


def _is_remote(uri: str) -> bool:
    return "://" in uri


def _resource(uri: str, folder: Path) -> bytes:
    """What a relative address beside the document names, or a data address holds."""
    if uri.startswith("data:"):
        return base64.b64decode(uri.partition(",")[2])
    path = (folder / unquote(uri)).resolve()
    if _is_remote(uri) or not path.is_relative_to(folder) or not path.is_file():
        raise FormatError(f"{uri} is no file beside the glTF")
    return path.read_bytes()


def glb(tree: Tree, data: bytes) -> bytes:
    """A .glb of a tree and the bytes of its first buffer."""
    text = json.dumps(tree, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    total = 12 + 8 + len(text) + 8 + len(data)
    head = struct.pack("<4sIIII", _MAGIC, 2, total, len(text), _JSON)
    return head + text + struct.pack("<II", len(data), _BIN) + data
