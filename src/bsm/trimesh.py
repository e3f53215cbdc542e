"""trimesh opens and writes .bsm: ``import bsm.trimesh``, then ``trimesh.load("a.bsm")`` and ``mesh.export("b.bsm")``.

Attributes are kept: texture coordinates, materials and their images as `TextureVisuals`, colors as `ColorVisuals`,
normals, and other values as `vertex_attributes` and `face_attributes`.

>>> import bsm.trimesh, trimesh
>>> bsm.trimesh.to_trimesh("bunny.bsm").is_watertight
True
>>> scene = trimesh.Scene({"box": trimesh.creation.box(), "ball": trimesh.creation.icosphere()})
>>> sorted(bsm.trimesh.to_scene(bsm.trimesh.from_trimesh(scene)).geometry)
['ball', 'box']
"""

import io
from collections.abc import Iterator
from typing import IO, Any

import numpy as np

from bsm.api import decode, encode
from bsm.bitstream.errors import imported
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes
from bsm.files.formats import metadata as formats
from bsm.files.formats.appearance import Material, Texture, appearance, in_gltf
from bsm.files.formats.polygons import Array
from bsm.files.libraries import as_mesh

__all__ = ["from_trimesh", "to_scene", "to_trimesh"]
_library = imported("trimesh", ".bsm files are opened by trimesh only with trimesh", "formats")


def to_trimesh(mesh: Any) -> Any:
    """Convert a mesh to a `trimesh.Trimesh`.

    Vertices are split where corners differ, for example in texture coordinates; no vertices are merged.
    """
    return _library.Trimesh(**arguments_of(as_mesh(mesh)))


def to_scene(mesh: Any) -> Any:
    """Convert a mesh to a `trimesh.Scene`, with a named geometry for each part.

    The integer face attribute ``part`` numbers the parts; without it, the mesh is one part.
    """
    whole = as_mesh(mesh)
    scene = _library.Scene()
    for name, part in parts_of(whole):
        scene.add_geometry(_library.Trimesh(**arguments_of(part)), geom_name=name)
    of_parts = ("material.", "image.", "part.")
    scene.metadata.update(
        {name: value for name, value in whole.metadata.items() if not name.startswith(of_parts)}
    )
    return scene


def from_trimesh(mesh: Any) -> TriangleMesh:
    """Convert a mesh of trimesh, or a scene with all its parts at their places, with attributes and materials."""
    return as_mesh(mesh)


def arguments_of(mesh: TriangleMesh) -> dict[str, Any]:
    """Return the arguments of `trimesh.Trimesh` for a mesh; split vertices where corners differ."""
    mesh = split_by_attributes(mesh)
    normal, color, texcoord = formats.shown_at_vertices(mesh)
    of_faces = formats.first(mesh, "color", (3, 4), "face")
    visual = None
    if texcoord is not None or formats.materials_in(mesh.metadata):
        visual, of_faces = _textured(mesh, texcoord), None
        if color is not None:
            visual.vertex_attributes["color"] = formats.rgba(color)
    elif color is not None:
        visual, of_faces = _library.visual.ColorVisuals(vertex_colors=formats.rgba(color)), None
    elif of_faces is not None:
        visual = _library.visual.ColorVisuals(face_colors=formats.rgba(of_faces))
    shown = {
        attribute.name for attribute in (normal, color, texcoord, of_faces) if attribute is not None
    }
    others = [attribute for attribute in mesh.attributes if attribute.name not in shown]
    plain = [
        (name, value)
        for name, value in mesh.metadata.items()
        if not name.startswith(("material.", "image."))
    ]
    # What trimesh calls it; its functions for units look there.
    metadata = {"units" if name == "unit" else name: value for name, value in plain}
    arguments: dict[str, Any] = {
        "vertices": mesh.positions,
        "faces": mesh.faces,
        "vertex_normals": None if normal is None else normal.values,
        "visual": visual,
        "vertex_attributes": {a.name: _flat(a.values) for a in others if a.domain == "vertex"},
        "face_attributes": {a.name: _flat(a.values) for a in others if a.domain == "face"},
        "metadata": metadata,
        # trimesh merges vertices otherwise, and values of vertices would no longer be theirs.
        "process": False,
    }
    return {name: value for name, value in arguments.items() if value is not None}


def _textured(mesh: TriangleMesh, texcoord: Attribute | None) -> Any:
    """Return the texture coordinates of vertices and the materials of faces as `TextureVisuals`."""
    known, numbers = formats.materials_in(mesh.metadata), formats.face_numbers(mesh, "material")
    materials = [_material(words, mesh.metadata) for words in known.values()]
    if not materials or (numbers is not None and not np.isin(numbers.values, list(known)).all()):
        # For faces without a material; trimesh would give them a gray material with an image.
        materials.append(_library.visual.material.PBRMaterial())
    uv, material, of_each = None if texcoord is None else texcoord.values[:, :2], materials[0], None
    if numbers is not None and len(materials) > 1:
        place = {number: place for place, number in enumerate(known)}
        material = _library.visual.material.MultiMaterial(materials)
        of_each = np.array(
            [place.get(number, len(known)) for number in numbers.values[:, 0].tolist()]
        )
    return _library.visual.TextureVisuals(uv=uv, material=material, face_materials=of_each)


def parts_of(mesh: TriangleMesh) -> Iterator[tuple[str, TriangleMesh]]:
    """Yield the name and the mesh of each part, with the materials of its faces and no other metadata."""
    part, material = formats.face_numbers(mesh, "part"), formats.face_numbers(mesh, "material")
    numbers = np.zeros(len(mesh.faces), np.int64) if part is None else part.values[:, 0]
    attributes = [attribute for attribute in mesh.attributes if attribute is not part]
    words, names = formats.materials_in(mesh.metadata), formats.names_in(mesh.metadata, "part")
    images = {name: value for name, value in mesh.metadata.items() if name.startswith("image.")}
    every_vertex = np.arange(len(mesh.positions))
    for number in np.unique(numbers).tolist():
        faces = np.flatnonzero(numbers == number)
        used = {0} if material is None else set(material.values[faces, 0].tolist())
        known = formats.described({which: known for which, known in words.items() if which in used})
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


def _material(words: Material, metadata: Metadata) -> Any:
    images, known = formats.images_in(metadata), in_gltf(appearance(words))
    known |= {
        n: _opened(images.get(v.image, ("", b""))[1])
        for n, v in known.items()
        if isinstance(v, Texture)
    }
    return _library.visual.material.PBRMaterial(**known)


def _opened(data: bytes) -> Any:
    try:
        import PIL.Image
    except ImportError:
        return None
    try:
        return PIL.Image.open(io.BytesIO(data))
    except (OSError, ValueError, PIL.Image.DecompressionBombError):
        return None


def _load(file_obj: IO[bytes], file_type: str | None = None, **keywords: Any) -> dict[str, Any]:
    return arguments_of(decode(file_obj.read())) | {
        name: keywords[name] for name in ("process",) if name in keywords
    }


_library.exchange.load.mesh_loaders["bsm"] = _load
# trimesh has a public table of loaders, and none of exporters.
_library.exchange.export._mesh_exporters["bsm"] = lambda mesh, **keywords: encode(
    from_trimesh(mesh), **keywords
)
