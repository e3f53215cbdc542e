import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm import BsmError
from bsm._core import Cut
from bsm.codec.blocks.overlap import block_size, derive_partition, grow_blocks
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import even_interval
from tests.codec.geometry.test_graph import graph_of
from tests.shapes import tetrahedron, torus


def blocks_of(graph, parts, overlap):
    partition = derive_partition(graph, parts)
    return partition, grow_blocks(graph, partition, block_size(partition, overlap))


def neighbors_of(graph, vertices):
    return {
        int(w) for v in vertices for w in graph.neighbors[graph.offsets[v] : graph.offsets[v + 1]]
    }


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


def test_many_parts_are_chained_in_linear_time():
    # A rule that looked at all parts, or at all of a hub's, for every step would take minutes.
    fan = np.stack(
        [np.zeros(99_998, int), np.arange(1, 99_999), np.arange(2, 100_000)], axis=1
    ).astype(np.int32)
    apart = np.arange(99_999, dtype=np.int32).reshape(-1, 3)
    for faces in (fan, apart):
        graph = graph_of_faces(faces, int(faces.max()) + 1)
        _, blocks = blocks_of(graph, graph.size, 1.0)
        assert sorted(core_of(blocks, index)[0] for index in range(blocks.count)) == list(
            range(graph.size)
        )


def core_of(blocks, index):
    return blocks.members_of(index)[: blocks.cores[index]]


@given(st.integers(1, 40), st.integers(1, 200))
def test_chains_are_evened_out_without_being_more(interval, blocks):
    even = even_interval(interval, blocks)
    chains = -(-blocks // interval)
    assert even <= interval and -(-blocks // even) == chains
    assert blocks - (chains - 1) * even > 0 and even - 1 < blocks / chains
    assert even_interval(0, blocks) == 0


@pytest.mark.parametrize(
    ("labels", "size"), [([0, 1, 2, -1], 4), ([0, 0, 0], 4), ([0, 0, 0, 1], 2), ([0] * 4, 4)]
)
def test_parts_that_do_not_fit_are_refused(labels, size):
    graph = graph_of(tetrahedron())
    with pytest.raises(BsmError, match=r"fit|blocks of"):
        Cut(graph.offsets, graph.neighbors).blocks(np.array(labels, np.int32), 2, size)
