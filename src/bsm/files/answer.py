"""The answer of a process that has read a file: one flat table, then the bytes that its rows name.

A hostile file may have taken that process over. So the table is checked before anything is made of it: each row is a
kind and a size, within shared memory. Whatever is wrong with it is a `FormatError` or `LimitError`.
"""

import os
import struct
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from itertools import islice
from mmap import mmap
from typing import Any, TypeAlias

import numpy as np

from bsm.bitstream import errors
from bsm.bitstream.errors import BsmError, FormatError, LimitError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import KINDS, Attribute
from bsm.codec.geometry.mesh import Metadata, NoFacesError, TriangleMesh
from bsm.files.formats.polygons import MeshFile
from bsm.files.motion.frames import Frames
from bsm.files.room import require_count

Value: TypeAlias = Any  # an array of two dimensions, a text, bytes, a whole number or a float
_COUNT = struct.Struct("<Q")
_ROW = struct.Struct("<IIQQ")  # a kind, columns, rows, and the first byte after the table
_PLAIN: dict[str, Callable[[bytes], Any]] = {
    "text": lambda data: data.decode(errors="surrogatepass"),
    "bytes": bytes,
    "int": lambda data: int.from_bytes(data[:_LONGEST], "little", signed=True),
    "float": lambda data: struct.unpack("<d", data)[0],
}
_KINDS = (*KINDS, *_PLAIN)
_COST = 1 << 10  # bytes of memory that a row is charged: what Python makes of it, and the time that it takes
_NOTHING, _MESH, _FRAMES, _ERROR = range(4)
_LETTER = 8  # bytes that a byte of text may become
_LONGEST = 32  # bytes of a whole number
_MOST_WORDS = 1 << 16  # bytes of an error
_REFUSALS: tuple[type[BsmError], ...] = (
    *(FormatError, LimitError, NoFacesError, errors.MeshError, errors.TruncatedError, errors.CorruptError),
    *(errors.UnsupportedError, errors.DependencyError, errors.OptionError, errors.ArgumentError, errors.NumericError),
)
"""Errors of readers; a process names them by their places here."""
_PLACES = ("offset", "frame", "block")

# ------------------------------------------------------------------------------------------------ as it is left


def leave(memory: int, found: MeshFile | Frames | BsmError | None) -> None:
    """Leave a mesh, frames, an error or nothing in shared memory."""
    rows, parts, known, total = list[bytes](), list[Any](), dict[int, bytes](), 0
    for value in _values(found):
        if id(value) not in known:
            kind, shape, data = _plain(value)
            known[id(value)] = _ROW.pack(_KINDS.index(kind), shape[1], shape[0], total)
            parts.append((value, data))  # a value that is gone could lend its number to another
            total += len(data)
        rows.append(known[id(value)])
    table = _COUNT.pack(len(rows)) + b"".join(rows)
    if len(table) + total > os.fstat(memory).st_size:
        raise MemoryError
    with closing(mmap(memory, len(table) + total)) as view:
        view.write(table)
        for _, data in parts:
            view.write(data)


def _plain(value: Value) -> tuple[str, tuple[int, ...], Any]:
    if isinstance(value, np.ndarray):
        return str(value.dtype), value.shape, np.ascontiguousarray(value).reshape(-1).view(np.uint8)
    kind, data = "bytes", value
    if isinstance(value, str):
        kind, data = "text", value.encode(errors="surrogatepass")
    elif isinstance(value, float | np.floating):
        kind, data = "float", struct.pack("<d", value)
    elif not isinstance(value, bytes):
        kind, data = "int", int(value).to_bytes(int(value).bit_length() // 8 + 1, "little", signed=True)
    return kind, (len(data), 1), data


def _values(found: MeshFile | Frames | BsmError | None) -> Iterator[Value]:
    if found is None:
        yield _NOTHING
    elif isinstance(found, BsmError):
        places = [getattr(found, name) for name in _PLACES]
        number = _REFUSALS.index(type(found)) if type(found) in _REFUSALS else 0
        yield from (_ERROR, number, found.message[:_MOST_WORDS])
        yield from (-1 if place is None else place for place in places)
    elif isinstance(found, MeshFile):
        yield from (_MESH, found.mesh.positions, *_dressed(found.mesh), *_listed(found.notes), *_listed(found.dropped))
    else:
        meshes = None if found.meshes is None else list(found.meshes)
        frames = list(found.frames) if meshes is None else [mesh.positions for mesh in meshes]
        yield from (_FRAMES, *_dressed(found), *_listed(found.notes), *_listed(frames))
        yield from (found.count, found.rigged, float(found.frame_rate), int(meshes is not None))
        for mesh in meshes or ():
            yield from _dressed(mesh)


def _dressed(found: TriangleMesh | Frames) -> Iterator[Value]:
    yield from (found.faces, len(found.attributes))
    for one in found.attributes:
        yield from (one.name, one.domain, one.semantic, one.values, 0 if one.indices is None else one.indices)
    yield len(found.metadata)
    for name, value in found.metadata.items():
        yield from (name, value)


def _listed(items: Sequence[Value]) -> tuple[Value, ...]:
    return (len(items), *items)


# ------------------------------------------------------------------------------------------------ as it is taken


@contextmanager
def _from_strangers() -> Iterator[None]:
    try:
        yield
    except (FormatError, LimitError):
        raise
    except MemoryError as error:
        raise LimitError("the system has too little memory for what the process that read this file left") from error
    except Exception as error:
        raise FormatError("the process that read this file left no mesh") from error


def found_in(memory: int, limits: Limits) -> MeshFile | Frames | None:
    """The mesh or frames that a process has left, or raise the error."""
    with _from_strangers():
        values = iter(_read(memory))
        kind = _next(values, int)
        if kind == _MESH:
            mesh = _mesh(next(values), values, limits)
            return MeshFile(mesh, _texts(values), _texts(values))
        if kind != _ERROR:
            return _frames(values, limits) if kind == _FRAMES else None
        error = _error(values)
    raise error


def _read(memory: int) -> list[Value]:
    """All values of a table: those of equal rows are one."""
    size = left = os.fstat(memory).st_size
    (count,) = _COUNT.unpack(os.pread(memory, _COUNT.size, 0))
    left -= count * _COST
    if left < 0:
        raise ValueError("more rows than there can be")
    table = os.pread(memory, count * _ROW.size, _COUNT.size)
    known, values = dict[bytes, Value](), list[Value]()
    for place in range(0, len(table), _ROW.size):
        row = table[place : place + _ROW.size]
        if row not in known:
            number, columns, rows, at = _ROW.unpack(row)
            kind, at = _KINDS[number], at + _COUNT.size + len(table)
            plain = np.dtype("uint8" if kind in _PLAIN else kind)
            taken = rows * columns * plain.itemsize
            left -= taken * (_LETTER if kind == "text" else 1)
            if left < 0 or at + taken > size:
                raise ValueError("a value that is not there")
            data = os.pread(memory, taken, at)
            known[row] = _PLAIN[kind](data) if kind in _PLAIN else np.ndarray((rows, columns), plain, data)
        values.append(known[row])
    return values


def _mesh(positions: Positions, values: Iterator[Value], limits: Limits) -> TriangleMesh:
    return TriangleMesh(_points(positions, limits), *_dressing(values, limits))


def _points(found: Value, limits: Limits) -> Positions:
    require_count("vertices", len(found), limits)
    points: Positions = _of_three(found, np.float64)
    return points


def _of_three(found: Value, kind: type[np.generic]) -> Any:
    if found.dtype != kind or found.shape[1] != 3:
        raise TypeError("an array of another kind")
    return found


def _frames(values: Iterator[Value], limits: Limits) -> Frames:
    faces, attributes, metadata = _dressing(values, limits)
    notes, frames = _texts(values), [_points(frame, limits) for frame in _list(values, np.ndarray)]
    count, rigged, rate = _next(values, int), _next(values, int), _next(values, float)
    require_count("vertices", rigged, limits)
    require_count("frames", len(frames), limits)
    if faces.min(initial=0) < 0 or count not in (0, len(frames)):  # 0: it was not known before all were read
        raise ValueError("faces or frames of another kind")
    meshes = _meshes(frames, values, limits) if _next(values, int) else None
    return Frames(faces, count, iter(frames), attributes, notes, rate, metadata, meshes, rigged)


def _meshes(frames: Sequence[Positions], values: Iterator[Value], limits: Limits) -> Iterator[TriangleMesh]:
    """Meshes as they are asked for, since each copies what it is made of."""
    for positions in frames:
        with _from_strangers():
            mesh = _mesh(positions, values, limits)
        yield mesh


def _dressing(values: Iterator[Value], limits: Limits) -> tuple[Faces, tuple[Attribute, ...], Metadata]:
    faces, attributes, known = next(values), list[Attribute](), set[int]()
    require_count("faces", len(faces), limits)
    for _ in range(_next(values, int)):
        name, domain, semantic, array, indices = islice(values, 5)
        given = None if isinstance(indices, int) else indices
        if {id(array), id(given)} & known:  # each is copied, and was charged once
            raise ValueError("attributes of the same numbers")
        known |= {id(array), id(given)} - {id(None)}
        attributes.append(Attribute(name, array, domain, semantic, given))
    metadata = {_next(values, str): _next(values, str | bytes | int | float) for _ in range(_next(values, int))}
    return _of_three(faces, np.int32), tuple(attributes), metadata


def _error(values: Iterator[Value]) -> BsmError:
    kind, words, *places = _next(values, int), _next(values, str), *(_next(values, int) for _ in _PLACES)
    known = {name: place for name, place in zip(_PLACES, places, strict=True) if place >= 0}
    return _REFUSALS[kind](words[:_MOST_WORDS], **known)


def _texts(values: Iterator[Value]) -> tuple[str, ...]:
    return tuple(_list(values, str))


def _list(values: Iterator[Value], kind: Any) -> list[Value]:
    return [_next(values, kind) for _ in range(_next(values, int))]


def _next(values: Iterator[Value], kind: Any) -> Value:
    if not isinstance(found := next(values), kind):
        raise TypeError("a value of another kind")
    return found
