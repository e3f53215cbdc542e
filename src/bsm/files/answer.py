"""The answer of a process that has read a file: one flat table, then the bytes that its rows name.

A hostile file may have taken that process over. So the reader names the kinds of answers that it accepts, and checks
each row, a kind and a size, before it makes anything of it. Whatever is wrong is a `FormatError` or `LimitError`.
"""

import os
import struct
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from bsm.bitstream import errors
from bsm.bitstream.errors import BsmError, FormatError, LimitError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import KINDS, Attribute
from bsm.codec.geometry.mesh import NoFacesError, TriangleMesh
from bsm.files.formats.polygons import MeshFile
from bsm.files.motion.frames import Frames
from bsm.files.parsing import require_counts

_COUNT = struct.Struct("<Q")
_ROW = struct.Struct("<IIQQ")  # a kind, columns, rows, and the first byte after the table
_PLAIN: dict[type, tuple[Callable[[Any], bytes], Callable[[bytes], Any]]] = {
    # Names of files that are not UTF-8 hold lone surrogates in Python; strict coding would lose the whole answer.
    str: (
        lambda text: text.encode(errors="surrogatepass"),
        lambda data: data.decode(errors="surrogatepass"),
    ),
    bytes: (bytes, bytes),
    float: (struct.Struct("<d").pack, lambda data: struct.unpack("<d", data)[0]),
    int: (
        lambda n: int(n).to_bytes(16, "little", signed=True),
        lambda data: int.from_bytes(data[:16], "little", signed=True),
    ),
    type(None): (lambda none: b"", lambda data: None),
}
"""Values besides arrays: how each becomes bytes, and is made of them again."""
_KINDS = (*KINDS, *_PLAIN)
# Bytes of memory that a row is charged, for its time, too, and a byte of text.
_COST, _LETTER = 1 << 10, 8
_MOST_WORDS = 4096  # letters of an error
_REFUSALS: tuple[type[BsmError], ...] = (
    *(
        FormatError,
        LimitError,
        NoFacesError,
        errors.MeshError,
        errors.TruncatedError,
        errors.CorruptError,
    ),
    *(errors.UnsupportedError, errors.DependencyError),
)
"""Errors of readers."""
MESH: tuple[type, ...] = (MeshFile, *_REFUSALS)
FRAMES: tuple[type, ...] = (type(None), Frames, errors.OptionError, *_REFUSALS)
"""The answers that are accepted from readers of meshes and of sequences."""
_METADATA = [(str, str | bytes | int | float)]
_PARTS: dict[type, dict[str, Any]] = {
    Attribute: {
        "name": str,
        "values": np.ndarray,
        "domain": str,
        "semantic": str,
        "indices": np.ndarray | None,
    },
    TriangleMesh: {
        "positions": np.ndarray,
        "faces": np.ndarray,
        "attributes": [Attribute],
        "metadata": _METADATA,
    },
    MeshFile: {"mesh": TriangleMesh, "notes": [str], "dropped": [str]},
    Frames: {
        **{
            "faces": np.ndarray,
            "count": int,
            "frames": [np.ndarray],
            "attributes": [Attribute],
            "notes": [str],
        },
        **{"frame_rate": float, "metadata": _METADATA, "rigged": int, "meshes": [TriangleMesh]},
    },
    **dict.fromkeys(
        (errors.OptionError, *_REFUSALS),
        dict.fromkeys(("offset", "frame", "block"), int | None) | {"message": str},
    ),
}
"""What an answer is made of, in this order; `[one]` is the number of them, then each."""
_ANSWERS = (MeshFile, *FRAMES)
_MISSING = (
    "a package that reads such files is missing: pip install 'bsm-codec[formats,simulation,usd]'"
)


def leave(
    memory: int,
    result: MeshFile | Frames | BsmError | None,
    ask: Callable[[int], None] = lambda size: None,
) -> None:
    """Leave a mesh, frames, an error or nothing in shared memory, after asking for the bytes that this takes."""
    rows, parts, total = list[bytes](), list[Any](), 0
    form: Any = type(result)
    if form not in _ANSWERS:
        form = FormatError
    kind: Any
    data: Any
    for value in (_ANSWERS.index(form), *_flat(form, result)):
        if isinstance(value, np.ndarray):
            numbers = np.ascontiguousarray(value).reshape(-1)
            kind, shape, data = str(value.dtype), value.shape, numbers.view(np.uint8)
        else:
            kind = next(kind for kind in _PLAIN if isinstance(value, kind))
            data = _PLAIN[kind][0](value)
            shape = (len(data), 1)
        rows.append(_ROW.pack(_KINDS.index(kind), shape[1], shape[0], total))
        parts.append(data)
        total += len(data)
    table = _COUNT.pack(len(rows)) + b"".join(rows)
    # Before anything is written: the parent may refuse, while a file of too many bytes would end this process with a
    # signal, and without words.
    ask(len(table) + total)
    with open(memory, "wb", closefd=False) as file:
        file.seek(0)
        file.writelines((table, *parts))


def _flat(form: Any, value: Any) -> Iterator[Any]:
    if isinstance(form, list) and value is not None:
        if isinstance(value, Mapping):
            value = value.items()
        items = list(value)
        yield len(items)
        for item in items:
            yield from _flat(form[0], item)
    elif isinstance(form, tuple):
        yield from value
    elif value is not None and form in _PARTS:
        for name, part in _PARTS[form].items():
            contents = getattr(value, name)
            # They are in the meshes.
            if form is Frames and name == "frames" and value.meshes is not None:
                contents = ()
            yield from _flat(part, contents)
    elif isinstance(value, np.generic):
        yield value.item()
    else:
        yield value


def found_in(memory: int, most: int, limits: Limits, accepted: tuple[type, ...]) -> Any:
    """The mesh or frames that a process has left, or raise the error; all copies take at most so many bytes."""
    try:
        values = _read(memory, most)
        form = _ANSWERS[_made(int, values, limits)]
        if form not in accepted:
            raise TypeError("an answer of another kind")
        result: MeshFile | Frames | BsmError | None = _made(form, values, limits)
    except LimitError:
        raise
    except MemoryError as error:
        raise LimitError(
            "the system has too little memory for the answer of the reading process"
        ) from error
    except Exception as error:
        raise FormatError("the process that read this file left no mesh") from error
    if isinstance(result, BsmError):
        words = result.message[:_MOST_WORDS]
        # Not the words of the child: they may tell to install anything.
        if isinstance(result, errors.DependencyError):
            words = _MISSING
        result.message = " ".join(words.splitlines())
        raise result
    return result


def _read(memory: int, most: int) -> Iterator[Any]:
    size = os.fstat(memory).st_size
    # Of what the answer may take, the shared memory itself is already gone.
    remaining = most - size
    (count,) = _COUNT.unpack(os.pread(memory, _COUNT.size, 0))
    remaining -= count * _COST
    for place in range(_COUNT.size, _COUNT.size + count * _ROW.size, _ROW.size):
        number, columns, rows, begin = _ROW.unpack(os.pread(memory, _ROW.size, place))
        kind, begin = _KINDS[number], begin + _COUNT.size + count * _ROW.size
        element_type = np.dtype("uint8")
        if kind not in _PLAIN:
            element_type = np.dtype(kind)
        taken = cost = rows * columns * element_type.itemsize
        if kind is str:
            cost *= _LETTER
        remaining -= cost
        if remaining < 0 or begin + taken > size:
            raise ValueError("more than there can be")
        data = os.pread(memory, taken, begin)
        if kind in _PLAIN:
            yield _PLAIN[kind][1](data)
        else:
            yield np.ndarray((rows, columns), element_type, data)


def _made(form: Any, values: Iterator[Any], limits: Limits) -> Any:
    if isinstance(form, list):
        count = _made(int | None, values, limits)
        if count is None:
            return None
        return [_made(form[0], values, limits) for _ in range(count)]
    if isinstance(form, tuple):
        return [_made(part, values, limits) for part in form]
    if form not in _PARTS:
        if not isinstance(value := next(values), form):
            raise TypeError("a value of another kind")
        return value
    values_by_name = {name: _made(part, values, limits) for name, part in _PARTS[form].items()}
    values_by_name |= {
        name: tuple(values_by_name[name])
        for name in ("attributes", "notes", "dropped")
        if name in values_by_name
    }
    if form in (TriangleMesh, Frames):
        _check(values_by_name, limits)
    return form(**values_by_name)


def _check(fields: dict[str, Any], limits: Limits) -> None:
    """Check a mesh or frames before they are made, and bring their parts into the right kinds."""
    fields["metadata"], meshes = dict(fields["metadata"]), fields.get("meshes")
    if meshes is None:
        frames = fields.get("frames", [fields.get("positions")])
    else:
        frames = [mesh.positions for mesh in meshes]
    counts = {
        "vertices": max(fields.get("rigged", 0), *map(len, frames)),
        "faces": len(fields["faces"]),
    }
    require_counts(limits, **counts, frames=len(frames))
    kinds = {
        fields["faces"].dtype.name,
        *(f"{frame.dtype} of {frame.shape[1]}" for frame in frames),
    }
    # Checked here since the classes convert what they get: a million objects in place of numbers would be copied first.
    # 0: it is not known.
    if kinds != {"int32", "float64 of 3"} or fields.get("count", 0) not in (0, len(frames)):
        raise ValueError("arrays of another kind")
    if "meshes" in fields:
        fields["faces"] = TriangleMesh(frames[0], fields["faces"]).faces
        fields["frames"] = iter(frames)
        if meshes is not None:
            fields["meshes"] = iter(meshes)
