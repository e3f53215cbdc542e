import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm.codec.blocks.partition import WORTH_A_THREAD, bisect
from bsm.codec.geometry.graph import component_sizes, graph_of_faces, is_connected
from tests.shapes import grid_faces

soups = hnp.arrays(np.int32, st.tuples(st.integers(1, 40), st.just(3)), elements=st.integers(0, 19))


@given(soups)
def test_a_graph_holds_each_edge_once_in_both_directions(faces):
    graph = graph_of_faces(faces, 20)
    edges = {(int(a), int(b)) for f in faces for a in f for b in f if a != b}
    found = [(v, int(w)) for v in range(20) for w in graph.neighbours[graph.offsets[v] : graph.offsets[v + 1]]]
    assert found == sorted(edges)


@given(soups, st.integers(1, 20))
def test_a_graph_is_connected_where_it_is_one_component(faces, size):
    graph = graph_of_faces(faces % size, size)
    assert is_connected(graph) == (len(component_sizes(graph)) == 1)


def test_a_vertex_of_high_degree_has_sorted_neighbours():
    fan = np.array([[0, 60 - i, 59 - i] for i in range(59)], np.int32)
    graph = graph_of_faces(fan, 61)
    assert graph.neighbours[: graph.offsets[1]].tolist() == list(range(1, 61))


@given(soups, st.integers(1, 20))
def test_bisection_cuts_any_graph_into_equal_parts(faces, parts):
    order, bounds = bisect(graph_of_faces(faces, 20), parts)
    assert sorted(order) == list(range(20))
    sizes = np.diff(bounds)
    assert sizes.min() >= 20 // parts and sizes.max() <= -(-20 // parts) + 1


def test_bisection_of_a_path_walks_along_it():
    faces = np.array([[i, i + 1, i] for i in range(31)], np.int32)
    order, _ = bisect(graph_of_faces(faces, 32), 32)
    assert np.abs(np.diff(order)).max() <= 16
    assert np.abs(np.diff(order)).mean() < 3


def test_a_bisection_keeps_neighbours_together():
    """In a square grid, halves are cut across: rows that are k apart lie about sqrt(k) apart."""
    rows = 32
    order, bounds = bisect(graph_of_faces(grid_faces(rows, rows), rows * rows), rows * rows)
    places = np.stack(np.divmod(order, rows), axis=1)
    assert np.array_equal(bounds, np.arange(rows * rows + 1))
    for gap in (16, 64, 256):
        apart = np.abs(places[gap:] - places[:-gap]).sum(axis=1)
        assert np.median(apart) < 3 * gap**0.5
    parts, _ = bisect(graph_of_faces(grid_faces(rows, rows), rows * rows), 4)
    for part in parts.reshape(4, -1):
        assert np.ptp(part // rows) + np.ptp(part % rows) < 48


def test_a_bisection_does_not_mix_components():
    """Two equal components, cut in two, are one part each."""
    faces = grid_faces(12, 12)
    both, _ = bisect(graph_of_faces(np.concatenate([faces, faces + 144]), 288), 2)
    assert {frozenset(part) for part in both.reshape(2, -1).tolist()} == {
        frozenset(range(144)),
        frozenset(range(144, 288)),
    }


@pytest.mark.parametrize("parts", [2, 3, 7, 46])
def test_two_threads_cut_as_one_does(parts):
    graph = graph_of_faces(grid_faces(100, 99), 9900)
    assert graph.size >= WORTH_A_THREAD
    for one, two in zip(bisect(graph, parts), bisect(graph, parts, threads=2), strict=True):
        assert np.array_equal(one, two)
