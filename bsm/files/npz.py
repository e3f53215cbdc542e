"""npz: the arrays `positions` (of a mesh, or of a sequence of them) and `faces`, as numpy saves them."""

from __future__ import annotations

import io
import lzma
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import IO, Any, BinaryIO

import numpy as np
import numpy.typing as npt

from bitstream.errors import CorruptError, FormatError, LimitError, MeshError
from codec.geometry.mesh import Faces, Positions, TriangleMesh

ARRAYS = ("positions", "faces")
"""What a mesh and a sequence are made of."""

_MAX_BYTES = 1 << 32


def read_arrays(data: bytes, *names: str) -> tuple[npt.NDArray[Any], ...]:
    """The arrays called `names` of an npz; never unpickles, never allocates more than the archive declares.

    Raises
    ------
    FormatError
        If it is no npz, or lacks one of the arrays.
    CorruptError
        If an array contradicts its own header.
    LimitError
        If an array takes more than 4 GiB.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return tuple(_read_array(archive, name) for name in names)
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, UnicodeDecodeError) as error:
        raise FormatError(f"this is not an npz file: {error}") from error


def array_names(data: bytes) -> list[str]:
    """The names of all arrays of an npz that `read_arrays` has read from."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return [name.removesuffix(".npy") for name in archive.namelist()]


def _read_array(archive: zipfile.ZipFile, name: str) -> npt.NDArray[Any]:
    try:
        entry = archive.getinfo(f"{name}.npy")
    except KeyError:
        raise FormatError(f"the npz file has no array {name}; it needs positions and faces") from None
    if entry.file_size > _MAX_BYTES:
        raise LimitError(f"the array {name} takes {entry.file_size} bytes; the limit is {_MAX_BYTES}")
    try:
        with archive.open(entry) as file:
            version = np.lib.format.read_magic(file)
            read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
            shape, fortran, kind = read(file)
            body = file.read()
    except (ValueError, EOFError, OSError, zipfile.BadZipFile, zlib.error, lzma.LZMAError) as error:
        raise CorruptError(f"the array {name} cannot be read: {error}") from error
    if kind.hasobject or kind.kind not in "iuf":
        raise MeshError(f"the array {name} holds {kind}, not numbers")
    count = int(np.prod([int(side) for side in shape], dtype=object))
    if min(shape, default=0) < 0 or len(body) != count * kind.itemsize:
        raise CorruptError(f"the array {name} should take {count * kind.itemsize} bytes, not {len(body)}")
    return np.frombuffer(body, kind).reshape(shape, order="F" if fortran else "C")


def write_npz(mesh: TriangleMesh) -> bytes:
    """The npz of a mesh: `positions` as float64, `faces` as int32."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, positions=mesh.positions, faces=mesh.faces)
    return buffer.getvalue()


@contextmanager
def open_npz_sequence(file: BinaryIO, faces: Faces, count: int) -> Iterator[Callable[[Positions], None]]:
    """Write an npz of `positions`, shape (T, n, 3), and `faces`; yields what takes frame after frame.

    With `count` > 0 frames, as many must come, and none is kept in memory; with 0, all are.
    """
    kept: list[Positions] = []
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        with archive.open("faces.npy", "w") as entry:
            np.lib.format.write_array(entry, faces)
        if count:
            with archive.open("positions.npy", "w", force_zip64=True) as entry:
                taken = _FrameEntry(entry, count)
                yield taken.write
                taken.finish()
        else:
            yield kept.append
            with archive.open("positions.npy", "w", force_zip64=True) as entry:
                np.lib.format.write_array(entry, np.array(kept))


class _FrameEntry:
    """The array `positions` of an npz that is being written."""

    def __init__(self, entry: IO[bytes], count: int) -> None:
        self._entry = entry
        self._count = count
        self._taken = 0

    def write(self, frame: Positions) -> None:
        """Append one frame; the first one tells the number of vertices."""
        if self._taken == 0:
            header = {"descr": "<f8", "fortran_order": False, "shape": (self._count, *frame.shape)}
            np.lib.format.write_array_header_1_0(self._entry, header)
        self._entry.write(np.ascontiguousarray(frame, "<f8").tobytes())
        self._taken += 1

    def finish(self) -> None:
        """Check that all frames came."""
        if self._taken != self._count:
            raise CorruptError(f"{self._taken} of {self._count} frames came")
