"""Streams of the preset "paper", against decoders that know the paper and the law, and nothing of the product."""

import importlib
from pathlib import Path

import numpy as np
import pytest

import bsm
from tests.shapes import torus
from tests.streams import info_of
from tools.surgery import frames_of


@pytest.fixture
def imported(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "spec"))
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    return importlib.import_module


@pytest.fixture
def numpy_decoder(imported):
    return imported("paper_decoder").decode


@pytest.fixture
def reference(imported):
    return imported("reference_decoder")


def off(decoder, stream):
    """How far the farthest vertex is from that of the product, over the diagonal; the faces are equal."""
    ours = bsm.decode(stream)
    theirs, faces = decoder(info_of(stream).header, frames_of(stream))
    assert np.array_equal(faces, ours.faces)
    return np.linalg.norm(theirs - ours.positions, axis=1).max() / ours.diagonal


@pytest.mark.parametrize(
    "options", [{}, {"keep": 0.1, "power": 1, "iterations": 2}, {"keep": 0.2, "power": 3}]
)
def test_a_decoder_from_the_paper_agrees(options, numpy_decoder):
    stream = bsm.encode(torus(30, 24, bumps=0.1), preset="paper", block_size=120, **options)
    assert off(numpy_decoder, stream) < 1e-3


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("name", ["fandisk_6475", "bunny_34834"])
@pytest.mark.parametrize("options", [{"keep": 0.1}, {}], ids=["fixed c", "DOI"])
def test_a_decoder_from_the_paper_agrees_on_real_meshes(name, options, numpy_decoder, meshes):
    assert (
        off(numpy_decoder, bsm.encode(meshes / "static" / f"{name}.ply", preset="paper", **options))
        < 1e-3
    )


@pytest.mark.parametrize(
    "options", [{}, {"keep": 0.4, "power": 3, "iterations": 2}, {"keep": 0.3, "power": 2}]
)
def test_streams_of_the_preset_come_back_with_the_same_bits(options, reference):
    stream = bsm.encode(torus(30, 24, bumps=0.1), preset="paper", block_size=90, **options)
    header = info_of(stream).header
    assert header.onorm == header.constants.power > 1 and stream[4] == 0x11  # 1.1 brought `onorm`
    positions, faces, skipped = reference.decode(stream)
    ours = bsm.decode(stream)
    assert (
        np.array_equal(positions, ours.positions)
        and np.array_equal(faces, ours.faces)
        and not skipped
    )


@pytest.mark.real
@pytest.mark.slow
def test_a_real_mesh_comes_back_with_the_same_bits(reference, meshes):
    stream = bsm.encode(meshes / "static" / "twelve_dodecahedron.ply", preset="paper")
    assert np.array_equal(reference.decode(stream)[0], bsm.decode(stream).positions)
