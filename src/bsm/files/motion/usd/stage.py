"""A stage: its parts as one mesh, at any time."""

import os
import re
from dataclasses import replace
from typing import Any

import numpy as np

from bsm.bitstream.errors import FormatError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.mesh import NoFacesError, TriangleMesh
from bsm.codec.sequence.runs import empty_frame
from bsm.files.formats import polygons
from bsm.files.formats.metadata import Value, named
from bsm.files.formats.outside import layers_inside, refuse_clips_outside
from bsm.files.motion.usd.library import import_usd, silence_usd
from bsm.files.motion.usd.materials import Materials
from bsm.files.motion.usd.meshes import StageMesh
from bsm.files.motion.usd.parts import PlacedMesh
from bsm.files.motion.usd.traversal import MOST_NAMED, Traversal
from bsm.files.parsing import Doubles, Ints, as_format_error, as_library_error
from bsm.ground.lengths import unit_named


class Stage:
    """A stage that is read at its first time or, with `runs`, with the faces and parts of each time."""

    def __init__(self, path: str, limits: Limits, *, runs: bool = False) -> None:
        self._limits = limits
        self._file_size = os.path.getsize(path)
        self._runs = runs
        self._pxr = pxr = import_usd()
        with as_library_error("usd-core"), silence_usd(pxr):
            try:
                # Kept, so that the stage does not read them again.
                self._layers = layers_inside(pxr, path)
                self._stage = pxr.Usd.Stage.Open(path)
                refuse_clips_outside(pxr, self._stage, path)
            # Which names its own source before the place in the file.
            except pxr.Tf.ErrorException as error:
                message = " ".join(str(error).split())
                reasons = re.findall(r" : '(.*?)'(?=\s*(?:Error in|$))", message)
                raise FormatError(
                    f"usd-core cannot read this file: {' '.join(reasons)[:300]}"
                ) from error
        stage = self._stage
        # Usd-core would not end.
        if not all(layer.timeCodesPerSecond > 0 for layer in stage.GetUsedLayers()):
            raise FormatError(
                "timeCodesPerSecond of this stage, or of a layer of it, is not above 0"
            )
        if any(prim.IsA(pxr.UsdSkel.Root) for prim in stage.Traverse()):
            # Skeletons move the points, in a layer that is not saved.
            stage.SetEditTarget(stage.GetSessionLayer())
            pxr.UsdSkel.BakeSkinning(stage.Traverse())
        self.codes_per_second = float(stage.GetTimeCodesPerSecond())
        first, last = stage.GetStartTimeCode(), stage.GetEndTimeCode()
        self.span: tuple[float, ...] = ()
        """The codes that the stage says it shows."""
        first_code = pxr.Usd.TimeCode.EarliestTime()
        if stage.HasAuthoredTimeCodeRange() and first <= last:
            self.span = float(first), float(last)
            first_code = pxr.Usd.TimeCode(self.span[0])
        self._materials = Materials(pxr, path, stage)
        self._traversal = Traversal(pxr, stage, first_code, runs=runs)
        with silence_usd(pxr):
            self.parts = list(self._traversal.parts())
        missing_layers = [" ".join(str(error).split()) for error in stage.GetCompositionErrors()]
        self._notes = [
            f"left out, a layer or reference: {text[:200]}" for text in missing_layers[:MOST_NAMED]
        ]
        self._notes += self._traversal.notes()
        if not self.parts:
            raise FormatError("; ".join(("this stage has no meshes", *self._notes)))

    @property
    def times(self) -> list[float]:
        times: set[float] = set()
        for part in self.parts:
            times.update(part.times(self._pxr.UsdGeom))
        return sorted(times)

    @property
    def changes(self) -> bool:
        """Whether faces change, or parts appear or vanish."""
        for part in self.parts:
            for attribute in (part.shape.counts_attr, part.shape.corners_attr):
                if attribute.GetNumTimeSamples() > 1:
                    return True
        return bool(self._traversal.blinking)

    @as_format_error("stage")
    def points(self, time: float) -> Doubles:
        code = self._pxr.Usd.TimeCode(time)
        cache = self._pxr.UsdGeom.XformCache(code)
        return np.concatenate([part.points(code, cache) for part in self.parts])

    @as_format_error("stage")
    def changed_mesh(self, time: float) -> TriangleMesh:
        """Return the mesh at a time, with the faces and primvars that it has then."""
        code = self._pxr.Usd.TimeCode(time)
        parts: list[PlacedMesh] = []
        for part in self.parts:
            shape = StageMesh(self._pxr, part.prim, code, part.instance)
            parts.append(PlacedMesh(shape, part.prim, part.instance))
        self.parts = parts
        return self.frame(time).mesh

    def frame(self, time: float) -> polygons.MeshFile:
        """Return the mesh at a time; where frames may be without faces, an empty one if nothing is visible."""
        try:
            return self.mesh(time)
        except NoFacesError:
            if not self._runs:
                raise
            return polygons.MeshFile(empty_frame())

    def mesh(self, time: float) -> polygons.MeshFile:
        """Return the mesh at a time, with everything; polygons are cut into triangles."""
        code = self._pxr.Usd.TimeCode(time)
        cache = self._pxr.UsdGeom.XformCache(code)
        visible_parts = self.parts
        if self._runs and self._traversal.blinking:
            visible_parts = [
                part for part in self.parts if self._traversal.is_part_visible(part, time)
            ]
            if not visible_parts:
                raise NoFacesError(f"nothing is visible at time {time:g}")
        face_sets = _FaceSets(several_parts=len(self.parts) > 1)
        sizes = [(part.shape.vertices, max(part.shape.triangles, 0)) for part in visible_parts]
        placed_parts = (self._placed_part(part, code, cache, face_sets) for part in visible_parts)
        joined = polygons.joined_parts(placed_parts, sizes, self._limits, self._file_size)
        material_metadata, missing_images, material_losses = self._materials.metadata(self._limits)
        metadata = {
            **self._stage_metadata(),
            **face_sets.metadata,
            **joined.metadata,
            **material_metadata,
        }
        metadata |= self._own_metadata()
        losses: list[str] = []
        for part in self.parts:
            losses += part.shape.left_out
        losses += [*self._materials.unread, *material_losses]
        notes = [*joined.notes, *missing_images, *self._notes, *face_sets.notes()]
        dropped = tuple(dict.fromkeys(losses))
        return replace(joined, notes=tuple(notes), dropped=dropped, metadata=metadata).checked(
            self._limits
        )

    def _stage_metadata(self) -> dict[str, Value]:
        geom = self._pxr.UsdGeom
        unit = float(geom.GetStageMetersPerUnit(self._stage))
        return {"up": str(geom.GetStageUpAxis(self._stage)).lower(), "unit": unit_named(unit)}

    def _own_metadata(self) -> dict[str, Value]:
        """Return metadata that `bsm decode` wrote into the stage."""
        metadata: dict[str, Value] = {}
        comment = self._stage.GetRootLayer().comment
        if comment.startswith("bsm "):
            metadata["provenance"] = comment
        path = self.parts[0].prim.GetPath()
        if len(self.parts) == 1 and path.pathElementCount > 1:
            metadata["prim"] = str(path)
        return metadata

    def _placed_part(
        self, part: PlacedMesh, code: Any, cache: Any, face_sets: "_FaceSets"
    ) -> polygons.Part:
        shape = part.shape
        # A mirror swaps inside and outside, as the left-handed orientation does; both together swap nothing.
        mirrored = np.linalg.det(part.matrix(code, cache)[:3, :3]) < 0.0
        turned = np.full(len(shape.counts), shape.left_handed != mirrored)
        order = polygons.turned_corners(shape.counts, turned)
        columns: list[polygons.Column] = []
        for column in shape.columns:
            if column.indices is not None:
                column = replace(column, indices=column.indices[order])
            columns.append(column)
        materials, unbound_sets = self._materials.number_faces(
            part.prim, len(shape.counts), shape.time
        )
        columns += face_sets.columns(unbound_sets, len(materials))
        name = part.name
        if len(self.parts) == 1:
            name = part.prim.GetName()
        points = part.points(code, cache)
        placed_part = polygons.Part(
            points, shape.counts, shape.corners[order], columns, materials, name
        )
        if len(shape.holes):
            placed_part = placed_part.without(shape.holes)
        return placed_part


class _FaceSets:
    """The sets of faces without a material: the parts of a single mesh, if no face is in two of them."""

    def __init__(self, *, several_parts: bool) -> None:
        self._several_parts = several_parts
        self._left_out: dict[str, None] = {}
        self.metadata: dict[str, str] = {}

    def columns(self, sets: list[tuple[str, Ints]], faces: int) -> list[polygons.Column]:
        if not sets:
            return []
        members = np.concatenate([places for _, places in sets])
        names = [name for name, _ in sets]
        if self._several_parts or len(np.unique(members)) < len(members):
            self._left_out |= dict.fromkeys(names)
            return []
        numbers = np.full(faces, len(sets), np.int32)
        numbers[members] = np.repeat(np.arange(len(sets)), [len(places) for _, places in sets])
        if len(members) < faces:
            names.append("rest")
        self.metadata |= named(names, "part")
        return [polygons.Column("part", numbers[:, None], "face")]

    def notes(self) -> list[str]:
        if not self._left_out:
            return []
        return [f"left out, face sets without a material: {', '.join(self._left_out)}"]
