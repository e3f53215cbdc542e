"""The extension `paper`, against decoders that know the paper and the law, and nothing of the product."""

import importlib
import json
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm.files.inspection import inspect_stream
from tests.shapes import torus
from tools.surgery import frames_of
from tools.vectors.store import NEEDS, read_manifest


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
    return imported("paper_reference")


def off(decoder, stream):
    """How far the farthest vertex is from that of the product, over the diagonal; the faces are equal."""
    ours = bsm.decode(stream)
    theirs, faces = decoder(inspect_stream(iter([stream])).header, frames_of(stream))
    assert np.array_equal(faces, ours.faces)
    return np.linalg.norm(theirs - ours.positions, axis=1).max() / ours.diagonal


@pytest.mark.parametrize("options", [{}, {"keep": 0.1, "power": 1, "iterations": 2}, {"keep": 0.2, "power": 3}])
def test_a_decoder_from_the_paper_agrees(options, numpy_decoder):
    stream = bsm.encode(torus(30, 24, bumps=0.1), preset="paper", block_size=120, **options)
    assert off(numpy_decoder, stream) < 1e-3


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("name", ["fandisk_6475", "bunny_34834"])
@pytest.mark.parametrize("options", [{"keep": 0.1}, {}], ids=["fixed c", "DOI"])
def test_a_decoder_from_the_paper_agrees_on_real_meshes(name, options, numpy_decoder, meshes):
    assert off(numpy_decoder, bsm.encode(meshes / "static" / f"{name}.ply", preset="paper", **options)) < 1e-3


PAPER = {name for name, needs in json.loads(NEEDS.read_text()).items() if set(needs) == {"core", "paper"}}
GOOD = [vector for vector in read_manifest() if vector.error is None and vector.name in PAPER]


LONG = {"good-pieces-many-iterations", "good-pieces-exact"}


@pytest.mark.parametrize(
    "vector", [pytest.param(v, id=v.name, marks=[pytest.mark.slow] * (v.name in LONG)) for v in GOOD]
)
def test_the_reference_of_the_extension_gives_the_same_bits(vector, reference):
    stream = vector.stream.read_bytes()
    positions, faces = reference.decode(inspect_stream(iter([stream])).header, frames_of(stream))
    with np.load(vector.expected) as right:
        assert np.array_equal(positions, right["positions"]) and np.array_equal(faces, right["faces"])


@pytest.mark.parametrize("options", [{}, {"keep": 0.4, "power": 3, "iterations": 2}, {"keep": 0.3, "power": 2}])
def test_streams_of_the_preset_come_back_with_the_same_bits(options, reference):
    mesh = torus(30, 24, bumps=0.1)
    stream = bsm.encode(mesh, preset="paper", block_size=90, **options)
    header = inspect_stream(iter([stream])).header
    assert header.onorm == header.constants.power > 1 and stream[4] == 0x11  # 1.1 brought `onorm`
    positions, _ = reference.decode(header, frames_of(stream))
    assert np.array_equal(positions, bsm.decode(stream).positions)
