"""Gmsh meshes by meshio: surfaces, the skin of volumes, and physical groups (the extra `simulation`).

meshio keeps values by their places, and those of one time only. So they are read here, by the numbers of nodes and
elements, from text, and their times are the frames of a sequence. Values in binary refuse a file. So does a section
that is there twice with other contents, or that is not in keywords.csv.
"""

import io
import re
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.errors import FormatError, imported
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.welding import row_numbers
from bsm.files.formats.cells import skin
from bsm.files.formats.lines import Keywords, by_number
from bsm.files.formats.metadata import named
from bsm.files.formats.polygons import Polygons
from bsm.files.motion.folder import read_steps
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.parsing import Ints, as_library_error, in_words

_GROUP, _VALUES = "gmsh:physical", ("NodeData", "ElementData")
MOST_GAPS = 16  # numbers of nodes for each node, on average
_WAY = "write it as text without that, e.g. gmsh FILE.msh -save -bin 0 -o NEW.msh"


class _Gmsh:
    """The cells of a file, the groups that name them, and values by time."""

    def __init__(self, data: bytes, path: str | None) -> None:
        if path is None:
            raise FormatError("this format is read from an uncompressed file with a name")
        self.keywords, sections = Keywords("gmsh", _WAY), dict[str, list[bytes]]()
        for found in re.finditer(rb"^\$(?!End)(\w+)[^\n]*\n(.*?)(?=^\$End\1|\Z)", data, re.M | re.S):
            name, line = found[1].decode(), data.count(b"\n", 0, found.start()) + 1
            known = sections.setdefault(name, [])
            if known and name not in _VALUES and found[2] not in known:  # Gmsh writes all again for each view
                raise self.keywords.refusal(f"another ${name}", line)
            known.append(found[2])
            self.keywords.leave(name, line)
        with as_library_error("meshio"), redirect_stderr(io.StringIO()), redirect_stdout(io.StringIO()):
            library = imported("meshio", "Gmsh meshes are read with meshio", "simulation").gmsh
            version, binary, _ = sections.get("MeshFormat", [b"0 0 0"])[0].split()[:3]
            if binary != b"0" and any(name in sections for name in _VALUES):
                raise FormatError(f"this file has values in binary, which are not read here; {_WAY}")
            # meshio makes a table of all numbers up to the largest.
            if "Nodes" in sections:
                section = sections["Nodes"][0]
                is_text = binary == b"0"
                nodes = _tags(section, version.startswith(b"4"), True) if is_text else _binary_tags(section, version)
                if len(nodes) and nodes.max() > MOST_GAPS * (len(nodes) + 65536):
                    far = f"node {nodes.max()} of {len(nodes)} nodes: numbers that far apart are not read"
                    raise FormatError(f"{far}; number them anew, e.g. gmsh FILE.msh -save -o NEW.msh")
            try:
                self.mesh = library.read(path)
            except Exception as error:
                raise FormatError(f"meshio cannot read this file: {in_words(error)}; {_WAY}") from error
            self._series: dict[tuple[str, str], dict[float, Any]] = {}
            for kind, section in ((whose, one) for whose in _VALUES for one in sections.get(whose, ())):
                of_nodes = kind == "NodeData"
                called, time, asked, values = _values(section)
                tagged = sections["Nodes" if of_nodes else "Elements"][0]
                numbers = _tags(tagged, version.startswith(b"4"), of_nodes)
                rows = np.full((len(numbers), values.shape[1]), np.nan)
                rows[by_number(numbers, asked, "node" if of_nodes else "element")] = values
                if self._series.setdefault((kind, called), {}).setdefault(time, rows) is not rows:
                    raise FormatError(f"the values {called} are there twice for the time {time:g}")
        moving = [[*steps] for steps in self._series.values() if len(steps) > 1] or [[0.0]]
        if any(times != moving[0] for times in moving):
            raise FormatError(f"values have times of their own each; {_WAY}")
        self.times = moving[0]

    def surface(self, step: int, left: Sequence[str] = ()) -> Polygons:
        """The surface at one of the times."""
        mesh = self.mesh
        cells, again = [(block.type, block.data) for block in mesh.cells], np.zeros(sum(map(len, mesh.cells)), np.bool_)
        ends = np.cumsum([len(table) for _, table in cells])
        for kind in {kind for kind, _ in cells}:  # version 2.2 writes an element again for each further group of it
            those = [place for place, (name, _) in enumerate(cells) if name == kind]
            places = np.concatenate([np.arange(ends[place] - len(cells[place][1]), ends[place]) for place in those])
            numbers = row_numbers(np.concatenate([cells[place][1] for place in those]))
            again[np.delete(places, np.unique(numbers, return_index=True)[1])] = True
        cells = [(kind, table[~there]) for (kind, table), there in zip(cells, np.split(again, ends))]
        groups = np.concatenate([np.zeros(0, np.int64), *mesh.cell_data.get(_GROUP, [])]).astype(np.int64)
        groups = groups[~again] if len(groups) else groups
        rows: dict[str, dict[str, Any]] = {"NodeData": {}, "ElementData": {}}
        for (kind, called), steps in self._series.items():
            values = [*steps.values()][step if len(steps) > 1 else 0]
            rows[kind][called] = values if kind == "NodeData" else values[~again]
        dims = np.repeat([block.dim for block in mesh.cells], [len(table) for _, table in cells])
        names = {(int(dim), int(number)): name for name, (number, dim) in mesh.field_data.items()}
        owned = np.column_stack([dims, groups]) if any(groups) else np.zeros((0, 2), np.int64)
        pairs, places = np.unique(owned, axis=0, return_inverse=True)
        listed = [*map(tuple, pairs.tolist())]
        metadata = named([names.pop(pair, str(pair[1])) for pair in listed], "group")
        if len(pairs) > 1:
            rows["ElementData"]["group"] = places.ravel().astype(np.int32)
        lost = (*self.keywords.named, *(f"the group {name}" for name in names.values()), *left)
        lost += (f"elements that are there again ({again.sum()})",) if again.any() else ()
        return skin(mesh.points, cells, rows["NodeData"], rows["ElementData"], lost, metadata)


def read_gmsh_mesh(data: bytes, path: str | None, limits: Limits) -> Polygons:
    """Read the surfaces of a file with the values of the first time."""
    model = _Gmsh(data, path)
    later = len(model.times) - 1
    return model.surface(0, [f"later steps ({later})"] if later else [])


def read_gmsh(path: str, wanted: Wanted, limits: Limits) -> Frames | None:
    """The times of values as frames; None if there is one."""
    model = _Gmsh(data := Path(path).read_bytes(), path)
    return read_steps(model.surface, model.times, len(data), wanted, limits)


def _values(section: bytes) -> tuple[str, float, Ints, Any]:
    """The name of values, their time, the numbers that they are of, and a row for each."""
    lines, tags = section.splitlines(), list[list[bytes]]()
    for _ in range(3):
        end = 1 + int(lines[0])
        tags.append(lines[1:end])
        lines = lines[end:]
    (name, *_), (time, *_), (_, width, count, *_) = tags
    table = np.array(b" ".join(lines).split(), np.float64).reshape(int(count), 1 + int(width))
    called = name.decode("utf-8", "replace").strip().strip('"')
    return called, float(time), table[:, 0].astype(np.int64), table[:, 1:]


def _tags(section: bytes, in_blocks: bool, of_nodes: bool) -> Ints:
    """The numbers of nodes or elements, in the order of the file."""
    lines, found, at = section.splitlines(), list[bytes](), 1
    while at < len(lines):
        count = int(lines[at].split()[3]) if in_blocks else len(lines) - 1
        at += in_blocks
        found += [line.split(None, 1)[0] for line in lines[at : at + count]]
        at += count * (1 + (in_blocks and of_nodes))
    return np.array(found, np.int64)


def _binary_tags(section: bytes, version: bytes) -> Ints:
    """The numbers of nodes in a binary file; none of version 2, where meshio takes 1, 2, 3, ... only."""
    is_new, found = version != b"4.0", [np.zeros(0, np.int64)]
    row = np.dtype([("tag", np.int32), ("position", np.float64, 3)])
    count = int(np.frombuffer(section, np.uint64, 1)[0]) if version.startswith(b"4") else 0
    at = 8 * (4 if is_new else 2)
    for _ in range(count):
        nodes = int(np.frombuffer(section, np.uint64, 1, at + 12)[0])
        at += 20
        if is_new:
            found.append(np.frombuffer(section, np.uint64, nodes, at).astype(np.int64))
        else:
            found.append(np.frombuffer(section, row, nodes, at)["tag"].astype(np.int64))
        at += nodes * (32 if is_new else row.itemsize)
    return np.concatenate(found)
