"""npz: the arrays `positions` (of a mesh, or of a sequence of them) and `faces`, as numpy saves them."""

from __future__ import annotations

import io
import lzma
import os
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import BinaryIO, TypeAlias

import numpy as np

from bitstream.errors import BsmError, CorruptError, FormatError, LimitError, MeshError
from bsm.files.formats.npy import Array, read_header, size_of
from codec.arrays import Faces, Positions
from codec.geometry.mesh import TriangleMesh

Archive: TypeAlias = "str | os.PathLike[str] | BinaryIO"
"""A path, or a seekable binary file."""

_MAX_BYTES = 1 << 32
# A damaged archive may send zipfile to places before the beginning of the file: ValueError.
_NO_ARCHIVE = (zipfile.BadZipFile, NotImplementedError, RuntimeError, ValueError)
_DAMAGE = (EOFError, OSError, ValueError, zipfile.BadZipFile, zlib.error, lzma.LZMAError)


class NpzArray:
    """An array of an npz, read from its beginning on; the archive is open until the end of the `with` block.

    Raises
    ------
    FormatError
        If it is no npz, or has no such array.
    MeshError
        If the array does not hold numbers.
    CorruptError
        If it contradicts its own header; also while reading.
    """

    def __init__(self, archive: Archive, name: str) -> None:
        self._name = name
        try:
            self._archive = zipfile.ZipFile(archive)
        except _NO_ARCHIVE as error:
            raise FormatError(f"this is not an npz file: {error}") from error
        try:
            self._entry = self._archive.open(f"{name}.npy")
            self.shape, self._fortran, self._kind = read_header(self._entry)
        except BaseException as error:
            self._archive.close()
            if isinstance(error, BsmError):
                raise
            if isinstance(error, KeyError):
                raise FormatError(f"the npz file has no array {name}; it needs positions and faces") from None
            if isinstance(error, _DAMAGE):
                raise CorruptError(f"the array {name} cannot be read: {error}") from error
            if isinstance(error, _NO_ARCHIVE):
                raise FormatError(f"this is not an npz file that can be read: {error}") from error
            raise

    def __enter__(self) -> NpzArray:
        return self

    def __exit__(self, *_: object) -> None:
        self._entry.close()
        self._archive.close()

    @property
    def others(self) -> list[str]:
        """The names of all arrays of the archive."""
        return [name.removesuffix(".npy") for name in self._archive.namelist()]

    def whole(self) -> Array:
        """All numbers; `LimitError` beyond 4 GiB. Nothing is allocated for what is only claimed."""
        size = size_of(self.shape, self._kind)
        if size > _MAX_BYTES:
            raise LimitError(f"the array {self._name} takes {size} bytes; the limit is {_MAX_BYTES}")
        data = self._read(size + 1)
        if len(data) != size:
            raise CorruptError(f"the array {self._name} should take {size} bytes, not {len(data)}")
        return np.frombuffer(data, self._kind).reshape(self.shape, order="F" if self._fortran else "C")

    def frames(self) -> Iterator[Positions]:
        """The first index' parts one after the other, as float64, without ever holding all of them."""
        if self._fortran:
            raise MeshError(f"the array {self._name} is in Fortran's order; save it with numpy.ascontiguousarray")
        size = size_of(self.shape[1:], self._kind)
        for number in range(self.shape[0]):
            data = self._read(size)
            if len(data) < size:
                raise CorruptError(f"the array {self._name} ends early, in frame {number} of {self.shape[0]}")
            yield np.frombuffer(data, self._kind).reshape(self.shape[1:]).astype(np.float64)

    def _read(self, size: int) -> bytes:
        try:
            return self._entry.read(size)
        except _DAMAGE as error:
            raise CorruptError(f"the array {self._name} cannot be read: {error}") from error


def npz_shape(archive: Archive) -> tuple[int, ...]:
    """Shape of the array `positions`, (T, n, 3) for a sequence; errors as those of `NpzArray`."""
    with NpzArray(archive, "positions") as positions:
        return positions.shape


def npz_frames(archive: Archive) -> Iterator[Positions]:
    """The frames of a sequence, shape (n, 3), read as they are asked for; errors as those of `NpzArray`."""
    with NpzArray(archive, "positions") as positions:
        yield from positions.frames()


def read_arrays(archive: Archive, *names: str) -> tuple[Array, ...]:
    """The arrays called `names`; errors as those of `NpzArray`, and `LimitError` beyond 4 GiB."""
    found = []
    for name in names:
        with NpzArray(archive, name) as array:
            found.append(array.whole())
    return tuple(found)


def other_arrays(archive: Archive) -> tuple[str, ...]:
    """The names of the arrays that neither a mesh nor a sequence needs."""
    with NpzArray(archive, "positions") as positions:
        return tuple(name for name in positions.others if name not in ("positions", "faces"))


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
    taken = 0

    def write(frame: Positions) -> None:
        nonlocal taken
        if taken == 0:
            header = {"descr": "<f8", "fortran_order": False, "shape": (count, *frame.shape)}
            np.lib.format.write_array_header_1_0(entry, header)
        entry.write(np.ascontiguousarray(frame, "<f8").tobytes())
        taken += 1

    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        with archive.open("faces.npy", "w") as entry:
            np.lib.format.write_array(entry, faces)
        known = count > 0
        if not known:
            yield kept.append
            count = len(kept)
        with archive.open("positions.npy", "w", force_zip64=True) as entry:
            for frame in kept:
                write(frame)
            if known:
                yield write
            if taken != count:
                raise CorruptError(f"{taken} of {count} frames came")
