"""A sequence as a scene of glTF: one mesh, whose stream has all frames (`spec/EXT_bsm_compression.md`)."""

from __future__ import annotations

from typing import Any

import numpy as np

from bsm.bitstream.errors import UnsupportedError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.sequence_stream import SequenceStream
from bsm.gltf.compress import EXTENSION, bounds_of
from bsm.gltf.document import Tree, glb
from bsm.gltf.primitives import drawn

_UINT, _FLOAT = 5125, 5126
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_SORTING = ("part", "material")
"""Attributes of faces that only sort these."""
_HALF = 0.5**0.5
_TURNS = {"x": [0.0, 0.0, _HALF, _HALF], "z": [-_HALF, 0.0, 0.0, _HALF]}
"""What turns the axis that a sequence calls up to that of glTF."""


def moving_scene(stream: bytes) -> bytes:
    """Write a .glb whose one mesh shows the frames of a stream."""
    sequence = SequenceStream(iter([stream]))
    _, positions = next(sequence.changing_frames())
    attributes = tuple(a for a in sequence.attributes if a.domain != "face" or a.name not in _SORTING)
    for attribute in attributes:
        if attribute.domain == "face":
            raise UnsupportedError(f"glTF has no place for {attribute.name}, which faces have")
    shape = drawn(TriangleMesh(positions, sequence.faces, attributes, {}))
    kinds = {"POSITION": "VEC3", "NORMAL": "VEC3"}
    for semantic, names in (("texcoord", ("TEXCOORD_0", "TEXCOORD_1")), ("color", ("COLOR_0",))):
        found = [a for a in attributes if a.semantic == semantic]
        kinds |= {name: f"VEC{a.values.shape[1]}" for name, a in zip(names, found, strict=False)}
    counts = dict.fromkeys(kinds, shape.vertices) | {"indices": shape.corners}
    kinds["indices"] = "SCALAR"
    views: list[Tree] = [{"buffer": 0, "byteLength": len(stream)}]
    accessors: list[Tree] = []
    for name, kind in kinds.items():
        told: Tree = {"stream": 0, "attribute": name}
        size = 4 * _WIDTHS[kind] * counts[name]
        component = _UINT if name == "indices" else _FLOAT
        accessors.append({"bufferView": len(views), "componentType": component, "count": counts[name], "type": kind})
        views.append({"buffer": 1, "byteLength": size, "extensions": {EXTENSION: told}})
    accessors[0] |= bounds_of(positions.astype(np.float32))
    places = {name: number for number, name in enumerate(kinds)}
    primitive = {"indices": places.pop("indices"), "attributes": places}
    node: Tree = {"mesh": 0}
    metadata: dict[str, Any] = dict(sequence.metadata)
    if "name" in metadata:
        node["name"] = str(metadata["name"])
    turn = _TURNS.get(str(metadata.get("up", "y")).lower())
    if turn:
        node["rotation"] = turn
    room = max(view["byteLength"] for view in views[1:])
    tree: Tree = {
        "asset": {"version": "2.0", "generator": "bsm"},
        "extensionsUsed": [EXTENSION],
        "extensionsRequired": [EXTENSION],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [node],
        "meshes": [{"primitives": [primitive], "extensions": {EXTENSION: {"stream": 0}}}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(stream)}, {"byteLength": room, "extensions": {EXTENSION: {"fallback": True}}}],
    }
    return glb(tree, stream)
