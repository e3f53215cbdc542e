"""Which primitives of a scene one stream holds, and their streams."""

from __future__ import annotations

from dataclasses import dataclass

from bsm.bitstream.errors import BsmError
from bsm.codec.static.decoder import decode
from bsm.gltf.document import Document, Tree
from bsm.gltf.primitives import Coder, Drawn, arrays_of, as_mesh, drawn, like

Bundle = list[list[Tree]]
"""Primitives of one mesh that one stream can hold, each with all others that are drawn of the same accessors."""


@dataclass(frozen=True, eq=False)
class Coded:
    """The stream of a bundle, what is drawn of it, and the accessors of that: component type, normalized or not."""

    stream: bytes
    shape: Drawn
    accessors: dict[str, tuple[int, bool]]


def code_bundle(document: Document, bundle: Bundle, coder: Coder) -> Coded | str:
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
    return Coded(stream, shape, found.accessors)


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
