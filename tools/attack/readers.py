"""Every reader of mesh files and sequences, with every count and length made as large as its type and its file allow.

`python -m tools.attack readers` walks all of it. Numbers are not listed by hand: in a text each number in turn, in a
binary file each byte, two, four and eight bytes from each offset become as large as they can be. Beside that stand
files that are sound, and large in one place for their bytes. What reading takes is held against the same bounds as
what decoding takes; whatever comes out must be a mesh or an error of ours.
"""

import gzip
import importlib
import importlib.util
import io
import json
import os
import re
import struct
import tempfile
import zipfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import chain, starmap
from pathlib import Path
from types import MappingProxyType
from typing import Any
from unittest import mock

import numpy as np

from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import NAMED_LIMITS, Limits
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.npz import write_npy
from bsm.files.mesh import read_mesh, written_mesh
from bsm.files.motion.frames import Shared, Wanted
from bsm.files.sequence import open_sequence, sequence_writer
from bsm.files.table import MESH_FORMATS, SEQUENCES_READ
from tests.gltf import Built, Tree, glb, unpack
from tests.shapes import ply_head
from tools.attack.taken import Case, Taken, problems_of, report
from tools.command import parser_of
from tools.vectors.good_attributes import charts, colors, groups, with_attributes
from tools.vectors.meshes import patch, torus

HUGE_WORDS = (b"2147483647", b"999999999999999999", b"9" * 400, b"-1", b"1e300")
HUGE_BYTES = tuple(
    bytes.fromhex(code)
    for code in ("ff", "ffff", "ffffff7f", "7fffffff", "ffffffff", "ffffffffffffff7f")
)
_NUMBER = re.compile(rb"(?<![\w.+-])-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?![\w.])")
MOST_SECONDS = 60


@dataclass(frozen=True)
class Sample:
    """A file with what lies beside it."""

    suffix: str
    data: bytes
    beside: tuple[tuple[str, bytes], ...] = ()


Change = Callable[[Tree], None]
DATA_URI = "data:application/octet-stream;base64,"


# ------------------------------------------------------------------------------------------------------------ samples


def _mesh() -> TriangleMesh:
    """A small mesh with something of everything."""
    return replace(with_attributes(torus(3, 3), colors, charts, groups), metadata={"unit": "mm"})


def _written(kind: str) -> bytes:
    """A sequence of three frames in a file of a kind."""
    mesh = torus(3, 3)
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder, f"a.{kind}"))
        with sequence_writer(path, kind, mesh.faces, 3, overwrite=False, shared=Shared()) as write:
            for frame in range(3):
                write(mesh.positions + frame)
        return Path(path).read_bytes()


def strip_of(size: int, each: int) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return the positions and faces of a strip whose vertices take `size` bytes, each `each`."""
    mesh = patch(2, max(2, size // (2 * each)))
    return mesh.positions, mesh.faces


class Scene(Built):
    """A strip of triangles whose vertices take `size` bytes, at a node, and what else grows on it."""

    def __init__(self, size: int) -> None:
        super().__init__()
        positions, faces = strip_of(size, 24)
        self.count = len(positions)
        self.attributes = {"POSITION": self.array(positions.astype("<f4"))}
        self.indices = self.array(faces.astype("<u4").reshape(-1))
        self.primitive: Tree = {"attributes": self.attributes, "indices": self.indices}
        self.mesh(self.primitive)
        self.nodes({"mesh": 0})

    def move(self, until: float = 1.0) -> None:
        """Let the first node move."""
        times, places = np.array([0, until], "<f4"), np.array([[0, 0, 0], [1, 0, 0]], "<f4")
        sampler = {"input": self.array(times), "output": self.array(places)}
        channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
        self.tree["animations"] = [{"samplers": [sampler], "channels": [channel]}]

    def sample(self) -> Sample:
        return Sample("glb", self.bytes)


def _ragged_ply() -> bytes:
    """Polygons of three and of four corners, whose rows differ in length."""
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "<f4").tobytes()
    faces = (
        b"\3" + np.array([0, 1, 2], "<i4").tobytes() + b"\4" + np.arange(4, dtype="<i4").tobytes()
    )
    return ply_head(4, 2, "binary_little_endian").encode() + points + faces


_FACET = (
    b"facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
)
_PVD = b"""<VTKFile type="Collection"><Collection>
<DataSet timestep="0" part="0" file="a.obj"/><DataSet timestep="1.5" part="0" file="b.obj"/>
</Collection></VTKFile>"""
_SERIES = b"""{"file-series-version": "1.0",
"files": [{"name": "a.obj", "time": 0}, {"name": "b.obj", "time": 1.5}]}"""
_MSH = b"""$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
3
1 0 0 0
2 1 0 0
3 0 1 0
$EndNodes
$Elements
1
1 2 2 0 1 1 2 3
$EndElements
$NodeData
1
"p"
1
0.5
3
0
1
3
1 0
2 1
3 2
$EndNodeData
"""
_ASCII_STL = b"solid a\n" + _FACET + b"endsolid a\n"
_USDA = b"""#usda 1.0
(
    defaultPrim = "a"
    startTimeCode = 0
    endTimeCode = 2
    timeCodesPerSecond = 24
)
def Mesh "a"
{
    int[] faceVertexCounts = [3, 3]
    int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    point3f[] points.timeSamples = {
        0: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
        2: [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
    }
    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
}
"""


@cache
def samples() -> dict[str, Sample]:
    """A small sound file of each kind that is read; of USD the text alone: damaged binary ones end usd-core."""
    mesh, plain = _mesh(), written_mesh(torus(3, 3), "obj").data
    beside = (("a.obj", plain),)
    painted = ply_head(more="property uchar red\nproperty uchar green\nproperty uchar blue\n")
    samples_by_name = {
        **{kind: Sample(kind, written_mesh(mesh, kind).data) for kind in (*MESH_FORMATS, "glb")},
        "ply of text": Sample(
            "ply", (painted + "0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n3 0 1 2\n").encode()
        ),
        "ply of polygons": Sample("ply", _ragged_ply()),
        "stl of text": Sample("stl", _ASCII_STL),
        "obj.gz": Sample("obj.gz", gzip.compress(plain, mtime=0)),
        "npz of frames": Sample("npz", _written("npz")),
        "npy": Sample("npy", _written("npy")),
        "pc2": Sample("pc2", _written("pc2"), beside),
        "mdd": Sample("mdd", _written("mdd"), beside),
        "moving glb": Sample("glb", _written("glb")),
        "pvd": Sample("pvd", _PVD, (*beside, ("b.obj", plain))),
        "series": Sample("series", _SERIES, (*beside, ("b.obj", plain))),
    }
    usd = {"usda": Sample("usda", _USDA)} if importlib.util.find_spec("pxr") else {}
    return {**samples_by_name, "msh": Sample("msh", _MSH), **usd}


# -------------------------------------------------------------------------------------------------------- every number


def _with_word(sample: Sample, begin: int, end: int, word: bytes) -> Sample:
    return replace(sample, data=sample.data[:begin] + word + sample.data[end:])


def numbers() -> Iterator[Case]:
    """Each number of each sample as large as it can be, and some less than nothing."""
    for kind, sample in samples().items():
        if b"\0" not in sample.data and sample.suffix != "obj.gz":
            for match in _NUMBER.finditer(sample.data):
                for word in HUGE_WORDS:
                    make = partial(_with_word, sample, match.start(), match.end(), word)
                    yield Case(f"{kind}, number at {match.start()} is {word[:20].decode()}", make)
            continue
        for offset in range(len(sample.data)):
            for word in HUGE_BYTES:
                make = partial(_with_word, sample, offset, offset + len(word), word)
                yield Case(f"{kind}, {word.hex()} at {offset}", make)
        if sample.suffix == "glb":
            yield from _numbers_of_tree(kind, sample)


def _numbers_of_tree(kind: str, sample: Sample) -> Iterator[Case]:
    """Change each number in the JSON of a GLB, and update its length."""
    tree, binary = unpack(sample.data)
    text = json.dumps(tree).encode()
    for match in _NUMBER.finditer(text):
        for word in (b"2147483647", b"20000000", b"9" * 18, b"-1", b"1e300", b'"a"', b"[]"):
            changed = text[: match.start()] + word + text[match.end() :]
            before = text[max(0, match.start() - 20) : match.start()].decode()
            make = partial(_remade, changed, binary)
            yield Case(f"{kind}, {before}{word.decode()} at {match.start()}", make)


def _remade(text: bytes, binary: bytes) -> Sample:
    try:
        return Sample("glb", glb(json.loads(text), binary))
    except ValueError:  # a number in a string
        return Sample("glb", b"glTF" + text)


# ------------------------------------------------------------------------------------------------- large for its bytes


def _text(suffix: str, head: bytes, line: bytes, size: int, tail: bytes = b"") -> Sample:
    return Sample(suffix, head + line * max(1, size // len(line)) + tail)


def _numbered(suffix: str, head: bytes, line: str, size: int, tail: bytes = b"") -> Sample:
    lines = [line.format(number).encode() for number in range(max(1, size // len(line)))]
    return Sample(suffix, head + b"".join(lines) + tail)


def grown(size: int) -> dict[str, Callable[[], Sample]]:
    """Return valid files, or nearly so, of about `size` bytes, each large in one place."""
    makers: dict[str, Callable[[], Sample]] = {}
    triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    for what, line in {
        "points": b"v 0 0 0\n",
        "faces": b"f 1 2 3\n",
        "faces of one corner": b"f 1\n",
        "keywords": b"f\n",
        "lines that end": b"\r",
        "values": b"vt 0\n",
        "normals": b"vn 0 0 1\n",
        "comments": b"#\n",
        "continued": b"\\\n",
        "others": b"q\n",
    }.items():
        makers[f"obj, {what}"] = partial(_text, "obj", triangle, line, size, b"f 1 2 3\n")
    for what, numbered in {
        "materials": "usemtl {0}\nf 1 2 3\n",
        "groups": "g {0}\nf 1 2 3\n",
        "objects": "o {0}\nf 1 2 3\n",
        "libraries": "mtllib {0}\n",
        "remarks": "# meta a{0}: 1\n",
    }.items():
        makers[f"obj, {what}"] = partial(_numbered, "obj", triangle, numbered, size, b"f 1 2 3\n")
    makers["obj, corners of one face"] = partial(_text, "obj", triangle + b"f", b" 1", size, b"\n")
    makers["obj, numbers of corners"] = partial(
        _text, "obj", triangle + b"vt 0\nvn 0 0 1\nf", b" 1/1/1", size, b"\n"
    )
    makers["obj, slashes"] = partial(_text, "obj", triangle + b"f 1", b"/", size, b"\n")
    makers["obj, numbers of a point"] = partial(_text, "obj", b"v", b" 0", size, b"\nf 1 1 1\n")
    makers["obj, one number"] = partial(_text, "obj", b"v 0 0 ", b"1", size, b"\nf 1 1 1\n")
    count = size // 6
    makers["off, points"] = partial(
        _text, "off", f"OFF {count} 1\n".encode(), b"0 0 0\n", 6 * count, b"3 0 1 2\n"
    )
    makers["off, faces"] = partial(
        _text, "off", f"OFF 1 {size // 8}\n0 0 0\n".encode(), b"3 0 0 0\n", size
    )
    makers["off, empty faces"] = partial(
        _text, "off", f"OFF 1 {size // 2}\n0 0 0\n".encode(), b"0\n", size
    )
    makers["off, one face"] = partial(
        _text, "off", f"OFF 1 1\n0 0 0\n{size // 2}".encode(), b" 0", size, b"\n"
    )
    makers["off, comments"] = partial(
        _text, "off", b"", b"# meta a: 1\n", size, b"OFF 1 1\n0 0 0\n3 0 0 0\n"
    )
    makers["off, keywords"] = partial(_text, "off", b"", b"ST", size, b"OFF 1 1\n0 0 0\n3 0 0 0\n")
    makers["off, spaces"] = partial(_text, "off", b"OFF", b"\n", size, b"x")
    makers["stl, triangles"] = lambda: Sample(
        "stl", bytes(80) + struct.pack("<I", size // 50) + bytes(50 * (size // 50))
    )
    makers["stl of text, lines"] = partial(
        _text, "stl", b"solid\n", b"vertex 0 0 0\n", size, b"endsolid"
    )
    makers["stl of text, facets"] = partial(_text, "stl", b"solid\n", _FACET, size, b"endsolid")
    makers["stl of text, spaces"] = partial(_text, "stl", b"solid\n", b" ", size, b"endsolid")
    makers |= (
        _grown_ply(size)
        | _grown_archives(size)
        | _grown_gltf(size)
        | _grown_caches(size)
        | _grown_3mf(size)
    )
    if "usda" in samples():
        makers |= _grown_usd(size)
    return makers


def _grown_ply(size: int) -> dict[str, Callable[[], Sample]]:
    chars = partial(ply_head, order="binary_little_endian", kind="char")

    def ply(head: str, body: bytes) -> Sample:
        return Sample("ply", head.encode() + body)

    def points(kind: str, width: int) -> Sample:
        count = size // (3 * width)
        return ply(chars(count, kind=kind), bytes(3 * width * count) + b"\3" + bytes(12))

    def properties(line: str) -> Sample:
        many = "".join(line.format(number) for number in range(60_000 // len(line)))
        return ply(chars(1).replace("element face", many + "element face"), bytes(8000))

    def lists() -> Sample:
        """As many lists as there may be in as many rows as there may be, some of them longer than others."""
        many = "".join(f"property list uchar char l{number}\n" for number in range(1500))
        rows = size // 1501
        return ply(chars(1, rows, last=many), bytes(3) + b"\1\0" + bytes(1500) + bytes(1501 * rows))

    def faces(fill: bytes, count: int) -> Sample:
        return ply(chars(1, count), bytes(3) + fill)

    def polygons(corners: int) -> Sample:
        row = bytes([corners, *(number % 3 for number in range(corners))])
        count = size // len(row)
        return ply(
            chars(3, count, corners="uchar uchar"), bytes((0, 0, 0, 1, 0, 0, 0, 1, 0)) + row * count
        )

    def more(lines: str) -> Sample:
        return ply(chars(1, more=lines), bytes(16))

    def rows(row: bytes) -> Sample:
        head = ply_head(1, size // len(row), kind="char")
        return _text("ply", head.encode() + b"0 0 0\n", row, size)

    empty = b"\0" * size
    mixed = b"\3" + bytes(12) + b"\0" * size
    long = struct.pack("<I", size // 4) + bytes(size)
    return {
        "ply, points of bytes": partial(points, "char", 1),
        "ply, points of doubles": partial(points, "double", 8),
        "ply, faces without corners": partial(faces, empty, size),
        "ply, rows that differ": partial(faces, mixed, size),
        "ply, triangles": partial(faces, (b"\3" + bytes(12)) * (size // 13), size // 13),
        "ply, quads of bytes": partial(polygons, 4),
        "ply, long polygons of bytes": partial(polygons, 255),
        "ply, one face": lambda: ply(chars(1, corners="uint int"), bytes(3) + long),
        "ply, properties": partial(properties, "property char a{}\n"),
        "ply, properties in a row": partial(properties, "property char a_{}\n"),
        "ply, lists": lists,
        "ply, comments": partial(more, "comment meta a: 1\n" * 3400),
        "ply, images": partial(more, "".join(f"comment TextureFile {n}\n" for n in range(2500))),
        "ply, elements": partial(more, "".join(f"element e{n} 0\n" for n in range(3500))),
        "ply of text, empty rows": partial(rows, b"0\n"),
        "ply of text, triangles": partial(rows, b"3 0 0 0\n"),
    }


def _archive(arrays: dict[str, Any], compression: int = zipfile.ZIP_DEFLATED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", compression) as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as entry:
                if isinstance(array, bytes):
                    entry.write(array)
                else:
                    np.lib.format.write_array(entry, array)
    return buffer.getvalue()


def _grown_archives(size: int) -> dict[str, Callable[[], Sample]]:
    faces = np.zeros((1, 3), np.int8)
    point = np.zeros((1, 3), np.int8)
    many = 40 * size  # what deflate makes of zeros is a thousandth of them

    def claimed(shape: tuple[int, ...], kind: str = "<f8") -> bytes:
        """An array that ends behind its header."""
        file = io.BytesIO()
        np.lib.format.write_array_header_1_0(
            file, {"descr": kind, "fortran_order": False, "shape": shape}
        )
        return file.getvalue()

    def npz(**arrays: Any) -> Sample:
        return Sample("npz", _archive(arrays))

    def entries() -> Sample:
        stored = {f"{number}": np.zeros(1, np.int8) for number in range(size // 250)}
        return Sample(
            "npz", _archive({"positions": point, "faces": faces, **stored}, zipfile.ZIP_STORED)
        )

    def pipe(shape: tuple[int, ...]) -> Sample:
        file = io.BytesIO()
        write_npy(file, torus(3, 3).faces)
        return Sample("npy", file.getvalue() + claimed(shape) + bytes(size))

    plain = b"v 0 0 0\n"
    return {
        "npz, points": lambda: npz(positions=np.zeros((many // 3, 3), np.int8), faces=faces),
        "npz, faces": lambda: npz(positions=point, faces=np.zeros((many // 3, 3), np.int8)),
        "npz, other": lambda: npz(positions=point, faces=faces, metadata=np.zeros(many, np.uint8)),
        "npz, values": lambda: npz(positions=point, faces=faces, a=np.zeros((1, many), np.uint8)),
        "npz, of corners": lambda: npz(
            positions=point, faces=faces, **{"corner/a": np.zeros((many, 1), np.uint8)}
        ),
        "npz, text": lambda: npz(
            positions=point,
            faces=faces,
            metadata=np.frombuffer(b'{"a":' + b"[" * size + b"}", np.uint8),
        ),
        "npz, entries": entries,
        "npz, claims": lambda: npz(positions=claimed((1 << 24, 3)), faces=faces),
        "npz, claims of nothing": lambda: npz(positions=claimed((0, 1 << 62)), faces=faces),
        "npz of frames, one frame": lambda: npz(
            positions=np.zeros((1, many // 3, 3), np.int8), faces=faces
        ),
        "npz of frames, frames": lambda: npz(
            positions=np.zeros((many // 9, 3, 3), np.int8), faces=faces
        ),
        "npz of frames, no vertices": lambda: npz(
            positions=np.zeros((1 << 40, 0, 3), np.int8), faces=faces
        ),
        "npz of frames, faces": lambda: npz(
            positions=np.zeros((2, 1, 3), np.int8), faces=np.zeros((many // 3, 3), np.int8)
        ),
        "npz of frames, claims": lambda: npz(positions=claimed((1 << 30, 1 << 30, 3)), faces=faces),
        "npy, a frame": partial(pipe, (1 << 40, 3)),
        "npy, frames of nothing": partial(pipe, (0, 3)),
        "npy, of large nothing": partial(pipe, (0, 1 << 62)),
        "gz, of lines": lambda: Sample(
            "obj.gz", gzip.compress(plain * (many // 8) + b"f 1 1 2\n", mtime=0)
        ),
        "gz, of points": lambda: Sample("obj.gz", gzip.compress(plain * (many // 8), mtime=0)),
        "gz, members": lambda: Sample("obj.gz", gzip.compress(plain, mtime=0) * (size // 30)),
        "gz, members of nothing": lambda: Sample(
            "obj.gz", gzip.compress(b"", mtime=0) * (size // 20)
        ),
        "gz of gz": lambda: Sample(
            "obj.gz", gzip.compress(gzip.compress(plain * (many // 8), mtime=0), mtime=0)
        ),
        "zip of meshes": lambda: Sample("zip", _zip({"a.obj": plain * (many // 8) + b"f 1 1 1\n"})),
        "3mf": lambda: Sample(
            "3mf", _zip({"3D/3dmodel.model": b"<model>" + b"<a/>" * (many // 4) + b"</model>"})
        ),
    }


def _zip(entries: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)
    return buffer.getvalue()


def three_mf(resources: str, items: str, parts: Mapping[str, str] = MappingProxyType({})) -> bytes:
    """A 3MF archive with a triangle as object 0, and what else is given, in part files, too.

    In the files, numbers begin with 1.
    """
    triangle = (
        '<object id="0"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>'
        '<vertex x="0" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>'
    )
    core = "http://schemas.microsoft.com/3dmanufacturing"

    def model(resources: str, items: str) -> bytes:
        text = (
            f'<?xml version="1.0"?><model unit="millimeter" xmlns="{core}/core/2015/02" '
            f'xmlns:m="{core}/material/2015/02" xmlns:p="{core}/production/2015/06">'
            f"<resources>{resources}</resources><build>{items}</build></model>"
        )
        return re.sub(
            r'(id|index)="(\d+)"',
            lambda match: f'{match[1]}="{int(match[2]) + (match[1] == "id")}"',
            text,
        ).encode()

    def related(names: list[str]) -> bytes:
        links = (
            f'<Relationship Target="/{n}" Id="r{i}" Type="{core}/2013/01/3dmodel"/>'
            for i, n in enumerate(names)
        )
        return f'<Relationships xmlns="{place}/relationships">{"".join(links)}</Relationships>'.encode()

    place, main = "http://schemas.openxmlformats.org/package/2006", "3D/3dmodel.model"
    kinds = {
        "model": "ms-package.3dmanufacturing-3dmodel",
        "rels": "openxmlformats-package.relationships",
    }
    types = (
        f'<Default Extension="{end}" ContentType="application/vnd.{k}+xml"/>'
        for end, k in kinds.items()
    )
    others = {f"3D/Objects/{name}.model": model(text, "") for name, text in parts.items()}
    return _zip(
        {
            "[Content_Types].xml": f'<Types xmlns="{place}/content-types">{"".join(types)}</Types>'.encode(),
            "_rels/.rels": related([main]),
            main: model(triangle + resources, items),
            **({"3D/_rels/3dmodel.model.rels": related([*others])} if others else {}),
            **others,
        }
    )


def chained_objects(count: int) -> str:
    """Objects of two components each, the next one deeper: 2^count triangles."""
    component = '<component objectid="{}"/>'
    return "".join(
        f'<object id="{number}"><components>{component.format(number - 1) * 2}</components></object>'
        for number in range(1, count + 1)
    )


def _grown_3mf(size: int) -> dict[str, Callable[[], Sample]]:
    def make_sample(resources: str, items: str) -> Sample:
        return Sample("3mf", three_mf(resources, items))

    item = '<item objectid="{}"/>'
    return {
        "3mf, some components": lambda: make_sample(chained_objects(10), item.format(10)),
        "3mf, components": lambda: make_sample(chained_objects(40), item.format(40)),
        "3mf, a chain": lambda: make_sample(chained_objects(size // 90), item.format(size // 90)),
    }


def _grown_caches(size: int) -> dict[str, Callable[[], Sample]]:
    mesh = ("a.obj", b"v 0 0 0\nf 1 1 1\n")
    frames = size // 16

    def mdd(data: bytes) -> Sample:
        return Sample("mdd", data, (mesh,))

    return {
        "pc2, frames": lambda: Sample(
            "pc2",
            struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 1, 0, 1, size // 12) + bytes(size),
            (mesh,),
        ),
        "mdd, frames": lambda: mdd(struct.pack(">ii", frames, 1) + bytes(16 * frames)),
        "mdd, times": lambda: mdd(struct.pack(">ii", size // 4, 1) + bytes(size)),
        "pc2, a large mesh beside it": lambda: Sample(
            "pc2",
            struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 1, 0, 1, 1) + bytes(12),
            (
                (
                    "a.npz",
                    _archive(
                        {
                            "positions": np.zeros((40 * size // 3, 3), np.int8),
                            "faces": np.zeros((1, 3), int),
                        }
                    ),
                ),
            ),
        ),
    }


def _grown_gltf(size: int) -> dict[str, Callable[[], Sample]]:
    """What a tree can say many times of the same bytes; each of a mesh that stays, and of one that moves."""

    def nothing(place: int, count: int) -> Change:
        """An accessor without a view: all of it is zeros."""
        return lambda t: t["accessors"].__setitem__(
            place,
            {key: value for key, value in t["accessors"][place].items() if key != "bufferView"}
            | {"count": count},
        )

    def nodes(t: Tree, entries: list[dict[str, Any]]) -> None:
        t["nodes"], t["scenes"] = entries, [{"nodes": list(range(len(entries)))}]

    def chained(t: Tree) -> None:
        t["nodes"] = [{"children": [number + 1]} for number in range(size // 40)] + [{"mesh": 0}]

    def channels(t: Tree, samplers: bool = False) -> None:
        count = size // 120
        nodes(t, [{"mesh": 0}] * count)
        for number, kind in ((2, "SCALAR"), (3, "VEC3")):
            t["accessors"][number] = {"componentType": 5126, "count": size // 16, "type": kind}
        t["animations"][0] = {
            "samplers": [{"input": 2, "output": 3}] * (count if samplers else 1),
            "channels": [
                {
                    "sampler": node if samplers else 0,
                    "target": {"node": node, "path": "translation"},
                }
                for node in range(count)
            ],
        }

    def targets(t: Tree) -> None:
        t["meshes"][0]["weights"] = [1] * (size // 24)
        t["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}] * (size // 24)

    def sparse(t: Tree) -> None:
        nothing(0, 1 << 24)(t)
        places = {"indices": {"bufferView": 1, "componentType": 5125}, "values": {"bufferView": 0}}
        t["accessors"][0]["sparse"] = {"count": 1, **places}

    def unused(t: Tree) -> None:
        t["accessors"] += [{"componentType": 5126, "count": 10**7, "type": "MAT4"}] * (size // 60)

    def empty(t: Tree) -> None:
        nodes(t, [{"mesh": 0}] + [{}] * (size // 8))

    def make_sample(change: Change, until: float | None) -> Sample:
        scene = Scene(72)
        if until is not None:
            scene.move(until)
        change(scene.tree)
        return scene.sample()

    both: dict[str, Change] = {
        "points of no bytes": nothing(0, 1 << 26),
        "indices of no bytes": nothing(1, 3 << 24),
        "a chain of nodes": chained,
        "nodes of nothing": empty,
        "accessors of no bytes": unused,
        "targets": targets,
    }
    moving: dict[str, Change] = {
        "curves of no bytes": channels,
        "samplers": partial(channels, samplers=True),
    }
    entries = {
        f"glb, {name}": partial(make_sample, change, None)
        for name, change in (both | {"sparse": sparse}).items()
    }
    entries |= {
        f"moving glb, {name}": partial(make_sample, change, 1.0)
        for name, change in (both | moving).items()
    }
    entries |= {
        f"long glb, {name}": partial(make_sample, both[name], 30_000.0)
        for name in ("nodes of nothing", "targets")
    }
    return entries | {
        "glb, nested": lambda: Sample("gltf", b'{"asset":{"version":"2.0"},"a":' + b"[" * size)
    }


def _grown_usd(size: int) -> dict[str, Callable[[], Sample]]:
    head, tail = b"#usda 1.0\n", b"\n}\n"
    mesh = b"int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n"
    points = b"point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n"

    def stage(inside: bytes) -> Sample:
        return Sample("usda", head + b'def Mesh "a"\n{\n' + inside + tail)

    def many(begun: bytes, entry: bytes, count: int, tail: bytes = b"") -> Sample:
        return Sample(
            "usda",
            head + begun + b"".join(entry.replace(b"#", b"%d" % n) for n in range(count)) + tail,
        )

    begun, samples = b'def Mesh "a"\n{\n' + mesh, b"point3f[] points.timeSamples = {\n"
    return {
        "usd, faces": lambda: stage(
            b"int[] faceVertexCounts = [" + b"0," * (size // 2) + b"0]\n" + points
        ),
        "usd, points": lambda: stage(
            mesh + b"point3f[] points = [" + b"(0,0,0)," * (size // 8) + b"(0,0,0)]\n"
        ),
        "usd, samples": lambda: many(
            begun + samples, b"#: [(0,0,0),(1,0,0),(0,1,0)],\n", size // 36, b"}\n" + tail
        ),
        "usd, prims": lambda: many(b"", b'def Mesh "a#" {\n' + mesh + points + b"}\n", size // 150),
        "usd, nested": lambda: Sample(
            "usda", head + b'def "a" {\n' * (size // 10) + b"}\n" * (size // 10)
        ),
    }


# ---------------------------------------------------------------------------------------------------------- measuring


def read_all(path: Path, limits: Limits) -> Taken:
    """Read a file as whatever it is, and say what came of it."""
    kind, vertices, shown_vertices = path.suffix[1:], 0, 0
    try:
        if kind in SEQUENCES_READ:
            try:
                sequence = open_sequence(
                    str(path), "npy" if kind == "npy" else None, request=Wanted(), limits=limits
                )
                if sequence is not None:
                    for frame in sequence.frames:
                        vertices = len(frame)
                        shown_vertices += vertices
                    return Taken("read", vertices=vertices, shown=shown_vertices)
            except BsmError:
                if kind not in ("glb", "gltf") or shown_vertices:
                    raise
        vertices = len(read_mesh(path, limits=limits).mesh.positions)
        return Taken("read", vertices=vertices)
    except BsmError as error:
        return Taken(f"{type(error).__name__}: {error}", vertices=vertices, shown=shown_vertices)


def problems(cases: list[Case], limits: str, most: float = 1.0) -> Iterator[str]:
    """Where reading takes more than `most` of what it may, or what comes out is neither a mesh nor an error of ours."""
    with tempfile.TemporaryDirectory() as folder:
        cases = [case for case in cases if limits == "service" or is_ours(case.name)]
        works = [
            partial(reading, case.make, Path(folder), NAMED_LIMITS[limits]()) for case in cases
        ]
        yield from problems_of([case.name for case in cases], works, limits, most, MOST_SECONDS)


def is_ours(name: str) -> bool:
    """Whether our own readers read a case; others have no bounds but those of isolation."""
    return not name.startswith(("3mf", "usd", "dae"))


def reading(make: Callable[[], Sample], folder: Path, limits: Limits) -> Callable[[], Taken]:
    """Write a file and those beside it, then measure the reader and its isolated processes."""
    path, size = written(make(), folder)
    end_of_child = importlib.import_module("bsm.files.isolation").end_of_child  # of Linux

    def read() -> Taken:
        ends: list[Any] = []

        def noted(*arguments: Any) -> Any:
            ends.append(end_of_child(*arguments))
            return ends[-1]

        with mock.patch("bsm.files.isolation.end_of_child", noted):
            cost = read_all(path, limits)
        memory, seconds = max((end[1] for end in ends), default=0), sum(end[2] for end in ends)
        return replace(cost, size=size, memory=memory, seconds=seconds)

    return read


def written(sample: Sample, folder: Path) -> tuple[Path, int]:
    """A file and what lies beside it, alone in a folder, and their bytes."""
    files = {f"a.{sample.suffix}": sample.data, **dict(sample.beside)}
    for name in os.listdir(folder):
        (folder / name).unlink()
    for name, data in files.items():
        (folder / name).write_bytes(data)
    return folder / f"a.{sample.suffix}", sum(map(len, files.values()))


def warm_up() -> None:
    """Load every library and start the server once, so that no case is charged for it."""
    with tempfile.TemporaryDirectory() as folder:
        for sample in samples().values():
            cost = read_all(written(sample, Path(folder))[0], Limits())
            if cost.outcome != "read":
                raise AssertionError(f"the sample {sample.suffix} is not sound: {cost.outcome}")
    read_mesh(written_mesh(torus(3, 3), "ply").data, limits=Limits.service())


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument(
        "--bytes", type=int, default=1 << 20, help="of a file that is grown (default: %(default)s)"
    )
    parser.add_argument(
        "--every", type=int, default=1, metavar="N", help="of the numbers take one in N"
    )
    parser.add_argument("--only", default="", metavar="TEXT", help="cases whose name begins so")
    parser.add_argument(
        "--limits", choices=("default", "service"), nargs="+", default=("default", "service")
    )
    parser.add_argument("--list", action="store_true", help="only say what there is")
    args = parser.parse_args()
    warm_up()
    every = (*starmap(Case, grown(args.bytes).items()), *list(numbers())[:: args.every])
    cases = [case for case in every if case.name.startswith(args.only)]
    if args.list:
        print("\n".join(case.name for case in cases))
        return 0
    findings = chain.from_iterable(problems(cases, limits) for limits in args.limits)
    return report(
        findings,
        f"{len(cases)} files of {len(samples())} kinds, {len(args.limits) * len(cases)} readings",
    )
