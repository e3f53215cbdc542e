"""Metrics on meshes whose errors are known by hand."""

import math

import numpy as np
import pytest

from bsm import MeshError
from bsm.codec.geometry.graph import vertex_neighbors
from bsm.codec.geometry.metrics import Reference, compare, folded_edges, geometric_laplacian, mnd, theta
from bsm.codec.sequence.targets import compare_sequences

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
    assert mnd(SQUARE, turned, TWO) == pytest.approx(2 * math.sin(math.radians(degrees / 2)), rel=1e-6)


def test_a_translation_costs_distance_and_no_detail() -> None:
    moved = SQUARE + np.array([0.3, 0.0, 0.4])
    result = compare(SQUARE, moved, TWO)
    assert result.rms == pytest.approx(0.5)
    assert result.max_error_relative == pytest.approx(0.5 / math.sqrt(2))
    assert result.theta_deg == 0
    # ||v - v~|| = sqrt(4) * 0.5, no Laplacian difference, 2n = 8, unit diagonal.
    assert result.nmsve == pytest.approx(1.0 / 8 / math.sqrt(2))
    assert result.nmsve_db == pytest.approx(10 * math.log10(1.0 / 8 / math.sqrt(2)))


def test_the_laplacian_weighs_neighbors_by_inverse_distance() -> None:
    positions = np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0]])
    faces = np.array([[0, 1, 2]], dtype=np.int32)
    expected = -(np.array([1.0, 0, 0]) + 0.5 * np.array([0, 2.0, 0])) / 1.5
    assert geometric_laplacian(positions, vertex_neighbors(faces, 3))[0] == pytest.approx(expected)


def test_coincident_neighbors_give_the_limit_and_no_nan() -> None:
    near, exact = SQUARE.copy(), SQUARE.copy()
    near[1], exact[1] = [1e-9, 0, 0], [0, 0, 0]
    assert compare(SQUARE, near, TWO).nmsve == pytest.approx(compare(SQUARE, exact, TWO).nmsve, rel=1e-6)
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
    small, large = compare(SQUARE, SQUARE + noise, TWO), compare(SQUARE * 1e3, (SQUARE + noise) * 1e3, TWO)
    assert large.nmsve == pytest.approx(small.nmsve)
    assert large.rms_relative == pytest.approx(small.rms_relative)
    assert large.rms == pytest.approx(small.rms * 1e3)


def test_kg_error_is_relative_to_the_extent() -> None:
    square = SQUARE - SQUARE.mean(axis=0)
    frames = np.stack([square, square + np.array([2.0, 0, 0])])  # where a frame is does not count
    assert compare_sequences(frames, frames, TWO).kg == 0
    offset = 0.1 * math.sqrt(np.square(square).sum() / len(square))
    assert compare_sequences(frames, frames + np.array([0.0, offset, 0]), TWO).kg == pytest.approx(10.0)
    points = np.zeros((2, 4, 3))
    assert compare_sequences(points, points + 1, TWO).kg == math.inf


def test_wrong_shapes_are_refused() -> None:
    with pytest.raises(MeshError, match="shape"):
        Reference(SQUARE, TWO).compare(SQUARE[:3])


def test_folded_edges_are_counted_whatever_the_orientation() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    over = np.where(np.arange(4)[:, None] == 3, [1, 0.2, 0.1], square)  # the second face lies on the first
    turned = np.array([[0, 1, 2], [0, 3, 2]])
    assert [folded_edges(square, faces), folded_edges(square, turned)] == [0, 0]
    assert [folded_edges(over, faces), folded_edges(over, turned)] == [1, 1]
    fan = np.vstack([over, [0, 0, 1]])
    assert folded_edges(fan, np.array([[0, 1, 2], [0, 2, 3], [0, 2, 4]])) == 0  # of three faces none is over another
