"""Tables of numbers in text, and the memory that a mesh file may take, checked before it is read.

Like a stream, a file may take the memory that limits grant for its bytes and vertices, inflated bytes included.
"""

import codecs
import gzip
import io
import re
import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from traceback import walk_tb
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import (
    BsmError,
    CorruptError,
    FormatError,
    LimitError,
    MeshError,
    TruncatedError,
)
from bsm.bitstream.limits import Limits

Ints = npt.NDArray[np.int64]
Doubles = npt.NDArray[np.float64]
_LINES = 1 << 12


class Rows:
    """Lines of numbers: all values in one array, and where each line's begin."""

    def __init__(self, lines: Sequence[bytes], what: str) -> None:
        self.what = what
        self.counts: Ints = np.fromiter((len(line.split()) for line in lines), np.int64, len(lines))
        self.starts: Ints = np.cumsum(self.counts) - self.counts
        # Few words at a time: millions of small objects fall out of the caches, and each then takes longer.
        pieces = (
            _numbers(lines[begin : begin + _LINES], what, begin)
            for begin in range(0, len(lines), _LINES)
        )
        self.values: Doubles = np.concatenate([np.zeros(0), *pieces])

    def require(self, needed: int | Ints) -> None:
        short = self.counts < needed
        if short.any():
            row = int(np.argmax(short))
            raise MeshError(f"{self.what} {row} has {self.counts[row]} numbers, too few")

    def columns(self, first: int, count: int) -> Doubles:
        """The numbers `first` to `first + count` of every line, shape (lines, count)."""
        self.require(first + count)
        columns: Doubles = self.values[self.starts[:, None] + np.arange(first, first + count)]
        return columns

    def lists(self, before: int) -> tuple[Ints, Ints]:
        """The lists that follow `before` numbers of each line: their lengths, and their items one after the other."""
        sizes = as_integers(
            self.columns(before, 1)[:, 0], f"the number of corners of a {self.what}"
        )
        if (sizes < 0).any():
            raise MeshError(
                f"{self.what} {int(np.argmax(sizes < 0))} has a negative number of corners"
            )
        self.require(before + 1 + sizes)
        return sizes, as_integers(
            self.values[ranges(self.starts + before + 1, sizes)], "a vertex index"
        )


class EvenRows(Rows):
    """A table of numbers, shape (lines, numbers)."""

    def __init__(self, table: Doubles, what: str) -> None:
        self.what, self._table = what, table
        self.counts = np.broadcast_to(np.int64(table.shape[1]), len(table))
        self.starts = np.arange(len(table)) * table.shape[1]
        self.values = table.reshape(-1)

    def columns(self, first: int, count: int) -> Doubles:
        self.require(first + count)
        columns: Doubles = self._table[:, first : first + count]
        return columns


def _numbers(lines: Sequence[bytes], what: str, first: int) -> Doubles:
    text = b" ".join(lines)
    if b"_" in text:  # which Python allows inside numbers
        row = next(number for number, line in enumerate(lines, first) if b"_" in line)
        raise MeshError(f"{what} {row} is not made of numbers: it has an underscore")
    try:
        return np.array(text.split(), dtype=np.float64)
    except ValueError as error:
        word = str(error).partition(": ")[2]  # as numpy quotes it
        row = next(
            number for number, line in enumerate(lines, first) if word in map(repr, line.split())
        )
        raise MeshError(f"{what} {row} is not made of numbers: {word[1:61]}") from None


def ranges(starts: Ints, sizes: Ints) -> Ints:
    """The indices start, start + 1, ..., start + size - 1 of each pair, one pair after the other."""
    ends = np.cumsum(sizes)
    begin: Ints = np.repeat(starts - (ends - sizes), sizes)
    return begin + np.arange(len(begin))


def as_integers(values: npt.NDArray[Any], what: str) -> Ints:
    # Up to here every whole number is a double; beyond, neighbours fall on one, and the index would be a guess.
    in_range = np.abs(values) < 2**53
    if values.dtype.kind == "f":
        in_range &= values == np.rint(values)
    if not in_range.all():
        raise MeshError(f"{what} is {values[np.argmin(in_range)]}, not a whole number")
    return values.astype(np.int64)


def plain_text(data: bytes) -> bytes:
    """Text in UTF-8 without a byte order mark; editors of Windows also write UTF-16."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        # An odd last byte is left out: the decoder would refuse all of the text for it.
        return data[: len(data) // 2 * 2].decode("utf-16", errors="replace").encode()
    return data.removeprefix(codecs.BOM_UTF8)


def continued(data: bytes) -> bytes:
    """Text whose lines that end with a backslash are joined to the next; comments are not continued."""
    if b"\\" not in data:
        return data
    return re.sub(
        rb"^([ \t]*#[^\r\n]*)|\\[ \t]*\r?\n", lambda match: match[1] or b" ", data, flags=re.M
    )


def require_lines(present: int, claimed: int) -> None:
    """Raise `TruncatedError` if fewer lines are present than the header of a file claims."""
    if present < claimed:
        raise TruncatedError(
            f"the file is cut short: its header claims {claimed} vertices and faces, {present} follow"
        )


PRECISION = {"precision": "single"}
"""Metadata of a mesh that comes from single precision and lies so far off that others would not fit into that."""
NO_DOUBLES = "the coordinates need double precision, which {} does not have; write PLY, OBJ or OFF, or round them: "
NO_DOUBLES += "--float32 (in Python, the metadata precision: single)"


def single_suffices(positions: Doubles) -> bool:
    with np.errstate(over="ignore", invalid="ignore"):
        error = np.abs(positions.astype(np.float32) - positions).max()
        return bool(
            np.isfinite(error) and error <= 1e-6 * np.linalg.norm(np.ptp(positions, axis=0))
        )


def is_single_and_far(positions: Doubles) -> bool:
    """Whether coordinates are in single precision, which would not suffice for others at this place."""
    with np.errstate(over="ignore", invalid="ignore"):
        single = positions.astype(np.float32)
        return bool((single == positions).all()) and not single_suffices(
            positions + np.spacing(single) / 2.0
        )


def text_table(row: str, columns: npt.NDArray[Any]) -> bytes:
    """The rows of a table, each written by the format string `row`."""
    return "".join(map(row.format, *columns.T.tolist())).encode()


def point_row(keyword: str, positions: Doubles) -> str:
    """The format of a line with a point: nine digits where float32 suffices, else as many as float64 needs."""
    number = "{!r}"
    if single_suffices(positions):
        number = "{:.9g}"
    return f"{keyword}{number} {number} {number}\n"


# Bytes of a coordinate or an index as readers make it, however narrow the file has it.
AS_NUMBERS = 8
TREE = 32  # bytes that a byte of JSON may become
TAG = 150  # bytes that a tag of XML becomes in the tree of a library
_PIECE = 1 << 18
# Zeros that the end of a gzip member may have; gzip skips zeros after it one at a time.
_ENDING = 16


def require_counts(limits: Limits, **counts: int) -> None:
    """Raise `LimitError` where a file has more vertices, faces or frames than a stream may."""
    for name, count in counts.items():
        most = int(min(getattr(limits, name), 1 << 62))
        if count > most:
            raise LimitError(
                f"{name} = {count:,} is over the limit of {most:,}; cut it into parts, as bsm tile does"
            )


def require_inflated(size: int, compressed: int, limits: Limits, vertices: int = 0) -> None:
    """Raise `LimitError` if the compressed bytes inflate to too many."""
    most = int(min(limits.memory_for(vertices, compressed), 1 << 62))
    if size > most:
        raise LimitError(
            f"{compressed} compressed bytes take {size} bytes of memory or more, over the limit of {most} "
            "(Limits.memory); if you trust the file, decompress it yourself"
        )


_PACKAGE = str(Path(__file__).parents[1])
_OF_PYTHON = re.compile(
    r"reshap|broadcast|\bint\(\)|to integer|inhomogeneous|' object\b|NoneType|__|\bargument"
)


def in_words(error: Exception) -> str:
    """The fault of a file as Python or a library tells it, without the names of their errors and types."""
    if isinstance(error, UnicodeDecodeError):
        return f"byte {error.start} of its text is not {error.encoding.upper()}"
    if isinstance(error, KeyError):
        return f"{error} is missing"
    words = re.sub(r"^\w*(Error|Exception)( \d+)?: *", "", " ".join(str(error).split()))[-200:]
    ours = (
        isinstance(
            error, LookupError | TypeError | AttributeError | ArithmeticError | AssertionError
        )
        or not words
    )
    # Such a text describes our program, not the file. The line that failed helps in a bug report.
    if ours or _OF_PYTHON.search(words):
        own_frames = [
            at
            for at in walk_tb(error.__traceback__)
            if at[0].f_code.co_filename.startswith(_PACKAGE)
        ]
        place = "".join(
            f" ({Path(frame.f_code.co_filename).name}, line {line})"
            for frame, line in own_frames[-1:]
        )
        return f"a value does not fit the others, or is of another kind than it must be{place}"
    return words


@contextmanager
def as_format_error(kind: str) -> Iterator[None]:
    """Raise `FormatError` in place of the errors that malformed content causes."""
    try:
        yield
    except BsmError:
        raise
    # Not Exception: all other errors are our own faults, and must not be blamed on the file.
    except (
        LookupError,
        TypeError,
        ValueError,
        AttributeError,
        RuntimeError,
        ArithmeticError,
    ) as error:
        raise FormatError(f"this {kind} makes no sense: {in_words(error)}") from error


@contextmanager
def as_library_error(library: str, what: str = "this file") -> Iterator[None]:
    """Raise `FormatError` in place of all errors of a library, which promises nothing about damaged files."""
    try:
        yield
    except (BsmError, MemoryError):
        raise
    except Exception as error:
        raise FormatError(f"{library} cannot read {what}: {in_words(error)}") from error


def gunzipped(data: bytes, limits: Limits) -> bytes:
    """What gzip has compressed, in one member or several."""
    unpacked = bytearray()
    try:
        # gzip.decompress would inflate all before its size can be judged; a few kilobytes may become gigabytes.
        with gzip.open(io.BytesIO(data[: len(data.rstrip(b"\0")) + _ENDING])) as file:
            while piece := file.read(_PIECE):
                unpacked += piece
                require_inflated(2 * len(unpacked), len(data), limits)  # these, and a copy of them
    except EOFError as error:
        raise TruncatedError(
            "the file is cut short: what gzip has compressed does not end"
        ) from error
    except (OSError, zlib.error) as error:
        raise CorruptError(f"what gzip has compressed is damaged: {error}") from error
    return bytes(unpacked)
