"""npz: the arrays `positions` (of a mesh, or of a sequence of them) and `faces`, as numpy saves them.

Attributes are arrays called "vertex/color", "face/material", "corner/texcoord" (with "corner/texcoord/indices"); arrays
of other names get their domain by their shape. The beginning of a name gives the meaning. "metadata" is JSON in UTF-8,
with binary values as {"base64": ...}.
"""

from __future__ import annotations

import base64
import binascii
import io
import json
import lzma
import math
import os
import shutil
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass, field
from tokenize import TokenError
from typing import IO, Any, BinaryIO, TypeAlias, cast, get_args

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError, CorruptError, FormatError, LimitError, MeshError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import MOST_COMPONENTS, Attribute, Domain
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.metadata import Written
from bsm.files.formats.polygons import Column, Polygons, attributes_of, meaning_of
from bsm.files.motion.frames import Frames
from bsm.files.pipes import Input, about
from bsm.files.room import AS_NUMBERS, TREE, require_count, require_inflated

# What numpy raises of a header, which it parses as Python.
_NO_HEADER = (ValueError, TypeError, KeyError, SyntaxError, RecursionError, MemoryError, OverflowError, TokenError)
NPY = b"\x93NUMPY"
Array = npt.NDArray[Any]
Kind = np.dtype[Any]


def read_header(file: IO[bytes]) -> tuple[tuple[int, ...], bool, Kind]:
    """Shape, whether the order is Fortran's, and type of an array of numbers; nothing is unpickled."""
    try:
        version = np.lib.format.read_magic(file)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, fortran, kind = read(file)
    except _NO_HEADER as error:
        raise CorruptError(f"not a valid npy header: {error}") from error
    if kind.hasobject or kind.kind not in "iuf":
        raise MeshError(f"an array of {kind} does not hold numbers")
    if any(type(side) is not int or side < 0 for side in shape):  # True is an int to numpy
        raise CorruptError(f"an array has the shape {shape}")
    return shape, fortran, kind


def size_of(shape: tuple[int, ...], kind: Kind) -> int:
    return int(np.prod([int(side) for side in shape], dtype=object)) * kind.itemsize


def read_npy(file: Input, bound: str = "vertices", limits: Limits = DEFAULT_LIMITS) -> Array | None:
    """The next table of three columns of a pipe, or None at its end; the limit called `bound` is that of its rows."""
    magic = file.read(len(NPY))
    if not magic:
        return None
    if magic != NPY:
        raise FormatError("this is not a sequence of npy arrays")
    # The header declares its own length, in two bytes in version 1 and in four in those after it.
    version = file.read(2)
    length = file.read(2 if version[:1] == b"\1" else 4)
    declared = int.from_bytes(length, "little")
    text = file.read(min(declared, 1 << 16))
    if not length or len(text) < declared:
        raise TruncatedError("an npy array ends in its header")
    shape, fortran, kind = read_header(io.BytesIO(magic + version + length + text))
    if len(shape) != 2 or shape[1] != 3:
        raise FormatError(f"an array of {kind} and shape {shape} is neither faces nor a frame: (n, 3) numbers are")
    require_count(bound, shape[0], limits)
    size = size_of(shape, kind)
    data = file.read(size)
    if len(data) < size:
        raise TruncatedError(f"an npy array has {len(data)} of {size} bytes")
    return np.frombuffer(data, kind).reshape(shape, order="F" if fortran else "C")


def write_npy(file: BinaryIO, array: Array) -> None:
    buffer = io.BytesIO()  # numpy would ask a pipe for its position
    np.save(buffer, array)
    file.write(buffer.getvalue())
    file.flush()


Archive: TypeAlias = "str | os.PathLike[str] | BinaryIO | zipfile.ZipFile"
"""A path, a seekable binary file, or an archive that is open and stays so."""

_MAX_BYTES = 1 << 32
MOST_NAMED = 16  # arrays that a note names, of those that are left out
# A damaged archive may send zipfile to places before the beginning of the file: ValueError.
_NO_ARCHIVE = (zipfile.BadZipFile, NotImplementedError, RuntimeError, ValueError)
_DAMAGE = (EOFError, OSError, ValueError, zipfile.BadZipFile, zlib.error, lzma.LZMAError)


def opened_archive(archive: str | os.PathLike[str] | BinaryIO) -> zipfile.ZipFile:
    try:
        return zipfile.ZipFile(archive)
    except _NO_ARCHIVE as error:
        raise FormatError(f"this is not an npz file: {error}") from error


class NpzArray:
    """An array of an npz, read from its beginning on; the archive is open until the end of the `with` block."""

    def __init__(self, archive: Archive, name: str) -> None:
        self._name = name
        with ExitStack() as opened:
            if not isinstance(archive, zipfile.ZipFile):
                archive = opened.enter_context(opened_archive(archive))
            try:
                self._entry = opened.enter_context(archive.open(f"{name}.npy"))
                self.shape, self._fortran, self._kind = read_header(self._entry)
            except BsmError:
                raise
            except KeyError:
                raise FormatError(f"the npz file has no array {name}; it needs positions and faces") from None
            except _DAMAGE as error:
                raise CorruptError(f"the array {name} cannot be read: {error}") from error
            except _NO_ARCHIVE as error:
                raise FormatError(f"this is not an npz file that can be read: {error}") from error
            self._opened = opened.pop_all()

    def __enter__(self) -> NpzArray:
        return self

    def __exit__(self, *_: object) -> None:
        self._opened.close()

    @property
    def size(self) -> int:
        return size_of(self.shape, self._kind)

    def whole(self) -> Array:
        """All numbers; `LimitError` beyond 4 GiB. Memory is allocated only for bytes that are present."""
        size = self.size
        if size > _MAX_BYTES:
            raise LimitError(f"the array {self._name} takes {size} bytes; the limit is {_MAX_BYTES}")
        data = self._read(size + 1)
        if len(data) != size:
            raise CorruptError(f"the array {self._name} should take {size} bytes, not {len(data)}")
        try:
            return np.frombuffer(data, self._kind).reshape(self.shape, order="F" if self._fortran else "C")
        except ValueError as error:  # of the shape (0, 2**62)
            raise CorruptError(f"the array {self._name} has no legal shape: {error}") from error

    def frames(self) -> Iterator[Array]:
        """The first index' parts one after the other, without ever holding all of them."""
        for piece in self.pieces(1):
            yield piece[0]

    def pieces(self, rows: int) -> Iterator[Array]:
        """Yield pieces of the array of up to `rows` entries of the first index."""
        if self._fortran:
            raise MeshError(f"the array {self._name} is in Fortran's order; save it with numpy.ascontiguousarray")
        size = size_of(self.shape[1:], self._kind)
        for first in range(0, self.shape[0], rows):
            count = min(rows, self.shape[0] - first)
            data = self._read(count * size)
            if len(data) < count * size:
                raise CorruptError(
                    f"the array {self._name} ends early, in part {first + len(data) // max(1, size)} of {self.shape[0]}"
                )
            yield np.frombuffer(data, self._kind).reshape(count, *self.shape[1:])

    def _read(self, size: int) -> bytes:
        try:
            return self._entry.read(size)
        except _DAMAGE as error:
            raise CorruptError(f"the array {self._name} cannot be read: {error}") from error


def npz_frames(archive: Archive) -> Iterator[Positions]:
    """The frames of a sequence, shape (n, 3), read as they are asked for; errors as those of `NpzArray`."""
    with NpzArray(archive, "positions") as positions:
        for frame in positions.frames():
            yield frame.astype(np.float64)


def read_arrays(archive: Archive, *names: str) -> tuple[Array, ...]:
    """The arrays called `names`; errors as those of `NpzArray`, and `LimitError` beyond 4 GiB."""
    found = []
    for name in names:
        with NpzArray(archive, name) as array:
            found.append(array.whole())
    return tuple(found)


def read_npz(data: bytes, limits: Limits) -> Polygons:
    """Read the npz of a mesh; check shapes before reading numbers, and skip arrays that are not needed."""
    with opened_archive(io.BytesIO(data)) as archive:
        inflated = 0
        for name, bound in (("positions", "vertices"), ("faces", "faces")):
            shape, size = shape_of(archive, name)
            if len(shape) == 3 and name == "positions":
                raise MeshError(f"this npz file holds a sequence of {shape[0]} frames, not one mesh")
            require_count(bound, math.prod(shape) // 3, limits)
            inflated += max(size, AS_NUMBERS * math.prod(shape))
            require_inflated(inflated, len(data), limits)
        positions, faces = read_arrays(archive, "positions", "faces")
        mesh = TriangleMesh(positions, faces)
        found = _Beside.of(archive, mesh, len(data), limits, inflated)
    sizes, corners = np.full(len(mesh.faces), 3), mesh.faces.astype(np.int64).reshape(-1)
    return Polygons(mesh.positions, sizes, corners, (), found.dropped, tuple(found.columns), found.metadata)


_PER_MOVING_BYTE = 5
"""Bytes that one of a frame's values takes while it becomes an attribute, and the frame before it is still there."""


@dataclass(frozen=True, eq=False)
class _Beside:
    """What an npz holds beside positions and faces; `moving`, by name, are the arrays with values for each frame."""

    columns: list[Column] = field(default_factory=list)
    moving: dict[str, str] = field(default_factory=dict)
    metadata: dict[str, str | int | float | bytes] = field(default_factory=dict)
    left: list[str] = field(default_factory=list)

    @staticmethod
    def of(
        archive: zipfile.ZipFile, mesh: TriangleMesh, compressed: int, limits: Limits, inflated: int, frames: int = 0
    ) -> _Beside:
        """Check shapes before numbers are read; for a sequence, with its number of frames."""
        found, frame, vertices = _Beside(), 0, len(mesh.positions)
        names = dict.fromkeys(name.removesuffix(".npy") for name in archive.namelist())
        others = [name for name in names if name not in ("positions", "faces")]
        for number, name in enumerate(others):
            if name.endswith("/indices") and name.removesuffix("/indices") in names:
                continue
            column, indexed = None, f"{name}/indices" in names
            with suppress(MeshError, FormatError):  # no numbers
                shape, size = shape_of(archive, name)
                if frames and shape[:2] == (frames, vertices) and math.prod(shape[2:]) <= MOST_COMPONENTS:
                    frame += _PER_MOVING_BYTE * size // frames
                    require_inflated(frame, compressed, limits, vertices)
                    if len(found.moving) < limits.attributes:
                        found.moving[name.removeprefix("vertex/")] = name
                        continue
                elif number <= 2 * limits.attributes and (
                    name == "metadata" or max(shape, default=0) <= max(vertices, 3 * len(mesh.faces))
                ):
                    size += AS_NUMBERS * math.prod(shape_of(archive, f"{name}/indices")[0]) if indexed else 0
                    inflated += TREE * size if name == "metadata" else size
                    require_inflated(inflated, compressed, limits)
                    (values,) = read_arrays(archive, name)
                    if name == "metadata" and values.dtype == np.uint8:
                        found.metadata.update(_parse_metadata(values.tobytes()))
                        continue
                    column = column_of(archive, name, values, mesh, indexed)
            found.columns.extend([column] if column else [])
            found.left.extend([] if column else [name])
        return found

    @property
    def dropped(self) -> tuple[str, ...]:
        """The names of those that are none of these, or how many there are."""
        rest = len(self.left) - MOST_NAMED
        return (*self.left[:MOST_NAMED], *([f"{rest} other arrays"] if rest > 0 else []))


def shape_of(archive: Archive, name: str) -> tuple[tuple[int, ...], int]:
    """What an array says of itself: its shape, and its bytes."""
    with NpzArray(archive, name) as array:
        return array.shape, array.size


def column_of(archive: Archive, name: str, values: Array, mesh: TriangleMesh, indexed: bool) -> Column | None:
    """An array as the column that its name or its shape tells; None: it is of nothing here."""
    domain, _, rest = name.partition("/")
    vertices, faces = len(mesh.positions), len(mesh.faces)
    if domain not in get_args(Domain) or not rest:
        domain = "corner" if values.ndim == 3 else "vertex" if values.shape[:1] == (vertices,) else "face"
        rest = name
    indices = None
    if domain == "corner" and indexed:
        (indices,) = read_arrays(archive, f"{name}/indices")
        if indices.dtype.kind not in "iu" or indices.size != 3 * faces:
            return None
        indices = indices.reshape(-1).astype(np.int64)
    elif domain == "corner" and values.ndim == 3:
        values = values.reshape(-1, values.shape[2])
    values = values[:, None] if values.ndim == 1 else values
    rows = {"vertex": vertices, "face": faces, "corner": 3 * faces if indices is None else len(values)}
    if values.ndim != 2 or not 1 <= values.shape[1] <= MOST_COMPONENTS or rows.get(domain) != len(values):
        return None
    native = values.astype(values.dtype.newbyteorder("="))
    return Column(rest, native, cast(Domain, domain), meaning_of(rest, values.shape[1]), indices)


def _parse_metadata(data: bytes) -> Metadata:
    try:
        entries = json.loads(data)
        found: dict[str, str | int | float | bytes] = {}
        for name, value in entries.items():
            plain = base64.b64decode(value["base64"], validate=True) if isinstance(value, dict) else value
            if not isinstance(plain, str | int | float | bytes):
                raise ValueError(f"{name} is neither a text nor a number")
            found[name] = plain
    except (ValueError, AttributeError, KeyError, TypeError, RecursionError, binascii.Error) as error:
        raise CorruptError(f"the metadata of the npz file are invalid: {error}") from error
    return found


def _written_metadata(metadata: Metadata) -> Array:
    entries: dict[str, Any] = {
        name: {"base64": base64.b64encode(value).decode()} if isinstance(value, bytes) else value
        for name, value in metadata.items()
    }
    return np.frombuffer(json.dumps(entries).encode(), np.uint8)


def write_npz(mesh: TriangleMesh, stem: str) -> Written:
    """The npz of a mesh: `positions` as float64, `faces` as int32, and everything else it has."""
    arrays: dict[str, Array] = {"positions": mesh.positions, "faces": mesh.faces}
    for attribute in mesh.attributes:
        arrays[f"{attribute.domain}/{attribute.name}"] = attribute.values
        if attribute.indices is not None:
            arrays[f"corner/{attribute.name}/indices"] = attribute.indices
    if mesh.metadata:
        arrays["metadata"] = _written_metadata(mesh.metadata)
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)  # type: ignore[arg-type]
    return Written(buffer.getvalue())


@contextmanager
def open_npz_sequence(
    file: BinaryIO,
    faces: Faces,
    count: int,
    attributes: Callable[[], tuple[Attribute, ...]] = tuple,
    metadata: Callable[[], Metadata] = dict,
) -> Iterator[Callable[[Positions], None]]:
    """Write an npz of `positions`, shape (T, n, 3), `faces` and attributes; yields what takes frame after frame."""
    kept: list[Positions] = []
    taken = 0

    def write(frame: Positions) -> None:
        nonlocal taken
        if taken == 0:
            header = {"descr": "<f8", "fortran_order": False, "shape": (count, *frame.shape)}
            np.lib.format.write_array_header_1_0(entry, header)
        entry.write(np.ascontiguousarray(frame, "<f8").data)
        taken += 1

    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive, closing(_Waiting(attributes)) as waiting:
        # Deflated, positions are 5 % smaller, and take longer than decoding does; faces would be a hundredth of them.
        with archive.open(zipfile.ZipInfo("faces.npy"), "w") as entry:
            np.lib.format.write_array(entry, faces)
        known = count > 0
        if not known:
            yield waiting.beside(kept.append)
            count = len(kept)
        with archive.open(zipfile.ZipInfo("positions.npy"), "w", force_zip64=True) as entry:
            for frame in kept:
                write(frame)
            if known:
                yield waiting.beside(write)
            if taken != count:
                raise CorruptError(f"{taken} of {count} frames came")
        waiting.finish(archive, count)
        if entries := metadata():
            with archive.open(zipfile.ZipInfo("metadata.npy"), "w") as entry:
                np.lib.format.write_array(entry, _written_metadata(entries))


class _Waiting:
    """Attributes of frames: those that change wait in files until all frames are there."""

    def __init__(self, attributes: Callable[[], tuple[Attribute, ...]]) -> None:
        self._attributes = attributes
        self._first: tuple[Attribute, ...] = ()
        self._moved: dict[str, IO[bytes]] = {}
        self._frames = 0

    def beside(self, write: Callable[[Positions], None]) -> Callable[[Positions], None]:
        """What writes a frame, and takes note of its attributes."""

        def take(frame: Positions) -> None:
            write(frame)
            self._take()

        return take

    def _take(self) -> None:
        now = self._attributes()
        self._first = now if self._frames == 0 else self._first
        for first, attribute in zip(self._first, now, strict=True):
            if attribute is not first and attribute.name not in self._moved:
                self._moved[attribute.name] = tempfile.TemporaryFile()  # noqa: SIM115
                for _ in range(self._frames):
                    self._moved[attribute.name].write(first.values.tobytes())
            if attribute.name in self._moved:
                self._moved[attribute.name].write(attribute.values.tobytes())
        self._frames += 1

    def finish(self, archive: zipfile.ZipFile, count: int) -> None:
        for attribute in self._first:
            with archive.open(f"{attribute.domain}/{attribute.name}.npy", "w", force_zip64=True) as entry:
                if attribute.name in self._moved:
                    kind, shape = attribute.values.dtype.str, (count, *attribute.values.shape)
                    header = {"descr": kind, "fortran_order": False, "shape": shape}
                    np.lib.format.write_array_header_1_0(entry, header)
                    self._moved[attribute.name].seek(0)
                    shutil.copyfileobj(self._moved[attribute.name], entry)
                else:
                    np.lib.format.write_array(entry, attribute.values)
            if attribute.indices is not None:
                with archive.open(f"corner/{attribute.name}/indices.npy", "w") as entry:
                    np.lib.format.write_array(entry, attribute.indices)

    def close(self) -> None:
        for file in self._moved.values():
            file.close()


# ------------------------------------------------------------------------------------------------------------ sequences


def read_archive(given: Input, limits: Limits) -> Frames | None:
    """The sequence of an npz; None if it holds a mesh. Shapes are looked at before numbers are read."""
    held = b"" if given.is_file else given.peek(1 << 32)
    archive = given.name if given.is_file else io.BytesIO(held)
    shape, _ = shape_of(archive, "positions")
    if len(shape) != 3:
        return None
    if 0 in shape or shape[2] != 3:
        raise MeshError(f"this npz file holds {shape[0]} frames of shape {shape[1:]}; (n, 3) numbers are a frame")
    of_faces, size = shape_of(archive, "faces")
    for name, count in (("frames", shape[0]), ("vertices", shape[1]), ("faces", of_faces[0] if of_faces else 0)):
        require_count(name, count, limits)
    compressed = os.path.getsize(given.name) if given.is_file else len(held)
    require_inflated(AS_NUMBERS * 3 * shape[1] + max(size, AS_NUMBERS * math.prod(of_faces)), compressed, limits)
    (faces,) = read_arrays(archive, "faces")
    mesh = TriangleMesh(next(npz_frames(archive)), faces)
    with opened_archive(archive) as opened:
        found = _Beside.of(opened, mesh, compressed, limits, 0, shape[0])
    corners, every_face = np.arange(3 * len(mesh.faces)).reshape(-1, 3), np.arange(len(mesh.faces))
    still, refused = attributes_of(found.columns, len(mesh.positions), len(mesh.faces), corners, every_face)
    found.left.extend(refused)
    notes = (f"left out: {', '.join(found.dropped)}",) if found.left else ()
    if not found.moving:
        return Frames(mesh.faces, shape[0], npz_frames(archive), still, notes, metadata=found.metadata)
    first, meshes = (_dressed(archive, mesh.faces, still, found.moving) for _ in range(2))
    frames, attributes = npz_frames(archive), next(first).attributes
    return Frames(mesh.faces, shape[0], frames, attributes, notes, metadata=found.metadata, meshes=meshes)


def _dressed(
    archive: str | io.BytesIO, faces: Faces, still: tuple[Attribute, ...], moving: Mapping[str, str]
) -> Iterator[TriangleMesh]:
    """One frame after the other, with the attributes of all frames, and its own."""
    with ExitStack() as stack:
        arrays = [stack.enter_context(NpzArray(archive, name)).frames() for name in moving.values()]
        for number, (positions, *values) in enumerate(zip(npz_frames(archive), *arrays, strict=True)):
            with about(f"frame {number}"):
                own = [column.astype(column.dtype.newbyteorder("=")) for column in values]
                named = zip(moving, own, strict=True)
                more = (Attribute(name, v, semantic=meaning_of(name, v[0].size)) for name, v in named)
                mesh = TriangleMesh(positions, faces, (*still, *more))
            yield mesh


def read_pipe(given: Input, limits: Limits) -> Frames:
    """npy arrays, one after the other: faces, frame, frame, ..."""
    with ExitStack() as unread:
        unread.callback(given.close)
        faces = read_npy(given, "faces", limits)
        if faces is None or faces.dtype.kind not in "iu":
            raise FormatError("the first array must be the faces: integers of shape (m, 3)")
        if faces.size and not 0 <= int(faces.min()) <= int(faces.max()) < 1 << 31:
            raise MeshError(f"a face refers to vertex {faces.max() if faces.min() >= 0 else faces.min()}")
        unread.pop_all()

    def frames() -> Iterator[Positions]:
        with closing(given):
            while (frame := read_npy(given, "vertices", limits)) is not None:
                yield frame.astype(np.float64)

    return Frames(faces.astype(np.int32), 0, frames())
