"""Sequences in files and pipes: frames that share their faces, read and written one at a time.

Forms: an npz with `positions` of shape (T, n, 3) and `faces`; mesh files, one for each frame, in a folder or named by
a pattern (``run/*.obj``), taken in the order of the numbers in their names; and, for live pipes, npy arrays one behind
the other: the faces, then the positions of each frame as it comes.
"""

from __future__ import annotations

import glob
import io
import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError, OptionError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.npy import NPY, read_npy, write_npy
from bsm.files.formats.npz import Archive, npz_frames, npz_shape, open_npz_sequence, read_arrays
from bsm.files.mesh import MESH_FORMATS, format_mesh, format_of_name, read_mesh
from bsm.files.output import open_output
from bsm.files.pipes import Input, Source, as_input, is_pipe
from bsm.files.remote import is_url

ZIP = b"PK\x03\x04"
SEQUENCE_FORMATS = ("npz", "npy", *(name for name in MESH_FORMATS if name != "npz"))
"""What `bsm decode` can make of a sequence: an npz, a pipe of npy arrays, or a folder of mesh files."""


@dataclass(frozen=True, eq=False)
class Frames:
    """A sequence that is read as it is used.

    Parameters
    ----------
    faces : int32 array, shape (m, 3)
    count : int
        Number of frames; 0 if that is not known beforehand.
    frames : iterator of float64 arrays, shape (n, 3)
        Can be used once.
    attributes : tuple of Attribute
        Those of the first frame that the last has, too; no normals, which move.
    notes : tuple of str
        What was left out.
    """

    faces: Faces
    count: int
    frames: Iterator[Positions]
    attributes: tuple[Attribute, ...] = ()
    notes: tuple[str, ...] = ()


def open_sequence(source: Source, file_format: str | None = None, reader: str | None = None) -> Frames | None:
    """The sequence that `source` names, or None if it is not one but perhaps a mesh.

    Nothing is taken from an `Input` that is none; the path of a pipe is not looked at, unless `file_format` is "npy".

    Parameters
    ----------
    source : path, buffer or binary file
        A path may be that of a folder, a pattern, or "-" for standard input.
    file_format : str, optional
        Of the file or of the frames' files.
    reader : str, optional
        Of the frames' files, see `read_mesh`.

    Raises
    ------
    FormatError, MeshError, TruncatedError
        If it is one, but cannot be read; also later, while the frames are read.
    """
    if is_pipe(source) and file_format != "npy":
        return None
    given = as_input(source)
    if not is_url(given.name) and _names_many(given.name):
        return _files(_frame_files(given.name), file_format, reader)
    if file_format not in (None, "npz", "npy"):
        return None
    head = given.peek(len(NPY))
    if head == NPY or file_format == "npy":
        return _arrays(given)
    if not head.startswith(ZIP) or (file_format is None and Path(given.name).suffix.lower() not in ("", ".npz")):
        return None  # a 3MF is a ZIP, too
    archive: Archive = given.name if given.is_file else io.BytesIO(given.peek(1 << 32))
    shape = npz_shape(archive)
    if len(shape) != 3:
        return None
    if shape[0] == 0:
        raise MeshError("this npz file holds a sequence without frames")
    (faces,) = read_arrays(archive, "faces")
    mesh = TriangleMesh(next(npz_frames(archive)), faces)
    return Frames(mesh.faces, shape[0], npz_frames(archive))


def separate_meshes(path: str, file_format: str | None = None, reader: str | None = None) -> list[str]:
    """The mesh files of a folder or pattern if they are meshes by themselves: one, or the last has other faces than
    the first; none if they are the frames of a sequence, or the path is that of a file.
    """
    if is_pipe(path) or is_url(path) or not _names_many(path):
        return []
    names = _frame_files(path)
    if len(names) > 1:
        first, last = (read_mesh(name, file_format, reader=reader).mesh for name in (names[0], names[-1]))
        if first.positions.shape == last.positions.shape and np.array_equal(first.faces, last.faces):
            return []
    return names


@contextmanager
def sequence_writer(
    path: str,
    kind: str,
    faces: Faces,
    count: int,
    *,
    overwrite: bool,
    attributes: Callable[[], tuple[Attribute, ...]] = tuple,
) -> Iterator[Callable[[Positions], None]]:
    """Open a sequence for writing; yields what takes frame after frame.

    Parameters
    ----------
    path : str
        A file for "npz" and "npy" ("-" is standard output), otherwise a folder, which is made.
    kind : str
        One of `SEQUENCE_FORMATS`.
    count : int
        Number of frames, if known; an npz whose length is not known is put together in memory.
    attributes : callable
        Those of all frames, asked for with each; npz and npy hold none.
    """
    if kind == "npz":
        with open_output(path, overwrite=overwrite) as file, open_npz_sequence(file, faces, count) as write:
            yield write
    elif kind == "npy":
        with open_output(path, overwrite=overwrite) as file:
            write_npy(file, faces)
            yield lambda frame: write_npy(file, frame)
    else:
        if is_url(path):
            raise OptionError(f"{path}: frames are written to a folder of this machine, or as an npz")
        folder = Path(path)
        folder.mkdir(parents=True, exist_ok=True)
        if any(folder.iterdir()) and not overwrite:
            raise FileExistsError(17, "the folder is not empty; -f writes into it", path)
        numbers = iter(range(sys.maxsize))
        yield lambda frame: _write_frame(
            folder / f"{next(numbers):05d}.{kind}", TriangleMesh(frame, faces, attributes()), kind
        )


def _names_many(path: str) -> bool:
    return os.path.isdir(path) or (glob.has_magic(path) and not os.path.exists(path))


def _write_frame(path: Path, mesh: TriangleMesh, kind: str) -> None:
    with open_output(path, overwrite=True) as file:
        file.write(format_mesh(mesh, kind))


def _frame_files(path: str) -> list[str]:
    """The mesh files of a folder or pattern, by the numbers in their names."""
    names = [os.path.join(path, name) for name in os.listdir(path)] if Path(path).is_dir() else glob.glob(path)
    found = [name for name in names if format_of_name(name)]
    if not found:
        raise FormatError(f"there are no mesh files in {path}; the formats are {', '.join(MESH_FORMATS)}")
    return sorted(found, key=lambda name: [int(p) if p.isdigit() else p for p in re.split(r"(\d+)", name)])


def _files(names: list[str], file_format: str | None, reader: str | None) -> Frames:
    first = read_mesh(names[0], file_format, reader=reader).mesh

    def frames() -> Iterator[Positions]:
        yield first.positions
        for number, name in enumerate(names[1:], 1):
            mesh = read_mesh(name, file_format, reader=reader).mesh
            if mesh.positions.shape != first.positions.shape or not np.array_equal(mesh.faces, first.faces):
                raise MeshError(
                    f"these are different meshes, not the frames of one animation: {name} (frame {number}) has other "
                    f"faces than {names[0]}; to work on each by itself, name the files and write to a folder, "
                    "-o FOLDER/"
                )
            yield mesh.positions

    last = read_mesh(names[-1], file_format, reader=reader).mesh if first.attributes and len(names) > 1 else first
    kept = tuple(one for one in first.attributes if one.semantic != "normal" and _has(last, one))
    moving = [one.name for one in first.attributes if one not in kept]
    notes = [f"left out, for they move or change: {', '.join(moving)}"] if moving else []
    if kept and len(names) > 1:
        notes.append(f"{', '.join(one.name for one in kept)}: as the first frame has them")
    return Frames(first.faces, len(names), frames(), kept, tuple(notes))


def _has(mesh: TriangleMesh, attribute: Attribute) -> bool:
    """Whether a mesh has the same attribute with the same values."""
    for one in mesh.attributes:
        if (one.name, one.domain, one.semantic) == (attribute.name, attribute.domain, attribute.semantic):
            alike = np.array_equal(one.values, attribute.values) and one.values.dtype == attribute.values.dtype
            if one.indices is None or attribute.indices is None:
                return alike
            return alike and np.array_equal(one.indices, attribute.indices)
    return False


def _arrays(given: Input) -> Frames:
    """npy arrays, one behind the other: faces, frame, frame, ..."""
    with ExitStack() as unread:
        unread.callback(given.close)
        faces = read_npy(given)
        if faces is None or faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu":
            raise FormatError("the first array must be the faces: integers of shape (m, 3)")
        unread.pop_all()

    def frames() -> Iterator[Positions]:
        with closing(given):
            while (frame := read_npy(given)) is not None:
                if frame.ndim != 2 or frame.shape[1] != 3:
                    raise FormatError(
                        f"an array of {frame.dtype} and shape {frame.shape} is no frame; (n, 3) numbers are"
                    )
                yield frame.astype(np.float64)

    return Frames(faces.astype(np.int32), 0, frames())


def sequence_kind(path: str, file_format: str | None) -> str:
    """The form in which a sequence is written: as asked for, or as the name tells.

    Raises
    ------
    OptionError
        If a single mesh file is named.
    """
    if path == "-":
        kind = file_format or "npy"
        if kind not in ("npz", "npy"):
            raise OptionError("a sequence goes to standard output as npy or npz")
        return kind
    suffix = Path(path).suffix[1:].lower()
    if suffix in ("npz", "npy"):
        if file_format not in (None, suffix):
            raise OptionError(f"{path}: the name does not go with --format {file_format}")
        return suffix
    if suffix in MESH_FORMATS:
        raise OptionError(f"{path}: this is a sequence; write it to an npz, or to a folder of mesh files")
    return file_format or "ply"
