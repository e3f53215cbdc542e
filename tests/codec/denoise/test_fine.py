"""What every fine step promises, whichever it is."""

import numpy as np
import pytest

from bsm.bitstream.errors import OptionError
from bsm.codec.denoise.normals import FINE_STEPS, FineStep, bilateral_normal_filtering, fine_step
from bsm.codec.geometry.metrics import theta
from tests.codec.denoise.denoise_shapes import Partners, cube, grid, sphere
from tools.noise import gaussian_along_normals

every_step = pytest.mark.parametrize("step", FINE_STEPS.values(), ids=FINE_STEPS.keys())


@every_step
@pytest.mark.parametrize("shape", [cube, sphere])
def test_noise_is_reduced(step: FineStep, shape) -> None:  # type: ignore[no-untyped-def]
    clean, faces = shape(10)
    noisy = gaussian_along_normals(clean, faces, 0.2, seed=5)
    assert theta(clean, step(noisy, faces), faces) < 0.65 * theta(clean, noisy, faces)


@every_step
def test_a_plane_stays_a_plane(step: FineStep) -> None:
    positions, faces = grid(6)
    turned = positions @ np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0].T
    normal = np.cross(turned[1] - turned[0], turned[7] - turned[0])
    assert step(turned, faces) @ normal == pytest.approx(0, abs=1e-9)


@every_step
def test_size_place_and_attitude_of_the_mesh_do_not_matter(step: FineStep) -> None:
    clean, faces = cube(5)
    noisy = gaussian_along_normals(clean, faces, 0.2, seed=1)
    q, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    rotation = q * np.linalg.det(q)
    moved = step(noisy @ rotation.T * 100 + 7, faces, 3)
    assert moved == pytest.approx(step(noisy, faces, 3) @ rotation.T * 100 + 7, rel=1e-6, abs=1e-6)


@every_step
def test_no_iterations_change_no_normal_much_and_the_input_never(step: FineStep) -> None:
    clean, faces = cube(4)
    before = clean.copy()
    step(clean, faces, 2)
    assert (clean == before).all()
    assert step(clean, faces, 0) == pytest.approx(clean)


@every_step
@pytest.mark.parametrize("scale", [0.0, 1.0])
def test_degenerate_and_non_manifold_meshes_stay_finite(step: FineStep, scale: float) -> None:
    positions, faces = cube(2)
    positions = np.concatenate([positions, np.full((2, 3), 9.0)]) * scale
    extra = np.array([[0, 0, 1], [0, 0, 0], [0, 1, len(positions) - 1], [5, 6, 7]], dtype=np.int32)
    broken = np.concatenate([faces, faces[:3], extra])
    moved = step(positions, broken, 3)
    assert np.isfinite(moved).all()
    assert (moved[-2] == positions[-2]).all()


def test_the_boundary_stays_where_the_method_says_so() -> None:
    flat, faces = grid(5)
    noisy = gaussian_along_normals(flat, faces, 0.2, seed=1)
    rim = (flat[:, :2] == 0).any(axis=1) | (flat[:, :2] == 5).any(axis=1)
    moved = bilateral_normal_filtering(noisy, faces)
    assert (moved[rim] == noisy[rim]).all()
    assert (moved[~rim] != noisy[~rim]).any()


def test_an_unknown_name_is_refused_with_the_known_ones() -> None:
    with pytest.raises(OptionError, match="guided"):
        fine_step("best")
    assert fine_step("guided") is FINE_STEPS["guided"]


@pytest.mark.real
def test_theta_on_fandisk_under_heavy_noise_is_the_published_one(partners: Partners) -> None:
    original, mesh = partners("fandisk_6475", "fandisk_0.7_noisy")
    denoised = bilateral_normal_filtering(mesh.positions, mesh.faces)
    assert theta(original.positions, denoised, mesh.faces) == pytest.approx(30.5, rel=0.01)
