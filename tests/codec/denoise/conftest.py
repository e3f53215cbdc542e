"""Clean and noisy partners of real meshes, where the folder is there."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
import pytest
from denoise_shapes import Partners

from codec.mesh import TriangleMesh

FOLDER = Path(os.environ.get("BSM_MESHES", Path(__file__).parents[4] / "shared" / "meshes"))


def read_binary_ply(path: Path) -> TriangleMesh:
    """The one layout the folder has: float32 x, y, z and lists of three int32."""
    data = path.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    vertices, faces = (int(count) for count in re.findall(rb"element \w+ (\d+)", header))
    positions = np.frombuffer(body, "<f4", 3 * vertices).reshape(vertices, 3)
    rows = np.frombuffer(body, np.dtype([("count", "u1"), ("corners", "<i4", 3)]), faces, 12 * vertices)
    return TriangleMesh(positions, rows["corners"])


@pytest.fixture
def partners() -> Partners:
    """Function from the names of a clean and a noisy mesh to both."""
    if not FOLDER.is_dir():
        pytest.skip(f"no folder of real meshes at {FOLDER}; set BSM_MESHES")

    def read(clean: str, noisy: str) -> tuple[TriangleMesh, TriangleMesh]:
        return read_binary_ply(FOLDER / "static" / f"{clean}.ply"), read_binary_ply(FOLDER / "noisy" / f"{noisy}.ply")

    return read
