"""Primitives of glTF that one stream can hold: their meshes, qualities and streams."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.decoding import decode
from bsm.codec.geometry.attributes import Attribute, Semantic
from bsm.codec.geometry.graph import components, graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import degenerate, group_rows, weld
from bsm.encoding.given import given_part
from bsm.files.conventions import shares_of
from bsm.gltf import document as gltf
from bsm.gltf.coding import COMPONENTS, DRACO, FLOAT, PIECE, TRANSFORM, TRIANGLES, TRIANGULAR, Array, Drawn, Tree, drawn
from bsm.ground.console import Progress

_TEXCOORD: tuple[Semantic, int] = ("texcoord", 2)
_SEMANTICS = {"NORMAL": ("normal", 3), "TEXCOORD_0": _TEXCOORD, "TEXCOORD_1": _TEXCOORD}
_GRID = 2.0**-15  # how far targets may move vertices wrongly, of the mesh's largest extent: as a grid of 14 bits
# Normals and colors as gltf-transform quantizes them for Draco, so that results compare.
_QUALITIES = {"NORMAL": "10bits", "TANGENT": "9bits", "COLOR_0": "8bits"}
_TURN = "0.002"  # of what targets add to directions: a tenth of a degree
_COARSEST, _FINEST = 12, 22  # bits of texture coordinates; with more, they are exact
_TEXELS, _SIDE = 0.25, 2048  # how many texels they may be off, and pixels of the side of an image that is not known
# Below, an accessor of its own type takes more JSON than it saves.
_SHORT = 1 << 10  # indices from which on 16 bits of each are worth their words
# Beyond this, an identifier that is stored as a float has already lost its last digit.
WHOLE = 2**24  # up to which single precision has all whole numbers


@dataclass(frozen=True, eq=False)
class Carried:
    """Primitives as one mesh, and the accessors of decoded arrays: component type, normalized or not."""

    mesh: TriangleMesh
    accessors: dict[str, tuple[int, bool]]
    qualities: dict[str, str]
    opens: bool  # whether targets or skins open faces without area


def arrays_of(primitive: Tree) -> dict[str, int]:
    """Accessors of what each vertex of a primitive has; those of morph targets are called "0/POSITION" and so on."""
    targets = enumerate(primitive.get("targets", []))
    added = {f"{number}/{name}": index for number, target in targets for name, index in target.items()}
    return dict(primitive["attributes"]) | added


# One stream has one type for each attribute, so only primitives with equal types share one.
def like(document: gltf.Document, primitive: Tree) -> str:
    """A key that is equal for primitives which one stream can hold."""
    accessors = [(name, document.item("accessors", index)) for name, index in sorted(arrays_of(primitive).items())]
    return str([(name, a["componentType"], a["type"], a.get("normalized", False)) for name, a in accessors])


def as_mesh(document: gltf.Document, bundle: Bundle, *, exact: bool = False) -> Carried | str:
    """Primitives that are alike as one mesh, or why they stay as they are."""
    primitives = [same[0] for same in bundle]
    if isinstance(joined := _joined(document, primitives), str):
        return joined
    arrays, corners, sizes = joined
    # Encoders leave out faces without area. Where a skin or a target opens such a face, it must stay.
    opens = _opens(arrays, corners)
    positions = arrays.pop("POSITION")
    entries = {name: document.item("accessors", index) for name, index in arrays_of(primitives[0]).items()}
    # Weights must sum to 1, or a skinned vertex drifts; rounding each by itself breaks that.
    if not exact:
        arrays |= _levels({name: array for name, array in arrays.items() if name.startswith("WEIGHTS_")})
    attributes, accessors, qualities = [], {"POSITION": (FLOAT, False)}, dict[str, str]()
    # Tangents are turned from the normals and texture coordinates that come before them.
    for name, array in sorted(arrays.items(), key=lambda entry: entry[0] == "TANGENT"):
        normalized = bool(entries[name].get("normalized")) or (name.startswith("WEIGHTS_") and not exact)
        carried = _carried(name, array, normalized)
        if isinstance(carried, str):
            return carried
        attributes.append(carried[0])
        accessors[name] = carried[1:]
        if carried[0].values.dtype.kind == "f" and not exact:
            extent = float(np.ptp(positions, axis=0).max())
            of_name = _quality(name, array, extent, lambda name: _texel(document, bundle, name))
            qualities |= {name: of_name} if of_name else {}
    if len(primitives) > 1:
        numbers = np.repeat(np.arange(len(sizes)), sizes)
        # One stream for many primitives: a head costs as much as a small mesh. The label tells where each begins.
        attributes.append(Attribute(PIECE, numbers.astype(np.uint16), "face"))
    mesh = TriangleMesh(positions.astype(np.float64), corners.astype(np.int32), tuple(attributes), {})
    return Carried(mesh, accessors, qualities, opens)


def _joined(
    document: gltf.Document, primitives: list[Tree]
) -> tuple[dict[str, Array], npt.NDArray[np.int64], list[int]] | str:
    """The arrays of all vertices, the faces, and how many each primitive has; or why they stay as they are."""
    combined = {str(sorted(arrays_of(primitive).items())): arrays_of(primitive) for primitive in primitives}
    indexes = [index for arrays in combined.values() for index in arrays.values()]
    indexes += [primitive["indices"] for primitive in primitives if "indices" in primitive]
    # Accessors may share bytes.
    DEFAULT_LIMITS.check_memory(gltf.PER_NUMBER * sum(map(document.claimed, indexes)), 0, document.received)
    begins, parts, faces, count = dict[str, int](), list[dict[str, Array]](), list[npt.NDArray[np.int64]](), 0
    for key, arrays in combined.items():  # each combination of accessors is made once
        if isinstance(arrays_or_reason := _vertices(document, arrays), str):
            return arrays_or_reason
        parts.append(arrays_or_reason)
        begins[key] = count
        count += len(arrays_or_reason["POSITION"])
    for primitive in primitives:
        triangles = gltf.triangles_of(document, primitive, document.count(primitive["attributes"]["POSITION"]))
        if not len(triangles):
            return "no triangles"
        faces.append(triangles + begins[str(sorted(arrays_of(primitive).items()))])
    # Vertices that no face uses are not drawn, and not sent.
    used, corners = np.unique(np.concatenate(faces), return_inverse=True)
    combined_arrays = {name: np.concatenate([part[name] for part in parts])[used] for name in parts[0]}
    return combined_arrays, corners.reshape(-1, 3), list(map(len, faces))


def _vertices(document: gltf.Document, indexes: Mapping[str, int]) -> dict[str, Array] | str:
    """What each vertex has by these accessors, or why that cannot be coded."""
    arrays: dict[str, Array] = {}
    for name, index in indexes.items():
        array, normalized = document.array(index), bool(document.item("accessors", index).get("normalized"))
        geometry = name.rpartition("/")[2].startswith(("POSITION", "NORMAL", "TANGENT", "TEXCOORD_"))
        narrow = normalized and (name.startswith("_") or array[0].nbytes % 4 > 0)
        if (geometry or narrow) and array.dtype.itemsize <= 2:
            values = array.astype(np.float32)
            # Quantized geometry is coded as the floats that it means, or the grid of the stream would be laid over
            # another grid.
            array = np.maximum(values / np.iinfo(array.dtype).max, -1, dtype=np.float32) if normalized else values
        arrays[name] = array
    positions = arrays.get("POSITION")
    if positions is None or positions.dtype != np.float32 or not np.isfinite(positions).all():
        return "positions that are not finite floats"
    if any(len(array) != len(positions) for array in arrays.values()):
        return "attributes of different lengths"
    return arrays


def _opens(arrays: Mapping[str, Array], faces: npt.NDArray[np.int64]) -> bool:
    """Whether vertices that make a face without area, being at one place, part by targets or joints."""
    moved = [a for name, a in arrays.items() if name.endswith("/POSITION") or name.startswith(("JOINTS_", "WEIGHTS_"))]
    positions = arrays["POSITION"].astype(np.float64)
    triangles = weld(positions, faces.astype(np.int32))[1]
    closed = degenerate(triangles) & ~degenerate(faces)
    if not moved or not closed.any():
        return False
    alike = group_rows(np.ascontiguousarray(np.column_stack([positions, *moved]), np.float64))
    return bool((closed & ~degenerate(alike[faces])).any())


def _levels(weights: Mapping[str, Array]) -> dict[str, Array]:
    """Weights of all sets as bytes whose sum is 255, as that of the weights is 1."""
    if not weights:
        return {}
    table = np.hstack([shares_of(array) for array in weights.values()])
    total = table.sum(axis=1, keepdims=True)
    exact = np.where(total > 0, table / np.maximum(total, 1e-30) * 255, 0)
    levels = np.floor(exact)
    # The method of largest remainders, as parliaments are seated: the sum is exact, and no weight is off by a whole
    # level.
    ranks = np.argsort(np.argsort(levels - exact, axis=1, kind="stable"), axis=1)
    levels += ranks < np.where(total > 0, 255, 0) - levels.sum(axis=1, keepdims=True)  # the largest remainders go up
    ends = np.cumsum([array.shape[1] for array in weights.values()])[:-1]
    return dict(zip(weights, np.split(levels.astype(np.uint8), ends, axis=1), strict=True))


def _quality(name: str, array: Array, extent: float, texel: Callable[[str], float]) -> str | None:
    """The quality of an attribute of floats; None: that which meshes have by default."""
    target, _, base = name.rpartition("/")
    if base.startswith("TEXCOORD_"):
        # As many bits as a quarter of a texel of the largest image needs.
        bits = math.ceil(math.log2(max(float(np.ptp(array, axis=0).max()) / (2 * _TEXELS * texel(base)), 1.0)))
        return f"{max(bits, _COARSEST)}bits" if bits <= _FINEST else "exact"
    if name in _QUALITIES:
        return _QUALITIES[name]
    if target and base == "POSITION":
        return repr(_GRID * extent) if extent > 0 else "exact"
    return _TURN if target and base in ("NORMAL", "TANGENT") else None


def _texel(document: gltf.Document, bundle: Bundle, name: str) -> float:
    """The side of the smallest texel of the images that a set of texture coordinates places."""
    sides = [1.0 * _SIDE]
    for index in {primitive.get("material") for same in bundle for primitive in same} - {None}:
        material = document.item("materials", index)
        groups = [material, material.get("pbrMetallicRoughness", {}), *material.get("extensions", {}).values()]
        textures = [value for group in groups for key, value in group.items() if key.endswith("Texture")]
        for info in textures:
            moved = info.get("extensions", {}).get(TRANSFORM, {})
            if f"TEXCOORD_{moved.get('texCoord', info.get('texCoord', 0))}" == name:
                sides.append(document.side_of_texture(info["index"], _SIDE) * max(map(abs, moved.get("scale", [1.0]))))
    return 1.0 / max(sides[1:] or sides, default=_SIDE)


def _carried(name: str, array: Array, normalized: bool) -> tuple[Attribute, int, bool] | str:
    """Return an attribute for a stream, and the accessor of the decoded values; or why it cannot be coded."""
    is_float = array.dtype == np.float32
    if is_float and not np.isfinite(array).all():
        return f"{name} has numbers that are not finite"
    if name in _SEMANTICS and is_float:
        semantic, width = _SEMANTICS[name]
        attribute = Attribute(name, array, "vertex", semantic) if array.shape[1] == width else None
        return (
            (attribute, FLOAT, False)
            if attribute
            else f"{name} has {array.shape[1]} numbers for each vertex, not {width}"
        )
    if name == "COLOR_0":
        if (is_float and (array.min() < 0 or array.max() > 1)) or not (is_float or array.dtype.kind == "u"):
            return "COLOR_0 has numbers that are not between 0 and 1"
        return Attribute(name, array, "vertex", "color"), FLOAT, False
    # Integers are coded without loss, and identifiers are wrong if they are off at all.
    if is_float and (array == np.rint(array)).all() and np.abs(array).max() <= WHOLE:  # identifiers, mostly
        return Attribute(name, array.astype(np.int32)), FLOAT, False
    if array[0].nbytes % 4:  # accessors keep their elements at multiples of four bytes; floats hold such integers
        return Attribute(name, array), FLOAT, False
    return Attribute(name, array), COMPONENTS[array.dtype.name], normalized and not is_float


Bundle = list[list[Tree]]
"""Primitives of one mesh that one stream can hold, each with all others that are drawn of the same accessors."""


@dataclass(frozen=True, eq=False)
class BundleStream:
    """The stream of a bundle, its drawn arrays, and the accessors: component type, normalized or not."""

    stream: bytes
    shape: Drawn
    accessors: dict[str, tuple[int, bool]]
    error: tuple[float, float]  # the largest of a vertex, and the largest of the diagonal of its component
    notes: tuple[str, ...]


def code_bundle(mesh_or_reason: Carried | str, pieces: int, options: Mapping[str, Any]) -> BundleStream | str:
    if isinstance(mesh_or_reason, str):
        return mesh_or_reason
    names = {"*", *(attribute.name for attribute in mesh_or_reason.mesh.attributes)}
    qualities_asked = {name: quality for name, quality in options.get("attributes", {}).items() if name in names}
    qualities = {} if "*" in qualities_asked else mesh_or_reason.qualities
    order = {"keep_order": True} if mesh_or_reason.opens else {}
    try:
        part_options = {"threads": 1, **options, **order, "attributes": {**qualities, **qualities_asked}}
        coded = given_part(mesh_or_reason.mesh, **part_options).encode(Progress(""))
        encoder, stream = coded.encoder, b"".join(coded.attempt.frames)
        decoded = decode(stream)
    # One primitive that cannot be coded stays as it is; the scene does not fail for it.
    except BsmError as error:
        return f"no stream: {error}"
    shape = drawn(decoded)
    if len(shape.pieces) != pieces:
        return "no face has an area"
    # Measured on what decoders give, so that the figure of the command is that of `bsm compare`.
    off = error_of(mesh_or_reason.mesh.positions[encoder.vertex_order], decoded)
    accessors = {name: mesh_or_reason.accessors[name] for name in shape.arrays}
    if len(shape.index) >= _SHORT and shape.index.max() < 65535:
        accessors["indices"] = (COMPONENTS["uint16"], False)
    return BundleStream(stream, shape, accessors, off, encoder.losses)


def accessors_of(primitive: Tree) -> dict[str, int]:
    return arrays_of(primitive) | ({"": primitive["indices"]} if "indices" in primitive else {})


def bundles_of(document: gltf.Document, tree: Tree, reasons: Counter[str]) -> list[Bundle]:
    """The primitives of a tree that can be coded, each in one bundle; `left` counts why others are not."""
    primitives_by_key: dict[str, list[Tree]] = {}
    bundles: list[Bundle] = []
    for mesh in tree.get("meshes", []):
        alike: dict[str, Bundle] = {}
        for primitive in mesh["primitives"]:
            if why := _why_left(document, mesh, primitive):
                reasons[why] += 1
                continue
            key = str((sorted(accessors_of(primitive).items()), primitive.get("mode")))
            # Two primitives of the same accessors are one set of triangles with two materials, and are coded once.
            if key not in primitives_by_key:
                primitives_by_key[key] = []
                alike.setdefault(like(document, primitive), []).append(primitives_by_key[key])
            primitives_by_key[key].append(primitive)
        bundles += alike.values()
    return bundles


_KNOWN = ("KHR_materials_variants", "EXT_mesh_features", "EXT_structural_metadata", DRACO)
"""Extensions of primitives that name no vertices, but for features without an attribute or a texture."""
OF_LOOKS = re.compile(
    r"KHR_(materials|texture|lights|xmp|node|animation_pointer|mesh_quantization)\w*|EXT_(texture|lights|mesh_features)\w*"
    r"|MSFT_(texture|lod|packing)\w*|ADOBE_materials\w*|CESIUM_RTC|AGI_\w+|VRMC?(_\w+)?"
)
"""Extensions that name no accessors and no bufferViews."""


def _why_left(document: gltf.Document, mesh: Tree, primitive: Tree) -> str | None:
    if primitive.get("mode", TRIANGLES) not in TRIANGULAR:
        return "points or lines"
    accessors = [document.item("accessors", index) for index in accessors_of(primitive).values()]
    unknown_names = [name for name in mesh.get("extensions", {}) if not OF_LOOKS.fullmatch(name)]
    unknown_names += [name for entry in accessors for name in entry.get("extensions", {})]
    unknown_names += [name for name in primitive.get("extensions", {}) if name not in _KNOWN]
    features = primitive.get("extensions", {}).get("EXT_mesh_features", {}).get("featureIds", [])
    unknown_names += ["EXT_mesh_features" for entry in features if not {"attribute", "texture"} & entry.keys()]
    if unknown_names:
        # A stream orders vertices anew. An extension that counts on their old numbers would point to others.
        return f"{unknown_names[0]} may name vertices"
    views = (document.item("bufferViews", entry["bufferView"]) for entry in accessors if "bufferView" in entry)
    packed = [name for view in views for name in sorted(document.unread_in(view))]
    return f"{packed[0]} may hold other bytes" if packed else None


def error_of(positions: Array, decoded: TriangleMesh) -> tuple[float, float]:
    """The largest error of a vertex, and the largest as a share of the diagonal of its component."""
    errors = np.linalg.norm(decoded.positions - positions, axis=1)
    labels = components(graph_of_faces(decoded.faces, len(errors)))
    order = np.argsort(labels, kind="stable")
    starts = np.searchsorted(labels[order], np.arange(labels.max() + 1))
    low, high = (way.reduceat(positions[order], starts, axis=0) for way in (np.minimum, np.maximum))
    farthest, diagonals = np.maximum.reduceat(errors[order], starts), np.linalg.norm(high - low, axis=1)
    return float(errors.max()), float((farthest / np.where(diagonals > 0, diagonals, np.inf)).max())
