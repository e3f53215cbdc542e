"""The names in a file that no reader takes: all but those in a table of the reader."""

import csv
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TypeAlias
from xml.parsers import expat

Said: TypeAlias = tuple[str, str, object]
"""The owner of a name (an object of JSON, an element of XML, a prim of USD), the name, and its value."""
_MOST_NAMED, _MOST_SHAPES = 24, 1 << 12


def rows_of(file_format: str) -> dict[str, str]:
    """The rows of taken.csv for a format."""
    every = csv.DictReader(Path(__file__).with_name("taken.csv").read_text().splitlines())
    mine = [
        (row["owners"].split() or [""], row["names"])
        for row in every
        if row["format"] == file_format
    ]
    return {owner: names for owners, names in mine for owner in owners}


class Taken:
    """The names that a reader takes, for each owner: whole, by their beginning (: or _ ends it), or name=value."""

    def __init__(self, rows: Mapping[str, str]) -> None:
        self._rows = {
            owner: {*f"{words} {rows.get('', '')}".split()}
            for owner, words in {"": "", **rows}.items()
        }

    def takes(self, owner: str, name: str, value: object = "") -> bool:
        row = self._rows.get(owner, self._rows[""])
        if name in row:
            return True
        text = "".join(str(value).split())
        if isinstance(value, int | float):
            text = f"{value:g}"
        if f"{name}={text}" in row:
            return True
        return any(name[: match.end()] in row for match in re.finditer("[:_]", name))

    def unread_names(self, said: Iterable[Said]) -> list[str]:
        """Return the names that are not taken, as "name of owner", of many only the first."""
        unread: dict[str, None] = {}
        for owner, name, value in said:
            if not self.takes(owner, name, value):
                if owner not in ("", "glTF", "extensions"):
                    name = f"{name} of {owner}"
                unread[name] = None
        names = list(unread)
        if len(names) > _MOST_NAMED:
            return [*names[:_MOST_NAMED], f"{len(names) - _MOST_NAMED} other names"]
        return names

    def in_xml(self, data: bytes) -> Iterator[Said]:
        """Yield the elements and attributes of a document, but not those below an element that is not taken."""
        elements: dict[tuple[str, ...], None] = {}
        ancestors = [""]

        def begin(tag: str, attributes: Mapping[str, str]) -> None:
            element = (ancestors[-1], tag.rpartition(":")[2], *attributes)
            if len(elements) < _MOST_SHAPES:
                elements.setdefault(element)
            ancestors.append(element[1])

        parser = expat.ParserCreate()
        parser.StartElementHandler = begin
        parser.EndElementHandler = lambda _: ancestors.pop()
        with suppress(expat.ExpatError):  # a library has read it
            parser.Parse(data, True)
        for owner, tag, *attribute_names in elements:
            if owner and not self.takes("", owner):
                continue
            yield owner, tag, ""
            for name in attribute_names:
                if self.takes("", tag) and not name.startswith("xmlns"):
                    yield tag, name.rpartition(":")[2], ""
