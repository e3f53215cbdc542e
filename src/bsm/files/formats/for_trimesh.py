"""A mesh as trimesh has it: what it shows as visuals."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Any

import numpy as np

from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes
from bsm.files.formats.columns import Array
from bsm.files.formats.materials import (
    GLTF_TEXTURES,
    Material,
    described,
    gltf_values,
    images_in,
    materials_in,
    names_in,
)
from bsm.files.formats.with_trimesh import import_trimesh
from bsm.files.formats.written import face_numbers, first, rgba, shown_at_vertices


def arguments_of(mesh: TriangleMesh) -> dict[str, Any]:
    """The arguments of `trimesh.Trimesh` that make it of a mesh; vertices are split where corners differ."""
    trimesh = import_trimesh("meshes of trimesh are made")
    mesh = split_by_attributes(mesh)
    normal, color, texcoord = shown_at_vertices(mesh)
    of_faces = first(mesh, "color", (3, 4), "face")
    known = materials_in(mesh.metadata)
    materials = [_material(trimesh, words, mesh.metadata) for words in known.values()]
    visual = None
    if texcoord is not None or materials:
        uv = None if texcoord is None else texcoord.values[:, :2]
        numbers = face_numbers(mesh, "material")
        place = {number: place for place, number in enumerate(known)}
        if not materials or (numbers is not None and not np.isin(numbers.values, list(known)).all()):
            # Of faces of whose material nothing is said: trimesh would give them a grey one, and an image.
            materials.append(trimesh.visual.material.PBRMaterial())
        several = numbers is not None and len(materials) > 1
        material = trimesh.visual.material.MultiMaterial(materials) if several else materials[0]
        of_each = None
        if several and numbers is not None:
            of_each = np.array([place.get(number, len(known)) for number in numbers.values[:, 0].tolist()])
        visual = trimesh.visual.TextureVisuals(uv=uv, material=material, face_materials=of_each)
        if color is not None:
            visual.vertex_attributes["color"] = rgba(color)
        of_faces = None
    elif color is not None:
        visual, of_faces = trimesh.visual.ColorVisuals(vertex_colors=rgba(color)), None
    elif of_faces is not None:
        visual = trimesh.visual.ColorVisuals(face_colors=rgba(of_faces))
    shown = {attribute.name for attribute in (normal, color, texcoord, of_faces) if attribute is not None}
    others = [attribute for attribute in mesh.attributes if attribute.name not in shown]
    metadata = {
        "units" if name == "unit" else name: value
        for name, value in mesh.metadata.items()
        if not name.startswith(("material.", "image."))
    }
    arguments: dict[str, Any] = {
        "vertices": mesh.positions,
        "faces": mesh.faces,
        "vertex_normals": None if normal is None else normal.values,
        "visual": visual,
        "vertex_attributes": {a.name: _flat(a.values) for a in others if a.domain == "vertex"},
        "face_attributes": {a.name: _flat(a.values) for a in others if a.domain == "face"},
        "metadata": metadata,
        "process": False,
    }
    return {name: value for name, value in arguments.items() if value is not None}


def parts_of(mesh: TriangleMesh) -> Iterator[tuple[str, TriangleMesh]]:
    """The parts that a mesh was made of, and their names; each has the materials of its faces, and no other metadata"""
    part, material = face_numbers(mesh, "part"), face_numbers(mesh, "material")
    numbers = np.zeros(len(mesh.faces), np.int64) if part is None else part.values[:, 0]
    attributes = [attribute for attribute in mesh.attributes if attribute is not part]
    words, names = materials_in(mesh.metadata), names_in(mesh.metadata, "part")
    images = {name: value for name, value in mesh.metadata.items() if name.startswith("image.")}
    every_vertex = np.arange(len(mesh.positions))
    for number in np.unique(numbers).tolist():
        faces = np.flatnonzero(numbers == number)
        used = {0} if material is None else set(material.values[faces, 0].tolist())
        known = described({which: known for which, known in words.items() if which in used})
        piece = TriangleMesh(
            mesh.positions,
            mesh.faces[faces],
            tuple(attribute.taken(every_vertex, faces) for attribute in attributes),
            {**known, **(images if known else {})},
        )
        called = names.get(number) or (mesh.metadata.get("name") if part is None else None)
        yield str(called or f"part {number}"), piece.without_isolated_vertices()[0]


def _flat(values: Array) -> Array:
    return values[:, 0] if values.shape[1] == 1 else values


def _material(trimesh: Any, words: Material, metadata: Metadata) -> Any:
    """A material as trimesh has it."""
    images, known = images_in(metadata), gltf_values(words)
    for name in set(GLTF_TEXTURES) & known.keys():
        known[name] = _opened(images.get(known[name], ("", b""))[1])
    return trimesh.visual.material.PBRMaterial(**{name: value for name, value in known.items() if value is not None})


def _opened(data: bytes) -> Any:
    """An image, or None where it cannot be opened."""
    try:
        import PIL.Image
    except ImportError:
        return None
    try:
        return PIL.Image.open(io.BytesIO(data))
    except (OSError, ValueError, PIL.Image.DecompressionBombError):
        return None
