"""The instances of point instancers, and the primvars that prims have."""

from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError
from bsm.files.parsing import Doubles


class Instance(NamedTuple):
    """An instance by its number, with the root of its prototype and the number of that."""

    instancer: "Instancer"
    number: int
    root: Any
    prototype: int


class Instancer:
    """A point instancer, whose instances have a place at any time."""

    def __init__(self, pxr: Any, prim: Any) -> None:
        self._pxr = pxr
        self.prim = prim
        self.primvars = authored_primvars(pxr, prim)
        self._instancer = pxr.UsdGeom.PointInstancer(prim)
        self._time = np.nan  # of the transforms
        self._transforms: Doubles = np.empty((0, 4, 4))
        stage = prim.GetStage()
        self._roots = [
            stage.GetPrimAtPath(path) for path in self._instancer.GetPrototypesRel().GetTargets()
        ]
        self._meshes: list[list[Any]] = []
        self.inner: list[str] = []
        """The paths of instancers in the prototypes."""
        for root in self._roots:
            prims: list[Any] = []
            if root:
                prims = list(pxr.Usd.PrimRange.AllPrims(root))
            self._meshes.append([below for below in prims if below.IsA(pxr.UsdGeom.Mesh)])
            self.inner += [
                str(below.GetPath()) for below in prims if below.IsA(pxr.UsdGeom.PointInstancer)
            ]

    def count(self, time: Any) -> int:
        return len(self._instancer.GetProtoIndicesAttr().Get(time) or [])

    @lru_cache(2)  # noqa: B019
    def visible_at(self, time: float) -> frozenset[tuple[int, int]]:
        """Return the instances that are visible at a time, with their prototypes."""
        code = self._pxr.Usd.TimeCode(time)
        prototypes = np.array(self._instancer.GetProtoIndicesAttr().Get(code) or [], np.int64)
        mask = self._instancer.ComputeMaskAtTime(code)
        numbers = np.arange(len(prototypes))
        if mask:
            numbers = np.flatnonzero(np.array(mask, np.bool_))
        return frozenset(zip(numbers.tolist(), prototypes[numbers].tolist(), strict=True))

    def instances(self, times: Iterable[float]) -> Iterator[tuple[Any, Instance]]:
        """Yield the meshes of each instance that is visible at one of the times."""
        visible = frozenset[tuple[int, int]]().union(*map(self.visible_at, times))
        for number, prototype in sorted(visible):
            if not 0 <= prototype < len(self._roots):
                raise FormatError(
                    f"{self.prim.GetPath()} names prototype {prototype} of {len(self._roots)}"
                )
            for mesh in self._meshes[prototype]:
                yield mesh, Instance(self, number, self._roots[prototype], prototype)

    @property
    def changes(self) -> list[float]:
        """The times at which instances may appear, vanish or become others."""
        times: list[float] = []
        for attribute in (
            self._instancer.GetProtoIndicesAttr(),
            self._instancer.GetInvisibleIdsAttr(),
        ):
            if attribute.GetNumTimeSamples() > 1:
                times += attribute.GetTimeSamples()
        return times

    @property
    def times(self) -> list[float]:
        return [
            *self._instancer.GetPositionsAttr().GetTimeSamples(),
            *self._instancer.GetOrientationsAttr().GetTimeSamples(),
            *self._instancer.GetScalesAttr().GetTimeSamples(),
            *self.changes,
        ]

    def matrix(self, number: int, time: Any, cache: Any) -> Doubles:
        """Return the matrix that places an instance, with its prototype's transform, in the world."""
        # usd-core computes all instances at once; asking for each would take the square of their number.
        if self._time != time.GetValue():
            api = self._pxr.UsdGeom.PointInstancer
            transforms = self._instancer.ComputeInstanceTransformsAtTime(
                time, time, api.IncludeProtoXform, api.IgnoreMask
            )
            self._time = time.GetValue()
            self._transforms = np.array(transforms, np.float64).reshape(-1, 4, 4)
        if number >= len(self._transforms):
            raise MeshError(
                f"{self.prim.GetPath()} has {len(self._transforms)} instances at {time}, and more before: --runs"
            )
        world: Doubles = np.array(cache.GetLocalToWorldTransform(self.prim), np.float64)
        matrix: Doubles = self._transforms[number] @ world
        return matrix


def authored_primvars(pxr: Any, prim: Any) -> list[Any]:
    """Return the primvars with a value that a prim has or inherits."""
    primvars = pxr.UsdGeom.PrimvarsAPI(prim).FindPrimvarsWithInheritance()
    return [primvar for primvar in primvars if primvar.HasAuthoredValue()]
