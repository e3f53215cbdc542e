"""npz: the arrays `positions` and `faces`, as numpy saves them."""

from __future__ import annotations

import io
import lzma
import zipfile
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

from bitstream.errors import CorruptError, FormatError, LimitError, MeshError
from codec.mesh import TriangleMesh

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
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError) as error:
        raise FormatError(f"this is not an npz file: {error}") from error


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
