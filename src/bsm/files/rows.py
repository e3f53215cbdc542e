"""Tables of numbers in text files."""

import re
from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError, TruncatedError

Ints = npt.NDArray[np.int64]
Doubles = npt.NDArray[np.float64]


class Rows:
    """Lines of numbers: all values in one array, and where each line's begin."""

    def __init__(self, lines: Sequence[bytes], what: str) -> None:
        fields = [line.split() for line in lines]
        if any(b"_" in line for line in lines):  # which Python allows inside numbers
            raise MeshError(f"a {what} is not made of numbers: it has an underscore")
        self.what = what
        self.counts: Ints = np.fromiter(map(len, fields), np.int64, len(fields))
        self.starts: Ints = np.cumsum(self.counts) - self.counts
        try:
            self.values: Doubles = np.array(list(chain.from_iterable(fields)), dtype=np.float64)
        except ValueError:
            word = next(filter(_is_no_number, chain.from_iterable(fields)), b"")
            shown = word[:40].decode(errors="replace")
            raise MeshError(f"a {what} is not made of numbers: {shown!r}") from None

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
        sizes = as_integers(self.columns(before, 1)[:, 0], f"the number of corners of a {self.what}")
        if (sizes < 0).any():
            raise MeshError(f"{self.what} {int(np.argmax(sizes < 0))} has a negative number of corners")
        self.require(before + 1 + sizes)
        return sizes, as_integers(self.values[ranges(self.starts + before + 1, sizes)], "a vertex index")


def _is_no_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return True
    return False


def ranges(starts: Ints, sizes: Ints) -> Ints:
    """The indices start, start + 1, ..., start + size - 1 of each pair, one pair after the other."""
    ends = np.cumsum(sizes)
    begin: Ints = np.repeat(starts - (ends - sizes), sizes)
    return begin + np.arange(len(begin))


def as_integers(values: npt.NDArray[Any], what: str) -> Ints:
    whole = np.abs(values) < 2**53
    if values.dtype.kind == "f":
        whole &= values == np.rint(values)
    if not whole.all():
        raise MeshError(f"{what} is {values[np.argmin(whole)]}, not a whole number")
    return values.astype(np.int64)


def without_comments(data: bytes) -> bytes:
    """`data` with everything from a # to the end of its line taken out."""
    return re.sub(rb"#[^\n\r]*", b"", data) if b"#" in data else data


def require_lines(present: int, claimed: int) -> None:
    """Raise `TruncatedError` if fewer lines are present than the header of a file claims."""
    if present < claimed:
        raise TruncatedError(f"the file is cut short: its header claims {claimed} vertices and faces, {present} follow")


def single_suffices(positions: Doubles) -> bool:
    with np.errstate(over="ignore", invalid="ignore"):
        error = np.abs(positions.astype(np.float32) - positions).max()
        return bool(np.isfinite(error) and error <= 1e-6 * np.linalg.norm(np.ptp(positions, axis=0)))


def text_table(row: str, columns: npt.NDArray[Any]) -> bytes:
    """The rows of a table, each written by the format string `row`."""
    return "".join(map(row.format, *columns.T.tolist())).encode()


def point_row(keyword: str, positions: Doubles) -> str:
    """The format of a line with a point: nine digits where float32 suffices, else as many as float64 needs."""
    number = "{:.9g}" if single_suffices(positions) else "{!r}"
    return f"{keyword}{number} {number} {number}\n"
