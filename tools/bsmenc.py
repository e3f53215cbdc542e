"""bsmenc by ctypes: the stream of a mesh, or the status of its error."""

import ctypes
from collections.abc import Container
from ctypes import (
    CFUNCTYPE,
    POINTER,
    Structure,
    byref,
    c_char_p,
    c_double,
    c_int,
    c_int32,
    c_int64,
    c_size_t,
    c_void_p,
)
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bsm import TriangleMesh
from tools.amalgamate import amalgamated, interface
from tools.bsmdec import DOMAINS, KINDS, SEMANTICS, Entry, compiled, loaded

GRID, CELLS, LOSSLESS = range(3)
QUALITIES = ("default", "exact", "bits", "bound", "share", "angle", "recompute", "none")
UNREACHABLE, STOPPED = 10, 13


class Given(Structure):
    """An attribute."""

    _fields_ = [
        ("name", c_char_p),
        *((name, c_int) for name in ("domain", "semantic", "kind", "components")),
        *(
            ("rows", c_int64),
            ("values", c_void_p),
            ("indices", c_void_p),
            ("quality", c_int),
            ("amount", c_double),
        ),
    ]


class Mesh(Structure):
    _fields_ = [
        *(("size", c_size_t), ("vertices", c_int64), ("faces", c_int64)),
        *((name, c_void_p) for name in ("positions", "positions_single", "corners", "attributes")),
        *(
            ("attribute_count", c_size_t),
            ("metadata", c_void_p),
            ("metadata_count", c_size_t),
            ("frames", c_int64),
        ),
    ]


PROGRESS = CFUNCTYPE(c_int, c_void_p, c_double)


class Options(Structure):
    _fields_ = [
        *(
            ("size", c_size_t),
            ("positions", c_int),
            ("bits", c_int),
            ("cell", c_double),
            ("origin", c_double * 3),
        ),
        *(("keep_order", c_int), ("quick", c_int), ("limits", c_void_p), ("allocator", c_void_p)),
        *(("progress", PROGRESS), ("host", c_void_p)),
    ]


TAKE, GIVE = CFUNCTYPE(c_void_p, c_void_p, c_size_t), CFUNCTYPE(None, c_void_p, c_void_p, c_size_t)


class Allocator(Structure):
    """Memory of malloc, of which some calls are refused."""

    _fields_ = [("size", c_size_t), ("allocate", TAKE), ("release", GIVE), ("host", c_void_p)]

    def __init__(self, refused: Container[int] = ()) -> None:
        self.held, self.calls, self.refused = dict[int, int](), 0, refused
        libc = ctypes.CDLL(None)
        libc.malloc.argtypes, libc.malloc.restype, libc.free.argtypes = (
            [c_size_t],
            c_void_p,
            [c_void_p],
        )
        self._libc = libc
        super().__init__(ctypes.sizeof(Allocator), TAKE(self._take), GIVE(self._give), None)

    def _take(self, host: int, size: int) -> int | None:
        self.calls += 1
        if self.calls in self.refused:
            return None
        memory: int = self._libc.malloc(max(size, 1))
        self.held[memory] = size
        return memory

    def _give(self, host: int, memory: int, size: int) -> None:
        assert self.held.pop(memory) == size
        self._libc.free(memory)


class Outcome(Structure):
    _fields_ = [
        *(
            ("index", c_int),
            ("error", c_double),
            ("step", c_double),
            ("bits", c_int),
            ("recomputed", c_int),
        ),
        *(("zeros", c_int64), ("scaled", c_int)),
    ]


class Stream(Structure):
    _fields_ = [
        *(("status", c_int), ("message", c_char_p), ("bytes", c_void_p), ("size", c_size_t)),
        *((name, c_int64) for name in ("vertices", "faces")),
        *((name, POINTER(c_int32)) for name in ("vertex_order", "face_order")),
        *((name, c_int64) for name in ("merged", "loose", "collapsed", "moved")),
        *(("error", c_double), ("outcomes", POINTER(Outcome))),
    ]


@dataclass
class Encoded:
    status: int
    message: str
    data: bytes
    orders: tuple[Any, Any]
    counts: tuple[int, int, int, int]
    error: float
    errors: list[float]


def library(*flags: str) -> ctypes.CDLL:
    """The whole library, of one file."""
    made = loaded(compiled_whole(*flags))
    made.bsmenc_release.argtypes = [c_void_p]
    return made


def compiled_whole(*flags: str) -> Path:
    """A folder with decoder and encoder, compiled of one file."""
    files = amalgamated(encodes=True), interface()
    return compiled(
        "-ffp-contract=off", "-O1", "-DKERNEL_ONE_TARGET", *flags, files=files, encodes=True
    )


def encode(
    library: ctypes.CDLL, mesh: TriangleMesh, qualities: Any = (), **options: Any
) -> Encoded:
    """Encode a mesh; `qualities`: by the names of attributes, a word and an amount."""
    kept: list[Any] = [
        np.ascontiguousarray(mesh.positions),
        np.ascontiguousarray(mesh.faces, np.uint32),
    ]
    given = (Given * len(mesh.attributes))()
    for i, a in enumerate(mesh.attributes):
        indices = None if a.indices is None else np.ascontiguousarray(a.indices, np.uint32)
        way, amount = dict(qualities).get(a.name, ("default", 0.0))
        kept.append(indices)
        numbers = (
            DOMAINS.index(a.domain),
            SEMANTICS.index(a.semantic),
            KINDS.index(a.values.dtype.name),
        )
        at = None if indices is None else indices.ctypes.data
        shape = a.values.shape[1], len(a.values), a.values.ctypes.data, at
        given[i] = Given(a.name.encode(), *numbers, *shape, QUALITIES.index(way), amount)
    entries = (Entry * len(mesh.metadata))()
    for i, (name, value) in enumerate(mesh.metadata.items()):
        kind = 1 + [int, float, str, bytes].index(type(value))
        plain = value.encode() if isinstance(value, str) else value
        kept.append(ctypes.create_string_buffer(plain) if isinstance(plain, bytes) else None)
        at = ctypes.addressof(kept[-1]) if isinstance(plain, bytes) else None
        size = len(plain) if isinstance(plain, bytes) else 0
        both = value if kind == 1 else 0, value if kind == 2 else 0.0
        entries[i] = Entry(name.encode(), kind, *both, at, size)
    arrays = kept[0].ctypes.data, None, kept[1].ctypes.data, ctypes.addressof(given)
    frames = options.pop("frames", 0)  # whose positions follow each other
    sizes = len(kept[0]) // max(frames, 1), len(kept[1])
    whole = Mesh(
        ctypes.sizeof(Mesh),
        *sizes,
        *arrays,
        len(given),
        ctypes.addressof(entries),
        len(entries),
        frames,
    )
    chosen = Options(ctypes.sizeof(Options))
    for name, value in options.items():
        setattr(chosen, name, (c_double * 3)(*value) if name == "origin" else value)
    return run(library, whole, chosen, len(given))


def run(library: ctypes.CDLL, mesh: Mesh, options: Options, attributes: int = 0) -> Encoded:
    """Call bsmenc_encode, and copy the result."""
    found = POINTER(Stream)()
    status = library.bsmenc_encode(byref(mesh), byref(options), byref(found))
    if not found:
        return Encoded(status, "", b"", (None, None), (0, 0, 0, 0), 0.0, [])
    stream = found.contents
    data = ctypes.string_at(stream.bytes, stream.size) if stream.bytes else b""
    orders = (
        (stream.vertex_order[: stream.vertices], stream.face_order[: stream.faces])
        if data
        else (None, None)
    )
    counts = stream.merged, stream.loose, stream.collapsed, stream.moved
    errors = [stream.outcomes[i].error for i in range(attributes)] if data else []
    result = Encoded(status, stream.message.decode(), data, orders, counts, stream.error, errors)
    library.bsmenc_release(found)
    return result
