"""Sizes that no mesh has end in a sentence, and never in warnings of numpy."""

import warnings

import numpy as np
import pytest

import bsm
from bsm import Attribute, MeshError, TriangleMesh
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.cli import main as program
from tools.vectors.meshes import torus


@pytest.mark.parametrize("scale", [1e307, 1e300, 1e31, 1e-43, 1e-320])
@pytest.mark.parametrize("options", [{}, {"preset": "near-lossless"}])
def test_a_size_that_no_promise_can_be_kept_for_is_reported(scale, options):
    mesh = torus(6, 6)
    with warnings.catch_warnings(), pytest.raises(MeshError, match="scale it"):
        warnings.simplefilter("error")
        bsm.encode((mesh.positions * scale, mesh.faces), **options)


@pytest.mark.parametrize("scale", [1e29, 1e-41])
def test_large_and_small_meshes_come_back(scale):
    mesh = torus(6, 6)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        decoded = bsm.decode(bsm.encode((mesh.positions * scale, mesh.faces), preset="near-lossless"))
    assert np.abs(decoded.positions).max() == pytest.approx(scale * np.abs(mesh.positions).max(), rel=0.01)


def test_too_many_attributes_are_refused_before_any_is_coded():
    shape = torus(8, 6)
    many = [Attribute(f"a{number}", np.zeros(len(shape.positions), np.uint8), "vertex") for number in range(256)]
    with pytest.raises(bsm.OptionError, match="255 attributes at most, not 256"):
        bsm.encode(TriangleMesh(shape.positions, shape.faces, tuple(many)))


def test_attributes_that_decoders_would_refuse_are_not_written(monkeypatch):
    monkeypatch.setitem(NAMED_LIMITS, "default", lambda: bsm.Limits(memory=6e6))
    shape = torus(12, 10)
    values = np.random.default_rng(0).normal(size=(3 * len(shape.faces), 4))
    many = tuple(Attribute(f"a{number}", values, "corner") for number in range(60))
    with pytest.raises(bsm.OptionError, match="decoders with default limits would refuse this stream"):
        bsm.encode(TriangleMesh(shape.positions, shape.faces, many), grid=8)
    bsm.encode(TriangleMesh(shape.positions, shape.faces, many[:2]), grid=8)


def _one_far(scale):
    positions = torus(6, 6).positions.copy()
    positions[3, 1] = scale
    return positions


USES = {
    "compare": lambda mesh, good: bsm.compare(good, mesh),
    "compare with": lambda mesh, good: bsm.compare(mesh, good),
    "look with": lambda mesh, good: bsm.look(mesh, good),
    "denoise": lambda mesh, good: bsm.denoise(mesh),
    "encode": lambda mesh, good: bsm.encode(mesh, preset="lossless"),
    "encode frames": lambda mesh, good: bsm.encode_sequence(np.stack([good[0], mesh[0], good[0]]), good[1]),
}


@pytest.mark.parametrize("use", USES)
@pytest.mark.parametrize("positions", [torus(6, 6).positions * 3e307, _one_far(1e308), _one_far(-1e300)])
def test_coordinates_that_overflow_are_reported_wherever_they_come(use, positions):
    faces = torus(6, 6).faces
    with np.errstate(all="raise", under="ignore"), pytest.raises(MeshError, match="scale"):
        USES[use]((positions, faces), (torus(6, 6).positions, faces))


@pytest.mark.parametrize("name", ["a.ply", "a.obj", "a.npz", "a.off", "a.vtp"])
def test_coordinates_that_overflow_are_read_and_neither_cut_nor_compared_nor_encoded(tmp_path, name, capsys):
    path, positions = tmp_path / name, _one_far(1e308)
    bsm.save((positions, torus(6, 6).faces), str(path))
    assert np.array_equal(bsm.load(path).positions, positions)
    with np.errstate(all="raise", under="ignore"):
        tile = [["tile", "-o", tmp_path / "tiles"]] if path.suffix in (".ply", ".obj", ".npz") else []
        for words in (
            *tile,
            ["compare", path],
            ["denoise", "-o", tmp_path / "b.ply"],
            ["encode", "-o", tmp_path / "a.bsm"],
        ):
            assert program([words[0], str(path), *map(str, words[1:])]) == 3
            assert "scale it" in capsys.readouterr().err
