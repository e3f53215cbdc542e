"""A scene with its geometry coded, and all else as it was."""

from __future__ import annotations

import copy
import io
import json
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, Self
from urllib.parse import quote

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError, FormatError, OptionError, imported
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.decoding import decode
from bsm.codec.geometry.attributes import Attribute, Semantic
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.gltf import coding
from bsm.gltf import document as gltf
from bsm.gltf.coding import PIECE, Drawn, Tree, drawn

_TRIANGLES = 4
_FLOAT, _UINT = coding.COMPONENTS["float32"], coding.COMPONENTS["uint32"]
_SEMANTICS: dict[str, tuple[Semantic, int]] = {
    "NORMAL": ("normal", 3),
    "TEXCOORD_0": ("texcoord", 2),
    "TEXCOORD_1": ("texcoord", 2),
}
_LARGEST = {np.dtype(np.uint8): 255, np.dtype(np.uint16): 65535}
_GRID = 2.0**-15  # how far targets may move vertices wrongly, of the mesh's largest extent: as a grid of 14 bits
_QUALITIES = {"NORMAL": "10bits", "TANGENT": "9bits", "COLOR_0": "8bits"}
_QUALITIES |= dict.fromkeys(("TEXCOORD_0", "TEXCOORD_1"), "12bits")
_TURN = "0.002"  # of what targets add to directions: a tenth of a degree


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


def like(document: gltf.Document, primitive: Tree) -> str:
    """A key that is equal for primitives which one stream can hold."""
    accessors = [(name, document.tree["accessors"][index]) for name, index in sorted(arrays_of(primitive).items())]
    kinds = [(name, a["componentType"], a["type"], a.get("normalized", False)) for name, a in accessors]
    return str((kinds, primitive.get("mode", _TRIANGLES)))


def as_mesh(document: gltf.Document, primitives: Sequence[Tree]) -> Carried | str:
    """Primitives that are alike as one mesh, or why they stay as they are."""
    if primitives[0].get("mode", _TRIANGLES) != _TRIANGLES:
        return "no triangles"
    indexes = [*{index for primitive in primitives for index in arrays_of(primitive).values()}]
    indexes += [primitive["indices"] for primitive in primitives if "indices" in primitive]
    # Accessors may share bytes.
    DEFAULT_LIMITS.check_memory(gltf.PER_NUMBER * sum(map(document.claimed, indexes)), 0, document.received)
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
        attributes.append(Attribute(PIECE, numbers.astype(np.uint16), "face"))
    mesh = TriangleMesh(positions.astype(np.float64), corners.reshape(-1, 3).astype(np.int32), tuple(attributes), {})
    return Carried(mesh, accessors, qualities)


def _vertices(document: gltf.Document, primitive: Tree) -> dict[str, npt.NDArray[Any]] | str:
    """What each vertex of a primitive has, or why that cannot be coded."""
    arrays: dict[str, npt.NDArray[Any]] = {}
    for name, index in arrays_of(primitive).items():
        array = document.array(index)
        if array is None:
            return "accessors without plain bytes"
        geometry = name.rpartition("/")[2].startswith(("POSITION", "NORMAL", "TANGENT", "TEXCOORD_"))
        arrays[name] = _floats(array, _is_normalized(document, index)) if geometry else array
    positions = arrays.get("POSITION")
    if positions is None or positions.dtype != np.float32 or not np.isfinite(positions).all():
        return "positions that are not plain floats"
    if any(len(array) != len(positions) for array in arrays.values()):
        return "attributes of different lengths"
    return arrays


def _is_normalized(document: gltf.Document, index: int) -> bool:
    return bool(document.tree["accessors"][index].get("normalized"))


def _floats(array: npt.NDArray[Any], normalized: bool) -> npt.NDArray[Any]:
    """Return the values of normalized integers as float32, of any shape."""
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
    if name == "WEIGHTS_0":  # as bytes whose sum is 255, as that of the weights is 1
        weights = array / np.float64(1 if is_float else _LARGEST.get(array.dtype, 1))
        levels = np.floor(weights / np.maximum(weights.sum(axis=1, keepdims=True), 1e-9) * 255)
        levels[np.arange(len(levels)), weights.argmax(axis=1)] += 255 - levels.sum(axis=1)
        return Attribute(name, np.clip(levels, 0, 255).astype(np.uint8)), coding.COMPONENTS["uint8"], True
    if array[0].nbytes % 4:  # accessors keep their elements at multiples of four bytes
        return None
    return Attribute(name, array), coding.COMPONENTS[array.dtype.name], normalized and not is_float


class Coder(Protocol):
    def __call__(self, mesh: TriangleMesh, *, attributes: dict[str, str]) -> bytes:
        """Its bytes; `attributes` is what is asked of some of its attributes."""


Bundle = list[list[Tree]]
"""Primitives of one mesh that one stream can hold, each with all others that are drawn of the same accessors."""


@dataclass(frozen=True, eq=False)
class BundleStream:
    """The stream of a bundle, what is drawn of it, and the accessors: component type, normalized or not."""

    stream: bytes
    shape: Drawn
    accessors: dict[str, tuple[int, bool]]


def code_bundle(document: gltf.Document, bundle: Bundle, coder: Coder) -> BundleStream | str:
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


def bundles_of(document: gltf.Document, tree: Tree) -> list[Bundle]:
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


# -------------------------------------------------------------------------------------------------------------- a scene


_COMPRESSED = {coding.EXTENSION, "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"}
_TYPES = {width: name for name, width in gltf.VECTORS.items()}
_MOST, _WHOLE = float(np.finfo(np.float32).max), 2**24


@dataclass(frozen=True)
class Compressed:
    """A .glb, how many of its primitives are coded, and why others are not: how many for each reason."""

    data: bytes
    coded: int
    left: dict[str, int]
    fallback: bytes = b""


@gltf.as_format_error()
def count_primitives(document: gltf.Document) -> int:
    return len(list(document.primitives()))


@gltf.as_format_error()
def compress(
    document: gltf.Document,
    coder: Coder,
    images: ImageRule | None = None,
    fallback: str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Compressed:
    """Code each primitive of triangles where that makes the scene smaller."""
    for name in _COMPRESSED & set(document.tree.get("extensionsUsed", [])):
        raise FormatError(f"its geometry is compressed already, by {name}; start from the scene before that")
    scene = _Scene(document, fallback)
    left: Counter[str] = Counter()
    done = 0
    bundles = bundles_of(document, scene.tree)
    users = users_of(bundles, document.tree)
    begun, total = 0, count_primitives(document)
    for together in that_share(bundles, users):
        if progress:
            progress(begun, total)
        found: dict[int, BundleStream] = {}
        for number in together:
            coded = code_bundle(document, bundles[number], coder)
            if isinstance(coded, BundleStream):
                found[number] = coded
            else:
                left[coded] += size_of(bundles[number])
            begun += size_of(bundles[number])
        freed = [index for index, theirs in users.items() if theirs <= found.keys()]
        primitives = sum(size_of(bundles[number]) for number in found)
        if scene.would_shrink(list(found.values()), freed):
            done += primitives
            for number, coded in found.items():
                scene.put(bundles[number], coded)
        elif found:
            left["a stream would not be smaller"] += primitives
    if images:
        scene.rewrite_images(images)
    return Compressed(scene.finished(), done, dict(left), b"".join(scene.plain) if fallback else b"")


def _stored(values: npt.NDArray[Any], component: int) -> npt.NDArray[Any]:
    if component == _FLOAT and values.dtype.kind == "u":
        return (values / np.float64(np.iinfo(values.dtype).max)).astype(np.float32)
    return values.astype(coding.KINDS[component])


def _length(entry: Tree) -> int:
    return len(json.dumps(_short(entry), separators=(",", ":"))) + 1


class _Scene:
    """A tree that is changed, and the parts of its new buffers."""

    def __init__(self, document: gltf.Document, fallback: str | None) -> None:
        self.tree: Tree = copy.deepcopy(document.tree)
        self._document = document
        self._images = {
            number: document.image(number)[1]
            for number, image in enumerate(document.items("images"))
            if "uri" in image and "://" not in str(image["uri"])
        }
        self._fresh: dict[int, bytes] = {}  # what new bufferViews hold
        self._virtual = 0  # bytes of what decoders fill
        self._fallback = fallback
        self.plain: list[bytes] = []

    def would_shrink(self, found: list[BundleStream], freed: list[int]) -> bool:
        """Return whether streams and their JSON are smaller than the accessors that they replace."""
        before = 0
        for index in freed:
            accessor = self._document.tree["accessors"][index]
            array = self._document.array(index)
            before += _length(accessor) + (0 if array is None else array.nbytes)
        after = sum(len(coded.stream) for coded in found)
        for coded in found:
            entries = [self._view(0, name, array, coded) for name, array in self._arrays(coded)]
            entries += [{"buffer": 0, "byteOffset": 0, "byteLength": len(coded.stream)}]
            entries += [self._accessor(0, name, array, coded) for name, array in coded.shape.arrays.items()]
            entries += [self._corners(0, piece) for piece in coded.shape.pieces]
            after += sum(map(_length, entries))
        return bool(found) and after < before

    def put(self, bundle: Bundle, coded: BundleStream) -> None:
        """Put a stream in the place of the accessors of a bundle."""
        stream = self._add_bytes(coded.stream)
        views = {}
        for name, array in self._arrays(coded):
            view = self._view(stream, name, array, coded)
            if self._fallback:
                view["byteOffset"] = self._virtual
                self.plain.append(array.tobytes() + b"\0" * (-array.nbytes % 4))
                self._virtual += array.nbytes + -array.nbytes % 4
            else:
                self._virtual = max(self._virtual, array.nbytes)
            views[name] = self._add("bufferViews", view)
        arrays = coded.shape.arrays
        places = {
            name: self._add("accessors", self._accessor(views[name], name, arrays[name], coded)) for name in arrays
        }
        for same, piece in zip(bundle, coded.shape.pieces, strict=True):
            indices = self._add("accessors", self._corners(views["indices"], piece))
            for primitive in same:
                primitive["indices"] = indices
                primitive["attributes"] = {name: places[name] for name in primitive["attributes"]}
                for number, target in enumerate(primitive.get("targets", [])):
                    target |= {name: places[f"{number}/{name}"] for name in target}

    @staticmethod
    def _arrays(coded: BundleStream) -> list[tuple[str, npt.NDArray[Any]]]:
        found = [(name, _stored(array, coded.accessors[name][0])) for name, array in coded.shape.arrays.items()]
        return [*found, ("indices", coded.shape.index)]

    @staticmethod
    def _view(stream: int, name: str, array: npt.NDArray[Any], coded: BundleStream) -> Tree:
        usual = _UINT if name == "indices" else _FLOAT
        component, _ = coded.accessors.get(name, (_UINT, False))
        extension: Tree = {"stream": stream, "attribute": name}
        extension |= {"componentType": component} if component != usual else {}
        return {"buffer": 1, "byteLength": array.nbytes, "extensions": {coding.EXTENSION: extension}}

    @staticmethod
    def _accessor(view: int, name: str, array: npt.NDArray[Any], coded: BundleStream) -> Tree:
        component, normalized = coded.accessors[name]
        accessor: Tree = {"bufferView": view, "componentType": component, "count": len(array)}
        accessor |= {"type": _TYPES[array.shape[1]], **({"normalized": True} if normalized else {})}
        return accessor | (gltf.bounds_of(array) if name.rpartition("/")[2] == "POSITION" else {})

    @staticmethod
    def _corners(view: int, piece: tuple[int, int]) -> Tree:
        start, count = piece
        accessor: Tree = {"bufferView": view, "componentType": _UINT, "count": count, "type": "SCALAR"}
        return accessor | ({"byteOffset": 4 * start} if start else {})

    def _add(self, kind: str, entry: Tree) -> int:
        entries: list[Tree] = self.tree.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def _add_bytes(self, data: bytes) -> int:
        view = self._add("bufferViews", {"byteLength": len(data)})
        self._fresh[view] = data
        return view

    def rewrite_images(self, rule: ImageRule) -> None:
        """Write images by a rule where that makes them smaller."""
        for number, image in enumerate(self.tree.get("images", [])):
            data = self._images.get(number)
            if "bufferView" in image:
                data = self._document.view(image["bufferView"])
            found = data and smaller(data, rule)
            if not found:
                continue
            image.pop("uri", None)
            image |= {"mimeType": f"image/{rule.kind}", "bufferView": self._add_bytes(found)}
            for texture in self.tree.get("textures", []) if rule.kind == "webp" else ():
                if texture.get("source") == number:
                    del texture["source"]
                    texture.setdefault("extensions", {})[gltf.WEBP] = {"source": number}
                    self._use(gltf.WEBP, required=True)

    def _use(self, extension: str, *, required: bool) -> None:
        for key in ("extensionsUsed", "extensionsRequired") if required else ("extensionsUsed",):
            names = self.tree.setdefault(key, [])
            if extension not in names:
                names.append(extension)

    def finished(self) -> bytes:
        """The .glb: bufferViews that nothing uses any more are gone, images that lay beside are in it."""
        tree = self.tree
        for number, data in self._images.items():
            image = tree["images"][number]
            if "uri" in image:
                kind = "image/png" if data.startswith(b"\x89PNG") else "image/jpeg"
                image.pop("uri")
                image |= {"mimeType": image.get("mimeType", kind), "bufferView": self._add_bytes(data)}
        _drop_unused(tree, "accessors")
        self._trim()
        kept = _drop_unused(tree, "bufferViews")
        parts: list[bytes] = []
        at = 0
        virtual = False
        for new, old in enumerate(kept):
            view = tree["bufferViews"][new]
            if coding.EXTENSION in view.get("extensions", {}):
                view["buffer"], virtual = 1, True
                continue
            data = self._fresh[old] if old in self._fresh else self._document.view(old)
            view |= {"buffer": 0, "byteOffset": at}
            parts.append(data + b"\0" * (-len(data) % 4))
            at += len(parts[-1])
        tree["buffers"] = [{"byteLength": at}] if at else []
        if virtual:
            filled: Tree = {"byteLength": self._virtual, "extensions": {coding.EXTENSION: {"fallback": True}}}
            tree["buffers"].append(filled | ({"uri": quote(self._fallback)} if self._fallback else {}))
            self._use(coding.EXTENSION, required=not self._fallback)
        return gltf.glb(_short(tree), b"".join(parts))

    def _trim(self) -> None:
        """Leave out of bufferViews that accessors share what none of them uses any more."""
        readers: dict[int, list[Tree]] = {}
        for accessor in self.tree.get("accessors", []):
            if gltf.is_plain(accessor):
                readers.setdefault(accessor["bufferView"], []).append(accessor)
        references = Counter(node[key] for node, key in _references(self.tree, "bufferViews"))
        for number, accessors in readers.items():
            view = self.tree["bufferViews"][number]
            if number in self._fresh or view.get("extensions") or references[number] > len(accessors):
                continue
            kept = _used(self._document.view(number), [gltf.span_of(accessor, view) for accessor in accessors])
            if kept is None:
                continue
            for accessor, start in zip(accessors, kept[1], strict=True):
                accessor["byteOffset"] = start
            self._fresh[number], view["byteLength"] = kept[0], len(kept[0])


def _used(data: bytes, spans: list[tuple[int, int]]) -> tuple[bytes, list[int]] | None:
    """The bytes that spans cover, and where each begins in them, of four bytes as before; None if that is all."""
    if any(not 0 <= start < end <= len(data) for start, end in spans):
        return None
    kept = bytearray()
    last = shift = 0
    starts = [0] * len(spans)
    for number in sorted(range(len(spans)), key=spans.__getitem__):
        start, end = spans[number]
        if start >= last:  # apart from those before it
            kept += b"\0" * (-len(kept) % 4)
            last = start // 4 * 4
            shift = last - len(kept)
        kept += data[last:end]
        last = max(last, end)
        starts[number] = start - shift
    return (bytes(kept), starts) if len(kept) < len(data) else None


_REFERENCES = {
    "accessors": ("indices", "input", "output", "inverseBindMatrices"),
    "bufferViews": ("bufferView", "stream"),
}


def _references(node: Any, kind: str, inside: str = "") -> Iterator[tuple[Any, Any]]:
    """Where in a tree, or what is `inside` of it, entries of a kind are referred to."""
    if isinstance(node, list):
        for item in node:
            yield from _references(item, kind, inside)
    elif isinstance(node, dict):
        for key, value in node.items():
            if not isinstance(value, int) or isinstance(value, bool):
                yield from _references(value, kind, key)
                continue
            named = key in _REFERENCES[kind] and not (kind == "accessors" and inside == "sparse")
            if named or (kind == "accessors" and inside in ("attributes", "targets")):
                yield node, key


def _short(node: Any) -> Any:
    """JSON with each number that single precision has written as shortly as that allows; glTF means no more."""
    if isinstance(node, dict):
        return {key: _short(value) for key, value in node.items()}
    if isinstance(node, list):
        return [_short(value) for value in node]
    if not isinstance(node, float) or abs(node) > _MOST or np.float32(node) != node:
        return node
    return int(node) if node.is_integer() and abs(node) < _WHOLE else float(str(np.float32(node)))


def _drop_unused(tree: Tree, kind: str) -> list[int]:
    """Drop the entries of a kind that nothing refers to, and number the others anew; which these were."""
    places = list(
        _references({name: value for name, value in tree.items() if name != kind or kind != "accessors"}, kind)
    )
    kept = sorted({node[key] for node, key in places})
    numbers = {old: new for new, old in enumerate(kept)}
    for node, key in places:
        node[key] = numbers[node[key]]
    if kind in tree:
        tree[kind] = [tree[kind][old] for old in kept]
    return kept


# -------------------------------------------------------------------------------------------------------------- images


@dataclass(frozen=True)
class ImageRule:
    """How images are written: format, quality from 1 to 100, and the most pixels of a side (0: any number)."""

    kind: str
    quality: int = 85
    side: int = 0

    @classmethod
    def parse(cls, text: str) -> Self:
        """The rule that "webp", "webp:85" or "webp:85@1024" says."""
        match = re.fullmatch(r"(webp|jpeg|png)(?::(\d{1,3}))?(?:@(\d{1,5}))?", text)
        if not match or not 1 <= int(match[2] or 85) <= 100:
            raise OptionError(f"images are written as webp, webp:85 or webp:85@1024 (jpeg, png, too), not as {text!r}")
        return cls(match[1], int(match[2] or 85), int(match[3] or 0))


def smaller(data: bytes, rule: ImageRule) -> bytes | None:
    """An image by a rule; None if that would not be smaller, or Pillow cannot read it."""
    pillow = imported("PIL.Image", "images are written with Pillow", "formats")
    try:  # what Pillow does not know is an OSError
        found = _written(pillow.open(io.BytesIO(data)), rule, pillow.Resampling.LANCZOS)
    except (OSError, ValueError, SyntaxError, pillow.DecompressionBombError):
        return None
    return found if found and len(found) < len(data) else None


def _written(image: Any, rule: ImageRule, how: Any) -> bytes | None:
    """The file of an image; None if the format would lose what shows through."""
    if rule.kind == "jpeg" and image.mode not in ("RGB", "L"):
        if "A" in image.getbands() or "transparency" in image.info:
            return None
        image = image.convert("RGB")
    if rule.side and max(image.size) > rule.side:
        factor = rule.side / max(image.size)
        size = (max(1, round(image.width * factor)), max(1, round(image.height * factor)))
        image = image.resize(size, how)
    written = io.BytesIO()
    image.save(written, rule.kind, quality=rule.quality, **({"method": 6} if rule.kind == "webp" else {}))
    return written.getvalue()
