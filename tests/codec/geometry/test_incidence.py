"""Rows of faces and neighbours against sets built the slow way."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bsm.codec.geometry.graph import mesh_edges, vertex_faces, vertex_neighbours

triangles = st.lists(st.tuples(*[st.integers(0, 8)] * 3), min_size=1, max_size=20)


@given(triangles)
def test_rows_equal_sets_built_the_slow_way(rows: list[tuple[int, int, int]]) -> None:
    faces = np.array(rows, dtype=np.int32)
    around, near = vertex_faces(faces, 9), vertex_neighbours(faces, 9)
    pairs = {(a, b) for f in rows for a in f for b in f if a != b}
    for v in range(9):
        assert around.members[around.starts[v] : around.starts[v + 1]].tolist() == [
            i for i, f in enumerate(rows) if v in f
        ]
        assert near.members[near.starts[v] : near.starts[v + 1]].tolist() == sorted(b for a, b in pairs if a == v)
    assert mesh_edges(faces, 9).tolist() == sorted([a, b] for a, b in pairs if a < b)
