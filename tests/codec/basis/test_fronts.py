"""Laplacians are solved by fronts on any graph."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import graph_of_faces
from tools.laplacians import dense_laplacian

soups = hnp.arrays(
    np.int32, st.tuples(st.integers(1, 150), st.just(3)), elements=st.integers(0, 69)
)


@settings(max_examples=60)
@given(soups, st.floats(1e-3, 10.0))
def test_any_graph_can_be_solved(faces, shift):
    """One iteration is the Q of a solution, whatever elimination fills in."""
    graph = graph_of_faces(faces, 70)
    block = Block(np.arange(70, dtype=np.int32), graph.offsets, graph.neighbors)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, (70, 3)).astype(np.float32)
    expected, upper = np.linalg.qr(
        np.linalg.solve(dense_laplacian(block) + shift * np.eye(70), start)
    )
    found = block.iterated(start, shift)
    assert np.allclose(found, expected * np.sign(np.diag(upper)), rtol=0, atol=1e-4 / shift**0.5)
