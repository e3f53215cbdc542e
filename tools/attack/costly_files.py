"""Files of meshes that repeat one or a few constructions of their format, for the search of `costly`.

A way is a construction that a file may repeat: it gives the text of so many of them. `parts` are the ways of a recipe
with their counts. Files are written to a folder of their own, and read as a service does without isolation.
"""

import io
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

import bsm
from bsm.bitstream.errors import BsmError
from tools.attack.taken import Taken

MOST, MOST_BYTES = 1 << 16, 1 << 20
Way = Callable[[int], str]


def _each(text: str) -> Way:
    """Repeat a text, in which # is a number that grows, and ## the next one."""
    return lambda count: "".join(
        text.replace("##", str(n + 1)).replace("#", str(n)) for n in range(10, 10 + count)
    )


def _nodes_of(text: str) -> Way:
    """Repeat a text with three numbers of nodes."""
    return lambda count: "".join(
        text.format(n, 3 * n, 3 * n + 1, 3 * n + 2, n + 1) for n in range(10, 10 + count)
    )


def _in_names(way: Way) -> Way:
    """Put a way into the names of groups of Gmsh."""
    return lambda count: f"$PhysicalNames\n{way(count)}x\n$EndPhysicalNames\n"


_SYSTEM = (
    "GRID,{1},{4},0.,0.,0.\nGRID,{2},{4},0.,0.,1.\nGRID,{3},{4},1.,0.,0.\nCORD1R,{0},{1},{2},{3}\n"
)
_COMMON: Mapping[str, Way] = {
    "blank lines": lambda count: "\n" * count,
    "blanks": lambda count: " " * count + "\n",
    "commas": lambda count: "," * count + "\n",
    "letters": lambda count: "A" * count + "\n",
}
_VALUE = '$NodeData\n1\n"{}"\n1\n{}\n3\n0\n1\n1\n1 2.5\n$EndNodeData\n'
_POINTS = "".join(f"{n} {n % 7} {n % 5} {n / 100}\n" for n in range(1, 501))
_ARRAY = '<DataArray type="Float32" Name="a#" format="ascii">0 1 2</DataArray>\n'
_ITEM = '<DataItem Dimensions="{}" Format="XML">{}</DataItem>'
_SHAPE = (
    f'<Topology TopologyType="Triangle">{_ITEM.format("1 3", "0 1 2")}</Topology>'
    f'<Geometry GeometryType="XYZ">{_ITEM.format("3 3", "0 0 0 1 0 0 0 1 0")}</Geometry>'
)
_NASTRAN = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nCTRIA3,1,1,1,2,3\n"
_ABAQUS = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n*ELEMENT, TYPE=S3\n1,1,2,3\n"
_PLY = "".join(f"property float {axis}\n" for axis in "xyz")
_VTP = (
    '<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="3" NumberOfPolys="1"><PointData>{}</PointData><Points>'
    '<DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points><Polys>'
    '<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>'
    '<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray></Polys></Piece></PolyData></VTKFile>'
)

FILES: Mapping[str, tuple[str, str, Mapping[str, Way]]] = {
    "nastran": (
        "nas",
        f"BEGIN BULK\n{{}}\n{_NASTRAN}ENDDATA\n",
        {
            **_COMMON,
            "nodes": _each("GRID,#,,#.,0.,1.\n"),
            "nodes in systems": _each(
                "CORD2R,#,,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.\nGRID,#,#,1.,2.,3.\n"
            ),
            "systems in systems": _each("CORD2R,#,##,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.\n"),
            "systems of nodes": _nodes_of(_SYSTEM),
            "faces": _each("CTRIA3,#,1,1,2,3\n"),
            "lines that go on": _each("GRID*,#\n*\n"),
            "includes": _each("INCLUDE '#.bdf\n"),
        },
    ),
    "abaqus": (
        "inp",
        f"*HEADING\nx\n{_ABAQUS}{{}}\n",
        {
            **_COMMON,
            "nodes": lambda count: "*NODE\n" + _each("#,0,0,1\n")(count),
            "elements": lambda count: "*ELEMENT, TYPE=S3\n" + _each("#,1,2,3\n")(count),
            "keywords": _each("*ELSET, ELSET=E#\n1\n"),
            "a keyword that goes on": lambda count: "*ELSET,\n" + "A=B,\n" * count,
            "blocks of nodes": _each("*NODE\n#,0,0,1\n"),
            "sets": _each("*ELEMENT, TYPE=S3, ELSET=E#\n#,1,2,3\n"),
            "includes": _each("*NODE, INPUT\n"),
        },
    ),
    "gmsh": (
        "msh",
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n500\n{_POINTS}$EndNodes\n$Elements\n1\n"
        "1 2 2 1 1 1 2 3\n$EndElements\n{}",
        {
            **{name: _in_names(way) for name, way in _COMMON.items()},
            "groups": _in_names(_each('2 # "g#"\n')),
            "sections": _each("$Comments\n$EndComments\n"),
            "times": lambda count: "".join(_VALUE.format("a", n) for n in range(count)),
            "names": lambda count: "".join(_VALUE.format(n, 0) for n in range(count)),
        },
    ),
    "xdmf": (
        "xdmf",
        f'<Xdmf><Domain><Grid Name="g" GridType="Collection"><Grid Name="h">{_SHAPE}</Grid>{{}}</Grid></Domain></Xdmf>',
        {
            "grids": _each(f'<Grid Name="g#">{_SHAPE}</Grid>'),
            "shapes": _each(f'<Grid Name="g#">{_SHAPE.replace("1 0 0", "1 0 #")}</Grid>'),
            "attributes": lambda count: (
                f'<Grid Name="m">{_SHAPE}'
                + _each(f'<Attribute Name="a#">{_ITEM.format(3, "1 2 3")}</Attribute>')(count)
                + "</Grid>"
            ),
            "references": _each(
                '<Grid Name="r#"><Topology Reference="/Xdmf/Domain/Grid/Grid[1]/Topology[1]"/>'
                "<Geometry Reference=\"//Grid[@Name='h']/Geometry\"/></Grid>"
            ),
            "remarks": _each('<Information Name="i#"/>'),
            "blank lines": lambda count: "\n" * count,
        },
    ),
    "vtp": (
        "vtp",
        _VTP,
        {"arrays": _each(_ARRAY), "one array": lambda count: _ARRAY + "\n" * count},
    ),
    "obj": (
        "obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\n{}\nf 1 2 3\n",
        {
            **_COMMON,
            "vertices": _each("v # 0 1\n"),
            "faces": _each("f 1 2 3\n"),
            "a polygon": lambda count: "f" + " 1 2 3" * count + "\n",
            "materials": _each("usemtl m#\nf 1 2 3\n"),
            "groups": _each("g g#\nf 1 2 3\n"),
            "remarks": _each("#ff\n"),
            "lines that go on": lambda count: "\\\n" * count,
            "libraries": _each("mtllib m#.mtl\n"),
        },
    ),
    "ply": (
        "ply",
        f"ply\nformat ascii 1.0\n{{}}element vertex 3\n{_PLY}element face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        {
            "remarks": _each("comment c#\n"),
            "elements": _each("element e# 0\n"),
            "properties": lambda count: "element e 0\n" + _each("property float p#\n")(count),
            "images": _each("comment TextureFile t#.png\n"),
        },
    ),
    "npz": (
        "npz",
        "",
        {"metadata": lambda count: "m" * count, "arrays": lambda count: "a" * count},
    ),
}
"""Formats: their suffix, a sound file with a place for the ways, and these."""


@dataclass(frozen=True)
class File:
    """A file of a format with some ways, each so many times."""

    kind: str
    parts: tuple[tuple[str, int], ...]

    @property
    def data(self) -> bytes:
        """The file, cut where it is too long to be small."""
        suffix, text, ways = FILES[self.kind]
        inside = "".join(ways[way](count)[:MOST_BYTES] for way, count in self.parts)
        if suffix != "npz":
            return text.replace("{}", inside).encode()
        buffer = io.BytesIO()
        arrays: dict[str, Any] = {"positions": np.eye(3), "faces": np.array([[0, 1, 2]])}
        arrays |= {
            f"{'meta.x' if letter == 'm' else 'vertex.x'}{n}": np.zeros(3)
            for n, letter in enumerate(inside[:4096])
        }
        np.savez(buffer, **arrays)
        return buffer.getvalue()


def drawn_file(kind: str, random: Random) -> File:
    """Any file of a format."""
    ways = random.sample(
        list(FILES[kind][2]), random.choice((1, 1, 1, 2)) if len(FILES[kind][2]) > 1 else 1
    )
    return File(kind, tuple((way, int(2 ** random.uniform(4, 16))) for way in ways))


def changed_file(file: File, random: Random) -> File:
    """The file with more or less of one way, or with another one."""
    place = random.randrange(len(file.parts))
    way, count = file.parts[place]
    if random.random() < 0.3:
        way = random.choice(list(FILES[file.kind][2]))
    count = min(max(int(count * 2 ** random.uniform(-1.5, 1.5)), 1), MOST)
    return replace(file, parts=(*file.parts[:place], (way, count), *file.parts[place + 1 :]))


def read_file(file: File) -> Taken:
    """Read a file that is trusted, and encode it."""
    data = file.data
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"a.{FILES[file.kind][0]}")
        path.write_bytes(data)
        try:
            stream = bsm.encode(bsm.read_mesh(path).mesh, threads=1)
            return Taken(f"{len(stream)} bytes", len(data))
        except BsmError as error:
            return Taken(f"{type(error).__name__}: {error}", len(data))
