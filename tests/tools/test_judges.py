"""Streams of the encoder by decoders that share no code with it."""

import numpy as np
import pytest

import bsm
from tests.shapes import torus
from tools.attack import judges
from tools.attack.judges import difference, streams


@pytest.mark.parametrize("preset", ["grid14", "lossless"])
def test_other_decoders_agree(preset, tmp_path):
    bsm.save(torus(12, 9), path := tmp_path / "torus.ply")
    for name, stream in streams(path, [preset]):
        assert difference(stream, vertices=1000) is None, name


@pytest.mark.real
@pytest.mark.parametrize("name", ["assets/duck_uv.obj", "hostile/cgal_blobby_3cc.off"])
def test_other_decoders_agree_on_real_meshes(name, meshes):
    for stream_of, stream in streams(meshes / name, ["grid14", "lossless"]):
        assert difference(stream) is None, stream_of


def test_a_difference_is_found(monkeypatch):
    stream = bsm.encode(torus(12, 9), preset="grid14")
    positions, faces, attributes = judges.whole(stream)
    moved = positions.copy()
    moved[5, 1] = np.nextafter(moved[5, 1], 9.0)
    monkeypatch.setattr(judges, "whole", lambda _: (moved, faces, attributes))
    assert difference(stream) == "release 1.0: positions differs"
