import numpy as np
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.smooth import NODES, filter_polynomial, smooth, smoothing_spectrum
from tests.shapes import torus


def random_walk_laplacian(graph):
    adjacency = sp.csr_matrix((np.ones(len(graph.neighbors)), graph.neighbors, graph.offsets))
    return sp.eye(graph.size) - sp.diags(1 / np.diff(graph.offsets)) @ adjacency


@given(st.floats(0.0, 64.0))
def test_the_polynomial_meets_the_low_pass_at_its_nodes(amount):
    powers = filter_polynomial(amount)
    for x in NODES:
        assert np.isclose(1 + sum(p * x**k for k, p in enumerate(powers, 2)), 1 / (1 + amount * x * x), atol=1e-12)


def test_smoothing_is_the_polynomial_of_the_sparse_matrix():
    mesh = torus()
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    laplacian = random_walk_laplacian(graph)
    expected, term = mesh.positions.copy(), laplacian @ mesh.positions
    for p in filter_polynomial(4.0):
        term = laplacian @ term
        expected += p * term
    assert np.allclose(smooth(graph, mesh.positions, 4.0), expected, atol=1e-13)
    rows = np.array([3, 500, 77])
    part = smoothing_spectrum(graph, mesh.positions).only(rows)
    assert np.array_equal(part.smoothed(4.0), smooth(graph, mesh.positions, 4.0)[rows])
