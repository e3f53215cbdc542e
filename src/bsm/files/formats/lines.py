"""Files of solvers in lines: keywords that are taken, harmless, or refused, numbers by their own names, and blocks."""

import csv
from collections import Counter
from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError
from bsm.files.parsing import Ints

_MOST_NAMED = 16


class Keywords:
    """The keywords of a format: those of keywords.csv are harmless, and counted but for a -."""

    def __init__(self, file_format: str, way: str) -> None:
        rows = csv.DictReader(Path(__file__).with_name("keywords.csv").read_text().splitlines())
        self._harmless = [word for row in rows if row["format"] == file_format for word in row["harmless"].split(";")]
        self._way, self.left = way, Counter[str]()

    def leave(self, keyword: str, line: int) -> None:
        """Count a keyword that is not taken, or refuse the file."""
        if keyword not in self.left and not any(fnmatch(keyword, word.lstrip("-")) for word in self._harmless):
            raise self.refusal(keyword, line)
        self.left[keyword] += 1

    def refusal(self, what: str, line: int) -> FormatError:
        """Return the error of a file with something that may change its shape, its numbers or its values."""
        return FormatError(f"line {line}: {what} is not read here, and may change the mesh; {self._way}")

    @property
    def named(self) -> tuple[str, ...]:
        """Return the keywords that were left out, with their counts."""
        found = [f"{keyword} ({count})" for keyword, count in self.left.items() if f"-{keyword}" not in self._harmless]
        return (*found[:_MOST_NAMED], *([f"{len(found) - _MOST_NAMED} other keywords"] * (len(found) > _MOST_NAMED)))


def by_number(known: Ints, asked: Ints, what: str = "node") -> Ints:
    """Return the rows of things by their numbers, which need no order."""
    order = np.argsort(known, kind="stable")
    if (same := np.diff(known[order]) == 0).any():
        raise MeshError(f"{what} {known[order][1:][same][0]} is there twice")
    places = np.searchsorted(known, asked, sorter=order).clip(0, max(len(known) - 1, 0))
    rows: Ints = order[places] if len(known) else np.full(np.shape(asked), -1)
    missing = np.ones(np.shape(asked), np.bool_) if not len(known) else known[rows] != asked
    if missing.any():
        raise MeshError(f"{what} {np.asarray(asked)[missing].ravel()[0]} is not there")
    return rows


def whole(words: Sequence[str], what: str, line: int) -> Ints:
    """Return whole numbers of words."""
    try:
        return np.array(words, np.int64)
    except (ValueError, OverflowError) as error:
        raise FormatError(f"line {line}: {what} has {str(error)[-60:]} in place of a whole number") from None
