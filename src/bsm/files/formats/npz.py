"""npz: the arrays `positions` (of a mesh, or of a sequence of them) and `faces`, as numpy saves them.

Attributes are arrays called "vertex/color", "face/material", "corner/texcoord" (with "corner/texcoord/indices"); arrays
of other names get their domain by their shape. The beginning of a name gives the meaning. "metadata" is JSON in UTF-8,
with binary values as {"base64": ...}.
"""

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
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass, field
from tokenize import TokenError
from typing import IO, Any, BinaryIO, Literal, cast, get_args

import numpy as np

from bsm.bitstream.errors import (
    BsmError,
    CorruptError,
    FormatError,
    LimitError,
    MeshError,
    TruncatedError,
)
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import MOST_COMPONENTS, Attribute, Domain
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.metadata import Written
from bsm.files.formats.polygons import Array, Column, Polygons, attributes_of, meaning_of
from bsm.files.motion.frames import Frames, Shared
from bsm.files.parsing import AS_NUMBERS, TREE, require_counts, require_inflated
from bsm.files.pipes import Input, about

# What numpy raises of a header, which it parses as Python.
_NO_HEADER = (
    ValueError,
    TypeError,
    KeyError,
    SyntaxError,
    RecursionError,
    MemoryError,
    OverflowError,
    TokenError,
)
_MOST_HEADER = 1 << 16
NPY = b"\x93NUMPY"
Kind = np.dtype[Any]


# Not numpy's load: from a pipe it would read on and on, and it takes the memory that a header declares.
def read_header(file: IO[bytes] | Input) -> tuple[tuple[int, ...], bool, Kind]:
    """Shape, whether the order is Fortran's, and type of an array of numbers; nothing is unpickled."""
    begin = file.read(len(NPY) + 2)
    # The header declares its own length, in two bytes in version 1 and in four in those after it.
    bytes_of_length = 4
    if begin[len(NPY) :][:1] == b"\1":
        bytes_of_length = 2
    length = file.read(bytes_of_length)
    declared = int.from_bytes(length, "little")
    text = file.read(min(declared, _MOST_HEADER))
    if begin.startswith(NPY) and (not length or len(text) < declared):
        raise TruncatedError(f"the header of an npy array has {len(text)} bytes of {declared}")
    header = io.BytesIO(begin + length + text)
    try:
        version = np.lib.format.read_magic(header)
        if version == (1, 0):
            shape, fortran, kind = np.lib.format.read_array_header_1_0(header)
        else:
            shape, fortran, kind = np.lib.format.read_array_header_2_0(header)
    except _NO_HEADER as error:
        raise CorruptError(f"not a valid npy header: {error}") from error
    # Objects would be unpickled, which runs whatever the file says.
    if kind.hasobject or kind.kind not in "iuf":
        raise MeshError(f"an array of {kind} does not hold numbers")
    if any(type(side) is not int or side < 0 for side in shape):  # True is an int to numpy
        raise CorruptError(f"an array has the shape {shape}")
    return shape, fortran, kind


def _shaped(data: bytes, shape: tuple[int, ...], fortran: bool, kind: Kind) -> Array:
    order: Literal["C", "F"] = "C"
    if fortran:
        order = "F"
    return np.frombuffer(data, kind).reshape(shape, order=order)


def read_npy(file: Input, bound: str = "vertices", limits: Limits = DEFAULT_LIMITS) -> Array | None:
    """The next table of three columns of a pipe, or None at its end; the limit called `bound` is that of its rows."""
    begin = file.peek(len(NPY))
    if not begin:
        return None
    if begin != NPY:
        raise FormatError("this is not a sequence of npy arrays")
    shape, fortran, kind = read_header(file)
    if len(shape) != 2 or shape[1] != 3:
        raise FormatError(
            f"an array of {kind} and shape {shape} is neither faces nor a frame: (n, 3) numbers are"
        )
    require_counts(limits, **{bound: shape[0]})
    size = math.prod(shape) * kind.itemsize
    data = file.read(size)
    if len(data) < size:
        raise TruncatedError(f"an npy array has {len(data)} of {size} bytes")
    return _shaped(data, shape, fortran, kind)


def write_npy(file: BinaryIO, array: Array) -> None:
    buffer = io.BytesIO()  # numpy would ask a pipe for its position
    np.save(buffer, array)
    file.write(buffer.getvalue())
    file.flush()


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


@contextmanager
def _reading(name: str) -> Iterator[None]:
    """Name the array that is absent, damaged, or packed in an unknown way."""
    try:
        yield
    except BsmError:
        raise
    except KeyError:
        raise FormatError(
            f"the npz file has no array {name}; it needs positions and faces"
        ) from None
    except _DAMAGE as error:
        raise CorruptError(f"the array {name} cannot be read: {error}") from error
    except RuntimeError as error:  # a password, or an unknown compression
        raise FormatError(f"this is not an npz file that can be read: {error}") from error


class NpzArray:
    """An array of an npz, read from its beginning on."""

    def __init__(self, archive: zipfile.ZipFile, name: str) -> None:
        self._name = name
        with _reading(name):
            self._entry = archive.open(f"{name}.npy")
            self.shape, self._fortran, self._kind = read_header(self._entry)

    @property
    def size(self) -> int:
        return math.prod(self.shape) * self._kind.itemsize

    def read_array(self) -> Array:
        """All numbers; `LimitError` beyond 4 GiB."""
        if self.size > _MAX_BYTES:
            raise LimitError(
                f"the array {self._name} takes {self.size} bytes; the limit is {_MAX_BYTES}"
            )
        values = self._taken(self.shape)
        with _reading(self._name):
            if self._entry.read(1):  # zipfile also checks the sum of an entry at its end
                raise CorruptError(f"the array {self._name} takes more than {self.size} bytes")
        return values

    def entries(self) -> Iterator[Array]:
        """Yield the array entry by entry of the first index."""
        # In that order a frame lies scattered over the whole array, which would have to be held.
        if self._fortran:
            raise MeshError(
                f"the array {self._name} is in Fortran's order; save it with numpy.ascontiguousarray"
            )
        for _ in range(self.shape[0]):
            yield self._taken(self.shape[1:])

    def _taken(self, shape: tuple[int, ...]) -> Array:
        """The next numbers; memory is allocated only for bytes that are present."""
        size = math.prod(shape) * self._kind.itemsize
        with _reading(self._name):
            data = self._entry.read(size)
            if len(data) < size:
                raise CorruptError(f"the array {self._name} of {self.size} bytes ends early")
            return _shaped(data, shape, self._fortran, self._kind)


def _frames(archive: str | BinaryIO, *names: str) -> Iterator[tuple[Array, ...]]:
    """The frames of arrays of a sequence, read as they are asked for."""
    with opened_archive(archive) as opened:
        yield from zip(*(NpzArray(opened, name).entries() for name in names), strict=True)


def _require_shapes(archive: zipfile.ZipFile, compressed: int, limits: Limits) -> tuple[int, int]:
    """Check positions and faces before they are read; the number of frames, 0 for one mesh, and bytes of memory."""
    positions, faces = NpzArray(archive, "positions"), NpzArray(archive, "faces")
    shape, frames = positions.shape, 0
    if len(shape) == 3:
        frames, *shape_of_frame = shape
        shape = tuple(shape_of_frame)
        if 0 in positions.shape or shape[1] != 3:
            raise MeshError(
                f"this npz file holds {frames} frames of shape {shape}; (n, 3) numbers are a frame"
            )
    numbers, corners = math.prod(shape), math.prod(faces.shape)
    require_counts(limits, frames=frames, vertices=numbers // 3, faces=corners // 3)
    size = max(positions.size // max(frames, 1), AS_NUMBERS * numbers)
    size += max(faces.size, AS_NUMBERS * corners)
    require_inflated(size, compressed, limits)
    return frames, size


def read_npz(data: bytes, limits: Limits) -> Polygons:
    """Read the npz of a mesh; check shapes before reading numbers, and skip arrays that are not needed."""
    with opened_archive(io.BytesIO(data)) as archive:
        frames, inflated = _require_shapes(archive, len(data), limits)
        if frames:
            raise MeshError(f"this npz file holds a sequence of {frames} frames, not one mesh")
        mesh = TriangleMesh(
            NpzArray(archive, "positions").read_array(), NpzArray(archive, "faces").read_array()
        )
        extras = _beside(archive, mesh, len(data), limits, inflated)
    sizes, corners = np.full(len(mesh.faces), 3), mesh.faces.astype(np.int64).reshape(-1)
    return Polygons(
        mesh.positions, sizes, corners, (), extras.dropped, tuple(extras.columns), extras.metadata
    )


_PER_MOVING_BYTE = 5
"""Bytes that one of a frame's values takes while it becomes an attribute, and the frame before it is still there."""


@dataclass(frozen=True, eq=False)
class _Beside:
    """What an npz holds beside positions and faces; `moving`, by name, are the arrays with values for each frame."""

    columns: list[Column] = field(default_factory=list)
    moving: dict[str, str] = field(default_factory=dict)
    metadata: dict[str, str | int | float | bytes] = field(default_factory=dict)
    unread: list[str] = field(default_factory=list)

    @property
    def dropped(self) -> tuple[str, ...]:
        """The names of those that are none of these, or how many there are."""
        others = len(self.unread) - MOST_NAMED
        if others <= 0:
            return tuple(self.unread)
        return (*self.unread[:MOST_NAMED], f"{others} other arrays")


def _beside(
    archive: zipfile.ZipFile,
    mesh: TriangleMesh,
    compressed: int,
    limits: Limits,
    inflated: int,
    frames: int = 0,
) -> _Beside:
    """Check shapes before numbers are read; for a sequence, with its number of frames."""
    extras, frame_bytes, vertices = _Beside(), 0, len(mesh.positions)
    most_rows = max(vertices, 3 * len(mesh.faces))
    names = dict.fromkeys(name.removesuffix(".npy") for name in archive.namelist())
    indices = {
        name
        for name in names
        if name.endswith("/indices") and name.removesuffix("/indices") in names
    }
    others = [name for name in names if name not in ("positions", "faces", *indices)]
    for number, name in enumerate(others):
        extras.unread.append(name)  # until it is taken
        with suppress(MeshError, FormatError):  # no numbers
            array = NpzArray(archive, name)
            if (
                frames
                and array.shape[:2] == (frames, vertices)
                and math.prod(array.shape[2:]) <= MOST_COMPONENTS
            ):
                frame_bytes += _PER_MOVING_BYTE * array.size // frames
                require_inflated(frame_bytes, compressed, limits, vertices)
                if len(extras.moving) < limits.attributes:
                    extras.moving[name.removeprefix("vertex/")] = extras.unread.pop()
                continue
            is_metadata = name == "metadata"
            # An archive may name a million arrays: only so many are opened.
            if number > 2 * limits.attributes or not (
                is_metadata or max(array.shape, default=0) <= most_rows
            ):
                continue
            inflated_size = array.size
            if is_metadata:
                inflated_size *= TREE
            inflated += inflated_size
            of_corners: NpzArray | None = None
            if f"{name}/indices" in indices:
                of_corners = NpzArray(archive, f"{name}/indices")
                inflated += AS_NUMBERS * math.prod(of_corners.shape)
            require_inflated(inflated, compressed, limits)
            values = array.read_array()
            if is_metadata and values.dtype == np.uint8:
                extras.metadata.update(_parse_metadata(values.tobytes()))
                extras.unread.pop()
                continue
            column = column_of(name, values, mesh, of_corners)
            if column is not None:
                extras.columns.append(column)
                extras.unread.pop()
    return extras


def column_of(
    name: str, values: Array, mesh: TriangleMesh, of_corners: NpzArray | None
) -> Column | None:
    """An array as the column that its name or its shape tells; None: it is of nothing here."""
    vertices, faces = len(mesh.positions), len(mesh.faces)
    domain, _, short_name = name.partition("/")
    if domain not in get_args(Domain) or not short_name:
        short_name, domain = name, "face"
        if values.ndim == 3:
            domain = "corner"
        elif values.shape[:1] == (vertices,):
            domain = "vertex"
    rows = {"vertex": vertices, "face": faces, "corner": 3 * faces}
    indices = None
    if domain == "corner" and of_corners:
        indices = of_corners.read_array()
        if indices.dtype.kind not in "iu" or indices.size != 3 * faces:
            return None
        indices = indices.reshape(-1).astype(np.int64)
        rows["corner"] = len(values)
    elif domain == "corner" and values.ndim == 3:
        values = values.reshape(-1, values.shape[2])
    if values.ndim == 1:
        values = values[:, None]
    if (
        values.ndim != 2
        or not 1 <= values.shape[1] <= MOST_COMPONENTS
        or rows[domain] != len(values)
    ):
        return None
    native = values.astype(values.dtype.newbyteorder("="))
    return Column(
        short_name, native, cast(Domain, domain), meaning_of(short_name, values.shape[1]), indices
    )


def _parse_metadata(data: bytes) -> Metadata:
    try:
        entries = json.loads(data)
        metadata: dict[str, str | int | float | bytes] = {}
        for name, value in entries.items():
            if isinstance(value, dict):
                value = base64.b64decode(value["base64"], validate=True)
            if not isinstance(value, str | int | float | bytes):
                raise ValueError(f"{name} is neither a text nor a number")
            metadata[name] = value
    except (
        ValueError,
        AttributeError,
        KeyError,
        TypeError,
        RecursionError,
        binascii.Error,
    ) as error:
        raise CorruptError(f"the metadata of the npz file are invalid: {error}") from error
    return metadata


def _metadata_in(metadata: Metadata) -> dict[str, Array]:
    """The array of metadata, if there are any."""
    if not metadata:
        return {}
    entries: dict[str, Any] = dict(metadata)
    for name, value in metadata.items():
        if isinstance(value, bytes):
            entries[name] = {"base64": base64.b64encode(value).decode()}
    return {"metadata": np.frombuffer(json.dumps(entries).encode(), np.uint8)}


def _arrays_of(attributes: Iterable[Attribute]) -> dict[str, Array]:
    arrays: dict[str, Array] = {}
    for attribute in attributes:
        name = f"{attribute.domain}/{attribute.name}"
        if attribute.indices is None:
            arrays[name] = attribute.values
            continue
        # Without the values of no corner: there may be no more of them than corners.
        used, indices = np.unique(attribute.indices, return_inverse=True)
        arrays[name] = attribute.values[used]
        arrays[f"{name}/indices"] = indices.reshape(attribute.indices.shape).astype(
            attribute.indices.dtype
        )
    return arrays


def write_npz(mesh: TriangleMesh, stem: str) -> Written:
    """The npz of a mesh: `positions` as float64, `faces` as int32, and everything else it has."""
    buffer = io.BytesIO()
    others = _arrays_of(mesh.attributes) | _metadata_in(mesh.metadata)
    np.savez_compressed(buffer, positions=mesh.positions, faces=mesh.faces, **others)  # type: ignore[arg-type]
    return Written(buffer.getvalue())


@contextmanager
def open_npz_sequence(
    file: BinaryIO, faces: Faces, count: int, shared: Shared
) -> Iterator[Callable[[Positions], None]]:
    """Write an npz of frames, shape (T, n, 3); yields what takes them. What changes waits in files for their number."""
    first, moving = dict[str, Array](), dict[str, IO[bytes]]()
    frames = 0
    # Deflated, positions are 5 % smaller, and take longer than decoding does; faces would be a hundredth of them.
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive, ExitStack() as waiting:

        def take(frame: Positions) -> None:
            nonlocal frames
            arrays = {"positions": np.asarray(frame, "<f8"), **_arrays_of(shared.attributes())}
            for name, values in arrays.items():
                of_first = first.setdefault(name, values)
                if name not in moving and (
                    name == "positions" or not np.array_equal(values, of_first)
                ):
                    moving[name] = waiting.enter_context(tempfile.TemporaryFile())
                    # Until now the values were those of the first frame, and so they were for all frames before.
                    for _ in range(frames):
                        moving[name].write(of_first.tobytes())
                if name in moving:
                    moving[name].write(values.tobytes())
            frames += 1

        yield take
        if count and frames != count:
            raise CorruptError(f"{frames} of {count} frames came")
        for name, values in {"faces": faces, **first, **_metadata_in(shared.metadata())}.items():
            target: Any = f"{name}.npy"
            # Positions and faces are stored and the rest is deflated: an entry made with a ZipInfo is not compressed by
            # default.
            if name in ("faces", "positions"):
                target = zipfile.ZipInfo(target)
            # The size is not known before, and zipfile cannot change to 64 bits while it writes.
            with archive.open(target, "w", force_zip64=name in moving) as entry:
                if name not in moving:
                    np.lib.format.write_array(entry, values)
                    continue
                header = {
                    "descr": values.dtype.str,
                    "fortran_order": False,
                    "shape": (frames, *values.shape),
                }
                np.lib.format.write_array_header_1_0(entry, header)
                moving[name].seek(0)
                shutil.copyfileobj(moving[name], entry)


# ------------------------------------------------------------------------------------------------------------ sequences


def read_archive(source: Input, limits: Limits) -> Frames | None:
    """The sequence of an npz; None if it holds a mesh. Shapes are looked at before numbers are read."""
    archive: str | BinaryIO = source.name
    if source.is_file:
        compressed = os.path.getsize(source.name)
    else:
        buffered = source.peek(1 << 32)
        archive, compressed = io.BytesIO(buffered), len(buffered)
    with opened_archive(archive) as opened:
        count, inflated = _require_shapes(opened, compressed, limits)
        if not count:
            return None
        mesh = TriangleMesh(next(_positions(archive)), NpzArray(opened, "faces").read_array())
        extras = _beside(opened, mesh, compressed, limits, inflated, count)
    faces = np.arange(len(mesh.faces))
    corners = np.arange(3 * len(faces)).reshape(-1, 3)
    still, _, refused = attributes_of(
        extras.columns, len(mesh.positions), len(faces), corners, faces
    )
    extras.unread.extend(refused)
    notes: tuple[str, ...] = ()
    if extras.unread:
        notes = (f"left out: {', '.join(extras.dropped)}",)
    meshes, attributes = None, still
    if extras.moving:
        meshes = _with_attributes(archive, mesh.faces, still, extras.moving)
        attributes = next(_with_attributes(archive, mesh.faces, still, extras.moving)).attributes
    return Frames(
        mesh.faces,
        count,
        _positions(archive),
        attributes,
        notes,
        metadata=extras.metadata,
        meshes=meshes,
    )


def _positions(archive: str | BinaryIO) -> Iterator[Positions]:
    return (frame.astype(np.float64) for (frame,) in _frames(archive, "positions"))


def _with_attributes(
    archive: str | BinaryIO, faces: Faces, still: tuple[Attribute, ...], moving: Mapping[str, str]
) -> Iterator[TriangleMesh]:
    """One frame after the other, with the attributes of all frames, and its own."""
    for number, (positions, *arrays) in enumerate(_frames(archive, "positions", *moving.values())):
        attributes = [*still]
        with about(f"frame {number}"):
            for name, array in zip(moving, arrays):
                values = array.astype(array.dtype.newbyteorder("="))
                attributes.append(
                    Attribute(name, values, semantic=meaning_of(name, values[0].size))
                )
            mesh = TriangleMesh(positions, faces, tuple(attributes))
        yield mesh


def read_pipe(source: Input, limits: Limits) -> Frames:
    """npy arrays, one after the other: faces, frame, frame, ..."""
    with ExitStack() as unread:
        unread.callback(source.close)
        faces = read_npy(source, "faces", limits)
        if faces is None or faces.dtype.kind not in "iu":
            raise FormatError("the first array must be the faces: integers of shape (m, 3)")
        outside = faces[(faces < 0) | (faces >= 1 << 31)]
        if outside.size:
            raise MeshError(f"a face refers to vertex {outside[0]}")
        unread.pop_all()

    def frames() -> Iterator[Positions]:
        with closing(source):
            while (frame := read_npy(source, "vertices", limits)) is not None:
                yield frame.astype(np.float64)

    return Frames(faces.astype(np.int32), 0, frames())
