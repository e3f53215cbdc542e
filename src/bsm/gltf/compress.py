"""A scene with its geometry coded, and all else as it was."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError, FormatError
from bsm.codec.static.decoder import decode
from bsm.gltf.document import Document, Tree, glb
from bsm.gltf.images import MIME, ImageRule, smaller
from bsm.gltf.primitives import Coder, as_mesh, drawn

EXTENSION = "EXT_bsm_compression"
_COMPRESSED = {EXTENSION, "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"}
_WEBP = "EXT_texture_webp"
_UINT, _FLOAT = 5125, 5126
_KINDS: dict[int, type[np.generic]] = {5121: np.uint8, 5123: np.uint16, _FLOAT: np.float32}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_ARRAY, _ELEMENTS = 34962, 34963


@dataclass(frozen=True)
class Compressed:
    """A .glb, how many of its primitives are coded, and why others are not: how many for each reason.

    `fallback` is the file for loaders that do not know the extension, if one was named.
    """

    data: bytes
    coded: int
    left: dict[str, int]
    fallback: bytes = b""


def compress(
    document: Document,
    coder: Coder,
    images: ImageRule | None = None,
    fallback: str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Compressed:
    """Code each primitive of triangles where that makes the scene smaller.

    Parameters
    ----------
    document : Document
    coder : callable
        The stream of a mesh.
    images : ImageRule, optional
        How images are written; None: as they are.
    fallback : str, optional
        Name of a file with plain arrays for loaders that do not know the extension; None: they must know it.
    progress : callable, optional
        Told how many primitives are done, and of how many.

    Raises
    ------
    FormatError
        If the scene contradicts itself, or its geometry is compressed already.
    """
    for name in _COMPRESSED & set(document.tree.get("extensionsUsed", [])):
        raise FormatError(f"its geometry is compressed already, by {name}; start from the scene before that")
    with _consistent():
        return _compressed(document, coder, images, fallback, progress)


def count_primitives(document: Document) -> int:
    """How many primitives the meshes of a scene have; raises FormatError if it contradicts itself."""
    with _consistent():
        return len(_primitives(document.tree))


@contextmanager
def _consistent() -> Iterator[None]:
    try:
        yield
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        raise FormatError(f"this glTF contradicts itself: {type(error).__name__}: {error}") from error


def _compressed(
    document: Document,
    coder: Coder,
    images: ImageRule | None,
    fallback: str | None,
    progress: Callable[[int, int], None] | None,
) -> Compressed:
    scene = _Scene(document, fallback)
    left: Counter[str] = Counter()
    coded = 0
    users = _users(document.tree)
    streams: dict[str, Any] = {}
    primitives = _primitives(scene.tree)
    for number, primitive in enumerate(primitives):
        if progress:
            progress(number, len(primitives))
        key = _key(primitive)
        if key in streams:
            reason = streams[key] if isinstance(streams[key], str) else None
            if reason is None:
                primitive["attributes"], primitive["indices"] = dict(streams[key][0]), streams[key][1]
        elif any(users[index] != {key} for index in _accessors_of(primitive).values()):
            reason = "accessors that others use, too"
        else:
            reason = scene.code(primitive, coder)
            streams[key] = reason or (primitive["attributes"], primitive["indices"])
        coded += reason is None
        left.update([reason] if reason else [])
    if images:
        scene.rewrite_images(images)
    return Compressed(scene.finished(), coded, dict(left), b"".join(scene.plain) if fallback else b"")


def _stored(values: npt.NDArray[Any], component: int) -> npt.NDArray[Any]:
    """Values as an accessor has them; integers that are floats there are shares of their largest."""
    if component == _FLOAT and values.dtype.kind == "u":
        return (values / np.float64(np.iinfo(values.dtype).max)).astype(np.float32)
    return values.astype(_KINDS[component])


def _primitives(tree: Tree) -> list[Tree]:
    return [primitive for mesh in tree.get("meshes", []) for primitive in mesh["primitives"]]


def _accessors_of(primitive: Tree) -> dict[str, int]:
    found = dict(primitive["attributes"])
    return found | ({"": primitive["indices"]} if "indices" in primitive else {})


def _key(primitive: Tree) -> str:
    """A key that is equal for primitives that are drawn of the same accessors."""
    return str((sorted(_accessors_of(primitive).items()), primitive.get("targets"), primitive.get("mode")))


def _users(tree: Tree) -> dict[int, set[str]]:
    """Which sets of accessors, or what else, use each accessor."""
    users: dict[int, set[str]] = {}
    for primitive in _primitives(tree):
        for index in _accessors_of(primitive).values():
            users.setdefault(index, set()).add(_key(primitive))
        for target in primitive.get("targets", []):
            for index in target.values():
                users.setdefault(index, set()).add("a morph target")
    for animation in tree.get("animations", []):
        for sampler in animation["samplers"]:
            for index in (sampler["input"], sampler["output"]):
                users.setdefault(index, set()).add("an animation")
    for skin in tree.get("skins", []):
        if "inverseBindMatrices" in skin:
            users.setdefault(skin["inverseBindMatrices"], set()).add("a skin")
    return users


class _Scene:
    """A tree that is changed, and the parts of its new buffers."""

    def __init__(self, document: Document, fallback: str | None) -> None:
        self.tree: Tree = copy.deepcopy(document.tree)
        self._document = document
        self._fresh: dict[int, bytes] = {}  # what new bufferViews hold
        self._virtual = 0  # bytes of what decoders fill
        self._fallback = fallback
        self.plain: list[bytes] = []

    def code(self, primitive: Tree, coder: Coder) -> str | None:
        """Put the stream of a primitive in the place of its accessors; why not, if it stays as it is."""
        found = as_mesh(self._document, primitive)
        if isinstance(found, str):
            return found
        try:
            stream = coder(found.mesh)
        except BsmError as error:
            return f"no stream: {error}"
        mesh = decode(stream)
        overhead = 150 * (2 + len(found.accessors))  # of JSON, for new accessors and bufferViews
        if len(stream) + overhead >= found.size:
            return "a stream would not be smaller"
        shape = drawn(mesh)
        place = self._add_view({"byteLength": len(stream)}, stream)
        low, high = shape.box
        attributes = {}
        for name, (component, normalized) in found.accessors.items():
            array = _stored(shape.arrays[name], component)
            accessor: Tree = {"componentType": component, "count": shape.vertices, "type": _TYPES[array.shape[1]]}
            accessor |= {"normalized": True} if normalized else {}
            accessor |= {"min": low, "max": high} if name == "POSITION" else {}
            attributes[name] = self._add_accessor(accessor, place, name, array, _ARRAY)
        primitive["attributes"] = attributes
        corners = {"componentType": _UINT, "count": shape.corners, "type": "SCALAR"}
        primitive["indices"] = self._add_accessor(corners, place, "indices", shape.index, _ELEMENTS)
        return None

    def _add_view(self, view: Tree, data: bytes | None) -> int:
        views = self.tree.setdefault("bufferViews", [])
        views.append(view)
        if data is not None:
            self._fresh[len(views) - 1] = data
        return len(views) - 1

    def _add_accessor(self, accessor: Tree, stream: int, name: str, array: npt.NDArray[Any], target: int) -> int:
        length = array.nbytes
        coded = {"stream": stream, "attribute": name, "componentType": accessor["componentType"]}
        view = {"byteOffset": self._virtual, "byteLength": length, "target": target, "extensions": {EXTENSION: coded}}
        self._virtual += length + -length % 4
        if self._fallback:
            self.plain.append(array.tobytes() + b"\0" * (-length % 4))
        self.tree["accessors"].append({"bufferView": self._add_view(view, None), **accessor})
        return len(self.tree["accessors"]) - 1

    def rewrite_images(self, rule: ImageRule) -> None:
        """Write images by a rule where that makes them smaller."""
        for number, image in enumerate(self.tree.get("images", [])):
            data = self._document.images.get(number)
            if "bufferView" in image:
                data = self._document.view(image["bufferView"])
            found = data and smaller(data, rule)
            if not found:
                continue
            image.pop("uri", None)
            image |= {"mimeType": MIME[rule.kind], "bufferView": self._add_view({"byteLength": len(found)}, found)}
            if rule.kind == "webp":
                self._refer_to_webp(number)

    def _refer_to_webp(self, image: int) -> None:
        for texture in self.tree.get("textures", []):
            if texture.get("source") == image:
                del texture["source"]
                texture.setdefault("extensions", {})[_WEBP] = {"source": image}
                self._use(_WEBP, required=True)

    def _use(self, extension: str, *, required: bool) -> None:
        for key in ("extensionsUsed", "extensionsRequired") if required else ("extensionsUsed",):
            names = self.tree.setdefault(key, [])
            if extension not in names:
                names.append(extension)

    def finished(self) -> bytes:
        """The .glb: bufferViews that nothing uses any more are gone, images that lay beside are in it."""
        tree = self.tree
        for number, data in self._document.images.items():
            image = tree["images"][number]
            if "uri" in image:
                kind = "image/png" if data.startswith(b"\x89PNG") else "image/jpeg"
                image.pop("uri")
                image |= {
                    "mimeType": image.get("mimeType", kind),
                    "bufferView": self._add_view({"byteLength": len(data)}, data),
                }
        _drop_unused(tree, "accessors", lambda node, key: key in _REFERENCES["accessors"])
        kept = _drop_unused(tree, "bufferViews", lambda node, key: key in _REFERENCES["bufferViews"])
        parts: list[bytes] = []
        at = 0
        virtual = False
        for new, old in enumerate(kept):
            view = tree["bufferViews"][new]
            if EXTENSION in view.get("extensions", {}):
                view["buffer"], virtual = 1, True
                continue
            data = self._fresh[old] if old in self._fresh else self._document.view(old)
            view |= {"buffer": 0, "byteOffset": at}
            parts.append(data + b"\0" * (-len(data) % 4))
            at += len(parts[-1])
        tree["buffers"] = [{"byteLength": at}] if at else []
        if virtual:
            filled: Tree = {"byteLength": self._virtual, "extensions": {EXTENSION: {"fallback": True}}}
            tree["buffers"].append(filled | ({"uri": quote(self._fallback)} if self._fallback else {}))
            self._use(EXTENSION, required=not self._fallback)
        return glb(tree, b"".join(parts))


_REFERENCES = {
    "accessors": ("indices", "input", "output", "inverseBindMatrices"),
    "bufferViews": ("bufferView", "stream"),
}


def _drop_unused(tree: Tree, kind: str, refers: Any) -> list[int]:
    """Drop the entries of a kind that nothing refers to, and number the others anew; which these were."""
    places: list[tuple[Any, Any]] = []

    def look(node: Any, inside: str) -> None:
        if isinstance(node, list):
            for item in node:
                look(item, inside)
        elif isinstance(node, dict):
            for key, value in node.items():
                if isinstance(value, int) and not isinstance(value, bool):
                    named = refers(node, key) and not (kind == "accessors" and inside == "sparse")
                    if named or (kind == "accessors" and inside in ("attributes", "targets")):
                        places.append((node, key))
                else:
                    look(value, key)

    look({name: value for name, value in tree.items() if kind != "accessors" or name != "accessors"}, "")
    kept = sorted({node[key] for node, key in places})
    numbers = {old: new for new, old in enumerate(kept)}
    for node, key in places:
        node[key] = numbers[node[key]]
    if kind in tree:
        tree[kind] = [tree[kind][old] for old in kept]
    return kept
