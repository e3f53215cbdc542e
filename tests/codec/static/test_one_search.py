"""The default is the smallest file of its promise, as far as the rule of bytes and decoding time goes."""

from pathlib import Path

import pytest

from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import Contract
from bsm.files.mesh import read_mesh
from tests.shapes import torus


def test_smooth_meshes_have_larger_blocks() -> None:
    smooth = torus(48, 32, bumps=0.0)
    usual = Encoder(smooth, EncodeOptions(threads=1)).draft()
    small = Encoder(smooth, EncodeOptions(threads=1, block_size=449)).draft()
    assert usual.size < 0.6 * small.size
    assert small.header.block_size < usual.header.block_size == 48 * 32


@pytest.mark.parametrize(("bound", "binding"), [(0.0002, "vertex error"), (0.01, "look")])
def test_the_encoder_says_what_binds(bound: float, binding: str) -> None:
    encoder = Encoder(torus(), EncodeOptions(contract=Contract(bound, look=1.0), threads=1))
    encoder.encode()
    assert encoder.binding == binding


@pytest.mark.real
def test_folds_do_not_leave_the_look_unused(meshes: Path) -> None:
    cloth = read_mesh(str(meshes / "assets/cloth.obj")).mesh.bare
    size = Encoder(cloth, EncodeOptions(threads=1)).draft().size
    assert size < 3500  # 3800 with the usual steps along tangents
