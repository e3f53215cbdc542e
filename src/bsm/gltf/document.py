"""A glTF document, binary or not: its tree, its bytes, and the numbers in them, checked before they are used."""

import base64
import io
import json
import re
import shutil
import struct
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import IO, Any
from urllib.parse import unquote, unquote_to_bytes

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError, LimitError, TruncatedError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.decoding import decode
from bsm.codec.geometry.welding import degenerate
from bsm.files.formats.metadata import kind_of_image
from bsm.files.formats.polygons import cut_strips
from bsm.files.images import side_of_image
from bsm.files.parsing import in_words, require_counts
from bsm.files.pipes import Input, file_beside, is_url
from bsm.files.unread import Said, Taken, rows_of
from bsm.gltf import coding
from bsm.gltf.coding import DRACO, EXTENSION, KINDS, MESHOPT, STRIP, TRIANGLES, Array, Tree

_MIMES = {kind: f"image/{kind}" for kind in ("png", "webp", "avif")}
_MIMES |= {"jpg": "image/jpeg", "ktx": "image/ktx2", "dds": "image/vnd-ms.dds"}
_WIDTHS = {"MAT2": 4, "MAT3": 9, "MAT4": 16, "SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_TYPES = {width: name for name, width in _WIDTHS.items()}  # vectors rather than matrices
# Rows of matrices whose columns are padded, if their numbers are small.
_PADDED = {"MAT2": 2, "MAT3": 3}
_MOST_BYTES = (1 << 32) - 1
_MAGIC, _JSON, _BINARY = b"glTF", 0x4E4F534A, 0x004E4942
WEBP = "EXT_texture_webp"
# A number becomes a double, with a copy or two on the way through a mesh.
PER_NUMBER = 48  # bytes that a number of an accessor takes while it is made into what a mesh has
# An accessor without a buffer claims any number of zeros in twenty bytes of JSON.
MOST_NUMBERS = 1 << 27
"""In one accessor, and in all morph targets: those without a buffer are zeros, for which no byte pays."""
_ROWS = rows_of("gltf")
"""In these a name may also have a kind: # a number, $ a text, [] a list, {} an object, with the kind or the number of
its items."""
_KINDS: Mapping[str, tuple[Any, str]] = {
    "{": (dict, "an object"), "[": (list, "a list"), "$": (str, "a text"), "#": (int | float, "a number"),
}  # fmt: skip
_SHAPE = {
    owner: dict(re.findall(r"(\w+)([#$\[{]\S*)", f"{words} {_ROWS['']}"))
    for owner, words in _ROWS.items()
}
_TAKEN = Taken({owner: re.sub(r"[#$\[{]\S*", "", words) for owner, words in _ROWS.items()})


class Document:
    """A glTF as it was read; `folder` is where it lies."""

    def __init__(
        self, data: bytes, folder: Path | None = None, limits: Limits = DEFAULT_LIMITS
    ) -> None:
        self._folder, self._own, self.limits = folder, len(data), limits
        text, self._binary = data, b""
        # By the first bytes and not by the name: files are often called .gltf and are binary, or the other way round.
        if data.startswith(_MAGIC):
            text, self._binary = _chunks(data)
        try:
            tree = json.loads(text)
        # Python's parser ends with a RecursionError at brackets that are nested a thousand deep.
        except (ValueError, RecursionError) as error:
            raise FormatError(f"not a glTF: {in_words(error)}") from error
        if not isinstance(tree, dict) or not isinstance(tree.get("asset"), dict):
            raise FormatError("not a glTF: it has no asset")
        version = str(tree["asset"].get("version", "2.0"))
        if not version.startswith("2"):
            raise FormatError(
                f"this is glTF {version[:20]}, and only glTF 2.0 is read; convert it first"
            )
        # Types are checked here, once and by a table, so that no reader below meets a list where it expects a number.
        self.unread = _TAKEN.unread_names(_said(tree, "{}", "", "glTF"))
        self.tree: Tree = tree
        self._resources: dict[str, bytes] = {}
        self._sides: dict[object, int] = {}
        # A stream holds many accessors and is decoded once. Its arrays are charged when they are made, not when they
        # are named.
        # Contents of compressed bufferViews, streams and primitives of Draco.
        self._unpacked: dict[object, Any] = {}
        self._charged = self._vertices = 0  # bytes of these, and vertices of streams and primitives

    # Memory may grow with the bytes that were really sent, files beside the document included.
    @property
    def received(self) -> int:
        """Bytes of the document, and of the external files read so far."""
        return self._own + sum(map(len, self._resources.values()))

    @property
    def compressed(self) -> list[str]:
        """The extensions by which geometry is compressed."""
        return [
            name
            for name in (EXTENSION, DRACO, *MESHOPT)
            if name in self.tree.get("extensionsUsed", [])
        ]

    @property
    def streams(self) -> list[int]:
        """The bufferViews that are streams."""
        return sorted({*self._streams_in("bufferViews"), *self._streams_in("meshes")})

    @property
    def moving(self) -> bytes | None:
        """The stream whose frames a mesh of the scene shows, None if there is none."""
        for stream in self._streams_in("meshes"):
            return self.view(stream)
        return None

    def _streams_in(self, name: str) -> Iterator[int]:
        """The streams that entries of the tree name."""
        for entry in self.items(name):
            extension = entry.get("extensions", {}).get(EXTENSION)
            if extension:
                yield int(extension["stream"])

    def items(self, name: str) -> list[Tree]:
        entries: list[Tree] = self.tree.get(name, [])
        return entries

    def item(self, name: str, index: object) -> Tree:
        entries = self.items(name)
        # Python takes -1 as the last item, which no glTF means.
        if not isinstance(index, int) or not 0 <= index < len(entries):
            raise FormatError(
                f"this glTF refers to number {json.dumps(index)} of {len(entries)} {name}"
            )
        return entries[index]

    def primitives(self) -> Iterator[Tree]:
        for mesh in self.items("meshes"):
            yield from mesh["primitives"]

    def buffer(self, index: object) -> bytes:
        buffer = self.item("buffers", index)
        data = b""
        if "uri" in buffer:
            data = self._resource(str(buffer["uri"]))
        elif index == 0:  # only the first buffer of a GLB is its binary chunk
            data = self._binary
        claimed = _count(buffer, "byteLength")
        if len(data) < claimed:
            raise TruncatedError(
                f"buffer {index} of this glTF should have {claimed} bytes, not {len(data)}"
            )
        return data

    def view(self, index: object) -> bytes:
        return bytes(self._viewed(index))

    def _viewed(self, index: object) -> memoryview:
        view = self.item("bufferViews", index)
        # An unknown extension that is not required may be passed over, as glTF says; a required one may have packed the
        # bytes.
        unread = self.unread_in(view) & {*self.tree.get("extensionsRequired", [])}
        if unread:
            raise UnsupportedError(
                f"bufferView {index} of this glTF is packed by {min(unread)}, which is not read"
            )
        extensions = view.get("extensions", {})
        if EXTENSION in extensions:
            return memoryview(self._array_of_stream(extensions[EXTENSION]))
        # The two names are one format: Khronos adopted it from the other.
        for name in MESHOPT:
            if name in extensions:
                return memoryview(self._from_meshopt(extensions[name]))
        return self._plain(view, index)

    def unread_in(self, entry: Tree) -> set[str]:
        """The extensions of a buffer or bufferView that are not known here."""
        return set(entry.get("extensions", {})) - {EXTENSION, *MESHOPT}

    def _array_of_stream(self, extension: Tree) -> bytes:
        """The bytes of a bufferView that is an array of a stream."""
        source = self.item("bufferViews", extension["stream"])
        name, component = str(extension["attribute"]), extension.get("componentType")
        # By place and not by number: two bufferViews may name the same stream.
        stream = source.get("buffer"), source.get("byteOffset", 0), source.get("byteLength")
        key = (*stream, name, component)
        if stream not in self._unpacked:
            mesh = decode(bytes(self._plain(source, extension["stream"])), limits=self.limits)
            self._charge(0, len(mesh.positions))
            self._unpacked[stream] = mesh, coding.drawn(mesh)
        if key not in self._unpacked:
            array: bytes = coding.array_of(self._unpacked[stream], name, component).tobytes()
            self._unpacked[key] = array
            self._charge(len(array))
        return bytes(self._unpacked[key])

    def _from_meshopt(self, extension: Tree) -> bytes:
        """The bytes of a bufferView that meshoptimizer has compressed."""
        data = self._plain(extension, "of meshopt")
        key = str(sorted(extension.items()))
        if key not in self._unpacked:
            # Before it is unpacked, and for three copies, which the library makes.
            self._charge(3 * _count(extension, "count") * _count(extension, "byteStride"))
            self._unpacked[key] = coding.unpack_meshopt(bytes(data), extension)
        return bytes(self._unpacked[key])

    def _charge(self, size: int, vertices: int = 0) -> None:
        """Raise `LimitError` if everything unpacked so far and this takes too much."""
        self._charged += size
        self._vertices += vertices
        require_counts(self.limits, vertices=self._vertices)
        self.limits.check_memory(self._charged, self._vertices, self.received)

    @cached_property
    def of_draco(self) -> dict[int, tuple[Tree, int]]:
        """Accessors that Draco holds: the extension of their primitive, and their number there; -1: the indices."""
        accessors: dict[int, tuple[Tree, int]] = {}
        for primitive in self.primitives():
            extension = primitive.get("extensions", {}).get(DRACO)
            if not extension:
                continue
            for name, number in extension["attributes"].items():
                accessors[primitive["attributes"][name]] = extension, int(number)
            if "indices" in primitive:
                accessors[primitive["indices"]] = extension, -1
        return accessors

    def _from_draco(self, index: int, kind: str, count: int, width: int) -> Array:
        extension, number = self.of_draco[index]
        key = (DRACO, extension["bufferView"])
        if key not in self._unpacked:
            unpacked = coding.unpack_draco(self.view(extension["bufferView"]))
            self._unpacked[key] = unpacked
            longest = max(map(len, unpacked.values()))
            self._charge(sum(table.nbytes for table in unpacked.values()), longest)
        values: Array = self._unpacked[key].get(number, np.zeros((0, 0)))
        # Accessors repeat what Draco holds. Where they disagree, one of them is damaged.
        if values.shape != (count, width) and not (number < 0 and values.shape[1] == width):
            raise FormatError(
                f"Draco holds {values.shape} numbers for accessor {index} of {count} values"
            )
        return values.astype(kind)

    def _plain(self, view: Tree, index: object) -> memoryview:
        data = self.buffer(view.get("buffer"))
        start, size = _count(view, "byteOffset"), _count(view, "byteLength")
        if start + size > len(data):
            raise TruncatedError(
                f"bufferView {index} of this glTF ends after the {len(data)} bytes of its buffer"
            )
        return memoryview(data)[start : start + size]

    def numbers(self, index: object, *, unscaled: bool = False) -> Array:
        accessor = self.item("accessors", index)
        form = accessor.get("type", "")
        kind, width = KINDS.get(accessor.get("componentType", 0)), _WIDTHS.get(form)
        if kind is None or width is None:
            raise FormatError(f"accessor {index} of this glTF is of no type that is known")
        count = _count(accessor, "count")
        if count * width > MOST_NUMBERS:
            raise LimitError(
                f"accessor {index} of this glTF has {count} values; the limit is {MOST_NUMBERS} numbers"
            )
        # Columns of matrices begin at multiples of four bytes. No mesh needs matrices with gaps between their columns,
        # so they are refused rather than read wrongly.
        if form in _PADDED and _PADDED[form] * np.dtype(kind).itemsize % 4:
            raise UnsupportedError(
                f"accessor {index} of this glTF holds small matrices of small numbers"
            )
        if "bufferView" in accessor:
            values = self._strided(accessor, kind, count, width)
        elif isinstance(index, int) and index in self.of_draco:
            values = self._from_draco(index, kind, count, width)
        else:
            values = np.zeros((count, width), kind)
        sparse = accessor.get("sparse")
        if sparse:
            self._replace(values, sparse, kind, width)
        if accessor.get("normalized") and not unscaled and values.dtype.kind in "iu":
            # Signed integers have one more value below zero, which glTF clamps.
            return np.maximum(values / np.iinfo(values.dtype).max, -1.0)
        return values

    def array(self, index: object) -> Array:
        """The values of an accessor, shape (n, c), as they are stored."""
        if not self.count(index):
            raise FormatError(f"accessor {index} of this glTF is empty")
        values = self.numbers(index, unscaled=True)
        return values.astype(values.dtype.newbyteorder("="))

    def count(self, index: object) -> int:
        return _count(self.item("accessors", index), "count")

    def claimed(self, index: object) -> int:
        """How many numbers an accessor claims; those without a buffer are zeros, for which no byte pays."""
        form = str(self.item("accessors", index).get("type"))
        return self.count(index) * _WIDTHS.get(form, 16)

    def why_absent(self, image: Tree) -> str:
        """Why the file of an image cannot be read: it lies at an address, or nowhere."""
        uri = str(image.get("uri", ""))
        if "bufferView" not in image and not uri.startswith("data:"):
            try:
                self.file(uri)
            except FormatError as error:
                if is_url(uri):
                    return "it lies at an address"
                return str(error)
        return ""

    def image(self, index: object) -> tuple[str, bytes | None]:
        """The name of an image, and its bytes where they are there."""
        image = self.item("images", index)
        uri = str(image.get("uri", ""))
        name = str(image.get("name") or "")
        if not name and not uri.startswith("data:"):
            name = Path(unquote(uri)).name
        if self.why_absent(image):
            return name, None
        if "bufferView" in image:
            return name, self.view(image["bufferView"])
        return name, self._resource(uri)

    def source_of(self, texture: object) -> int | None:
        """The image of a texture."""
        entry = self.item("textures", texture)
        for holder in (entry, *entry.get("extensions", {}).values()):
            if "source" in holder:
                source: int = holder["source"]
                return source
        return None

    def side_of_texture(self, index: object, usual: int) -> int:
        """The longer side of the image of a texture, in pixels."""
        if index not in self._sides:
            source = self.source_of(index)
            data = None
            if source is not None:
                _, data = self.image(source)
            self._sides[index] = side_of_image(data or b"") or usual
        return self._sides[index]

    def _strided(self, where: Tree, kind: str, count: int, width: int) -> Array:
        data = self._viewed(where["bufferView"])
        offset, size = _count(where, "byteOffset"), np.dtype(kind).itemsize
        item = size * width
        stride = _count(self.item("bufferViews", where["bufferView"]), "byteStride") or item
        # Checked as numbers before numpy sees them: ndarray with strides reads wherever it is told to.
        if stride < item or (count and offset + stride * (count - 1) + item > len(data)):
            raise TruncatedError(
                f"{count} values of {item} bytes do not fit into {len(data)} bytes of their view"
            )
        values: Array = np.ndarray((count, width), kind, data, offset, (stride, size))
        # Copied, so that a few rows of a large buffer do not keep all of it.
        return values.copy()

    def _replace(self, values: Array, sparse: Tree, kind: str, width: int) -> None:
        count, where = _count(sparse, "count"), sparse["indices"]
        places = self._strided(where, KINDS[where["componentType"]], count, 1)[:, 0]
        # The law wants them ascending; nothing here depends on that.
        if len(places) and places.max() >= len(values):
            raise FormatError(f"a sparse accessor replaces value {places.max()} of {len(values)}")
        values[places] = self._strided(sparse["values"], kind, count, width)

    def _resource(self, uri: str) -> bytes:
        """The bytes of a data URI, or of a file beside the document."""
        if uri not in self._resources and uri.startswith("data:"):
            self._resources[uri] = _data_of(uri)
        elif uri not in self._resources:
            self._resources[uri] = self._read(uri)
        return self._resources[uri]

    def _read(self, uri: str) -> bytes:
        try:
            return Input(str(self.file(uri))).read_all()
        except FormatError as error:
            raise FormatError(f"this glTF refers to {uri[:80]}, but {error}") from error

    @property
    def files(self) -> list[str]:
        """The files that the document refers to."""
        paths: list[str] = []
        for entry in (*self.items("buffers"), *self.items("images")):
            uri = str(entry.get("uri", "data:"))
            if not uri.startswith("data:"):
                with suppress(FormatError):
                    paths.append(str(self.file(uri)))
        return paths

    def file(self, uri: str) -> Path:
        """The regular file in the folder of the document, or below, that is meant."""
        if self._folder is None:
            raise FormatError("the mesh did not come from a file")
        # A uri may be any path, ../../etc/passwd as well. Only files in the folder of the document are opened.
        return file_beside(self._folder, unquote(uri))


def _data_of(uri: str) -> bytes:
    """The bytes in a data URI."""
    head, _, body = uri.partition(",")
    data = unquote_to_bytes(body)
    if not head.endswith(";base64"):
        return data
    try:
        # Without validation Python skips what is not base64, and damage would go unnoticed.
        return base64.b64decode(data, validate=True)
    except ValueError as error:
        raise FormatError(f"a data URI of this glTF makes no sense: {error}") from error


def _said(value: Any, kind: str, path: str, owner: str) -> Iterator[Said]:
    """The names in a value that must be of a kind, and in those of its objects that readers take."""
    (python_type, kind_name), inside = _KINDS[kind[0]], kind[1:-1]
    if not isinstance(value, python_type) or isinstance(value, bool):
        raise FormatError(
            f"in this glTF, {path[1:]} must be {kind_name}, not {json.dumps(value)[:40]}"
        )
    if inside.isdecimal() and len(value) != int(inside):
        raise FormatError(f"in this glTF, {path[1:]} must have {inside} values, not {len(value)}")
    if kind[0] == "[":
        kind_of_items = inside or "{}"
        if inside.isdecimal():
            kind_of_items = "#"
        for place, item in enumerate(value):
            yield from _said(item, kind_of_items, f"{path}[{place}]", owner)
    elif kind[0] == "{":
        kind_of_others = ""
        if owner == "extensions":
            kind_of_others = "{}"
        for name, item in value.items():
            if isinstance(item, dict | list):
                yield owner, name, ""
            else:
                yield owner, name, item
            kind_of_item = _SHAPE.get(owner, {}).get(name, inside or kind_of_others)
            if kind_of_item:
                yield from _said(item, kind_of_item, f"{path}.{name}", name)


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    if len(data) < 20:
        raise TruncatedError("a GLB begins with 20 bytes; this one ends before")
    _, version, length, size, kind = struct.unpack_from("<4sIIII", data)
    if version != 2 or kind != _JSON:
        raise FormatError(f"not a GLB of version 2 (version {version})")
    start = 20 + size
    # Some writers give a length that is too small, and it does no harm. One that is too large means that bytes are
    # missing.
    if len(data) < max(length, start):
        raise TruncatedError(f"this GLB should have {max(length, start)} bytes, not {len(data)}")
    text, binary = data[20:start], b""
    if len(data) >= start + 8:
        size, kind = struct.unpack_from("<II", data, start)
        if kind == _BINARY:
            binary = data[start + 8 : start + 8 + size]
    return text, binary


class Growing:
    """A tree that grows, and the bytes of its buffer, which wait in a file."""

    def __init__(self, file: IO[bytes], tree: Tree | None = None) -> None:
        begun: Tree = {
            "asset": {"version": "2.0", "generator": "bsm"},
            "scene": 0,
            "scenes": [{"nodes": []}],
        }
        self.tree: Tree = begun if tree is None else tree
        # The buffer waits in a file, because the JSON before it can only be written when all offsets are known.
        self._file, self.size = file, 0

    def add(self, kind: str, entry: Tree) -> int:
        entries: list[Tree] = self.tree.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def accessor(
        self, component: int, count: int, width: int, view: int | None = None, **more: Any
    ) -> int:
        entry: Tree = {}
        if view is not None:
            entry["bufferView"] = view
        entry |= {"componentType": component, "count": count, "type": _TYPES[width]}
        return self.add("accessors", entry | more)

    def append(self, data: bytes) -> int:
        """Append bytes to the buffer; return their offset."""
        start = self.size
        # Accessors must begin at multiples of four bytes.
        padded = data + bytes(-len(data) % 4)
        self.size += len(padded)
        if self.size > _MOST_BYTES:
            raise LimitError(
                "this takes more than the 4 GiB of a GLB; take fewer frames (--frames A:B), or write USD"
            )
        self._file.write(padded)
        return start

    def view(self, data: bytes, **more: Any) -> int:
        place = {"buffer": 0, "byteOffset": self.append(data), "byteLength": len(data)}
        return self.add("bufferViews", place | more)

    def use(self, extension: str, *, required: bool) -> None:
        keys = ["extensionsUsed"]
        if required:
            keys.append("extensionsRequired")
        for key in keys:
            names = self.tree.setdefault(key, [])
            if extension not in names:
                names.append(extension)

    def table(self, values: Array, *, packed: bool = False) -> int:
        """A bufferView of values, which begin at multiples of four bytes, unless they shall be packed."""
        size = values.itemsize * values.shape[1]
        padding = -size % 4
        if packed or not padding:
            return self.view(values.tobytes())
        # Rows of three bytes, as colors have them, are padded: glTF wants each vertex at a multiple of four.
        rows = np.ascontiguousarray(values).view(np.uint8).reshape(-1, size)
        padded = np.pad(rows, ((0, 0), (0, padding)))
        return self.view(padded.tobytes(), byteStride=size + padding)

    def write(self, file: IO[bytes]) -> None:
        tree = json.dumps(self.tree, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
        # Lone surrogates of file names cannot be written as UTF-8, and a question mark is better than no file.
        text = tree.encode(errors="replace")
        text += b" " * (-len(text) % 4)
        length = 28 + len(text) + self.size
        file.write(struct.pack("<4sIIII", _MAGIC, 2, length, len(text), _JSON) + text)
        file.write(struct.pack("<II", self.size, _BINARY))
        self._file.seek(0)
        shutil.copyfileobj(self._file, file)

    def glb(self) -> bytes:
        written = io.BytesIO()
        self.write(written)
        return written.getvalue()


def mime_of(data: bytes) -> str | None:
    """The type that the first bytes of an image tell."""
    if data[4:12] in (b"ftypavif", b"ftypavis"):
        return _MIMES["avif"]
    return _MIMES.get(kind_of_image(data) or "")


def bounds_of(values: Array) -> Tree:
    low, high = values.min(axis=0), values.max(axis=0)
    return {"min": low.astype(float).tolist(), "max": high.astype(float).tolist()}


def _count(where: Tree, name: str) -> int:
    value = where.get(name, 0)
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < 1 << 53:
        raise FormatError(
            f"{name} of this glTF is {repr(value)[:40]}, not a number of bytes or values"
        )
    return value


def read_document(path: str, limits: Limits = DEFAULT_LIMITS) -> Document:
    return Document(Input(path).read_all(), Path(path).parent, limits)


def triangles_of(document: Document, primitive: Tree, count: int) -> npt.NDArray[np.int64]:
    """The triangles of a primitive over `count` vertices, shape (m, 3), those of strips and fans, too."""
    indices: npt.NDArray[np.int64] = np.arange(count)
    if "indices" in primitive:
        indices = document.numbers(primitive["indices"])[:, 0].astype(np.int64)
    mode = primitive.get("mode", TRIANGLES)
    if DRACO in primitive.get("extensions", {}):
        mode = TRIANGLES
    if mode == TRIANGLES:
        triangles = indices[: len(indices) // 3 * 3].reshape(-1, 3)
    else:
        if mode == STRIP:
            triangles, _ = cut_strips(np.array([len(indices)]), indices)
        else:
            step = np.arange(max(len(indices) - 2, 0))
            triangles = indices[np.column_stack([step + 1, step + 2, 0 * step])]
        # Not those that only lead to the next piece of a strip.
        triangles = triangles[~degenerate(triangles)]
    if triangles.size and not (triangles.min() >= 0 and triangles.max() < count):
        raise FormatError(f"a face of this glTF refers to vertex {triangles.max()} of {count}")
    return triangles
