"""Stages that are written: one mesh with a time sample for each frame."""

import re
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.runs import EMPTY, is_empty
from bsm.files.conventions import shares_of, to_linear
from bsm.files.formats.metadata import face_numbers, in_words, names_in, without_materials
from bsm.files.motion.frames import USUAL_RATE, Shared
from bsm.files.motion.usd.library import COORDINATES, NO_TIME, import_usd
from bsm.files.motion.usd.surfaces import bind_materials, write_materials, write_parts
from bsm.files.parsing import single_suffices
from bsm.ground.lengths import metres, unit_of


@contextmanager
def write_usd(
    file: BinaryIO, kind: str, faces: Faces, shared: Shared
) -> Iterator[Callable[..., None]]:
    """Write a stage of one mesh with a time sample for each frame; yields a function that takes one frame."""
    with tempfile.TemporaryDirectory() as name:
        writer = _StageWriter(Path(name), kind, faces, shared)
        yield writer.write
        path = writer.save()
        with open(path, "rb") as stage_file:
            shutil.copyfileobj(stage_file, file)


class _StageWriter:
    """A stage in a folder that takes one frame after the other."""

    def __init__(self, folder: Path, kind: str, faces: Faces, shared: Shared) -> None:
        self._pxr = import_usd()
        self._folder = folder
        self._packed = kind == "usdz"
        self._path = folder / f"mesh.{kind}"
        if self._packed:
            self._path = folder / "mesh.usdc"
        self._stage = self._pxr.Usd.Stage.CreateNew(str(self._path))
        self._faces = faces
        self._shared = shared
        self._mesh: Any = None
        self._materials: dict[int, Any] = {}
        # The first mesh, as long as its faces are those of all frames.
        self._first: TriangleMesh | None = None
        self._count = 0
        self._last_code = 0.0
        self._timed: set[str] = set()  # attributes that have times

    def write(self, frame: Positions, faces: Faces | None = None) -> None:
        """Write a frame, with its faces where they are others than before."""
        code = self._shared.code(self._count)
        if self._mesh is None:
            self._first = self._shared.mesh(frame, self._faces)
            self._begin(self._first)
        if faces is not None:
            if self._first is not None:
                self._set_mesh(self._first, self._shared.code(0))
            self._set_mesh(self._shared.mesh(frame, faces), code)
            self._first = None
        for attribute in self._shared.moved():
            if self._first is not None and attribute.name not in self._timed:
                # A value at a later time alone would hold for all earlier times: its old value gets the time before.
                first_values = next(
                    old for old in self._first.attributes if old.name == attribute.name
                )
                self._write_attribute(first_values, self._last_code)
            self._timed.add(attribute.name)
            self._write_attribute(attribute, code)
        if not single_suffices(frame):
            raise MeshError(
                f"frame {self._count} needs double precision, which points of USD do not have; write npz"
            )
        extent = np.array([frame.min(axis=0), frame.max(axis=0)], np.float32)
        self._mesh.GetPointsAttr().Set(frame.astype(np.float32), code)
        self._mesh.GetExtentAttr().Set(extent, code)
        self._count += 1
        self._last_code = code
        if self._count % 64 == 0:
            self._stage.Save()  # saved frames need not stay in memory

    def save(self) -> Path:
        """Write the stage, and return the path of its file."""
        self._stage.SetEndTimeCode(self._last_code)
        self._stage.Save()
        if not self._packed:
            return self._path
        package = self._folder / "mesh.usdz"
        if not self._pxr.UsdUtils.CreateNewUsdzPackage(str(self._path), str(package)):
            raise OSError("usd-core could not pack the stage as usdz")
        return package

    def _begin(self, first: TriangleMesh) -> None:
        """Write everything of the first mesh but its points."""
        pxr, shared = self._pxr, self._shared
        metadata = without_materials(first.metadata)
        has_unit = self._set_conventions(
            str(metadata.get("up", "y")).lower(), metres(unit_of(metadata))
        )
        self._define_mesh(str(metadata.get("name") or "mesh"), str(metadata.get("prim")))
        mesh = self._mesh
        # The default is Catmull-Clark: without this, viewers round off every mesh.
        mesh.CreateSubdivisionSchemeAttr(pxr.UsdGeom.Tokens.none)
        mesh.CreateFaceVertexCountsAttr().Set(np.full(len(first.faces), 3))
        mesh.CreateFaceVertexIndicesAttr().Set(first.faces.reshape(-1))
        mesh.CreatePointsAttr()
        mesh.CreateExtentAttr()
        if str(metadata.get("up")).lower() == "x":  # which stages cannot have
            mesh.AddRotateZOp().Set(90.0)
        image_folder: Path | None = None
        if self._packed:
            image_folder = self._folder
        self._materials, written = write_materials(pxr, mesh, first, image_folder)
        parts = write_parts(pxr, mesh, first)
        primvars = self._primvars(first, parts)
        shared.loses(
            attribute.name for attribute in primvars if not self._write_attribute(attribute)
        )
        self._stage.GetRootLayer().comment = str(metadata.get("provenance", ""))
        written |= {"up", "name", "prim", "provenance"}
        if has_unit:
            written.add("unit")
        if parts is not None:
            written |= {
                "part.names",
                *(f"part.{number}.name" for number in names_in(metadata, "part")),
            }
        unwritten = (name for name in first.metadata if name not in written)
        shared.loses(in_words(unwritten, first.metadata))

    def _set_conventions(self, up: str, unit: float | None) -> bool:
        """Set the axis, the unit and the rate of the stage; return whether the unit could be set."""
        stage, geom = self._stage, self._pxr.UsdGeom
        rate = self._shared.frame_rate or USUAL_RATE
        axis = geom.Tokens.y
        if up == "z":
            axis = geom.Tokens.z
        geom.SetStageUpAxis(stage, axis)
        geom.SetStageMetersPerUnit(stage, unit or 1.0)
        stage.SetTimeCodesPerSecond(rate)
        stage.SetFramesPerSecond(rate)
        stage.SetStartTimeCode(self._shared.code(0))
        stage.SetInterpolationType(self._pxr.Usd.InterpolationTypeLinear)
        return bool(unit)

    def _define_mesh(self, name: str, prim_path: str) -> None:
        """Add the mesh under the path of its prim, or else under its name."""
        stage, geom = self._stage, self._pxr.UsdGeom
        if not re.fullmatch(r"(/[A-Za-z_]\w{0,99}){1,30}", prim_path, re.ASCII):
            prim_path = f"/{self._pxr.Tf.MakeValidIdentifier(name)}"
        path = self._pxr.Sdf.Path(prim_path)
        self._mesh = geom.Mesh.Define(stage, path)
        ancestors = list(path.GetPrefixes())[:-1]
        for ancestor in ancestors:
            geom.Xform.Define(stage, ancestor)
        # Without one, a reference to this file from another stage finds nothing.
        stage.SetDefaultPrim(stage.GetPrimAtPath(path.GetPrefixes()[0]))

    def _set_mesh(self, frame: TriangleMesh, time: float) -> None:
        """Let the mesh have the faces and attributes of a frame from a time on."""
        pxr, mesh = self._pxr, self._mesh
        faces = frame.faces
        if is_empty(frame.attributes):
            faces = faces[:0]
        mesh.GetFaceVertexCountsAttr().Set(np.full(len(faces), 3), time)
        mesh.GetFaceVertexIndicesAttr().Set(faces.reshape(-1), time)
        bind_materials(pxr, mesh, frame, self._materials, time)
        parts = write_parts(pxr, mesh, frame, time)
        for attribute in self._primvars(frame, parts):
            self._write_attribute(attribute, time)

    def _primvars(self, frame: TriangleMesh, parts: Attribute | None) -> list[Attribute]:
        """Return the attributes that are not written as sets of faces."""
        materials: Attribute | None = None
        if self._materials:
            materials = face_numbers(frame, "material")
        return [
            a for a in frame.attributes if a is not materials and a is not parts and a.name != EMPTY
        ]

    def _write_attribute(self, attribute: Attribute, time: float = NO_TIME) -> bool:
        """Write an attribute as a primvar, or its values at a time; return whether that is possible."""
        types, width = self._pxr.Sdf.ValueTypeNames, attribute.components
        if attribute.semantic == "color":
            return self._write_color(attribute, time)
        values = attribute.values.astype(np.float32)
        if attribute.semantic == "texcoord" and width == 2:
            name = self._identifier(attribute.name)
            if attribute.name == "texcoord":
                name = COORDINATES
            self._set_primvar(attribute, name, types.TexCoord2fArray, values, time)
            return True
        if not (values == attribute.values).all():
            return False
        type_name = "FloatArray"
        if width > 1:
            type_name = f"Float{width}Array"
        kind = getattr(types, type_name)
        self._set_primvar(attribute, self._identifier(attribute.name), kind, values, time)
        return True

    def _write_color(self, color: Attribute, time: float) -> bool:
        """Write a color as a primvar, and its opacity as another one."""
        if color.components < 3:
            return False
        is_display_color = color.name == "color"
        linear = to_linear(shares_of(color.values)).astype(np.float32)
        if color.components == 4:
            if not is_display_color:
                return False
            api = self._pxr.UsdGeom.PrimvarsAPI(self._mesh)
            if (linear[:, 3] < 1).any() or api.HasPrimvar("displayOpacity"):
                opacity = replace(
                    color, name="displayOpacity", values=linear[:, 3:], semantic="generic"
                )
                self._write_attribute(opacity, time)
        name = self._identifier(color.name)
        if is_display_color:
            name = "displayColor"
        kind = self._pxr.Sdf.ValueTypeNames.Color3fArray
        self._set_primvar(color, name, kind, linear[:, :3], time)
        return True

    def _identifier(self, name: str) -> str:
        return str(self._pxr.Tf.MakeValidIdentifier(name))

    def _set_primvar(
        self, attribute: Attribute, name: str, kind: Any, values: Any, time: float
    ) -> None:
        pxr = self._pxr
        tokens = pxr.UsdGeom.Tokens
        interpolations = {
            "vertex": tokens.vertex,
            "face": tokens.uniform,
            "corner": tokens.faceVarying,
        }
        api = pxr.UsdGeom.PrimvarsAPI(self._mesh)
        primvar = api.CreatePrimvar(name, kind, interpolations[attribute.domain])
        if values.shape[1] == 1:
            values = values[:, 0]
        primvar.Set(values, time)
        if attribute.indices is not None:
            rows = np.ascontiguousarray(attribute.indices.reshape(-1), np.int32)
            primvar.SetIndices(pxr.Vt.IntArray.FromNumpy(rows), pxr.Usd.TimeCode(time))
