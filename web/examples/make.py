"""Make what the examples show: python make.py FOLDER writes ring.bsm, ring.glb and wave.bsm."""

import struct
import sys
import zlib
from pathlib import Path

import numpy as np

import bsm
from bsm.cli import main
from bsm.codec.geometry.attributes import Attribute

folder = Path(sys.argv[1])
folder.mkdir(exist_ok=True)


def png(pixels: np.ndarray) -> bytes:
    """An image of red, green and blue bytes."""
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    chunks = [
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows)),
        (b"IEND", b""),
    ]
    framed = (
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(framed)


across, around = 96, 32
u, v = (
    grid.ravel()
    for grid in np.meshgrid(
        np.linspace(0, 1, across + 1), np.linspace(0, 1, around + 1), indexing="ij"
    )
)
radius = 1 + 0.4 * np.cos(2 * np.pi * v)
positions = np.stack(
    [radius * np.cos(2 * np.pi * u), 0.4 * np.sin(2 * np.pi * v), radius * np.sin(2 * np.pi * u)],
    axis=1,
)
corner = np.arange(across)[:, None] * (around + 1) + np.arange(around)
a, b, c, d = (x.ravel() for x in (corner, corner + 1, corner + around + 1, corner + around + 2))
faces = np.concatenate([np.stack([a, b, c], 1), np.stack([b, d, c], 1)]).astype(np.int32)
squares = (np.add.outer(np.arange(64) // 8, np.arange(64) // 8) % 2)[..., None]
image = np.where(squares, [230, 60, 40], [40, 90, 220]).astype(np.uint8)
coordinates = Attribute(
    "TEXCOORD_0", np.stack([8 * u, 3 * v], 1).astype(np.float32), "vertex", "texcoord"
)
metadata: dict[str, str | int | float | bytes] = {
    "material.0.baseColorTexture": 0,
    "material.0.metallicFactor": 0.0,
}
metadata["image.0.data"] = png(image)
ring = bsm.TriangleMesh(positions, faces, (coordinates,), metadata)
(folder / "ring.bsm").write_bytes(bsm.encode(ring))
bsm.save(ring, folder / "plain.glb")
assert main(["glb", str(folder / "plain.glb"), "-o", str(folder / "ring.glb"), "-f"]) == 0
times = np.linspace(0, 2 * np.pi, 48, endpoint=False)
frames = np.stack(
    [positions * (1 + 0.2 * np.sin(3 * 2 * np.pi * u + time))[:, None] for time in times]
)
(folder / "wave.bsm").write_bytes(bsm.encode_sequence(frames, faces, frame_rate=24, kg=0.1))
