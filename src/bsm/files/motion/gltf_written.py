"""A sequence as a GLB that plays wherever glTF does: each frame a morph target, and weights that go from one to the
next.

Between frames the weights of two targets cross, so that what is shown is the straight line between them. Nothing but
the first frame is kept in memory; the targets wait in a file until their number is known.
"""

from __future__ import annotations

import json
import shutil
import struct
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, BinaryIO

import numpy as np

from bsm.bitstream.errors import LimitError, MeshError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import face_normals
from bsm.files.formats.glb import write_glb
from bsm.files.motion.told import Told
from bsm.files.rows import Doubles

MOST_FRAMES = 2048
"""Viewers keep targets as the layers of one texture, of which graphics cards have 2,048, and some old ones 256."""
USUAL_RATE = 24.0
_ROW = "BSM_ROW"
_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_MOST_BYTES = (1 << 32) - 1


@contextmanager
def write_gltf(file: BinaryIO, path: str, faces: Faces, told: Told) -> Iterator[Callable[[Positions], None]]:
    """Write a GLB; yields what takes frame after frame."""
    with tempfile.TemporaryFile() as spool:
        targets: _Targets | None = None

        def write(frame: Positions) -> None:
            nonlocal targets
            if targets is None:
                targets = _Targets(spool, told.mesh(frame, faces), Path(path).stem)
            else:
                targets.add(frame)

        yield write
        assert targets is not None
        told.loses(targets.left_out)
        targets.finish(file, told.frame_rate or USUAL_RATE)


class _Targets:
    """The first frame as a GLB, and what the others add to it."""

    def __init__(self, spool: IO[bytes], first: TriangleMesh, stem: str) -> None:
        self._spool, self._faces = spool, first.faces
        self._frames = 1
        rows = np.arange(len(first.positions), dtype=np.float32)[:, None]
        if len(rows) > 1 << 24:
            raise MeshError("a GLB of moving meshes can have 16,777,216 vertices")
        normals = _vertex_normals(first.positions, first.faces)
        kept = [one for one in first.attributes if one.semantic != "normal"]
        more = (Attribute("normal", normals.astype(np.float32), "vertex", "normal"), Attribute(_ROW, rows))
        still = TriangleMesh(first.positions, first.faces, (*kept, *more), first.metadata)
        written = write_glb(still, stem)
        self.left_out = written.left_out
        self._tree, self._binary = _parsed(written.data)
        self._first = (first.positions, normals)
        self._rows = {id(one): self._taken_rows(one) for one in self._primitives()}
        for one in self._primitives():
            one["targets"] = []

    def _primitives(self) -> list[dict[str, Any]]:
        return [one for mesh in self._tree["meshes"] for one in mesh["primitives"]]

    def _taken_rows(self, primitive: dict[str, Any]) -> np.ndarray:
        """Which vertex of the sequence each of a primitive's is."""
        accessor = self._tree["accessors"][primitive["attributes"].pop(f"_{_ROW}")]
        view = self._tree["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(self._binary, "<f4", accessor["count"], start).astype(np.int64)

    def add(self, frame: Positions) -> None:
        """Take the next frame."""
        if self._frames == MOST_FRAMES:
            raise LimitError(
                f"a GLB holds each frame as a morph target, of which viewers take {MOST_FRAMES}; "
                "take fewer with --frames A:B, or write USD"
            )
        self._frames += 1
        now = (frame, _vertex_normals(frame, self._faces))
        for primitive in self._primitives():
            rows = self._rows[id(primitive)]
            deltas = [(one[rows] - other[rows]).astype("<f4") for one, other in zip(now, self._first, strict=True)]
            places = {"POSITION": self._accessor(deltas[0]), "NORMAL": self._accessor(deltas[1])}
            primitive["targets"].append(places)

    def _accessor(self, values: np.ndarray) -> int:
        """Add numbers; the place of their accessor."""
        if not np.isfinite(values).all():
            raise MeshError(f"frame {self._frames - 1} is beyond single precision, which GLB has")
        size = values.nbytes
        start = len(self._binary) + self._spool.tell()
        if start + size > _MOST_BYTES:
            raise LimitError("the frames take more than the 4 GiB of a GLB; take fewer with --frames A:B, or write USD")
        self._spool.write(values.tobytes())
        self._tree["bufferViews"].append({"buffer": 0, "byteOffset": start, "byteLength": size})
        width = 1 if values.ndim == 1 else values.shape[1]
        accessor: dict[str, Any] = {"bufferView": len(self._tree["bufferViews"]) - 1, "componentType": 5126}
        accessor |= {"count": len(values), "type": {1: "SCALAR", 3: "VEC3"}[width]}
        accessor |= {side: np.atleast_1d(value(values, axis=0)).tolist() for side, value in _SIDES.items()}
        self._tree["accessors"].append(accessor)
        return len(self._tree["accessors"]) - 1

    def finish(self, file: BinaryIO, rate: float) -> None:
        """Write the GLB."""
        tree, count = self._tree, self._frames - 1
        if count:
            weights = np.vstack([np.zeros((1, count), "<f4"), np.eye(count, dtype="<f4")]).reshape(-1)
            times = self._accessor((np.arange(self._frames) / rate).astype("<f4"))
            sampler = {"input": times, "output": self._accessor(weights), "interpolation": "LINEAR"}
            moving = [number for number, node in enumerate(tree["nodes"]) if "mesh" in node]
            channels = [{"sampler": 0, "target": {"node": number, "path": "weights"}} for number in moving]
            tree["animations"] = [{"name": "frames", "samplers": [sampler], "channels": channels}]
            for mesh in tree["meshes"]:
                mesh["weights"] = [0.0] * count
        size = len(self._binary) + self._spool.tell()
        tree["buffers"][0]["byteLength"] = size
        text = json.dumps(tree, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + size, len(text), _JSON))
        file.write(text)
        file.write(struct.pack("<II", size, _BINARY))
        file.write(self._binary)
        self._spool.seek(0)
        shutil.copyfileobj(self._spool, file)


_SIDES: dict[str, Callable[..., Any]] = {"min": np.min, "max": np.max}


def _parsed(data: bytes) -> tuple[dict[str, Any], bytes]:
    size = int.from_bytes(data[12:16], "little")
    binary = data[28 + size :]
    return json.loads(data[20 : 20 + size]), binary + b"\0" * (-len(binary) % 4)


def _vertex_normals(positions: Positions, faces: Faces) -> Doubles:
    """The mean of the normals of a vertex' faces, shape (n, 3); a vertex without any looks up."""
    normals = face_normals(positions, faces)
    sums = np.column_stack(
        [np.bincount(faces.reshape(-1), np.repeat(axis, 3), minlength=len(positions)) for axis in normals.T]
    )
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    found: Doubles = np.divide(sums, lengths, out=np.tile([0.0, 0.0, 1.0], (len(sums), 1)), where=lengths > 1e-12)
    return found
