"""The faces of a mesh of a stage, and its primvars as columns of attributes."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from bsm.bitstream.errors import FormatError
from bsm.codec.geometry.attributes import MOST_COMPONENTS, Domain, Semantic
from bsm.files.conventions import shares_of, srgb_colors, to_linear
from bsm.files.formats.polygons import Array, Column
from bsm.files.motion.usd.instances import Instance, authored_primvars
from bsm.files.parsing import Ints

_SHADES = {"displayColor": "color", "displayOpacity": "displayOpacity"}
_DOMAINS: dict[str, Domain] = {
    "vertex": "vertex",
    "varying": "vertex",
    "uniform": "face",
    "faceVarying": "corner",
}


class StageMesh:
    """The faces and primvars of a mesh of a stage; only their sizes until they are used.

    Instances share them where their primvars come from the same prims.
    """

    def __init__(self, pxr: Any, prim: Any, time: Any, instance: Instance | None) -> None:
        self._pxr = pxr
        self.prim = prim
        self.time = time
        mesh = pxr.UsdGeom.Mesh(prim)
        self.points = mesh.GetPointsAttr()
        self.counts_attr = mesh.GetFaceVertexCountsAttr()
        self.corners_attr = mesh.GetFaceVertexIndicesAttr()
        self.vertices = len(self.points.Get(time) or [])
        faces = len(self.counts_attr.Get(time) or [])
        corners = len(self.corners_attr.Get(time) or [])
        self.rows: dict[Domain, int] = {"vertex": self.vertices, "face": faces, "corner": corners}
        # A polygon of k corners has k - 2 triangles. Known before any table is copied, so that limits can refuse.
        self.triangles = corners - 2 * faces
        self.left_handed = mesh.GetOrientationAttr().Get() == pxr.UsdGeom.Tokens.leftHanded
        self._instance = instance
        self._primvars = authored_primvars(pxr, prim)
        self._instance_primvars: list[Any] = []
        if instance is not None:
            names = {primvar.GetPrimvarName() for primvar in self._primvars}
            self._instance_primvars = [
                p for p in instance.instancer.primvars if p.GetPrimvarName() not in names
            ]
        self.left_out: list[str] = []
        """The contents that no column has."""
        painted_attrs = self.painted
        for primvar in (*self._primvars, *self._instance_primvars):
            if primvar.ValueMightBeTimeVarying() and primvar.GetAttr() not in painted_attrs:
                self.left_out.append(f"how {primvar.GetPrimvarName()} changes")

    @cached_property
    def counts(self) -> Ints:
        counts = np.array(self.counts_attr.Get(self.time) or [], np.int64)
        corners = self.rows["corner"]
        if (counts < 0).any() or counts.sum() != corners:
            raise FormatError(
                f"the faces of {self.prim.GetPath()} have {corners} corners, not {counts.sum()}"
            )
        return counts

    @cached_property
    def corners(self) -> Ints:
        return np.array(self.corners_attr.Get(self.time) or [], np.int64)

    @cached_property
    def columns(self) -> list[Column]:
        """The primvars that a mesh has; a displayOpacity is the fourth number of the displayColor."""
        columns = {column.name: column for column in self._columns()}
        color = columns.get(_SHADES["displayColor"])
        opacity = columns.get(_SHADES["displayOpacity"])
        if (
            color is None
            or opacity is None
            or color.domain != opacity.domain
            or color.semantic != "color"
        ):
            return [*columns.values()]
        shades = np.hstack([shares_of(_rows(color)[:, :3]), _rows(opacity)])
        indices: Ints | None = None
        if color.indices is not None:
            indices = np.arange(len(shades))
        columns[color.name] = replace(color, values=srgb_colors(to_linear(shades)), indices=indices)
        del columns[opacity.name]
        return [*columns.values()]

    @property
    def painted(self) -> list[Any]:
        """The primvars of vertices that change."""
        attributes: list[Any] = []
        for primvar in self._primvars:
            at_vertices = _DOMAINS.get(primvar.GetInterpolation()) == "vertex"
            if at_vertices and not str(primvar.GetTypeName()).startswith("texCoord"):
                attributes.append(primvar.GetAttr())
        return [attribute for attribute in attributes if attribute.GetNumTimeSamples() > 1]

    @cached_property
    def holes(self) -> Ints:
        """The faces that are holes."""
        indices = self._pxr.UsdGeom.Mesh(self.prim).GetHoleIndicesAttr().Get(self.time)
        holes = np.array(indices or [], np.int64)
        return holes[(holes >= 0) & (holes < self.rows["face"])]

    def _columns(self) -> Iterator[Column]:
        for primvar in self._instance_primvars:
            column = self._instance_column(primvar)
            if column is None:
                self.left_out.append(str(primvar.GetPrimvarName()))
            else:
                yield column
        for primvar in self._primvars:
            value = primvar.Get(self.time)
            if value is None:
                continue
            column = self._column(primvar, np.array(value))
            if column is None:
                self.left_out.append(str(primvar.GetPrimvarName()))
            else:
                yield column

    def _column(self, primvar: Any, values: Array) -> Column | None:
        """Return the values of a primvar as a column; None if attributes cannot have them."""
        name, kind = str(primvar.GetPrimvarName()), str(primvar.GetTypeName())
        domain = _DOMAINS.get(primvar.GetInterpolation())
        # One color for a whole mesh would be lost where parts are joined, so its vertices have it.
        if primvar.GetInterpolation() == "constant" and name in _SHADES and len(values) == 1:
            domain = "vertex"
            values = np.repeat(values, self.vertices, axis=0)
        if domain is None or not kind.endswith("[]") or name == "normals":
            return None
        if values.ndim == 1:
            values = values[:, None]
        if values.dtype.kind not in "iuf" or values.ndim != 2 or values.shape[1] > MOST_COMPONENTS:
            return None
        rows = np.array(primvar.GetIndices(self.time) or np.arange(len(values)), np.int64)
        if len(rows) != self.rows[domain] or not 0 <= rows.min(initial=0) <= rows.max(
            initial=0
        ) < len(values):
            return None
        attribute_name, values, semantic = _interpret(name, kind, values)
        if domain == "corner":
            return Column(attribute_name, values, domain, semantic, rows)
        return Column(attribute_name, values[rows], domain, semantic)

    def _instance_column(self, primvar: Any) -> Column | None:
        """Return the value that an instancer has for this instance, at all of its vertices or faces."""
        assert self._instance is not None
        name, kind = str(primvar.GetPrimvarName()), str(primvar.GetTypeName())
        value = primvar.ComputeFlattened(self.time)
        if value is None:
            value = []
        values = np.array(value)
        number = self._instance.number
        if values.ndim and len(values) == self._instance.instancer.count(self.time):
            values = values[number : number + 1]
        values = values.reshape(1, -1)
        if (
            not kind.endswith("[]")
            or values.dtype.kind not in "iuf"
            or not 1 <= values.size <= MOST_COMPONENTS
        ):
            return None
        domain: Domain = "face"
        if name in _SHADES:
            domain = "vertex"
        attribute_name, values, semantic = _interpret(name, kind, values)
        return Column(
            attribute_name, np.repeat(values, self.rows[domain], axis=0), domain, semantic
        )


def source_paths(pxr: Any, prim: Any) -> tuple[str, ...]:
    """Return the paths of a mesh and of its primvars, with those of prototypes in place of their instances."""
    owners = [prim, *(primvar.GetAttr().GetPrim() for primvar in authored_primvars(pxr, prim))]
    paths: list[str] = []
    for owner in owners:
        if owner.IsInstanceProxy():
            owner = owner.GetPrimInPrototype()
        paths.append(str(owner.GetPath()))
    return tuple(paths)


def _rows(column: Column) -> Array:
    """Return the values of a column, one for each element of its domain."""
    return column.values if column.indices is None else column.values[column.indices]


def _interpret(name: str, kind: str, values: Array) -> tuple[str, Array, Semantic]:
    """Return the name of a primvar as an attribute, its values, and their meaning."""
    if kind.startswith(("color3", "color4")):
        name = _SHADES.get(name, name)
        if values.size and 0 <= values.min() <= values.max() <= 1:
            return name, srgb_colors(values), "color"
        return name, values, "generic"
    if kind.startswith("texCoord2") or (name in ("st", "uv", "UVMap") and values.shape[1] == 2):
        if name in ("st", "UVMap"):
            name = "texcoord"
        return name, values, "texcoord"
    return name, values, "generic"
