"""USD, read and written with usd-core: points with time samples, their units and the axis that points up."""

from __future__ import annotations

import math
import os
import re
import shutil
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import cached_property, lru_cache
from itertools import chain
from pathlib import Path
from typing import Any, BinaryIO, TypeAlias

import numpy as np

from bsm.bitstream.errors import FormatError, LimitError, MeshError, imported
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import MOST_COMPONENTS, Attribute, Domain, Semantic
from bsm.codec.geometry.mesh import NoFacesError, TriangleMesh
from bsm.codec.sequence.runs import EMPTY, empty_frame, is_empty
from bsm.files import conventions, table
from bsm.files.formats import appearance as looks
from bsm.files.formats import metadata as formats
from bsm.files.formats import polygons as shapes
from bsm.files.formats.outside import layers_inside, refuse_clips_outside
from bsm.files.motion.frames import USUAL_RATE, Frames, Shared, Wanted, between, painted_like
from bsm.files.parsing import Doubles, Ints, as_format_error, as_library_error, require_counts, single_suffices
from bsm.files.unread import Said, Taken, rows_of
from bsm.ground.lengths import metres, unit_named, unit_of

_COORDINATES = "st"  # what texture coordinates are called
_SURFACE, _TEXTURE, _READER = "UsdPreviewSurface", "UsdUVTexture", "UsdPrimvarReader_float2"
_MOVE, _SIDES = "UsdTransform2d", ("wrapS", "wrapT")
_KINDS = {"diffuseColor": "Color3f", "emissiveColor": "Color3f", "normal": "Normal3f"}  # others are Float
_INPUTS: Mapping[str, tuple[Any, ...]] = {
    name: (_KINDS.get(name, "Float"), *map({f.endswith("_texture"): f for f in fields}.get, (False, True)))
    for name, fields in looks.fields_of("USD").items()
    if name not in ("prim", "opacity")
}
"""The kind of an input of a surface, and the fields of an appearance that are its number and its texture."""
_USUAL = {"diffuseColor": [0.18] * 3, "metallic": [0.0], "roughness": [0.5]}
_TAKEN = rows_of("usd")
_NO_TIME = float("nan")  # as usd-core has it
_MOST_SETS = 1 << 12  # of the faces of parts: each is a prim


# ----------------------------------------------------------------------------------------------------------------- in


class Materials:
    """The materials of the meshes of a stage, met one after the other."""

    def __init__(self, pxr: Any, path: str, stage: Any) -> None:
        self._pxr, self._shade, self._geom, self._path, self._stage = pxr, pxr.UsdShade, pxr.UsdGeom, path, stage
        # By what materials say and not by their paths: instances and copies of a prim name the same look under many
        # paths.
        self._known: dict[tuple[tuple[str, str | int | float], ...], int] = {}
        self._images: dict[str, int] = {}
        self._packages: dict[str, str] = {}  # that images are in, if not in the stage itself
        self._sets, self._unsaid = set[str](), set[str]()

    def of_faces(self, prim: Any, faces: int, time: Any) -> tuple[Ints, list[tuple[str, Ints]]]:
        """Return the number of each face's material, one for all without; and the sets of faces without a material."""
        numbers, sets = np.full(faces, -1, np.int64), list[tuple[str, Ints]]()
        given = self._geom.PrimvarsAPI(prim).FindPrimvarsWithInheritance()
        self._sets |= {*[str(p.GetPrimvarName()) for p in given if str(p.GetTypeName()).startswith("texCoord2")][:1]}
        double = bool(self._geom.Mesh(prim).GetDoubleSidedAttr().Get())
        for subset in self._geom.Subset.GetAllGeomSubsets(self._geom.Imageable(prim)):
            if subset.GetElementTypeAttr().Get() != self._geom.Tokens.face:
                continue
            places = np.array(subset.GetIndicesAttr().Get(time) or [], np.int64)
            places = places[(places >= 0) & (places < faces)]
            if self._bound(subset.GetPrim()):
                numbers[places] = self._number(subset.GetPrim(), double)
            else:
                sets.append((str(subset.GetPrim().GetDisplayName() or subset.GetPrim().GetName()), places))
        if (numbers < 0).any():
            numbers[numbers < 0] = self._number(prim, double)
        return numbers, sets

    def metadata(self, limits: Limits) -> tuple[dict[str, formats.Value], list[str], tuple[str, ...]]:
        """Return the metadata of all materials, with images of limited size, notes on missing images, and losses."""
        entries = formats.described({number: dict(words) for words, number in self._known.items()})
        names = {f"image.{number}.name": name for name, number in self._images.items()}
        if not zipfile.is_zipfile(self._path):
            beside = formats.Beside(Path(self._path).parent, limits)

            def read(name: str) -> bytes | str:
                if name not in self._packages:
                    return beside.read(name)
                found = beside.find(self._packages[name])
                if isinstance(found, str):
                    return found
                with as_library_error("zipfile"), zipfile.ZipFile(found) as package:
                    return _packed(package, name, limits.frame_bytes)

            return formats.fetched({**entries, **names}, read)
        with as_library_error("zipfile"), zipfile.ZipFile(self._path) as package:
            return formats.fetched({**entries, **names}, lambda name: _packed(package, name, limits.frame_bytes))

    @cached_property
    def left(self) -> list[str]:
        """The names of everything that the stage says and nothing takes, once all its materials are known."""
        own = " ".join((_TAKEN[_READER], *(f"varname={name}" for name in sorted(self._sets))))

        def said() -> Iterator[Said]:
            below = map(self._pxr.Usd.PrimRange, self._stage.GetPrototypes())
            for prim in chain(self._stage.Traverse(), *below):
                shader = prim.IsA(self._shade.Shader)
                kind = str(self._shade.Shader(prim).GetIdAttr().Get() if shader else prim.GetTypeName())
                if kind not in _TAKEN:
                    yield "", f"shader {kind}" if shader else f"{kind}, which is not a mesh", ""
                    continue
                # Without a scheme, the surface is that of Catmull and Clark.
                unauthored = ["subdivisionScheme"] if prim.IsA(self._geom.Mesh) else []
                own = dict.fromkeys((*prim.GetAuthoredPropertyNames(), *unauthored))
                for name in (*own, *["customData"] * prim.HasAuthoredCustomData()):
                    attr = prim.GetAttribute(name)
                    value = attr.Get() if attr and attr.GetTypeName().isScalar else ""
                    yield kind, name.removeprefix("inputs:") if shader else name, value

        return sorted(self._unsaid) + Taken({**_TAKEN, _READER: own}).left(said())

    def _bound(self, prim: Any) -> Any:
        return self._shade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]

    def _number(self, prim: Any, double: bool) -> int:
        material = self._bound(prim)
        words = (self._words(material) if material else {}) | ({"doubleSided": 1} if double else {})
        return self._known.setdefault(tuple(words.items()), len(self._known))

    def _words(self, material: Any) -> looks.Material:
        called = str(material.GetPrim().GetName())
        surface = material.ComputeSurfaceSource()[0]
        if not surface or surface.GetIdAttr().Get() != _SURFACE:
            return {"name": called}
        look: dict[str, Any] = {}
        self._unsaid |= {f"texture of {name}" for name in ("metallic", "roughness") if self._source(surface, name)}
        for name, (kind, number, painted) in _INPUTS.items():
            value = self._value(surface, name, 3 if kind == "Color3f" else 1) or _USUAL.get(name)
            if texture := self._source(surface, name) if painted else None:
                files = texture.GetInput("file").GetValueProducingAttributes() if texture.GetInput("file") else []
                image = files[0].Get() if files else None
                if image is not None and image.path:
                    # Images inside a package resolve to "scene.usdz[textures/a.png]".
                    outside, packed, inside = str(image.resolvedPath).rpartition("[")
                    folder = Path(self._path).resolve().parent
                    if packed and Path(outside).resolve() != Path(self._path).resolve():
                        self._packages[inside.rstrip("]")] = os.path.relpath(outside, folder)
                    path = inside.rstrip("]") if packed else os.path.relpath(inside or folder / image.path, folder)
                    look[painted] = self._placed(texture, self._images.setdefault(path, len(self._images)))
                space = texture.GetInput("sourceColorSpace")
                if space and space.Get() not in ("auto", "sRGB" if kind == "Color3f" else "raw"):
                    self._unsaid.add(f"sourceColorSpace of {_TEXTURE}")
                value = (self._value(texture, "scale", 4) or [1.0] * 4)[:3]
            if number and value:
                look[number] = tuple(value) if kind == "Color3f" else value[0]
        opacity, cut = (self._value(surface, "opacity", 1) or [1.0])[0], look.get("cutoff", 0.0)
        if cut > 0 or opacity < 1 or self._source(surface, "opacity") is not None:
            look["mode"] = "MASK" if cut > 0 else "BLEND"
        said = {"": ("metallic", "roughness", *(name for name in look if name == "cutoff"))}
        given = looks.in_gltf(looks.Appearance(called, **look, opacity=opacity, said=said))
        images = [word for word, value in given.items() if isinstance(value, looks.Texture)]
        plain = ((w, v if isinstance(v, int | str) else looks.as_text(v)) for w, v in given.items() if w not in images)
        return dict(plain) | {key: entry for word in images for key, entry in given[word].in_words(word).items()}

    def _placed(self, texture: Any, image: int) -> looks.Texture:
        """A texture with the way in which it goes on beyond its image, and the transform of its coordinates."""
        ways = [given.Get() if (given := texture.GetInput(side)) else "" for side in _SIDES]
        about: dict[str, Any] = {"wrap": tuple(way if way in looks.WAYS else "repeat" for way in ways)}
        if move := self._source(texture, "st", _MOVE):
            given = {name: self._value(move, name, 2) for name in ("scale", "translation")}
            about |= {{"translation": "offset"}.get(name, name): tuple(pair) for name, pair in given.items() if pair}
            about["rotation"] = math.radians((self._value(move, "rotation", 1) or [0.0])[0])
        return looks.Texture(image, **about)

    def _source(self, shader: Any, name: str, kind: str = _TEXTURE) -> Any:
        """The shader of a kind that an input takes its value from, if it takes it from one."""
        given = shader.GetInput(name)
        if not given or not given.HasConnectedSource() or not (sources := given.GetValueProducingAttributes()):
            return None
        source = self._shade.Shader(sources[0].GetPrim())
        return source if source and source.GetIdAttr().Get() == kind else None

    @staticmethod
    def _value(shader: Any, name: str, width: int) -> list[float] | None:
        given = shader.GetInput(name)
        sources = given.GetValueProducingAttributes() if given else []
        value = sources[0].Get() if sources else None
        numbers = np.array([] if value is None else value, np.float64).reshape(-1)
        return numbers.tolist() if len(numbers) == width and np.isfinite(numbers).all() else None


def _packed(package: zipfile.ZipFile, name: str, most: int) -> bytes | str:
    """The bytes of a file in a package, or why there are none."""
    with suppress(KeyError, zipfile.BadZipFile, NotImplementedError, RuntimeError):
        entry = package.getinfo(name.removeprefix("./"))
        # USDZ demands entries that are not compressed, so that they can be mapped. Anything else may inflate without
        # bound.
        if entry.compress_type == zipfile.ZIP_STORED and entry.file_size <= most:
            return package.read(entry)
    return "it is not in the package"


# ---------------------------------------------------------------------------------------------------------------- out


def write_materials(pxr: Any, mesh: Any, shown: TriangleMesh, folder: Path | None) -> tuple[dict[int, Any], set[str]]:
    """Write the materials of a mesh beneath it; return them by their numbers, and the metadata that they express."""
    stage, shade = mesh.GetPrim().GetStage(), pxr.UsdShade
    words, images = formats.materials_in(shown.metadata), formats.images_in(shown.metadata)
    files: dict[int, str] = {}
    for number, (_, data) in images.items() if folder else ():
        if (kind := formats.kind_of_image(data)) in ("png", "jpg", "exr"):  # those that USD knows
            files[number] = f"image_{number}.{kind}"
            Path(str(folder), files[number]).write_bytes(data)
    written = {f"image.{number}.{what}" for number in files for what in ("name", "data")}
    bound: dict[int, Any] = {}
    # USD says it of a mesh and not of a material, so one single-sided material keeps it from being said.
    if words and all(known.get("doubleSided") for known in words.values()):
        mesh.CreateDoubleSidedAttr(True)
        written |= {f"material.{number}.doubleSided" for number in words}
    for number, known in words.items():
        name = pxr.Tf.MakeValidIdentifier(str(known.get("name") or f"material_{number}"))
        place = mesh.GetPath().AppendChild(name)
        place = mesh.GetPath().AppendChild(f"{name}_{number}") if stage.GetPrimAtPath(place) else place
        bound[number] = shade.Material.Define(stage, place)
        held = _write_surface(pxr, bound[number], looks.within(looks.appearance(known))[0], files)
        written |= {f"material.{number}.{word}" for word in known.keys() - {*looks.lost(known, held)}}
    bind_materials(pxr, mesh, shown, bound)
    return bound, written


def bind_materials(pxr: Any, mesh: Any, shown: TriangleMesh, bound: Mapping[int, Any], time: float = _NO_TIME) -> None:
    """Say which faces have which material, from a time on if one is given."""
    numbers = formats.face_numbers(shown, "material")
    api = pxr.UsdShade.MaterialBindingAPI
    if numbers is None:
        if 0 in bound:
            api.Apply(mesh.GetPrim()).Bind(bound[0])
        return
    for number, material in bound.items():
        subset = _subset(pxr, mesh, f"faces_{number}", pxr.UsdShade.Tokens.materialBind, numbers, number, time)
        api.Apply(subset.GetPrim()).Bind(material)


def name_parts(pxr: Any, mesh: Any, shown: TriangleMesh, time: float = _NO_TIME) -> Attribute | None:
    """Write a set of faces for each part, under its name; return the attribute that says which face has which."""
    numbers, names = formats.face_numbers(shown, "part"), formats.names_in(shown.metadata, "part")
    if numbers is None or len(names) > _MOST_SETS or not {*np.unique(numbers.values).tolist()} <= {*names}:
        return None
    for number, name in names.items():
        _subset(pxr, mesh, f"part_{number}", "part", numbers, number, time).GetPrim().SetDisplayName(name)
    return numbers


def _subset(pxr: Any, mesh: Any, name: str, family: str, numbers: Attribute, number: int, time: float) -> Any:
    """Write the faces that have a number, from a time on if one is given."""
    geom = pxr.UsdGeom
    geom.Subset.SetFamilyType(mesh, family, geom.Tokens.nonOverlapping)
    subset = geom.Subset.Define(mesh.GetPrim().GetStage(), mesh.GetPath().AppendChild(name))
    subset.CreateElementTypeAttr(geom.Tokens.face)
    subset.CreateFamilyNameAttr(family)
    subset.CreateIndicesAttr().Set(np.flatnonzero(numbers.values[:, 0] == number), time)
    return subset


def _write_surface(pxr: Any, material: Any, look: looks.Appearance, images: Mapping[int, str]) -> set[str]:
    """Write the fields of an appearance for which USD has an input, and return these."""
    types, stage, held = pxr.Sdf.ValueTypeNames, material.GetPrim().GetStage(), looks.held_by("USD")

    def shader(name: str, kind: str) -> Any:
        made = pxr.UsdShade.Shader.Define(stage, material.GetPath().AppendChild(name))
        made.CreateIdAttr(kind)
        return made

    surface = shader("surface", _SURFACE)
    material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    if look.opacity < 1.0 and look.mode != "OPAQUE":
        surface.CreateInput("opacity", types.Float).Set(look.opacity)
    needed = {*_USUAL, *(["opacityThreshold"] if look.mode == "MASK" else [])}  # which are others where nothing is said
    for name, (kind, number, painted) in _INPUTS.items():
        shown = getattr(look, painted) if painted else None
        value, image = getattr(look, number) if number else None, images.get(shown.image) if shown else None
        if image is None or shown is None:
            held.discard(painted)
            if number and (name in needed or look.says(number)):
                value = pxr.Gf.Vec3f(*value) if isinstance(value, tuple) else value
                surface.CreateInput(name, getattr(types, kind)).Set(value)
            continue
        reader = shader("coordinates", _READER)
        reader.CreateInput("varname", types.String).Set(_COORDINATES)
        texture = shader(f"{name}_texture", _TEXTURE)
        texture.CreateInput("file", types.Asset).Set(pxr.Sdf.AssetPath(f"./{image}"))
        if (shown.scale, shown.offset, shown.rotation) != ((1.0, 1.0), (0.0, 0.0), 0.0):
            # Beside each texture: two textures of a material may have transforms of their own.
            reader, placed = shader(f"{name}_transform", _MOVE), reader
            reader.CreateInput("in", types.Float2).ConnectToSource(placed.ConnectableAPI(), "result")
            reader.CreateInput("scale", types.Float2).Set(pxr.Gf.Vec2f(*shown.scale))
            reader.CreateInput("rotation", types.Float).Set(math.degrees(shown.rotation))
            reader.CreateInput("translation", types.Float2).Set(pxr.Gf.Vec2f(*shown.offset))
        texture.CreateInput("st", types.Float2).ConnectToSource(reader.ConnectableAPI(), "result")
        for side, way in zip(_SIDES, shown.wrap):
            texture.CreateInput(side, types.Token).Set(way)
        opacity = look.opacity if name == "diffuseColor" and look.mode != "OPAQUE" else 1.0
        if isinstance(value, tuple) and (*value, opacity) != (1.0,) * 4:
            texture.CreateInput("scale", types.Float4).Set(pxr.Gf.Vec4f(*value, opacity))
        # A normal map holds shares from 0 to 1 of what runs from -1 to 1. UsdPreviewSurface does not unfold them by
        # itself.
        if name == "normal":
            texture.CreateInput("scale", types.Float4).Set(pxr.Gf.Vec4f(2.0, 2.0, 2.0, 1.0))
            texture.CreateInput("bias", types.Float4).Set(pxr.Gf.Vec4f(-1.0, -1.0, -1.0, 0.0))
        if name in ("normal", "occlusion"):
            texture.CreateInput("sourceColorSpace", types.Token).Set("raw")
        made = surface.CreateInput(name, getattr(types, kind))
        made.ConnectToSource(texture.ConnectableAPI(), "r" if kind == "Float" else "rgb")
        if name == "diffuseColor" and look.mode != "OPAQUE":
            surface.CreateInput("opacity", types.Float).ConnectToSource(texture.ConnectableAPI(), "a")
    return held


MOST_PRIMS, MOST_NAMED = 1 << 16, 12


def import_usd() -> Any:
    """The modules of usd-core; `DependencyError` where they are missing."""
    for name in ("Ar", "Gf", "Sdf", "Tf", "Usd", "UsdGeom", "UsdShade", "UsdSkel", "UsdUtils", "Vt"):
        # One by one: `import pxr` alone loads none of them.
        imported(f"pxr.{name}", "USD files are read and written with usd-core", "usd")
    return sys.modules["pxr"]


# ----------------------------------------------------------------------------------------------------------------- in


class _Shape:
    """The faces and primvars of a mesh of a stage; only their sizes until they are used.

    Instances share them where their primvars come from the same prims.
    """

    def __init__(self, pxr: Any, prim: Any, time: Any, instance: _Instance | None) -> None:
        mesh = pxr.UsdGeom.Mesh(prim)
        self._pxr, self.prim, self.time, self.points = pxr, prim, time, mesh.GetPointsAttr()
        self.counts_attr, self.corners_attr = mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()
        tables = (self.points, self.counts_attr, self.corners_attr)
        self.vertices, faces, corners = (len(attr.Get(time) or []) for attr in tables)
        # A polygon of k corners has k - 2 triangles. Known before any table is copied, so that limits can refuse.
        self.triangles = corners - 2 * faces
        self.left_handed = mesh.GetOrientationAttr().Get() == pxr.UsdGeom.Tokens.leftHanded
        self.rows: dict[Domain, int] = {"vertex": self.vertices, "face": faces, "corner": corners}
        self._primvars, self._of_instance = _primvars_at(pxr, prim), list[Any]()
        if instance is not None:
            instancer, self._instance = instance[:2]
            self._instances = instancer.count(time)
            own = {primvar.GetPrimvarName() for primvar in self._primvars}
            self._of_instance = [p for p in instancer.primvars if p.GetPrimvarName() not in own]
        every = (*self._primvars, *self._of_instance)
        moving = [primvar for primvar in every if primvar.ValueMightBeTimeVarying()]
        self.left_out = [f"how {p.GetPrimvarName()} changes" for p in moving if p.GetAttr() not in self.painted]

    @cached_property
    def counts(self) -> Ints:
        counts, corners = np.array(self.counts_attr.Get(self.time) or [], np.int64), self.rows["corner"]
        if (counts < 0).any() or counts.sum() != corners:
            raise FormatError(f"the faces of {self.prim.GetPath()} have {corners} corners, not {counts.sum()}")
        return counts

    @cached_property
    def corners(self) -> Ints:
        return np.array(self.corners_attr.Get(self.time) or [], np.int64)

    @cached_property
    def columns(self) -> list[shapes.Column]:
        """The primvars that a mesh has; a displayOpacity is the fourth number of the displayColor."""
        found = {column.name: column for column in self._columns()}
        color, opacity = (found.get(name) for name in _SHADES.values())
        if color is not None and opacity is not None and color.domain == opacity.domain and color.semantic == "color":
            rows = [c.values if c.indices is None else c.values[c.indices] for c in (color, opacity)]
            shades = np.hstack([conventions.shares_of(rows[0][:, :3]), rows[1]])
            indices = None if color.indices is None else np.arange(len(shades))
            shades = conventions.srgb_colors(conventions.to_linear(shades))
            found[color.name] = replace(color, values=shades, indices=indices)
            del found[opacity.name]
        return [*found.values()]

    @property
    def painted(self) -> list[Any]:
        """The primvars of vertices that change."""
        at_vertices = (p for p in self._primvars if _DOMAINS.get(p.GetInterpolation()) == "vertex")
        moving = (p.GetAttr() for p in at_vertices if not str(p.GetTypeName()).startswith("texCoord"))
        return [attr for attr in moving if attr.GetNumTimeSamples() > 1]

    @cached_property
    def holes(self) -> Ints:
        """The faces that are holes."""
        found = np.array(self._pxr.UsdGeom.Mesh(self.prim).GetHoleIndicesAttr().Get(self.time) or [], np.int64)
        return found[(found >= 0) & (found < self.rows["face"])]

    def _columns(self) -> Iterator[shapes.Column]:
        yield from self._instance_columns()
        for primvar in self._primvars:
            name, kind = str(primvar.GetPrimvarName()), str(primvar.GetTypeName())
            domain = _DOMAINS.get(primvar.GetInterpolation())
            value = primvar.Get(self.time)
            if value is None:
                continue
            self.left_out.append(name)
            values = np.array(value)
            # One color for a whole mesh would be lost where parts are joined, so its vertices have it.
            if primvar.GetInterpolation() == "constant" and name in _SHADES and len(values) == 1:
                domain, values = "vertex", np.repeat(values, self.vertices, axis=0)
            if domain is None or not kind.endswith("[]") or name == "normals":
                continue
            values = values[:, None] if values.ndim == 1 else values
            if values.dtype.kind not in "iuf" or values.ndim != 2 or values.shape[1] > MOST_COMPONENTS:
                continue
            places = np.array(primvar.GetIndices(self.time) or np.arange(len(values)), np.int64)
            if len(places) == self.rows[domain] and 0 <= places.min(initial=0) <= places.max(initial=0) < len(values):
                self.left_out.remove(name)
                named_as, values, semantic = _meant(name, kind, values)
                at_corners = domain == "corner"
                table = values if at_corners else values[places]
                yield shapes.Column(named_as, table, domain, semantic, places if at_corners else None)

    def _instance_columns(self) -> Iterator[shapes.Column]:
        """The values that an instancer has for this instance, at all of its vertices or faces."""
        for primvar in self._of_instance:
            name, kind = str(primvar.GetPrimvarName()), str(primvar.GetTypeName())
            value = primvar.ComputeFlattened(self.time)
            values = np.array([] if value is None else value)
            if values.ndim and len(values) == self._instances:
                values = values[self._instance : self._instance + 1]
            values = values.reshape(1, -1)
            if not kind.endswith("[]") or values.dtype.kind not in "iuf" or not 1 <= values.size <= MOST_COMPONENTS:
                self.left_out.append(name)
                continue
            domain: Domain = "vertex" if name in _SHADES else "face"
            called, values, semantic = _meant(name, kind, values)
            yield shapes.Column(called, np.repeat(values, self.rows[domain], axis=0), domain, semantic)


def _primvars_at(pxr: Any, prim: Any) -> list[Any]:
    given = pxr.UsdGeom.PrimvarsAPI(prim).FindPrimvarsWithInheritance()
    return [primvar for primvar in given if primvar.HasAuthoredValue()]


def _sources_of(pxr: Any, prim: Any) -> tuple[str, ...]:
    """The paths of a mesh and of its primvars, with those of prototypes in place of their instances."""
    attrs = [primvar.GetAttr() for primvar in _primvars_at(pxr, prim)]
    owners = [prim, *(attr.GetPrim() for attr in attrs)]
    shared = (owner.GetPrimInPrototype() if owner.IsInstanceProxy() else owner for owner in owners)
    return tuple(str(owner.GetPath()) for owner in shared)


class _Instancer:
    """The instances of a point instancer, which are placed at any time."""

    def __init__(self, pxr: Any, prim: Any) -> None:
        self._pxr, self.prim = pxr, prim
        self._instancer = pxr.UsdGeom.PointInstancer(prim)
        self._placed: tuple[float, Doubles] = (np.nan, np.empty((0, 4, 4)))
        self._roots = [prim.GetStage().GetPrimAtPath(path) for path in self._instancer.GetPrototypesRel().GetTargets()]
        below = [list(pxr.Usd.PrimRange.AllPrims(root)) if root else [] for root in self._roots]
        self._meshes = [[one for one in prims if one.IsA(pxr.UsdGeom.Mesh)] for prims in below]
        self.primvars = _primvars_at(pxr, prim)
        inner = (one for prims in below for one in prims if one.IsA(pxr.UsdGeom.PointInstancer))
        self.inner = [str(one.GetPath()) for one in inner]

    def count(self, time: Any) -> int:
        return len(self._instancer.GetProtoIndicesAttr().Get(time) or [])

    @lru_cache(2)  # noqa: B019
    def shown(self, time: float) -> frozenset[tuple[int, int]]:
        """The instances that are there at a time, and their prototypes."""
        code = self._pxr.Usd.TimeCode(time)
        kinds = np.array(self._instancer.GetProtoIndicesAttr().Get(code) or [], np.int64)
        mask = self._instancer.ComputeMaskAtTime(code)
        numbers = np.flatnonzero(np.array(mask, np.bool_)) if mask else np.arange(len(kinds))
        return frozenset(zip(numbers.tolist(), kinds[numbers].tolist(), strict=True))

    def instances(self, times: Iterable[float]) -> Iterator[tuple[Any, _Instance]]:
        """The meshes of each instance that is there at one of the times, and which one that is."""
        for number, kind in sorted({one for time in times for one in self.shown(time)}):
            if not 0 <= kind < len(self._roots):
                raise FormatError(f"{self.prim.GetPath()} names prototype {kind} of {len(self._roots)}")
            for mesh in self._meshes[kind]:
                yield mesh, (self, number, self._roots[kind], kind)

    @property
    def changes(self) -> list[float]:
        """The times at which instances may appear, vanish or become others."""
        every = (self._instancer.GetProtoIndicesAttr(), self._instancer.GetInvisibleIdsAttr())
        return [time for attr in every if attr.GetNumTimeSamples() > 1 for time in attr.GetTimeSamples()]

    @property
    def times(self) -> list[float]:
        every = (self._instancer.GetPositionsAttr(), self._instancer.GetOrientationsAttr())
        moves = [time for attr in (*every, self._instancer.GetScalesAttr()) for time in attr.GetTimeSamples()]
        return moves + self.changes

    def place(self, number: int, time: Any, cache: Any) -> Doubles:
        """Return the matrix that places an instance, with its prototype's transform, in the world."""
        # usd-core computes all instances at once; asking for each would take the square of their number.
        if self._placed[0] != time.GetValue():
            every = self._pxr.UsdGeom.PointInstancer.IgnoreMask
            moved = self._pxr.UsdGeom.PointInstancer.IncludeProtoXform
            found = self._instancer.ComputeInstanceTransformsAtTime(time, time, moved, every)
            self._placed = time.GetValue(), np.array(found, np.float64).reshape(-1, 4, 4)
        if number >= len(self._placed[1]):
            raise MeshError(
                f"{self.prim.GetPath()} has {len(self._placed[1])} instances at {time}, and more before: --runs"
            )
        world: Doubles = np.array(cache.GetLocalToWorldTransform(self.prim), np.float64)
        placed: Doubles = self._placed[1][number] @ world
        return placed


_Instance: TypeAlias = tuple[_Instancer, int, Any, int]
"""An instance by its number, the root of its prototype, and the number of that."""


class _Part:
    """A mesh of a stage at its place: its faces once, its points at any time."""

    def __init__(self, shape: _Shape, prim: Any, instance: _Instance | None = None) -> None:
        self.shape, self.prim, self.instance = shape, prim, instance
        self.name = str(prim.GetPath()) if instance is None else f"{instance[0].prim.GetPath()}[{instance[1]}]"

    def times(self, geom: Any) -> list[float]:
        found = [time for attr in (self.shape.points, *self.shape.painted) for time in attr.GetTimeSamples()]
        found += self.instance[0].times if self.instance else []
        for prim in (self.prim, self.instance[0].prim) if self.instance else (self.prim,):
            found += _times_of_visibility(geom, prim)
            for one in filter(geom.Xformable, _with_those_above(prim)):
                found += geom.Xformable(one).GetTimeSamples()
        return found

    def matrix(self, time: Any, cache: Any) -> Doubles:
        """Return the matrix that places the points in the world, from the right."""
        found: Doubles = np.array(cache.GetLocalToWorldTransform(self.prim), np.float64)
        if self.instance is None:
            return found
        instancer, number, root, _ = self.instance
        base = np.array(cache.GetLocalToWorldTransform(root), np.float64)
        # The prototype may lie anywhere in the stage: its own place is taken out first. A pseudo-inverse, as a
        # prototype may be scaled to 0.
        return found @ np.linalg.pinv(base) @ instancer.place(number, time, cache)

    def at(self, time: Any, cache: Any) -> Doubles:
        shape, when = self.shape, f"at time {time.GetValue():g}"
        points = np.array(shape.points.Get(time) or (), np.float64).reshape(-1, 3)
        arrays = (("counts", shape.counts_attr, shape.counts), ("corners", shape.corners_attr, shape.corners))
        for name, attr, known in arrays:
            if attr.GetNumTimeSamples() > 1 and not np.array_equal(np.array(attr.Get(time), np.int64), known):
                raise MeshError(f"the faces of {self.name} change {when} (their {name}); if they may, --runs")
        if len(points) != shape.vertices:
            raise MeshError(f"{self.name} has {len(points)} points {when} and {shape.vertices} before")
        matrix = self.matrix(time, cache)
        with np.errstate(over="ignore", invalid="ignore"):  # a later check refuses infinite values
            return points @ matrix[:3, :3] + matrix[3, :3]


_SHADES = {"displayColor": "color", "displayOpacity": "displayOpacity"}
_DOMAINS: dict[str, Domain] = {"vertex": "vertex", "varying": "vertex", "uniform": "face", "faceVarying": "corner"}


def _meant(name: str, kind: str, values: shapes.Array) -> tuple[str, shapes.Array, Semantic]:
    """The name of a primvar as an attribute, its values, and their meaning."""
    if kind.startswith(("color3", "color4")):
        name = _SHADES.get(name, name)
        in_range = values.size and 0 <= values.min() <= values.max() <= 1
        return (name, conventions.srgb_colors(values), "color") if in_range else (name, values, "generic")
    if kind.startswith("texCoord2") or (name in ("st", "uv", "UVMap") and values.shape[1] == 2):
        return "texcoord" if name in ("st", "UVMap") else name, values, "texcoord"
    return name, values, "generic"


def _with_those_above(prim: Any) -> Iterator[Any]:
    while prim and not prim.IsPseudoRoot():
        yield prim
        prim = prim.GetParent()


def _times_of_visibility(geom: Any, prim: Any) -> list[float]:
    """The times at which a prim may appear or vanish."""
    attrs = (geom.Imageable(one).GetVisibilityAttr() for one in _with_those_above(prim))
    return [time for attr in attrs if attr and attr.ValueMightBeTimeVarying() for time in attr.GetTimeSamples()]


@contextmanager
def _quiet(pxr: Any) -> Iterator[None]:
    """Keep usd-core from writing what notes say, where it can be told to."""
    if not hasattr(pxr.Tf, "DiagnosticTrap"):
        yield
        return
    with pxr.Tf.DiagnosticTrap() as trap:
        yield
        trap.Clear()


class _Stage:
    def __init__(self, path: str, limits: Limits, *, runs: bool = False) -> None:
        self._limits, self._size, self._runs = limits, os.path.getsize(path), runs
        self.pxr = pxr = import_usd()
        with as_library_error("usd-core"), _quiet(pxr):
            try:
                self._layers = layers_inside(pxr, path)  # kept, so that the stage does not read them again
                self.stage = pxr.Usd.Stage.Open(path)
                refuse_clips_outside(pxr, self.stage, path)
            except pxr.Tf.ErrorException as error:  # which names its own source before the place in the file
                said = re.findall(r" : '(.*?)'(?=\s*(?:Error in|$))", " ".join(str(error).split()))
                raise FormatError(f"usd-core cannot read this file: {' '.join(said)[:300]}") from error
        if not all(layer.timeCodesPerSecond > 0 for layer in self.stage.GetUsedLayers()):  # usd-core would not end
            raise FormatError("timeCodesPerSecond of this stage, or of a layer of it, is not above 0")
        if any(prim.IsA(pxr.UsdSkel.Root) for prim in self.stage.Traverse()):
            # Skeletons move the points, in a layer that is not saved.
            self.stage.SetEditTarget(self.stage.GetSessionLayer())
            pxr.UsdSkel.BakeSkinning(self.stage.Traverse())
        self.span: tuple[float, ...] = ()  # codes that the stage says it shows
        if self.stage.HasAuthoredTimeCodeRange() and self.stage.GetStartTimeCode() <= self.stage.GetEndTimeCode():
            self.span = float(self.stage.GetStartTimeCode()), float(self.stage.GetEndTimeCode())
        self.first = pxr.Usd.TimeCode(self.span[0]) if self.span else pxr.Usd.TimeCode.EarliestTime()
        self._materials = Materials(pxr, path, self.stage)
        lost = [" ".join(str(error).split()) for error in self.stage.GetCompositionErrors()]
        self.notes: list[str] = [f"left out, a layer or reference: {text[:200]}" for text in lost[:MOST_NAMED]]
        with _quiet(pxr):
            self.parts = list(self._parts())
        if not self.parts:
            raise FormatError("this stage has no meshes" + "".join(f"; {note}" for note in self.notes))

    def _parts(self) -> Iterator[_Part]:
        """Yield the visible meshes, once for each instance."""
        known: dict[tuple[Any, ...], _Shape] = {}
        for prim, instance in self._placed():
            # An instance has primvars of its own, and those of the prims above it.
            own = (str(instance[0].prim.GetPath()), instance[1]) if instance and instance[0].primvars else ()
            key = *_sources_of(self.pxr, prim), own
            if key not in known:
                known[key] = _Shape(self.pxr, prim, self.first, instance)
            shape = known[key]
            if shape.rows["face"] or shape.rows["corner"]:
                yield _Part(shape, prim, instance)

    def _placed(self) -> Iterator[tuple[Any, _Instance | None]]:
        """Yield the visible meshes, and the instances of instancers."""
        pxr, left = self.pxr, dict[str, list[str]]()
        self.blinking: list[str] = []
        # The usual traversal stops at instances, whose meshes would then be missing.
        every = iter(pxr.Usd.PrimRange.Stage(self.stage, pxr.Usd.TraverseInstanceProxies()))
        for count, prim in enumerate(every):
            if count == MOST_PRIMS:
                raise LimitError(f"the stage and its instances have over {MOST_PRIMS:,} prims; export a part of it")
            variants = prim.GetVariantSets()
            for name in variants.GetNames():
                chosen = variants.GetVariantSelection(name)
                others = sorted({*variants.GetVariantSet(name).GetVariantNames()} - {chosen})
                left.setdefault("variants that are not chosen", []).extend(f"{name}={other}" for other in others)
            if hidden := self._hidden(prim):
                left.setdefault(hidden, []).append(str(prim.GetPath()))
            elif prim.IsA(pxr.UsdGeom.PointInstancer):
                every.PruneChildren()
                instancer, first = _Instancer(pxr, prim), self.first.GetValue()
                if instancer.inner:
                    left.setdefault("instancers in prototypes", []).extend(instancer.inner)
                if changing := any(instancer.shown(time) != instancer.shown(first) for time in instancer.changes):
                    self.blinking += [str(prim.GetPath())] if self._runs else []
                    why = "instances that appear, vanish or become others later (--runs)"
                    left.setdefault(why, []).extend([] if self._runs else [str(prim.GetPath())])
                yield from instancer.instances([first, *(instancer.changes if changing and self._runs else ())])
            elif prim.IsA(pxr.UsdGeom.Mesh):
                yield prim, None
        if self.blinking and not self._runs:
            names = ", ".join(self.blinking[:MOST_NAMED])
            self.notes.append(f"these vanish, and are always shown; --runs lets them: {names}")
        self.notes += [f"left out, {why}: {', '.join(paths[:MOST_NAMED])}" for why, paths in left.items() if paths]

    def _hidden(self, prim: Any) -> str:
        """Why a mesh or an instancer is not seen; nothing if it is."""
        geom = self.pxr.UsdGeom
        if not (prim.IsA(geom.Mesh) or prim.IsA(geom.PointInstancer)):
            return ""
        purpose = geom.Imageable(prim).ComputePurpose()
        if purpose == geom.Tokens.guide or (purpose == geom.Tokens.proxy and self._rendered):
            return "guides" if purpose == geom.Tokens.guide else "stand-ins (purpose proxy)"
        times = _times_of_visibility(geom, prim)
        shown = any(self.seen(prim, time) for time in (times if self._runs else ()) or [self.first.GetValue()])
        if times and shown:
            self.blinking.append(str(prim.GetPath()))
        return "" if shown else "hidden" if not times or self._runs else "they appear later (--runs)"

    @cached_property
    def _rendered(self) -> bool:
        """Whether some mesh is for pictures only, so that others stand in for it elsewhere."""
        geom = self.pxr.UsdGeom
        every = (geom.Imageable(prim) for prim in self.stage.Traverse() if prim.IsA(geom.Mesh))
        return any(one.ComputePurpose() == geom.Tokens.render for one in every)

    def seen(self, prim: Any, time: float) -> bool:
        """Return whether a prim is visible at a time."""
        geom, code = self.pxr.UsdGeom, self.pxr.Usd.TimeCode(time)
        return bool(geom.Imageable(prim).ComputeVisibility(code) != geom.Tokens.invisible)

    def _seen_there(self, part: _Part, time: float) -> bool:
        """Return whether a part is visible at a time, of an instancer with this instance."""
        if part.instance is None:
            return self.seen(part.prim, time)
        instancer, number, _, kind = part.instance
        return self.seen(instancer.prim, time) and (number, kind) in instancer.shown(time)

    @property
    def times(self) -> list[float]:
        return sorted({time for part in self.parts for time in part.times(self.pxr.UsdGeom)})

    @as_format_error("stage")
    def at(self, time: float) -> Doubles:
        code = self.pxr.Usd.TimeCode(time)
        cache = self.pxr.UsdGeom.XformCache(code)
        return np.concatenate([part.at(code, cache) for part in self.parts])

    @as_format_error("stage")
    def renewed(self, time: float) -> TriangleMesh:
        """The mesh at a time, with the faces and primvars that it has then."""
        code = self.pxr.Usd.TimeCode(time)
        self.parts = [
            _Part(_Shape(self.pxr, part.prim, code, part.instance), part.prim, part.instance) for part in self.parts
        ]
        return self.frame(time).mesh

    def frame(self, time: float) -> shapes.MeshFile:
        """The mesh at a time; where frames may be without faces, an empty one if none are there."""
        try:
            return self.mesh(time)
        except NoFacesError:
            if not self._runs:
                raise
            return shapes.MeshFile(empty_frame())

    @property
    def changes(self) -> bool:
        attrs = (attr for part in self.parts for attr in (part.shape.counts_attr, part.shape.corners_attr))
        return bool(self.blinking) or any(attr.GetNumTimeSamples() > 1 for attr in attrs)

    def mesh(self, time: float) -> shapes.MeshFile:
        """The mesh at a time, with everything; polygons are cut into triangles."""
        geom, code, materials = self.pxr.UsdGeom, self.pxr.Usd.TimeCode(time), self._materials
        cache = geom.XformCache(code)
        parts = self.parts
        if self._runs and self.blinking:
            parts = [part for part in parts if self._seen_there(part, time)]
            if not parts:
                raise NoFacesError(f"nothing is visible at time {time:g}")

        named, unnamed = dict[str, str](), dict[str, Ints]()

        def made(part: Any) -> shapes.Part:
            shape = part.shape
            # A mirror swaps inside and outside, as the left-handed orientation does; both together swap nothing.
            mirrored = np.linalg.det(part.matrix(code, cache)[:3, :3]) < 0.0
            order = shapes.turned_corners(shape.counts, np.full(len(shape.counts), shape.left_handed != mirrored))
            columns = [c if c.indices is None else replace(c, indices=c.indices[order]) for c in shape.columns]
            numbers, sets = materials.of_faces(part.prim, len(shape.counts), shape.time)
            inside = np.concatenate([np.empty(0, np.int64), *(places for _, places in sets)])
            if len(self.parts) > 1 or len(np.unique(inside)) < len(inside):
                unnamed.update(dict(sets))
            elif sets:
                owner = np.full(len(numbers), len(sets), np.int32)
                owner[inside] = np.repeat(np.arange(len(sets)), [len(places) for _, places in sets])
                columns.append(shapes.Column("part", owner[:, None], "face"))
                rest = ["rest"] * (len(inside) < len(numbers))
                named.update(formats.named([*(name for name, _ in sets), *rest], "part"))
            corners, name = shape.corners[order], part.name if len(self.parts) > 1 else part.prim.GetName()
            whole = shapes.Part(part.at(code, cache), shape.counts, corners, columns, numbers, name)
            return whole.without(shape.holes) if len(shape.holes) else whole

        counts = [(part.shape.vertices, max(part.shape.triangles, 0)) for part in parts]
        found = shapes.joined_parts(map(made, parts), counts, self._limits, self._size)
        up = str(geom.GetStageUpAxis(self.stage)).lower()
        unit = float(geom.GetStageMetersPerUnit(self.stage))
        of_materials, absent, lost = materials.metadata(self._limits)
        metadata = {"up": up, "unit": unit_named(unit), **named, **found.metadata, **of_materials}
        metadata |= {"provenance": said} if (said := self.stage.GetRootLayer().comment).startswith("bsm ") else {}
        own = self.parts[0].prim.GetPath()
        metadata |= {"prim": str(own)} if len(self.parts) == 1 and own.pathElementCount > 1 else {}
        left = dict.fromkeys((*(name for part in self.parts for name in part.shape.left_out), *materials.left, *lost))
        notes = [*found.notes, *absent, *self.notes]
        notes += [f"left out, face sets without a material: {', '.join(unnamed)}"] if unnamed else []
        return replace(found, notes=tuple(notes), dropped=tuple(left), metadata=metadata).checked(self._limits)


@as_format_error("stage")
def read_usd(path: str, wanted: Wanted, limits: Limits = DEFAULT_LIMITS) -> Frames | None:
    """The frames of a stage, sampled at its rate or the one that is wanted; None if nothing moves."""
    stage = _Stage(path, limits, runs=wanted.runs)
    times = stage.times
    if len(times) < 2:
        return None
    codes = float(stage.stage.GetTimeCodesPerSecond())
    rate = wanted.rate or codes
    first, last = stage.span or (times[0], times[-1])
    if not np.isfinite([first, last, codes, (last - first) * rate / codes]).all():
        raise FormatError(f"the stage runs from {first:g} to {last:g} at {codes:g} codes per second")
    # A little more, since 1/24 s is not exact in binary, and rounding would lose the last frame.
    count = int(np.floor(max(last - first, 0.0) * rate / codes + 1e-6)) + 1
    require_counts(limits, frames=count)
    still = stage.frame(first)
    every = [first + number * codes / rate for number in range(count)]
    samples = (np.array([time for time in times if first <= time <= last]) - first) * rate / codes
    off = between("time samples", samples, rate)
    off += [f"{len(times) - len(samples)} time samples lie outside {first:g} to {last:g}"] * (len(samples) < len(times))
    mesh, notes = still.mesh, (f"{count} frames at {rate:g} per second", *off, *still.notes)
    meshes = None
    if (wanted.runs and stage.changes) or any(part.shape.painted for part in stage.parts):
        meshes = (painted_like(mesh, stage.renewed(time)) for time in every)
    metadata = {**mesh.metadata, **({table.START: first * rate / codes} if first else {})}
    return Frames(mesh.faces, count, map(stage.at, every), mesh.attributes, notes, rate, metadata, meshes)


@as_format_error("stage")
def read_usd_mesh(path: str, limits: Limits = DEFAULT_LIMITS) -> shapes.MeshFile:
    """The mesh of a stage at its first time; errors as of `read_usd`."""
    stage = _Stage(path, limits)
    times = stage.times
    found = stage.mesh(*stage.span[:1] or times[:1] or [0.0])
    note = ("of the motion, the first time was taken",) if len(times) > 1 else ()
    return replace(found, notes=(*found.notes, *note))


# ---------------------------------------------------------------------------------------------------------------- out


@contextmanager
def write_usd(file: BinaryIO, kind: str, faces: Faces, shared: Shared) -> Iterator[Callable[..., None]]:
    """Write a stage of one mesh with a time sample for each frame; yields a function that takes one frame."""
    pxr = import_usd()
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder, "mesh.usdc" if kind == "usdz" else f"mesh.{kind}"))
        stage = pxr.Usd.Stage.CreateNew(path)
        mesh: Any = None
        materials: dict[int, Any] = {}
        still: TriangleMesh | None = None  # the first mesh, as long as its faces are those of all frames
        taken = 0
        before = 0.0  # the code of the frame before
        keyed: set[str] = set()  # attributes that have times

        def write(frame: Positions, other: Faces | None = None) -> None:
            nonlocal mesh, materials, taken, still, before
            code = shared.code(taken)
            if mesh is None:
                still = shared.mesh(frame, faces)
                mesh, materials = _begun(pxr, stage, still, shared, Path(folder) if kind == "usdz" else None)
            if other is not None:
                if still is not None:
                    _set_mesh(pxr, mesh, materials, still, shared.code(0))
                _set_mesh(pxr, mesh, materials, shared.mesh(frame, other), code)
                still = None
            for attribute in shared.moved():
                if still is not None and attribute.name not in keyed:
                    # A value at a later time alone would hold for all earlier times: its old value gets the time
                    # before.
                    _written(pxr, mesh, next(own for own in still.attributes if own.name == attribute.name), before)
                keyed.add(attribute.name)
                _written(pxr, mesh, attribute, code)
            if not single_suffices(frame):
                raise MeshError(f"frame {taken} needs double precision, which points of USD do not have; write npz")
            mesh.GetPointsAttr().Set(frame.astype(np.float32), code)
            mesh.GetExtentAttr().Set(np.array([frame.min(axis=0), frame.max(axis=0)], np.float32), code)
            taken, before = taken + 1, code
            if taken % 64 == 0:
                stage.Save()  # saved frames need not stay in memory

        yield write
        stage.SetEndTimeCode(before)
        stage.Save()
        if kind == "usdz":
            packed = str(Path(folder, "mesh.usdz"))
            if not pxr.UsdUtils.CreateNewUsdzPackage(path, packed):
                raise OSError("usd-core could not pack the stage as usdz")
            path = packed
        with open(path, "rb") as written:
            shutil.copyfileobj(written, file)


def _begun(
    pxr: Any, stage: Any, first: TriangleMesh, shared: Shared, images: Path | None
) -> tuple[Any, dict[int, Any]]:
    """A stage with everything of a mesh but its points, and its materials by their numbers; images go to a folder."""
    geom, rate = pxr.UsdGeom, shared.frame_rate or USUAL_RATE
    metadata = formats.without_materials(first.metadata)
    geom.SetStageUpAxis(stage, geom.Tokens.z if str(metadata.get("up", "y")).lower() == "z" else geom.Tokens.y)
    size = metres(unit_of(metadata))
    geom.SetStageMetersPerUnit(stage, size or 1.0)
    stage.SetTimeCodesPerSecond(rate)
    stage.SetFramesPerSecond(rate)
    stage.SetStartTimeCode(shared.code(0))
    stage.SetInterpolationType(pxr.Usd.InterpolationTypeLinear)
    name = pxr.Tf.MakeValidIdentifier(str(metadata.get("name") or "mesh"))
    own = re.fullmatch(r"(/[A-Za-z_]\w{0,99}){1,30}", str(metadata.get("prim")), re.ASCII)
    place = pxr.Sdf.Path(own[0] if own else f"/{name}")
    mesh = geom.Mesh.Define(stage, place)
    for above in list(place.GetPrefixes())[:-1]:
        geom.Xform.Define(stage, above)
    # Without one, a reference to this file from another stage finds nothing.
    stage.SetDefaultPrim(stage.GetPrimAtPath(place.GetPrefixes()[0]))
    # The default is Catmull-Clark: without this, viewers round off every mesh.
    mesh.CreateSubdivisionSchemeAttr(geom.Tokens.none)
    mesh.CreateFaceVertexCountsAttr().Set(np.full(len(first.faces), 3))
    mesh.CreateFaceVertexIndicesAttr().Set(first.faces.reshape(-1))
    mesh.CreatePointsAttr()
    mesh.CreateExtentAttr()
    if str(metadata.get("up")).lower() == "x":  # which stages cannot have
        mesh.AddRotateZOp().Set(90.0)
    materials, written = write_materials(pxr, mesh, first, images)
    others = _others(first, materials, parts := name_parts(pxr, mesh, first))
    shared.loses(attribute.name for attribute in others if not _written(pxr, mesh, attribute))
    stage.GetRootLayer().comment = str(metadata.get("provenance", ""))
    written |= {"up", "name", "prim", "provenance"} | ({"unit"} if size else set())
    written |= {"part.names", *(f"part.{n}.name" for n in formats.names_in(metadata, "part"))} if parts else set()
    shared.loses(formats.in_words((name for name in first.metadata if name not in written), first.metadata))
    return mesh, materials


def _others(frame: TriangleMesh, materials: dict[int, Any], parts: Attribute | None) -> list[Attribute]:
    shown = formats.face_numbers(frame, "material") if materials else None
    return [one for one in frame.attributes if one is not shown and one is not parts and one.name != EMPTY]


def _set_mesh(pxr: Any, mesh: Any, materials: dict[int, Any], frame: TriangleMesh, time: float) -> None:
    """Let the mesh have the faces and attributes of a frame from a time on."""
    faces = frame.faces[:0] if is_empty(frame.attributes) else frame.faces
    mesh.GetFaceVertexCountsAttr().Set(np.full(len(faces), 3), time)
    mesh.GetFaceVertexIndicesAttr().Set(faces.reshape(-1), time)
    bind_materials(pxr, mesh, frame, materials, time)
    for attribute in _others(frame, materials, name_parts(pxr, mesh, frame, time)):
        _written(pxr, mesh, attribute, time)


def _written(pxr: Any, mesh: Any, attribute: Attribute, time: float = _NO_TIME) -> bool:
    """Write an attribute as a primvar, or its values at a time; return whether that is possible."""
    width, name = attribute.components, pxr.Tf.MakeValidIdentifier(attribute.name)
    values = attribute.values.astype(np.float32)
    if attribute.semantic == "color":
        if width < 3:
            return False
        linear = conventions.to_linear(conventions.shares_of(attribute.values)).astype(np.float32)
        values, name, kind = linear[:, :3], "displayColor" if attribute.name == "color" else name, "Color3fArray"
        if width == 4 and (
            attribute.name != "color"
            or (linear[:, 3] < 1).any()
            or pxr.UsdGeom.PrimvarsAPI(mesh).HasPrimvar("displayOpacity")
        ):
            opacity = replace(attribute, name="displayOpacity", values=linear[:, 3:], semantic="generic")
            if attribute.name != "color" or not _written(pxr, mesh, opacity, time):
                return False
    elif attribute.semantic == "texcoord" and width == 2:
        name, kind = (_COORDINATES if attribute.name == "texcoord" else name), "TexCoord2fArray"
    elif (values == attribute.values).all():
        kind = f"Float{width if width > 1 else ''}Array"
    else:
        return False
    tokens, types = pxr.UsdGeom.Tokens, pxr.Sdf.ValueTypeNames
    place = {"vertex": tokens.vertex, "face": tokens.uniform, "corner": tokens.faceVarying}[attribute.domain]
    primvar = pxr.UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(name, getattr(types, kind), place)
    primvar.Set(values[:, 0] if values.shape[1] == 1 else values, time)
    if attribute.indices is not None:
        rows = np.ascontiguousarray(attribute.indices.reshape(-1), np.int32)
        primvar.SetIndices(pxr.Vt.IntArray.FromNumpy(rows), pxr.Usd.TimeCode(time))
    return True
