"""Primitives of a scene as meshes, what decoders of their streams draw, and which of them one stream holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.geometry.attributes import Attribute, Semantic
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.decoder import decode
from bsm.gltf.document import COMPONENTS, PER_NUMBER, Document, Tree

_TRIANGLES = 4
_FLOAT, _UBYTE = COMPONENTS["float32"], COMPONENTS["uint8"]
_SEMANTICS: dict[str, tuple[Semantic, int]] = {
    "NORMAL": ("normal", 3),
    "TEXCOORD_0": ("texcoord", 2),
    "TEXCOORD_1": ("texcoord", 2),
}
_LARGEST = {np.dtype(np.uint8): 255, np.dtype(np.uint16): 65535}
_PIECE = "material"
"""The attribute of faces by which decoders sort them."""
_GRID = 2.0**-15
"""How far targets may move vertices wrongly, of the mesh's largest extent: as a grid of 14 bits."""
_QUALITIES = {
    "NORMAL": "10bits",
    "TANGENT": "9bits",
    "TEXCOORD_0": "12bits",
    "TEXCOORD_1": "12bits",
    "COLOR_0": "8bits",
}
_TURN = "0.002"
"""Of what targets add to directions: a tenth of a degree."""


@dataclass(frozen=True, eq=False)
class Carried:
    """Primitives as one mesh, and the accessors of decoded arrays: component type, normalized or not."""

    mesh: TriangleMesh
    accessors: dict[str, tuple[int, bool]]
    qualities: dict[str, str]


def arrays_of(primitive: Tree) -> dict[str, int]:
    """Accessors of what each vertex of a primitive has; those of morph targets are called "0/POSITION" and so on."""
    targets = enumerate(primitive.get("targets", []))
    added = {f"{number}/{name}": index for number, target in targets for name, index in target.items()}
    return dict(primitive["attributes"]) | added


def like(document: Document, primitive: Tree) -> str:
    """A key that is equal for primitives which one stream can hold."""
    told = [(name, document.tree["accessors"][index]) for name, index in sorted(arrays_of(primitive).items())]
    kinds = [(name, one["componentType"], one["type"], one.get("normalized", False)) for name, one in told]
    return str((kinds, primitive.get("mode", _TRIANGLES)))


def as_mesh(document: Document, primitives: Sequence[Tree]) -> Carried | str:
    """Primitives that are alike as one mesh, or why they stay as they are."""
    if primitives[0].get("mode", _TRIANGLES) != _TRIANGLES:
        return "no triangles"
    _check_room(document, primitives)
    tables: dict[str, int] = {}  # where the vertices of which accessors begin
    parts: list[dict[str, npt.NDArray[Any]]] = []
    faces: list[npt.NDArray[np.int64]] = []
    count = 0
    for primitive in primitives:
        key = str(sorted(arrays_of(primitive).items()))
        if key not in tables:
            found = _vertices(document, primitive)
            if isinstance(found, str):
                return found
            parts.append(found)
            tables[key] = count
            count += len(found["POSITION"])
        indices = np.arange(count - tables[key])[:, None]
        if "indices" in primitive:
            given = document.array(primitive["indices"])
            if given is None:
                return "accessors without plain bytes"
            indices = given
        size = document.tree["accessors"][primitive["attributes"]["POSITION"]]["count"]
        if len(indices) % 3 or not len(indices) or indices.max() >= size:
            return "indices that are no triangles"
        faces.append(indices.reshape(-1, 3).astype(np.int64) + tables[key])
    used, corners = np.unique(np.concatenate(faces), return_inverse=True)
    arrays = {name: np.concatenate([part[name] for part in parts])[used] for name in parts[0]}
    positions = arrays.pop("POSITION")
    extent = float(np.ptp(positions, axis=0).max())
    attributes, accessors = [], {"POSITION": (_FLOAT, False)}
    qualities: dict[str, str] = {}
    for name, array in arrays.items():
        carried = _carried(name, array, _is_normalized(document, arrays_of(primitives[0])[name]))
        if carried is None:
            return f"{name}, which streams do not carry as it is"
        attributes.append(carried[0])
        accessors[name] = carried[1:]
        quality = _quality(name, array, extent)
        qualities |= {name: quality} if quality else {}
    if len(primitives) > 1:
        numbers = np.repeat(np.arange(len(faces)), [len(some) for some in faces])
        attributes.append(Attribute(_PIECE, numbers.astype(np.uint16), "face"))
    mesh = TriangleMesh(positions.astype(np.float64), corners.reshape(-1, 3).astype(np.int32), tuple(attributes), {})
    return Carried(mesh, accessors, qualities)


def _check_room(document: Document, primitives: Sequence[Tree]) -> None:
    """Bound what is made of accessors, which may share bytes."""
    given = {index for primitive in primitives for index in arrays_of(primitive).values()}
    numbers = sum(map(document.claimed, given))
    numbers += sum(document.claimed(primitive["indices"]) for primitive in primitives if "indices" in primitive)
    DEFAULT_LIMITS.check_memory(PER_NUMBER * numbers, 0, document.received)


def _vertices(document: Document, primitive: Tree) -> dict[str, npt.NDArray[Any]] | str:
    """What each vertex of a primitive has, or why that cannot be coded."""
    arrays: dict[str, npt.NDArray[Any]] = {}
    for name, index in arrays_of(primitive).items():
        array = document.array(index)
        if array is None:
            return "accessors without plain bytes"
        arrays[name] = _floats(array, _is_normalized(document, index)) if _is_geometry(name) else array
    positions = arrays.get("POSITION")
    if positions is None or positions.dtype != np.float32 or not np.isfinite(positions).all():
        return "positions that are not plain floats"
    if any(len(array) != len(positions) for array in arrays.values()):
        return "attributes of different lengths"
    return arrays


def _is_normalized(document: Document, index: int) -> bool:
    return bool(document.tree["accessors"][index].get("normalized"))


def _is_geometry(name: str) -> bool:
    base = name.rpartition("/")[2]
    return base in ("POSITION", "NORMAL", "TANGENT") or base.startswith("TEXCOORD_")


def _floats(array: npt.NDArray[Any], normalized: bool) -> npt.NDArray[Any]:
    """Short integers as what they stand for; any shape, float32 for these."""
    if array.dtype.itemsize > 2 or array.dtype.kind not in "iu":
        return array
    values = array.astype(np.float32)
    return np.maximum(values / np.iinfo(array.dtype).max, -1, dtype=np.float32) if normalized else values


def _quality(name: str, array: npt.NDArray[Any], extent: float) -> str | None:
    """What is asked of an attribute; None: what meshes have by themselves."""
    if array.dtype != np.float32:
        return None
    if name in _QUALITIES:
        return _QUALITIES[name]
    target, _, base = name.rpartition("/")
    if target and base == "POSITION":
        return repr(_GRID * extent) if extent > 0 else "exact"
    return _TURN if target and base in ("NORMAL", "TANGENT") else None


def _carried(name: str, array: npt.NDArray[Any], normalized: bool) -> tuple[Attribute, int, bool] | None:
    """An attribute as a stream carries it, and the accessor of what is decoded."""
    is_float = array.dtype == np.float32
    if is_float and not np.isfinite(array).all():
        return None
    if name in _SEMANTICS and is_float:
        semantic, width = _SEMANTICS[name]
        return (Attribute(name, array, "vertex", semantic), _FLOAT, False) if array.shape[1] == width else None
    if name == "COLOR_0" and (is_float or (normalized and array.dtype in _LARGEST)):
        if is_float and (array.min() < 0 or array.max() > 1):
            return None
        return Attribute(name, array, "vertex", "color"), _FLOAT, False
    if name == "WEIGHTS_0":
        weights = _eighths(array / np.float64(1 if is_float else _LARGEST.get(array.dtype, 1)))
        return Attribute(name, weights), _UBYTE, True
    if array[0].nbytes % 4:  # accessors keep their elements at multiples of four bytes
        return None
    return Attribute(name, array), COMPONENTS[array.dtype.name], normalized and not is_float


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
    labels: npt.NDArray[np.integer[Any]]

    @property
    def vertices(self) -> int:
        """How many there are."""
        return len(self.arrays["POSITION"])

    @property
    def corners(self) -> int:
        """Three for each face."""
        return len(self.index)

    @property
    def pieces(self) -> list[tuple[int, int]]:
        """For each primitive the first of its corners, and how many these are."""
        starts = np.searchsorted(self.labels, np.unique(self.labels))
        return [(int(start), int(end - start)) for start, end in pairwise([*starts, len(self.labels)])]


def drawn(mesh: TriangleMesh) -> Drawn:
    """Draw as the extension defines: a vertex for each vertex and values of attributes that meet at a corner."""
    named = {a.name: a.values[:, 0] for a in mesh.attributes if a.name == _PIECE and a.domain == "face"}
    labels = named.get(_PIECE, np.zeros(len(mesh.faces), np.int64))
    order = np.argsort(labels, kind="stable")
    corners = mesh.faces[order].ravel()
    attributes = [a for a in mesh.attributes if a.name not in named]
    parting = {a.name: a.indices[order].ravel() for a in attributes if a.indices is not None}
    vertices: npt.NDArray[np.integer[Any]] = np.arange(len(mesh.positions))
    rows: npt.NDArray[np.integer[Any]] = corners
    values = {a.name: a.values for a in attributes}
    if parting:
        different, rows = np.unique(np.stack([corners, *parting.values()], axis=1), axis=0, return_inverse=True)
        vertices = different[:, 0]
        values |= {name: values[name][different[:, column]] for column, name in enumerate(parting, 1)}
    for name in values.keys() - parting.keys():
        values[name] = values[name][vertices]
    arrays = {"POSITION": mesh.positions.astype(np.float32)[vertices], **values}
    return Drawn(rows.ravel().astype(np.uint32), arrays, np.repeat(labels[order], 3))


class Coder(Protocol):
    """Makes the stream of a mesh."""

    def __call__(self, mesh: TriangleMesh, *, attributes: dict[str, str]) -> bytes:
        """Its bytes; `attributes` is what is asked of some of its attributes."""


Bundle = list[list[Tree]]
"""Primitives of one mesh that one stream can hold, each with all others that are drawn of the same accessors."""


@dataclass(frozen=True, eq=False)
class BundleStream:
    """The stream of a bundle, what is drawn of it, and the accessors of that: component type, normalized or not."""

    stream: bytes
    shape: Drawn
    accessors: dict[str, tuple[int, bool]]


def code_bundle(document: Document, bundle: Bundle, coder: Coder) -> BundleStream | str:
    """A bundle coded, or why it cannot be."""
    found = as_mesh(document, [same[0] for same in bundle])
    if isinstance(found, str):
        return found
    try:
        stream = coder(found.mesh, attributes=found.qualities)
    except BsmError as error:
        return f"no stream: {error}"
    shape = drawn(decode(stream))
    if len(shape.pieces) != len(bundle):
        return "faces that are none"
    return BundleStream(stream, shape, found.accessors)


def _accessors_of(primitive: Tree) -> dict[str, int]:
    return arrays_of(primitive) | ({"": primitive["indices"]} if "indices" in primitive else {})


def bundles_of(document: Document, tree: Tree) -> list[Bundle]:
    """The primitives of a tree, each in one bundle; `document` has the same accessors."""
    known: dict[str, list[Tree]] = {}
    bundles: list[Bundle] = []
    for mesh in tree.get("meshes", []):
        alike: dict[str, Bundle] = {}
        for primitive in mesh["primitives"]:
            key = str((sorted(_accessors_of(primitive).items()), primitive.get("mode")))
            if key not in known:
                known[key] = []
                alike.setdefault(like(document, primitive), []).append(known[key])
            known[key].append(primitive)
        bundles += alike.values()
    return bundles


def size_of(bundle: Bundle) -> int:
    """How many primitives are drawn of it."""
    return sum(len(same) for same in bundle)


def users_of(bundles: list[Bundle], tree: Tree) -> dict[int, set[int]]:
    """Which bundles use each accessor; -1: an animation or a skin."""
    users: dict[int, set[int]] = {}
    for number, bundle in enumerate(bundles):
        for same in bundle:
            for index in _accessors_of(same[0]).values():
                users.setdefault(index, set()).add(number)
    samplers = [sampler for animation in tree.get("animations", []) for sampler in animation["samplers"]]
    used = [sampler[end] for sampler in samplers for end in ("input", "output")]
    used += [skin["inverseBindMatrices"] for skin in tree.get("skins", []) if "inverseBindMatrices" in skin]
    for index in used:
        users.setdefault(index, set()).add(-1)
    return users


def that_share(bundles: list[Bundle], users: dict[int, set[int]]) -> list[list[int]]:
    """Numbers of bundles, those together that share accessors, if only by others."""
    groups = {number: {number} for number in range(len(bundles))}
    for numbers in users.values():
        joined = set().union(*(groups[number] for number in numbers if number >= 0))
        for number in joined:
            groups[number] = joined
    return [sorted(group) for number, group in groups.items() if number == min(group)]
