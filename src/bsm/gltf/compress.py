"""Scenes of glTF with their geometry coded, or restored; everything else stays as it was."""

from __future__ import annotations

import copy
import io
import math
import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any
from urllib.parse import quote

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from bsm.bitstream.errors import BsmError, FormatError, MeshError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.decoding import decode
from bsm.codec.geometry.attributes import Attribute, Semantic
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import degenerate, group_rows, weld
from bsm.codec.static.encoder import Encoder
from bsm.codec.threads import ordered_map
from bsm.files.images import ImageRule, smaller
from bsm.files.room import as_format_error
from bsm.gltf import document as gltf
from bsm.gltf.coding import (
    COMPONENTS,
    DRACO,
    EXTENSION,
    FLOAT,
    MESHOPT,
    PIECE,
    TRIANGLES,
    TRIANGULAR,
    UINT,
    Array,
    Drawn,
    Tree,
    drawn,
    shares,
    stored,
)
from bsm.gltf.scene import parents_of, places_of
from bsm.options import encode_options

_SEMANTICS: dict[str, tuple[Semantic, int]] = {
    "NORMAL": ("normal", 3),
    "TEXCOORD_0": ("texcoord", 2),
    "TEXCOORD_1": ("texcoord", 2),
}
_GRID = 2.0**-15  # how far targets may move vertices wrongly, of the mesh's largest extent: as a grid of 14 bits
_QUALITIES = {"NORMAL": "10bits", "TANGENT": "9bits", "COLOR_0": "8bits"}
_TURN = "0.002"  # of what targets add to directions: a tenth of a degree
_COARSEST, _FINEST = 12, 22  # bits of texture coordinates; with more, they are exact
_TEXELS, _SIDE = 0.25, 2048  # how many texels they may be off, and pixels of the side of an image that is not known
_SHORT = 1 << 10  # indices from which on 16 bits of each are worth their words
_WORDS = 90  # bytes of JSON of an accessor or a bufferView
_WHOLE = 2**24  # up to which single precision has all whole numbers


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


def like(document: gltf.Document, primitive: Tree) -> str:
    """A key that is equal for primitives which one stream can hold."""
    accessors = [(name, document.item("accessors", index)) for name, index in sorted(arrays_of(primitive).items())]
    return str([(name, a["componentType"], a["type"], a.get("normalized", False)) for name, a in accessors])


def as_mesh(document: gltf.Document, bundle: Bundle, *, exact: bool = False) -> Carried | str:
    """Primitives that are alike as one mesh, or why they stay as they are."""
    primitives = [same[0] for same in bundle]
    if primitives[0].get("mode", TRIANGLES) not in TRIANGULAR:
        return "points or lines"
    # Each combination of accessors is made once.
    combined = {str(sorted(arrays_of(primitive).items())): arrays_of(primitive) for primitive in primitives}
    indexes = [index for arrays in combined.values() for index in arrays.values()]
    indexes += [primitive["indices"] for primitive in primitives if "indices" in primitive]
    # Accessors may share bytes.
    DEFAULT_LIMITS.check_memory(gltf.PER_NUMBER * sum(map(document.claimed, indexes)), 0, document.received)
    tables: dict[str, int] = {}  # where the vertices of which accessors begin
    parts: list[dict[str, Array]] = []
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
        triangles = gltf.triangles_of(document, primitive, document.count(primitive["attributes"]["POSITION"]))
        if not len(triangles):
            return "no triangles"
        faces.append(triangles + tables[key])
    used, corners = np.unique(np.concatenate(faces), return_inverse=True)
    arrays = {name: np.concatenate([part[name] for part in parts])[used] for name in parts[0]}
    corners = corners.reshape(-1, 3)
    opens = _opens(arrays, corners)
    positions = arrays.pop("POSITION")
    entries = {name: document.item("accessors", index) for name, index in arrays_of(primitives[0]).items()}
    if not exact:
        arrays |= _levels({name: array for name, array in arrays.items() if name.startswith("WEIGHTS_")})
    attributes, accessors, qualities = [], {"POSITION": (FLOAT, False)}, dict[str, str]()
    for name, array in arrays.items():
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
        numbers = np.repeat(np.arange(len(faces)), [len(some) for some in faces])
        attributes.append(Attribute(PIECE, numbers.astype(np.uint16), "face"))
    mesh = TriangleMesh(positions.astype(np.float64), corners.astype(np.int32), tuple(attributes), {})
    return Carried(mesh, accessors, qualities, opens)


def as_shares(document: gltf.Document, primitive: Tree) -> TriangleMesh:
    """A primitive as one mesh, whose normalized integers are the numbers that they stand for."""
    found = as_mesh(document, [[primitive]], exact=True)
    if isinstance(found, str):
        raise MeshError(found)
    plain = [
        replace(a, values=_floats(a.values, True)) if found.accessors[a.name][1] or a.name == "COLOR_0" else a
        for a in found.mesh.attributes
    ]
    return replace(found.mesh, attributes=tuple(plain))


def _vertices(document: gltf.Document, primitive: Tree) -> dict[str, Array] | str:
    """What each vertex of a primitive has, or why that cannot be coded."""
    arrays: dict[str, Array] = {}
    for name, index in arrays_of(primitive).items():
        array, normalized = document.array(index), bool(document.item("accessors", index).get("normalized"))
        geometry = name.rpartition("/")[2].startswith(("POSITION", "NORMAL", "TANGENT", "TEXCOORD_"))
        narrow = normalized and (name.startswith("_") or array[0].nbytes % 4 > 0)
        arrays[name] = _floats(array, normalized) if geometry or narrow else array
    positions = arrays.get("POSITION")
    if positions is None or positions.dtype != np.float32 or not np.isfinite(positions).all():
        return "positions that are not finite floats"
    if any(len(array) != len(positions) for array in arrays.values()):
        return "attributes of different lengths"
    return arrays


def _floats(array: Array, normalized: bool) -> Array:
    """Return the values of normalized integers as float32, of any shape."""
    if array.dtype.itemsize > 2 or array.dtype.kind not in "iu":
        return array
    values = array.astype(np.float32)
    return np.maximum(values / np.iinfo(array.dtype).max, -1, dtype=np.float32) if normalized else values


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
    table = np.hstack([shares(array) for array in weights.values()])
    total = table.sum(axis=1, keepdims=True)
    exact = np.where(total > 0, table / np.maximum(total, 1e-30) * 255, 0)
    levels = np.floor(exact)
    ranks = np.argsort(np.argsort(levels - exact, axis=1, kind="stable"), axis=1)
    levels += ranks < np.where(total > 0, 255, 0) - levels.sum(axis=1, keepdims=True)  # the largest remainders go up
    ends = np.cumsum([array.shape[1] for array in weights.values()])[:-1]
    return dict(zip(weights, np.split(levels.astype(np.uint8), ends, axis=1), strict=True))


def _quality(name: str, array: Array, extent: float, texel: Callable[[str], float]) -> str | None:
    """The quality of an attribute of floats; None: that which meshes have by default."""
    target, _, base = name.rpartition("/")
    if base.startswith("TEXCOORD_"):
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
            moved = info.get("extensions", {}).get("KHR_texture_transform", {})
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
        found = Attribute(name, array, "vertex", semantic) if array.shape[1] == width else None
        return (found, FLOAT, False) if found else f"{name} has {array.shape[1]} numbers for each vertex, not {width}"
    if name == "COLOR_0":
        if (is_float and (array.min() < 0 or array.max() > 1)) or not (is_float or array.dtype.kind == "u"):
            return "COLOR_0 has numbers that are not between 0 and 1"
        return Attribute(name, array, "vertex", "color"), FLOAT, False
    if is_float and (array == np.rint(array)).all() and np.abs(array).max() <= _WHOLE:  # identifiers, mostly
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


def code_bundle(found: Carried | str, pieces: int, options: Mapping[str, Any]) -> BundleStream | str:
    if isinstance(found, str):
        return found
    names = {"*", *(attribute.name for attribute in found.mesh.attributes)}
    asked = {name: quality for name, quality in options.get("attributes", {}).items() if name in names}
    qualities = {} if "*" in asked else found.qualities
    order = {"keep_order": True} if found.opens else {}
    try:
        encoder = Encoder(
            found.mesh, encode_options(**{"threads": 1, **options, **order, "attributes": {**qualities, **asked}})
        )
        stream = encoder.encode()
        decoded = decode(stream)
    except BsmError as error:
        return f"no stream: {error}"
    shape = drawn(decoded)
    if len(shape.pieces) != pieces:
        return "no face has an area"
    off = error_of(found.mesh.positions[encoder.vertex_order], decoded)
    accessors = {name: found.accessors[name] for name in shape.arrays}
    if len(shape.index) >= _SHORT and shape.index.max() < 65535:
        accessors["indices"] = (COMPONENTS["uint16"], False)
    return BundleStream(stream, shape, accessors, off, encoder.losses)


def _accessors_of(primitive: Tree) -> dict[str, int]:
    return arrays_of(primitive) | ({"": primitive["indices"]} if "indices" in primitive else {})


def bundles_of(document: gltf.Document, tree: Tree, left: Counter[str]) -> list[Bundle]:
    """The primitives of a tree that can be coded, each in one bundle; `left` counts why others are not."""
    known: dict[str, list[Tree]] = {}
    bundles: list[Bundle] = []
    for mesh in tree.get("meshes", []):
        alike: dict[str, Bundle] = {}
        for primitive in mesh["primitives"]:
            if why := _why_left(document, mesh, primitive):
                left[why] += 1
                continue
            key = str((sorted(_accessors_of(primitive).items()), primitive.get("mode")))
            if key not in known:
                known[key] = []
                alike.setdefault(like(document, primitive), []).append(known[key])
            known[key].append(primitive)
        bundles += alike.values()
    return bundles


_KNOWN = ("KHR_materials_variants", "EXT_mesh_features", "EXT_structural_metadata", DRACO)
"""Extensions of primitives that name no vertices, but for features without an attribute or a texture."""
_OF_LOOKS = re.compile(
    r"KHR_(materials|texture|lights|xmp|node|animation_pointer|mesh_quantization)\w*|EXT_(texture|lights|mesh_features)\w*"
    r"|MSFT_(texture|lod|packing)\w*|ADOBE_materials\w*|CESIUM_RTC|AGI_\w+|VRMC?(_\w+)?"
)
"""Extensions that name no accessors and no bufferViews."""


def _why_left(document: gltf.Document, mesh: Tree, primitive: Tree) -> str | None:
    if primitive.get("mode", TRIANGLES) not in TRIANGULAR:
        return "points or lines"
    accessors = [document.item("accessors", index) for index in _accessors_of(primitive).values()]
    named = [name for name in mesh.get("extensions", {}) if not _OF_LOOKS.fullmatch(name)]
    named += [name for entry in accessors for name in entry.get("extensions", {})]
    named += [name for name in primitive.get("extensions", {}) if name not in _KNOWN]
    features = primitive.get("extensions", {}).get("EXT_mesh_features", {}).get("featureIds", [])
    named += ["EXT_mesh_features" for entry in features if not {"attribute", "texture"} & entry.keys()]
    if named:
        return f"{named[0]} may name vertices"
    views = (document.item("bufferViews", entry["bufferView"]) for entry in accessors if "bufferView" in entry)
    packed = [name for view in views for name in sorted(document.unread_in(view))]
    return f"{packed[0]} may hold other bytes" if packed else None


def users_of(bundles: list[Bundle], tree: Tree, named: set[int]) -> dict[int, set[int]]:
    """Which bundles use each accessor; -1: something else."""
    users: dict[int, set[int]] = {index: {-1} for index in named}
    coded: dict[int, int] = {}
    for number, bundle in enumerate(bundles):
        for primitive in (primitive for same in bundle for primitive in same):
            holders = (primitive, primitive["attributes"], *primitive.get("targets", []))
            coded |= {id(holder): number for holder in holders}
    for holder, key in references(tree, "accessors"):
        users.setdefault(holder[key], set()).add(coded.get(id(holder), -1))
    return users


def that_share(bundles: list[Bundle], users: dict[int, set[int]]) -> list[list[int]]:
    """Numbers of bundles, those together that share accessors, if only by others."""
    groups = {number: {number} for number in range(len(bundles))}
    for numbers in users.values():
        joined = set().union(*(groups[number] for number in numbers if number >= 0))
        for number in joined:
            groups[number] = joined
    return [sorted(group) for number, group in groups.items() if number == min(group)]


# ----------------------------------------------------------------------------------------------------------- references


def references(tree: Tree, kind: str) -> Iterator[tuple[Tree, str]]:
    """Where the schema of glTF refers to accessors or bufferViews: an object, and the key there."""
    if kind == "accessors":
        for primitive in (primitive for mesh in tree.get("meshes", []) for primitive in mesh["primitives"]):
            for holder in (primitive["attributes"], *primitive.get("targets", [])):
                yield from ((holder, name) for name in holder)
            yield from [(primitive, "indices")] if "indices" in primitive else []
        for animation in tree.get("animations", []):
            yield from ((sampler, end) for sampler in animation["samplers"] for end in ("input", "output"))
        yield from ((skin, "inverseBindMatrices") for skin in tree.get("skins", []) if "inverseBindMatrices" in skin)
        return
    sparse = [accessor["sparse"] for accessor in tree.get("accessors", []) if "sparse" in accessor]
    holders = [*tree.get("accessors", []), *tree.get("images", [])]
    holders += [part for entry in sparse for part in (entry["indices"], entry["values"])]
    yield from ((holder, "bufferView") for holder in holders if "bufferView" in holder)
    for view in tree.get("bufferViews", []):
        yield from ((how, "stream") for name, how in view.get("extensions", {}).items() if name == EXTENSION)


def named_by_others(node: Any, *, inside: bool = False) -> set[int]:
    """Numbers in extensions that are not known: they may be those of accessors or bufferViews."""
    if isinstance(node, dict):
        found = set[int]()
        for key, value in node.items():
            if key == "extensions" and isinstance(value, dict):
                known = {name for name in value if _OF_LOOKS.fullmatch(name) or name in (EXTENSION, DRACO, *MESHOPT)}
                found |= set().union(*(named_by_others(value[name], inside=name not in known) for name in value))
            elif key != "extras":
                found |= named_by_others(value, inside=inside)
        return found
    if isinstance(node, list):
        return set().union(*(named_by_others(item, inside=inside) for item in node))
    if isinstance(node, str):
        return {int(number) for number in re.findall(r"/(\d{1,9})", node)} if inside else set()
    return {int(node)} if inside and isinstance(node, int | float) and abs(node) < _WHOLE else set()


# -------------------------------------------------------------------------------------------------------------- a scene


_MOST = float(np.finfo(np.float32).max)


@dataclass(frozen=True)
class Compressed:
    """A .glb, how many of its primitives are coded, why others are not, and notes: how many for each."""

    data: bytes
    coded: int
    left: dict[str, int]
    fallback: bytes = b""
    notes: Mapping[str, int] = field(default_factory=dict)
    error: tuple[float, float] = (0.0, 0.0)


@as_format_error("glTF")
def count_primitives(document: gltf.Document) -> int:
    return len(list(document.primitives()))


@as_format_error("glTF")
def compress(
    document: gltf.Document,
    options: Mapping[str, Any],
    images: ImageRule | None = None,
    fallback: str | None = None,
    progress: Callable[[int, int], None] | None = None,
    *,
    jobs: int = 1,
    one_grid: bool = False,
) -> Compressed:
    """Code each primitive of triangles where that makes the scene smaller; `options` are those of `bsm.encode`."""
    if EXTENSION in document.compressed:
        raise FormatError(f"its geometry is compressed already, by {EXTENSION}; start from the scene before that")
    scene = _Rewritten(document, fallback)
    left, notes = Counter[str](), Counter[str]()
    bundles = bundles_of(document, scene.tree, left)
    users = users_of(bundles, scene.tree, scene.named)
    exact = options.get("preset") == "lossless"
    asked = {**({"*": "exact"} if exact else {}), **options.get("attributes", {})}
    each = _one_grid(document, scene.tree, bundles, options) if one_grid else [options] * len(bundles)
    each = [{**own, "attributes": asked} for own in each]
    sizes, begun = [sum(map(len, bundle)) for bundle in bundles], 0
    coded: list[BundleStream | str] = []
    meshes = (as_mesh(document, bundle, exact=exact) for bundle in bundles)
    given = zip(meshes, map(len, bundles), each, strict=True)
    for found in ordered_map(lambda mesh: code_bundle(*mesh), given, jobs or None):
        if progress:
            progress(begun, sum(sizes))
        begun += sizes[len(coded)]
        coded.append(found)
    done, errors = 0, [(0.0, 0.0)]
    for together in that_share(bundles, users):
        streams = {number: found for number in together if isinstance(found := coded[number], BundleStream)}
        for number in together:
            if isinstance(why := coded[number], str):
                left[why] += sizes[number]
        freed = [index for index, theirs in users.items() if theirs <= streams.keys()]
        primitives = sum(sizes[number] for number in streams)
        if scene.would_shrink(list(streams.values()), freed):
            done += primitives
            for number, found in streams.items():
                scene.put(bundles[number], found)
                notes.update(found.notes)
                errors.append(found.error)
        elif streams:
            left["a stream would not be smaller"] += primitives
    data = scene.finished(images)
    worst = (max(error for error, _ in errors), max(share for _, share in errors))
    return Compressed(data, done, dict(left), b"".join(scene.plain) if fallback else b"", notes, worst)


@as_format_error("glTF")
def restore(document: gltf.Document) -> bytes:
    """A .glb without compressed geometry."""
    for number, mesh in enumerate(document.items("meshes")):
        if EXTENSION in mesh.get("extensions", {}):
            raise UnsupportedError(f"mesh {number} moves, and plain glTF cannot hold it: decode its stream to .glb")
    return _Rewritten(document, None).finished()


def _one_grid(
    document: gltf.Document, tree: Tree, bundles: list[Bundle], options: Mapping[str, Any]
) -> list[dict[str, Any]]:
    """Options of each bundle: those whose nodes turn and scale alike share the places and the size of their cells."""
    matrices: dict[object, Array] = {}
    for node, matrix in places_of(document, parents_of(document)).items():
        entry = document.item("nodes", node)
        matrices.setdefault(entry.get("mesh"), np.eye(4) if "skin" in entry else matrix)
    meshes = {id(primitive): n for n, mesh in enumerate(tree["meshes"]) for primitive in mesh["primitives"]}
    placed = [matrices.get(meshes[id(bundle[0][0])], np.eye(4)) for bundle in bundles]
    keys = [np.round(matrix[:3, :3], 9).tobytes() for matrix in placed]
    cells: dict[bytes, float] = {}
    corners = [same[0]["attributes"]["POSITION"] for bundle in bundles for same in bundle]
    document.limits.check_memory(gltf.PER_NUMBER * sum(map(document.claimed, corners)), 0, document.received)
    for bundle, key in zip(bundles, keys, strict=True):
        tables = [document.numbers(same[0]["attributes"]["POSITION"]) for same in bundle]
        extent = max(float(np.ptp(table, axis=0).max(initial=0.0)) for table in tables)
        cells[key] = max(cells.get(key, 0.0), extent / (1 << 14))
    found = []
    for matrix, cell in zip(placed, map(cells.__getitem__, keys), strict=True):
        moved = np.linalg.lstsq(matrix[:3, :3], matrix[:3, 3], rcond=None)[0]
        origin = tuple((-moved % cell).tolist()) if cell else (0.0, 0.0, 0.0)
        grid = {"grid_cell": cell, "grid_origin": origin} if cell else {"grid": 14}
        found.append({name: value for name, value in options.items() if name not in ("preset", "grid")} | grid)
    return found


def error_of(positions: Array, decoded: TriangleMesh) -> tuple[float, float]:
    """The largest error of a vertex, and the largest as a share of the diagonal of its component."""
    errors = np.linalg.norm(decoded.positions - positions, axis=1)
    edges = decoded.faces[:, [0, 1, 1, 2]].reshape(-1, 2)
    graph = coo_array((np.ones(len(edges), np.int8), edges.T), shape=(len(errors),) * 2)
    labels = connected_components(graph, directed=False)[1]
    order = np.argsort(labels, kind="stable")
    starts = np.searchsorted(labels[order], np.arange(labels.max() + 1))
    low, high = (way.reduceat(positions[order], starts, axis=0) for way in (np.minimum, np.maximum))
    farthest, diagonals = np.maximum.reduceat(errors[order], starts), np.linalg.norm(high - low, axis=1)
    return float(errors.max()), float((farthest / np.where(diagonals > 0, diagonals, np.inf)).max())


class _Rewritten(gltf.Growing):
    """The tree of a document that is changed, and the bytes of its new buffer."""

    def __init__(self, document: gltf.Document, fallback: str | None) -> None:
        super().__init__(io.BytesIO(), copy.deepcopy(document.tree))
        self._document, self._fallback = document, fallback
        unknown = set().union(*map(document.unread_in, document.items("buffers")))
        packed = set().union(*map(document.unread_in, document.items("bufferViews")))
        if unknown or (packed and len(document.items("buffers")) > 1):
            raise UnsupportedError(f"{min(unknown | packed)} may name bytes of buffers that would move")
        self._whole = bool(packed)  # then all bytes stay where they are
        if self._whole:
            self.append(document.buffer(0))
        self.named = named_by_others(document.tree)
        self._before = {
            kind: {holder[key] for holder, key in references(document.tree, kind)}
            for kind in ("accessors", "bufferViews")
        }
        for kind, numbers in self._before.items():
            for number in numbers:
                document.item(kind, number)
        self._moved: set[int] = set()  # bufferViews whose bytes are in the new buffer
        self._virtual = 0  # bytes of what decoders fill
        self.plain: list[bytes] = []

    def view(self, data: bytes, **more: Any) -> int:
        view = super().view(data, **more)
        self._moved.add(view)
        return view

    def would_shrink(self, found: list[BundleStream], freed: list[int]) -> bool:
        """Return whether streams and their words are smaller than the accessors that they replace."""
        entries = {index: self._document.item("accessors", index) for index in freed}
        views = {entry["bufferView"] for entry in entries.values() if "bufferView" in entry} - self.named
        held = [n for n, e in entries.items() if e.get("bufferView") in views or n in self._document.of_draco]
        before = _WORDS * (len(freed) + len(views)) + sum(self._document.array(index).nbytes for index in held)
        words = sum(3 + 2 * len(coded.shape.arrays) + len(coded.shape.pieces) for coded in found)
        return bool(found) and sum(len(coded.stream) for coded in found) + _WORDS * words < before

    def put(self, bundle: Bundle, coded: BundleStream) -> None:
        """Put a stream in the place of the accessors of a bundle."""
        stream = self.view(coded.stream)
        entries: list[Tree] = self.tree["accessors"]
        given, places = arrays_of(bundle[0][0]), dict[str, int]()
        for name, array in coded.shape.arrays.items():
            component, normalized = coded.accessors[name]
            view = self._view(stream, name, stored(name, array, component), component)
            more: Tree = {"normalized": True} if normalized else {}
            more |= gltf.bounds_of(array) if name.rpartition("/")[2] == "POSITION" else {}
            places[name] = self.accessor(
                component, len(array), array.shape[1], view, **more, **_words(entries[given[name]])
            )
        component, _ = coded.accessors.get("indices", (UINT, False))
        corners = stored("indices", coded.shape.index, component)
        view = self._view(stream, "indices", corners, component)
        for same, (start, count) in zip(bundle, coded.shape.pieces, strict=True):
            more = {"byteOffset": start * corners.itemsize} if start else {}
            more |= _words(entries[same[0]["indices"]] if "indices" in same[0] else {})
            indices = self.accessor(component, count, 1, view, **more)
            for primitive in same:
                primitive["indices"] = indices
                primitive.pop("mode", None)
                named = {name: places[name] for name in primitive["attributes"] if name in places}
                primitive["attributes"] = named
                for number, target in enumerate(primitive.get("targets", [])):
                    target |= {name: places[f"{number}/{name}"] for name in target}

    def _view(self, stream: int, name: str, array: Array, component: int) -> int:
        extension: Tree = {"stream": stream, "attribute": name}
        extension |= {} if component == (UINT if name == "indices" else FLOAT) else {"componentType": component}
        view: Tree = {"buffer": 1, "byteLength": array.nbytes, "extensions": {EXTENSION: extension}}
        if self._fallback:
            view["byteOffset"] = self._virtual
            self.plain.append(array.tobytes() + b"\0" * (-array.nbytes % 4))
            self._virtual += array.nbytes + -array.nbytes % 4
        else:
            self._virtual = max(self._virtual, array.nbytes)
        return self.add("bufferViews", view)

    def _take_images(self, rule: ImageRule | None) -> None:
        """Put images inside that lie elsewhere, and write all by a rule where that makes them smaller."""
        for number, image in enumerate(self.tree.get("images", [])):
            data = self._document.image(number)[1] if rule or "uri" in image else None
            found = smaller(data, rule) if data and rule else None
            kind = f"image/{rule.kind}" if rule and found else image.get("mimeType") or (data and gltf.mime_of(data))
            if data and kind and (found or "uri" in image):
                image.pop("uri", None)
                image |= {"mimeType": kind, "bufferView": self.view(found or data)}
            for texture in self.tree.get("textures", []) if found and kind == "image/webp" else ():
                if texture.get("source") == number:
                    del texture["source"]
                    texture.setdefault("extensions", {})[gltf.WEBP] = {"source": number}
                    self._use(gltf.WEBP, required=True)

    def _use(self, extension: str, *, required: bool) -> None:
        for key in ("extensionsUsed", "extensionsRequired") if required else ("extensionsUsed",):
            names = self.tree.setdefault(key, [])
            if extension not in names:
                names.append(extension)

    def finished(self, images: ImageRule | None = None) -> bytes:
        """Return the .glb without replaced data, with external images inside, and with plain geometry elsewhere."""
        tree = self.tree
        self._take_images(images)
        self._write_draco()
        self._drop_accessors()
        self._place_views()
        gone = {DRACO, *MESHOPT, *([] if self._virtual else [EXTENSION])}
        for key in ("extensionsUsed", "extensionsRequired"):
            tree[key] = [name for name in tree.get(key, []) if name not in gone]
        tree["buffers"] = [{"byteLength": self.size}] if self.size else []
        if self._virtual:
            filled: Tree = {"byteLength": self._virtual, "extensions": {EXTENSION: {"fallback": True}}}
            tree["buffers"].append(filled | ({"uri": quote(self._fallback)} if self._fallback else {}))
            self._use(EXTENSION, required=not self._fallback)
        for key in ("accessors", "bufferViews", "buffers", "extensionsUsed", "extensionsRequired"):
            if not tree.get(key):
                tree.pop(key, None)
        self.tree = _short(tree)
        return self.whole()

    def _drop_accessors(self) -> None:
        """Drop those that were replaced; others take their bytes out of bufferViews that they shared with these."""
        entries: list[Tree] = self.tree.get("accessors", [])
        numbers = {id(entry): number for number, entry in enumerate(entries)}
        blank: Tree = {"componentType": COMPONENTS["uint8"], "count": 1, "type": "SCALAR"}
        self._renumber("accessors", blank)
        kept = self.tree["accessors"]
        gone = numbers.keys() - {id(entry) for entry in kept}
        shared = {entry["bufferView"] for entry in entries if id(entry) in gone and "bufferView" in entry} - self.named
        for entry in kept:
            if entry.get("bufferView") in shared and "sparse" not in entry:
                strided = "byteStride" in self._document.item("bufferViews", entry["bufferView"])
                entry["bufferView"] = self.table(self._document.array(numbers[id(entry)]), packed=not strided)
                entry.pop("byteOffset", None)

    def _write_draco(self) -> None:
        """Write what Draco held of primitives that were not coded."""
        for primitive in (primitive for mesh in self.tree.get("meshes", []) for primitive in mesh["primitives"]):
            if DRACO not in primitive.get("extensions", {}):
                continue
            del primitive["extensions"][DRACO]
            primitive.pop("mode", None)
            if not primitive["extensions"]:
                del primitive["extensions"]
            for name, index in _accessors_of(primitive).items():
                accessor = self.tree["accessors"][index]
                if index < len(self._document.items("accessors")) and "bufferView" not in accessor:
                    values = self._document.array(index)
                    accessor |= {"bufferView": self.table(values, packed=not name), "count": len(values)}

    def _place_views(self) -> None:
        """Drop replaced views, and put the bytes of the others into the new buffer."""
        views: list[Tree] = self.tree.setdefault("bufferViews", [])
        used = {holder[key] for holder, key in references(self.tree, "bufferViews")}
        for number, view in enumerate(views[: len(self._document.items("bufferViews"))]):
            packed = [name for name in (EXTENSION, *MESHOPT) if view.get("extensions", {}).pop(name, None)]
            if "extensions" in view and not view["extensions"]:
                del view["extensions"]
            unread = number in self._before["bufferViews"] and not {number} & (used | self.named)
            if number in self._moved or unread or (self._whole and not packed):
                continue
            data = self._document.view(number)
            view |= {"buffer": 0, "byteOffset": self.append(data), **({"byteLength": len(data)} if packed else {})}
        self._renumber("bufferViews", {"buffer": 0, "byteLength": 1})

    def _renumber(self, kind: str, blank: Tree) -> None:
        """Drop the entries of a kind that were referenced and no longer are; those that others may name stay there."""
        entries, places = self.tree.get(kind, []), list(references(self.tree, kind))
        every = set(range(len(entries)))
        stay = self.named & every
        kept = {holder[key] for holder, key in places} | (every - self._before[kind]) | stay
        free = iter(sorted(every - stay))
        numbers = {old: old if old in stay else next(free) for old in sorted(kept)}
        for holder, key in places:
            holder[key] = numbers[holder[key]]
        origin = {new: old for old, new in numbers.items()}
        size = max(origin, default=-1) + 1
        self.tree[kind] = [entries[origin[new]] if new in origin else dict(blank) for new in range(size)]


def _words(accessor: Tree) -> Tree:
    return {key: accessor[key] for key in ("name", "extras") if key in accessor}


def _short(node: Any) -> Any:
    """JSON with each number that single precision has written as shortly as that allows; glTF means no more.

    Extras and extensions stay as they are.
    """
    if isinstance(node, dict):
        return {key: value if key in ("extras", "extensions") else _short(value) for key, value in node.items()}
    if isinstance(node, list):
        return [_short(value) for value in node]
    if not isinstance(node, float) or abs(node) > _MOST or np.float32(node) != node:
        return node
    return int(node) if node.is_integer() and abs(node) < _WHOLE else float(str(np.float32(node)))
