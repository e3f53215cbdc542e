"""The meshes of a stage where it places them."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.files.motion.usd.instances import Instance
from bsm.files.motion.usd.meshes import StageMesh
from bsm.files.parsing import Doubles


class PlacedMesh:
    """A mesh of a stage at its place: its faces once, its points at any time."""

    def __init__(self, shape: StageMesh, prim: Any, instance: Instance | None = None) -> None:
        self.shape = shape
        self.prim = prim
        self.instance = instance
        self.name = str(prim.GetPath())
        if instance is not None:
            self.name = f"{instance.instancer.prim.GetPath()}[{instance.number}]"

    def times(self, geom: Any) -> list[float]:
        """Return the times at which the points, their colors, their place or their visibility change."""
        times: list[float] = []
        for attribute in (self.shape.points, *self.shape.painted):
            times += attribute.GetTimeSamples()
        prims = [self.prim]
        if self.instance is not None:
            times += self.instance.instancer.times
            prims.append(self.instance.instancer.prim)
        for prim in prims:
            times += visibility_times(geom, prim)
            for ancestor in _with_ancestors(prim):
                if geom.Xformable(ancestor):
                    times += geom.Xformable(ancestor).GetTimeSamples()
        return times

    def matrix(self, time: Any, cache: Any) -> Doubles:
        """Return the matrix that places the points in the world, from the right."""
        matrix: Doubles = np.array(cache.GetLocalToWorldTransform(self.prim), np.float64)
        if self.instance is None:
            return matrix
        root = np.array(cache.GetLocalToWorldTransform(self.instance.root), np.float64)
        # The prototype may lie anywhere in the stage: its own place is taken out first. A pseudo-inverse, as a
        # prototype may be scaled to 0.
        return (
            matrix
            @ np.linalg.pinv(root)
            @ self.instance.instancer.matrix(self.instance.number, time, cache)
        )

    def points(self, time: Any, cache: Any) -> Doubles:
        """Return the points in the world at a time."""
        shape = self.shape
        moment = f"at time {time.GetValue():g}"
        points = np.array(shape.points.Get(time) or (), np.float64).reshape(-1, 3)
        tables = (
            ("counts", shape.counts_attr, shape.counts),
            ("corners", shape.corners_attr, shape.corners),
        )
        for name, attribute, first_values in tables:
            if attribute.GetNumTimeSamples() <= 1:
                continue
            values = np.array(attribute.Get(time), np.int64)
            if not np.array_equal(values, first_values):
                raise MeshError(
                    f"the faces of {self.name} change {moment} (their {name}); if they may, --runs"
                )
        if len(points) != shape.vertices:
            raise MeshError(
                f"{self.name} has {len(points)} points {moment} and {shape.vertices} before"
            )
        matrix = self.matrix(time, cache)
        with np.errstate(over="ignore", invalid="ignore"):  # a later check refuses infinite values
            return points @ matrix[:3, :3] + matrix[3, :3]


def visibility_times(geom: Any, prim: Any) -> list[float]:
    """Return the times at which a prim may appear or vanish."""
    times: list[float] = []
    for ancestor in _with_ancestors(prim):
        attribute = geom.Imageable(ancestor).GetVisibilityAttr()
        if attribute and attribute.ValueMightBeTimeVarying():
            times += attribute.GetTimeSamples()
    return times


def _with_ancestors(prim: Any) -> Iterator[Any]:
    while prim and not prim.IsPseudoRoot():
        yield prim
        prim = prim.GetParent()
