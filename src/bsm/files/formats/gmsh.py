"""Gmsh meshes of the formats 2 and 4.1, in text and binary: surfaces, the skin of volumes, physical groups and data.

Sections are one array of numbers each, in text, or are read by their layout. Nodes, elements and values go by their
numbers. Sections in keywords.csv are harmless; all others refuse the file. Data of several times are a sequence.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.errors import FormatError, TruncatedError
from bsm.bitstream.limits import Limits
from bsm.files.formats.cells import runs, skin
from bsm.files.formats.lines import Keywords, by_number
from bsm.files.formats.metadata import named
from bsm.files.formats.polygons import CutAlike, MeshFile, Polygons
from bsm.files.motion.folder import read_files
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.parsing import Doubles, Ints, as_format_error, require_counts

_KINDS = {
    1: ("line", 2), 2: ("triangle", 3), 3: ("quad", 4), 4: ("tetra", 4), 5: ("hexahedron", 8), 6: ("wedge", 6),
    7: ("pyramid", 5), 8: ("line", 3), 9: ("triangle", 6), 10: ("quad", 9), 11: ("tetra", 10), 12: ("hexahedron", 27),
    13: ("wedge", 18), 14: ("pyramid", 14), 15: ("vertex", 1), 16: ("quad", 8), 17: ("hexahedron", 20),
    18: ("wedge", 15), 19: ("pyramid", 13), 26: ("line", 4), 27: ("line", 5), 28: ("line", 6),
}  # fmt: skip
"""Kinds of elements by their numbers: shapes, and how many nodes they have."""
_ORDER = {
    "tetra": (10, [*range(8), 9, 8]), "pyramid": (13, [*range(6), 8, 10, 6, 7, 9, 11, 12]),
    "wedge": (15, [*range(7), 9, 7, 12, 14, 13, 8, 10, 11]),
    "hexahedron": (20, [*range(9), 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15]),
}  # fmt: skip
"""Where the nodes on edges are of quadratic elements; those amid sides and cells come after these, and are left out."""
_WAY = "write it as .vtu, e.g. with gmsh -o x.vtu, or in the format 4.1"
_SECTION = re.compile(rb"\$(\w+)[ \t\r]*\n")


class _Numbers:
    """The numbers of a section, one after the other: all are words, or bytes in the order of the file."""

    def __init__(self, data: bytes, binary: bool, order: str) -> None:
        self._data, self._order, self._at = data, order if binary else "", 0
        try:
            self._words: Any = None if binary else np.array(data.split(), np.float64)
        except ValueError as error:
            raise FormatError(f"a section of this file is not made of numbers: {error}") from None

    def take(self, count: int, kind: str) -> Any:
        """Some numbers: "i4", "u8" or "f8"."""
        size = np.dtype(kind).itemsize if self._order else 1
        whole = len(self._data) if self._order else len(self._words)
        if not 0 <= count * size <= whole - self._at:
            raise TruncatedError(f"a section of this file is cut short: {count} numbers from {self._at} on")
        begin, self._at = self._at, self._at + count * size
        if not self._order:
            return self._words[begin : self._at].astype("f8" if kind == "f8" else "i8")
        found = np.frombuffer(self._data, self._order + kind, count, begin)
        return found.astype("f8" if kind == "f8" else "i8")

    def rows(self, count: int, kinds: Sequence[str]) -> list[Any]:
        """Columns of rows of mixed numbers."""
        if not self._order:
            table = self.take(count * len(kinds), "f8").reshape(count, len(kinds))
            return [table[:, place].astype("f8" if kind == "f8" else "i8") for place, kind in enumerate(kinds)]
        row = np.dtype([(str(place), self._order + kind) for place, kind in enumerate(kinds)])
        data = self.take(count * row.itemsize, "u1").astype("u1").view(row)
        return [data[str(place)].astype("f8" if kind == "f8" else "i8") for place, kind in enumerate(kinds)]


class _Mesh:
    """The nodes, elements, groups and values of a file."""

    def __init__(self, data: bytes, limits: Limits) -> None:
        self._keywords, self._limits = Keywords("gmsh", _WAY), limits
        self.version, self._binary, self._order = 0.0, False, "<"
        self.numbers, self.points = np.empty(0, np.int64), np.empty((0, 3))
        self.blocks: list[tuple[int, Ints, Ints, Ints]] = []  # a kind, numbers, nodes, and groups of elements
        self.names: dict[tuple[int, int], str] = {}  # of groups, by their dimension and number
        self._groups: dict[tuple[int, int], int] = {}  # of entities
        self.values: dict[tuple[str, str], dict[float, tuple[Ints, Doubles]]] = {}
        at, seen = 0, dict[str, bytes]()
        while found := _SECTION.search(data, at):
            name, line = found[1].decode(), data.count(b"\n", 0, found.start()) + 1
            end = data.find(b"$End" + found[1], found.end())
            if end < 0:
                raise TruncatedError(f"line {line}: ${name} does not end")
            section, at = data[found.end() : end], end + 4 + len(name)
            if name not in _SECTIONS:
                self._keywords.leave(name, line)
            elif name.endswith("Data") or name not in seen:
                seen[name] = section
                _SECTIONS[name](self, section)
            elif seen[name] != section:  # the same again is what Gmsh writes with a view
                raise self._keywords.refusal(f"another ${name}", line)
        if not self.version:
            raise FormatError("this is not a Gmsh mesh: it has no $MeshFormat")

    def _format(self, data: bytes) -> None:
        version, binary, size = data.split()[:3]
        self.version, self._binary = float(version), binary == b"1"
        if self.version not in (2.0, 2.1, 2.2, 4.1) or size != b"8":
            raise FormatError(f"Gmsh meshes of the format {version.decode()} are not read here; {_WAY}")
        if self._binary and data.split(b"\n", 1)[1][:4] == b"\0\0\0\1":
            self._order = ">"

    def _nodes(self, data: bytes) -> None:
        if self.version < 4:
            head, data = data.split(b"\n", 1)
            require_counts(self._limits, vertices=int(head))
            rows = _Numbers(data, self._binary, self._order).rows(int(head), ("i4", "f8", "f8", "f8"))
            self.numbers, self.points = rows[0], np.column_stack(rows[1:])
            return
        section = _Numbers(data, self._binary, self._order)
        blocks, count, _, _ = section.take(4, "u8").tolist()
        require_counts(self._limits, vertices=count)
        numbers, points = list[Ints](), list[Doubles]()
        for _ in range(blocks):
            dimension, _, parametric = section.take(3, "i4").tolist()
            size = int(section.take(1, "u8")[0])
            numbers.append(section.take(size, "u8"))
            width = 3 + (dimension if parametric else 0)
            points.append(section.take(size * width, "f8").reshape(size, width)[:, :3])
        self.numbers, self.points = np.concatenate([self.numbers, *numbers]), np.concatenate([self.points, *points])

    def _elements(self, data: bytes) -> None:
        if self.version < 4:
            self._elements_2(data)
            return
        section = _Numbers(data, self._binary, self._order)
        for _ in range(int(section.take(4, "u8")[0])):
            dimension, entity, kind = section.take(3, "i4").tolist()
            count, width = int(section.take(1, "u8")[0]), self._known(kind)
            table = section.take(count * (1 + width), "u8").reshape(count, 1 + width)
            group = self._groups.get((dimension, entity), 0)
            self.blocks.append((kind, table[:, 0], table[:, 1:], np.full(count, group)))

    def _elements_2(self, data: bytes) -> None:
        head, data = data.split(b"\n", 1)
        left, section = int(head), _Numbers(data, self._binary, self._order)
        if not self._binary:
            flat = section.take(len(data.split()), "i4")
            for table in runs(flat, lambda row: (3 + int(row[2]) + self._known(int(row[1])), slice(1, 3))):
                kind, tags = table[0, 1:3].tolist()
                group = table[:, 3] if tags else np.zeros(len(table), np.int64)
                self.blocks.append((kind, table[:, 0], table[:, 3 + tags :], group))
            return
        while left > 0:
            kind, count, tags = section.take(3, "i4").tolist()
            width = 1 + tags + self._known(kind)
            table = section.take(count * width, "i4").reshape(count, width)
            group = table[:, 1] if tags else np.zeros(count, np.int64)
            self.blocks.append((kind, table[:, 0], table[:, 1 + tags :], group))
            left -= max(count, 1)

    def _known(self, kind: int) -> int:
        if kind not in _KINDS:
            raise FormatError(f"$Elements has elements of the type {kind}, which are not read here; {_WAY}")
        return _KINDS[kind][1]

    def _entities(self, data: bytes) -> None:
        section = _Numbers(data, self._binary, self._order)
        for dimension, count in enumerate(section.take(4, "u8").tolist()):
            for _ in range(count):
                number = int(section.take(1, "i4")[0])
                section.take(6 if dimension else 3, "f8")
                groups = section.take(int(section.take(1, "u8")[0]), "i4")
                if dimension:
                    section.take(int(section.take(1, "u8")[0]), "i4")
                if len(groups):
                    self._groups[dimension, number] = int(groups[0])

    def _physical(self, data: bytes) -> None:
        for found in re.finditer(rb'(\d+)[ \t]+(-?\d+)[ \t]+"([^"]*)"', data):
            self.names[int(found[1]), int(found[2])] = found[3].decode("utf-8", "replace")

    def _data(self, data: bytes, domain: str) -> None:
        tags, at = list[list[str]](), 0
        for _ in range(3):
            lines = data[at:].split(b"\n", 1 + int(data[at:].split(b"\n", 1)[0]))
            tags.append([line.decode("utf-8", "replace").strip().strip('"') for line in lines[1:-1]])
            at = len(data) - len(lines[-1])
        (name, *_), reals, (_, width, count, *_) = tags
        rows = _Numbers(data[at:], self._binary, self._order).rows(int(count), ["i4", *["f8"] * int(width)])
        time = float(reals[0]) if reals else 0.0
        of_name = self.values.setdefault((domain, name), {})
        if time in of_name:
            raise FormatError(f"the values of {name} at the time {time:g} are there twice")
        of_name[time] = rows[0], np.column_stack(rows[1:])

    @property
    def times(self) -> list[float]:
        """The times of values that change."""
        return sorted({time for of_name in self.values.values() if len(of_name) > 1 for time in of_name})

    def surface(self, step: int = 0) -> Polygons:
        """The surface with the values of a step; values that have only one time are those of all steps."""
        time = self.times[step] if self.times else 0.0
        elements = np.concatenate([np.empty(0, np.int64), *(numbers for _, numbers, _, _ in self.blocks)])
        rows = {"vertex": self.numbers, "cell": elements}
        found: dict[str, dict[str, Any]] = {"vertex": {}, "cell": {}}
        for (domain, name), of_name in self.values.items():
            if time not in of_name and len(of_name) > 1:
                raise FormatError(f"{name} has no values at the time {time:g}, which others have; {_WAY}")
            asked, values = of_name.get(time) or next(iter(of_name.values()))
            found[domain][name] = np.full((len(rows[domain]), values.shape[1]), np.nan)
            found[domain][name][by_number(rows[domain], asked, "element" if domain == "cell" else "node")] = values
        groups = np.concatenate([np.empty(0, np.int64), *(group for _, _, _, group in self.blocks)])
        dims = np.repeat([_dimension(kind) for kind, *_ in self.blocks], [len(n) for _, n, _, _ in self.blocks])
        pairs, places = np.unique(np.column_stack([dims, groups]), axis=0, return_inverse=True)
        known = [self.names.get((dim, number), str(number)) for dim, number in pairs.tolist()]
        metadata = named(known, "group") if any(groups) else {}
        found["cell"] |= {"group": places.ravel().astype(np.int32)} if len(pairs) > 1 else {}
        blocks = []
        for kind, _, nodes, _ in self.blocks:
            shape, width = _KINDS[kind][0], nodes.shape[1]
            taken = _ORDER[shape][1] if width >= _ORDER.get(shape, (99,))[0] else [*range(width)]
            blocks.append((shape, by_number(self.numbers, nodes)[:, taken]))
        return skin(self.points, blocks, found["vertex"], found["cell"], self._keywords.named, metadata)


def _dimension(kind: int) -> int:
    return {"vertex": 0, "line": 1, "triangle": 2, "quad": 2}.get(_KINDS[kind][0], 3)


_SECTIONS: dict[str, Callable[[_Mesh, bytes], None]] = {
    "MeshFormat": _Mesh._format, "Nodes": _Mesh._nodes, "Elements": _Mesh._elements, "Entities": _Mesh._entities,
    "PhysicalNames": _Mesh._physical, "NodeData": lambda mesh, data: mesh._data(data, "vertex"),
    "ElementData": lambda mesh, data: mesh._data(data, "cell"),
}  # fmt: skip


def read_gmsh_mesh(data: bytes, path: str | None, limits: Limits) -> Polygons:
    """The mesh of a file, with the values of the first time."""
    with as_format_error("Gmsh mesh"):
        mesh = _Mesh(data, limits)
        found = mesh.surface()
    later = [f"later steps ({len(mesh.times) - 1})"] if mesh.times else []
    return replace(found, dropped=(*found.dropped, *later))


def read_gmsh(path: str, wanted: Wanted, limits: Limits) -> Frames | None:
    """The times of values as frames; None if there are not several."""
    data, cut = Path(path).read_bytes(), CutAlike()
    with as_format_error("Gmsh mesh"):
        mesh = _Mesh(data, limits)

    def read(name: str) -> MeshFile:
        with as_format_error("Gmsh mesh"):
            return mesh.surface(int(name)).checked(limits, len(data), cut)

    names = [*map(str, range(len(mesh.times)))]
    return read_files(names, read, replace(wanted, times=mesh.times)) if names else None
