"""Metrics on meshes, and distances between surfaces, that are known by hand."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from bsm import MeshError
from bsm.codec.geometry.graph import vertex_neighbors
from bsm.codec.geometry.metrics import (
    Reference,
    compare,
    distances_to_surface,
    folded_edges,
    geometric_laplacian,
    nearest_points,
    surface_distance,
)
from bsm.codec.sequence.targets import compare_sequences
from tests.shapes import mnd, theta

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
TWO = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)


def rotation_x(degrees: float) -> np.ndarray:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def test_equal_meshes_have_no_error() -> None:
    result = compare(SQUARE, SQUARE, TWO)
    assert (result.nmsve, result.theta_deg, result.rms, result.max_error) == (0, 0, 0, 0)
    assert result.nmsve_db == -math.inf


@pytest.mark.parametrize("degrees", [1e-6, 0.5, 30.0, 90.0, 170.0])
def test_a_rotation_turns_every_normal_by_its_angle(degrees: float) -> None:
    turned = SQUARE @ rotation_x(degrees).T
    assert theta(SQUARE, turned, TWO) == pytest.approx(degrees, rel=1e-9)
    assert mnd(SQUARE, turned, TWO) == pytest.approx(
        2 * math.sin(math.radians(degrees / 2)), rel=1e-6
    )


def test_a_translation_costs_distance_and_no_detail() -> None:
    moved = SQUARE + np.array([0.3, 0.0, 0.4])
    result = compare(SQUARE, moved, TWO)
    assert result.rms == pytest.approx(0.5)
    assert result.max_error_relative == pytest.approx(0.5 / math.sqrt(2))
    assert result.theta_deg == 0
    # ||v - v~|| = sqrt(4) * 0.5, no Laplacian difference, 2n = 8, unit diagonal.
    assert result.nmsve == pytest.approx(1.0 / 8 / math.sqrt(2))
    assert result.nmsve_db == pytest.approx(10 * math.log10(1.0 / 8 / math.sqrt(2)))
    assert result.nmsve_paper_db == pytest.approx(10 * math.log10(1.0 / 8))
    assert compare(7 * SQUARE, 7 * moved, TWO).nmsve_paper_db == pytest.approx(
        10 * math.log10(7.0 / 8)
    )


def test_the_laplacian_weighs_neighbors_by_inverse_distance() -> None:
    positions = np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0]])
    faces = np.array([[0, 1, 2]], dtype=np.int32)
    expected = -(np.array([1.0, 0, 0]) + 0.5 * np.array([0, 2.0, 0])) / 1.5
    assert geometric_laplacian(positions, vertex_neighbors(faces, 3))[0] == pytest.approx(expected)


def test_coincident_neighbors_give_the_limit_and_no_nan() -> None:
    near, exact = SQUARE.copy(), SQUARE.copy()
    near[1], exact[1] = [1e-9, 0, 0], [0, 0, 0]
    assert compare(SQUARE, near, TWO).nmsve == pytest.approx(
        compare(SQUARE, exact, TWO).nmsve, rel=1e-6
    )
    collapsed = np.zeros_like(SQUARE)
    assert math.isfinite(compare(collapsed, SQUARE, TWO).nmsve)
    assert compare(collapsed, collapsed, TWO).rms_relative == 0


def test_lost_faces_count_and_degenerate_originals_do_not() -> None:
    lost = SQUARE.copy()
    lost[1] = [0.5, 0.5, 0]
    assert theta(SQUARE, lost, TWO) == pytest.approx(45.0)
    assert mnd(SQUARE, lost, TWO) == pytest.approx(math.sqrt(2) / 2)
    assert theta(lost, SQUARE, TWO) == 0
    assert theta(np.zeros_like(SQUARE), SQUARE, TWO) == 0


def test_the_unit_of_the_mesh_does_not_matter() -> None:
    noise = np.random.default_rng(1).normal(0, 0.05, SQUARE.shape)
    small, large = (
        compare(SQUARE, SQUARE + noise, TWO),
        compare(SQUARE * 1e3, (SQUARE + noise) * 1e3, TWO),
    )
    assert large.nmsve == pytest.approx(small.nmsve)
    assert large.rms_relative == pytest.approx(small.rms_relative)
    assert large.rms == pytest.approx(small.rms * 1e3)


def test_kg_error_is_relative_to_the_extent() -> None:
    square = SQUARE - SQUARE.mean(axis=0)
    frames = np.stack([square, square + np.array([2.0, 0, 0])])  # where a frame is does not count
    assert compare_sequences(frames, frames, TWO).kg == 0
    offset = 0.1 * math.sqrt(np.square(square).sum() / len(square))
    assert compare_sequences(frames, frames + np.array([0.0, offset, 0]), TWO).kg == pytest.approx(
        10.0
    )
    points = np.zeros((2, 4, 3))
    assert compare_sequences(points, points + 1, TWO).kg == math.inf
    steady = np.linspace(1, 2, 9, dtype=np.float32)[:, None, None] * frames[0].astype(np.float32)
    assert (
        compare_sequences(
            steady, steady + np.random.default_rng(1).normal(size=steady.shape), TWO
        ).flicker
        == math.inf
    )


def test_wrong_shapes_are_refused() -> None:
    with pytest.raises(MeshError, match="shape"):
        Reference(SQUARE, TWO).compare(SQUARE[:3])


def test_folded_edges_are_counted_whatever_the_orientation() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    # The second face lies on the first.
    over = np.where(np.arange(4)[:, None] == 3, [1, 0.2, 0.1], square)
    turned = np.array([[0, 1, 2], [0, 3, 2]])
    assert [folded_edges(square, faces), folded_edges(square, turned)] == [0, 0]
    assert [folded_edges(over, faces), folded_edges(over, turned)] == [1, 1]
    fan = np.vstack([over, [0, 0, 1]])
    # Of three faces none is over another.
    assert folded_edges(fan, np.array([[0, 1, 2], [0, 2, 3], [0, 2, 4]])) == 0


def test_two_parallel_squares() -> None:
    result = surface_distance(SQUARE, TWO, SQUARE + np.array([0, 0, 0.25]), TWO, samples=1000)
    assert [result.hausdorff, result.forward, result.backward, result.mean] == pytest.approx(
        [0.25] * 4
    )
    assert surface_distance(
        SQUARE, TWO, SQUARE, TWO[:, ::-1], samples=1000
    ).hausdorff == pytest.approx(0, abs=1e-12)


def test_the_two_sides_differ() -> None:
    # A square and its half: everything of the half lies on the square, the far corner is sqrt(1/2) away from it.
    result = surface_distance(SQUARE, TWO, SQUARE, TWO[:1], samples=1000)
    assert result.backward == pytest.approx(0, abs=1e-12)
    assert result.forward == result.hausdorff == pytest.approx(np.sqrt(0.5))


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_the_tree_finds_the_nearest_triangle(seed: int) -> None:
    random = np.random.default_rng(seed)
    positions, faces = random.normal(size=(30, 3)), random.integers(0, 30, (60, 3)).astype(np.int32)
    points = random.normal(size=(5, 3)) * 2
    found = distances_to_surface(points, positions, faces)
    alone = [distances_to_surface(points, positions, faces[k : k + 1]) for k in range(len(faces))]
    assert found == pytest.approx(np.min(alone, axis=0))
    corners, weights = nearest_points(points, positions, faces)
    assert weights.min() >= 0.0 and weights.sum(axis=1) == pytest.approx(1.0)
    nearest = (weights[:, :, None] * positions[corners]).sum(axis=1)
    assert np.linalg.norm(nearest - points, axis=1) == pytest.approx(found)


@pytest.mark.parametrize("seed", range(5))
def test_the_distance_to_a_triangle_is_the_minimum_over_its_points(seed: int) -> None:
    random = np.random.default_rng(seed)
    triangle, point = random.normal(size=(3, 3)), random.normal(size=3) * 2

    def squared(weights: np.ndarray) -> float:
        return float(np.sum((triangle[0] + weights @ (triangle[1:] - triangle[0]) - point) ** 2))

    inside = {"type": "ineq", "fun": lambda weights: 1.0 - weights.sum()}
    best = minimize(squared, [0.3, 0.3], bounds=[(0, 1), (0, 1)], constraints=[inside], tol=1e-12)
    face = np.array([[0, 1, 2]], dtype=np.int32)
    assert distances_to_surface(point[None], triangle, face)[0] == pytest.approx(
        np.sqrt(best.fun), abs=1e-5
    )


def test_surfaces_without_area_are_points() -> None:
    flat = np.zeros((3, 3))
    face = np.array([[0, 1, 2]], dtype=np.int32)
    assert surface_distance(
        flat, face, flat + np.array([0, 3.0, 4.0]), face
    ).hausdorff == pytest.approx(5)
