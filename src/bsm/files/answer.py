"""The answer of a process that has read a file: one flat table, then the bytes that its rows name.

A hostile file may have taken that process over. So the table is checked before anything is made of it: each row is a
kind and a size, within shared memory. Whatever is wrong with it is a `FormatError` or `LimitError`.
"""

import os
import struct
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from mmap import mmap
from typing import Any, TypeAlias

import numpy as np

from bsm.bitstream import errors
from bsm.bitstream.errors import BsmError, FormatError, LimitError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import KINDS, Attribute
from bsm.codec.geometry.mesh import NoFacesError, TriangleMesh
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
    "none": lambda data: None,
}
_KINDS = (*KINDS, *_PLAIN)
_COST = 1 << 10  # bytes of memory that a row is charged: what Python makes of it, and the time that it takes
_LETTER = 8  # bytes that a byte of text may become
_LONGEST = 32  # bytes of a whole number
_END = object()
_MOST_WORDS = 1 << 16  # bytes of an error
_REFUSALS: tuple[type[BsmError], ...] = (
    *(FormatError, LimitError, NoFacesError, errors.MeshError, errors.TruncatedError, errors.CorruptError),
    *(errors.UnsupportedError, errors.DependencyError, errors.OptionError, errors.ArgumentError, errors.NumericError),
)
"""Errors of readers."""
_METADATA = [(str, str | bytes | int | float)]
_PARTS: dict[type, dict[str, Any]] = {
    Attribute: {"name": str, "values": np.ndarray, "domain": str, "semantic": str, "indices": np.ndarray | None},
    TriangleMesh: {"positions": np.ndarray, "faces": np.ndarray, "attributes": [Attribute], "metadata": _METADATA},
    MeshFile: {"mesh": TriangleMesh, "notes": [str], "dropped": [str]},
    Frames: {
        **{"faces": np.ndarray, "count": int, "frames": [np.ndarray], "attributes": [Attribute], "notes": [str]},
        **{"frame_rate": float, "metadata": _METADATA, "rigged": int, "meshes": [TriangleMesh]},
    },
    **dict.fromkeys(_REFUSALS, dict.fromkeys(("offset", "frame", "block"), int | None) | {"message": str}),
    type(None): {},
}
"""What an answer is made of, in this order; `[one]` is the number of them, then each."""
_ANSWERS = (type(None), MeshFile, Frames, *_REFUSALS)

# ------------------------------------------------------------------------------------------------ as it is left


def leave(memory: int, found: MeshFile | Frames | BsmError | None) -> None:
    """Leave a mesh, frames, an error or nothing in shared memory."""
    if isinstance(found, Frames) and found.meshes is not None:
        meshes = list(found.meshes)
        found = replace(found, frames=(mesh.positions for mesh in meshes), meshes=iter(meshes))
    rows, parts, known, total = list[bytes](), list[Any](), dict[int, bytes](), 0
    form = type(found) if type(found) in _ANSWERS else FormatError
    for value in (_ANSWERS.index(form), *_flat(form, found)):
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
    elif value is None:
        kind, data = "none", b""
    elif not isinstance(value, bytes):
        kind, data = "int", int(value).to_bytes(int(value).bit_length() // 8 + 1, "little", signed=True)
    return kind, (len(data), 1), data


def _flat(form: Any, found: Any) -> Iterator[Value]:
    if found is None:
        yield None
    elif isinstance(form, list):
        items = list(found.items() if isinstance(found, Mapping) else found)
        yield len(items)
        for item in items:
            yield from _flat(form[0], item)
    elif isinstance(form, tuple):
        yield from found
    elif form in _PARTS:
        for name, part in _PARTS[form].items():
            yield from _flat(part, getattr(found, name))
    else:
        yield found


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
        taker = _Taker(iter(_read(memory)), limits, os.fstat(memory).st_size)
        found: MeshFile | Frames | BsmError | None = taker.made(_ANSWERS[taker.next(int)])
    if isinstance(found, BsmError):
        raise found
    return found


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


@dataclass
class _Taker:
    """Makes an answer of values that were read, and checks what they say of each other."""

    values: Iterator[Value]
    limits: Limits
    size: int  # bytes of shared memory, and of values that attributes may copy

    def next(self, kind: Any) -> Value:
        if not isinstance(found := next(self.values, _END), kind):
            raise TypeError("a value of another kind")
        return found

    def made(self, form: Any) -> Any:
        if isinstance(form, list):
            count = self.next(int | None)
            return None if count is None else tuple(self.made(form[0]) for _ in range(count))
        if isinstance(form, tuple):
            return tuple(map(self.next, form))
        if form not in _PARTS:
            return self.next(form)
        given = {name: self.made(part) for name, part in _PARTS[form].items() if name != "meshes"}
        self.check(form, given)
        return form(**given) if form is not type(None) else None

    def check(self, form: type, given: dict[str, Any]) -> None:
        if form is Attribute:
            self.size -= sum(given[name].nbytes for name in ("values", "indices") if given[name] is not None)
            if self.size < 0:
                raise ValueError("values that are used many times")
        if "message" in given:
            given["message"] = given["message"][:_MOST_WORDS]
        if "faces" not in given:
            return
        frames = given.get("frames", [given.get("positions")])
        counts = {"vertices": max(given.get("rigged", 0), *map(len, frames), 0), "faces": len(given["faces"])}
        for name, count in (counts | {"frames": len(frames)}).items():
            require_count(name, count, self.limits)
        threes = {(array.dtype.name, array.shape[1]) for array in frames}
        if {("int32", 3)} != {(given["faces"].dtype.name, given["faces"].shape[1])} or threes - {("float64", 3)}:
            raise TypeError("arrays of another kind")
        given["metadata"] = dict(given["metadata"])
        if form is Frames:
            count = self.next(int | None)
            if {given["count"], count} - {0, None, len(frames)} or given["faces"].min(initial=0) < 0:
                raise ValueError("frames of another number")  # 0: it was not known before all were read
            given |= {"frames": iter(frames), "meshes": None if count is None else self.later(count)}

    def later(self, count: int) -> Iterator[TriangleMesh]:
        """Meshes as they are asked for, since each copies what it is made of."""
        left = self.size
        for _ in range(count):
            self.size = left
            with _from_strangers():
                mesh: TriangleMesh = self.made(TriangleMesh)
            yield mesh
