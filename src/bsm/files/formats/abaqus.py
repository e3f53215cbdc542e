"""Abaqus and CalculiX input: shells and the skin of solids, of the model or of each instance of its parts.

A keyword line begins with *, and data lines follow. Nodes and elements are taken in the scope that they are in: the
model, a part or an instance. Keywords in keywords.csv are harmless; all others refuse the file.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from bsm.bitstream.errors import FormatError
from bsm.bitstream.limits import Limits
from bsm.files.formats.cells import skin
from bsm.files.formats.lines import Keywords, Numbering, included, whole
from bsm.files.formats.metadata import named
from bsm.files.formats.polygons import Part, Polygons, joined_parts, part_of, unit_rows
from bsm.files.parsing import Doubles, Ints, require_counts

_FLAT = r"(?:S|STRI|DS|M3D|R3D|SFM3D|F3D|AC2D|ACAX|DC2D|DCC2D|DCAX|DCCAX|CPS|CPE|CPEG|CAX|CGAX|E2D|WARP2D|COH2D)"
_SOLID = r"(?:C3D|DC3D|DCC3D|AC3D|SC|CSS|COH3D|Q3D|F3D)"
_KIND = re.compile(
    rf"(?:{_FLAT}(?P<flat>[34689])|{_SOLID}(?P<solid>4|5|6|8|10|15|20))(?![0-9V])\w*"
)
_SHAPES = {
    4: "tetra",
    5: "pyramid",
    6: "wedge",
    8: "hexahedron",
    10: "tetra",
    15: "wedge",
    20: "hexahedron",
}
_LINES = re.compile(
    r"(?:B[23]\d|T[23]D[23]|PIPE|ELBOW|MASS|ROTARYI|SPRING|DASHPOT|CONN|GAP|FRAME|RB|DC1D|DCOUP|D$|ITT|ITS|LS6)\w*"
)
"""Elements without a surface."""
_INCLUDE = r"""^((?:\*(?:NODE|ELEMENT)\b.*?)?)(?:\*INCLUDE\b *)?,\s*INPUT\s*=\s*("[^"\n]*"|[^,\s]+)[ \t]*(.*)$"""
_WAY = "let Abaqus/CAE write it anew without parts, or CalculiX a .frd, of which ccx2paraview makes a .vtu"


@dataclass(eq=False)
class _Scope:
    """Nodes and elements with numbers of their own: of the model, a part or an instance."""

    name: str
    # A line, and the data lines that follow.
    nodes: list[tuple[int, list[str]]] = field(default_factory=list)
    # With their kind and set.
    elements: list[tuple[str, str, int, list[str]]] = field(default_factory=list)
    part: "_Scope | None" = None  # of which it is an instance, with nodes and elements of its own
    placement: Doubles = field(default_factory=lambda: np.eye(4))


@dataclass(frozen=True)
class _Keyword:
    name: str
    parameters: dict[str, str]
    line: int
    rows: list[str]


def _without_remark(row: str) -> str:
    """Return a row without spaces around it; nothing of a remark."""
    row = row.strip()
    if row.startswith("**"):
        return ""
    return row


def _keywords(text: str) -> Iterator[_Keyword]:
    """The keywords of a file with their parameters and the lines of data after them."""
    lines = [_without_remark(row) for row in text.splitlines()]
    starts = [number for number, line in enumerate(lines) if line.startswith("*")]
    first = next((number for number, line in enumerate(lines) if line), 0)
    if starts[:1] != [first]:
        what = "is not a keyword: this is not a file of Abaqus; save AVS UCD as .vtu, e.g. with ParaView"
        raise FormatError(f"line {first + 1}: {lines[first][:40]!r} {what}")
    for begin, end in pairwise([*starts, len(lines)]):
        head, *rows = filter(None, lines[begin:end])
        goes_on = next(
            (number for number, row in enumerate([head, *rows]) if not row.endswith(",")), len(rows)
        )
        head, rows = "".join([head, *rows[:goes_on]]), rows[goes_on:]
        name, *words = (word.strip() for word in head[1:].split(","))
        pairs = (word.partition("=") for word in words if word)
        parameters = {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}
        yield _Keyword(" ".join(name.upper().split()), parameters, begin + 1, rows)


def read_abaqus(data: bytes, path: str | None, limits: Limits) -> Polygons:
    table = Keywords("abaqus", _WAY)
    reader = _ModelReader(table)
    for keyword in _keywords(included(data.decode("latin-1"), _INCLUDE, path)):
        reader.read(keyword)
    if reader.model.elements and reader.instances:
        raise table.refusal("*ELEMENT outside of parts", reader.model.elements[0][2])
    group_numbers: dict[str, int] = {}
    surfaces = _Surfaces(group_numbers, table, limits)
    # Those of parts are made once, and their counts are known before the first instance is placed.
    visible: list[tuple[_Scope, Part]] = []
    counts: list[tuple[int, int]] = []
    losses: dict[str, None] = {}
    for scope in reader.instances or [reader.model, *reader.parts.values()]:
        part, lost = surfaces.of(scope)
        losses |= dict.fromkeys(lost)
        if len(part.sizes):
            visible.append((scope, part))
            counts.append((len(part.positions), int(np.maximum(part.sizes - 2, 0).sum())))
    placed_parts = (
        replace(part, name=scope.name).placed(scope.placement) for scope, part in visible
    )
    joined = joined_parts(placed_parts, counts, limits, len(data))
    columns = [
        column for column in joined.columns if column.name != "group" or len(group_numbers) > 1
    ]
    metadata = dict(joined.metadata)
    if any(group_numbers):
        metadata |= named(list(group_numbers), "group")
    return replace(
        joined, dropped=(*losses, *table.notes), columns=tuple(columns), metadata=metadata
    )


class _ModelReader:
    """The model, its parts and its instances, keyword by keyword."""

    def __init__(self, table: Keywords) -> None:
        self._table = table
        self.model = _Scope("")
        self.parts: dict[str, _Scope] = {}
        self.instances: list[_Scope] = []
        self._scope = self.model
        self._in_assembly = False

    def _read_nodes(self, keyword: _Keyword) -> None:
        parameters, line = keyword.parameters, keyword.line
        system = parameters.get("SYSTEM", "").upper()
        if {"SYSTEM", "INPUT"} & parameters.keys() and system != "R":
            raise self._table.refusal(f"*NODE with {' and '.join(parameters)}", line)
        self._scope.nodes.append((line, keyword.rows))
        if "NSET" in parameters:
            self._table.leave(f"NSET {parameters['NSET']}", line)

    def read(self, keyword: _Keyword) -> None:
        name, parameters, line = keyword.name, keyword.parameters, keyword.line
        if name == "PART":
            self._scope = _Scope(parameters.get("NAME", ""))
            self.parts[self._scope.name.upper()] = self._scope
        elif name == "INSTANCE":
            self._begin_instance(keyword)
        elif name in ("END PART", "END INSTANCE", "ASSEMBLY"):
            self._in_assembly |= name == "ASSEMBLY"
            self._scope = self.model
            # Reference points of an assembly are in no element here.
            if self._in_assembly:
                self._scope = _Scope("")
        elif name == "NODE":
            self._read_nodes(keyword)
        elif name == "ELEMENT":
            outside = self._in_assembly and self._scope not in self.instances
            if "INPUT" in parameters or "OFFSET" in parameters or outside:
                raise self._table.refusal(f"*ELEMENT with {', '.join(parameters)}", line)
            kind = parameters.get("TYPE", "").upper()
            self._scope.elements.append((kind, parameters.get("ELSET", ""), line, keyword.rows))
        elif "INPUT" in parameters:
            raise self._table.refusal(f"*{name} with INPUT", line)
        else:
            set_name = ""
            if name in ("NSET", "ELSET", "SURFACE"):
                set_name = parameters.get(name, parameters.get("NAME", ""))
            self._table.leave(f"{name} {set_name}".strip(), line)

    def _begin_instance(self, keyword: _Keyword) -> None:
        parameters = keyword.parameters
        part = self.parts.get(parameters.get("PART", "").upper())
        if part is None or {"LIBRARY", "INSTANCE"} & parameters.keys():
            raise self._table.refusal(
                f"*INSTANCE of {parameters.get('PART', 'another model')}", keyword.line
            )
        self._scope = _Scope(parameters.get("NAME", ""), part=part, placement=_placement(keyword))
        self.instances.append(self._scope)


def _placement(keyword: _Keyword) -> Doubles:
    """Return the matrix of an instance: moved, then turned around an axis."""
    matrix = np.eye(4)
    try:
        rows = [
            [float(word or "0") for word in row.rstrip(", ").split(",")] for row in keyword.rows
        ]
        if rows:
            matrix[:3, 3] = (rows[0] + [0.0] * 3)[:3]
        if rows[1:]:
            start, end, angle = (
                np.array(rows[1][:3]),
                np.array(rows[1][3:6]),
                np.radians(rows[1][6]),
            )
            x, y, z = unit_rows((end - start)[None])[0]
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            rotation = np.eye(4)
            rotation[:3, :3] = (
                np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
            )
            rotation[:3, 3] = start - rotation[:3, :3] @ start
            matrix = rotation @ matrix
    except (ValueError, IndexError) as error:
        raise FormatError(
            f"line {keyword.line}: the place of an instance is not made of numbers: {error}"
        ) from None
    return matrix


class _Surfaces:
    """The surfaces of scopes; instances without nodes and elements of their own have that of their part."""

    def __init__(self, names: dict[str, int], table: Keywords, limits: Limits) -> None:
        self._names, self._table, self._limits = names, table, limits
        self._known: dict[int, tuple[Part, tuple[str, ...]]] = {}
        self._lines = 0

    def of(self, scope: _Scope) -> tuple[Part, tuple[str, ...]]:
        """Return the surface of a scope where its part has it, and the names of the rest."""
        part = scope.part
        if part is not None and (scope.nodes or scope.elements):
            scope = replace(
                scope, nodes=[*part.nodes, *scope.nodes], elements=[*part.elements, *scope.elements]
            )
            # Each such instance reads the lines of its part again.
            self._lines += sum(len(lines) for _, lines in scope.nodes)
            self._lines += sum(len(lines) for *_, lines in scope.elements)
            require_counts(self._limits, vertices=self._lines)
            return _surface(scope, self._names, self._table, self._limits)
        if part is not None:
            scope = part
        if id(scope) not in self._known:
            self._known[id(scope)] = _surface(scope, self._names, self._table, self._limits)
        return self._known[id(scope)]


def _surface(
    scope: _Scope, names: dict[str, int], table: Keywords, limits: Limits
) -> tuple[Part, tuple[str, ...]]:
    """Return the surface of a scope, and the names of the rest."""
    rows: list[tuple[int, list[str]]] = []
    for line, data_lines in scope.nodes:
        for row in data_lines:
            words = row.upper().replace("D", "E").split(",")[:4]  # 1.D0 is 1.E0
            rows.append((line, [word.strip() or "0" for word in words]))
    require_counts(limits, vertices=len(rows))
    first_line = 0
    if rows:
        first_line, _ = rows[0]
    numbers = Numbering(whole([words[0] for _, words in rows], "*NODE", first_line))
    try:
        places = np.array(
            [(*words[1:], "0", "0", "0")[:3] for _, words in rows], np.float64
        ).reshape(-1, 3)
    except ValueError as error:
        raise FormatError(f"line {first_line}: a node is not made of numbers: {error}") from None
    blocks: list[tuple[str, Ints]] = []
    sets: list[int] = []
    for kind, set_name, line, data_lines in scope.elements:
        shape, count = _shape_of(kind)
        if not shape:
            if not _LINES.fullmatch(kind):
                raise table.refusal(f"*ELEMENT of the type {kind or '(none)'}", line)
            table.counts[f"elements of the type {kind}"] += sum(
                not row.endswith(",") for row in data_lines
            )
            continue
        words = ",".join(data_lines).replace(",", " ").split()
        if len(words) % (count + 1):
            raise FormatError(
                f"line {line}: elements of the type {kind} do not have {count} nodes each"
            )
        nodes = whole(words, "*ELEMENT", line).reshape(-1, count + 1)[:, 1:]
        blocks.append((shape, nodes))
        sets += [names.setdefault(set_name, len(names))] * len(nodes)
    blocks = [(shape, numbers.rows(nodes)) for shape, nodes in blocks]
    skinned = skin(places, blocks, {}, {"group": np.array(sets, np.int32)})
    return part_of(skinned, scope.name), skinned.dropped


def _shape_of(kind: str) -> tuple[str, int]:
    """Return the shape of a type of elements and the number of its nodes; "" if it has no surface."""
    if kind == "STRI65":
        return "triangle", 6
    match = _KIND.fullmatch(kind)
    if match is None:
        return "", 0
    if match["solid"]:
        count = int(match["solid"])
        return _SHAPES[count], count
    count = int(match["flat"])
    if count in (3, 6):
        return "triangle", count
    return "quad", count
