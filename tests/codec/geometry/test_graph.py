import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm.codec.geometry.graph import graph_of_faces, mesh_edges, vertex_faces, vertex_neighbors
from bsm.codec.geometry.welding import weld


def graph_of(mesh):
    return graph_of_faces(mesh.faces, len(mesh.positions))


soups = hnp.arrays(np.int32, st.tuples(st.integers(1, 40), st.just(3)), elements=st.integers(0, 19))


@given(soups)
def test_rows_equal_sets_built_the_slow_way(faces):
    around, near = vertex_faces(faces, 20), vertex_neighbors(faces, 20)
    pairs = {(int(a), int(b)) for f in faces for a in f for b in f if a != b}
    for v in range(20):
        holding = [i for i, face in enumerate(faces) if v in face]
        assert around.members[around.starts[v] : around.starts[v + 1]].tolist() == holding
        assert near.members[near.starts[v] : near.starts[v + 1]].tolist() == sorted(
            b for a, b in pairs if a == v
        )
    assert mesh_edges(faces, 20).tolist() == sorted([a, b] for a, b in pairs if a < b)


few_places = hnp.arrays(
    np.float64,
    st.tuples(st.integers(1, 40), st.just(3)),
    elements=st.sampled_from([-1.0, 0.0, 2.5]),
)


@given(few_places, st.data())
def test_every_vertex_finds_its_place_again(positions, data):
    faces = data.draw(hnp.arrays(np.int32, (7, 3), elements=st.integers(0, len(positions) - 1)))
    welded, welded_faces, index = weld(positions, faces)
    assert (welded[index] == positions).all()
    assert (welded_faces == index[faces]).all()
    assert len(np.unique(welded, axis=0)) == len(welded)
    first_seen = np.unique(index, return_index=True)[1]
    assert (np.diff(first_seen) > 0).all()


def test_minus_zero_is_zero_and_nothing_else_is_near_enough():
    positions = np.array([[0.0, 1, 2], [-0.0, 1, 2], [np.nextafter(0.0, 1.0), 1, 2]])
    welded, _, index = weld(positions, np.array([[0, 1, 2]], dtype=np.int32))
    assert index.tolist() == [0, 0, 1]
    assert len(welded) == 2
