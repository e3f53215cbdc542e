"""The frames of an npz sequence one after the other, without ever holding all of them."""

from __future__ import annotations

import lzma
import os
import zipfile
import zlib
from collections.abc import Iterator
from typing import IO, Any, BinaryIO, TypeAlias

import numpy as np
import numpy.typing as npt

from bitstream.errors import CorruptError, FormatError, MeshError
from codec.geometry.mesh import Positions

Archive: TypeAlias = "str | os.PathLike[str] | BinaryIO"
"""A path, or a seekable binary file."""

Array = npt.NDArray[Any]

_DAMAGE = (EOFError, OSError, zipfile.BadZipFile, zlib.error, lzma.LZMAError)


def npz_shape(archive: Archive) -> tuple[int, ...]:
    """Shape of the array `positions` of an npz, (T, n, 3) for a sequence.

    Raises
    ------
    FormatError
        If it is no npz, or has no such array.
    MeshError
        If the array holds no numbers, or is in Fortran's order, where frames are not one behind the other.
    CorruptError
        If its header cannot be read.
    """
    with _Array(archive, "positions") as positions:
        return positions.shape


def npz_faces(archive: Archive) -> Array:
    """The array `faces` of an npz; errors as `npz_shape`."""
    with _Array(archive, "faces") as faces:
        return faces.read(faces.shape)


def npz_frames(archive: Archive) -> Iterator[Positions]:
    """The frames of a sequence as float64 arrays, shape (n, 3), read as they are asked for; errors as `npz_shape`."""
    with _Array(archive, "positions") as positions:
        for _ in range(positions.shape[0]):
            yield positions.read(positions.shape[1:]).astype(np.float64)


class _Array:
    """An array of an npz, read from its beginning on."""

    def __init__(self, archive: Archive, name: str) -> None:
        self._name = name
        try:
            self._archive = zipfile.ZipFile(archive)
        except (zipfile.BadZipFile, NotImplementedError, UnicodeDecodeError) as error:
            raise FormatError(f"this is not an npz file: {error}") from error
        try:
            self._entry = self._archive.open(f"{name}.npy")
            self.shape, self._kind = self._header(self._entry)
        except BaseException as error:
            self._archive.close()
            if isinstance(error, KeyError):
                raise FormatError(f"the npz file has no array {name}; it needs positions and faces") from None
            if isinstance(error, (zipfile.BadZipFile, NotImplementedError, RuntimeError)):
                raise FormatError(f"this is not an npz file that can be read: {error}") from error
            raise

    def __enter__(self) -> _Array:
        return self

    def __exit__(self, *_: object) -> None:
        self._entry.close()
        self._archive.close()

    def read(self, shape: tuple[int, ...]) -> Array:
        """The next numbers, as many as make this shape."""
        size = int(np.prod(shape, dtype=object)) * self._kind.itemsize
        try:
            data = self._entry.read(size)
        except _DAMAGE as error:
            raise CorruptError(f"the array {self._name} cannot be read: {error}") from error
        if len(data) < size:
            raise CorruptError(f"the array {self._name} ends early: {len(data)} of {size} bytes are left for a frame")
        return np.frombuffer(data, self._kind).reshape(shape)

    def _header(self, entry: IO[bytes]) -> tuple[tuple[int, ...], np.dtype[Any]]:
        try:
            version = np.lib.format.read_magic(entry)
            read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
            shape, fortran, kind = read(entry)
        except (ValueError, *_DAMAGE) as error:
            raise CorruptError(f"the array {self._name} cannot be read: {error}") from error
        if kind.hasobject or kind.kind not in "iuf":
            raise MeshError(f"the array {self._name} holds {kind}, not numbers")
        if fortran:
            raise MeshError(f"the array {self._name} is in Fortran's order; save it with numpy.ascontiguousarray")
        if min(shape, default=0) < 0:
            raise CorruptError(f"the array {self._name} has the shape {shape}")
        return shape, kind
