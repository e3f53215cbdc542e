"""Materials that are written: the words of metadata as preview surfaces, and the faces that have them."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.appearance import (
    Appearance,
    Material,
    Texture,
    appearance,
    held_by,
    lost,
    within,
)
from bsm.files.formats.metadata import (
    face_numbers,
    images_in,
    kind_of_image,
    materials_in,
    names_in,
)
from bsm.files.motion.usd.library import (
    COORDINATES,
    DEFAULTS,
    INPUTS,
    NO_TIME,
    READER,
    SIDES,
    SURFACE,
    TEXTURE,
    TRANSFORM,
)

_MOST_SETS = 1 << 12  # of the faces of parts: each is a prim
_IMAGE_KINDS = ("png", "jpg", "exr")  # those that USD knows


def write_materials(
    pxr: Any, mesh: Any, frame: TriangleMesh, folder: Path | None
) -> tuple[dict[int, Any], set[str]]:
    """Write the materials of a mesh beneath it; return them by their numbers, and the metadata that they express."""
    materials = materials_in(frame.metadata)
    image_files: dict[int, str] = {}
    if folder is not None:
        image_files = _write_images(frame.metadata, folder)
    written: set[str] = set()
    for number in image_files:
        written |= {f"image.{number}.name", f"image.{number}.data"}
    # USD says it of a mesh and not of a material, so one single-sided material keeps it from being said.
    if materials and all(words.get("doubleSided") for words in materials.values()):
        mesh.CreateDoubleSidedAttr(True)
        written |= {f"material.{number}.doubleSided" for number in materials}
    prims: dict[int, Any] = {}
    for number, words in materials.items():
        prims[number] = _define_material(pxr, mesh, number, words)
        look = within(appearance(words))[0]
        lost_words = lost(words, _Surface(pxr, prims[number], look, image_files).write())
        written |= {f"material.{number}.{word}" for word in words.keys() - {*lost_words}}
    bind_materials(pxr, mesh, frame, prims)
    return prims, written


def _write_images(metadata: Metadata, folder: Path) -> dict[int, str]:
    names: dict[int, str] = {}
    for number, (_, data) in images_in(metadata).items():
        kind = kind_of_image(data)
        if kind in _IMAGE_KINDS:
            names[number] = f"image_{number}.{kind}"
            (folder / names[number]).write_bytes(data)
    return names


def _define_material(pxr: Any, mesh: Any, number: int, words: Material) -> Any:
    """Add a material beneath a mesh, under its name unless another prim has it."""
    stage = mesh.GetPrim().GetStage()
    name = pxr.Tf.MakeValidIdentifier(str(words.get("name") or f"material_{number}"))
    path = mesh.GetPath().AppendChild(name)
    if stage.GetPrimAtPath(path):
        path = mesh.GetPath().AppendChild(f"{name}_{number}")
    return pxr.UsdShade.Material.Define(stage, path)


def bind_materials(
    pxr: Any, mesh: Any, frame: TriangleMesh, prims: Mapping[int, Any], time: float = NO_TIME
) -> None:
    """Bind the faces of a frame to their materials, from a time on if there is one."""
    numbers = face_numbers(frame, "material")
    api = pxr.UsdShade.MaterialBindingAPI
    if numbers is None:
        if 0 in prims:
            api.Apply(mesh.GetPrim()).Bind(prims[0])
        return
    for number, material in prims.items():
        subset = _write_subset(
            pxr, mesh, f"faces_{number}", pxr.UsdShade.Tokens.materialBind, numbers, number, time
        )
        api.Apply(subset.GetPrim()).Bind(material)


def write_parts(
    pxr: Any, mesh: Any, frame: TriangleMesh, time: float = NO_TIME
) -> Attribute | None:
    """Write a set of faces for each part, under its name; return the attribute that numbers the parts."""
    numbers = face_numbers(frame, "part")
    names = names_in(frame.metadata, "part")
    if numbers is None or len(names) > _MOST_SETS:
        return None
    if not {*np.unique(numbers.values).tolist()} <= names.keys():
        return None
    for number, name in names.items():
        subset = _write_subset(pxr, mesh, f"part_{number}", "part", numbers, number, time)
        subset.GetPrim().SetDisplayName(name)
    return numbers


def _write_subset(
    pxr: Any, mesh: Any, name: str, family: str, numbers: Attribute, number: int, time: float
) -> Any:
    """Write the faces that have a number, from a time on if there is one."""
    geom = pxr.UsdGeom
    geom.Subset.SetFamilyType(mesh, family, geom.Tokens.nonOverlapping)
    subset = geom.Subset.Define(mesh.GetPrim().GetStage(), mesh.GetPath().AppendChild(name))
    subset.CreateElementTypeAttr(geom.Tokens.face)
    subset.CreateFamilyNameAttr(family)
    faces = np.flatnonzero(numbers.values[:, 0] == number)
    subset.CreateIndicesAttr().Set(faces, time)
    return subset


class _Surface:
    """A preview surface of a material, as far as USD has inputs for an appearance."""

    def __init__(
        self, pxr: Any, material: Any, look: Appearance, images: Mapping[int, str]
    ) -> None:
        self._pxr = pxr
        self._types = pxr.Sdf.ValueTypeNames
        self._material = material
        self._look = look
        self._images = images
        self._shader = self._add_shader("surface", SURFACE)

    def write(self) -> set[str]:
        """Write the inputs, and return the fields of the appearance that they hold."""
        look = self._look
        output = self._material.CreateSurfaceOutput()
        output.ConnectToSource(self._shader.ConnectableAPI(), "surface")
        if look.opacity < 1.0 and look.mode != "OPAQUE":
            self._shader.CreateInput("opacity", self._types.Float).Set(look.opacity)
        fields = held_by("USD")
        required_inputs = {*DEFAULTS}  # USD has other values for these where nothing is said
        if look.mode == "MASK":
            required_inputs.add("opacityThreshold")
        for name, (kind, number_field, texture_field) in INPUTS.items():
            texture: Texture | None = None
            value: Any = None
            if texture_field:
                texture = getattr(look, texture_field)
            if number_field:
                value = getattr(look, number_field)
            if texture is not None and self._images.get(texture.image) is not None:
                self._write_texture(name, kind, texture, value)
                continue
            if texture_field:
                fields.discard(texture_field)
            if number_field and (name in required_inputs or look.says(number_field)):
                if isinstance(value, tuple):
                    value = self._pxr.Gf.Vec3f(*value)
                self._shader.CreateInput(name, getattr(self._types, kind)).Set(value)
        return fields

    def _add_shader(self, name: str, kind: str) -> Any:
        stage = self._material.GetPrim().GetStage()
        shader = self._pxr.UsdShade.Shader.Define(stage, self._material.GetPath().AppendChild(name))
        shader.CreateIdAttr(kind)
        return shader

    def _write_texture(self, name: str, kind: str, texture: Texture, factor: Any) -> None:
        """Connect an input to an image, whose colors are multiplied by a factor."""
        types = self._types
        vector = self._pxr.Gf.Vec4f
        has_opacity = name == "diffuseColor" and self._look.mode != "OPAQUE"
        coordinates = self._add_shader("coordinates", READER)
        coordinates.CreateInput("varname", types.String).Set(COORDINATES)
        shader = self._add_shader(f"{name}_texture", TEXTURE)
        image_path = self._pxr.Sdf.AssetPath(f"./{self._images[texture.image]}")
        shader.CreateInput("file", types.Asset).Set(image_path)
        if texture.scale != (1.0, 1.0) or texture.offset != (0.0, 0.0) or texture.rotation != 0.0:
            coordinates = self._add_transform(name, texture, coordinates)
        shader.CreateInput("st", types.Float2).ConnectToSource(
            coordinates.ConnectableAPI(), "result"
        )
        for side, way in zip(SIDES, texture.wrap):
            shader.CreateInput(side, types.Token).Set(way)
        if isinstance(factor, tuple):
            opacity = 1.0
            if has_opacity:
                opacity = self._look.opacity
            scale = (*factor, opacity)
            if scale != (1.0,) * 4:
                shader.CreateInput("scale", types.Float4).Set(vector(*scale))
        # A normal map holds shares from 0 to 1 of what runs from -1 to 1. UsdPreviewSurface does not unfold them by
        # itself.
        if name == "normal":
            shader.CreateInput("scale", types.Float4).Set(vector(2.0, 2.0, 2.0, 1.0))
            shader.CreateInput("bias", types.Float4).Set(vector(-1.0, -1.0, -1.0, 0.0))
        if name in ("normal", "occlusion"):
            shader.CreateInput("sourceColorSpace", types.Token).Set("raw")
        surface_input = self._shader.CreateInput(name, getattr(types, kind))
        channels = "rgb"
        if kind == "Float":
            channels = "r"
        surface_input.ConnectToSource(shader.ConnectableAPI(), channels)
        if has_opacity:
            opacity_input = self._shader.CreateInput("opacity", types.Float)
            opacity_input.ConnectToSource(shader.ConnectableAPI(), "a")

    def _add_transform(self, name: str, texture: Texture, reader: Any) -> Any:
        """Add a transform of coordinates, beside its texture: two textures of a material may have different ones."""
        types = self._types
        pair = self._pxr.Gf.Vec2f
        transform = self._add_shader(f"{name}_transform", TRANSFORM)
        transform.CreateInput("in", types.Float2).ConnectToSource(reader.ConnectableAPI(), "result")
        transform.CreateInput("scale", types.Float2).Set(pair(*texture.scale))
        transform.CreateInput("rotation", types.Float).Set(math.degrees(texture.rotation))
        transform.CreateInput("translation", types.Float2).Set(pair(*texture.offset))
        return transform
