"""Meshes as Blender has them: attributes, materials and their images."""

from __future__ import annotations

import os
import tempfile
from typing import Any

import bpy
import numpy as np

from bsm.codec.arrays import Faces
from bsm.codec.geometry.attributes import Attribute, Domain, Semantic
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.metadata import gltf_values, images_in, kind_of_image, materials_in
from bsm.files.formats.polygons import Array, unused_name

_DOMAINS = {"vertex": "POINT", "corner": "CORNER", "face": "FACE"}
_TYPES = {1: ("FLOAT", "value"), 2: ("FLOAT2", "vector"), 3: ("FLOAT_VECTOR", "vector"), 4: ("FLOAT_COLOR", "color")}
_WIDTHS = {"FLOAT": 1, "INT": 1, "INT8": 1, "BOOLEAN": 1, "FLOAT2": 2, "FLOAT_VECTOR": 3, "FLOAT_COLOR": 4}
_OWN = ("position", "sharp_face", "material_index", "custom_normal")


def data_of(mesh: TriangleMesh, name: str) -> Any:
    """A mesh as Blender's, with everything that it carries."""
    made = bpy.data.meshes.new(name)
    made.vertices.add(len(mesh.positions))
    made.vertices.foreach_set("co", mesh.positions.astype(np.float32).reshape(-1))
    made.loops.add(3 * len(mesh.faces))
    made.loops.foreach_set("vertex_index", mesh.faces.reshape(-1))
    made.polygons.add(len(mesh.faces))
    made.polygons.foreach_set("loop_start", np.arange(0, 3 * len(mesh.faces), 3, dtype=np.int32))
    made.update(calc_edges=True)
    made.shade_smooth()
    for attribute in mesh.attributes:
        _add(made, attribute)
    _add_materials(made, mesh)
    return made


def _add(made: Any, attribute: Attribute) -> None:
    values = attribute.values if attribute.indices is None else attribute.values[attribute.indices.reshape(-1)]
    domain, width = _DOMAINS[attribute.domain], attribute.components
    if attribute.name == "material" and domain == "FACE" and width == 1 and values.dtype.kind in "iu":
        made.polygons.foreach_set("material_index", np.maximum(values[:, 0], 0).astype(np.int32))
        return
    if attribute.semantic == "normal" and width == 3 and domain != "FACE":
        split = made.normals_split_custom_set_from_vertices if domain == "POINT" else made.normals_split_custom_set
        split(values.astype(np.float64).tolist())
        return
    if attribute.semantic == "texcoord" and width == 2 and domain != "FACE":
        at_corners = values if domain == "CORNER" else values[_corners(made)]
        layer = made.uv_layers.new(name=attribute.name)
        layer.uv.foreach_set("vector", np.ascontiguousarray(at_corners, np.float32).reshape(-1))
        return
    if attribute.semantic == "color" and width >= 3:
        _add_color(made, attribute.name, values, domain)
        return
    whole = width == 1 and values.dtype.kind in "iu" and values.dtype != np.uint32
    kind, field = ("INT", "value") if whole else _TYPES[width]
    table = np.ascontiguousarray(values, np.int32 if whole else np.float32).reshape(-1)
    made.attributes.new(attribute.name, kind, domain).data.foreach_set(field, table)


def _add_color(made: Any, name: str, values: Array, domain: str) -> None:
    largest = {np.dtype(np.uint8): 255.0, np.dtype(np.uint16): 65535.0}.get(values.dtype, 1.0)
    table = np.ones((len(values), 4), np.float32)
    table[:, : values.shape[1]] = values / largest
    kind = "BYTE_COLOR" if values.dtype == np.uint8 else "FLOAT_COLOR"
    layer = made.attributes.new(name, kind, domain)
    layer.data.foreach_set("color_srgb" if kind == "BYTE_COLOR" else "color", table.reshape(-1))
    if domain != "FACE":
        made.color_attributes.active_color_name = layer.name
        made.color_attributes.render_color_index = made.color_attributes.find(layer.name)


def _corners(made: Any) -> Array:
    found = np.empty(len(made.loops), np.int32)
    made.loops.foreach_get("vertex_index", found)
    return found


def _add_materials(made: Any, mesh: TriangleMesh) -> None:
    known = materials_in(mesh.metadata)
    for number in range(max(known) + 1 if known else 0):
        made.materials.append(_material(gltf_values(known.get(number, {})), mesh.metadata, number))


def _material(words: dict[str, Any], metadata: Metadata, number: int) -> Any:
    made = bpy.data.materials.new(str(words.get("name") or f"material {number}"))
    made.use_nodes = True
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    if color := words.get("baseColorFactor"):
        shader.inputs["Base Color"].default_value = (*color[:3], 1.0)
        shader.inputs["Alpha"].default_value = color[3]
    for name, socket in (("metallicFactor", "Metallic"), ("roughnessFactor", "Roughness")):
        if name in words:
            shader.inputs[socket].default_value = words[name]
    data = images_in(metadata).get(words.get("baseColorTexture", -1), ("", b""))[1]
    if kind := kind_of_image(data):
        node = made.node_tree.nodes.new("ShaderNodeTexImage")
        node.image = _image(data, f"{made.name}.{kind}")
        made.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    return made


def _image(data: bytes, name: str) -> Any:
    """An image that is packed into the project, from the bytes of its file."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, name.replace(os.sep, "_"))
        with open(path, "wb") as file:
            file.write(data)
        image = bpy.data.images.load(path)
        image.pack()
    image.filepath = f"//{name}"
    return image


def triangles_of(data: Any) -> tuple[Faces, Array]:
    """The triangles of a mesh of Blender's, polygons cut by it: vertices and corners, each of shape (m, 3)."""
    data.calc_loop_triangles()
    count = len(data.loop_triangles)
    vertices, corners = np.empty(3 * count, np.int32), np.empty(3 * count, np.int32)
    data.loop_triangles.foreach_get("vertices", vertices)
    data.loop_triangles.foreach_get("loops", corners)
    return vertices.reshape(-1, 3), corners.reshape(-1, 3)


def attributes_of(data: Any, corners: Array) -> tuple[Attribute, ...]:
    """What a mesh of Blender's carries: texture coordinates, colours, numbers, and which material a face has."""
    found: dict[str, Attribute] = {}
    owner = np.empty(len(corners), np.int32)
    data.loop_triangles.foreach_get("polygon_index", owner)
    for layer in data.attributes:
        hidden = layer.name in _OWN or layer.name.startswith(".") or layer.is_internal
        kind = "FLOAT_COLOR" if layer.data_type == "BYTE_COLOR" else layer.data_type
        if hidden or kind not in _WIDTHS or layer.domain == "EDGE":
            continue
        values, semantic = _values(layer, kind)
        domain: Domain = {"POINT": "vertex", "CORNER": "corner", "FACE": "face"}[layer.domain]  # type: ignore[assignment]
        name = unused_name(layer.name, domain, found)
        indices = corners if domain == "corner" else None
        found[name] = Attribute(name, values[owner] if domain == "face" else values, domain, semantic, indices)
    slots = np.empty(len(data.polygons), np.int32)
    data.polygons.foreach_get("material_index", slots)
    if slots.any() and "material" not in found:
        found["material"] = Attribute("material", slots[owner], "face")
    return tuple(found.values())


def _values(layer: Any, kind: str) -> tuple[Array, Semantic]:
    width, count = _WIDTHS[kind], len(layer.data)
    if layer.data_type == "BYTE_COLOR":
        table = np.empty(4 * count, np.float32)
        layer.data.foreach_get("color_srgb", table)
        return np.rint(table.reshape(-1, 4) * 255).astype(np.uint8), "color"
    whole = kind in ("INT", "INT8", "BOOLEAN")
    table = np.empty(width * count, np.int32 if whole else np.float32)
    layer.data.foreach_get({1: "value", 4: "color"}.get(width, "vector"), table)
    values = table.reshape(-1, width)
    if width == 4:
        in_range = count and values.min() >= 0 and values.max() <= 1
        return values, "color" if in_range else "generic"
    return values, "texcoord" if width == 2 and layer.domain == "CORNER" else "generic"


def materials_of(slots: Any) -> dict[str, str | int | float | bytes]:
    """The metadata of an object's materials: names, colours, and the images of base colours."""
    found: dict[str, str | int | float | bytes] = {}
    images = 0
    for number, slot in enumerate(slots):
        material = slot.material
        if material is None:
            continue
        found[f"material.{number}.name"] = material.name
        nodes = material.node_tree.nodes if material.use_nodes and material.node_tree else ()
        shader = next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)
        if shader is None:
            continue
        color = [*shader.inputs["Base Color"].default_value][:3]
        found[f"material.{number}.baseColorFactor"] = " ".join(f"{one:.6g}" for one in (*color, 1.0))
        for name, socket in (("metallicFactor", "Metallic"), ("roughnessFactor", "Roughness")):
            found[f"material.{number}.{name}"] = float(shader.inputs[socket].default_value)
        links = shader.inputs["Base Color"].links
        image = links[0].from_node.image if links and links[0].from_node.type == "TEX_IMAGE" else None
        packed = bytes(image.packed_file.data) if image is not None and image.packed_file else b""
        if kind_of_image(packed):
            found[f"material.{number}.baseColorTexture"] = images
            found[f"image.{images}.data"] = packed
            images += 1
    return found
