"""bsmdec by ctypes: what a stream decodes to, or the status of its error."""

import ctypes
import hashlib
import subprocess
import tarfile
from collections.abc import Callable
from ctypes import (
    CFUNCTYPE,
    POINTER,
    Structure,
    byref,
    c_char,
    c_char_p,
    c_double,
    c_int,
    c_int64,
    c_size_t,
    c_void_p,
)
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from tools.amalgamate import ROOT, amalgamated, interface

FLAGS = ("-std=gnu11", "-O2", "-fPIC", "-shared")
QUICKLY = ("-O1", "-DKERNEL_ONE_TARGET")
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Werror")
(
    HEADER,
    METADATA,
    CONNECTIVITY,
    BLOCK,
    REFINEMENT,
    ATTRIBUTE,
    FRAME,
    LOSS,
    END,
    END_OF_STREAM,
    ERROR,
) = range(1, 12)
SEMANTICS, DOMAINS = ("generic", "color", "normal", "texcoord"), ("vertex", "corner", "face")
KINDS = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")


class Event(Structure):
    _fields_ = [
        ("type", c_int),
        *((name, c_int64) for name in ("index", "count", "vertices", "faces", "frames")),
    ]


class Failure(Structure):
    _fields_ = [
        ("status", c_int),
        ("offset", c_int64),
        ("frame", c_int64),
        ("block", c_int64),
        ("message", c_char * 160),
        ("limit", c_char_p),
        ("value", c_double),
    ]


class Shape(Structure):
    _fields_ = [
        ("name", c_char_p),
        *((name, c_int) for name in ("domain", "semantic", "kind", "components")),
        ("rows", c_int64),
        ("indices", c_int64),
        ("moves", c_int),
    ]


class Entry(Structure):
    """An entry of metadata."""

    _fields_ = [
        *(("name", c_char_p), ("type", c_int), ("whole", c_int64)),
        *(("number", c_double), ("bytes", c_void_p), ("size", c_size_t)),
    ]

    @property
    def value(self) -> int | float | str | bytes:
        data = ctypes.string_at(self.bytes, self.size) if self.bytes else b""
        return (self.whole, self.number, data.decode() if self.type == 3 else "", data)[
            self.type - 1
        ]


_TASK = CFUNCTYPE(None, c_void_p, c_int)
_RUN = CFUNCTYPE(None, c_void_p, c_int, _TASK, c_void_p)


class Parallel(Structure):
    """Runs tasks in threads, and counts them."""

    _fields_ = [("size", c_size_t), ("run", _RUN), ("host", c_void_p), ("threads", c_int64)]

    def __init__(self, threads: int) -> None:
        self.tasks = 0
        super().__init__(ctypes.sizeof(Parallel), _RUN(self._run), None, threads)

    def _run(self, host: int, count: int, task: Callable[[int, int], None], context: int) -> None:
        self.tasks += count
        workers = [Thread(target=task, args=(context, index)) for index in reversed(range(count))]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()


class Limits(Structure):
    _fields_ = [("size", c_size_t), ("bounds", c_double * 22), ("later", c_double)]


class Options(Structure):
    _fields_ = [
        *(("size", c_size_t), ("limits", c_void_p), ("allocator", c_void_p)),
        *(("tolerant", c_int), ("start", c_int64), ("fields", c_void_p)),
        *((name, c_size_t) for name in ("field_count", "stride", "index_size")),
        ("parallel", c_void_p),
        ("layers", c_int64),
    ]

    def __init__(
        self,
        limits: int | None = None,
        allocator: int | None = None,
        tolerant: bool = False,
        start: int = 0,
        parallel: int | None = None,
    ) -> None:
        super().__init__(
            ctypes.sizeof(Options), limits, allocator, tolerant, start, parallel=parallel
        )


class ReleasedOptions(Structure):
    """Options of release 1.0."""

    _fields_ = [
        ("limits", c_void_p),
        ("allocator", c_void_p),
        ("tolerant", c_int),
        ("start", c_int64),
    ]


@dataclass
class Decoded:
    """What came of a stream: arrays by name, or a status that is not 0."""

    status: int = 0
    message: str = ""
    arrays: dict[str, npt.NDArray[Any]] = field(default_factory=dict)
    losses: int = 0
    moving: set[str] = field(default_factory=set)
    lost: list[tuple[int, int]] = field(default_factory=list)
    frames: list[tuple[int, npt.NDArray[Any] | None]] = field(default_factory=list)
    shown: list[dict[str, npt.NDArray[Any]]] = field(default_factory=list)
    runs: list[tuple[int, int, npt.NDArray[Any]]] = field(default_factory=list)


def compiled(
    *flags: str, compiler: str = "cc", files: tuple[str, str] | None = None, encodes: bool = False
) -> Path:
    """A folder with bsmdec.c, bsmdec.h and bsmdec.so, compiled once of these files and flags (QUICKLY, if none)."""
    source, header = files or (amalgamated(), interface())
    command = [
        compiler,
        *FLAGS,
        *(WARNINGS if files is None or encodes else ["-w"]),
        *(flags or QUICKLY),
    ]
    name = hashlib.sha256(
        "\0".join([source, header, interface(encodes=True) * encodes, *command]).encode()
    ).hexdigest()[:16]
    folder = ROOT / "build" / "bsmdec" / name
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl = pytest.importorskip("fcntl", reason="the library is compiled for ctypes on POSIX")
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "bsmdec.so").exists():
            (folder / "bsmdec.c").write_text(source)
            (folder / "bsmdec.h").write_text(header)
            if encodes:
                (folder / "bsmenc.h").write_text(interface(encodes=True))
            subprocess.run([*command, "bsmdec.c", "-o", "part.so", "-lm"], check=True, cwd=folder)
            (folder / "part.so").rename(folder / "bsmdec.so")
    return folder


def build(*flags: str, compiler: str = "cc", files: tuple[str, str] | None = None) -> ctypes.CDLL:
    """The library, compiled from one file, of this source and header if they are given."""
    return loaded(compiled(*flags, compiler=compiler, files=files))


def loaded(folder: Path) -> ctypes.CDLL:
    """What was compiled there, with the types of its functions."""
    library = ctypes.CDLL(str(folder / "bsmdec.so"))
    library.bsmdec_open.restype = c_void_p
    library.bsmdec_last_error.restype = POINTER(Failure)
    if hasattr(library, "bsmdec_last_misuse"):
        library.bsmdec_last_misuse.argtypes, library.bsmdec_last_misuse.restype = (
            [c_void_p],
            c_char_p,
        )
    names = "close push finish next faces positions last_error"
    for name in (
        *names.split(),
        "metadata_at",
        *(f"attribute_{name}" for name in ("count", "at", "values", "indices")),
    ):
        getattr(library, f"bsmdec_{name}").argtypes = {
            "push": [c_void_p, c_char_p, c_size_t],
            "next": [c_void_p, POINTER(Event)],
            "faces": [c_void_p, c_void_p, c_size_t],
            "positions": [c_void_p, c_void_p, c_size_t],
            "metadata_at": [c_void_p, c_int64, POINTER(Entry)],
            "attribute_at": [c_void_p, c_int, POINTER(Shape)],
            "attribute_values": [c_void_p, c_int, c_void_p, c_size_t],
            "attribute_indices": [c_void_p, c_int, c_void_p, c_size_t],
        }.get(name, [c_void_p])
    return library


@cache
def released() -> ctypes.CDLL:
    """The decoder of release 1.0: a second opinion on streams, also damaged ones."""
    with tarfile.open(ROOT / "tests/spec/bsmdec-1.0.tar.xz") as tar:
        texts = [tar.extractfile(name) for name in ("bsmdec.c", "bsmdec.h")]
        source, header = (text.read().decode() for text in texts if text is not None)
    library = build("-O1", "-DKERNEL_ONE_TARGET", files=(source, header))
    setattr(library, "is_released", True)  # noqa: B010
    return library


def decode(
    library: ctypes.CDLL,
    stream: bytes,
    *,
    tolerant: bool = False,
    pieces: int = 0,
    start: int = 0,
    parallel: Parallel | None = None,
) -> Decoded:
    """Decode a stream, given at once or in pieces of `size` bytes."""
    threads = ctypes.addressof(parallel) if parallel else None
    released = getattr(library, "is_released", False)
    common = (None, None, tolerant, start)
    options = ReleasedOptions(*common) if released else Options(*common, threads)
    decoder = library.bsmdec_open(byref(options))
    try:
        found, event = Decoded(), Event()
        for begin in range(0, len(stream), pieces or max(len(stream), 1)):
            piece = stream[begin : begin + (pieces or len(stream))]
            library.bsmdec_push(decoder, piece, len(piece))
            while pieces and library.bsmdec_next(decoder, byref(event)) == 0 and event.type != 0:
                _take(library, decoder, event, found)
        library.bsmdec_finish(decoder)
        while library.bsmdec_next(decoder, byref(event)) == 0 and event.type not in (
            0,
            END_OF_STREAM,
        ):
            _take(library, decoder, event, found)
        error = library.bsmdec_last_error(decoder).contents
        found.status, found.message = error.status, error.message.decode()
        return found
    finally:
        library.bsmdec_close(decoder)


def _take(library: ctypes.CDLL, decoder: Any, event: Event, found: Decoded) -> None:
    if event.type == LOSS:
        found.losses += 1
        found.lost += [(event.index, event.count)] if event.count else []
    if event.type == CONNECTIVITY:
        found.runs.append((len(found.frames), event.vertices, _faces(library, decoder, event)))
        found.shown.clear()
    if event.type == FRAME:
        found.frames.append((event.index, _positions(library, decoder, event)))
        found.shown.append(_attributes(library, decoder, found))
    if event.type == END:
        found.arrays = _attributes(library, decoder, found)
        if not found.frames and (positions := _positions(library, decoder, event)) is not None:
            found.arrays |= {"positions": positions, "faces": _faces(library, decoder, event)}


def of_sequence(found: Decoded) -> dict[str, npt.NDArray[Any]]:
    """The arrays of all frames of a sequence, as the vectors have them."""
    arrays = dict(found.arrays)
    for key in arrays:
        each = [shown[key] for shown in found.shown]
        if each and key in found.moving:
            arrays[key] = np.array(each)
    frames = [positions for _, positions in found.frames if positions is not None]
    if len(found.runs) == 1:
        return arrays | {
            "positions": np.array(frames).reshape(-1, found.runs[0][1], 3),
            "faces": found.runs[0][2],
        }
    runs = np.array(
        [(first, vertices, len(faces)) for first, vertices, faces in found.runs], np.int32
    )
    faces = np.concatenate([faces for *_, faces in found.runs])
    return arrays | {
        "positions": np.concatenate([np.zeros((0, 3)), *frames]),
        "faces": faces,
        "runs": runs,
    }


def _positions(library: ctypes.CDLL, decoder: Any, event: Event) -> npt.NDArray[np.float64] | None:
    positions = np.zeros((event.vertices, 3))
    return (
        None
        if library.bsmdec_positions(decoder, positions.ctypes.data, positions.size)
        else positions
    )


def _faces(library: ctypes.CDLL, decoder: Any, event: Event) -> npt.NDArray[np.int32]:
    faces = np.zeros((event.faces, 3), np.uint32)
    assert library.bsmdec_faces(decoder, faces.ctypes.data, faces.size) == 0
    return faces.astype(np.int32)


def _attributes(library: ctypes.CDLL, decoder: Any, found: Decoded) -> dict[str, npt.NDArray[Any]]:
    arrays: dict[str, npt.NDArray[Any]] = {}
    shape, number = Shape(), 0
    for index in range(library.bsmdec_attribute_count(decoder)):
        if library.bsmdec_attribute_at(decoder, index, byref(shape)) != 0:
            continue
        values = np.zeros((shape.rows, shape.components), KINDS[shape.kind])
        assert (
            library.bsmdec_attribute_values(decoder, index, values.ctypes.data, values.nbytes) == 0
        )
        label = f"{SEMANTICS[shape.semantic]} {DOMAINS[shape.domain]} {shape.name.decode()}"
        arrays[f"attribute {number} {label}"] = values
        found.moving |= {f"attribute {number} {label}"} if shape.moves else set()
        if shape.indices:
            indices = np.zeros((shape.indices // 3, 3), np.uint32)
            assert (
                library.bsmdec_attribute_indices(decoder, index, indices.ctypes.data, indices.size)
                == 0
            )
            arrays[f"indices {number}"] = indices.astype(np.int32)
        number += 1
    return arrays
