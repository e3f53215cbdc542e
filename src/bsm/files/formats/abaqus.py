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
_KIND = re.compile(rf"(?:{_FLAT}(?P<flat>[34689])|{_SOLID}(?P<solid>4|5|6|8|10|15|20))(?![0-9V])\w*")
_SHAPES = {4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron", 10: "tetra", 15: "wedge", 20: "hexahedron"}
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
    nodes: list[tuple[int, list[str]]] = field(default_factory=list)  # a line, and the data lines that follow
    elements: list[tuple[str, str, int, list[str]]] = field(default_factory=list)  # with their kind and set
    part: "_Scope | None" = None  # of which it is an instance, with nodes and elements of its own
    placed: Doubles = field(default_factory=lambda: np.eye(4))


@dataclass(frozen=True)
class _Keyword:
    name: str
    parameters: dict[str, str]
    line: int
    rows: list[str]


def _keywords(text: str) -> Iterator[_Keyword]:
    """The keywords of a file with their parameters and the lines of data after them."""
    lines = ["" if row.lstrip().startswith("**") else row.strip() for row in text.splitlines()]
    starts = [number for number, line in enumerate(lines) if line.startswith("*")]
    first = next((number for number, line in enumerate(lines) if line), 0)
    if starts[:1] != [first]:
        what = "is not a keyword: this is not a file of Abaqus; save AVS UCD as .vtu, e.g. with ParaView"
        raise FormatError(f"line {first + 1}: {lines[first][:40]!r} {what}")
    for begin, end in pairwise([*starts, len(lines)]):
        head, *rows = filter(None, lines[begin:end])
        goes_on = next((number for number, row in enumerate([head, *rows]) if not row.endswith(",")), len(rows))
        head, rows = "".join([head, *rows[:goes_on]]), rows[goes_on:]
        name, *words = (word.strip() for word in head[1:].split(","))
        pairs = (word.partition("=") for word in words if word)
        parameters = {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}
        yield _Keyword(" ".join(name.upper().split()), parameters, begin + 1, rows)


def read_abaqus(data: bytes, path: str | None, limits: Limits) -> Polygons:
    table = Keywords("abaqus", _WAY)
    model, parts, instances = _Scope(""), dict[str, _Scope](), list[_Scope]()
    scope, assembly = model, False
    for keyword in _keywords(included(data.decode("latin-1"), _INCLUDE, path)):
        name, parameters, line = keyword.name, keyword.parameters, keyword.line
        if name == "PART":
            scope = parts[parameters.get("NAME", "").upper()] = _Scope(parameters.get("NAME", ""))
        elif name == "INSTANCE":
            part = parts.get(parameters.get("PART", "").upper())
            if part is None or {"LIBRARY", "INSTANCE"} & parameters.keys():
                raise table.refusal(f"*INSTANCE of {parameters.get('PART', 'another model')}", line)
            scope = _Scope(parameters.get("NAME", ""), part=part, placed=_placed(keyword))
            instances.append(scope)
        elif name in ("END PART", "END INSTANCE", "ASSEMBLY"):
            assembly |= name == "ASSEMBLY"
            scope = _Scope("") if assembly else model  # reference points of an assembly are in no element here
        elif name == "NODE":
            if {"SYSTEM", "INPUT"} & parameters.keys() and parameters.get("SYSTEM", "").upper() != "R":
                raise table.refusal(f"*NODE with {' and '.join(parameters)}", line)
            scope.nodes.append((line, keyword.rows))
            if "NSET" in parameters:
                table.leave(f"NSET {parameters['NSET']}", line)
        elif name == "ELEMENT":
            if "INPUT" in parameters or "OFFSET" in parameters or (assembly and scope not in instances):
                raise table.refusal(f"*ELEMENT with {', '.join(parameters)}", line)
            scope.elements.append((parameters.get("TYPE", "").upper(), parameters.get("ELSET", ""), line, keyword.rows))
        elif "INPUT" in parameters:
            raise table.refusal(f"*{name} with INPUT", line)
        else:
            set_name = parameters.get(name, parameters.get("NAME", "")) if name in ("NSET", "ELSET", "SURFACE") else ""
            table.leave(f"{name} {set_name}".strip(), line)
    if model.elements and instances:
        raise table.refusal("*ELEMENT outside of parts", model.elements[0][2])
    names = dict[str, int]()
    surfaces = _Surfaces(names, table, limits)
    # Those of parts are made once, and their counts are known before the first instance is placed.
    surfaces_of_scopes = [(one, *surfaces.of(one)) for one in instances or [model, *parts.values()]]
    visible = [(one, part) for one, part, _ in surfaces_of_scopes if len(part.sizes)]
    counts = [(len(part.positions), int(np.maximum(part.sizes - 2, 0).sum())) for _, part in visible]
    placed = (replace(part, name=one.name).placed(one.placed) for one, part in visible)
    joined = joined_parts(placed, counts, limits, len(data))
    lost = dict.fromkeys(name for _, _, names_left in surfaces_of_scopes for name in names_left)
    columns = [column for column in joined.columns if column.name != "group" or len(names) > 1]
    groups = named(list(names), "group") if any(names) else {}
    return replace(
        joined, dropped=(*lost, *table.notes), columns=tuple(columns), metadata={**joined.metadata, **groups}
    )


def _placed(keyword: _Keyword) -> Doubles:
    """Where an instance is: moved, then turned around an axis."""
    try:
        rows = [[float(word or "0") for word in row.rstrip(", ").split(",")] for row in keyword.rows]
        found = np.eye(4)
        if rows:
            found[:3, 3] = (rows[0] + [0.0] * 3)[:3]
        if rows[1:]:
            a, b, angle = np.array(rows[1][:3]), np.array(rows[1][3:6]), np.radians(rows[1][6])
            x, y, z = unit_rows((b - a)[None])[0]
            k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            turn = np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
            about = np.eye(4)
            about[:3, :3], about[:3, 3] = turn, a - turn @ a
            found = about @ found
    except (ValueError, IndexError) as error:
        raise FormatError(f"line {keyword.line}: the place of an instance is not made of numbers: {error}") from None
    return found


class _Surfaces:
    """The surfaces of scopes; instances without nodes and elements of their own have that of their part."""

    def __init__(self, names: dict[str, int], table: Keywords, limits: Limits) -> None:
        self._names, self._table, self._limits = names, table, limits
        self._known: dict[int, tuple[Part, tuple[str, ...]]] = {}
        self._lines = 0

    def of(self, scope: _Scope) -> tuple[Part, tuple[str, ...]]:
        """Return the surface of a scope where its part has it, and the names of the rest."""
        part = scope.part
        own = scope if part is None or scope.nodes or scope.elements else part
        if part is not None and own is scope:
            own = replace(scope, nodes=[*part.nodes, *scope.nodes], elements=[*part.elements, *scope.elements])
            # Each such instance reads the lines of its part again.
            self._lines += sum(len(lines) for _, lines in own.nodes) + sum(len(lines) for *_, lines in own.elements)
            require_counts(self._limits, vertices=self._lines)
            return _surface(own, self._names, self._table, self._limits)
        if id(own) not in self._known:
            self._known[id(own)] = _surface(own, self._names, self._table, self._limits)
        return self._known[id(own)]


def _surface(scope: _Scope, names: dict[str, int], table: Keywords, limits: Limits) -> tuple[Part, tuple[str, ...]]:
    """The surface of a scope, and the names of the rest."""
    lines = ((line, row.upper().replace("D", "E")) for line, those in scope.nodes for row in those)  # 1.D0 is 1.E0
    rows = [(line, [word.strip() or "0" for word in row.split(",")][:4]) for line, row in lines]
    require_counts(limits, vertices=len(rows))
    numbers = Numbering(whole([words[0] for _, words in rows], "*NODE", rows[0][0] if rows else 0))
    try:
        places = np.array([(*words[1:], "0", "0", "0")[:3] for _, words in rows], np.float64).reshape(-1, 3)
    except ValueError as error:
        raise FormatError(f"line {rows[0][0]}: a node is not made of numbers: {error}") from None
    blocks, sets = list[tuple[str, Ints]](), list[int]()
    for kind, set_name, line, those in scope.elements:
        words = ",".join(those).replace(",", " ").split()
        if (match := _KIND.fullmatch(kind)) is None and kind != "STRI65":
            if not _LINES.fullmatch(kind):
                raise table.refusal(f"*ELEMENT of the type {kind or '(none)'}", line)
            table.counts[f"elements of the type {kind}"] += sum(not row.endswith(",") for row in those)
            continue
        count = int(match["flat"] or match["solid"]) if match else 6
        if len(words) % (count + 1):
            raise FormatError(f"line {line}: elements of the type {kind} do not have {count} nodes each")
        nodes = whole(words, "*ELEMENT", line).reshape(-1, count + 1)[:, 1:]
        flat = match is None or match["flat"]
        blocks.append(((("triangle" if count % 3 == 0 and count < 9 else "quad") if flat else _SHAPES[count]), nodes))
        sets += [names.setdefault(set_name, len(names))] * len(nodes)
    blocks = [(shape, numbers.rows(nodes)) for shape, nodes in blocks]
    of_cells = {"group": np.array(sets, np.int32)}
    skinned = skin(places, blocks, {}, of_cells)
    return part_of(skinned, scope.name), skinned.dropped
