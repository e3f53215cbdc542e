"""Gmsh meshes by meshio: surfaces, the skin of volumes, and physical groups (the extra `simulation`).

meshio keeps values by their places, and those of one time only. So they are read here, by the numbers of nodes and
elements, from text; binary values refuse a file, and so does a section that is there twice or not in keywords.csv.
"""

import io
import re
from contextlib import redirect_stderr, redirect_stdout
from typing import Any

import numpy as np

from bsm.bitstream.errors import FormatError, imported
from bsm.bitstream.limits import Limits
from bsm.files.formats.cells import skin
from bsm.files.formats.lines import Keywords, by_number
from bsm.files.formats.metadata import named
from bsm.files.formats.polygons import Polygons
from bsm.files.parsing import Ints, as_library_error, in_words

_GROUP, _VALUES = "gmsh:physical", ("NodeData", "ElementData")
_WAY = "write it as text without that, e.g. gmsh FILE.msh -save -bin 0 -o NEW.msh"


def read_gmsh(data: bytes, path: str | None, limits: Limits) -> Polygons:
    """Read the cells of a file, the groups that name them, and the values of the first time."""
    if path is None:
        raise FormatError("this format is read from an uncompressed file with a name")
    keywords, sections = Keywords("gmsh", _WAY), dict[str, list[bytes]]()
    for found in re.finditer(rb"^\$(?!End)(\w+)[^\n]*\n(.*?)(?=^\$End\1|\Z)", data, re.M | re.S):
        name, line = found[1].decode(), data.count(b"\n", 0, found.start()) + 1
        known = sections.setdefault(name, [])
        if known and name not in _VALUES:
            raise keywords.refusal(f"another ${name}", line)
        known.append(found[2])
        keywords.leave(name, line)
    with as_library_error("meshio"), redirect_stderr(io.StringIO()), redirect_stdout(io.StringIO()):
        library = imported("meshio", "Gmsh meshes are read with meshio", "simulation").gmsh
        version, binary, _ = sections.get("MeshFormat", [b"0 0 0"])[0].split()[:3]
        if binary != b"0" and any(name in sections for name in _VALUES):
            raise FormatError(f"this file has values in binary, which are not read here; {_WAY}")
        try:
            mesh = library.read(path)
        except Exception as error:
            raise FormatError(f"meshio cannot read this file: {in_words(error)}; {_WAY}") from error
        blocks = [(block.type, block.data) for block in mesh.cells]
        groups = np.concatenate([np.zeros(0, np.int64), *mesh.cell_data.get(_GROUP, [])]).astype(np.int64)
        rows: dict[str, dict[str, Any]] = {"NodeData": {}, "ElementData": {}}
        later = 0
        for kind, section in ((whose, one) for whose in _VALUES for one in sections.get(whose, ())):
            called, asked, values = _values(section)
            if called in rows[kind]:
                later += 1
                continue
            of_nodes = kind == "NodeData"
            tagged = sections["Nodes" if of_nodes else "Elements"][0]
            numbers = _tags(tagged, version.startswith(b"4"), of_nodes)
            rows[kind][called] = np.full((len(numbers), values.shape[1]), np.nan)
            rows[kind][called][by_number(numbers, asked, "node" if of_nodes else "element")] = values
    dims = np.repeat([block.dim for block in mesh.cells], [len(table) for _, table in blocks])
    names = {(int(dim), int(number)): name for name, (number, dim) in mesh.field_data.items()}
    owned = np.column_stack([dims, groups]) if any(groups) else np.zeros((0, 2), np.int64)
    pairs, places = np.unique(owned, axis=0, return_inverse=True)
    metadata = named([names.get((dim, number), str(number)) for dim, number in pairs.tolist()], "group")
    if len(pairs) > 1:
        rows["ElementData"]["group"] = places.ravel().astype(np.int32)
    left = (*keywords.named, *([f"later steps ({later})"] if later else []))
    return skin(mesh.points, blocks, rows["NodeData"], rows["ElementData"], left, metadata)


def _values(section: bytes) -> tuple[str, Ints, Any]:
    """The name of values, the numbers that they are of, and a row for each."""
    lines, tags = section.splitlines(), list[list[bytes]]()
    for _ in range(3):
        count = int(lines[0])
        tags.append(lines[1 : 1 + count])
        lines = lines[1 + count :]
    table = np.array(b" ".join(lines).split(), np.float64).reshape(int(tags[2][2]), 1 + int(tags[2][1]))
    return tags[0][0].decode("utf-8", "replace").strip().strip('"'), table[:, 0].astype(np.int64), table[:, 1:]


def _tags(section: bytes, in_blocks: bool, of_nodes: bool) -> Ints:
    """The numbers of nodes or elements, in the order of the file."""
    lines, found, at = section.splitlines(), list[bytes](), 1
    while at < len(lines):
        count = int(lines[at].split()[3]) if in_blocks else len(lines) - 1
        at += in_blocks
        found += [line.split(None, 1)[0] for line in lines[at : at + count]]
        at += count * (1 + (in_blocks and of_nodes))
    return np.array(found, np.int64)
