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

from bsm.bitstream.container.header import RECOMPUTED
from bsm.bitstream.container.packets import Declared
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
from bsm.gltf.coding import (
    COMPONENTS,
    DRACO,
    FLOAT,
    PIECE,
    TRANSFORM,
    TRIANGLES,
    TRIANGULAR,
    Array,
    Drawn,
    Tree,
    drawn,
    set_of,
)
from bsm.ground.console import Progress

_TEXCOORD: tuple[Semantic, int] = ("texcoord", 2)
_SEMANTICS = {"NORMAL": ("normal", 3), "TEXCOORD_0": _TEXCOORD, "TEXCOORD_1": _TEXCOORD}
# How far targets may move vertices wrongly, of the mesh's largest extent: as a grid of 14 bits.
_GRID = 2.0**-15
# Normals and colors as gltf-transform quantizes them for Draco, so that results compare.
_QUALITIES = {"NORMAL": "10bits", "TANGENT": "9bits", "COLOR_0": "8bits"}
_TURN = "0.002"  # of what targets add to directions: a tenth of a degree
_COARSEST, _FINEST = 12, 22  # bits of texture coordinates; with more, they are exact
# How many texels they may be off, and pixels of the side of an image that is not known.
_TEXELS, _SIDE = 0.25, 2048
# Below, an accessor of its own type takes more JSON than it saves.
_SHORT = 1 << 10  # indices from which on 16 bits of each are worth their words
COMPUTED = "normals are not stored: decoders compute them, within 1 degree"
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
    arrays: dict[str, int] = dict(primitive["attributes"])
    for number, target in enumerate(primitive.get("targets", [])):
        arrays |= {f"{number}/{name}": index for name, index in target.items()}
    return arrays


# One stream has one type for each attribute, so only primitives with equal types share one.
def like(document: gltf.Document, primitive: Tree) -> str:
    """A key that is equal for primitives which one stream can hold."""
    key: list[tuple[Any, ...]] = []
    for name, index in sorted(arrays_of(primitive).items()):
        accessor = document.item("accessors", index)
        key.append(
            (name, accessor["componentType"], accessor["type"], accessor.get("normalized", False))
        )
    return str(key)


def as_mesh(document: gltf.Document, bundle: Bundle, *, exact: bool = False) -> Carried | str:
    """Primitives that are alike as one mesh, or why they stay as they are."""
    primitives = [same[0] for same in bundle]
    joined = _joined(document, primitives)
    if isinstance(joined, str):
        return joined
    arrays, corners, sizes = joined
    # Encoders leave out faces without area. Where a skin or a target opens such a face, it must stay.
    opens = _opens(arrays, corners)
    positions = arrays.pop("POSITION")
    extent = float(np.ptp(positions, axis=0).max())
    entries = {
        name: document.item("accessors", index) for name, index in arrays_of(primitives[0]).items()
    }
    weights = {
        name: array for name, array in arrays.items() if name.startswith("WEIGHTS_") and not exact
    }
    # Weights must sum to 1, or a skinned vertex drifts; rounding each by itself breaks that.
    arrays |= _levels(weights)
    attributes, accessors, qualities = [], {"POSITION": (FLOAT, False)}, dict[str, str]()
    # Tangents are turned from the normals and texture coordinates that come before them.
    for name, array in sorted(arrays.items(), key=lambda entry: entry[0] == "TANGENT"):
        normalized = bool(entries[name].get("normalized")) or name in weights
        carried = _carried(name, array, normalized)
        if isinstance(carried, str):
            return carried
        attribute, component, is_normalized = carried
        attributes.append(attribute)
        accessors[name] = component, is_normalized
        if attribute.values.dtype.kind == "f" and not exact:
            quality = _quality(name, array, extent, lambda name: _texel(document, bundle, name))
            if quality is not None:
                qualities[name] = quality
    if len(primitives) > 1:
        numbers = np.repeat(np.arange(len(sizes)), sizes)
        # One stream for many primitives: a head costs as much as a small mesh. The label tells where each begins.
        attributes.append(Attribute(PIECE, numbers.astype(np.uint16), "face"))
    mesh = TriangleMesh(
        positions.astype(np.float64), corners.astype(np.int32), tuple(attributes), {}
    )
    return Carried(mesh, accessors, qualities, opens)


def _joined(
    document: gltf.Document, primitives: list[Tree]
) -> tuple[dict[str, Array], npt.NDArray[np.int64], list[int]] | str:
    """The arrays of all vertices, the faces, and how many each primitive has; or why they stay as they are."""
    arrays_by_key: dict[str, dict[str, int]] = {}
    keys: list[str] = []
    indexes: list[int] = []
    for primitive in primitives:
        arrays = arrays_of(primitive)
        keys.append(str(sorted(arrays.items())))
        arrays_by_key[keys[-1]] = arrays
        if "indices" in primitive:
            indexes.append(primitive["indices"])
    for arrays in arrays_by_key.values():
        indexes += arrays.values()
    # Accessors may share bytes.
    DEFAULT_LIMITS.check_memory(
        gltf.PER_NUMBER * sum(map(document.claimed, indexes)), 0, document.received
    )
    begins, parts, count = dict[str, int](), list[dict[str, Array]](), 0
    for key, arrays in arrays_by_key.items():  # each combination of accessors is made once
        part = _vertices(document, arrays)
        if isinstance(part, str):
            return part
        parts.append(part)
        begins[key] = count
        count += len(part["POSITION"])
    faces: list[npt.NDArray[np.int64]] = []
    for key, primitive in zip(keys, primitives, strict=True):
        vertices = document.count(primitive["attributes"]["POSITION"])
        triangles = gltf.triangles_of(document, primitive, vertices)
        if not len(triangles):
            return "no triangles"
        faces.append(triangles + begins[key])
    # Vertices that no face uses are not drawn, and not sent.
    used, corners = np.unique(np.concatenate(faces), return_inverse=True)
    joined = {name: np.concatenate([part[name] for part in parts])[used] for name in parts[0]}
    return joined, corners.reshape(-1, 3), list(map(len, faces))


def _vertices(document: gltf.Document, indexes: Mapping[str, int]) -> dict[str, Array] | str:
    """What each vertex has by these accessors, or why that cannot be coded."""
    arrays: dict[str, Array] = {}
    for name, index in indexes.items():
        array = document.array(index)
        normalized = bool(document.item("accessors", index).get("normalized"))
        is_geometry = name.rpartition("/")[2].startswith(
            ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_")
        )
        is_narrow = normalized and (name.startswith("_") or array[0].nbytes % 4 > 0)
        if (is_geometry or is_narrow) and array.dtype.itemsize <= 2:
            # Quantized geometry is coded as the floats that it means, or the grid of the stream would be laid over
            # another grid.
            most = np.iinfo(array.dtype).max
            array = array.astype(np.float32)
            if normalized:
                array = np.maximum(array / most, -1, dtype=np.float32)
        arrays[name] = array
    positions = arrays.get("POSITION")
    if positions is None or positions.dtype != np.float32 or not np.isfinite(positions).all():
        return "positions that are not finite floats"
    if any(len(array) != len(positions) for array in arrays.values()):
        return "attributes of different lengths"
    return arrays


def _opens(arrays: Mapping[str, Array], faces: npt.NDArray[np.int64]) -> bool:
    """Whether vertices that make a face without area, being at one place, part by targets or joints."""
    motion: list[Array] = []
    for name, array in arrays.items():
        if name.endswith("/POSITION") or name.startswith(("JOINTS_", "WEIGHTS_")):
            motion.append(array)
    positions = arrays["POSITION"].astype(np.float64)
    _, triangles, _ = weld(positions, faces.astype(np.int32))
    closed = degenerate(triangles) & ~degenerate(faces)
    if not motion or not closed.any():
        return False
    table = np.ascontiguousarray(np.column_stack([positions, *motion]), np.float64)
    alike = group_rows(table)
    return bool((closed & ~degenerate(alike[faces])).any())


def _levels(weights: Mapping[str, Array]) -> dict[str, Array]:
    """Weights of all sets as bytes whose sum is 255, as that of the weights is 1."""
    if not weights:
        return {}
    table = np.hstack([shares_of(array) for array in weights.values()])
    total = table.sum(axis=1, keepdims=True)
    has_weight = total > 0
    exact = np.where(has_weight, table / np.maximum(total, 1e-30) * 255, 0)
    levels = np.floor(exact)
    missing = np.where(has_weight, 255, 0) - levels.sum(axis=1, keepdims=True)
    # The method of largest remainders, as parliaments are seated: the sum is exact, and no weight is off by a whole
    # level.
    order = np.argsort(levels - exact, axis=1, kind="stable")
    ranks = np.argsort(order, axis=1)
    levels[ranks < missing] += 1
    ends = np.cumsum([array.shape[1] for array in weights.values()])
    tables = np.split(levels.astype(np.uint8), ends[:-1], axis=1)
    return dict(zip(weights, tables, strict=True))


def _quality(name: str, array: Array, extent: float, texel: Callable[[str], float]) -> str | None:
    """The quality of an attribute of floats; None: that which meshes have by default."""
    target, _, base = name.rpartition("/")
    if base.startswith("TEXCOORD_"):
        # As many bits as a quarter of a texel of the largest image needs.
        steps = float(np.ptp(array, axis=0).max()) / (2 * _TEXELS * texel(base))
        bits = math.ceil(math.log2(max(steps, 1.0)))
        if bits > _FINEST:
            return "exact"
        return f"{max(bits, _COARSEST)}bits"
    if name in _QUALITIES:
        return _QUALITIES[name]
    if target and base == "POSITION":
        if extent <= 0:
            return "exact"
        return repr(_GRID * extent)
    if target and base in ("NORMAL", "TANGENT"):
        return _TURN
    return None


def _texel(document: gltf.Document, bundle: Bundle, name: str) -> float:
    """The side of the smallest texel of the images that a set of texture coordinates places."""
    sides: list[float] = []
    materials: set[int] = set()
    for same in bundle:
        materials |= {primitive["material"] for primitive in same if "material" in primitive}
    for index in materials:
        material = document.item("materials", index)
        groups = [
            material,
            material.get("pbrMetallicRoughness", {}),
            *material.get("extensions", {}).values(),
        ]
        for group in groups:
            for key, info in group.items():
                if key.endswith("Texture") and f"TEXCOORD_{set_of(info)}" == name:
                    transform = info.get("extensions", {}).get(TRANSFORM, {})
                    scale = max(map(abs, transform.get("scale", [1.0])))
                    sides.append(document.side_of_texture(info["index"], _SIDE) * scale)
    return 1.0 / max(sides, default=_SIDE)


def _carried(name: str, array: Array, normalized: bool) -> tuple[Attribute, int, bool] | str:
    """Return an attribute for a stream, and the accessor of the decoded values; or why it cannot be coded."""
    is_float = array.dtype == np.float32
    if is_float and not np.isfinite(array).all():
        return f"{name} has numbers that are not finite"
    if name in _SEMANTICS and is_float:
        semantic, width = _SEMANTICS[name]
        if array.shape[1] != width:
            return f"{name} has {array.shape[1]} numbers for each vertex, not {width}"
        return Attribute(name, array, "vertex", semantic), FLOAT, False
    if name == "COLOR_0":
        in_range = array.dtype.kind == "u"
        if is_float:
            in_range = array.min() >= 0 and array.max() <= 1
        if not in_range:
            return "COLOR_0 has numbers that are not between 0 and 1"
        return Attribute(name, array, "vertex", "color"), FLOAT, False
    # Integers are coded without loss, and identifiers are wrong if they are off at all.
    # Identifiers, mostly.
    if is_float and (array == np.rint(array)).all() and np.abs(array).max() <= WHOLE:
        return Attribute(name, array.astype(np.int32)), FLOAT, False
    # Accessors keep their elements at multiples of four bytes; floats hold such integers.
    if array[0].nbytes % 4:
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
    # The largest of a vertex, and the largest of the diagonal of its component.
    error: tuple[float, float]
    notes: tuple[str, ...]


def code_bundle(
    carried: Carried | str, pieces: int, options: Mapping[str, Any]
) -> BundleStream | str:
    if isinstance(carried, str):
        return carried
    names = {"*", *(attribute.name for attribute in carried.mesh.attributes)}
    requests = {
        name: quality for name, quality in options.get("attributes", {}).items() if name in names
    }
    qualities = requests
    if "*" not in requests:
        qualities = {**carried.qualities, **requests}
    part_options = {"threads": 1, **options, "attributes": qualities}
    if not requests.keys() & {"*", "NORMAL"}:
        part_options["normals"] = "near"
    if carried.opens:
        part_options["keep_order"] = True
    try:
        coded = given_part(carried.mesh, **part_options).encode(Progress(""))
        encoder, stream = coded.encoder, b"".join(coded.attempt.frames)
        decoded = decode(stream)
    # One primitive that cannot be coded stays as it is; the scene does not fail for it.
    except BsmError as error:
        return f"no stream: {error}"
    shape = drawn(decoded)
    if len(shape.pieces) != pieces:
        return "no face has an area"
    # Measured on what decoders give, so that the figure of the command is that of `bsm compare`.
    error_of_positions = error_of(carried.mesh.positions[encoder.vertex_order], decoded)
    accessors = {name: carried.accessors[name] for name in shape.arrays}
    if len(shape.index) >= _SHORT and shape.index.max() < 65535:
        accessors["indices"] = (COMPONENTS["uint16"], False)
    notes = encoder.losses
    codings = [
        packet.declaration.coding
        for packet in coded.attempt.draft.body
        if isinstance(packet, Declared)
    ]
    if RECOMPUTED in codings:
        notes = (*notes, COMPUTED)
    return BundleStream(stream, shape, accessors, error_of_positions, notes)


def accessors_of(primitive: Tree) -> dict[str, int]:
    accessors = arrays_of(primitive)
    if "indices" in primitive:
        accessors[""] = primitive["indices"]
    return accessors


def bundles_of(document: gltf.Document, tree: Tree, reasons: Counter[str]) -> list[Bundle]:
    """The primitives of a tree that can be coded, each in one bundle; `reasons` counts why others are not."""
    primitives_by_key: dict[str, list[Tree]] = {}
    bundles: list[Bundle] = []
    for mesh in tree.get("meshes", []):
        alike: dict[str, Bundle] = {}
        for primitive in mesh["primitives"]:
            reason = _why_left(document, mesh, primitive)
            if reason is not None:
                reasons[reason] += 1
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
    extensions = primitive.get("extensions", {})
    unknown_names = [name for name in mesh.get("extensions", {}) if not OF_LOOKS.fullmatch(name)]
    for accessor in accessors:
        unknown_names += accessor.get("extensions", {})
    unknown_names += [name for name in extensions if name not in _KNOWN]
    for feature in extensions.get("EXT_mesh_features", {}).get("featureIds", []):
        if feature.keys().isdisjoint(("attribute", "texture")):
            unknown_names.append("EXT_mesh_features")
    if unknown_names:
        # A stream orders vertices anew. An extension that counts on their old numbers would point to others.
        return f"{unknown_names[0]} may name vertices"
    for accessor in accessors:
        if "bufferView" in accessor:
            packings = document.unread_in(document.item("bufferViews", accessor["bufferView"]))
            if packings:
                return f"{min(packings)} may hold other bytes"
    return None


def error_of(positions: Array, decoded: TriangleMesh) -> tuple[float, float]:
    """The largest error of a vertex, and the largest as a share of the diagonal of its component."""
    errors = np.linalg.norm(decoded.positions - positions, axis=1)
    labels = components(graph_of_faces(decoded.faces, len(errors)))
    order = np.argsort(labels, kind="stable")
    starts = np.searchsorted(labels[order], np.arange(labels.max() + 1))
    farthest = np.maximum.reduceat(errors[order], starts)
    low = np.minimum.reduceat(positions[order], starts, axis=0)
    high = np.maximum.reduceat(positions[order], starts, axis=0)
    diagonals = np.linalg.norm(high - low, axis=1)
    shares = farthest / np.where(diagonals > 0, diagonals, np.inf)
    return float(errors.max()), float(shares.max())
