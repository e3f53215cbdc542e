"""Materials that are read: the preview surfaces of a stage in the words of metadata."""

import math
import os
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.limits import Limits
from bsm.files.formats.appearance import WAYS, Appearance, Material, Texture, as_text, in_gltf
from bsm.files.formats.metadata import Beside, Value, described, fetched
from bsm.files.motion.usd.library import (
    DEFAULTS,
    INPUTS,
    READER,
    SIDES,
    SURFACE,
    TEXTURE,
    TRANSFORM,
    SurfaceInput,
)
from bsm.files.parsing import Ints, as_library_error
from bsm.files.unread import Said, Taken, rows_of

_TAKEN = rows_of("usd")


class Materials:
    """The materials of the meshes of a stage, numbered as they are met."""

    def __init__(self, pxr: Any, path: str, stage: Any) -> None:
        self._pxr = pxr
        self._path = path
        self._stage = stage
        # By what materials say and not by their paths: instances and copies of a prim name the same look under many
        # paths.
        self._numbers: dict[tuple[tuple[str, str | int | float], ...], int] = {}
        self._images: dict[str, int] = {}
        self._packages: dict[str, str] = {}  # that images are in, if not in the stage itself
        self._coordinate_sets = set[str]()
        self._unsupported = set[str]()

    def number_faces(self, prim: Any, faces: int, time: Any) -> tuple[Ints, list[tuple[str, Ints]]]:
        """Return the number of each face's material, and the sets of faces without a material."""
        self._note_coordinates(prim)
        geom = self._pxr.UsdGeom
        double_sided = bool(geom.Mesh(prim).GetDoubleSidedAttr().Get())
        numbers = np.full(faces, -1, np.int64)
        unbound_sets: list[tuple[str, Ints]] = []
        for subset in geom.Subset.GetAllGeomSubsets(geom.Imageable(prim)):
            if subset.GetElementTypeAttr().Get() != geom.Tokens.face:
                continue
            indices = np.array(subset.GetIndicesAttr().Get(time) or [], np.int64)
            indices = indices[(indices >= 0) & (indices < faces)]
            subset_prim = subset.GetPrim()
            if self._bound_material(subset_prim):
                numbers[indices] = self._number(subset_prim, double_sided)
            else:
                name = subset_prim.GetDisplayName() or subset_prim.GetName()
                unbound_sets.append((str(name), indices))
        unnumbered = numbers < 0
        if unnumbered.any():
            numbers[unnumbered] = self._number(prim, double_sided)
        return numbers, unbound_sets

    def metadata(self, limits: Limits) -> tuple[dict[str, Value], list[str], tuple[str, ...]]:
        """Return the metadata of all materials, with images of limited size, notes on missing images, and losses."""
        entries = described({number: dict(words) for words, number in self._numbers.items()})
        entries |= {f"image.{number}.name": name for name, number in self._images.items()}
        if zipfile.is_zipfile(self._path):
            with as_library_error("zipfile"), zipfile.ZipFile(self._path) as package:
                return fetched(entries, lambda name: _read_entry(package, name, limits.frame_bytes))
        folder = Beside(Path(self._path).parent, limits)

        def read_image(name: str) -> bytes | str:
            if name not in self._packages:
                return folder.read(name)
            package_path = folder.find(self._packages[name])
            if isinstance(package_path, str):
                return package_path
            with as_library_error("zipfile"), zipfile.ZipFile(package_path) as package:
                return _read_entry(package, name, limits.frame_bytes)

        return fetched(entries, read_image)

    @cached_property
    def unread(self) -> list[str]:
        """The names in the stage that nothing reads, once all its materials are numbered."""
        variable_names = [f"varname={name}" for name in sorted(self._coordinate_sets)]
        reader_row = " ".join((_TAKEN[READER], *variable_names))
        read_names = Taken({**_TAKEN, READER: reader_row})
        return sorted(self._unsupported) + read_names.unread_names(self._authored_names())

    def _authored_names(self) -> Iterator[Said]:
        shader_type = self._pxr.UsdShade.Shader
        prototypes = map(self._pxr.Usd.PrimRange, self._stage.GetPrototypes())
        for prim in chain(self._stage.Traverse(), *prototypes):
            if prim.IsA(shader_type):
                kind = str(shader_type(prim).GetIdAttr().Get())
                unread_name = f"shader {kind}"
                prefix = "inputs:"
            else:
                kind = str(prim.GetTypeName())
                unread_name = f"{kind}, which is not a mesh"
                prefix = ""
            if kind not in _TAKEN:
                yield "", unread_name, ""
                continue
            for name in self._properties(prim):
                attribute = prim.GetAttribute(name)
                value = ""
                if attribute and attribute.GetTypeName().isScalar:
                    value = attribute.Get()
                yield kind, name.removeprefix(prefix), value

    def _properties(self, prim: Any) -> list[str]:
        """Return the names of the properties that a prim has, once each."""
        names = dict.fromkeys(prim.GetAuthoredPropertyNames())
        if prim.IsA(self._pxr.UsdGeom.Mesh):
            # Without a scheme, the surface is that of Catmull and Clark.
            names["subdivisionScheme"] = None
        if prim.HasAuthoredCustomData():
            return [*names, "customData"]
        return [*names]

    def _note_coordinates(self, prim: Any) -> None:
        """Remember the first set of texture coordinates of a mesh: only it is read."""
        for primvar in self._pxr.UsdGeom.PrimvarsAPI(prim).FindPrimvarsWithInheritance():
            if str(primvar.GetTypeName()).startswith("texCoord2"):
                self._coordinate_sets.add(str(primvar.GetPrimvarName()))
                return

    def _bound_material(self, prim: Any) -> Any:
        return self._pxr.UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]

    def _number(self, prim: Any, double_sided: bool) -> int:
        material = self._bound_material(prim)
        words: Material = {}
        if material:
            words = self._words(material)
        if double_sided:
            words["doubleSided"] = 1
        return self._numbers.setdefault(tuple(words.items()), len(self._numbers))

    def _words(self, material: Any) -> Material:
        name = str(material.GetPrim().GetName())
        surface = material.ComputeSurfaceSource()[0]
        if not surface or surface.GetIdAttr().Get() != SURFACE:
            return {"name": name}
        for input_name in ("metallic", "roughness"):
            if self._source(surface, input_name):
                self._unsupported.add(f"texture of {input_name}")
        fields: dict[str, Any] = {}
        for input_name, surface_input in INPUTS.items():
            fields |= self._fields(surface, input_name, surface_input)
        opacity = (_value(surface, "opacity", 1) or [1.0])[0]
        if fields.get("cutoff", 0.0) > 0:
            fields["mode"] = "MASK"
        elif opacity < 1 or self._source(surface, "opacity") is not None:
            fields["mode"] = "BLEND"
        stated_fields = ["metallic", "roughness"]
        if "cutoff" in fields:
            stated_fields.append("cutoff")
        look = Appearance(name, **fields, opacity=opacity, stated={"": tuple(stated_fields)})
        words: Material = {}
        texture_words: Material = {}
        for word, value in in_gltf(look).items():
            if isinstance(value, Texture):
                texture_words |= value.in_words(word)
            elif isinstance(value, int | str):
                words[word] = value
            else:
                words[word] = as_text(value)
        return words | texture_words

    def _fields(self, surface: Any, name: str, surface_input: SurfaceInput) -> dict[str, Any]:
        """Return the fields of an appearance that an input of a surface sets."""
        kind, number_field, texture_field = surface_input
        is_color = kind == "Color3f"
        fields: dict[str, Any] = {}
        width, usual_space = 1, "raw"
        if is_color:
            width, usual_space = 3, "sRGB"
        value = _value(surface, name, width) or DEFAULTS.get(name)
        texture: Any = None
        if texture_field:
            texture = self._source(surface, name)
        if texture and texture_field:
            image_path = self._image_path(texture)
            if image_path is not None:
                number = self._images.setdefault(image_path, len(self._images))
                fields[texture_field] = self._texture(texture, number)
            color_space = texture.GetInput("sourceColorSpace")
            if color_space and color_space.Get() not in ("auto", usual_space):
                self._unsupported.add(f"sourceColorSpace of {TEXTURE}")
            value = (_value(texture, "scale", 4) or [1.0] * 4)[:3]
        if number_field and value:
            fields[number_field] = value[0]
            if is_color:
                fields[number_field] = tuple(value)
        return fields

    def _image_path(self, texture: Any) -> str | None:
        """Return the path of a texture's image from the folder of the stage, or inside its package."""
        image = _produced_value(texture, "file")
        if image is None or not image.path:
            return None
        folder = Path(self._path).resolve().parent
        # Images inside a package resolve to "scene.usdz[textures/a.png]".
        package, bracket, resolved_path = str(image.resolvedPath).rpartition("[")
        if not bracket:
            return os.path.relpath(resolved_path or folder / image.path, folder)
        path_inside = resolved_path.rstrip("]")
        if Path(package).resolve() != Path(self._path).resolve():
            self._packages[path_inside] = os.path.relpath(package, folder)
        return path_inside

    def _texture(self, texture: Any, image: int) -> Texture:
        """Return a texture with its wrapping beyond the image and the transform of its coordinates."""
        wrapping: list[str] = []
        for side in SIDES:
            side_input = texture.GetInput(side)
            way = "repeat"
            if side_input and side_input.Get() in WAYS:
                way = side_input.Get()
            wrapping.append(way)
        fields: dict[str, Any] = {"wrap": tuple(wrapping)}
        transform = self._source(texture, "st", TRANSFORM)
        if transform:
            for name, field in (("scale", "scale"), ("translation", "offset")):
                pair = _value(transform, name, 2)
                if pair:
                    fields[field] = tuple(pair)
            degrees = (_value(transform, "rotation", 1) or [0.0])[0]
            fields["rotation"] = math.radians(degrees)
        return Texture(image, **fields)

    def _source(self, shader: Any, name: str, kind: str = TEXTURE) -> Any:
        """Return the shader of a kind that an input is connected to, or None."""
        shader_input = shader.GetInput(name)
        if not shader_input or not shader_input.HasConnectedSource():
            return None
        attributes = shader_input.GetValueProducingAttributes()
        if not attributes:
            return None
        source = self._pxr.UsdShade.Shader(attributes[0].GetPrim())
        if source and source.GetIdAttr().Get() == kind:
            return source
        return None


def _produced_value(shader: Any, name: str) -> Any:
    """Return the value that an input has or is connected to, or None."""
    shader_input = shader.GetInput(name)
    if not shader_input:
        return None
    attributes = shader_input.GetValueProducingAttributes()
    if not attributes:
        return None
    return attributes[0].Get()


def _value(shader: Any, name: str, width: int) -> list[float] | None:
    """Return the finite numbers of an input, or None if it does not have as many."""
    value = _produced_value(shader, name)
    if value is None:
        return None
    numbers = np.array(value, np.float64).reshape(-1)
    if len(numbers) != width or not np.isfinite(numbers).all():
        return None
    return numbers.tolist()


def _read_entry(package: zipfile.ZipFile, name: str, most: int) -> bytes | str:
    """Return the bytes of a file in a package, or why there are none."""
    with suppress(KeyError, zipfile.BadZipFile, NotImplementedError, RuntimeError):
        entry = package.getinfo(name.removeprefix("./"))
        # USDZ demands entries that are not compressed, so that they can be mapped. Anything else may inflate without
        # bound.
        if entry.compress_type == zipfile.ZIP_STORED and entry.file_size <= most:
            return package.read(entry)
    return "it is not in the package"
