"""Materials of USD: preview surfaces with their factors and textures, in the words of glTF."""

from __future__ import annotations

import zipfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.metadata import (
    Material,
    Value,
    as_gltf,
    described,
    fetched,
    gltf_values,
    images_in,
    kind_of_image,
    materials_in,
)
from bsm.files.formats.written import face_numbers
from bsm.files.rows import Ints

_SURFACE, _TEXTURE, _READER = "UsdPreviewSurface", "UsdUVTexture", "UsdPrimvarReader_float2"
_SINGLE = {"metallic": "metallicFactor", "roughness": "roughnessFactor", "opacityThreshold": "alphaCutoff"}
_PAINTED = {
    "diffuseColor": "baseColorTexture",
    "emissiveColor": "emissiveTexture",
    "normal": "normalTexture",
    "occlusion": "occlusionTexture",
}
_COORDINATES = "st"
"""What texture coordinates are called."""


# ----------------------------------------------------------------------------------------------------------------- in


class Materials:
    """The materials of the meshes of a stage, met one after the other."""

    def __init__(self, pxr: Any, path: str) -> None:
        self._shade, self._geom, self._path = pxr.UsdShade, pxr.UsdGeom, path
        self._known: dict[tuple[tuple[str, str | int | float], ...], int] = {}
        self._images: dict[str, int] = {}

    def of_faces(self, prim: Any, faces: int, time: Any) -> Ints:
        """The number of each face's material; all faces of whose material nothing is said have one number."""
        numbers = np.full(faces, -1, np.int64)
        for subset in self._geom.Subset.GetAllGeomSubsets(self._geom.Imageable(prim)):
            if subset.GetElementTypeAttr().Get() == self._geom.Tokens.face and self._bound(subset.GetPrim()):
                places = np.array(subset.GetIndicesAttr().Get(time) or [], np.int64)
                numbers[places[(places >= 0) & (places < faces)]] = self._number(subset.GetPrim())
        if (numbers < 0).any():
            numbers[numbers < 0] = self._number(prim)
        return numbers

    def metadata(self, most: int) -> tuple[dict[str, Value], list[str]]:
        """What is said of all that were met, with images of at most so many bytes, and notes on those not there."""
        said = described({number: dict(words) for words, number in self._known.items()})
        names = {f"image.{number}.name": name for name, number in self._images.items()}
        if not zipfile.is_zipfile(self._path):
            return fetched({**said, **names}, Path(self._path).parent, most)
        packed: dict[str, Value] = {}
        with zipfile.ZipFile(self._path) as package, suppress(zipfile.BadZipFile, NotImplementedError, RuntimeError):
            for key, name in names.items():
                image = next((one for one in package.infolist() if one.filename == name.removeprefix("./")), None)
                if image is not None and image.compress_type == zipfile.ZIP_STORED and image.file_size <= most:
                    data = package.read(image)
                    packed |= {key.replace(".name", ".data"): data} if kind_of_image(data) else {}
        lacking = [name for key, name in names.items() if key.replace(".name", ".data") not in packed]
        notes = [f"the image {name} was left out, its name was kept: it is not in the package" for name in lacking]
        return {**said, **names, **packed}, notes

    def _bound(self, prim: Any) -> Any:
        return self._shade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]

    def _number(self, prim: Any) -> int:
        material = self._bound(prim)
        words = self._words(material) if material else {}
        return self._known.setdefault(tuple(words.items()), len(self._known))

    def _words(self, material: Any) -> Material:
        """A material in the words of glTF."""
        words: Material = {"name": str(material.GetPrim().GetName())}
        surface = material.ComputeSurfaceSource()[0]
        if not surface or surface.GetIdAttr().Get() != _SURFACE:
            return words
        color = self._value(surface, "diffuseColor", 3)
        opacity = self._value(surface, "opacity", 1) or [1.0]
        for name, painted in _PAINTED.items():
            texture = self._texture(surface, name)
            if texture is None:
                continue
            image = texture.GetInput("file").Get() if texture.GetInput("file") else None
            if image is not None and image.path:
                words[painted] = self._images.setdefault(str(image.path), len(self._images))
            if name == "diffuseColor":
                color = (self._value(texture, "scale", 4) or [1.0] * 4)[:3]
        if color is not None and [*color, *opacity] != [1.0] * 4:
            words["baseColorFactor"] = _text([*color, *opacity])
        if emitted := self._value(surface, "emissiveColor", 3):
            words |= {"emissiveFactor": _text(emitted)} if any(emitted) else {}
        for name, known in _SINGLE.items():
            if value := self._value(surface, name, 1):
                words[known] = _text(value)
        return words

    def _texture(self, shader: Any, name: str) -> Any:
        """The texture that an input takes its value from, if it takes it from one."""
        given = shader.GetInput(name)
        if not given or not given.HasConnectedSource():
            return None
        source = self._shade.Shader(given.GetConnectedSources()[0][0].source.GetPrim())
        return source if source and source.GetIdAttr().Get() == _TEXTURE else None

    @staticmethod
    def _value(shader: Any, name: str, width: int) -> list[float] | None:
        """The numbers of an input, if they are told there."""
        given = shader.GetInput(name)
        value = given.Get() if given else None
        numbers = np.array([] if value is None else value, np.float64).reshape(-1)
        return numbers.tolist() if len(numbers) == width and np.isfinite(numbers).all() else None


def _text(numbers: Iterable[float]) -> str:
    return " ".join(f"{number:.6g}" for number in numbers)


# ---------------------------------------------------------------------------------------------------------------- out


def write_materials(pxr: Any, mesh: Any, shown: TriangleMesh, folder: Path | None) -> tuple[dict[int, Any], set[str]]:
    """Write the materials of a mesh beneath it; returns them by their numbers, and the metadata that are said so."""
    stage, shade = mesh.GetPrim().GetStage(), pxr.UsdShade
    words, images = materials_in(shown.metadata), images_in(shown.metadata)
    files = {} if folder is None else dict(_written_images(images, folder))
    said = {f"image.{number}.{what}" for number in files for what in ("name", "data")}
    bound: dict[int, Any] = {}
    for number, known in words.items():
        name = pxr.Tf.MakeValidIdentifier(str(known.get("name") or f"material_{number}"))
        place = mesh.GetPath().AppendChild(name)
        place = mesh.GetPath().AppendChild(f"{name}_{number}") if stage.GetPrimAtPath(place) else place
        bound[number] = shade.Material.Define(stage, place)
        told = _Surface(pxr, bound[number], files).write(gltf_values(known))
        said |= {f"material.{number}.{one}" for one in known if one == "name" or set(as_gltf({one: known[one]})) & told}
        if {"Kd", "d"} & known.keys() and "baseColorFactor" in told:
            said |= {f"material.{number}.{one}" for one in ("Kd", "d")}
    bind_materials(pxr, mesh, shown, bound)
    return bound, said


def bind_materials(pxr: Any, mesh: Any, shown: TriangleMesh, bound: Mapping[int, Any], time: int | None = None) -> None:
    """Say which faces have which material, from a time on if one is given."""
    numbers = face_numbers(shown, "material")
    api = pxr.UsdShade.MaterialBindingAPI
    if numbers is None:
        if 0 in bound:
            api.Apply(mesh.GetPrim()).Bind(bound[0])
        return
    code = pxr.Usd.TimeCode.Default() if time is None else pxr.Usd.TimeCode(time)
    geom, family = pxr.UsdGeom, pxr.UsdShade.Tokens.materialBind
    geom.Subset.SetFamilyType(mesh, family, geom.Tokens.nonOverlapping)
    for number, material in bound.items():
        places = pxr.Vt.IntArray.FromNumpy(np.flatnonzero(numbers.values[:, 0] == number).astype(np.int32))
        subset = geom.Subset.Define(mesh.GetPrim().GetStage(), mesh.GetPath().AppendChild(f"faces_{number}"))
        subset.CreateElementTypeAttr(geom.Tokens.face)
        subset.CreateFamilyNameAttr(family)
        subset.CreateIndicesAttr().Set(places, code)
        api.Apply(subset.GetPrim()).Bind(material)


def _written_images(images: Mapping[int, tuple[str, bytes]], folder: Path) -> Iterator[tuple[int, str]]:
    """Write images that USD knows; their numbers and names."""
    for number, (_, data) in images.items():
        if (kind := kind_of_image(data)) in ("png", "jpg", "exr"):
            name = f"image_{number}.{kind}"
            (folder / name).write_bytes(data)
            yield number, name


class _Surface:
    """The preview surface of a material."""

    def __init__(self, pxr: Any, material: Any, images: Mapping[int, str]) -> None:
        self._pxr, self._types, self._images = pxr, pxr.Sdf.ValueTypeNames, images
        self._stage, self._path = material.GetPrim().GetStage(), material.GetPath()
        self._surface = self._shader("surface", _SURFACE)
        material.CreateSurfaceOutput().ConnectToSource(self._surface.ConnectableAPI(), "surface")

    def write(self, words: Mapping[str, Any]) -> set[str]:
        """Say what USD has an input for; returns which of the words of glTF these were."""
        types, said = self._types, {"name"}
        factor = words.get("baseColorFactor")
        for name, painted in _PAINTED.items():
            image = words.get(painted, -1)
            if image in self._images:
                kind = types.Float if name == "occlusion" else types.Normal3f if name == "normal" else types.Color3f
                scale = factor if name == "diffuseColor" else None
                self._paint(name, kind, self._images[image], scale)
                said.add(painted)
        if factor is not None:
            if "baseColorTexture" not in said:
                self._set("diffuseColor", types.Color3f, self._pxr.Gf.Vec3f(*factor[:3]))
            if factor[3] < 1.0:
                self._set("opacity", types.Float, factor[3])
            said.add("baseColorFactor")
        emitted = words.get("emissiveFactor")
        if emitted is not None and "emissiveTexture" not in said:
            self._set("emissiveColor", types.Color3f, self._pxr.Gf.Vec3f(*emitted))
            said.add("emissiveFactor")
        for name, known in _SINGLE.items():
            if known in words:
                self._set(name, types.Float, words[known])
                said.add(known)
        return said

    def _paint(self, name: str, kind: Any, file: str, scale: list[float] | None) -> None:
        """Connect an input with a texture."""
        types = self._types
        reader = self._shader("coordinates", _READER)
        reader.CreateInput("varname", types.String).Set(_COORDINATES)
        texture = self._shader(f"{name}_texture", _TEXTURE)
        texture.CreateInput("file", types.Asset).Set(self._pxr.Sdf.AssetPath(f"./{file}"))
        texture.CreateInput("st", types.Float2).ConnectToSource(reader.ConnectableAPI(), "result")
        for side in ("wrapS", "wrapT"):
            texture.CreateInput(side, types.Token).Set("repeat")
        if scale is not None:
            texture.CreateInput("scale", types.Float4).Set(self._pxr.Gf.Vec4f(*scale[:3], 1.0))
        if name == "normal":
            texture.CreateInput("scale", types.Float4).Set(self._pxr.Gf.Vec4f(2.0, 2.0, 2.0, 1.0))
            texture.CreateInput("bias", types.Float4).Set(self._pxr.Gf.Vec4f(-1.0, -1.0, -1.0, 0.0))
        if name in ("normal", "occlusion"):
            texture.CreateInput("sourceColorSpace", types.Token).Set("raw")
        self._surface.CreateInput(name, kind).ConnectToSource(
            texture.ConnectableAPI(), "r" if name == "occlusion" else "rgb"
        )

    def _set(self, name: str, kind: Any, value: Any) -> None:
        self._surface.CreateInput(name, kind).Set(value)

    def _shader(self, name: str, kind: str) -> Any:
        shader = self._pxr.UsdShade.Shader.Define(self._stage, self._path.AppendChild(name))
        shader.CreateIdAttr(kind)
        return shader
