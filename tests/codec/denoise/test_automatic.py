"""The automatic mode: its estimate of the noise, its choices, and what they are worth."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from bsm import OptionError
from bsm.codec.denoise.automatic import CANDIDATES
from bsm.codec.denoise.filters import Filters
from bsm.codec.denoise.noise.finding import estimate_noise
from bsm.codec.denoise.surface import guided_normal_filtering
from bsm.codec.geometry.metrics import face_normals, mean_edge_length, rms_over_edge
from tests.codec.denoise.denoise_shapes import Partners, cube, grid, probe_of, sphere
from tests.shapes import theta
from tools.made_shapes import made_shape
from tools.noise import (
    correlated_along_normals,
    denoise_automatically,
    gaussian_along_normals,
    gaussian_isotropic,
)


@pytest.mark.parametrize("sigma", [0.1, 0.2, 0.6])
@pytest.mark.parametrize("shape", [cube, sphere])
def test_the_estimate_tells_noise_along_the_normals_from_isotropic_noise(
    sigma: float, shape
) -> None:  # type: ignore[no-untyped-def]
    clean, faces = shape(20)
    probe, edge = probe_of(clean, faces), mean_edge_length(clean, faces)
    along = estimate_noise(gaussian_along_normals(clean, faces, sigma, seed=3), clean, probe)
    assert along.normal / edge == pytest.approx(sigma, rel=0.2)
    assert along.tangential < 0.5 * along.normal
    if shape is sphere and sigma > 0.3:
        everywhere = estimate_noise(gaussian_isotropic(clean, faces, sigma, seed=3), clean, probe)
        assert everywhere.normal / edge == pytest.approx(sigma, rel=0.15)
        assert everywhere.tangential / edge == pytest.approx(sigma, rel=0.3)


@pytest.mark.parametrize("shape", [cube, sphere])
def test_it_beats_a_fixed_number_of_iterations(shape) -> None:  # type: ignore[no-untyped-def]
    clean, faces = shape(14)
    noisy = gaussian_along_normals(clean, faces, 0.25, seed=7)
    denoised, choice = denoise_automatically(noisy, faces)
    assert {step.filter for step in choice.steps} <= set(CANDIDATES)
    assert choice.kind == "white"
    assert choice.noise.normal == pytest.approx(0.25, rel=0.2)
    assert theta(clean, denoised, faces) < theta(
        clean, guided_normal_filtering(noisy, faces, 20), faces
    )


@pytest.mark.parametrize("shape", [cube, pytest.param(sphere, marks=pytest.mark.slow)])
def test_the_angle_that_it_expects_is_the_one_that_comes(shape) -> None:  # type: ignore[no-untyped-def]
    clean, faces = shape(20)
    for make in (gaussian_along_normals, gaussian_isotropic):
        noisy = make(clean, faces, 0.2, seed=7)
        denoised, choice = denoise_automatically(noisy, faces)
        came = theta(clean, denoised, faces)
        assert choice.untreated == pytest.approx(theta(clean, noisy, faces), rel=0.15)
        assert choice.expected / 1.3 < came < 1.3 * choice.at_most


@pytest.mark.parametrize("shape", [cube, pytest.param(sphere, marks=pytest.mark.slow)])
def test_noise_that_neighbors_share_leaves_every_part(shape) -> None:  # type: ignore[no-untyped-def]
    clean, faces = shape(30)
    noisy = correlated_along_normals(clean, faces, 0.2, 3, rounds=4)
    denoised = denoise_automatically(noisy, faces)[0]
    assert theta(clean, denoised, faces) < 0.25 * theta(clean, noisy, faces)


def test_no_angle_is_estimated_where_noise_turns_faces_anywhere() -> None:
    clean, faces = sphere(20)
    for stretched, reliable in ((1.0, True), (12.0, False)):
        shape = clean * [stretched, 1.0, 1.0]
        _, choice = denoise_automatically(gaussian_isotropic(shape, faces, 0.2, seed=7), faces)
        assert choice.steps and choice.reliable == reliable


@pytest.mark.parametrize("make", [gaussian_along_normals, gaussian_isotropic])
def test_noise_leaves_thin_triangles_whichever_way_it_moved_them(make) -> None:  # type: ignore[no-untyped-def]
    """Noise in all directions left nothing to rehearse with as long as it was taken for that of irregular triangles."""
    clean, faces = sphere(20)
    noisy = make(clean * [1.0, 1.0, 30.0], faces, 0.2, seed=3)
    result, choice = denoise_automatically(noisy, faces)
    assert choice.steps and not choice.reliable
    assert theta(clean * [1.0, 1.0, 30.0], result, faces) < 0.5 * theta(
        clean * [1.0, 1.0, 30.0], noisy, faces
    )


@pytest.mark.parametrize("seed", [4, 10, 11, 16])
@pytest.mark.parametrize("sigma", [0.2, 0.3])
def test_noise_along_the_surface_differs_from_irregular_triangles(seed: int, sigma: float) -> None:
    """Shape 4 has triangles that six Laplacians take for noise along the surface."""
    clean, faces = made_shape(seed, 24)
    surface = Filters(faces, len(clean))
    for make, slides in ((gaussian_along_normals, False), (gaussian_isotropic, True)):
        for draw in range(2):
            noisy = make(clean, faces, sigma, draw)
            level = estimate_noise(noisy, surface.smooth(noisy, CANDIDATES[0]), surface.probe)
            assert level.slides == slides


@pytest.mark.parametrize(
    ("seed", "make", "most"), [(4, gaussian_along_normals, 1.0), (16, gaussian_isotropic, 0.35)]
)
def test_vertices_slide_where_noise_moved_them_along_the_surface(
    seed: int, make, most: float
) -> None:  # type: ignore[no-untyped-def]
    clean, faces = made_shape(seed, 24)
    noisy = make(clean, faces, 0.2, 0)
    denoised, choice = denoise_automatically(noisy, faces)
    assert choice.steps and choice.noise.slides == (make is gaussian_isotropic)
    assert theta(clean, denoised, faces) < most * theta(clean, noisy, faces)


def test_vertices_end_closer_even_where_triangles_are_uneven() -> None:
    random = np.random.default_rng(0)
    middles, widths = random.normal(size=(40, 3)), 0.06 * np.exp(random.normal(size=(2500, 1)))
    clean = middles[random.integers(0, 40, 2500)] + widths * random.normal(size=(2500, 3))
    clean /= np.linalg.norm(clean, axis=1, keepdims=True)
    faces = ConvexHull(clean).simplices.astype(np.int32)
    inward = np.einsum("ij,ij->i", face_normals(clean, faces), clean[faces[:, 0]]) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    noisy = gaussian_along_normals(clean, faces, 0.2, seed=3)
    denoised = denoise_automatically(noisy, faces)[0]
    assert rms_over_edge(clean, denoised, faces) < 0.5 * rms_over_edge(clean, noisy, faces)
    assert theta(clean, denoised, faces) < 0.2 * theta(clean, noisy, faces)


@pytest.mark.slow
def test_each_goal_is_best_at_what_it_is_for() -> None:
    """Where planes or smooth shapes are found, no goal costs the other one anything."""
    for shape, level, wanted, other, errors in (
        (cube, 0.2, "shape", "shading", rms_over_edge),
        (sphere, 0.3, "shading", "shape", theta),
    ):
        clean, faces = shape(20)
        noisy = gaussian_along_normals(clean, faces, level, seed=7)
        better, worse = (denoise_automatically(noisy, faces, goal)[0] for goal in (wanted, other))
        assert errors(clean, better, faces) < 1.02 * errors(clean, worse, faces)
    with pytest.raises(OptionError, match="goal"):
        denoise_automatically(noisy, faces, "beauty")


@pytest.mark.parametrize("shape", [grid, cube, sphere])
@pytest.mark.parametrize("size", [3, 12, 24])
def test_a_clean_mesh_comes_back_bit_for_bit(shape, size: int) -> None:  # type: ignore[no-untyped-def]
    positions, faces = shape(size)
    denoised, choice = denoise_automatically(positions, faces)
    assert choice.steps == ()
    assert choice.reason
    assert (denoised == positions).all()


def test_a_triangle_soup_is_welded_first_and_comes_back_as_a_soup() -> None:
    clean, faces = sphere(14)
    noisy = gaussian_along_normals(clean, faces, 0.25, seed=7)
    corners = noisy[faces.ravel()]
    soup = np.arange(len(corners), dtype=np.int32).reshape(-1, 3)
    denoised, choice = denoise_automatically(corners, soup)
    assert choice.steps
    assert theta(clean[faces.ravel()], denoised, soup) < 0.5 * theta(
        clean[faces.ravel()], corners, soup
    )
    _, index = np.unique(corners, axis=0, return_inverse=True)
    places = denoised[np.unique(index.ravel(), return_index=True)[1]]
    assert (denoised == places[index.ravel()]).all()


def test_the_same_mesh_gets_the_same_result_in_any_unit() -> None:
    clean, faces = cube(14)
    noisy = gaussian_along_normals(clean, faces, 0.2, seed=7)
    first, choice = denoise_automatically(noisy, faces)
    scaled, other = denoise_automatically(noisy * 1000.0, faces)
    assert other.steps == choice.steps and choice.steps
    assert scaled == pytest.approx(first * 1000.0, rel=1e-6)


@pytest.mark.parametrize("count", [1, 2])
def test_the_smallest_meshes_pass(count: int) -> None:
    positions = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0], [9, 9, 9]])
    faces = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)[:count]
    denoised, _ = denoise_automatically(positions, faces)
    assert np.isfinite(denoised).all()


@pytest.mark.slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "noisy", "most"),
    [
        ("twelve_dodecahedron", "twelve_dodecahedron_noisy", 1.0),
        ("block", "block_noisy", 2.2),
        ("fandisk_6475", "fandisk_0.7_noisy", 5.2),
    ],
)
def test_parts_become_flat_where_they_are(
    partners: Partners, name: str, noisy: str, most: float
) -> None:
    original, mesh = partners(name, noisy)
    denoised, choice = denoise_automatically(mesh.positions, mesh.faces)
    assert choice.finish.startswith("flat")
    assert theta(original.positions, denoised, mesh.faces) < most


def test_what_is_flat_becomes_flat() -> None:
    clean, faces = cube(24)
    noisy = gaussian_along_normals(clean, faces, 0.3, seed=5)
    denoised, choice = denoise_automatically(noisy, faces)
    assert choice.finish == "flat"
    assert theta(clean, denoised, faces) < 0.015 * theta(clean, noisy, faces)
