"""Gmsh meshes, text or binary, of the versions 2 to 4.1: surfaces, the skin of volumes, and physical groups.

A section of numbers is read by one cursor, whether they are text or binary. Values go by the numbers of nodes and
elements, and their times are the frames of a sequence. A section that is there twice with other contents, or that is
not in keywords.csv, refuses a file, and so do elements beyond the second order.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from bsm.bitstream.errors import FormatError, TruncatedError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.welding import row_numbers
from bsm.files.formats.cells import runs, skin
from bsm.files.formats.lines import Keywords, Numbering
from bsm.files.formats.metadata import named
from bsm.files.formats.polygons import Polygons
from bsm.files.motion.folder import read_steps
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.parsing import (
    AS_NUMBERS,
    Doubles,
    Ints,
    as_format_error,
    as_integers,
    ranges,
    require_counts,
)

_VALUES = ("NodeData", "ElementData")
_MOST_GROUPS = 64  # that become attributes
_COPIES = 3  # of a table of values that are there at a time
_WAY = "write it as text without that, e.g. gmsh FILE.msh -save -bin 0 -o NEW.msh"
_TYPES = {
    1: "line2", 2: "triangle3", 3: "quad4", 4: "tetra4", 5: "hexahedron8", 6: "wedge6", 7: "pyramid5", 8: "line3",
    9: "triangle6", 10: "quad9", 11: "tetra10", 12: "hexahedron27", 13: "wedge18", 14: "pyramid14", 15: "vertex1",
    16: "quad8", 17: "hexahedron20", 18: "wedge15", 19: "pyramid13",
}  # fmt: skip
"""Shapes of elements by their types, and how many nodes they have."""
_DIMENSIONS = {"vertex": 0, "line": 1, "triangle": 2, "quad": 2}
_EDGES = {
    "tetra": [4, 5, 6, 7, 9, 8], "hexahedron": [8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15],
    "wedge": [6, 9, 7, 12, 14, 13, 8, 10, 11], "pyramid": [5, 8, 10, 6, 7, 9, 11, 12],
}  # fmt: skip
"""Where Gmsh has the nodes on edges, in the order of `cells.py`."""
_Cells: TypeAlias = tuple[str, Ints, Ints, Ints]
"""A shape; of each cell its number, the place of its physical groups in a list of such sets, and its nodes."""


class _Numbers:
    """The numbers of a section, one after the other."""

    def __init__(self, data: bytes, binary: bool) -> None:
        self._data: Any = data
        if not binary:
            self._data = np.array(data.split(), np.float64)
        self._binary, self._at = binary, 0

    def __len__(self) -> int:
        return len(self._data) - self._at

    def take(self, kind: Any, count: int = 1) -> Any:
        """The next numbers, of a kind that they have in binary."""
        size = count
        if self._binary:
            size *= np.dtype(kind).itemsize
        begin = self._at
        self._at += size
        if not begin <= self._at <= len(self._data):
            raise TruncatedError("a section ends amid its numbers")
        if self._binary:
            return np.frombuffer(self._data, kind, count, begin)
        numbers = self._data[begin : self._at]
        if kind == "f8":
            return numbers
        return as_integers(numbers, "a number")

    def table(self, kind: str, count: int, width: int) -> Any:
        return self.take(kind, count * width).reshape(count, width)

    def counts(self, count: int, kind: str = "u8") -> list[int]:
        numbers: list[int] = self.take(kind, count).tolist()
        return numbers

    def count(self) -> int:
        return self.counts(1)[0]

    def rows(self, count: int, width: int) -> tuple[Ints, Doubles]:
        """The next rows: a whole number each, and values."""
        if self._binary:
            rows = self.take(np.dtype([("number", "i4"), ("values", "f8", (width,))]), count)
            return rows["number"].astype(np.int64), rows["values"]
        table = self.table("f8", count, 1 + width)
        return as_integers(table[:, 0], "a number"), table[:, 1:]


class _Gmsh:
    """The cells of a file, the groups that name them, and values by time."""

    def __init__(self, data: bytes, limits: Limits) -> None:
        self.keywords = Keywords("gmsh", _WAY)
        self._sections = self._split(data)
        self._groups: dict[tuple[int, ...], int] = {(): 0}
        self._limits, self._size = limits, len(data)
        header, _, one = self._first("MeshFormat").partition(b"\n")
        with as_format_error("Gmsh"):
            version, binary, size = header.split()
            self._version, self._binary = float(version), binary == b"1"
            if (
                size != b"8"
                or not 2 <= self._version < 5
                or (self._binary and one[:4] != b"\1\0\0\0")
            ):
                raise FormatError(
                    f"this file has the version {version.decode()}, or numbers of another size; {_WAY}"
                )
            numbers, self.points = self._nodes()
            require_counts(limits, vertices=len(numbers))
            nodes = Numbering(numbers)
            self.cells: list[_Cells] = []
            elements = [np.zeros(0, np.int64)]
            for shape, cell_numbers, places, corners in self._cells():
                self.cells.append((shape, cell_numbers, places, nodes.rows(corners)))
                elements.append(cell_numbers)
            self._tagged = {"NodeData": nodes}
            if "ElementData" in self._sections:
                self._tagged["ElementData"] = Numbering(np.concatenate(elements), "element")
            self._series: dict[tuple[str, str], dict[float, tuple[Ints, Doubles]]] = {}
            for kind in _VALUES:
                for section in self._sections.get(kind, ()):
                    self._add_values(kind, section)
            self._require_tables()
            self._names = _names_in(self._first("PhysicalNames"))
        self.times = [0.0]
        moving = [[*steps] for steps in self._series.values() if len(steps) > 1]
        if moving:
            self.times = moving[0]
        if any(times != self.times for times in moving):
            raise FormatError(f"values have times of their own each; {_WAY}")

    def _split(self, data: bytes) -> dict[str, list[bytes]]:
        """Return the sections of a file by their names; refuse those that are there twice."""
        sections_by_name = dict[str, list[bytes]]()
        line, counted = 1, 0
        for match in re.finditer(
            rb"^\$(?!End)(\w+)[^\n]*\n(.*?)(?=^\$End\1|\Z)", data, re.M | re.S
        ):
            line += data.count(b"\n", counted, match.start())
            counted = match.start()
            name, content = match[1].decode(), match[2]
            sections = sections_by_name.setdefault(name, [])
            # Gmsh writes all again for each view.
            if sections and name not in _VALUES and content not in sections:
                raise self.keywords.refusal(f"another ${name}", line)
            sections.append(content)
            self.keywords.leave(name, line)
        return sections_by_name

    def _add_values(self, kind: str, section: bytes) -> None:
        name, time, numbers, values = self._values(section)
        steps = self._series.setdefault((kind, name), {})
        if time in steps:
            raise FormatError(f"the values {name} are there twice for the time {time:g}")
        steps[time] = self._tagged[kind].rows(numbers), values

    def _require_memory(self, size: int) -> None:
        self._limits.check_memory(size, len(self.points), self._size)

    def _require_tables(self) -> None:
        """Refuse values that take too much memory as tables: a file may have few of many names, or of a wide one."""
        numbers = 0
        for (kind, _), steps in self._series.items():
            widths = [values.shape[1] for _, values in steps.values()]
            numbers += len(self._tagged[kind]) * max(widths) * AS_NUMBERS
        self._require_memory(_COPIES * numbers)

    def _table(self, kind: str, rows: Ints, values: Doubles) -> Doubles:
        """Return a row of values for each node or element; those without any have no numbers."""
        table = np.full((len(self._tagged[kind]), values.shape[1]), np.nan)
        table[rows] = values
        return table

    def _first(self, name: str) -> bytes:
        """The first section of a name, or nothing."""
        return self._sections.get(name, [b""])[0]

    def _section(self, name: str) -> _Numbers:
        return _Numbers(self._first(name), self._binary)

    def _counted(self, name: str) -> tuple[int, _Numbers]:
        """The count of rows that a section of version 2 begins with, and the rest."""
        count, _, rest = self._sections.get(name, [b"0"])[0].partition(b"\n")
        return int(count), _Numbers(rest, self._binary)

    def _blocks(self, name: str) -> Iterator[tuple[_Numbers, int, int, int, int]]:
        """The blocks of a section of version 4: dimension and number of an entity, a third number, and a count."""
        section, is_new = self._section(name), self._version > 4
        if not section:
            return
        width_of_head = 2
        if is_new:
            width_of_head = 4
        blocks, *_ = section.counts(width_of_head)
        for _ in range(blocks):
            dimension, number, third = section.counts(3, "i4")
            if not is_new:
                dimension, number = number, dimension
            yield section, dimension, number, third, section.count()

    def _nodes(self) -> tuple[Ints, Doubles]:
        """The numbers of nodes, and where they are."""
        if self._version < 4:
            count, section = self._counted("Nodes")
            return section.rows(count, 3)
        numbers, points = [np.zeros(0, np.int64)], [np.zeros((0, 3))]
        for section, dimension, _, parametric, count in self._blocks("Nodes"):
            width = 3
            if parametric:
                width += dimension
            if self._version > 4:
                block_numbers = section.take("u8", count).astype(np.int64)
                rows = section.table("f8", count, width)
            else:
                block_numbers, rows = section.rows(count, width)
            numbers.append(block_numbers)
            points.append(rows[:, :3])
        return np.concatenate(numbers), np.concatenate(points)

    def _cells(self) -> Iterator[_Cells]:
        if self._version < 4:
            yield from self._cells_with_tags()
            return
        groups = self._groups_of_entities()
        number_type = "i4"
        if self._version > 4:
            number_type = "u8"
        for section, dimension, entity, kind, count in self._blocks("Elements"):
            table = section.table(number_type, count, 1 + self._width(kind))
            place = self._place_of(groups.get((dimension, entity), ()))
            shape, numbers, _, nodes = self._cell(kind, 0, table)
            yield shape, numbers, np.full(count, place), nodes

    def _cells_with_tags(self) -> Iterator[_Cells]:
        """The cells of version 2, whose rows have tags."""
        remaining, section = self._counted("Elements")
        if not self._binary:
            flat = section.take("i8", len(section))
            for table in runs(
                flat, lambda row: (3 + int(row[2]) + self._width(int(row[1])), slice(1, 3))
            ):
                _, kind, tags = table[0, :3].tolist()
                yield self._cell(kind, tags, np.delete(table, [1, 2], axis=1))
            return
        while remaining > 0:
            kind, count, tags = section.counts(3, "i4")
            remaining -= count
            yield self._cell(kind, tags, section.table("i4", count, 1 + tags + self._width(kind)))

    def _place_of(self, groups: tuple[int, ...]) -> int:
        """The place of physical groups in the list of such sets."""
        return self._groups.setdefault(groups, len(self._groups))

    def _width(self, kind: int) -> int:
        if kind not in _TYPES:
            raise FormatError(
                f"elements of the type {kind} are not read here; gmsh FILE.msh -order 2 -save -o NEW.msh"
            )
        return int(re.sub(r"\D", "", _TYPES[kind]))

    def _cell(self, kind: int, tags: int, rows: Any) -> _Cells:
        """Cells of rows: a number, tags, the first of which is the physical group, and nodes."""
        shape, table = _TYPES[kind].rstrip("0123456789"), rows.astype(np.int64)
        nodes, edges = table[:, 1 + tags :], _EDGES.get(shape)
        if edges and nodes.shape[1] > min(edges):
            nodes = nodes[:, [*range(min(edges)), *edges]]
        groups = np.zeros(len(table), np.int64)
        if tags:
            groups = np.abs(table[:, 1])
        different, inverse = np.unique(groups, return_inverse=True)
        places: list[int] = []
        for group in different.tolist():
            sets: tuple[int, ...] = (group,)
            if not group:
                sets = ()
            places.append(self._place_of(sets))
        return shape, table[:, 0], np.array(places, np.int64)[inverse.ravel()], nodes

    def _groups_of_entities(self) -> dict[tuple[int, int], tuple[int, ...]]:
        """The physical groups of entities by their dimensions and numbers."""
        groups_by_entity = dict[tuple[int, int], tuple[int, ...]]()
        for name in ("Entities", "PartitionedEntities"):
            section, is_part = self._section(name), name != "Entities"
            if not section:
                continue
            if is_part:
                _, ghosts = section.counts(2)
                section.take("i4", 2 * ghosts)
            for dimension, count in enumerate(section.counts(4)):
                box = 6
                if dimension == 0 and self._version > 4:
                    box = 3
                for _ in range(count):
                    (entity,) = section.counts(1, "i4")
                    if is_part:
                        section.take("i4", 2)  # of which entity it is a part
                        section.take("i4", section.count())
                    section.take("f8", box)
                    groups = section.counts(section.count(), "i4")
                    if dimension:
                        section.take("i4", section.count())
                    groups_by_entity[dimension, entity] = tuple(sorted({*map(abs, groups)}))
        return groups_by_entity

    def _values(self, section: bytes) -> tuple[str, float, Ints, Doubles]:
        """The name of values, their time, the numbers that they are of, and a row for each."""
        tags = list[list[bytes]]()
        for _ in range(3):
            count, *lines = section.split(b"\n", 1)
            *row, section = lines[0].split(b"\n", int(count))
            tags.append(row)
        name, time = tags[0][0], tags[1][0]
        _, width, rows = tags[2][:3]
        numbers, values = _Numbers(section, self._binary).rows(int(rows), int(width))
        return name.decode("utf-8", "replace").strip().strip('"'), float(time), numbers, values

    def surface(self, step: int, losses: Sequence[str] = ()) -> Polygons:
        """The surface at one of the times."""
        most = max((nodes.shape[1] for *_, nodes in self.cells), default=0)
        tables = [np.zeros((0, 2 + most), np.int64)]  # dimensions, groups and nodes
        for shape, _, group, nodes in self.cells:
            table = np.pad(nodes, ((0, 0), (2, most - nodes.shape[1])), constant_values=-1)
            table[:, 0] = _DIMENSIONS.get(shape, 3)
            table[:, 1] = group
            tables.append(table)
        rows = np.concatenate(tables)
        # Version 2.2 writes an element again for each further group of it.
        alike: Ints = row_numbers(np.delete(rows, 1, axis=1)).astype(np.int64)
        _, first_rows = np.unique(alike, return_index=True)
        is_kept = np.zeros(len(alike), np.bool_)
        is_kept[first_rows] = True
        cells: list[tuple[str, Ints]] = []
        begin = 0
        for shape, _, _, nodes in self.cells:
            end = begin + len(nodes)
            cells.append((shape, nodes[is_kept[begin:end]]))
            begin = end
        of_nodes, of_cells = dict[str, Any](), dict[str, Any]()
        for (kind, name), steps in self._series.items():
            place = step
            if len(steps) <= 1:
                place = 0
            numbers, step_values = [*steps.values()][place]
            values = self._table(kind, numbers, step_values)
            if kind == "NodeData":
                of_nodes[name] = values
            else:
                of_cells[name] = values[is_kept]
        metadata, group_columns, lost, notes = self._named_groups(rows[:, :2], alike, is_kept)
        lost = [*self.keywords.notes, *lost, *losses]
        polygons = skin(self.points, cells, of_nodes, of_cells | group_columns, lost, metadata)
        return replace(polygons, notes=(*polygons.notes, *notes))

    def _pairs(self, owned: Ints, alike: Ints) -> tuple[Ints, int]:
        """The numbers of cells with the dimension and a group each, 0 for none, and how many pairs are there again."""
        sets = [groups or (0,) for groups in self._groups]
        flat = np.array([*chain(*sets)])
        sizes = np.array([*map(len, sets)])
        begins = np.cumsum(sizes) - sizes
        dimensions, places = owned.T
        counts = sizes[places]
        self._require_memory(_COPIES * 3 * AS_NUMBERS * int(counts.sum()))  # three columns
        groups = flat[ranges(begins[places], counts)]
        every = np.column_stack([np.repeat(alike, counts), np.repeat(dimensions, counts), groups])
        pairs = np.unique(every, axis=0)
        return pairs, len(every) - len(pairs)

    def _named_groups(
        self, owned: Ints, alike: Ints, is_kept: Any
    ) -> tuple[dict[str, str], dict[str, Any], list[str], list[str]]:
        """The groups of cells, whose dimensions and sets of groups are `owned`; equal cells have one number in `alike`.

        The metadata, an array for the cells that are kept, or one for each group if cells have several, losses, notes.
        """
        pairs, again = self._pairs(owned, alike)
        lost: list[str] = []
        if again:
            lost.append(f"elements that are there again ({again})")
        names = dict(self._names)
        grouped = pairs[pairs[:, 2] > 0]
        table, inverse = np.unique(grouped[:, 1:], axis=0, return_inverse=True)
        cells, groups = grouped[:, 0], inverse.ravel()
        kinds = [*map(tuple, table.tolist())]
        group_names = [names.pop(kind, str(kind[1])) for kind in kinds]
        lost += [f"the group {name}" for name in names.values()]
        if not kinds:
            return {}, {}, lost, []
        faces = cells[grouped[:, 1] > 1]
        further = len(faces) - len(np.unique(faces))
        masks = dict[str, Any]()
        if further and len(kinds) <= _MOST_GROUPS:
            self._require_memory(_COPIES * len(alike) * len(kinds))
            is_in = np.zeros((len(alike), len(kinds)), np.uint8)
            is_in[cells, groups] = 1
            is_in = is_in[alike[is_kept]]
            # The first group first.
            not_in, places = np.unique(1 - is_in, axis=0, return_inverse=True)
            together = [" + ".join(np.array(group_names)[row == 0].tolist()) for row in not_in]
            for (dimension, _), name, marks in zip(kinds, group_names, is_in.T, strict=True):
                if dimension > 1 and name in masks:
                    masks[f"{name} ({dimension}D)"] = marks
                elif dimension > 1:
                    masks[name] = marks
        else:
            if further:
                lost.append(f"further groups of faces that are in several ({further})")
            first = np.full(len(alike), len(kinds))
            np.minimum.at(first, cells, groups)
            used, places = np.unique(first[alike[is_kept]], return_inverse=True)
            together = [[*group_names, ""][place] for place in used.tolist()]
        metadata = named([name or "0" for name in together], "group")
        columns: dict[str, Any] = {}
        if len(together) > 1:
            columns["group"] = places.ravel().astype(np.int32)
        notes: list[str] = []
        if masks:
            mask_names = ", ".join(masks)
            notes.append(
                f"faces are in several groups, each of which is an attribute: {mask_names}"
            )
        return metadata, columns | masks, lost, notes


def _names_in(section: bytes) -> dict[tuple[int, int], str]:
    """Return the names of physical groups by their dimensions and numbers."""
    rows = re.findall(rb'^[ \t]*(\d{1,9})[ \t]+(\d{1,9})[ \t]+"(.*)"', section, re.M)
    return {
        (int(dimension), int(number)): name.decode("utf-8", "replace")
        for dimension, number, name in rows
    }


def read_gmsh_mesh(data: bytes, limits: Limits) -> Polygons:
    """Read the surfaces of a file with the values of the first time."""
    model = _Gmsh(data, limits)
    later = len(model.times) - 1
    losses: list[str] = []
    if later:
        losses.append(f"later steps ({later})")
    return model.surface(0, losses)


def read_gmsh(path: str, request: Wanted, limits: Limits) -> Frames | None:
    """The times of values as frames; None if there is one."""
    data = Path(path).read_bytes()
    model = _Gmsh(data, limits)
    return read_steps(model.surface, model.times, len(data), request, limits)
