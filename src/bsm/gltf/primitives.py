"""Primitives of a scene as meshes, and as what decoders of their streams draw."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.gltf.document import Document, Tree

_TRIANGLES = 4
_FLOAT = 5126
_SEMANTICS = {"NORMAL": ("normal", 3), "TEXCOORD_0": ("texcoord", 2), "TEXCOORD_1": ("texcoord", 2)}
_LARGEST = {np.dtype(np.uint8): 255, np.dtype(np.uint16): 65535}


@dataclass(frozen=True, eq=False)
class Coded:
    """A primitive as a mesh, its bytes now, and the accessors of decoded arrays: component type, normalized or not."""

    mesh: TriangleMesh
    accessors: dict[str, tuple[int, bool]]
    size: int


def as_mesh(document: Document, primitive: Tree) -> Coded | str:
    """A primitive as a mesh, or why it stays as it is."""
    if primitive.get("mode", _TRIANGLES) != _TRIANGLES:
        return "no triangles"
    if primitive.get("targets"):
        return "morph targets"
    names = primitive["attributes"]
    arrays = {name: document.array(index) for name, index in names.items()}
    if any(array is None for array in arrays.values()):
        return "accessors without plain bytes"
    positions = arrays.get("POSITION")
    if positions is None or positions.dtype != np.float32 or not np.isfinite(positions).all():
        return "positions that are not plain floats"
    indices = np.arange(len(positions))[:, None]
    if "indices" in primitive:
        found = document.array(primitive["indices"])
        if found is None:
            return "accessors without plain bytes"
        indices = found
    if len(indices) % 3 or not len(indices) or indices.max() >= len(positions):
        return "indices that are no triangles"
    attributes, accessors = [], {"POSITION": (_FLOAT, False)}
    for name, array in arrays.items():
        if name == "POSITION" or array is None:
            continue
        if len(array) != len(positions):
            return "attributes of different lengths"
        carried = _carried(name, array, bool(document.tree["accessors"][names[name]].get("normalized")))
        if carried is None:
            return f"{name}, which streams do not carry as it is"
        attributes.append(carried[0])
        accessors[name] = carried[1:]
    faces = indices.reshape(-1, 3).astype(np.int32)
    size = sum(array.nbytes for array in arrays.values() if array is not None)
    size += indices.nbytes if "indices" in primitive else 0
    return Coded(TriangleMesh(positions.astype(np.float64), faces, tuple(attributes), {}), accessors, size)


def _carried(name: str, array: npt.NDArray[Any], normalized: bool) -> tuple[Attribute, int, bool] | None:
    """An attribute as a stream carries it, and the accessor of what is decoded."""
    is_float = array.dtype == np.float32
    if is_float and not np.isfinite(array).all():
        return None
    if name in _SEMANTICS:
        semantic, width = _SEMANTICS[name]
        if not is_float or array.shape[1] != width:
            return None
        return Attribute(name, array, "vertex", "normal" if semantic == "normal" else "texcoord"), _FLOAT, False
    if name == "COLOR_0" and (is_float or (normalized and array.dtype in _LARGEST)):
        if is_float and (array.min() < 0 or array.max() > 1):
            return None
        return Attribute(name, array, "vertex", "color"), _FLOAT, False
    if name in ("JOINTS_0", "JOINTS_1") and array.dtype in _LARGEST:
        return Attribute(name, array), 5121 if array.dtype == np.uint8 else 5123, False
    if name == "WEIGHTS_0":
        weights = _eighths(array / np.float64(1 if is_float else _LARGEST.get(array.dtype, 1)))
        return Attribute(name, weights), 5121, True
    return None


def _eighths(weights: npt.NDArray[np.float64]) -> npt.NDArray[np.uint8]:
    """Weights as bytes whose sum is 255, as that of the weights is 1."""
    levels = np.floor(weights / np.maximum(weights.sum(axis=1, keepdims=True), 1e-9) * 255)
    levels[np.arange(len(levels)), weights.argmax(axis=1)] += 255 - levels.sum(axis=1)
    rounded: npt.NDArray[np.uint8] = np.clip(levels, 0, 255).astype(np.uint8)
    return rounded


@dataclass(frozen=True, eq=False)
class Drawn:
    """What a decoder makes of a stream: three vertices for each face, and what each vertex has, by names of glTF."""

    index: npt.NDArray[np.uint32]
    arrays: dict[str, npt.NDArray[Any]]

    @property
    def vertices(self) -> int:
        """How many there are."""
        return len(self.arrays["POSITION"])

    @property
    def corners(self) -> int:
        """Three for each face."""
        return len(self.index)

    @property
    def box(self) -> tuple[list[float], list[float]]:
        """The least and the largest coordinates."""
        used = self.arrays["POSITION"]
        return used.min(axis=0).astype(float).tolist(), used.max(axis=0).astype(float).tolist()


def drawn(mesh: TriangleMesh) -> Drawn:
    """Draw as the extension defines: a vertex for each vertex and values of attributes that meet at a corner."""
    corners = mesh.faces.ravel()
    parting = {a.name: a.indices.ravel() for a in mesh.attributes if a.indices is not None}
    vertices: npt.NDArray[np.integer[Any]] = np.arange(len(mesh.positions))
    rows: npt.NDArray[np.integer[Any]] = corners
    values = {a.name: a.values for a in mesh.attributes}
    if parting:
        different, rows = np.unique(np.stack([corners, *parting.values()], axis=1), axis=0, return_inverse=True)
        vertices = different[:, 0]
        values |= {name: values[name][different[:, column]] for column, name in enumerate(parting, 1)}
    for name in values.keys() - parting.keys():
        values[name] = values[name][vertices]
    arrays = {"POSITION": mesh.positions.astype(np.float32)[vertices], **values}
    return Drawn(rows.ravel().astype(np.uint32), arrays)


Coder = Callable[[TriangleMesh], bytes]
