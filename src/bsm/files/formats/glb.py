"""GLB, written with trimesh."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.geometry.splitting import split_by_attributes
from bsm.files.formats.columns import Array
from bsm.files.formats.for_trimesh import FACTORS, SCALARS, TEXTURES, arguments_of, shown_by_trimesh
from bsm.files.formats.materials import Material, as_gltf, images_in, kind_of_image, materials_in, names_in
from bsm.files.formats.with_trimesh import import_trimesh
from bsm.files.formats.written import Written, face_numbers, left_out
from bsm.files.rows import single_suffices


class _AsItIs:
    """An image that is written as the bytes that it was; trimesh would compress a JPEG once more."""

    def __init__(self, data: bytes, kind: str) -> None:
        self._data = data
        self.format = kind

    def save(self, file: Any, format: str = "") -> None:
        """Write the file."""
        file.write(self._data)


def write_glb(mesh: TriangleMesh, stem: str) -> Written:
    """The GLB of a mesh: a part for each material, and for each part that it was made of; images are in it."""
    trimesh = import_trimesh(".glb files are written")
    if not single_suffices(mesh.positions):
        raise MeshError("the coordinates need double precision, which GLB does not have; write PLY, OBJ or OFF")
    mesh = split_by_attributes(mesh)
    material, part = face_numbers(mesh, "material"), face_numbers(mesh, "part")
    shown = shown_by_trimesh(mesh)
    others = [a for a in mesh.attributes if a.domain == "vertex" and a not in shown and _is_single(a)]
    numbers = np.zeros((len(mesh.faces), 2), np.int64)
    for column, attribute in enumerate((part, material)):
        if attribute is not None:
            numbers[:, column] = attribute.values[:, 0]
    kinds, of_face = np.unique(numbers, axis=0, return_inverse=True)
    words = materials_in(mesh.metadata)
    scene, names = trimesh.Scene(), names_in(mesh.metadata, "part")
    for place, (number, its_material) in enumerate(kinds.tolist()):
        faces = np.flatnonzero(of_face.reshape(-1) == place)
        piece = _piece(mesh, faces, its_material, [a for a in (*shown, *others) if a is not None])
        called = names.get(number) or (mesh.metadata.get("name") if len(kinds) == 1 else None)
        geometry = trimesh.Trimesh(**arguments_of(piece))
        geometry.metadata.clear()
        if geometry.visual.kind == "texture":
            _keep_images(geometry.visual.material, words.get(its_material, {}), mesh.metadata)
        scene.add_geometry(geometry, geom_name=str(called or stem))
    said = {f"material.{n}.{name}" for n, known in words.items() for name in known if _is_said({name: known[name]})}
    said |= {f"image.{n}.data" for n in images_in(mesh.metadata)} | {f"part.{n}.name" for n in names} | {"part.names"}
    scene.metadata.update({n: v for n, v in mesh.metadata.items() if n not in said and not isinstance(v, bytes)})
    data = scene.export(file_type="glb")
    binary = [name for name, value in mesh.metadata.items() if name not in said and isinstance(value, bytes)]
    return Written(data, left_out(mesh, [*shown, *others, material, part], binary))


def _is_said(material: Material) -> bool:
    return any(name in (*TEXTURES, *FACTORS, *SCALARS) for name in as_gltf(material))


def _is_single(attribute: Attribute) -> bool:
    return bool((attribute.values.astype(np.float32) == attribute.values).all())


def _piece(mesh: TriangleMesh, faces: Array, material: int, attributes: list[Attribute]) -> TriangleMesh:
    """The part of these faces, with one material."""
    every_vertex = np.arange(len(mesh.positions))
    metadata = {n: v for n, v in mesh.metadata.items() if n.startswith((f"material.{material}.", "image."))}
    names = {a.name: a for a in attributes}
    taken = [a.taken(every_vertex, faces) for a in attributes]
    taken = [a if a.semantic != "generic" else replace(a, values=a.values.astype(np.float32)) for a in taken]
    assert len(names) == len(taken)
    return TriangleMesh(mesh.positions, mesh.faces[faces], tuple(taken), metadata).without_isolated_vertices()[0]


def _keep_images(material: Any, words: Material, metadata: Metadata) -> None:
    """Put the images of a material back as they were."""
    images = images_in(metadata)
    for name, number in as_gltf(words).items():
        data = images.get(number, ("", b""))[1] if isinstance(number, int) else b""
        kind = {"jpg": "JPEG", "png": "PNG"}.get(kind_of_image(data) or "")
        if name in TEXTURES and kind:
            material._data[name] = _AsItIs(data, kind)
