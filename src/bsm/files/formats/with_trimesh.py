"""Meshes and scenes of trimesh: the parts, placed where a scene has them, as one mesh."""

import io
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.attributes import Domain
from bsm.files.formats.appearance import Material, as_text
from bsm.files.formats.metadata import Value, described, kind_of_image
from bsm.files.formats.polygons import Array, Column, Part, Polygons, color_column, compact, joined_parts, meaning_of
from bsm.files.parsing import Doubles

_NO_NAMES = re.compile(r"geometry_\d+|GLTF(_\d+)?")
_PADDING = re.compile(rb"(?<=IEND\xaeB`\x82)\0{1,3}\Z|(?<=\xff\xd9)\0{1,3}\Z")
"""The padding after a PNG or JPEG in GLB files."""
_OF_TRIMESH = ("units", "from_gltf_primitive", "gltf_extensions", "file_path", "file_name", "node", "processed")
"""Metadata that trimesh has added."""


def joined(scene: Any, limits: Limits = DEFAULT_LIMITS, received: int = 1 << 62) -> Polygons:
    """Join the surfaces of a scene, each as often and where the scene places it; `received` is the size of the file."""
    order = {name: place for place, name in enumerate(scene.geometry)}  # that of the file; the graph has none
    places = sorted((scene.graph[node] for node in scene.graph.nodes_geometry), key=lambda place: order[place[1]])
    every = [(matrix, scene.geometry[name], name) for matrix, name in places]
    surfaces = [one for one in every if hasattr(one[1], "faces")]
    polygons = _polygons(surfaces, scene.metadata, limits, received)
    lost = len(places) - len(surfaces)
    return replace(polygons, dropped=(*polygons.dropped, *([f"curves and point clouds ({lost})"] if lost else [])))


def polygons_of(mesh: Any) -> Polygons:
    return _polygons([(np.eye(4), mesh, "")], {}, DEFAULT_LIMITS, 1 << 62)


def _columns(mesh: Any) -> list[Column]:
    visual, columns = mesh.visual, []
    if "vertex_normals" in mesh._cache:
        columns.append(Column("normal", np.asarray(mesh.vertex_normals, np.float64), semantic="normal"))
    if visual.kind == "texture":
        uv = visual.uv
        if uv is not None and np.shape(uv) == (len(mesh.vertices), 2):
            columns.append(Column("texcoord", compact(np.asarray(uv, np.float64)), semantic="texcoord"))
        colors = visual.vertex_attributes.get("color")
        if colors is not None and np.shape(colors)[0] == len(mesh.vertices):
            columns.append(color_column(np.array(colors), "vertex"))
    elif visual.kind == "vertex":
        columns.append(color_column(np.array(visual.vertex_colors), "vertex"))
    elif visual.kind == "face":
        columns.append(color_column(np.array(visual.face_colors), "face"))
    columns += [_column(name.removeprefix("_"), values, "vertex") for name, values in mesh.vertex_attributes.items()]
    return [*columns, *(_column(name, values, "face") for name, values in mesh.face_attributes.items())]


def _materials_of(mesh: Any) -> tuple[list[Any], Array]:
    visual = mesh.visual
    none = np.zeros(len(mesh.faces), np.int64)
    if visual.kind != "texture" or visual.material is None:
        return [], none
    several = getattr(visual.material, "materials", None)
    numbers = getattr(visual, "face_materials", None)
    if several and numbers is not None and np.shape(numbers) == none.shape:
        return list(several), np.clip(np.asarray(numbers, np.int64), 0, len(several) - 1)
    return [several[0] if several else visual.material], none


def _column(name: str, values: Any, domain: Domain) -> Column:
    table = np.array(values)
    table = table[:, None] if table.ndim == 1 else table
    return Column(name, table, domain, meaning_of(name, table.shape[1] if table.ndim == 2 else 0))


def _polygons(
    surfaces: list[tuple[Doubles, Any, str]], of_scene: dict[str, Any], limits: Limits, received: int
) -> Polygons:
    """Meshes of trimesh with their places and names as one."""
    meshes = [mesh for _, mesh, _ in surfaces]
    of_materials, numbers = _materials(meshes)

    def made() -> Iterator[Part]:
        for (matrix, mesh, name), materials in zip(surfaces, numbers, strict=True):
            faces = np.asarray(mesh.faces, np.int64)
            points, sizes = np.asarray(mesh.vertices, np.float64), np.full(len(faces), 3)
            yield Part(points, sizes, faces.reshape(-1), _columns(mesh), materials, name).placed(matrix)

    counts = [(len(mesh.vertices), len(mesh.faces)) for mesh in meshes]
    joined = joined_parts(made(), counts, limits, received)
    metadata, losses = _metadata(meshes, of_scene)
    names = {} if _NO_NAMES.fullmatch(str(joined.metadata.get("name", ""))) else joined.metadata
    return replace(joined, metadata={**names, **metadata, **of_materials}, dropped=tuple(losses))


def _metadata(meshes: list[Any], of_scene: dict[str, Any]) -> tuple[dict[str, Value], dict[str, None]]:
    """What trimesh knows of a scene and its parts, and the names of what metadata cannot hold."""
    entries: dict[str, Value] = {}
    losses: dict[str, None] = {}
    for source in (of_scene, *(mesh.metadata for mesh in meshes)):
        for name, value in source.items():
            plain = isinstance(value, str | int | float | bytes)
            if name and name not in _OF_TRIMESH and plain and not (isinstance(value, str) and not value.strip("\0 ")):
                entries.setdefault(str(name), int(value) if isinstance(value, bool) else value)
            elif name and name not in _OF_TRIMESH and not plain and value is not None:
                losses[f"metadata {name}"] = None
    units = dict.fromkeys(mesh.units for mesh in meshes)
    if len(units) == 1 and isinstance(unit := next(iter(units)), str):
        entries.setdefault("unit", unit)
    return entries, losses


def _materials(meshes: list[Any]) -> tuple[dict[str, Value], list[Array]]:
    numbered: dict[frozenset[tuple[str, Value]], tuple[int, Material]] = {}
    images: list[bytes] = []
    numbers = []
    for mesh in meshes:
        several, of_faces = _materials_of(mesh)
        places = np.zeros(max(len(several), 1), np.int32)
        for place, material in enumerate(several or [None]):
            words = {} if material is None else _words_of(material, images)
            places[place], _ = numbered.setdefault(frozenset(words.items()), (len(numbered), words))
        numbers.append(places[of_faces])
    metadata = described(dict(numbered.values()))
    metadata |= {f"image.{number}.data": data for number, data in enumerate(images)}
    return metadata, numbers


def _words_of(material: Any, images: list[bytes]) -> Material:
    """A material of trimesh in the words of glTF, or of MTL; new images are added to `images`."""
    properties = dict(getattr(material, "_data", None) or {})
    if not properties and hasattr(material, "diffuse"):  # one with the words of MTL
        properties = {
            "Kd": material.diffuse,
            "Ka": material.ambient,
            "Ks": material.specular,
            "Ns": material.glossiness,
        }
        properties |= {"map_Kd": material.image, "name": material.name, **getattr(material, "kwargs", {})}
    words: Material = {}
    for name, value in properties.items():
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
            words[name] = images.index(data)
        elif isinstance(value, str | int | float | np.bool_):
            words[name] = int(value) if isinstance(value, bool | np.bool_) else value
        elif isinstance(value, np.ndarray | list | tuple) and np.asarray(value).dtype.kind in "iuf":
            numbers = np.asarray(value).reshape(-1)
            if numbers.dtype == np.uint8:
                numbers = numbers / 255
            words[name] = as_text(numbers[:3] if name.startswith("K") else numbers)
    finite = {name: value for name, value in words.items() if not isinstance(value, float) or np.isfinite(value)}
    return {} if finite == {"doubleSided": 0} else finite  # the default
