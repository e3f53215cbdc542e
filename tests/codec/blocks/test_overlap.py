import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm import BsmError
from bsm._core import Cut
from bsm.codec.blocks.overlap import block_size, derive_partition, grow_blocks, metis_partition, partition_of_labels
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import even_interval
from tests.codec.geometry.test_graph import graph_of, soups
from tests.shapes import grid_faces, patch, tetrahedron, together, torus


def blocks_of(graph, parts, overlap):
    partition = derive_partition(graph, parts)
    return partition, grow_blocks(graph, partition, block_size(partition, overlap))


def neighbors_of(graph, vertices):
    return {int(w) for v in vertices for w in graph.neighbors[graph.offsets[v] : graph.offsets[v + 1]]}


@pytest.mark.parametrize("overlap", [1.0, 1.15, 1.5])
def test_blocks_hold_their_part_and_rings_around_it(overlap):
    graph = graph_of(torus(50, 40))
    partition, blocks = blocks_of(graph, 9, overlap)
    size = block_size(partition, overlap)
    assert blocks.count == 9
    for index in range(blocks.count):
        members = blocks.members_of(index)
        assert len(members) == len(set(members)) == size
        assert set(core_of(blocks, index)) == set(np.flatnonzero(partition.labels == partition.labels[members[0]]))
        outside = np.setdiff1d(members, core_of(blocks, index))
        assert set(outside) <= neighbors_of(graph, members)


@pytest.mark.parametrize("parts", [1, 2, 13, 60])
def test_every_block_of_a_connected_mesh_touches_one_before_it(parts):
    graph = graph_of(torus(50, 40))
    _, blocks = blocks_of(graph, parts, 1.0)
    seen = set(core_of(blocks, 0))
    steps = 0
    for index in range(1, parts):
        around = neighbors_of(graph, core_of(blocks, index))
        assert around & seen
        steps += bool(around & set(core_of(blocks, index - 1)))
        seen |= set(core_of(blocks, index))
    assert steps >= 0.8 * (parts - 1)


def test_a_component_smaller_than_a_block_stays_small():
    _, blocks = blocks_of(graph_of(together(patch(5, 6), patch(5, 6))), 2, 1.5)
    assert np.diff(blocks.starts).tolist() == [30, 30]
    _, blocks = blocks_of(graph_of(together(*[tetrahedron()] * 8)), 8, 1.0)
    assert sorted(sorted(blocks.members_of(i))[0] for i in range(8)) == list(range(0, 32, 4))


def test_many_parts_are_chained_in_linear_time():
    # A rule that looked at all parts, or at all of a hub's, for every step would take minutes.
    fan = np.stack([np.zeros(99_998, int), np.arange(1, 99_999), np.arange(2, 100_000)], axis=1).astype(np.int32)
    apart = np.arange(99_999, dtype=np.int32).reshape(-1, 3)
    for faces in (fan, apart):
        graph = graph_of_faces(faces, int(faces.max()) + 1)
        _, blocks = blocks_of(graph, graph.size, 1.0)
        assert sorted(core_of(blocks, index)[0] for index in range(blocks.count)) == list(range(graph.size))


def test_blocks_do_not_grow_over_hubs():
    wheel = np.stack([np.zeros(2000, int), np.arange(1, 2001), np.r_[np.arange(2, 2001), 1]], axis=1).astype(np.int32)
    _, blocks = blocks_of(graph_of_faces(wheel, 2001), 20, 1.3)
    assert sum(0 in blocks.members_of(index) for index in range(20)) == 1


def core_of(blocks, index):
    return blocks.members_of(index)[: blocks.cores[index]]


@given(soups, st.integers(1, 6), st.sampled_from([1.0, 1.5]))
def test_a_blocks_graph_is_that_of_its_vertices(faces, parts, overlap):
    graph = graph_of_faces(faces, 20)
    _, blocks = blocks_of(graph, parts, overlap)
    for index in range(parts):
        block = blocks.block(index)
        assert sorted(block.vertices) == sorted(blocks.members_of(index))
        for row, v in enumerate(block.vertices):
            local = block.neighbors[block.offsets[row] : block.offsets[row + 1]]
            beyond = graph.neighbors[graph.offsets[v] : graph.offsets[v + 1]]
            assert sorted(block.vertices[local]) == [w for w in beyond if w in block.vertices]


@given(st.integers(1, 40), st.integers(1, 200))
def test_chains_are_evened_out_without_being_more(interval, blocks):
    even = even_interval(interval, blocks)
    chains = -(-blocks // interval)
    assert even <= interval and -(-blocks // even) == chains
    assert blocks - (chains - 1) * even > 0 and even - 1 < blocks / chains
    assert even_interval(0, blocks) == 0


def cut(graph, partition):
    source = np.repeat(np.arange(graph.size), np.diff(graph.offsets))
    return np.count_nonzero(partition.labels[source] != partition.labels[graph.neighbors]) // 2


@given(soups, st.integers(1, 20))
def test_derived_parts_cover_any_graph(faces, parts):
    graph = graph_of_faces(faces, 20)
    partition = derive_partition(graph, parts)
    assert partition.parts == parts
    assert partition.sizes.sum() == len(partition.labels) == 20
    assert partition.sizes.min() >= 1


@pytest.mark.parametrize("parts", [2, 7, 16, 33])
def test_derived_parts_are_even_and_short_of_boundary(parts):
    graph = graph_of(torus(80, 60))
    partition = derive_partition(graph, parts)
    share = graph.size / parts
    sizes = partition.sizes
    assert sizes.max() <= 1.03 * share + 2 and sizes.min() >= 0.9 * share
    assert cut(graph, partition) <= 1.4 * cut(graph, metis_partition(graph, parts))


@given(hnp.arrays(np.int32, st.integers(1, 60), elements=st.integers(0, 9)))
def test_labels_are_numbered_by_first_appearance(labels):
    partition = partition_of_labels(labels)
    _, first = np.unique(partition.labels, return_index=True)
    assert (np.diff(first) > 0).all()
    assert partition.parts == len(np.unique(labels))
    assert ((labels[:, None] == labels) == (partition.labels[:, None] == partition.labels)).all()


def test_rows_keep_neighbors_together():
    """In a square grid, halves are cut across: rows that are k apart lie about sqrt(k) apart."""
    rows = 32
    graph = graph_of_faces(grid_faces(rows, rows), rows * rows)
    order = grow_blocks(graph, derive_partition(graph, 1), rows * rows).block(0).vertices
    places = np.stack(np.divmod(order, rows), axis=1)
    for gap in (16, 64, 256):
        apart = np.abs(places[gap:] - places[:-gap]).sum(axis=1)
        assert np.median(apart) < 3 * gap**0.5
    for part in order.reshape(4, -1):
        assert np.ptp(part // rows) + np.ptp(part % rows) < 48


@pytest.mark.parametrize(("labels", "size"), [([0, 1, 2, -1], 4), ([0, 0, 0], 4), ([0, 0, 0, 1], 2), ([0] * 4, 4)])
def test_parts_that_do_not_fit_are_refused(labels, size):
    graph = graph_of(tetrahedron())
    with pytest.raises(BsmError, match=r"fit|blocks of"):
        Cut(graph.offsets, graph.neighbors).blocks(np.array(labels, np.int32), 2, size)
