"""DAE (COLLADA) as output: one geometry with a set of triangles for each material, written with pycollada."""

import io
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Any

import numpy as np

from bsm.bitstream.errors import imported
from bsm.codec.geometry.attributes import Attribute, at_corners
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.conventions import shares_of
from bsm.files.formats import metadata as materials
from bsm.files.formats.appearance import Material, as_numbers, fields_of, in_mtl, is_mtl, one_line
from bsm.files.parsing import Doubles, Ints
from bsm.ground.lengths import metres, unit_of

COLORS = {"Kd": "diffuse", "Ka": "ambient", "Ks": "specular", "Ke": "emission"}
NUMBERS = {"Ns": "shininess", "Ni": "index_of_refraction"}
IMAGES = {"map_Kd": "diffuse", "map_Ka": "ambient", "map_Ks": "specular", "map_Ke": "emission"}
"""Words of materials, and the properties of effects that hold them."""
OWN_WORDS = {*COLORS, *NUMBERS, *IMAGES} - {*fields_of("MTL")}
"""Words that effects hold, although no field of an appearance has their meaning."""
PROVENANCE = "provenance"
"""The entry of metadata that says how a stream was made; in a DAE, the tool that wrote it."""
_NO_DATE = datetime(1970, 1, 1, tzinfo=UTC)
AXES = ("X_UP", "Y_UP", "Z_UP")


def write_dae(mesh: TriangleMesh, stem: str) -> materials.Written:
    """Return a mesh as DAE in its own unit and axis; images lie beside it."""
    collada = imported("collada", "DAE is written with pycollada", "formats")
    document = collada.Collada()
    # Equal meshes become equal files.
    document.assetInfo.created = document.assetInfo.modified = _NO_DATE
    metadata_held = _say_place(document, mesh)
    metadata_held.add("name")
    provenance = mesh.metadata.get(PROVENANCE)
    if isinstance(provenance, str):
        document.assetInfo.contributors.append(
            collada.asset.Contributor(authoring_tool=one_line(provenance))
        )
        metadata_held.add(PROVENANCE)
    library = materials.Library(mesh, stem)
    texcoord = materials.first(mesh, "texcoord", (2,), "vertex", "corner")
    color = materials.first(mesh, "color", (3, 4), "vertex", "corner", "face")
    normal = materials.first(mesh, "normal", (3,), "vertex", "corner")
    name = one_line(str(mesh.metadata.get("name") or stem))
    geometry, indices = _add_geometry(collada, document, mesh, name, (normal, texcoord, color))
    numbers = materials.face_numbers(mesh, "material")
    face_materials = (
        np.zeros(len(mesh.faces), np.int64) if numbers is None else numbers.values[:, 0]
    )
    inputs = _inputs(collada, (normal, texcoord, color))
    symbols = []
    for number in np.unique(face_materials).tolist():
        material_words = library.materials.get(number, {})
        words = in_mtl(material_words)
        rows = indices[face_materials == number]
        symbol = f"material-{number}"
        geometry.primitives.append(geometry.createTriangleSet(rows.reshape(-1), inputs, symbol))
        material = _add_material(collada, document, number, words, library.images)
        metadata_held |= {
            f"material.{number}.{word}"
            for word in material_words
            if not is_mtl(word) or _holds(word, words, library.images)
        }
        symbols.append(
            collada.scene.MaterialNode(symbol, material, inputs=[("UV", "TEXCOORD", "0")])
        )
    document.geometries.append(geometry)
    node = collada.scene.Node(stem, children=[collada.scene.GeometryNode(geometry, symbols)])
    scene = collada.scene.Scene("scene", [node])
    document.scenes.append(scene)
    document.scene = scene
    data = _as_text(document, geometry)
    attributes_written = [
        attribute for attribute in (normal, texcoord, color, numbers) if attribute is not None
    ]
    unsaid = {
        name
        for name in materials.unsaid(mesh.metadata, "MTL")
        if name.split(".", 2)[2] not in OWN_WORDS
    }
    metadata_held = (metadata_held | library.written) - unsaid
    lost = materials.left_out(
        mesh, attributes_written, [name for name in mesh.metadata if name not in metadata_held]
    )
    return materials.Written(data, lost, library.beside)


def _say_place(document: Any, mesh: TriangleMesh) -> set[str]:
    """Write the unit and the upward axis of a mesh into a document; return the metadata that it holds."""
    metadata_held = set()
    up = str(mesh.metadata.get("up", "y")).upper()
    document.assetInfo.upaxis = "Y_UP"
    if f"{up}_UP" in AXES:
        document.assetInfo.upaxis = f"{up}_UP"
        metadata_held.add("up")
    unit = unit_of(mesh.metadata)
    size: float | None = None
    if unit:
        size = metres(unit)
    document.assetInfo.unitmeter, document.assetInfo.unitname = 1.0, "meter"
    if size is not None:
        document.assetInfo.unitmeter = size
        document.assetInfo.unitname = unit.replace(" ", "_")
        metadata_held.add("unit")
    return metadata_held


def _add_geometry(
    collada: Any,
    document: Any,
    mesh: TriangleMesh,
    name: str,
    attributes: Sequence[Attribute | None],
) -> tuple[Any, Ints]:
    """Return a geometry with its sources, and the indices of its corners, shape (m, 3, inputs)."""
    float_source = collada.source.FloatSource
    sources = [float_source("positions", mesh.positions.reshape(-1), ("X", "Y", "Z"))]
    columns: list[Ints] = [mesh.faces.astype(np.int64)]
    kinds = (("normals", "XYZ"), ("texcoords", "ST"), ("colors", "RGBA"))
    for (kind, components), attribute in zip(kinds, attributes, strict=True):
        if attribute is None:
            continue
        values, corners = _rows(mesh, attribute)
        sources.append(float_source(kind, values.reshape(-1), tuple(components[: values.shape[1]])))
        columns.append(corners)
    geometry = collada.geometry.Geometry(document, "geometry", name, sources)
    return geometry, np.stack(columns, axis=2)


def _rows(mesh: TriangleMesh, attribute: Attribute) -> tuple[Doubles, Ints]:
    """Return the values of an attribute, and their numbers at the corners, shape (m, 3)."""
    if attribute.semantic == "color":
        shares = shares_of(at_corners(attribute, mesh.faces))
        values, corners = np.unique(
            shares.reshape(-1, shares.shape[-1]), axis=0, return_inverse=True
        )
        return np.asarray(values, np.float64), corners.reshape(mesh.faces.shape)
    joined = materials.without_seams(attribute, mesh)
    indices = mesh.faces if joined.indices is None else joined.indices
    return np.asarray(joined.values, np.float64), indices.astype(np.int64)


def _inputs(collada: Any, attributes: Sequence[Attribute | None]) -> Any:
    """Return the list that tells which index of a corner belongs to which source."""
    inputs = collada.source.InputList()
    inputs.addInput(0, "VERTEX", "#positions")
    offset = 1
    for (meaning, source), attribute in zip(
        (("NORMAL", "#normals"), ("TEXCOORD", "#texcoords"), ("COLOR", "#colors")),
        attributes,
        strict=True,
    ):
        if attribute is None:
            continue
        number_of_set: str | None = None
        if meaning == "TEXCOORD":
            number_of_set = "0"
        inputs.addInput(offset, meaning, source, number_of_set)
        offset += 1
    return inputs


def _holds(word: str, words: Material, images: dict[int, str]) -> bool:
    """Return whether an effect holds a word of a material; a color beside its image gives way."""
    if word in IMAGES:
        return words[word] in images
    if word in COLORS:
        gives_way = any(IMAGES[image] == COLORS[word] for image in IMAGES if image in words)
        return len(as_numbers(words[word])) == 3 and not gives_way
    if word in NUMBERS:
        return len(as_numbers(words[word])) == 1
    return word in ("name", "d", "doubleSided")


def _add_material(
    collada: Any, document: Any, number: int, words: Material, images: dict[int, str]
) -> Any:
    """Add a material and its effect to a document."""
    unsaid = (
        "reflective",
        "reflectivity",
        "transparent",
        "ambient",
        "specular",
        "emission",
        "shininess",
    )
    properties: dict[str, Any] = {"diffuse": (1.0, 1.0, 1.0, 1.0), **dict.fromkeys(unsaid)}
    for word, name in COLORS.items():
        color = as_numbers(words.get(word, ""))
        if len(color) == 3:
            properties[name] = (*color, 1.0)
    for word, name in NUMBERS.items():
        value = as_numbers(words.get(word, ""))
        if len(value) == 1:
            properties[name] = value[0]
    parameters: list[Any] = []
    for word, name in IMAGES.items():
        place = words.get(word)
        if isinstance(place, int) and place in images:
            properties[name] = _add_image(
                collada, document, f"{number}-{name}", images[place], parameters
            )
    opacity = as_numbers(words.get("d", ""))
    if len(opacity) == 1:
        properties |= {
            "transparent": (1.0, 1.0, 1.0, 1.0),
            "transparency": opacity[0],
            "opaque_mode": "A_ONE",
        }
    properties["double_sided"] = bool(words.get("doubleSided"))
    effect = collada.material.Effect(f"effect-{number}", parameters, "phong", **properties)
    name = one_line(str(words.get("name") or f"material {number}"))
    material = collada.material.Material(f"material-{number}-id", name, effect)
    document.effects.append(effect)
    document.materials.append(material)
    return material


def _add_image(collada: Any, document: Any, name: str, path: str, parameters: list[Any]) -> Any:
    """Add an image to a document, and what shows it to the parameters of an effect; return the map."""
    image = collada.material.CImage(f"image-{name}", path)
    surface = collada.material.Surface(f"surface-{name}", image)
    sampler = collada.material.Sampler2D(f"sampler-{name}", surface)
    document.images.append(image)
    parameters += [surface, sampler]
    return collada.material.Map(sampler, "UV")


def _as_text(document: Any, geometry: Any) -> bytes:
    """Return a document with all digits of its numbers, of which pycollada writes seven."""
    document.save()
    for source in geometry.sourceById.values():
        if hasattr(source, "data"):
            array = source.xmlnode.find("{*}float_array")
            array.text = " ".join(
                map(repr, np.asarray(source.data, np.float64).reshape(-1).tolist())
            )
    file = io.BytesIO()
    document.xmlnode.write(file, encoding="utf-8", xml_declaration=True)
    return file.getvalue()
