"""Meshes and scenes of trimesh: the parts, placed where a scene has them, as one mesh."""

import io
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.attributes import Domain
from bsm.files.formats.appearance import Material, as_text
from bsm.files.formats.metadata import Value, described, kind_of_image
from bsm.files.formats.polygons import (
    Array,
    Column,
    Part,
    Polygons,
    color_column,
    compact,
    joined_parts,
    meaning_of,
)
from bsm.files.parsing import Doubles

_NO_NAMES = re.compile(r"geometry_\d+|GLTF(_\d+)?")
_PADDING = re.compile(rb"(?<=IEND\xaeB`\x82)\0{1,3}\Z|(?<=\xff\xd9)\0{1,3}\Z")
"""The padding after a PNG or JPEG in GLB files."""
_OF_TRIMESH = (
    "units",
    "from_gltf_primitive",
    "gltf_extensions",
    "file_path",
    "file_name",
    "node",
    "processed",
)
"""Metadata that trimesh has added."""
_Surface: TypeAlias = tuple[Doubles, Any, str]
"""A place, the mesh there, and its name."""


def joined(scene: Any, limits: Limits = DEFAULT_LIMITS, received: int = 1 << 62) -> Polygons:
    """Join the surfaces of a scene, each as often and where the scene places it; `received` is the size of the file."""
    # That of the file; the graph has none.
    order = {name: place for place, name in enumerate(scene.geometry)}
    places = sorted(
        (scene.graph[node] for node in scene.graph.nodes_geometry),
        key=lambda place: order[place[1]],
    )
    surfaces: list[_Surface] = []
    for matrix, name in places:
        if hasattr(scene.geometry[name], "faces"):
            surfaces.append((matrix, scene.geometry[name], name))
    polygons = _polygons(surfaces, scene.metadata, limits, received)
    lost = len(places) - len(surfaces)
    if not lost:
        return polygons
    return replace(polygons, dropped=(*polygons.dropped, f"curves and point clouds ({lost})"))


def polygons_of(mesh: Any) -> Polygons:
    return _polygons([(np.eye(4), mesh, "")], {}, DEFAULT_LIMITS, 1 << 62)


def _columns(mesh: Any) -> Iterator[Column]:
    visual = mesh.visual
    if "vertex_normals" in mesh._cache:
        yield Column("normal", np.asarray(mesh.vertex_normals, np.float64), semantic="normal")
    if visual.kind == "texture":
        uv = visual.uv
        if uv is not None and np.shape(uv) == (len(mesh.vertices), 2):
            yield Column("texcoord", compact(np.asarray(uv, np.float64)), semantic="texcoord")
        colors = visual.vertex_attributes.get("color")
        if colors is not None and len(colors) == len(mesh.vertices):
            yield color_column(np.array(colors), "vertex")
    elif visual.kind == "vertex":
        yield color_column(np.array(visual.vertex_colors), "vertex")
    elif visual.kind == "face":
        yield color_column(np.array(visual.face_colors), "face")
    for name, values in mesh.vertex_attributes.items():
        yield _column(name.removeprefix("_"), values, "vertex")
    for name, values in mesh.face_attributes.items():
        yield _column(name, values, "face")


def _materials_of(mesh: Any) -> tuple[list[Any], Array]:
    """The materials of a mesh, and for each face the place of its own."""
    visual = mesh.visual
    first_of_all = np.zeros(len(mesh.faces), np.int64)
    if visual.kind != "texture" or visual.material is None:
        return [], first_of_all
    several = getattr(visual.material, "materials", None)
    if not several:
        return [visual.material], first_of_all
    numbers = getattr(visual, "face_materials", None)
    if numbers is None or np.shape(numbers) != first_of_all.shape:
        return [several[0]], first_of_all
    return list(several), np.clip(np.asarray(numbers, np.int64), 0, len(several) - 1)


def _column(name: str, values: Any, domain: Domain) -> Column:
    table = np.array(values)
    if table.ndim == 1:
        table = table[:, None]
    width = 0
    if table.ndim == 2:
        width = table.shape[1]
    return Column(name, table, domain, meaning_of(name, width))


def _polygons(
    surfaces: list[_Surface], of_scene: dict[str, Any], limits: Limits, received: int
) -> Polygons:
    """Meshes of trimesh with their places and names as one."""
    meshes = [mesh for _, mesh, _ in surfaces]
    of_materials, numbers = _materials(meshes)

    def parts() -> Iterator[Part]:
        for (matrix, mesh, name), materials in zip(surfaces, numbers, strict=True):
            faces = np.asarray(mesh.faces, np.int64)
            points, sizes = np.asarray(mesh.vertices, np.float64), np.full(len(faces), 3)
            yield Part(points, sizes, faces.reshape(-1), [*_columns(mesh)], materials, name).placed(
                matrix
            )

    counts = [(len(mesh.vertices), len(mesh.faces)) for mesh in meshes]
    joined = joined_parts(parts(), counts, limits, received)
    metadata, losses = _metadata(meshes, of_scene)
    names = joined.metadata
    if _NO_NAMES.fullmatch(str(names.get("name", ""))):
        names = {}
    return replace(joined, metadata={**names, **metadata, **of_materials}, dropped=tuple(losses))


def _metadata(
    meshes: list[Any], of_scene: dict[str, Any]
) -> tuple[dict[str, Value], dict[str, None]]:
    """What trimesh knows of a scene and its parts, and the names of what metadata cannot hold."""
    entries: dict[str, Value] = {}
    losses: dict[str, None] = {}
    for source in (of_scene, *(mesh.metadata for mesh in meshes)):
        for name, value in source.items():
            is_blank = value is None or (isinstance(value, str) and not value.strip("\0 "))
            if not name or name in _OF_TRIMESH or is_blank:
                continue
            if isinstance(value, bool):
                value = int(value)
            if isinstance(value, str | int | float | bytes):
                entries.setdefault(str(name), value)
            else:
                losses[f"metadata {name}"] = None
    units = [*dict.fromkeys(mesh.units for mesh in meshes)]
    if len(units) == 1 and isinstance(units[0], str):
        entries.setdefault("unit", units[0])
    return entries, losses


def _materials(meshes: list[Any]) -> tuple[dict[str, Value], list[Array]]:
    """The different materials of meshes, with their images, as metadata; and the number of that of each face."""
    numbered: dict[frozenset[tuple[str, Value]], tuple[int, Material]] = {}
    images: list[bytes] = []
    numbers = []
    for mesh in meshes:
        materials, of_faces = _materials_of(mesh)
        all_words = [_words_of(material, images) for material in materials] or [{}]
        places = np.zeros(len(all_words), np.int32)
        for place, words in enumerate(all_words):
            places[place], _ = numbered.setdefault(frozenset(words.items()), (len(numbered), words))
        numbers.append(places[of_faces])
    metadata = described(dict(numbered.values()))
    metadata |= {f"image.{number}.data": data for number, data in enumerate(images)}
    return metadata, numbers


def _numbers_as_text(name: str, numbers: Array) -> str:
    """The numbers of a word, bytes as shares; the colors of MTL have three."""
    if numbers.dtype == np.uint8:
        numbers = numbers / 255
    if name.startswith("K"):
        numbers = numbers[:3]
    return as_text(numbers)


def _words_of(material: Any, images: list[bytes]) -> Material:
    """A material of trimesh in the words of glTF, or of MTL; new images are added to `images`."""
    properties = dict(getattr(material, "_data", None) or {})
    if not properties and hasattr(material, "diffuse"):  # one with the words of MTL
        properties = {
            "Kd": material.diffuse,
            "Ka": material.ambient,
            "Ks": material.specular,
            "Ns": material.glossiness,
            "map_Kd": material.image,
            "name": material.name,
            **getattr(material, "kwargs", {}),
        }
    words: Material = {}
    for name, value in properties.items():
        if hasattr(value, "save"):
            if value.format is None and value.size == (1, 1):
                continue  # that of the material that trimesh gives to what has none
            data = _data_of(value)
            if data not in images:
                images.append(data)
            words[name] = images.index(data)
        elif isinstance(value, bool | np.bool_):
            words[name] = int(value)
        elif isinstance(value, str | int) or (isinstance(value, float) and np.isfinite(value)):
            words[name] = value
        elif isinstance(value, np.ndarray | list | tuple) and np.asarray(value).dtype.kind in "iuf":
            words[name] = _numbers_as_text(name, np.asarray(value).reshape(-1))
    if words == {"doubleSided": 0}:  # the default
        return {}
    return words


def _data_of(image: Any) -> bytes:
    """The file that an image of Pillow was, if it is still there, or else a PNG of it."""
    file = getattr(image, "fp", None)
    if isinstance(file, io.BytesIO) and not file.closed and kind_of_image(file.getvalue()):
        return re.sub(_PADDING, b"", file.getvalue())
    buffer = io.BytesIO()
    image.save(buffer, format="PNG")
    return buffer.getvalue()
