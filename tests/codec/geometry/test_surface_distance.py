"""Distances between surfaces whose distances are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from bsm.codec.geometry.metrics import distances_to_surface, surface_distance

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
TWO = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)


def test_two_parallel_squares() -> None:
    result = surface_distance(SQUARE, TWO, SQUARE + np.array([0, 0, 0.25]), TWO, samples=1000)
    assert [result.hausdorff, result.forward, result.backward, result.mean] == pytest.approx([0.25] * 4)
    assert surface_distance(SQUARE, TWO, SQUARE, TWO[:, ::-1], samples=1000).hausdorff == pytest.approx(0, abs=1e-12)


def test_the_two_sides_differ() -> None:
    # A square and its half: everything of the half lies on the square, the far corner is sqrt(1/2) away from it.
    result = surface_distance(SQUARE, TWO, SQUARE, TWO[:1], samples=1000)
    assert result.backward == pytest.approx(0, abs=1e-12)
    assert result.forward == result.hausdorff == pytest.approx(np.sqrt(0.5))


def test_a_different_triangulation_of_the_same_surface_is_no_distance() -> None:
    middle = np.concatenate([SQUARE, [[0.3, 0.6, 0.0]]])
    fan = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], dtype=np.int32)
    assert surface_distance(SQUARE, TWO, middle, fan, samples=2000).hausdorff < 1e-12


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_the_tree_finds_the_nearest_triangle(seed: int) -> None:
    random = np.random.default_rng(seed)
    positions, faces = random.normal(size=(30, 3)), random.integers(0, 30, (60, 3)).astype(np.int32)
    points = random.normal(size=(5, 3)) * 2
    found = distances_to_surface(points, positions, faces)
    alone = [distances_to_surface(points, positions, faces[k : k + 1]) for k in range(len(faces))]
    assert found == pytest.approx(np.min(alone, axis=0))


@pytest.mark.parametrize("seed", range(5))
def test_the_distance_to_a_triangle_is_the_minimum_over_its_points(seed: int) -> None:
    random = np.random.default_rng(seed)
    triangle, point = random.normal(size=(3, 3)), random.normal(size=3) * 2

    def squared(weights: np.ndarray) -> float:
        return float(np.sum((triangle[0] + weights @ (triangle[1:] - triangle[0]) - point) ** 2))

    inside = {"type": "ineq", "fun": lambda weights: 1.0 - weights.sum()}
    best = minimize(squared, [0.3, 0.3], bounds=[(0, 1), (0, 1)], constraints=[inside], tol=1e-12)
    face = np.array([[0, 1, 2]], dtype=np.int32)
    assert distances_to_surface(point[None], triangle, face)[0] == pytest.approx(np.sqrt(best.fun), abs=1e-5)


def test_surfaces_without_area_are_points() -> None:
    flat = np.zeros((3, 3))
    face = np.array([[0, 1, 2]], dtype=np.int32)
    assert surface_distance(flat, face, flat + np.array([0, 3.0, 4.0]), face).hausdorff == pytest.approx(5)
