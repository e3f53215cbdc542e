"""The tree of a glTF document, rewritten for streams in the place of accessors; everything else stays as it was."""

import copy
import io
import json
import re
from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any
from urllib.parse import quote

import numpy as np

from bsm.account.images import ImageComparison, compare_image
from bsm.bitstream.errors import UnsupportedError
from bsm.files.images import ImageRule, smaller
from bsm.gltf import document as gltf
from bsm.gltf.bundles import OF_LOOKS, WHOLE, Bundle, BundleStream, accessors_of, arrays_of
from bsm.gltf.coding import COMPONENTS, DRACO, EXTENSION, FLOAT, MESHOPT, UINT, Array, Tree, stored

_WORDS = 90  # bytes of JSON of an accessor or a bufferView
_MOST = float(np.finfo(np.float32).max)


def users_of(bundles: list[Bundle], tree: Tree, foreign_numbers: set[int]) -> dict[int, set[int]]:
    """Return the bundles that use each accessor; -1: something else."""
    users: dict[int, set[int]] = {index: {-1} for index in foreign_numbers}
    bundle_of_holder: dict[int, int] = {}
    for number, bundle in enumerate(bundles):
        for primitive in chain.from_iterable(bundle):
            # By identity, as equal dictionaries stand in many places of a tree.
            for holder in (primitive, primitive["attributes"], *primitive.get("targets", [])):
                bundle_of_holder[id(holder)] = number
    # Everything that refers to an accessor is known here. An accessor may only go when nothing else does.
    for holder, key in references(tree, "accessors"):
        users.setdefault(holder[key], set()).add(bundle_of_holder.get(id(holder), -1))
    return users


def group_bundles(bundles: list[Bundle], sharers: Iterable[set[int]]) -> list[list[int]]:
    """Return the numbers of bundles, those together that share accessors or a stream, if only by others."""
    groups = {number: {number} for number in range(len(bundles))}
    for numbers in sharers:
        joined = set().union(*(groups[number] for number in numbers if number >= 0))
        for number in joined:
            groups[number] = joined
    return [sorted(group) for number, group in groups.items() if number == min(group)]


def references(tree: Tree, kind: str) -> Iterator[tuple[Tree, str]]:
    """Yield where the schema of glTF refers to accessors or bufferViews: an object, and the key there."""
    if kind == "accessors":
        return _accessor_references(tree)
    return _view_references(tree)


def _accessor_references(tree: Tree) -> Iterator[tuple[Tree, str]]:
    for primitive in primitives_of(tree):
        for holder in (primitive["attributes"], *primitive.get("targets", [])):
            for name in holder:
                yield holder, name
        if "indices" in primitive:
            yield primitive, "indices"
    for animation in tree.get("animations", []):
        for sampler in animation["samplers"]:
            yield sampler, "input"
            yield sampler, "output"
    for skin in tree.get("skins", []):
        if "inverseBindMatrices" in skin:
            yield skin, "inverseBindMatrices"


def _view_references(tree: Tree) -> Iterator[tuple[Tree, str]]:
    holders = [*tree.get("accessors", []), *tree.get("images", [])]
    for accessor in tree.get("accessors", []):
        if "sparse" in accessor:
            holders += (accessor["sparse"]["indices"], accessor["sparse"]["values"])
    for holder in holders:
        if "bufferView" in holder:
            yield holder, "bufferView"
    for view in tree.get("bufferViews", []):
        if EXTENSION in view.get("extensions", {}):
            yield view["extensions"][EXTENSION], "stream"


def primitives_of(tree: Tree) -> Iterator[Tree]:
    for mesh in tree.get("meshes", []):
        yield from mesh["primitives"]


# An unknown extension may name accessors by any key, so every whole number in it counts as one. Keeping too much is
# safe.
def numbers_by_others(node: Any, *, inside: bool = False) -> set[int]:
    """Return numbers in extensions that are not known: they may be those of accessors or bufferViews."""
    numbers = set[int]()
    if isinstance(node, dict):
        for key, value in node.items():
            if key == "extensions" and isinstance(value, dict):
                for name, extension in value.items():
                    is_safe = OF_LOOKS.fullmatch(name) or name in (EXTENSION, DRACO, *MESHOPT)
                    numbers |= numbers_by_others(extension, inside=not is_safe)
            elif key != "extras":
                numbers |= numbers_by_others(value, inside=inside)
    elif isinstance(node, list):
        for item in node:
            numbers |= numbers_by_others(item, inside=inside)
    elif inside and isinstance(node, str):
        numbers |= {int(number) for number in re.findall(r"/(\d{1,9})", node)}
    elif inside and isinstance(node, int | float) and abs(node) < WHOLE:
        numbers.add(int(node))
    return numbers


class Rewritten(gltf.Growing):
    """The tree of a document that is changed, and the bytes of its new buffer."""

    def __init__(self, document: gltf.Document, fallback: str | None) -> None:
        # A copy: the document is still read, while its tree is changed here.
        super().__init__(io.BytesIO(), copy.deepcopy(document.tree))
        self._document, self._fallback = document, fallback
        unknown = set().union(*map(document.unread_in, document.items("buffers")))
        packed = set().union(*map(document.unread_in, document.items("bufferViews")))
        if unknown or (packed and len(document.items("buffers")) > 1):
            raise UnsupportedError(
                f"{min(unknown | packed)} may name bytes of buffers that would move"
            )
        # A reader that unpacks these bufferViews finds them by offsets in the old buffer, so nothing in it may move.
        self._whole = bool(packed)  # then all bytes stay where they are
        if self._whole:
            self.append(document.buffer(0))
        self.foreign_numbers = numbers_by_others(document.tree)
        self._before = {
            kind: {holder[key] for holder, key in references(document.tree, kind)}
            for kind in ("accessors", "bufferViews")
        }
        for kind, numbers in self._before.items():
            for number in numbers:
                document.item(kind, number)
        self._moved: set[int] = set()  # bufferViews whose bytes are in the new buffer
        self._virtual = 0  # bytes of what decoders fill
        self._streams: dict[bytes, int] = {}  # the bufferView of each stream
        # bufferViews and accessors of streams, by what they are.
        self._shared: dict[object, int] = {}
        self.plain: list[bytes] = []
        self.images: list[ImageComparison] = []

    def view(self, data: bytes, **more: Any) -> int:
        view = super().view(data, **more)
        self._moved.add(view)
        return view

    def would_shrink(self, streams: list[BundleStream], freed: list[int]) -> bool:
        """Return whether streams and their words are smaller than the accessors that they replace."""
        if not streams:
            return False
        entries = {index: self._document.item("accessors", index) for index in freed}
        views = {
            entry["bufferView"] for entry in entries.values() if "bufferView" in entry
        } - self.foreign_numbers
        # JSON counts as well: a small mesh may save fewer bytes than its stream needs words.
        size_before = _WORDS * (len(freed) + len(views))
        for number, entry in entries.items():
            if entry.get("bufferView") in views or number in self._document.of_draco:
                size_before += self._document.array(number).nbytes
        size = 0
        # Equal streams are written once.
        for coded in {coded.stream: coded for coded in streams}.values():
            words = 3 + 2 * len(coded.shape.arrays) + len(coded.shape.pieces)
            size += len(coded.stream) + _WORDS * words
        return size < size_before

    def put(self, bundle: Bundle, coded: BundleStream) -> None:
        """Put a stream in the place of the accessors of a bundle."""
        if coded.stream not in self._streams:
            self._streams[coded.stream] = self.view(coded.stream)
        stream = self._streams[coded.stream]
        entries: list[Tree] = self.tree["accessors"]
        accessors = arrays_of(bundle[0][0])
        places: dict[str, int] = {}
        for name, array in coded.shape.arrays.items():
            component, normalized = coded.accessors[name]
            view = self._view(stream, name, stored(name, array, component), component)
            more: Tree = {}
            if normalized:
                more["normalized"] = True
            if name.rpartition("/")[2] == "POSITION":
                more |= gltf.bounds_of(array)
            more |= _words(entries[accessors[name]])
            places[name] = self._accessor(component, len(array), array.shape[1], view, more)
        component, _ = coded.accessors.get("indices", (UINT, False))
        corners = stored("indices", coded.shape.index, component)
        view = self._view(stream, "indices", corners, component)
        for primitives, (start, count) in zip(bundle, coded.shape.pieces, strict=True):
            more = {}
            if start:
                more["byteOffset"] = start * corners.itemsize
            if "indices" in primitives[0]:
                more |= _words(entries[primitives[0]["indices"]])
            indices = self._accessor(component, count, 1, view, more)
            for primitive in primitives:
                primitive["indices"] = indices
                # Strips and fans were made triangles, which is the default.
                primitive.pop("mode", None)
                primitive["attributes"] = {
                    name: places[name] for name in primitive["attributes"] if name in places
                }
                for number, target in enumerate(primitive.get("targets", [])):
                    target |= {name: places[f"{number}/{name}"] for name in target}

    def _accessor(self, component: int, count: int, width: int, view: int, more: Tree) -> int:
        """Return an accessor of a stream; primitives with equal streams share it."""
        key = ("accessor", component, count, width, view, json.dumps(more, sort_keys=True))
        if key not in self._shared:
            self._shared[key] = self.accessor(component, count, width, view, **more)
        return self._shared[key]

    def _view(self, stream: int, name: str, array: Array, component: int) -> int:
        """Return the bufferView of an array of a stream; primitives with equal streams share it."""
        key = ("bufferView", stream, name, component)
        if key not in self._shared:
            self._shared[key] = self._new_view(stream, name, array, component)
        return self._shared[key]

    def _new_view(self, stream: int, name: str, array: Array, component: int) -> int:
        extension: Tree = {"stream": stream, "attribute": name}
        usual_component = FLOAT
        if name == "indices":
            usual_component = UINT
        if component != usual_component:
            extension["componentType"] = component
        view: Tree = {"buffer": 1, "byteLength": array.nbytes, "extensions": {EXTENSION: extension}}
        if self._fallback:
            view["byteOffset"] = self._virtual
            self.plain.append(array.tobytes() + b"\0" * (-array.nbytes % 4))
            self._virtual += array.nbytes + -array.nbytes % 4
        else:
            # Decoders fill this buffer, and no file holds it. Views may overlap, as each is filled for itself.
            self._virtual = max(self._virtual, array.nbytes)
        return self.add("bufferViews", view)

    def _take_images(self, rule: ImageRule | None) -> None:
        """Put images inside that lie elsewhere, and write all by a rule where that makes them smaller."""
        for number, image in enumerate(self.tree.get("images", [])):
            if not rule and "uri" not in image:
                continue
            name, data = self._document.image(number)
            if not data:
                continue
            kind = image.get("mimeType") or gltf.mime_of(data)
            smaller_data: bytes | None = None
            if rule:
                # An image that its rule makes larger stays as it is.
                smaller_data = smaller(data, rule)
                image_name = name or f"image {number}"
                self.images.append(compare_image(image_name, data, smaller_data or data))
            if rule and smaller_data:
                kind = f"image/{rule.kind}"
            if kind and (smaller_data or "uri" in image):
                image.pop("uri", None)
                image |= {"mimeType": kind, "bufferView": self.view(smaller_data or data)}
            if smaller_data and kind == "image/webp":
                self._name_webp(number)

    def _name_webp(self, image: int) -> None:
        """Let the textures of an image say that it is a WebP."""
        for texture in self.tree.get("textures", []):
            if texture.get("source") == image:
                del texture["source"]
                texture.setdefault("extensions", {})[gltf.WEBP] = {"source": image}
                self.use(gltf.WEBP, required=True)

    def finished(self, images: ImageRule | None = None) -> bytes:
        """Return the .glb without replaced data, with external images inside, and with plain geometry elsewhere."""
        tree = self.tree
        self._take_images(images)
        self._write_draco()
        self._drop_accessors()
        self._place_views()
        unused_extensions = {DRACO, *MESHOPT}
        if not self._virtual:
            unused_extensions.add(EXTENSION)
        for key in ("extensionsUsed", "extensionsRequired"):
            # Everything that these extensions held is plain now, or in a stream.
            tree[key] = [name for name in tree.get(key, []) if name not in unused_extensions]
        tree["buffers"] = []
        if self.size:
            tree["buffers"].append({"byteLength": self.size})
        if self._virtual:
            virtual_buffer: Tree = {
                "byteLength": self._virtual,
                "extensions": {EXTENSION: {"fallback": True}},
            }
            if self._fallback:
                virtual_buffer["uri"] = quote(self._fallback)
            tree["buffers"].append(virtual_buffer)
            self.use(EXTENSION, required=not self._fallback)
        for key in ("accessors", "bufferViews", "buffers", "extensionsUsed", "extensionsRequired"):
            if not tree.get(key):
                tree.pop(key, None)
        self.tree = _short(tree)
        return self.glb()

    def _drop_accessors(self) -> None:
        """Drop those that were replaced; others take their bytes out of bufferViews that they shared with these."""
        entries: list[Tree] = self.tree.get("accessors", [])
        numbers = {id(entry): number for number, entry in enumerate(entries)}
        blank: Tree = {"componentType": COMPONENTS["uint8"], "count": 1, "type": "SCALAR"}
        self._renumber("accessors", blank)
        kept_entries = self.tree["accessors"]
        dropped = numbers.keys() - {id(entry) for entry in kept_entries}
        shared_views = {entry.get("bufferView") for entry in entries if id(entry) in dropped}
        shared_views -= {None, *self.foreign_numbers}
        for entry in kept_entries:
            # Only the bytes that somebody still uses move to the new buffer.
            if entry.get("bufferView") in shared_views and "sparse" not in entry:
                strided = "byteStride" in self._document.item("bufferViews", entry["bufferView"])
                entry["bufferView"] = self.table(
                    self._document.array(numbers[id(entry)]), packed=not strided
                )
                entry.pop("byteOffset", None)

    def _write_draco(self) -> None:
        """Write the arrays that Draco held of primitives that were not coded."""
        for primitive in primitives_of(self.tree):
            if DRACO not in primitive.get("extensions", {}):
                continue
            del primitive["extensions"][DRACO]
            primitive.pop("mode", None)
            if not primitive["extensions"]:
                del primitive["extensions"]
            for name, index in accessors_of(primitive).items():
                accessor = self.tree["accessors"][index]
                if index < len(self._document.items("accessors")) and "bufferView" not in accessor:
                    values = self._document.array(index)
                    accessor |= {
                        "bufferView": self.table(values, packed=not name),
                        "count": len(values),
                    }

    def _place_views(self) -> None:
        """Drop replaced views, and put the bytes of the others into the new buffer."""
        views: list[Tree] = self.tree.setdefault("bufferViews", [])
        used = {
            holder[key] for holder, key in references(self.tree, "bufferViews")
        } | self.foreign_numbers
        for number, view in enumerate(views[: len(self._document.items("bufferViews"))]):
            extensions = view.get("extensions", {})
            packed = [name for name in (EXTENSION, *MESHOPT) if extensions.pop(name, None)]
            if "extensions" in view and not extensions:
                del view["extensions"]
            replaced = number in self._before["bufferViews"] and number not in used
            if number in self._moved or replaced or (self._whole and not packed):
                continue
            # Unpacked where it was compressed, since readers of the result need not know that extension.
            data = self._document.view(number)
            view |= {"buffer": 0, "byteOffset": self.append(data)}
            if packed:
                view["byteLength"] = len(data)
        self._renumber("bufferViews", {"buffer": 0, "byteLength": 1})

    def _renumber(self, kind: str, blank: Tree) -> None:
        """Drop the entries of a kind that were referenced and no longer are; those that others may name stay there."""
        entries = self.tree.get(kind, [])
        places = list(references(self.tree, kind))
        every = set(range(len(entries)))
        fixed = self.foreign_numbers & every
        kept_numbers = (
            {holder[key] for holder, key in places} | (every - self._before[kind]) | fixed
        )
        # Numbers that unknown extensions may name stay. All others close ranks, as validators want no unused entries.
        free = iter(sorted(every - fixed))
        numbers: dict[int, int] = {}
        for old in sorted(kept_numbers):
            if old in fixed:
                numbers[old] = old
            else:
                numbers[old] = next(free)
        for holder, key in places:
            holder[key] = numbers[holder[key]]
        self.tree[kind] = [dict(blank) for _ in range(max(numbers.values(), default=-1) + 1)]
        for old, new in numbers.items():
            self.tree[kind][new] = entries[old]


def _words(accessor: Tree) -> Tree:
    return {key: accessor[key] for key in ("name", "extras") if key in accessor}


def _short(node: Any) -> Any:
    """Return JSON with numbers as short as single precision allows; extras and extensions stay as they are."""
    if isinstance(node, dict):
        shortened: Tree = {}
        for key, value in node.items():
            shortened[key] = value
            if key not in ("extras", "extensions"):
                shortened[key] = _short(value)
        return shortened
    if isinstance(node, list):
        return [_short(value) for value in node]
    if not isinstance(node, float) or abs(node) > _MOST or np.float32(node) != node:
        return node
    # Writers print doubles of single precision with up to 17 digits. Shorter ones mean the same number.
    if node.is_integer() and abs(node) < WHOLE:
        return int(node)
    return float(str(np.float32(node)))
