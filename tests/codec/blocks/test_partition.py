import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm.codec.blocks.overlap import bisect, derive_partition, metis_partition, partition_of_labels
from bsm.codec.geometry.graph import graph_of_faces
from tests.codec.geometry.test_graph import graph_of, soups
from tests.shapes import grid_faces, torus


def cut(graph, partition):
    source = np.repeat(np.arange(graph.size), np.diff(graph.offsets))
    return np.count_nonzero(partition.labels[source] != partition.labels[graph.neighbors]) // 2


@given(soups, st.integers(1, 20))
def test_derived_parts_cover_any_graph(faces, parts):
    graph = graph_of_faces(faces, 20)
    partition = derive_partition(graph, parts)
    assert partition.parts == parts
    assert sorted(partition.order) == list(range(20))
    assert np.diff(partition.bounds).min() >= 1
    for part in range(parts):
        members = partition.order[partition.bounds[part] : partition.bounds[part + 1]]
        assert (np.diff(members) > 0).all() and (partition.labels[members] == part).all()


@pytest.mark.parametrize("parts", [2, 7, 16, 33])
def test_derived_parts_are_even_and_short_of_boundary(parts):
    graph = graph_of(torus(80, 60))
    partition = derive_partition(graph, parts)
    share = graph.size / parts
    sizes = np.diff(partition.bounds)
    assert sizes.max() <= 1.03 * share + 2 and sizes.min() >= 0.9 * share
    assert cut(graph, partition) <= 1.4 * cut(graph, metis_partition(graph, parts))


@given(hnp.arrays(np.int32, st.integers(1, 60), elements=st.integers(0, 9)))
def test_labels_are_numbered_by_first_appearance(labels):
    partition = partition_of_labels(labels)
    _, first = np.unique(partition.labels, return_index=True)
    assert (np.diff(first) > 0).all()
    assert partition.parts == len(np.unique(labels))
    assert ((labels[:, None] == labels) == (partition.labels[:, None] == partition.labels)).all()


@given(soups, st.integers(1, 20))
def test_bisection_cuts_any_graph_into_equal_parts(faces, parts):
    order, bounds = bisect(graph_of_faces(faces, 20), parts)
    assert sorted(order) == list(range(20))
    sizes = np.diff(bounds)
    assert sizes.min() >= 20 // parts and sizes.max() <= -(-20 // parts) + 1


def test_a_bisection_keeps_neighbors_together():
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
