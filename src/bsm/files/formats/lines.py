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
        self._harmless: list[str] = []
        for row in rows:
            if row["format"] == file_format:
                self._harmless += row["harmless"].split(";")
        self._way, self.counts = way, Counter[str]()

    def leave(self, keyword: str, line: int) -> None:
        """Count a keyword that is not taken, or refuse the file."""
        if keyword not in self.counts and not any(
            fnmatch(keyword, word.lstrip("-")) for word in self._harmless
        ):
            raise self.refusal(keyword, line)
        self.counts[keyword] += 1

    def refusal(self, what: str, line: int) -> FormatError:
        """Return the error of a file with something that may change its shape, its numbers or its values."""
        return FormatError(
            f"line {line}: {what} is not read here, and may change the mesh; {self._way}"
        )

    @property
    def notes(self) -> tuple[str, ...]:
        """Return the keywords that were left out, with their counts."""
        keywords = [
            f"{keyword} ({count})"
            for keyword, count in self.counts.items()
            if f"-{keyword}" not in self._harmless
        ]
        return (
            *keywords[:_MOST_NAMED],
            *([f"{len(keywords) - _MOST_NAMED} other keywords"] * (len(keywords) > _MOST_NAMED)),
        )


def included(text: str, pattern: str, path: str | None) -> str:
    """Text with that of files it includes, each once: a pattern finds the kept part of a line, a name, and the rest."""
    paths, pieces, waiting = set[Path](), list[str](), [(text, 0)]
    find = re.compile(pattern, re.M | re.I).search
    # A stack and no recursion: files may include each other deeper than Python can call.
    while waiting:
        text, begin = waiting.pop()
        match = find(text, begin)
        if match is None:
            pieces.append(text[begin:])
            continue
        waiting.append((text, match.end()))
        name = re.sub(r"\s*\n\s*", "", match[2].strip("'\""))
        with about(name):
            if path is None:
                raise FormatError("only a file with a name, and not compressed, can include others")
            file = file_beside(Path(path).resolve().parent, name)
            if file in paths:
                raise FormatError("this file is included twice")
            paths.add(file)
            content = file.read_text("latin-1")
        pieces.append(text[begin : match.start()])
        statement = f"{match[1]}{match[3]}"
        if statement:
            pieces.append(f"{statement}\n")
        else:
            content = content.lstrip("\n")
        waiting.append((content, 0))
    return "".join(pieces)


class Numbering:
    """The rows of things by their numbers, which need no order."""

    def __init__(self, numbers: Ints, what: str = "node") -> None:
        self._what, self._order = what, np.argsort(numbers, kind="stable")
        self._known = numbers[self._order]
        if (same := np.diff(self._known) == 0).any():
            raise MeshError(f"{what} {self._known[1:][same][0]} is there twice")

    def __len__(self) -> int:
        return len(self._known)

    def rows(self, references: Ints) -> Ints:
        """Return the rows of things with these numbers."""
        places = np.searchsorted(self._known, references).clip(0, max(len(self) - 1, 0))
        missing = np.ones(np.shape(references), np.bool_)
        if len(self):
            missing = self._known[places] != references
        if missing.any():
            first_missing, *_ = np.asarray(references)[missing].ravel()
            raise MeshError(f"{self._what} {first_missing} is not there")
        # Without any numbers there are no references here.
        rows: Ints = self._order[places]
        return rows


def whole(words: Sequence[str], what: str, line: int) -> Ints:
    """Return whole numbers of words."""
    try:
        return np.array(words, np.int64)
    except (ValueError, OverflowError) as error:
        raise FormatError(
            f"line {line}: {what} has {str(error)[-60:]} in place of a whole number"
        ) from None
