import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm import Encoder, OptionError
from bsm.bitstream.container.header import LAW
from bsm.codec.basis.laplacian import dense_laplacian
from bsm.codec.blocks.overlap import derive_partition, grow_blocks
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import Chain
from bsm.codec.static.coding import rules_of
from bsm.options import encode_options
from tests.shapes import patch, torus

STIFFNESS = 8.0


def chain_of(mesh, parts, size):
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    blocks = grow_blocks(graph, derive_partition(graph, parts), size)
    return Chain(rules_of(LAW), blocks), blocks


def step(chain, index, positions):
    """Go through a block as if it decoded to these positions."""
    vertices = chain.begin(index)[0]
    chain.dictionary(4)
    chain.commit(4, np.ascontiguousarray(positions[vertices]))
    return vertices


def test_springs_count_edges_that_leave_and_known_rows():
    mesh = torus(10, 8)
    chain, blocks = chain_of(mesh, 4, 26)
    graph = blocks.graph
    known = set(step(chain, 0, np.ones((80, 3))).tolist())
    vertices, continuation, weights = chain.begin(1)
    offsets, neighbors, springs, pulls = chain.site()
    assert np.array_equal(weights, np.maximum(np.diff(offsets), 1))
    inside = set(vertices.tolist())
    assert known & inside and known - inside
    for row, v in enumerate(vertices.tolist()):
        around = set(graph.neighbors[graph.offsets[v] : graph.offsets[v + 1]].tolist())
        assert {int(vertices[w]) for w in neighbors[offsets[row] : offsets[row + 1]]} == around & inside
        assert springs[row] == len(around & known - inside) + STIFFNESS * (v in known)
    assert np.allclose(pulls, springs[:, None])
    assert np.allclose(continuation, 1.0, atol=1e-4)


@given(st.integers(0, 2**32 - 1))
def test_the_extension_is_the_equilibrium_within_the_hull_of_the_pulls(seed):
    mesh = patch(11, 9)
    chain, blocks = chain_of(mesh, 3, 45)
    places = np.random.default_rng(seed).normal(size=(99, 3))
    known = step(chain, 0, places)
    _, found, _ = chain.begin(1)
    springs, pulls = chain.site()[2:]
    matrix = dense_laplacian(blocks.block(1)) + np.diag(springs)
    assert np.abs(found - np.linalg.solve(matrix, pulls)).max() < 0.05
    held = places[known]
    assert (found >= held.min(axis=0) - 1e-9).all() and (found <= held.max(axis=0) + 1e-9).all()


def test_blocks_come_in_their_order():
    chain, _ = chain_of(torus(10, 8), 4, 26)
    with pytest.raises(OptionError, match="not the next"):
        chain.begin(1)


def test_positions_that_do_not_fit_are_refused():
    chain, _ = chain_of(torus(10, 8), 4, 26)
    vertices = chain.begin(0)[0]
    chain.dictionary(4)
    with pytest.raises(OptionError, match="fit"):
        chain.commit(4, np.zeros((len(vertices) + 1, 3)))


def test_prediction_saves_bits_and_error():
    mesh = torus(90, 60)
    options = {"block_size": 250, "overlap": 1.0, "keep": 0.12, "key_interval": 0, "step": 0.004, "threads": 1}
    held = Encoder(mesh, encode_options(**options)).result()
    loose = Encoder(mesh, encode_options(**options, predict=False)).result()
    assert held.size < 0.9 * loose.size
    assert held.comparison.nmsve < loose.comparison.nmsve
