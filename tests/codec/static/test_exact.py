"""Positions to the bit: every float of single precision comes back, wherever it is."""

from dataclasses import replace

import numpy as np
import pytest

import bsm
from bsm import PRESETS, EncodeOptions, Encoder, TriangleMesh, decode, encode, read_mesh
from tests.shapes import patch, torus

LOSSLESS = PRESETS["lossless"]


def bits(positions: np.ndarray) -> np.ndarray:
    return np.asarray(positions, np.float32).view(np.uint32)


def assert_exact(positions: np.ndarray, faces: np.ndarray) -> None:
    single = np.asarray(positions, np.float32)
    mesh = TriangleMesh(single, faces)
    encoder = Encoder(mesh, LOSSLESS)
    decoded = decode(encoder.encode())
    assert np.array_equal(bits(decoded.positions), bits(single[encoder.vertex_order]))
    kept = decode(encode(mesh, replace(LOSSLESS, keep_order=True)))
    assert np.array_equal(bits(kept.positions), bits(single)) and np.array_equal(
        kept.faces, mesh.faces
    )


@pytest.mark.parametrize("scale", [1.0, 1e-40, 1e-45, 1e-20, 1e20, 2e38])
@pytest.mark.parametrize("offset", [0.0, 1e3, 1e7, -3e9])
def test_floats_come_back(scale: float, offset: float) -> None:
    mesh = torus(12, 9)
    assert_exact(mesh.positions * scale + offset, mesh.faces)


def test_vertices_that_no_face_uses_are_kept_in_single_precision() -> None:
    mesh = TriangleMesh([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0.1, 0.2, 0.3]], [[0, 1, 2]])
    kept = decode(encode(mesh, replace(LOSSLESS, keep_order=True)))
    assert np.array_equal(bits(kept.positions), bits(mesh.positions))


def test_zeros_keep_their_sign_and_are_different_vertices() -> None:
    mesh = patch(9, 8)
    positions = mesh.positions.copy()
    positions[:, 2] = 0.0
    positions[::2, 2] = -0.0
    assert_exact(positions, mesh.faces)
    two = TriangleMesh(
        np.array([[0.0, 0, 0], [-0.0, 0, 0], [1, 0, 0], [0, 1, 0]]),
        np.array([[0, 2, 3], [1, 3, 2]]),
    )
    assert len(decode(encode(two, LOSSLESS)).positions) == 4


def test_decimals_take_about_what_their_grid_does() -> None:
    mesh = torus(40, 30)
    decimals = TriangleMesh(np.round(mesh.positions, 4).astype(np.float32), mesh.faces)
    assert_exact(decimals.positions, mesh.faces)
    on_grid = encode(decimals, EncodeOptions(grid_cell=1e-4))
    assert len(encode(decimals, LOSSLESS)) < 1.03 * len(on_grid)
    assert len(
        encode(TriangleMesh(mesh.positions.astype(np.float32), mesh.faces), LOSSLESS)
    ) > 1.3 * len(on_grid)


def test_any_floats_come_back() -> None:
    random = np.random.default_rng(7)
    mesh = patch(16, 15)
    numbers = random.integers(0, 1 << 32, mesh.positions.shape, np.uint32).view(np.float32)
    assert_exact(np.where(np.isfinite(numbers), numbers, 0), mesh.faces)
    assert_exact(np.zeros(mesh.positions.shape), mesh.faces)
    for scale in (1e-44, 1e-40, 1e-36, 2e38):
        decoded = bsm.decode(
            bsm.encode((scale * mesh.positions, mesh.faces), grid=12, keep_order=True)
        )
        assert (
            np.abs(decoded.positions / scale - mesh.positions).max()
            <= 0.51 * np.ptp(mesh.positions) / 4095
        )


def test_doubles_are_rounded_and_that_is_reported() -> None:
    mesh = torus(8, 7)
    encoder = Encoder(mesh, LOSSLESS)
    decoded = decode(encoder.encode())
    assert any("rounded to single precision" in note for note in encoder.notes)
    assert np.array_equal(bits(decoded.positions), bits(mesh.positions[encoder.vertex_order]))
    # Of no area.
    assert encode(TriangleMesh(mesh.positions, np.repeat(mesh.faces[:, :1], 3, axis=1)), LOSSLESS)
    single = TriangleMesh(mesh.positions.astype(np.float32), mesh.faces)
    assert not any("precision" in note for note in Encoder(single, LOSSLESS).notes)
    with pytest.raises(bsm.BsmError, match="single precision"):
        encode(TriangleMesh(mesh.positions * 1e39, mesh.faces), LOSSLESS)


def test_attributes_are_exact_unless_something_else_is_asked() -> None:
    mesh = torus(8, 7)
    values = np.random.default_rng(3).normal(size=(len(mesh.positions), 2)).astype(np.float32)
    dressed = replace(mesh, attributes=(bsm.Attribute("heat", values),))
    (heat,) = decode(encode(dressed, replace(LOSSLESS, keep_order=True))).attributes
    assert np.array_equal(heat.values, values)


@pytest.mark.real
@pytest.mark.parametrize(
    "name", ["static/nicolo.ply", "static/bunny_34834.ply", "assets/ADIS16480.STL"]
)
def test_real_meshes_come_back_below_draco(meshes, name) -> None:
    mesh = read_mesh(meshes / name).mesh
    assert_exact(mesh.positions, mesh.faces)
    if "nicolo" in name:
        # Draco's, positions as they are, level 10.
        assert len(encode(mesh, LOSSLESS)) < 0.6 * 182_842


@pytest.mark.parametrize("keep", [False, True])
def test_what_rounding_to_single_precision_moves_is_counted(keep: bool) -> None:
    mesh = TriangleMesh(torus(12, 9).positions + 5, torus(12, 9).faces)
    found = Encoder(mesh, replace(LOSSLESS, keep_order=keep)).result().comparison
    moved = np.linalg.norm(mesh.positions - mesh.positions.astype(np.float32), axis=1).max()
    assert moved > 1e-7 and found.max_error_relative == pytest.approx(
        moved / mesh.diagonal, rel=0.1
    )
