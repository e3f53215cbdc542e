"""Mesh files of any size, piece by piece: positions and faces as plain arrays on the disk."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError, LimitError, MeshError, TruncatedError
from bsm.console import Console
from bsm.files.formats.npz import NpzArray, opened_archive
from bsm.files.formats.obj import ObjPieces
from bsm.files.formats.ply import Element, parse_header
from bsm.files.mesh import format_of_bytes, format_of_name
from bsm.files.pipes import Input

Array: TypeAlias = npt.NDArray[Any]
Pieces: TypeAlias = Iterator[tuple[Array, Array]]  # some positions, shape (k, 3), and some faces, from anywhere on
LeftOut: TypeAlias = dict[str, None]  # names, in order
_KNOWN = ("x", "y", "z", "length", "corners")
ROWS = 1 << 18  # that are in memory at a time
_HEAD = 1 << 16
_TEXT = 1 << 23
_MOST_INDEX = (1 << 32) - 1
NO_FACES, NO_POSITIONS = np.zeros((0, 3), np.int64), np.zeros((0, 3))


@dataclass(frozen=True)
class Raw:
    """A mesh in two files, each a table of three columns."""

    positions: Path
    faces: Path
    kind: str
    vertices: int = 0
    triangles: int = 0
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    left_out: tuple[str, ...] = ()


def pieces_of(path: Path, kind: str) -> Iterator[Array]:
    """A table of three columns on the disk, from its beginning to its end."""
    with path.open("rb") as file:
        while len(piece := np.fromfile(file, kind, 3 * ROWS)):
            yield piece.reshape(-1, 3)


def read_big(name: str, file_format: str | None, folder: Path, console: Console) -> Raw:
    """Read a mesh of any size once; the memory is that of a piece."""
    given = Input(name)
    head = given.peek(_HEAD)
    kind = file_format or format_of_name(name) or format_of_bytes(head)
    if not head:
        raise FormatError("the file is empty")
    if kind not in _READERS:
        raise FormatError(f"tiles are made of binary PLY, binary STL, npz and OBJ files, not of {kind or 'such files'}")
    raw = Raw(folder / "positions", folder / "faces", "<f8")
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    vertices = triangles = largest = 0
    left_out: LeftOut = {}
    with (
        raw.positions.open("wb") as points,
        raw.faces.open("wb") as corners,
        closing(given),
        console.progress("reading"),
    ):
        for positions, faces in _READERS[kind](given, left_out):
            if not vertices and len(positions) and positions.dtype.itemsize == 4 and positions.dtype.kind == "f":
                raw = Raw(raw.positions, raw.faces, "<f4")
            if not np.isfinite(positions).all():
                row = vertices + int(np.argmin(np.isfinite(positions).all(axis=1)))
                raise MeshError(f"vertex {row} has a coordinate that is not finite; remove or repair it")
            if len(faces):
                if faces.dtype.kind not in "iu":
                    raise MeshError(f"faces must be integers, not {faces.dtype}")
                if faces.min() < 0:
                    raise MeshError(f"a face refers to vertex {faces.min()}, which there is not")
                largest = max(largest, int(faces.max()))
                if largest > _MOST_INDEX:
                    raise LimitError(f"a face refers to vertex {largest}; tiles are made of up to {_MOST_INDEX}")
                faces.astype("<u4").tofile(corners)
            if len(positions):
                low, high = np.minimum(low, positions.min(axis=0)), np.maximum(high, positions.max(axis=0))
                positions.astype(raw.kind).tofile(points)
            vertices, triangles = vertices + len(positions), triangles + len(faces)
    if not triangles:
        raise MeshError("the mesh has no faces; point clouds are not supported")
    if largest >= vertices:
        raise MeshError(f"a face refers to vertex {largest}, outside 0..{vertices - 1}")
    ends = tuple(map(float, low)), tuple(map(float, high))
    return Raw(raw.positions, raw.faces, raw.kind, vertices, triangles, *ends, tuple(left_out))


def _read_ply(given: Input, left_out: LeftOut) -> Pieces:
    header = parse_header(given.peek(_HEAD))
    if not header.order:
        raise FormatError("this PLY file is text; tiles are made of binary ones")
    given.read(header.size)
    if {"vertex", "face"} - {element.name for element in header.elements}:
        raise FormatError("the PLY file has no vertices, or no faces")
    for element in header.elements:
        kind = _row_of(element, header.order)
        left_out |= dict.fromkeys(name for name in kind.names or () if name not in _KNOWN)
        for first in range(0, element.count, ROWS):
            size = min(ROWS, element.count - first) * kind.itemsize
            data = given.read(size)
            if len(data) < size:
                raise TruncatedError(
                    f"the PLY file is cut short: {element.name} {first} and those behind it are missing"
                )
            rows = np.frombuffer(data, kind)
            if element.name == "vertex":
                yield np.stack([rows[axis] for axis in "xyz"], axis=1), NO_FACES
            elif element.name == "face":
                if (rows["length"] != 3).any():
                    raise MeshError("the faces are not all triangles; triangulate polygons first")
                yield NO_POSITIONS, rows["corners"]


def _row_of(element: Element, order: str) -> np.dtype[Any]:
    """A row as it stands in the file; a list is one of three corners."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for column in element.properties:
        if column.length is None:
            fields.append((column.name, order + column.type))
        elif element.name == "face" and column.name in ("vertex_indices", "vertex_index"):
            fields += [("length", order + column.length), ("corners", order + column.type, (3,))]
        else:
            raise FormatError(f"the list {column.name} of the PLY file cannot be skipped; leave it out")
    names = {field[0] for field in fields}
    needed = {"vertex": {"x", "y", "z"}, "face": {"corners"}}.get(element.name, set())
    if needed - names or len(names) < len(fields):
        raise FormatError(f"the element {element.name} of the PLY file lacks a property, or has it twice")
    return np.dtype(fields)


def _read_stl(given: Input, left_out: LeftOut) -> Pieces:
    head = given.peek(1024)
    if head.lstrip().startswith(b"solid") and b"facet" in head:
        raise FormatError("this STL file is text; tiles are made of binary ones")
    head = given.read(84)
    if len(head) < 84:
        raise FormatError("this is not an STL file: it is shorter than the header of one")
    count = int.from_bytes(head[80:], "little")
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    for first in range(0, count, ROWS):
        rows = min(ROWS, count - first)
        data = given.read(50 * rows)
        if len(data) < 50 * rows:
            raise TruncatedError(f"the STL file is cut short: triangle {first} and those behind it are missing")
        yield (
            np.frombuffer(data, record)["corners"].reshape(-1, 3),
            np.arange(3 * first, 3 * (first + rows)).reshape(-1, 3),
        )


def _read_npz(given: Input, left_out: LeftOut) -> Pieces:
    if not given.is_file:
        raise FormatError("an npz is read from a file of this machine only")
    with opened_archive(given.name) as archive:
        names = (name.removesuffix(".npy") for name in archive.namelist())
        left_out |= dict.fromkeys(name for name in names if name not in ("positions", "faces"))
        for name in ("positions", "faces"):
            with NpzArray(archive, name) as array:
                if len(array.shape) != 2 or array.shape[1] != 3:
                    raise MeshError(f"{name} must have shape (n, 3), not {array.shape}")
                for piece in array.pieces(ROWS):
                    yield (piece, NO_FACES) if name == "positions" else (NO_POSITIONS, piece)


def _read_obj(given: Input, left_out: LeftOut) -> Pieces:
    pieces, rest = ObjPieces(), b""
    while data := given.read(_TEXT):
        text, newline, rest = (rest + data).rpartition(b"\n")
        if not newline and len(rest) > _TEXT:
            raise FormatError("this is not an OBJ file: it has no lines")
        yield _triangles(*pieces.take(text))
    yield _triangles(*pieces.take(rest))
    left_out |= dict.fromkeys(sorted(pieces.left_out))


def _triangles(positions: Array, sizes: Array, corners: Array) -> tuple[Array, Array]:
    if (sizes < 3).any():
        raise MeshError("a face has fewer than three corners")
    starts = np.cumsum(sizes) - sizes
    owner = np.repeat(np.arange(len(sizes)), sizes - 2)
    turn = np.arange(len(owner)) - (np.cumsum(sizes - 2) - (sizes - 2))[owner]
    first = starts[owner]
    return positions, np.stack([corners[first], corners[first + turn + 1], corners[first + turn + 2]], axis=1)


_READERS = {"ply": _read_ply, "stl": _read_stl, "npz": _read_npz, "obj": _read_obj}
