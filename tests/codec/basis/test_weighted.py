"""Cotangent weights and held parts, on triangles whose angles are known."""

from __future__ import annotations

import numpy as np
import pytest

from bsm import NumericError
from bsm.codec.basis.laplacian import LARGEST_WEIGHT, SMALLEST_WEIGHT, cotangent_weights, hold
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import graph_of_faces

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
HALVES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def weights_of(positions: np.ndarray, faces: np.ndarray) -> dict[tuple[int, int], float]:
    graph = graph_of_faces(faces, len(positions))
    weights = cotangent_weights(graph, faces, positions)
    tails = np.repeat(np.arange(graph.size), np.diff(graph.offsets))
    return {(int(a), int(b)): float(w) for a, b, w in zip(tails, graph.neighbors, weights, strict=True)}


def bounded(cotangents: float) -> float:
    """The weight of an edge with a given half sum of cotangents."""
    positive = (cotangents + np.sqrt(cotangents**2 + 1 / 64)) / 2
    return 1 / 32 + 8 * positive / (8 + positive)


def test_the_angles_of_a_halved_square() -> None:
    found = weights_of(SQUARE, HALVES)
    # Opposite to each side lies 45 degrees, whose cotangent is one; opposite to the diagonal two right angles.
    sides = [found[edge] for edge in ((0, 1), (1, 2), (2, 3), (0, 3))]
    assert sides == pytest.approx([bounded(0.5)] * 4, rel=3e-3)  # the rest is what softens cotangents
    assert found[0, 2] == pytest.approx(bounded(0.0))
    assert all(found[a, b] == found[b, a] for a, b in found)


def test_equilateral_triangles() -> None:
    height = np.sqrt(3) / 2
    positions = np.array([[0, 0, 0], [1, 0, 0], [0.5, height, 0], [0.5, -height, 0]])
    found = weights_of(positions, np.array([[0, 1, 2], [1, 0, 3]], np.int32))
    assert found[0, 1] == pytest.approx(bounded(1 / np.sqrt(3)), rel=3e-3)
    assert found[0, 2] == found[1, 3] == pytest.approx(bounded(0.5 / np.sqrt(3)), rel=3e-3)
    larger = weights_of(1024.0 * positions, np.array([[0, 1, 2], [1, 0, 3]], np.int32))
    assert larger == pytest.approx(found, rel=5e-3)
    with pytest.raises(NumericError):
        weights_of(1e200 * SQUARE, HALVES)


def test_weights_are_bounded_and_a_point_counts_nothing() -> None:
    needle = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1e-9, 0]])
    found = weights_of(needle, np.array([[0, 1, 2]], np.int32))
    assert SMALLEST_WEIGHT < found[0, 1] < 1.05 * SMALLEST_WEIGHT  # obtuse: its cotangent is negative
    assert 3.0 < found[0, 2] < LARGEST_WEIGHT and found[0, 2] == found[1, 2]
    point = np.zeros((3, 3))
    assert list(weights_of(point, np.array([[0, 1, 2]], np.int32)).values()) == pytest.approx([bounded(0.0)] * 6)


@pytest.mark.parametrize("length", [1.0, 1e-2, 1e-4, 1e-6, 1e-9, 0.0])
@pytest.mark.parametrize("flatness", [1.0, 1e-3, 1e-9, 0.0])
def test_weights_make_little_of_little(length: float, flatness: float) -> None:
    """Whatever the triangle, a change of the positions by d changes no weight by more than about 2^13 d."""
    triangle = length * np.array([[0, 0, 0], [1, 0, 0], [0.4, flatness, 0]])
    faces = np.array([[0, 1, 2]], np.int32)
    change = 1e-10
    for seed in range(8):
        moved = triangle + change * np.random.default_rng(seed).choice([-1.0, 1.0], (3, 3))
        weights, other = weights_of(triangle, faces), weights_of(moved, faces)
        assert max(abs(weights[edge] - other[edge]) for edge in weights) < 2**13 * change


def test_a_part_hangs_on_what_is_known_before_it_and_on_nothing_else() -> None:
    faces = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4]], np.int32)  # a fan around vertex 4
    graph = graph_of_faces(faces, 5)
    weights = np.arange(1.0, len(graph.neighbors) + 1)
    rank = np.array([0, 1, 1, 2, 1], np.int32)  # 0 is known before, 3 comes later
    offsets, neighbors = np.array([0, 2, 4, 6], np.int32), np.array([1, 2, 0, 2, 0, 1], np.int32)
    part = Block(np.array([4, 1, 2], np.int32), offsets, neighbors)
    held = hold(graph, weights, rank, part)
    edge = {
        (a, int(b)): weights[i]
        for a in range(5)
        for i, b in zip(range(graph.offsets[a], graph.offsets[a + 1]), graph.neighbors[graph.offsets[a] :])
    }
    inner = [(4, 1), (4, 2), (1, 4), (1, 2), (2, 4), (2, 1)]
    assert held.laplacian.weights.tolist() == [edge[pair] for pair in inner]
    sums = [edge[4, 1] + edge[4, 2], edge[1, 4] + edge[1, 2], edge[2, 4] + edge[2, 1]]
    assert held.laplacian.diagonal.tolist() == sums
    assert held.springs.tolist() == [edge[4, 0], edge[1, 0], 0.0]
    field = np.arange(10.0).reshape(5, 2) + 1
    assert held.pulls(field).tolist() == [[edge[4, 0], 2 * edge[4, 0]], [edge[1, 0], 2 * edge[1, 0]], [0.0, 0.0]]
