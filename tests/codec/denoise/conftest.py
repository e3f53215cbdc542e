"""Clean and noisy partners of real meshes, where the folder is there."""

from pathlib import Path

import pytest

import bsm
from tests.codec.denoise.denoise_shapes import Partners


@pytest.fixture
def partners(meshes: Path) -> Partners:
    """Function from the names of a clean and a noisy mesh to both."""
    return lambda clean, noisy: (
        bsm.load(meshes / f"static/{clean}.ply"),
        bsm.load(meshes / f"noisy/{noisy}.ply"),
    )
