"""The prims of a stage that are shown: its meshes and the instances of instancers, and notes on all others."""

from collections.abc import Iterator
from functools import cached_property
from typing import Any

from bsm.bitstream.errors import LimitError
from bsm.files.motion.usd.instances import Instance, Instancer
from bsm.files.motion.usd.meshes import StageMesh, source_paths
from bsm.files.motion.usd.parts import PlacedMesh, visibility_times

_MOST_PRIMS = 1 << 16
MOST_NAMED = 12  # things of a kind in a note


class Traversal:
    """One walk over a stage, at its first time or, with `runs`, at all its times."""

    def __init__(self, pxr: Any, stage: Any, first: Any, *, runs: bool) -> None:
        self._pxr = pxr
        self._geom = pxr.UsdGeom
        self._stage = stage
        self._first = first
        self._runs = runs
        self._left_out: dict[str, list[str]] = {}
        self.blinking: list[str] = []
        """The paths of meshes and instancers that appear or vanish."""

    def parts(self) -> Iterator[PlacedMesh]:
        """Yield the visible meshes, once for each instance."""
        shapes: dict[tuple[Any, ...], StageMesh] = {}
        for prim, instance in self._visible_meshes():
            key: tuple[Any, ...] = source_paths(self._pxr, prim)
            # An instance has primvars of its own, and those of the prims above it.
            if instance is not None and instance.instancer.primvars:
                key = (*key, str(instance.instancer.prim.GetPath()), instance.number)
            if key not in shapes:
                shapes[key] = StageMesh(self._pxr, prim, self._first, instance)
            shape = shapes[key]
            if shape.rows["face"] or shape.rows["corner"]:
                yield PlacedMesh(shape, prim, instance)

    def notes(self) -> Iterator[str]:
        """Yield notes on all that is left out, after all parts were taken."""
        if self.blinking and not self._runs:
            names = ", ".join(self.blinking[:MOST_NAMED])
            yield f"these vanish, and are always shown; --runs lets them: {names}"
        for reason, paths in self._left_out.items():
            if paths:
                yield f"left out, {reason}: {', '.join(paths[:MOST_NAMED])}"

    def _visible_meshes(self) -> Iterator[tuple[Any, Instance | None]]:
        # The usual traversal stops at instances, whose meshes would then be missing.
        prims = iter(
            self._pxr.Usd.PrimRange.Stage(self._stage, self._pxr.Usd.TraverseInstanceProxies())
        )
        for count, prim in enumerate(prims):
            if count == _MOST_PRIMS:
                raise LimitError(
                    f"the stage and its instances have over {_MOST_PRIMS:,} prims; export a part of it"
                )
            self._note_variants(prim)
            reason = self._reason_hidden(prim)
            if reason:
                self._leave_out(reason, [str(prim.GetPath())])
            elif prim.IsA(self._geom.PointInstancer):
                prims.PruneChildren()
                yield from self._instances(Instancer(self._pxr, prim))
            elif prim.IsA(self._geom.Mesh):
                yield prim, None

    def _instances(self, instancer: Instancer) -> Iterator[tuple[Any, Instance]]:
        path = str(instancer.prim.GetPath())
        if instancer.inner:
            self._leave_out("instancers in prototypes", instancer.inner)
        times = [self._first.GetValue()]
        visible_first = instancer.visible_at(times[0])
        if any(instancer.visible_at(time) != visible_first for time in instancer.changes):
            if self._runs:
                self.blinking.append(path)
                times += instancer.changes
            else:
                self._leave_out(
                    "instances that appear, vanish or become others later (--runs)", [path]
                )
        yield from instancer.instances(times)

    def _leave_out(self, reason: str, paths: list[str]) -> None:
        self._left_out.setdefault(reason, []).extend(paths)

    def _note_variants(self, prim: Any) -> None:
        variant_sets = prim.GetVariantSets()
        for name in variant_sets.GetNames():
            unused_variants = {*variant_sets.GetVariantSet(name).GetVariantNames()}
            unused_variants.discard(variant_sets.GetVariantSelection(name))
            self._leave_out(
                "variants that are not chosen",
                [f"{name}={variant}" for variant in sorted(unused_variants)],
            )

    def _reason_hidden(self, prim: Any) -> str:
        """Return why a mesh or an instancer is not shown, or "" if it is."""
        geom = self._geom
        if not (prim.IsA(geom.Mesh) or prim.IsA(geom.PointInstancer)):
            return ""
        purpose = geom.Imageable(prim).ComputePurpose()
        if purpose == geom.Tokens.guide:
            return "guides"
        if purpose == geom.Tokens.proxy and self._has_render_meshes:
            return "stand-ins (purpose proxy)"
        times = visibility_times(geom, prim)
        times_read = [self._first.GetValue()]
        if self._runs and times:
            times_read = times
        if any(self.is_visible(prim, time) for time in times_read):
            if times:
                self.blinking.append(str(prim.GetPath()))
            return ""
        if times and not self._runs:
            return "they appear later (--runs)"
        return "hidden"

    @cached_property
    def _has_render_meshes(self) -> bool:
        """Whether some mesh is for pictures only, so that others stand in for it elsewhere."""
        geom = self._geom
        for prim in self._stage.Traverse():
            if prim.IsA(geom.Mesh) and geom.Imageable(prim).ComputePurpose() == geom.Tokens.render:
                return True
        return False

    def is_visible(self, prim: Any, time: float) -> bool:
        """Return whether a prim is visible at a time."""
        visibility = self._geom.Imageable(prim).ComputeVisibility(self._pxr.Usd.TimeCode(time))
        return bool(visibility != self._geom.Tokens.invisible)

    def is_part_visible(self, part: PlacedMesh, time: float) -> bool:
        """Return whether a part is visible at a time; of an instancer, whether its instance is."""
        if part.instance is None:
            return self.is_visible(part.prim, time)
        instancer, number, _, prototype = part.instance
        return self.is_visible(instancer.prim, time) and (
            number,
            prototype,
        ) in instancer.visible_at(time)
