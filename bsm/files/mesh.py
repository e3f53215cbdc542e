"""Mesh files: OBJ, OFF, PLY and STL through openmesh, and npz.

openmesh builds a half-edge mesh while it reads, and that costs what a codec must keep: it duplicates vertices at
non-manifold edges, drops faces with repeated corners, passes text through float32, and it hangs on (or crashes over)
PLY files that are damaged or hold NaN. So `bsm.files` first takes a census of each file and refuses what is no mesh;
openmesh reads the faces of what is sound; and where its vertices, faces or corners differ from the census, the faces
are taken from the file itself, with a note. Coordinates always come from the file, in double precision. Writing is
ours alone, because openmesh writes six digits and leaves faces out.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np

from bitstream.container.wire import MAGIC
from bitstream.errors import DependencyError, FormatError, LimitError, MeshError, OptionError
from bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.files.census import Census, Ints
from bsm.files.npz import read_arrays, write_npz
from bsm.files.obj import census_obj, write_obj
from bsm.files.off import census_off, write_off
from bsm.files.output import open_output
from bsm.files.pipes import read_chunks
from bsm.files.ply import census_ply, write_ply
from bsm.files.stl import census_stl, write_stl
from bsm.files.triangles import triangulate
from codec.geometry.mesh import TriangleMesh

_CENSUSES: dict[str, Callable[[bytes], Census]] = {
    "obj": census_obj,
    "off": census_off,
    "ply": census_ply,
    "stl": census_stl,
}
_WRITERS: dict[str, Callable[[TriangleMesh], bytes]] = {
    "npz": write_npz,
    "obj": write_obj,
    "off": write_off,
    "ply": write_ply,
    "stl": write_stl,
}
MESH_FORMATS = tuple(_WRITERS)
_MAX_BYTES = 1 << 32
# openmesh parses numbers as float32; in text it hangs on those that are none.
_SAFE_RANGE = (1e-37, 1e38)


@dataclass(frozen=True)
class MeshFile:
    """A mesh as its file has it, and what was changed on the way.

    Parameters
    ----------
    mesh : TriangleMesh
    notes : tuple of str
        One sentence for each thing the reader did to the file's content.
    """

    mesh: TriangleMesh
    notes: tuple[str, ...] = ()


def read_mesh(
    path: str | os.PathLike[str], file_format: str | None = None, limits: Limits = DEFAULT_LIMITS
) -> MeshFile:
    """Read a mesh file.

    Parameters
    ----------
    path : path
        "-" reads standard input.
    file_format : str, optional
        One of `MESH_FORMATS`; guessed from the name, or else from the first bytes.
    limits : Limits
        `vertices` and `faces` bound the mesh.

    Returns
    -------
    MeshFile
        Vertices and faces in the order of the file. Isolated vertices, degenerate and repeated faces are kept; polygons
        are cut into triangles.

    Raises
    ------
    FormatError, TruncatedError, MeshError, LimitError
        If the file holds no mesh of triangles or polygons over finite points.
    DependencyError
        If openmesh is needed and missing.
    OSError
        If the file cannot be read.
    """
    data = read_bytes(path)
    if not data:
        raise FormatError("the file is empty")
    if data.startswith(MAGIC):
        raise FormatError("this is a BSM stream, not a mesh file; decode it first")
    kind = file_format or format_of_name(path) or format_of_bytes(data)
    if kind == "npz":
        positions, faces = read_arrays(data, "positions", "faces")
        if positions.ndim == 3:
            raise MeshError(f"this npz file holds a sequence of {len(positions)} frames, not one mesh")
        limits.check("vertices", positions.size // 3)
        limits.check("faces", faces.size // 3)
        return MeshFile(TriangleMesh(positions, faces))
    if kind not in _CENSUSES:
        raise FormatError(f"this is not a mesh file that can be read; the formats are {', '.join(MESH_FORMATS)}")
    openmesh = import_openmesh()
    census = _CENSUSES[kind](data)
    limits.check("vertices", len(census.positions))
    limits.check("faces", int(np.maximum(census.sizes - 2, 0).sum()))
    return _mesh_of(census, lambda: _corners_by_openmesh(openmesh, census, path, data, kind))


def format_mesh(mesh: TriangleMesh, file_format: str) -> bytes:
    """The bytes of a mesh file of one of `MESH_FORMATS`, exact but for float32 where that suffices (STL always)."""
    return _WRITERS[file_format](mesh)


def write_mesh(path: str | os.PathLike[str], mesh: TriangleMesh, *, overwrite: bool = True) -> None:
    """Write a mesh file, as a whole or not at all, in the format of its name.

    Raises
    ------
    OptionError
        If the name tells no format.
    MeshError
        If the format cannot hold the mesh.
    OSError
        If the file cannot be written.
    """
    kind = format_of_name(path)
    if kind not in _WRITERS:
        raise OptionError(f"{path}: the name tells no mesh format; use one of .{', .'.join(MESH_FORMATS)}")
    with open_output(path, overwrite=overwrite) as file:
        file.write(format_mesh(mesh, kind))


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """The content of a file, or of standard input for "-"; `LimitError` beyond 4 GiB."""
    pieces: list[bytes] = []
    size = 0
    for piece in read_chunks(path):
        pieces.append(piece)
        size += len(piece)
        if size > _MAX_BYTES:
            raise LimitError(f"the file is larger than {_MAX_BYTES} bytes")
    return b"".join(pieces)


def format_of_name(path: str | os.PathLike[str]) -> str | None:
    """The format that a file name's suffix tells, or None."""
    suffix = Path(path).suffix[1:].lower()
    return suffix if suffix in _WRITERS else None


def format_of_bytes(data: bytes) -> str | None:
    """The format that the first bytes of a file tell, or None."""
    head = data[:1024].lstrip()
    if head.startswith(b"ply"):
        return "ply"
    if data.startswith(b"PK\x03\x04"):
        return "npz"
    if head.startswith(b"solid") or len(data) == 84 + 50 * int.from_bytes(data[80:84], "little"):
        return "stl"
    if b"OFF" in head[:8]:
        return "off"
    if re.search(rb"^\s*v[ \t]", data[: 1 << 16], re.MULTILINE):
        return "obj"
    return None


def import_openmesh() -> ModuleType:
    """The package openmesh; the one place that imports it."""
    try:
        import openmesh
    except ImportError as error:
        raise DependencyError(
            'OBJ, OFF, PLY and STL files are read with openmesh; run: pip install "bsm-codec[files]"'
        ) from error
    return openmesh


def _mesh_of(census: Census, by_openmesh: Callable[[], Ints | None]) -> MeshFile:
    positions, sizes = census.positions, census.sizes
    if len(sizes) == 0:
        raise MeshError("the file has no faces; point clouds are not supported")
    if not np.isfinite(positions).all():
        row = int(np.argmin(np.isfinite(positions).all(axis=1)))
        raise MeshError(f"vertex {row} has a coordinate that is not finite; remove or repair it")
    notes = list(census.notes)
    corners = by_openmesh()
    if corners is None:
        notes.append("openmesh cannot read the file as it is, so the faces were taken from its own text or bytes")
        corners = census.corners()
    outside = (corners < 0) | (corners >= len(positions))
    if outside.any():
        index = int(corners[np.argmax(outside)])
        raise MeshError(f"a face refers to vertex {index}, outside 0..{len(positions) - 1}")
    if (sizes < 3).any():
        notes.append(f"faces with fewer than three corners were left out: {int((sizes < 3).sum())}")
    if (sizes > 3).any():
        notes.append(f"polygons were cut into triangles: {int((sizes > 3).sum())}")
    triangles, folded = triangulate(positions, sizes, corners)
    if folded:
        notes.append(f"polygons so far from convex that their triangles overlap: {folded}")
    return MeshFile(TriangleMesh(positions, triangles.astype(np.int32)), tuple(notes))


def _corners_by_openmesh(
    openmesh: ModuleType, census: Census, path: str | os.PathLike[str], data: bytes, kind: str
) -> Ints | None:
    """The vertex indices of all faces as openmesh reads them; None unless it reads just what the file says."""
    if not census.plain or not _in_safe_range(census.positions):
        return None
    try:
        with _seekable(path, data, kind) as name, _native_stderr_closed():
            mesh = openmesh.read_polymesh(name)
            points = mesh.points()
            table = mesh.fv_indices() if mesh.n_faces() else np.empty((0, 3), dtype=np.int64)
    except (RuntimeError, MemoryError):
        return None
    present = table >= 0
    same = (
        len(points) == len(census.positions)
        and np.array_equal(present.sum(axis=1), census.sizes)
        and np.array_equal(points.astype(np.float32), census.positions.astype(np.float32))
    )
    return table[present].astype(np.int64) if same else None


def _in_safe_range(positions: np.ndarray) -> bool:
    size = np.abs(positions)
    return bool(((size == 0) | ((size >= _SAFE_RANGE[0]) & (size <= _SAFE_RANGE[1]))).all())


@contextmanager
def _seekable(path: str | os.PathLike[str], data: bytes, kind: str) -> Iterator[str]:
    """A name under which openmesh finds the file: its own, or that of a copy where it came through a pipe."""
    if Path(path).suffix.lower() == f".{kind}" and Path(path).is_file():
        yield os.fspath(path)
        return
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, f"mesh.{kind}")
        copy.write_bytes(data)
        yield str(copy)


@contextmanager
def _native_stderr_closed() -> Iterator[None]:
    """Keep openmesh, which prints a line for each edge it dislikes, from writing to the terminal."""
    sys.stderr.flush()
    saved = os.dup(2)
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(sink, 2)
        yield
    finally:
        os.dup2(saved, 2)
        os.close(saved)
        os.close(sink)
