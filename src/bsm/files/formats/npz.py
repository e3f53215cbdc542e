"""npz: the arrays `positions` (of a mesh, or of a sequence of them) and `faces`, as numpy saves them.

Attributes are arrays called "vertex/color", "face/material", "corner/texcoord" (with "corner/texcoord/indices"); arrays
of other names are what their shape tells. What a name begins with tells the meaning. "metadata" is the UTF-8 of a JSON
object, binary values as {"base64": ...} in it.
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
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from tokenize import TokenError
from typing import IO, Any, BinaryIO, Protocol, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError, CorruptError, FormatError, LimitError, MeshError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import MOST_COMPONENTS, Attribute, Domain
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.polygons import Column, Polygons, meaning_of
from bsm.files.formats.written import Written
from bsm.files.room import AS_NUMBERS, TREE, require_count, require_inflated

# What numpy raises of a header, which it parses as Python.
_NO_HEADER = (ValueError, TypeError, KeyError, SyntaxError, RecursionError, MemoryError, OverflowError, TokenError)
NPY = b"\x93NUMPY"
Array = npt.NDArray[Any]
Kind = np.dtype[Any]


class Readable(Protocol):
    """What arrays are read from."""

    def read(self, size: int = ..., /) -> bytes:
        """The next bytes, as many as asked for unless the end comes before."""


def read_header(file: Readable | IO[bytes]) -> tuple[tuple[int, ...], bool, Kind]:
    """Shape, whether the order is Fortran's, and type of an array of numbers; nothing is unpickled."""
    try:
        version = np.lib.format.read_magic(file)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, fortran, kind = read(file)
    except _NO_HEADER as error:
        raise CorruptError(f"there is no legal npy header: {error}") from error
    if kind.hasobject or kind.kind not in "iuf":
        raise MeshError(f"an array of {kind} does not hold numbers")
    if any(type(side) is not int or side < 0 for side in shape):  # True is an int to numpy
        raise CorruptError(f"an array has the shape {shape}")
    return shape, fortran, kind


def size_of(shape: tuple[int, ...], kind: Kind) -> int:
    """Bytes of an array."""
    return int(np.prod([int(side) for side in shape], dtype=object)) * kind.itemsize


def read_npy(file: Readable, bound: str = "vertices", limits: Limits = DEFAULT_LIMITS) -> Array | None:
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
    """Write an array so that whoever reads a pipe has it at once."""
    buffer = io.BytesIO()  # numpy would ask a pipe for its position
    np.save(buffer, array)
    file.write(buffer.getvalue())
    file.flush()


Archive: TypeAlias = "str | os.PathLike[str] | BinaryIO | zipfile.ZipFile"
"""A path, a seekable binary file, or an archive that is open and stays so."""

_MAX_BYTES = 1 << 32
MOST_NAMED = 16
"""Arrays that a note names, of those that are left out."""
# A damaged archive may send zipfile to places before the beginning of the file: ValueError.
_NO_ARCHIVE = (zipfile.BadZipFile, NotImplementedError, RuntimeError, ValueError)
_DAMAGE = (EOFError, OSError, ValueError, zipfile.BadZipFile, zlib.error, lzma.LZMAError)


def opened_archive(archive: str | os.PathLike[str] | BinaryIO) -> zipfile.ZipFile:
    """A zip archive, open; `FormatError` if it is none."""
    try:
        return zipfile.ZipFile(archive)
    except _NO_ARCHIVE as error:
        raise FormatError(f"this is not an npz file: {error}") from error


class NpzArray:
    """An array of an npz, read from its beginning on; the archive is open until the end of the `with` block."""

    def __init__(self, archive: Archive, name: str) -> None:
        self._name = name
        self._ours = not isinstance(archive, zipfile.ZipFile)
        self._archive = archive if isinstance(archive, zipfile.ZipFile) else opened_archive(archive)
        try:
            self._entry = self._archive.open(f"{name}.npy")
            self.shape, self._fortran, self._kind = read_header(self._entry)
        except BaseException as error:
            self._close_archive()
            if isinstance(error, BsmError):
                raise
            if isinstance(error, KeyError):
                raise FormatError(f"the npz file has no array {name}; it needs positions and faces") from None
            if isinstance(error, _DAMAGE):
                raise CorruptError(f"the array {name} cannot be read: {error}") from error
            if isinstance(error, _NO_ARCHIVE):
                raise FormatError(f"this is not an npz file that can be read: {error}") from error
            raise

    def __enter__(self) -> NpzArray:
        return self

    def __exit__(self, *_: object) -> None:
        self._entry.close()
        self._close_archive()

    def _close_archive(self) -> None:
        if self._ours:
            self._archive.close()

    @property
    def size(self) -> int:
        """Bytes that it takes, by its header."""
        return size_of(self.shape, self._kind)

    def whole(self) -> Array:
        """All numbers; `LimitError` beyond 4 GiB. Nothing is allocated for what is only claimed."""
        size = size_of(self.shape, self._kind)
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
        if self._fortran:
            raise MeshError(f"the array {self._name} is in Fortran's order; save it with numpy.ascontiguousarray")
        size = size_of(self.shape[1:], self._kind)
        for number in range(self.shape[0]):
            data = self._read(size)
            if len(data) < size:
                raise CorruptError(f"the array {self._name} ends early, in frame {number} of {self.shape[0]}")
            yield np.frombuffer(data, self._kind).reshape(self.shape[1:])

    def _read(self, size: int) -> bytes:
        try:
            return self._entry.read(size)
        except _DAMAGE as error:
            raise CorruptError(f"the array {self._name} cannot be read: {error}") from error


def npz_shape(archive: Archive) -> tuple[int, ...]:
    """Shape of the array `positions`, (T, n, 3) for a sequence; errors as those of `NpzArray`."""
    with NpzArray(archive, "positions") as positions:
        return positions.shape


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
    """Read the npz of a mesh; shapes are looked at before numbers are read, and what is of no use is not read."""
    with opened_archive(io.BytesIO(data)) as archive:
        return _read_npz(archive, len(data), limits)


def _read_npz(archive: zipfile.ZipFile, compressed: int, limits: Limits) -> Polygons:
    inflated = 0
    for name, bound in (("positions", "vertices"), ("faces", "faces")):
        shape, size = shape_of(archive, name)
        if len(shape) == 3 and name == "positions":
            raise MeshError(f"this npz file holds a sequence of {shape[0]} frames, not one mesh")
        require_count(bound, math.prod(shape) // 3, limits)
        inflated += max(size, AS_NUMBERS * math.prod(shape))
        require_inflated(inflated, compressed, limits)
    positions, faces = read_arrays(archive, "positions", "faces")
    mesh = TriangleMesh(positions, faces)
    columns: list[Column] = []
    dropped: list[str] = []
    metadata: Metadata = {}
    every = [name.removesuffix(".npy") for name in archive.namelist()]
    names = {name: None for name in every if name not in ("positions", "faces")}
    for number, name in enumerate(names):
        if name.endswith("/indices") and name.removesuffix("/indices") in names:
            continue
        try:
            if number > 2 * limits.attributes:
                raise MeshError("too many")
            shape, size = shape_of(archive, name)
            if name != "metadata" and max(shape, default=0) > max(len(mesh.positions), 3 * len(mesh.faces)):
                raise MeshError("of nothing here")
            if f"{name}/indices" in names:
                size += AS_NUMBERS * math.prod(shape_of(archive, f"{name}/indices")[0])
            inflated += TREE * size if name == "metadata" else size
            require_inflated(inflated, compressed, limits)
            (values,) = read_arrays(archive, name)
            if name == "metadata" and values.dtype == np.uint8:
                metadata = _parse_metadata(values.tobytes())
                continue
            column = column_of(archive, name, values, mesh, f"{name}/indices" in names)
        except (MeshError, FormatError):  # no numbers
            column = None
        columns += [column] if column else []
        dropped += [] if column else [name]
    if len(dropped) > MOST_NAMED:
        dropped[MOST_NAMED:] = [f"{len(dropped) - MOST_NAMED} other arrays"]
    sizes, corners = np.full(len(mesh.faces), 3), mesh.faces.astype(np.int64).reshape(-1)
    return Polygons(mesh.positions, sizes, corners, (), tuple(dropped), tuple(columns), metadata)


def shape_of(archive: Archive, name: str) -> tuple[tuple[int, ...], int]:
    """What an array says of itself: its shape, and its bytes."""
    with NpzArray(archive, name) as array:
        return array.shape, array.size


def column_of(archive: Archive, name: str, values: Array, mesh: TriangleMesh, indexed: bool) -> Column | None:
    """An array as the column that its name or its shape tells; None: it is of nothing here."""
    domain, _, rest = name.partition("/")
    vertices, faces = len(mesh.positions), len(mesh.faces)
    if domain not in get_args(Domain) or not rest:
        domain, rest = _domain_of(values.shape, vertices, faces), name
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
    return Column(rest, values.astype(values.dtype.newbyteorder("=")), _DOMAINS[domain], meaning_of(rest), indices)


_DOMAINS: dict[str, Domain] = {"vertex": "vertex", "face": "face", "corner": "corner"}


def _domain_of(shape: tuple[int, ...], vertices: int, faces: int) -> str:
    if len(shape) == 3:
        return "corner"
    return "vertex" if shape[:1] == (vertices,) else "face"


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
        raise CorruptError(f"the metadata of the npz file make no sense: {error}") from error
    return found


def write_npz(mesh: TriangleMesh, stem: str) -> Written:
    """The npz of a mesh: `positions` as float64, `faces` as int32, and everything else it has."""
    arrays: dict[str, Array] = {"positions": mesh.positions, "faces": mesh.faces}
    for attribute in mesh.attributes:
        arrays[f"{attribute.domain}/{attribute.name}"] = attribute.values
        if attribute.indices is not None:
            arrays[f"corner/{attribute.name}/indices"] = attribute.indices
    if mesh.metadata:
        entries: dict[str, Any] = {
            name: {"base64": base64.b64encode(value).decode()} if isinstance(value, bytes) else value
            for name, value in mesh.metadata.items()
        }
        arrays["metadata"] = np.frombuffer(json.dumps(entries).encode(), np.uint8)
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)  # type: ignore[arg-type]
    return Written(buffer.getvalue())


@contextmanager
def open_npz_sequence(
    file: BinaryIO, faces: Faces, count: int, attributes: Callable[[], tuple[Attribute, ...]] = tuple
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

    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive, closing(_Worn(attributes)) as worn:
        # Deflated, positions are 5 % smaller, and take longer than decoding does; faces would be a hundredth of them.
        with archive.open(zipfile.ZipInfo("faces.npy"), "w") as entry:
            np.lib.format.write_array(entry, faces)
        known = count > 0
        if not known:
            yield worn.beside(kept.append)
            count = len(kept)
        with archive.open(zipfile.ZipInfo("positions.npy"), "w", force_zip64=True) as entry:
            for frame in kept:
                write(frame)
            if known:
                yield worn.beside(write)
            if taken != count:
                raise CorruptError(f"{taken} of {count} frames came")
        worn.finish(archive, count)


class _Worn:
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
        for first, one in zip(self._first, now, strict=True):
            if one is not first and one.name not in self._moved:
                self._moved[one.name] = tempfile.TemporaryFile()  # noqa: SIM115
                for _ in range(self._frames):
                    self._moved[one.name].write(first.values.tobytes())
            if one.name in self._moved:
                self._moved[one.name].write(one.values.tobytes())
        self._frames += 1

    def finish(self, archive: zipfile.ZipFile, count: int) -> None:
        """Write them all."""
        for one in self._first:
            with archive.open(f"{one.domain}/{one.name}.npy", "w", force_zip64=True) as entry:
                if one.name in self._moved:
                    header = {
                        "descr": one.values.dtype.str,
                        "fortran_order": False,
                        "shape": (count, *one.values.shape),
                    }
                    np.lib.format.write_array_header_1_0(entry, header)
                    self._moved[one.name].seek(0)
                    shutil.copyfileobj(self._moved[one.name], entry)
                else:
                    np.lib.format.write_array(entry, one.values)
            if one.indices is not None:
                with archive.open(f"corner/{one.name}/indices.npy", "w") as entry:
                    np.lib.format.write_array(entry, one.indices)

    def close(self) -> None:
        """Give up the files."""
        for file in self._moved.values():
            file.close()
