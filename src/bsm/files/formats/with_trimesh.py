"""3MF, DAE and whatever else trimesh reads: the parts of a scene, placed where it has them, as one mesh."""

import importlib.util
import io
import re
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from bsm.bitstream.errors import BsmError, FormatError, MeshError, how_to_install, imported
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import Domain
from bsm.files.formats.metadata import Beside, Material, Value, described, kind_of_image
from bsm.files.formats.placed import placed_surfaces, placed_triangles
from bsm.files.formats.polygons import (
    CROSSING,
    CUT,
    Array,
    Column,
    Polygons,
    color_column,
    compact,
    joined_columns,
    meaning_of,
    sorted_into_parts,
    triangulate,
    turned_normals,
)
from bsm.files.room import Doubles, require_count

_WAY = "in Python, give bsm.encode what meshio.read or pyvista.read returns, or its surface"
_ARCHIVES = ("zip", "gz", "bz2", "xz", "tar", "tar.gz", "tar.bz2", "tgz")
PER_TRIANGLE, PER_PART = 150, 2000  # bytes that parts take while they are joined: for each triangle, and for each part
_NO_NAMES = re.compile(r"geometry_\d+|GLTF(_\d+)?")
_PADDING = re.compile(rb"(?<=IEND\xaeB`\x82)\0{1,3}\Z|(?<=\xff\xd9)\0{1,3}\Z")
"""The padding after a PNG or JPEG in GLB files."""
_OF_TRIMESH = ("units", "from_gltf_primitive", "gltf_extensions", "file_path", "file_name", "node", "processed")
"""Metadata that trimesh has added."""


def import_trimesh(what: str) -> Any:
    """The library; `DependencyError` where it is missing."""
    return imported("trimesh", f"{what} with trimesh", "formats")


def read_with_trimesh(data: bytes, path: str | None, kind: str, limits: Limits) -> Polygons:
    """Read a file with trimesh, which neither merges vertices nor splits them here."""
    if kind in _ARCHIVES:
        raise FormatError(f".{kind} files contain files: unpack it, and read its contents")
    trimesh = import_trimesh(f"{f'.{kind}' if kind else 'such'} files are read")
    if kind not in trimesh.available_formats():
        complete = all(map(importlib.util.find_spec, ("lxml", "networkx", "collada")))
        more = "" if complete else f" (trimesh reads 3MF, DAE and others after: {how_to_install('formats')})"
        raise FormatError(f"{f'.{kind} is' if kind else 'this is'} no mesh format that is known here{more}; {_WAY}")
    resolver = _Resolver(Beside(Path(path).resolve().parent if path else None, limits.metadata_bytes))
    try:
        up = re.search(rb"<up_axis>\s*([XYZ])_UP", data) if kind == "dae" else None
        with np.errstate(all="ignore"):  # a later check refuses infinite values
            expected, left_out = placed_triangles(data, limits) if kind == "3mf" else (None, ())
            surfaces, left_out = placed_surfaces(data, limits) if kind == "dae" else (0, left_out)
            data, cuts = _with_triangles(data) if kind == "dae" else (data, {})
            scene = trimesh.load_scene(io.BytesIO(data), file_type=kind, process=False, resolver=resolver)
            found = joined(scene, limits, len(data))
        if (lost := surfaces - len(scene.graph.nodes_geometry)) > 0:
            left_out = (*left_out, f"{lost} of {surfaces} surfaces, which refer to something that is not there")
        if expected not in (None, len(found.sizes)):
            raise MeshError(f"trimesh gives {len(found.sizes)} of the {expected} triangles that this 3MF file places")
    except (BsmError, MemoryError):
        raise
    except Exception as error:  # it promises nothing about what damaged files raise
        raise FormatError(f"trimesh cannot read this file: {type(error).__name__}: {str(error)[:200]}") from error
    axis = {"up": up[1].decode().lower()} if up else {}
    metadata = {**axis, **found.metadata}
    if metadata.get("name") == Path(path or "").name:
        del metadata["name"]  # trimesh calls it like the file
    notes = [f"{name} was left out: {why}" for name, why in resolver.absent.items()]
    notes += [f"{what}: {count}" for what, count in cuts.items() if count]
    return replace(found, metadata=metadata, notes=(*found.notes, *notes), dropped=(*found.dropped, *left_out))


def _with_triangles(data: bytes) -> tuple[bytes, dict[str, int]]:
    """Cut the polygons of a DAE as all formats here are cut, of which pycollada makes fans; counts for notes."""
    collada = imported("collada", "DAE is read with pycollada", "formats")
    document = collada.Collada(io.BytesIO(data), ignore=[collada.common.DaeError])
    counts = {CUT: 0, CROSSING: 0}
    for geometry in document.geometries:
        mesh = geometry.xmlnode.find(collada.common.tag("mesh"))
        for given in geometry.primitives:
            if not isinstance(given, collada.polylist.Polylist) or not (given.vcounts > 3).any():
                continue
            sizes, corners = np.asarray(given.vcounts, np.int64), given.index
            if sizes.sum() != len(corners) or (sizes < 0).any():
                raise MeshError(f"polygons of this DAE file have {len(corners)} corners, not {sizes.sum()}")
            points = np.asarray(given.vertex, np.float64)
            places, _, crossing = triangulate(points, sizes, np.asarray(given.vertex_index, np.int64))
            flat = corners[places.reshape(-1)].reshape(-1)
            cut = collada.triangleset.TriangleSet(given.sources, given.material, flat)
            mesh[list(mesh).index(given.xmlnode)] = cut.xmlnode
            counts = {CUT: counts[CUT] + int((sizes > 3).sum()), CROSSING: counts[CROSSING] + crossing}
    written = io.BytesIO()
    collada.xmlutil.writeXML(document.xmlnode, written)
    return written.getvalue(), counts


@dataclass
class _Resolver:
    """What trimesh asks for the files beside a mesh."""

    beside: Beside
    absent: dict[str, str] = field(default_factory=dict)

    def get(self, name: str) -> bytes:
        found = self.beside.read(unquote(name))
        if isinstance(found, str):
            self.absent[name] = found
            raise ValueError(found)
        return found

    __getitem__ = get

    def namespaced(self, _: str) -> "_Resolver":
        return self


def joined(scene: Any, limits: Limits, received: int = 1 << 62) -> Polygons:
    """Join the surfaces of a scene, each as often and where the scene places it; `received` is the size of the file."""
    order = {name: place for place, name in enumerate(scene.geometry)}  # that of the file; the graph has none
    places = sorted((scene.graph[node] for node in scene.graph.nodes_geometry), key=lambda place: order[place[1]])
    surfaces = [(matrix, scene.geometry[name], name) for matrix, name in places]
    surfaces = [surface for surface in surfaces if hasattr(surface[1], "faces")]
    vertices = sum(len(part.vertices) for _, part, _ in surfaces)
    require_count("vertices", vertices, limits)
    triangles = sum(len(part.faces) for _, part, _ in surfaces)
    require_count("faces", triangles, limits)
    limits.check_memory(PER_TRIANGLE * triangles + PER_PART * len(surfaces), vertices, received)
    found = _polygons([_Part(part, name, matrix) for matrix, part, name in surfaces], scene.metadata)
    lost = len(places) - len(surfaces)
    notes = [f"curves and point clouds were left out: {lost}"] if lost else []
    return replace(found, notes=(*found.notes, *notes))


def polygons_of(mesh: Any) -> Polygons:
    return _polygons([_Part(mesh, "", np.eye(4))], {})


@dataclass(frozen=True, eq=False)
class _Part:
    """A mesh of trimesh, its name, and its transform."""

    mesh: Any
    name: str
    matrix: Doubles

    @property
    def positions(self) -> Doubles:
        moved: Doubles = np.asarray(self.mesh.vertices, np.float64) @ self.matrix[:3, :3].T + self.matrix[:3, 3]
        return moved

    @property
    def faces(self) -> Array:
        mirrored = np.linalg.det(self.matrix[:3, :3]) < 0
        return np.asarray(self.mesh.faces[:, ::-1] if mirrored else self.mesh.faces)

    @property
    def rows(self) -> dict[Domain, int]:
        return {"vertex": len(self.mesh.vertices), "face": len(self.mesh.faces)}

    def columns(self) -> list[Column]:
        mesh, visual = self.mesh, self.mesh.visual
        found = []
        if "vertex_normals" in mesh._cache:
            turned = turned_normals(np.asarray(mesh.vertex_normals, np.float64), self.matrix[:3, :3])
            found.append(Column("normal", compact(turned), semantic="normal"))
        if visual.kind == "texture":
            uv = visual.uv
            if uv is not None and np.shape(uv) == (len(mesh.vertices), 2):
                found.append(Column("texcoord", compact(np.asarray(uv, np.float64)), semantic="texcoord"))
            colors = visual.vertex_attributes.get("color")
            if colors is not None and np.shape(colors)[0] == len(mesh.vertices):
                found.append(color_column(np.array(colors), "vertex"))
        elif visual.kind == "vertex":
            found.append(color_column(np.array(visual.vertex_colors), "vertex"))
        elif visual.kind == "face":
            found.append(color_column(np.array(visual.face_colors), "face"))
        for name, values in mesh.vertex_attributes.items():
            found.append(Column(name.removeprefix("_"), _rows(values), "vertex", meaning_of(name.removeprefix("_"))))
        for name, values in mesh.face_attributes.items():
            found.append(Column(name, _rows(values), "face", meaning_of(name)))
        return found

    def materials(self) -> tuple[list[Any], Array]:
        visual = self.mesh.visual
        none = np.zeros(len(self.mesh.faces), np.int64)
        if visual.kind != "texture" or visual.material is None:
            return [], none
        several = getattr(visual.material, "materials", None)
        numbers = getattr(visual, "face_materials", None)
        if several and numbers is not None and np.shape(numbers) == none.shape:
            return list(several), np.clip(np.asarray(numbers, np.int64), 0, len(several) - 1)
        return [several[0] if several else visual.material], none


def _rows(values: Any) -> Array:
    table = np.array(values)
    return table[:, None] if table.ndim == 1 else table


def _polygons(parts: list[_Part], of_scene: dict[str, Any]) -> Polygons:
    """Parts as one: what some have and others do not is zero there (white, for colors)."""
    positions = np.concatenate([np.empty((0, 3)), *(part.positions for part in parts)])
    begin = np.cumsum([0, *(len(part.mesh.vertices) for part in parts)])
    faces = [np.empty((0, 3), np.int64), *(part.faces + first for part, first in zip(parts, begin))]
    triangles = np.concatenate(faces)
    columns, notes = joined_columns((part.columns() for part in parts), [part.rows for part in parts])
    metadata, left = _metadata(parts, of_scene)
    of_materials, numbers = _materials(parts)
    metadata |= of_materials
    shape = (positions, np.full(len(triangles), 3), triangles.reshape(-1))
    whole = Polygons(*shape, tuple(notes), tuple(left), tuple(columns), metadata)
    return sorted_into_parts(whole, [part.name for part in parts], [len(part.mesh.faces) for part in parts], numbers)


def _metadata(parts: list[_Part], of_scene: dict[str, Any]) -> tuple[dict[str, Value], dict[str, None]]:
    """What trimesh knows of a scene and its parts, and the names of what metadata cannot hold."""
    found: dict[str, Value] = {}
    left: dict[str, None] = {}
    for source in (of_scene, *(part.mesh.metadata for part in parts)):
        for name, value in source.items():
            plain = isinstance(value, str | int | float | bytes)
            if name and name not in _OF_TRIMESH and plain and not (isinstance(value, str) and not value.strip("\0 ")):
                found.setdefault(str(name), int(value) if isinstance(value, bool) else value)
            elif name and name not in _OF_TRIMESH and not plain and value is not None:
                left[f"metadata {name}"] = None
    units = dict.fromkeys(part.mesh.units for part in parts)
    if len(units) == 1 and isinstance(unit := next(iter(units)), str):
        found.setdefault("unit", unit)
    if len(parts) == 1 and parts[0].name and not _NO_NAMES.fullmatch(parts[0].name):
        found.setdefault("name", parts[0].name)
    return found, left


def _materials(parts: list[_Part]) -> tuple[dict[str, Value], Array]:
    known: dict[frozenset[tuple[str, Value]], tuple[int, Material]] = {}
    images: list[bytes] = []
    numbers = [np.empty(0, np.int32)]
    for part in parts:
        several, of_faces = part.materials()
        places = np.zeros(max(len(several), 1), np.int32)
        for place, material in enumerate(several or [None]):
            words = {} if material is None else _words_of(material, images)
            places[place], _ = known.setdefault(frozenset(words.items()), (len(known), words))
        numbers.append(places[of_faces])
    metadata = described(dict(known.values()))
    metadata |= {f"image.{number}.data": data for number, data in enumerate(images)}
    return metadata, np.concatenate(numbers)


def _words_of(material: Any, images: list[bytes]) -> Material:
    """A material of trimesh in the words of glTF, or of MTL; new images are added to `images`."""
    given = dict(getattr(material, "_data", None) or {})
    if not given and hasattr(material, "diffuse"):  # one with the words of MTL
        given = {"Kd": material.diffuse, "Ka": material.ambient, "Ks": material.specular, "Ns": material.glossiness}
        given |= {"map_Kd": material.image, "name": material.name, **getattr(material, "kwargs", {})}
    found: Material = {}
    for name, value in given.items():
        if hasattr(value, "save"):
            if value.format is None and value.size == (1, 1):
                continue  # that of the material that trimesh gives to what has none
            file = getattr(value, "fp", None)  # the one that the image was, if it is still there, or else a PNG of it
            data = file.getvalue() if isinstance(file, io.BytesIO) and not file.closed else b""
            if kind_of_image(data):
                data = re.sub(_PADDING, b"", data)
            else:
                value.save(buffer := io.BytesIO(), format="PNG")
                data = buffer.getvalue()
            if data not in images:
                images.append(data)
            found[name] = images.index(data)
        elif isinstance(value, bool | np.bool_):
            found[name] = int(value)
        elif isinstance(value, str | int | float):
            found[name] = value
        elif isinstance(value, np.ndarray | list | tuple) and np.asarray(value).dtype.kind in "iuf":
            numbers = np.asarray(value).reshape(-1)
            if numbers.dtype == np.uint8:
                numbers = numbers / 255
            kept = numbers[:3] if name.startswith("K") else numbers
            found[name] = " ".join(f"{number:.6g}" for number in kept)
    finite = {name: value for name, value in found.items() if not isinstance(value, float) or np.isfinite(value)}
    return {} if finite == {"doubleSided": 0} else finite  # the default
