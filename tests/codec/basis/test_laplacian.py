"""Laplacians: solved by fronts on any graph, and cotangent weights on triangles whose angles are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm import NumericError
from bsm._core import codec as _kernels
from bsm.codec.basis.laplacian import dense_laplacian, solver_of
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import graph_of_faces

soups = hnp.arrays(np.int32, st.tuples(st.integers(1, 150), st.just(3)), elements=st.integers(0, 69))


def unordered(faces, size):
    graph = graph_of_faces(faces, size)
    return Block(np.arange(size, dtype=np.int32), graph.offsets, graph.neighbors)


@settings(max_examples=60)
@given(soups, st.floats(1e-3, 10.0))
def test_any_graph_can_be_solved(faces, shift):
    """One iteration is the Q of a solution, whatever elimination fills in."""
    block = unordered(faces, 70)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, (70, 3)).astype(np.float32)
    expected, upper = np.linalg.qr(np.linalg.solve(dense_laplacian(block) + shift * np.eye(70), start))
    found = solver_of(block, shift).iterate(start, 1, 1)
    assert np.allclose(found, expected * np.sign(np.diag(upper)), rtol=0, atol=1e-4 / shift**0.5)


SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
HALVES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def weights_of(positions: np.ndarray, faces: np.ndarray) -> dict[tuple[int, int], float]:
    graph = graph_of_faces(faces, len(positions))
    weights, positions = np.zeros(len(graph.neighbors)), np.ascontiguousarray(positions)
    if not _kernels.weigh_by_cotangents(graph.offsets, graph.neighbors, faces, positions, weights):
        raise NumericError("not finite")
    tails = np.repeat(np.arange(graph.size), np.diff(graph.offsets))
    return {(int(a), int(b)): float(w) for a, b, w in zip(tails, graph.neighbors, weights, strict=True)}


def bounded(cotangents: float) -> float:
    """The weight of an edge with a given half sum of cotangents."""
    positive = (cotangents + np.sqrt(cotangents**2 + 1 / 64)) / 2
    return 1 / 32 + 8 * positive / (8 + positive)


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
