import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm.codec.geometry.graph import (
    component_sizes,
    graph_of_faces,
    is_connected,
    mesh_edges,
    vertex_faces,
    vertex_neighbors,
)

soups = hnp.arrays(np.int32, st.tuples(st.integers(1, 40), st.just(3)), elements=st.integers(0, 19))


@given(soups, st.integers(1, 20))
def test_a_graph_is_connected_where_it_is_one_component(faces, size):
    graph = graph_of_faces(faces % size, size)
    assert is_connected(graph) == (len(component_sizes(graph)) == 1)


def test_a_vertex_of_high_degree_has_sorted_neighbors():
    fan = np.array([[0, 60 - i, 59 - i] for i in range(59)], np.int32)
    graph = graph_of_faces(fan, 61)
    assert graph.neighbors[: graph.offsets[1]].tolist() == list(range(1, 61))


@given(soups)
def test_rows_equal_sets_built_the_slow_way(faces):
    around, near = vertex_faces(faces, 20), vertex_neighbors(faces, 20)
    pairs = {(int(a), int(b)) for f in faces for a in f for b in f if a != b}
    for v in range(20):
        holding = [i for i, face in enumerate(faces) if v in face]
        assert around.members[around.starts[v] : around.starts[v + 1]].tolist() == holding
        assert near.members[near.starts[v] : near.starts[v + 1]].tolist() == sorted(b for a, b in pairs if a == v)
    assert mesh_edges(faces, 20).tolist() == sorted([a, b] for a, b in pairs if a < b)
