import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bsm import Encoder
from bsm.codec.basis.laplacian import dense_laplacian, laplacian_of
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import Known, Surroundings
from bsm.options import encode_options
from tests.shapes import patch, torus


def piece(graph, vertices):
    """The block of `vertices`, rows in the order given."""
    number = {int(v): row for row, v in enumerate(vertices)}
    rows = [
        [number[int(w)] for w in graph.neighbors[graph.offsets[v] : graph.offsets[v + 1]] if int(w) in number]
        for v in vertices
    ]
    offsets = np.cumsum([0, *map(len, rows)]).astype(np.int32)
    return Block(np.array(vertices, np.int32), offsets, np.array([w for row in rows for w in row], np.int32))


SHIFT = 2.0**-16


def test_springs_count_edges_that_leave_and_known_rows():
    graph = graph_of_faces(torus(10, 8).faces, 80)
    known = Known(graph, 3.0)
    first = piece(graph, np.arange(30))
    known.add(first, np.ones((30, 3)))
    block = piece(graph, np.arange(28, 60))
    around = known.around(laplacian_of(block), SHIFT)
    for row, v in enumerate(block.vertices):
        beyond = [w for w in graph.neighbors[graph.offsets[v] : graph.offsets[v + 1]] if w < 28]
        assert around.springs[row] == len(beyond) + (3.0 if v < 30 else 0.0)
    assert np.allclose(around.pulls, around.springs[:, None])
    assert np.array_equal(known.around(laplacian_of(block), SHIFT).springs, around.springs)


@given(st.integers(0, 2**32 - 1))
def test_the_extension_is_the_equilibrium_within_the_hull_of_the_pulls(seed):
    random = np.random.default_rng(seed)
    graph = graph_of_faces(patch(9, 7).faces, 63)
    block = piece(graph, random.permutation(63))
    springs = np.where(random.random(63) < 0.2, random.integers(1, 9, 63), 0).astype(float)
    springs[0] = 1.0
    places = random.normal(size=(63, 3))
    found = Surroundings(laplacian_of(block), springs, SHIFT, springs[:, None] * places).continuation
    expected = np.linalg.solve(dense_laplacian(block) + np.diag(springs), springs[:, None] * places)
    assert np.abs(found - expected).max() < 0.05
    held = places[springs > 0]
    assert (found >= held.min(axis=0) - 1e-9).all() and (found <= held.max(axis=0) + 1e-9).all()


def test_prediction_saves_bits_and_error():
    mesh = torus(90, 60)
    options = {"block_size": 250, "overlap": 1.0, "keep": 0.12, "key_interval": 0, "step": 0.004, "threads": 1}
    held = Encoder(mesh, encode_options(**options)).result()
    loose = Encoder(mesh, encode_options(**options, predict=False)).result()
    assert held.size < 0.9 * loose.size
    assert held.comparison.nmsve < loose.comparison.nmsve
