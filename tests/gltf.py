"""Scenes of glTF that grow piece by piece."""

import io
import json
import struct
from typing import Any

import numpy as np
import pytest

from bsm import MeshFile, read_mesh
from bsm.gltf.coding import COMPONENTS
from tests.shapes import torus

Tree = dict[str, Any]


def unpack(data: bytes) -> tuple[Tree, bytes]:
    """The tree of a .glb, and its numbers."""
    begin = 28 + int.from_bytes(data[12:16], "little")
    return json.loads(data[20 : begin - 8]), data[begin:]


def glb(tree: Any, data: bytes) -> bytes:
    """A .glb of any tree, valid or not."""
    text, data = json.dumps(tree).encode(), data + b"\0" * (-len(data) % 4)
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", len(data), 0x004E4942) + data


TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Built:
    """A scene that grows: `array` returns the number of an accessor."""

    def __init__(self, **tree: Any) -> None:
        self.tree: Tree = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], **tree}
        self.data = b""

    def view(self, data: bytes, **more: Any) -> int:
        self.tree["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more}
        )
        self.data += data + b"\0" * (-len(data) % 4)
        return len(self.tree["bufferViews"]) - 1

    def array(self, values: Any, **more: Any) -> int:
        values = np.asarray(values)
        values = values.reshape(len(values), -1)
        rows = np.ascontiguousarray(values).view(np.uint8).reshape(len(values), -1)
        padded = np.pad(rows, ((0, 0), (0, -rows.shape[1] % 4 if values.shape[1] > 1 else 0)))
        stride = {} if padded.shape == rows.shape else {"byteStride": padded.shape[1]}
        accessor = {
            "componentType": COMPONENTS[values.dtype.name],
            "count": len(values),
            "type": TYPES[values.shape[1]],
        }
        self.tree["accessors"].append(
            {"bufferView": self.view(padded.tobytes(), **stride), **accessor, **more}
        )
        return len(self.tree["accessors"]) - 1

    def mesh(self, *primitives: Tree, **more: Any) -> int:
        self.tree.setdefault("meshes", []).append({"primitives": list(primitives), **more})
        return len(self.tree["meshes"]) - 1

    def nodes(self, *nodes: Tree) -> "Built":
        self.tree |= {
            "nodes": list(nodes),
            "scenes": [{"nodes": list(range(len(nodes)))}],
            "scene": 0,
        }
        return self

    @property
    def bytes(self) -> bytes:
        self.tree["buffers"] = [{"byteLength": max(len(self.data), 4)}]
        return glb(self.tree, self.data.ljust(4, b"\0"))

    def read(self) -> MeshFile:
        return read_mesh(self.bytes, "glb")


def picture() -> bytes:
    image = pytest.importorskip("PIL.Image")
    noise = np.random.default_rng(3).integers(0, 255, (64, 64, 3), np.uint8)
    written = io.BytesIO()
    image.fromarray(noise).save(written, "PNG")
    return written.getvalue()


def scene() -> Built:
    """Two instances of a skinned and textured torus, a morphing one, an animation, and materials with extensions."""
    mesh, built = (
        torus(40, 24),
        Built(extensionsUsed=["KHR_texture_transform", "KHR_materials_sheen"]),
    )
    across = (mesh.positions - mesh.positions.min(axis=0)) / np.ptp(mesh.positions, axis=0)
    count, points, corners = (
        len(mesh.positions),
        mesh.positions.astype(np.float32),
        mesh.faces.astype(np.uint16),
    )
    weights = np.zeros((count, 4), np.float32)
    weights[:, 0], weights[:, 1] = across[:, 0], 1 - across[:, 0]
    skinned = {
        "POSITION": built.array(points, min=[-2, -2, -2], max=[2, 2, 2]),
        "TEXCOORD_0": built.array(across[:, :2].astype(np.float32)),
        "JOINTS_0": built.array(np.tile(np.array([0, 1, 0, 0], np.uint8), (count, 1))),
        "WEIGHTS_0": built.array(weights),
    }
    index = built.array(corners.ravel())
    moved, target = (
        built.array(points + 1, min=[-1, -1, -1], max=[3, 3, 3]),
        np.full((count, 3), 0.25, np.float32),
    )
    morphing: Tree = {
        "attributes": {"POSITION": moved},
        "targets": [{"POSITION": built.array(target)}],
    }
    matrices = built.array(np.tile(np.eye(4, dtype=np.float32).reshape(1, 16), (2, 1)))
    times = built.array(np.array([0, 1], np.float32), min=[0], max=[1])
    sampler = {"input": times, "output": built.array(np.array([[0, 0, 0], [1, 2, 3]], np.float32))}
    morphing["indices"] = built.array(corners.ravel())
    image = built.view(picture())
    textured = {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [30, 30]}}}
    sheen = {"KHR_materials_sheen": {"sheenRoughnessFactor": 0.5}}
    built.mesh({"attributes": skinned, "indices": index, "material": 0})
    built.mesh(morphing)
    placed = {"mesh": 0, "skin": 0}
    built.nodes(
        placed,
        {**placed, "translation": [3, 0, 0]},
        {"mesh": 1, "name": "morphing"},
        {"children": [4]},
        {},
    )
    built.tree["scenes"][0]["nodes"].remove(4)
    channel = {"sampler": 0, "target": {"node": 1, "path": "translation"}}
    built.tree |= {
        "skins": [{"joints": [3, 4], "inverseBindMatrices": matrices}],
        "animations": [{"samplers": [sampler], "channels": [channel]}],
        "materials": [
            {"pbrMetallicRoughness": {"baseColorTexture": textured}, "extensions": sheen}
        ],
        "textures": [{"source": 0}],
        "images": [{"bufferView": image, "mimeType": "image/png"}],
    }
    return built
