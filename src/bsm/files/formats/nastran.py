"""Nastran bulk data: shells and the skin of solids, in basic coordinates, with the number of the property of each.

A card has a name and fields, in eight or sixteen columns or between commas, and goes on in lines that begin with a
blank field, + or *. Cards of geometry are taken; those in keywords.csv are harmless; all others refuse the file.
"""

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError
from bsm.bitstream.limits import Limits
from bsm.files.formats.cells import skin
from bsm.files.formats.lines import Keywords, Numbering, included, whole
from bsm.files.formats.polygons import Polygons, unit_rows
from bsm.files.parsing import Doubles, Ints, require_counts

Card: TypeAlias = tuple[int, list[str]]
_ELEMENTS = {
    "CTRIA3": ("triangle", (3,)), "CTRIAR": ("triangle", (3,)), "CTRIA6": ("triangle", (6, 3)),
    "CQUAD4": ("quad", (4,)), "CQUADR": ("quad", (4,)), "CSHEAR": ("quad", (4,)), "CQUAD8": ("quad", (8, 4)),
    "CTETRA": ("tetra", (10, 4)), "CPYRAM": ("pyramid", (13, 5)), "CPENTA": ("wedge", (15, 6)),
    "CHEXA": ("hexahedron", (20, 8)),
}  # fmt: skip
"""Elements that are taken: their shapes, and how many nodes they may have."""
_ORDER = {15: [*range(9), 12, 13, 14, 9, 10, 11], 20: [*range(12), 16, 17, 18, 19, 12, 13, 14, 15]}
"""Where nodes on edges are, which Nastran counts from the bottom up."""
_EXPONENT = re.compile(r"(?<=[\d.])(?:[eEdD])?([+-])(?=\d)|[dD](?=\d)")
_INCLUDE = r"""^[ \t]*()INCLUDE[ \t]+('[^']{0,1100}'|"[^"]{0,1100}"|[^\s'"]+)().*$"""
_WAY = "write it as .vtu, e.g. with pyNastran or ParaView"


def read_nastran(data: bytes, path: str | None, limits: Limits) -> Polygons:
    keywords = Keywords("nastran", _WAY)
    lines = included(data.decode("latin-1"), _INCLUDE, path).splitlines()
    cards = defaultdict[str, list[Card]](list)
    systems = dict[int, tuple[str, Card]]()
    for name, line, fields in _cards(lines, keywords):
        if name in ("GRID", *_ELEMENTS):
            cards[name].append((line, fields))
        elif re.fullmatch("CORD[12][RCS]", name):
            rows = [fields]
            # A card of three nodes may have two systems.
            if name[4] == "1":
                rows = [fields[:4], fields[4:8]]
            for row in filter(any, rows):
                number = int(_integers([(line, row)], 0)[0])
                systems[number] = name, (line, row)
        else:
            keywords.leave(name, line)
    require_counts(limits, vertices=len(cards["GRID"]))
    grids = _without_repeats(cards["GRID"])
    numbers = Numbering(_integers(grids, 0))
    points = _reals([(line, row[2:5]) for line, row in grids])
    owners = _integers(grids, 1)
    if owners.any():
        points = _Systems(systems, numbers, points, owners).points()
    blocks, properties = [], list[Ints]()
    for name, (shape, counts) in _ELEMENTS.items():
        for count, elements in _by_count(name, cards[name], counts, keywords):
            nodes = np.column_stack([_integers(elements, 2 + place) for place in range(count)])
            node_rows = numbers.rows(nodes)
            if count in _ORDER:
                node_rows = node_rows[:, _ORDER[count]]
            blocks.append((shape, node_rows))
            properties.append(_integers(elements, 1))
    of_cells: dict[str, Ints] = {}
    if properties:
        of_cells["property"] = np.concatenate(properties)
    return skin(points, blocks, {}, of_cells, keywords.notes)


def _cards(lines: Sequence[str], keywords: Keywords) -> Iterator[tuple[str, int, list[str]]]:
    """The cards of bulk data: their names, lines and fields."""
    starts = [
        place for place, line in enumerate(lines) if re.match(r"BEGIN\b", line.lstrip(), re.I)
    ]
    if len(starts) > 1 or (
        starts and not re.match(r"\s*BEGIN(\s+BULK)?$", _without_remark(lines[starts[0]]), re.I)
    ):
        raise keywords.refusal(lines[starts[-1]].strip()[:40], starts[-1] + 1)
    first = 0
    if starts:
        first = starts[0] + 1
    name, begun, fields = "", 0, list[str]()
    for number, raw_line in enumerate(lines[first:], first + 1):
        line = _without_remark(raw_line)
        if not line.strip():
            continue
        head, row = _fields(line)
        if head[:1] in ("", "+", "*") and (head[:1] or name):
            fields += row
            continue
        if name:
            yield name, begun, fields
        name, begun, fields = head.rstrip("*").upper(), number, row
        if name == "ENDDATA":
            return
        if not re.fullmatch("[A-Z][A-Z0-9]{0,7}", name):
            raise FormatError(f"line {number}: {raw_line.strip()[:40]!r} is not a card of Nastran")
    if name:
        yield name, begun, fields


def _fields(line: str) -> tuple[str, list[str]]:
    """Return the first field of a line, and as many others as such a line has."""
    first, comma, _ = line.partition(",")
    if comma and re.fullmatch(r"[\w*+]*", first.strip()):
        head, *row = (word.strip() for word in line.split(","))
    else:
        line, width = line.expandtabs(8), 8
        head = line[:8].strip()
        if head.endswith("*"):
            width = 16
        row = [line[begin : begin + width].strip() for begin in range(8, 72, width)]
    count = 8
    if head.endswith("*"):
        count = 4
    blanks = [""] * (count - len(row))
    return head, [*row[:count], *blanks]


def _without_remark(line: str) -> str:
    return line.partition("$")[0].rstrip()


def _integers(cards: Sequence[Card], place: int) -> Ints:
    """One field of cards as whole numbers; a blank one is 0."""
    words = [_word(row, place) for _, row in cards]
    first_line = 0
    if cards:
        first_line, _ = cards[0]
    return whole(words, "a card", first_line)


def _word(row: Sequence[str], place: int) -> str:
    if place >= len(row):
        return "0"
    return row[place] or "0"


def _reals(cards: Sequence[Card]) -> Doubles:
    """The fields of cards as numbers, as Nastran writes them: 7.-3 is 7e-3."""
    fields: list[str] = []
    for _, row in cards:
        fields += [word or "0" for word in row]
    words = _EXPONENT.sub(lambda match: f"e{match[1] or ''}", " ".join(fields)).split()
    width = 3
    if cards:
        _, first_row = cards[0]
        width = len(first_row)
    try:
        return np.array(words, np.float64).reshape(len(cards), width)
    except ValueError:
        if len(cards) > 1:
            for card in cards:
                _reals([card])
        line, row = cards[0]
        raise FormatError(
            f"line {line}: {' '.join(row)[:60]!r} are not {len(row)} numbers"
        ) from None


def _without_repeats(cards: Sequence[Card]) -> list[Card]:
    """Cards without those that say the same again."""
    first_cards = {tuple(row): (line, row) for line, row in reversed(cards)}
    return list(reversed(first_cards.values()))


def _by_count(
    name: str, cards: Sequence[Card], counts: Sequence[int], keywords: Keywords
) -> Iterator[tuple[int, list[Card]]]:
    """Elements by how many nodes they have; nodes on edges are all there, or none."""
    cards_by_count = defaultdict[int, list[Card]](list)
    for line, row in cards:
        has_node = [word not in ("", "0") for word in row[2 : 2 + counts[0]]]
        count = sum(has_node)
        if count not in counts or not all(has_node[:count]):
            raise keywords.refusal(f"{name} with {count} of {counts[0]} nodes", line)
        cards_by_count[count].append((line, row))
    yield from cards_by_count.items()


class _Systems:
    """Coordinate systems, each of which is placed once, after the one that it is in."""

    def __init__(
        self,
        systems: Mapping[int, tuple[str, Card]],
        numbers: Numbering,
        points: Doubles,
        owners: Ints,
    ) -> None:
        self._systems, self._numbers, self._points, self._owners = systems, numbers, points, owners
        # Origins, and axes as rows, in basic coordinates.
        self._axes: dict[int, tuple[Doubles, Doubles]] = {}

    def points(self) -> Doubles:
        """Return all points in basic coordinates."""
        points = self._points.copy()
        order = np.argsort(self._owners, kind="stable")
        owners, begins = np.unique(self._owners[order], return_index=True)
        for owner, rows in zip(owners.tolist(), np.split(order, begins[1:])):
            if owner:
                self._place(owner)
                points[rows] = self._moved(self._points[rows], owner)
        return points

    def _place(self, number: int) -> None:
        """Find the axes of a system, and of those that it is in."""
        waiting, begun = [number], set[int]()
        while waiting:
            current = waiting[-1]
            if current in self._axes:
                waiting.pop()
                continue
            if current not in self._systems:
                raise FormatError(f"the coordinate system {current} is not there; {_WAY}")
            owners, corners = self._corners(current)
            missing = [owner for owner in owners if owner and owner not in self._axes]
            if not missing:
                self._axes[current] = self._axes_of(current, owners, corners)
            elif current in begun:
                raise FormatError(f"the coordinate system {current} refers to itself; {_WAY}")
            begun.add(current)
            waiting += missing

    def _corners(self, number: int) -> tuple[list[int], Doubles]:
        """Return the three points of a system, and the systems that these are in."""
        name, (line, row) = self._systems[number]
        if name[4] == "1":
            references = np.array([_integers([(line, row)], place)[0] for place in (1, 2, 3)])
            nodes = self._numbers.rows(references)
            return self._owners[nodes].tolist(), self._points[nodes]
        owner = int(_integers([(line, row)], 1)[0])
        fields = [*row[2:11], *[""] * 9]
        corners = _reals([(line, fields[:9])]).reshape(3, 3)
        return [owner] * 3, corners

    def _axes_of(self, number: int, owners: list[int], corners: Doubles) -> tuple[Doubles, Doubles]:
        a, b, c = (self._moved(corner[None], owner)[0] for owner, corner in zip(owners, corners))
        z = unit_rows((b - a)[None])[0]
        y = unit_rows(np.cross(z, c - a)[None])[0]
        if not y.any():
            _, (line, _) = self._systems[number]
            raise MeshError(
                f"line {line}: the axes of the coordinate system {number} lie on a line"
            )
        return a, np.array([np.cross(y, z), y, z])

    def _moved(self, rows: Doubles, number: int) -> Doubles:
        """Return points of a system in basic coordinates."""
        if not number:
            return rows
        name, _ = self._systems[number]
        r, s, t = rows.T
        first, second = np.radians(s), np.radians(t)
        if name[5] == "C":
            r, s = r * np.cos(first), r * np.sin(first)
        elif name[5] == "S":
            flat = r * np.sin(first)
            r, s, t = flat * np.cos(second), flat * np.sin(second), r * np.cos(first)
        origin, axes = self._axes[number]
        moved: Doubles = np.column_stack([r, s, t]) @ axes + origin
        return moved
