"""Cotangent weights and held Laplacians, on triangles whose angles are known."""

from __future__ import annotations

import numpy as np
import pytest

from codec.basis.weighted import (
    LARGEST_WEIGHT,
    SMALLEST_WEIGHT,
    binary_weights,
    cotangent_weights,
    held_laplacian,
)
from codec.geometry.graph import graph_of_faces
from tests.shapes import torus

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
HALVES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def weights_of(positions: np.ndarray, faces: np.ndarray) -> dict[tuple[int, int], float]:
    graph = graph_of_faces(faces, len(positions))
    weights = cotangent_weights(graph, faces, positions)
    tails = np.repeat(np.arange(graph.size), np.diff(graph.offsets))
    return {(int(a), int(b)): float(w) for a, b, w in zip(tails, graph.neighbours, weights, strict=True)}


def test_the_angles_of_a_halved_square() -> None:
    found = weights_of(SQUARE, HALVES)
    # Opposite to each side lies 45 degrees, whose cotangent is one; opposite to the diagonal two right angles.
    assert {edge: found[edge] for edge in ((0, 1), (1, 2), (2, 3), (0, 3))} == pytest.approx(
        {(0, 1): 0.5, (1, 2): 0.5, (2, 3): 0.5, (0, 3): 0.5}
    )
    assert found[0, 2] == SMALLEST_WEIGHT
    assert all(found[a, b] == found[b, a] for a, b in found)


def test_equilateral_triangles() -> None:
    height = np.sqrt(3) / 2
    positions = np.array([[0, 0, 0], [1, 0, 0], [0.5, height, 0], [0.5, -height, 0]])
    found = weights_of(positions, np.array([[0, 1, 2], [1, 0, 3]], np.int32))
    assert found[0, 1] == pytest.approx(1 / np.sqrt(3))
    assert found[0, 2] == found[1, 3] == pytest.approx(0.5 / np.sqrt(3))


def test_weights_are_clamped_and_a_triangle_without_area_counts_nothing() -> None:
    needle = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1e-3, 0]])
    found = weights_of(needle, np.array([[0, 1, 2]], np.int32))
    assert found[0, 1] == SMALLEST_WEIGHT  # obtuse: its cotangent is negative
    assert found[0, 2] == found[1, 2] == LARGEST_WEIGHT
    flat = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], float)
    assert set(weights_of(flat, np.array([[0, 1, 2]], np.int32)).values()) == {SMALLEST_WEIGHT}


def test_weights_do_not_depend_on_the_unit() -> None:
    mesh = torus(12, 8)
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    one = cotangent_weights(graph, mesh.faces, mesh.positions)
    np.testing.assert_allclose(cotangent_weights(graph, mesh.faces, 1024.0 * mesh.positions), one, rtol=1e-12)
    assert binary_weights(graph).tolist() == [1.0] * len(graph.neighbours)


def test_a_part_hangs_on_what_is_known_before_it_and_on_nothing_else() -> None:
    faces = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4]], np.int32)  # a fan around vertex 4
    graph = graph_of_faces(faces, 5)
    weights = np.arange(1.0, len(graph.neighbours) + 1)
    rank = np.array([0, 1, 1, 2, 1], np.int32)  # 0 is known before, 3 comes later
    vertices = np.array([1, 2, 4], np.int32)
    held = held_laplacian(graph, weights, vertices, rank)
    edge = {
        (a, int(b)): weights[i]
        for a in range(5)
        for i, b in zip(range(graph.offsets[a], graph.offsets[a + 1]), graph.neighbours[graph.offsets[a] :])
    }
    expected = np.array(
        [
            [edge[1, 0] + edge[1, 2] + edge[1, 4], -edge[1, 2], -edge[1, 4]],
            [-edge[2, 1], edge[2, 1] + edge[2, 4], -edge[2, 4]],
            [-edge[4, 1], -edge[4, 2], edge[4, 0] + edge[4, 1] + edge[4, 2]],
        ]
    )
    assert held.matrix.tolist() == expected.tolist()
    assert list(zip(held.rows, held.outer, held.weights)) == [(0, 0, edge[1, 0]), (2, 0, edge[4, 0])]
