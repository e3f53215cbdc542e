"""The learnt candidate: its inputs do not depend on the position of a mesh, and its output improves the result."""

from pathlib import Path

import numpy as np
import pytest

from bsm.codec.denoise.learnt import (
    BASE,
    NUMBERS,
    RADIUS,
    WEIGHTS,
    Network,
    descriptions,
    joined,
    learnt,
    read_networks,
    regressed_normals,
)
from bsm.codec.denoise.surface import Topology, surroundings
from bsm.codec.geometry.metrics import rms_over_edge
from tests.codec.denoise.denoise_shapes import cube, grid, sphere
from tests.shapes import theta
from tools.noise import gaussian_along_normals
from tools.train_denoiser import mirrored, write_networks

TURN = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
TURN *= np.sign(np.linalg.det(TURN))


def zeros(size: int) -> Network:
    """A network for this many inputs that adds nothing."""
    layer = (np.zeros((size, 3), np.float32), np.zeros(3, np.float32))
    return Network(np.zeros(size, np.float32), np.ones(size, np.float32), (layer,))


def described(positions: np.ndarray, topology: Topology) -> tuple[np.ndarray, np.ndarray]:
    return next(descriptions(positions, topology, surroundings(positions, topology, RADIUS)))


def noisy_sphere(size: int = 16):  # type: ignore[no-untyped-def]
    clean, faces = sphere(size)
    return clean, gaussian_along_normals(clean, faces, 0.3, seed=3), faces


def test_the_same_mesh_elsewhere_gives_the_same_normals_there() -> None:
    _, noisy, faces = noisy_sphere()
    topology = Topology(faces, len(noisy))
    here = learnt(noisy, topology)
    there = learnt(1000.0 * noisy @ TURN.T + [5.0, -7.0, 1.0], topology)
    assert there.normals == pytest.approx(here.normals @ TURN.T, abs=2e-2)
    assert np.abs(there.normals - here.normals @ TURN.T).mean() < 1e-4


@pytest.mark.parametrize("flipped", [0, 1])
def test_a_mirrored_mesh_is_described_by_mirrored_numbers(flipped: int) -> None:
    """Of a flat square with bumps, seen in a mirror across x or y: frames differ by signs alone."""
    flat, faces = grid(12)
    bumpy = flat + np.random.default_rng(1).normal(size=flat.shape) * [0.0, 0.0, 0.2]
    mirror = np.where(np.arange(3) == flipped, -1.0, 1.0)
    numbers, frames = described(bumpy, Topology(faces, len(bumpy)))
    # Turned about, faces look to the same side as before.
    other, turned = described(
        bumpy * mirror, Topology(np.ascontiguousarray(faces[:, [0, 2, 1]]), len(bumpy))
    )
    signs = np.sign(np.einsum("kij,kij->ki", turned, frames * mirror))
    assert (signs[:, 2] == 1.0).all()
    for x in (False, True):
        for y in (False, True):
            chosen = (signs[:, 0] == (-1.0 if x else 1.0)) & (signs[:, 1] == (-1.0 if y else 1.0))
            order, sign = mirrored(x, y)
            assert other[chosen] == pytest.approx(numbers[chosen][:, order] * sign, abs=1e-4)


@pytest.mark.parametrize("shape", [cube, sphere])
def test_it_takes_noise_away(shape) -> None:  # type: ignore[no-untyped-def]
    clean, faces = shape(16)
    noisy = gaussian_along_normals(clean, faces, 0.3, seed=3)
    topology = Topology(faces, len(clean))
    other = learnt(noisy, topology)
    assert theta(clean, other.positions, faces) < 0.3 * theta(clean, noisy, faces)
    assert rms_over_edge(clean, other.positions, faces) < 0.6 * rms_over_edge(clean, noisy, faces)
    half = theta(clean, joined(noisy, other, 0.5, topology), faces)
    assert (
        theta(clean, joined(noisy, other, 1.0, topology), faces) < half < theta(clean, noisy, faces)
    )


def test_a_mesh_without_faces_and_one_without_area_pass() -> None:
    assert learnt(np.zeros((3, 3)), Topology(np.zeros((0, 3), np.int32), 3)).normals.shape == (0, 3)
    flat = learnt(np.zeros((3, 3)), Topology(np.array([[0, 1, 2]], np.int32), 3))
    assert np.isfinite(flat.positions).all() and np.isfinite(flat.normals).all()


def test_weights_are_small_and_written_as_they_are_read(tmp_path: Path) -> None:
    assert WEIGHTS.stat().st_size <= 600_000
    networks = list(read_networks())
    write_networks(tmp_path / "again.npz", networks)
    again = read_networks(tmp_path / "again.npz")
    numbers = np.random.default_rng(0).normal(size=(7, NUMBERS)).astype(np.float32)
    assert len(again) == len(networks)
    assert all(
        (network(numbers) == other(numbers)).all()
        for network, other in zip(networks, again, strict=True)
    )


def test_weights_for_other_numbers_are_refused(tmp_path: Path) -> None:
    write_networks(tmp_path / "short.npz", [zeros(5)])
    with pytest.raises(ValueError, match="train"):
        read_networks(tmp_path / "short.npz")


def test_a_network_of_zeros_says_the_filtered_normal() -> None:
    _, noisy, faces = noisy_sphere(8)
    numbers, frames = described(noisy, Topology(faces, len(noisy)))
    filtered = np.einsum("kij,ki->kj", frames, numbers[:, BASE])
    assert regressed_normals([(numbers, frames)], zeros(NUMBERS)) == pytest.approx(
        filtered, abs=1e-5
    )


def test_how_rough_a_mesh_is_counts_where_it_is_noisy() -> None:
    clean, noisy, faces = noisy_sphere()
    topology, near = (
        Topology(faces, len(clean)),
        surroundings(noisy, Topology(faces, len(clean)), RADIUS),
    )
    upper = clean[:, 2] > 0.0
    half = np.where(upper[:, None], noisy, clean)
    all_over, everywhere, there = (
        next(descriptions(positions, topology, near, where))[0][0, -1]
        for positions, where in ((noisy, None), (half, None), (half, upper))
    )
    assert everywhere < 0.7 * all_over and there == pytest.approx(all_over, rel=0.1)
