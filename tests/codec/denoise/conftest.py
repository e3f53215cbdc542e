"""Clean and noisy partners of real meshes, where the folder is there."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from bsm.codec.geometry.mesh import TriangleMesh
from tests.codec.denoise.denoise_shapes import Partners


def read_binary_ply(path: Path) -> TriangleMesh:
    """The one layout the folder has: float32 x, y, z and lists of three int32."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    vertices, faces = (int(count) for count in re.findall(rb"element \w+ (\d+)", header))
    positions = np.frombuffer(body, "<f4", 3 * vertices).reshape(vertices, 3)
    rows = np.frombuffer(body, np.dtype([("count", "u1"), ("corners", "<i4", 3)]), faces, 12 * vertices)
    return TriangleMesh(positions, rows["corners"])


@pytest.fixture
def partners(meshes: Path) -> Partners:
    """Function from the names of a clean and a noisy mesh to both."""

    def read(clean: str, noisy: str) -> tuple[TriangleMesh, TriangleMesh]:
        return read_binary_ply(meshes / "static" / f"{clean}.ply"), read_binary_ply(meshes / "noisy" / f"{noisy}.ply")

    return read
