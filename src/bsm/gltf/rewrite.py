"""The tree of a glTF document, rewritten for streams in the place of accessors; everything else stays as it was."""

import copy
import io
import re
from collections.abc import Iterator
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


def users_of(bundles: list[Bundle], tree: Tree, numbers_by_others: set[int]) -> dict[int, set[int]]:
    """Which bundles use each accessor; -1: something else."""
    users: dict[int, set[int]] = {index: {-1} for index in numbers_by_others}
    coded: dict[int, int] = {}
    for number, bundle in enumerate(bundles):
        for primitive in (primitive for same in bundle for primitive in same):
            # By identity, as equal dictionaries stand in many places of a tree.
            holders = (primitive, primitive["attributes"], *primitive.get("targets", []))
            coded |= {id(holder): number for holder in holders}
    # Everything that refers to an accessor is known here. An accessor may only go when nothing else does.
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


# An unknown extension may name accessors by any key, so every whole number in it counts as one. Keeping too much is
# safe.
def numbers_by_others(node: Any, *, inside: bool = False) -> set[int]:
    """Numbers in extensions that are not known: they may be those of accessors or bufferViews."""
    if isinstance(node, dict):
        numbers = set[int]()
        for key, value in node.items():
            if key == "extensions" and isinstance(value, dict):
                safe_names = {
                    name for name in value if OF_LOOKS.fullmatch(name) or name in (EXTENSION, DRACO, *MESHOPT)
                }
                numbers |= set().union(
                    *(numbers_by_others(value[name], inside=name not in safe_names) for name in value)
                )
            elif key != "extras":
                numbers |= numbers_by_others(value, inside=inside)
        return numbers
    if isinstance(node, list):
        return set().union(*(numbers_by_others(item, inside=inside) for item in node))
    if isinstance(node, str):
        return {int(number) for number in re.findall(r"/(\d{1,9})", node)} if inside else set()
    return {int(node)} if inside and isinstance(node, int | float) and abs(node) < WHOLE else set()


class Rewritten(gltf.Growing):
    """The tree of a document that is changed, and the bytes of its new buffer."""

    def __init__(self, document: gltf.Document, fallback: str | None) -> None:
        # A copy: the document is still read, while its tree is changed here.
        super().__init__(io.BytesIO(), copy.deepcopy(document.tree))
        self._document, self._fallback = document, fallback
        unknown = set().union(*map(document.unread_in, document.items("buffers")))
        packed = set().union(*map(document.unread_in, document.items("bufferViews")))
        if unknown or (packed and len(document.items("buffers")) > 1):
            raise UnsupportedError(f"{min(unknown | packed)} may name bytes of buffers that would move")
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
        self.plain: list[bytes] = []
        self.images: list[ImageComparison] = []

    def view(self, data: bytes, **more: Any) -> int:
        view = super().view(data, **more)
        self._moved.add(view)
        return view

    def would_shrink(self, streams: list[BundleStream], freed: list[int]) -> bool:
        """Return whether streams and their words are smaller than the accessors that they replace."""
        entries = {index: self._document.item("accessors", index) for index in freed}
        views = {entry["bufferView"] for entry in entries.values() if "bufferView" in entry} - self.foreign_numbers
        accessors_with_bytes = [
            n for n, e in entries.items() if e.get("bufferView") in views or n in self._document.of_draco
        ]
        # JSON counts as well: a small mesh may save fewer bytes than its stream needs words.
        before = _WORDS * (len(freed) + len(views)) + sum(
            self._document.array(index).nbytes for index in accessors_with_bytes
        )
        words = sum(3 + 2 * len(coded.shape.arrays) + len(coded.shape.pieces) for coded in streams)
        return bool(streams) and sum(len(coded.stream) for coded in streams) + _WORDS * words < before

    def put(self, bundle: Bundle, coded: BundleStream) -> None:
        """Put a stream in the place of the accessors of a bundle."""
        stream = self.view(coded.stream)
        entries: list[Tree] = self.tree["accessors"]
        accessors, places = arrays_of(bundle[0][0]), dict[str, int]()
        for name, array in coded.shape.arrays.items():
            component, normalized = coded.accessors[name]
            view = self._view(stream, name, stored(name, array, component), component)
            more: Tree = {"normalized": True} if normalized else {}
            more |= gltf.bounds_of(array) if name.rpartition("/")[2] == "POSITION" else {}
            more |= _words(entries[accessors[name]])
            places[name] = self.accessor(component, len(array), array.shape[1], view, **more)
        component, _ = coded.accessors.get("indices", (UINT, False))
        corners = stored("indices", coded.shape.index, component)
        view = self._view(stream, "indices", corners, component)
        for same, (start, count) in zip(bundle, coded.shape.pieces, strict=True):
            more = {"byteOffset": start * corners.itemsize} if start else {}
            more |= _words(entries[same[0]["indices"]] if "indices" in same[0] else {})
            indices = self.accessor(component, count, 1, view, **more)
            for primitive in same:
                primitive["indices"] = indices
                # Strips and fans were made triangles, which is the default.
                primitive.pop("mode", None)
                attributes = {name: places[name] for name in primitive["attributes"] if name in places}
                primitive["attributes"] = attributes
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
            # Decoders fill this buffer, and no file holds it. Views may overlap, as each is filled for itself.
            self._virtual = max(self._virtual, array.nbytes)
        return self.add("bufferViews", view)

    def _take_images(self, rule: ImageRule | None) -> None:
        """Put images inside that lie elsewhere, and write all by a rule where that makes them smaller."""
        for number, image in enumerate(self.tree.get("images", [])):
            data = self._document.image(number)[1] if rule or "uri" in image else None
            # An image that its rule makes larger stays as it is.
            smaller_data = smaller(data, rule) if data and rule else None
            name = self._document.image(number)[0] or f"image {number}"
            self.images += [compare_image(name, data, smaller_data or data)] if data and rule else []
            kind = (
                f"image/{rule.kind}"
                if rule and smaller_data
                else image.get("mimeType") or (data and gltf.mime_of(data))
            )
            if data and kind and (smaller_data or "uri" in image):
                image.pop("uri", None)
                image |= {"mimeType": kind, "bufferView": self.view(smaller_data or data)}
            for texture in self.tree.get("textures", []) if smaller_data and kind == "image/webp" else ():
                if texture.get("source") == number:
                    del texture["source"]
                    texture.setdefault("extensions", {})[gltf.WEBP] = {"source": number}
                    self.use(gltf.WEBP, required=True)

    def finished(self, images: ImageRule | None = None) -> bytes:
        """Return the .glb without replaced data, with external images inside, and with plain geometry elsewhere."""
        tree = self.tree
        self._take_images(images)
        self._write_draco()
        self._drop_accessors()
        self._place_views()
        gone = {DRACO, *MESHOPT, *([] if self._virtual else [EXTENSION])}
        for key in ("extensionsUsed", "extensionsRequired"):
            # Everything that these extensions held is plain now, or in a stream.
            tree[key] = [name for name in tree.get(key, []) if name not in gone]
        tree["buffers"] = [{"byteLength": self.size}] if self.size else []
        if self._virtual:
            filled: Tree = {"byteLength": self._virtual, "extensions": {EXTENSION: {"fallback": True}}}
            tree["buffers"].append(filled | ({"uri": quote(self._fallback)} if self._fallback else {}))
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
        gone = numbers.keys() - {id(entry) for entry in kept_entries}
        shared = {
            entry["bufferView"] for entry in entries if id(entry) in gone and "bufferView" in entry
        } - self.foreign_numbers
        for entry in kept_entries:
            # Only the bytes that somebody still uses move to the new buffer.
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
            for name, index in accessors_of(primitive).items():
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
            unread = number in self._before["bufferViews"] and not {number} & (used | self.foreign_numbers)
            if number in self._moved or unread or (self._whole and not packed):
                continue
            # Unpacked where it was compressed, since readers of the result need not know that extension.
            data = self._document.view(number)
            view |= {"buffer": 0, "byteOffset": self.append(data), **({"byteLength": len(data)} if packed else {})}
        self._renumber("bufferViews", {"buffer": 0, "byteLength": 1})

    def _renumber(self, kind: str, blank: Tree) -> None:
        """Drop the entries of a kind that were referenced and no longer are; those that others may name stay there."""
        entries, places = self.tree.get(kind, []), list(references(self.tree, kind))
        every = set(range(len(entries)))
        stay = self.foreign_numbers & every
        kept_numbers = {holder[key] for holder, key in places} | (every - self._before[kind]) | stay
        # Numbers that unknown extensions may name stay. All others close ranks, as validators want no unused entries.
        free = iter(sorted(every - stay))
        numbers = {old: old if old in stay else next(free) for old in sorted(kept_numbers)}
        for holder, key in places:
            holder[key] = numbers[holder[key]]
        origin = {new: old for old, new in numbers.items()}
        size = max(origin, default=-1) + 1
        self.tree[kind] = [entries[origin[new]] if new in origin else dict(blank) for new in range(size)]


def _words(accessor: Tree) -> Tree:
    return {key: accessor[key] for key in ("name", "extras") if key in accessor}


def _short(node: Any) -> Any:
    """JSON with numbers as short as single precision allows; extras and extensions stay as they are."""
    if isinstance(node, dict):
        return {key: value if key in ("extras", "extensions") else _short(value) for key, value in node.items()}
    if isinstance(node, list):
        return [_short(value) for value in node]
    if not isinstance(node, float) or abs(node) > _MOST or np.float32(node) != node:
        return node
    # Writers print doubles of single precision with up to 17 digits. Shorter ones mean the same number.
    return int(node) if node.is_integer() and abs(node) < WHOLE else float(str(np.float32(node)))
