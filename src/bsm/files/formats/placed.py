"""3MF and DAE: how much their objects become where they are placed, counted before trimesh places them."""

from __future__ import annotations

import io
import zipfile
from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from typing import IO
from xml.parsers import expat

from bsm.bitstream.errors import FormatError, LimitError, MeshError
from bsm.bitstream.limits import Limits
from bsm.files.room import require_count

FREE_PARTS, BYTES_OF_PART = 4096, 8  # placed parts that any file may have, and bytes for each further one
_MOST = 1 << 62
_OF_POLYGONS = ("triangles", "polylist", "polygons", "trifans", "tristrips")
_LEFT_OUT = {
    "instance_controller": "skins and morphs with their meshes", "animation": "animations", "lines": "lines",
    "linestrips": "lines", "tristrips": "triangle strips", "trifans": "triangle fans", "instance_camera": "cameras",
    "instance_light": "lights", "basematerials": "materials", "colorgroup": "colors", "texture2dgroup": "textures",
    "compositematerials": "materials", "multiproperties": "materials", "metadata": "metadata",
    "ph": "holes of polygons", "beamlattice": "beams", "slicestack": "slices",
}  # fmt: skip
"""What trimesh leaves out of 3MF and DAE, by the tags."""
_PIECE = 1 << 16


@dataclass
class _Model:
    """One XML file of an archive: what its meshes hold, and which object uses which how often."""

    size: Counter[str] = field(default_factory=Counter)
    objects: defaultdict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    uses: defaultdict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    files: list[tuple[str, str]] = field(default_factory=list)
    left_out: dict[str, None] = field(default_factory=dict)
    _object: str = ""

    def read(self, file: IO[bytes]) -> _Model:
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartElementHandler = self._begin
        parser.StartDoctypeDeclHandler = self._refuse
        try:
            while piece := file.read(_PIECE):
                parser.Parse(piece)
            parser.Parse(b"", True)
        except (expat.ExpatError, LookupError, ValueError) as error:
            raise FormatError(f"this is not a 3MF file: its XML is broken: {error}") from error
        return self

    def _refuse(self, *_: object) -> None:
        raise FormatError("a 3MF file has no DOCTYPE")

    def _begin(self, name: str, attrs: Mapping[str, str]) -> None:
        match name.rpartition(" ")[2]:
            case "object":
                self._object = attrs.get("id", "")
            case "vertex" | "triangle" as what:
                self.size[what] += 1
                self.objects[self._object][what] += 1
            case "component":
                used = attrs.get("objectid", "")
                self.uses[self._object][used] += 1
                paths = (path.strip("/") for key, path in attrs.items() if key.endswith("path"))
                self.files += ((used, path) for path in paths)
            case "item":
                self.uses[""][attrs.get("objectid", "")] += 1
            case what if what in _LEFT_OUT:
                self.left_out[_LEFT_OUT[what]] = None


def placed_triangles(data: bytes, limits: Limits) -> tuple[int, tuple[str, ...]]:
    """Return how many triangles a 3MF file becomes, and what trimesh leaves out; raise `LimitError` if too many."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        names = {name.strip("/"): name for name in archive.namelist()}
        main = next((name for name in names.values() if "3d/3dmodel.model" in name.lower()), None)
        if main is None:
            raise FormatError("this 3MF file has no model (3D/3dmodel.model)")
        with archive.open(main) as file:
            model = _Model().read(file)
        read: dict[str, _Model] = {}
        for user, path in model.files:  # trimesh reads all meshes of such a file for each use
            if path in names:
                if path not in read:
                    with archive.open(names[path]) as file:
                        read[path] = _Model().read(file)
                model.objects[user] += read[path].size
                model.size += read[path].size
                model.left_out |= read[path].left_out
                for what in ("vertex", "triangle"):
                    require_count("vertices" if what == "vertex" else "faces", model.size[what], limits)
    if not model.uses[""]:
        raise MeshError("this 3MF file places no object: its build has no item")
    edges, nodes = sum(used.total() for used in model.uses.values()), {*model.uses}.union(*model.uses.values())
    return _placed("3MF", model.uses, model.objects, data, limits, len(nodes) * edges + 1)[0], tuple(model.left_out)


def _placed(
    kind: str,
    uses: Mapping[str, Counter[str]],
    objects: Mapping[str, Counter[str]],
    data: bytes,
    limits: Limits,
    followed: int = _MOST,
) -> tuple[int, int]:
    """Return the triangles and surfaces of all that "" uses; raise `LimitError` if these or the parts are too many.

    Trimesh stops without an error after `followed` parts.
    """
    sizes: dict[str, tuple[int, int, int, int]] = {}
    try:
        for name in TopologicalSorter(uses).static_order():
            own = objects.get(name, Counter())
            used = [(times, sizes[other]) for other, times in uses.get(name, Counter()).items()]
            totals = (sum(times * size[place] for times, size in used) for place in range(4))
            mine = (own["vertex"], own["triangle"], own["surface"], 1)
            sizes[name] = tuple(min(_MOST, n + more) for n, more in zip(mine, totals))  # type: ignore[assignment]
    except CycleError:
        raise MeshError(f"an object of this {kind} file is a component of itself") from None
    vertices, triangles, surfaces, parts = sizes.get("", (0, 0, 0, 0))
    require_count("vertices", vertices, limits)
    require_count("faces", triangles, limits)
    if parts > (most := FREE_PARTS + len(data) // BYTES_OF_PART):
        raise LimitError(f"this {kind} file places {parts:,} parts, over the limit of {most:,} for its bytes")
    if parts > followed:
        raise LimitError(f"this {kind} file places {parts:,} parts, of which trimesh reads {followed:,}: split it")
    return triangles, surfaces


class _Collada:
    """The geometries of a DAE, about how many triangles each has at least, and which node uses which how often."""

    def __init__(self, data: bytes) -> None:
        self.uses: defaultdict[str, Counter[str]] = defaultdict(Counter)
        self.objects: defaultdict[str, Counter[str]] = defaultdict(Counter)
        self.left_out: dict[str, None] = {}
        self._nodes: list[str] = []
        self._geometry = ""
        self._width = self._words = 0
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartElementHandler, parser.EndElementHandler = self._begin, self._end
        parser.CharacterDataHandler = self._take
        try:
            parser.Parse(data, True)
        except (expat.ExpatError, LookupError, ValueError) as error:
            raise FormatError(f"this is not a DAE file: its XML is broken: {error}") from error

    def _begin(self, tag: str, attrs: Mapping[str, str]) -> None:
        name, self._inside = tag.rpartition(" ")[2], False
        if name in ("node", "visual_scene"):
            node = "#" + attrs.get("id", "")
            node = node if node != "#" and node not in self.uses else f"{len(self.uses)}"
            if self._nodes:
                self.uses[self._nodes[-1]][node] += 1
            self.uses[node] = self.uses[node]
            self._nodes.append(node)
        elif name in ("instance_geometry", "instance_node", "instance_visual_scene"):
            self.uses[self._nodes[-1] if self._nodes else ""][attrs.get("url", "")] += 1
        elif name == "geometry":
            self._geometry = "#" + attrs.get("id", "")
        elif name in _OF_POLYGONS:
            self._width = self._words = 0
        elif name == "input" and attrs.get("offset", "").isdecimal():
            self._width = max(self._width, min(int(attrs["offset"]), 64) + 1)
        self._inside = name == "p"
        if name in _LEFT_OUT:
            self.left_out[_LEFT_OUT[name]] = None

    def _end(self, tag: str) -> None:
        name, self._inside = tag.rpartition(" ")[2], False
        if name in ("node", "visual_scene"):
            self._nodes.pop()
        elif name in _OF_POLYGONS:
            own = self._words // (3 * max(self._width, 1))
            self.objects[self._geometry].update(triangle=own, vertex=3 * own, surface=int(name not in _LEFT_OUT))

    def _take(self, text: str) -> None:
        self._words += text.count(" ") + text.count("\n") + 1 if self._inside else 0


def placed_surfaces(data: bytes, limits: Limits) -> tuple[int, tuple[str, ...]]:
    """Return how many surfaces a DAE places, and what trimesh leaves out; raise `LimitError` if they are too large."""
    scene = _Collada(data)
    return _placed("DAE", scene.uses, scene.objects, data, limits)[1], tuple(scene.left_out)
