"""Files of solvers in lines: keywords that are taken, harmless, or refused, files that they include, and numbers."""

import csv
import re
from collections import Counter
from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError
from bsm.files.parsing import Ints
from bsm.files.pipes import about, file_beside

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


def included(text: str, pattern: str, path: str | None, known: set[Path] | None = None) -> str:
    """Text with that of files it includes, each once: a pattern finds the kept part of a line, a name, and the rest."""
    known = set() if known is None else known

    def content(found: re.Match[str]) -> str:
        name = re.sub(r"\s*\n\s*", "", found[2].strip("'\""))
        with about(name):
            if path is None:
                raise FormatError("only a file with a name, and not compressed, can include others")
            file = file_beside(Path(path).resolve().parent, name)
            if file in known:
                raise FormatError("this file is included twice")
            known.add(file)
            return f"{found[1]}{found[3]}\n{included(file.read_text('latin-1'), pattern, path, known)}".lstrip("\n")

    return re.sub(pattern, content, text, flags=re.M | re.I)


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
