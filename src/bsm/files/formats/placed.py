"""3MF: how much their objects become where they are placed, counted before trimesh places them."""

from __future__ import annotations

import io
import zipfile
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from typing import IO
from xml.parsers import expat

from bsm.bitstream.errors import FormatError, LimitError, MeshError
from bsm.bitstream.limits import Limits
from bsm.files.room import require_count

FREE_PARTS, BYTES_OF_PART = 4096, 8  # placed parts that any file may have, and bytes for each further one
_MOST = 1 << 62
_LEFT_OUT = {
    "instance_controller": "skins and morphs with their meshes", "animation": "animations", "lines": "lines",
    "linestrips": "lines", "instance_camera": "cameras",
    "instance_light": "lights", "basematerials": "materials", "colorgroup": "colors", "texture2dgroup": "textures",
    "compositematerials": "materials", "multiproperties": "materials", "metadata": "metadata",
    "ph": "holes of polygons", "beamlattice": "beams", "slicestack": "slices",
}  # fmt: skip
"""Contents of 3MF and DAE that are left out, by the tags."""
_PIECE = 1 << 16


@dataclass
class _Model:
    """One XML file of an archive: what its meshes hold, and which object uses which how often."""

    size: Counter[str] = field(default_factory=Counter)
    objects: defaultdict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    uses: defaultdict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    files: list[tuple[str, str]] = field(default_factory=list)
    tags: dict[str, None] = field(default_factory=dict)
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
                self.tags[what] = None


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
                model.tags |= read[path].tags
                for what in ("vertex", "triangle"):
                    require_count("vertices" if what == "vertex" else "faces", model.size[what], limits)
    if not model.uses[""]:
        raise MeshError("this 3MF file places no object: its build has no item")
    return _placed(model, len(data), limits), left_out_of(model.tags)


def _placed(model: _Model, size: int, limits: Limits) -> int:
    """Return the triangles of all that "" uses; raise `LimitError` if these or the parts are too many."""
    uses = model.uses
    followed = len({*uses}.union(*uses.values())) * sum(used.total() for used in uses.values()) + 1
    sizes: dict[str, tuple[int, int, int]] = {}
    try:
        for name in TopologicalSorter(uses).static_order():
            own = model.objects[name]
            used = [(times, sizes[other]) for other, times in uses[name].items()]
            totals = (sum(times * size[place] for times, size in used) for place in range(3))
            mine = (own["vertex"], own["triangle"], 1)
            sizes[name] = tuple(min(_MOST, n + more) for n, more in zip(mine, totals))  # type: ignore[assignment]
    except CycleError:
        raise MeshError("an object of this 3MF file is a component of itself") from None
    vertices, triangles, parts = sizes.get("", (0, 0, 0))
    require_count("vertices", vertices, limits)
    require_count("faces", triangles, limits)
    if parts > (most := FREE_PARTS + size // BYTES_OF_PART):
        raise LimitError(f"this 3MF file places {parts:,} parts, over the limit of {most:,} for its bytes")
    if parts > followed:  # trimesh stops there without an error
        raise LimitError(f"this 3MF file places {parts:,} parts, of which trimesh reads {followed:,}: split it")
    return triangles


def left_out_of(tags: Iterable[str]) -> tuple[str, ...]:
    """Return the contents that are left out, by the names of XML elements."""
    return tuple(dict.fromkeys(_LEFT_OUT[tag] for tag in tags if tag in _LEFT_OUT))
