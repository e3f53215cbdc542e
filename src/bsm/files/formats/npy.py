"""npy: one array behind a header, alone or, on a pipe, one behind the other."""

from __future__ import annotations

import io
from tokenize import TokenError
from typing import IO, Any, BinaryIO, Protocol

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import CorruptError, FormatError, MeshError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

# What numpy raises of a header, which it parses as Python.
_NO_HEADER = (ValueError, TypeError, KeyError, SyntaxError, RecursionError, MemoryError, OverflowError, TokenError)
NPY = b"\x93NUMPY"
Array = npt.NDArray[Any]
Kind = np.dtype[Any]


class Readable(Protocol):
    """What arrays are read from."""

    def read(self, size: int = ..., /) -> bytes:
        """The next bytes, as many as asked for unless the end comes before."""


def read_header(file: Readable | IO[bytes]) -> tuple[tuple[int, ...], bool, Kind]:
    """Shape, whether the order is Fortran's, and type of an array of numbers; nothing is unpickled."""
    try:
        version = np.lib.format.read_magic(file)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, fortran, kind = read(file)
    except _NO_HEADER as error:
        raise CorruptError(f"there is no legal npy header: {error}") from error
    if kind.hasobject or kind.kind not in "iuf":
        raise MeshError(f"an array of {kind} does not hold numbers")
    if min(shape, default=0) < 0:
        raise CorruptError(f"an array has the shape {shape}")
    return shape, fortran, kind


def size_of(shape: tuple[int, ...], kind: Kind) -> int:
    """Bytes of an array."""
    return int(np.prod([int(side) for side in shape], dtype=object)) * kind.itemsize


def read_npy(file: Readable, bound: str = "vertices", limits: Limits = DEFAULT_LIMITS) -> Array | None:
    """The next table of three columns of a pipe, or None at its end; the limit called `bound` is that of its rows."""
    magic = file.read(len(NPY))
    if not magic:
        return None
    if magic != NPY:
        raise FormatError("this is not a sequence of npy arrays")
    # The header declares its own length, in two bytes in version 1 and in four in those after it.
    version = file.read(2)
    length = file.read(2 if version[:1] == b"\1" else 4)
    declared = int.from_bytes(length, "little")
    text = file.read(min(declared, 1 << 16))
    if not length or len(text) < declared:
        raise TruncatedError("an npy array ends in its header")
    shape, fortran, kind = read_header(io.BytesIO(magic + version + length + text))
    if len(shape) != 2 or shape[1] != 3:
        raise FormatError(f"an array of {kind} and shape {shape} is neither faces nor a frame: (n, 3) numbers are")
    limits.check(bound, shape[0])
    size = size_of(shape, kind)
    data = file.read(size)
    if len(data) < size:
        raise TruncatedError(f"an npy array has {len(data)} of {size} bytes")
    return np.frombuffer(data, kind).reshape(shape, order="F" if fortran else "C")


def write_npy(file: BinaryIO, array: Array) -> None:
    """Write an array so that whoever reads a pipe has it at once."""
    buffer = io.BytesIO()  # numpy would ask a pipe for its position
    np.save(buffer, array)
    file.write(buffer.getvalue())
    file.flush()
