import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm.codec import _kernels
from bsm.codec.basis.laplacian import dense_laplacian, factorize, find_fronts, laplacian_of, solving_room
from bsm.codec.basis.orthogonal_iteration import hash_columns
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import graph_of_faces

soups = hnp.arrays(np.int32, st.tuples(st.integers(1, 150), st.just(3)), elements=st.integers(0, 69))


def solve(factor, columns):
    """R X for X of shape (n, c), rounded to single precision."""
    solution = np.empty(columns.shape)
    given = factor.fronts, factor.values, factor.inverse, np.ascontiguousarray(columns)
    _kernels.solve_columns(*given, solving_room(*columns.shape), solution)
    return solution


def unordered(faces, size):
    graph = graph_of_faces(faces, size)
    return Block(np.arange(size, dtype=np.int32), graph.offsets, graph.neighbors)


def fill(block, fronts):
    """Entries below the diagonal that elimination in this order fills: by brute force, on sets."""
    rows = fronts.rows.astype(int)
    later = {int(r): set(block.neighbors[block.offsets[r] : block.offsets[r + 1]].tolist()) for r in rows}
    pattern = {}
    for r in rows.tolist():
        pattern[r] = later.pop(r)
        for v in pattern[r]:
            later[v] = (later[v] | pattern[r]) - {r, v}
    return pattern


@settings(max_examples=12)
@given(soups)
def test_fronts_hold_everything_that_elimination_fills(faces):
    block = unordered(faces, 70)
    fronts = find_fronts(block.offsets, block.neighbors)
    assert sorted(fronts.rows) == list(range(70))
    assert np.array_equal(fronts.rows[fronts.steps], np.arange(70))
    pattern = fill(block, fronts)
    for t in range(len(fronts.firsts) - 1):
        first, end = int(fronts.firsts[t]), int(fronts.firsts[t + 1])
        assert (fronts.owners[first:end] == t).all()
        border = fronts.borders[fronts.starts[t] : fronts.starts[t + 1]]
        assert len(border) % 2 == 0 and (np.diff(border.astype(int)) > 0).all() and (border >= end).all()
        held = {int(fronts.rows[s]) for s in [*range(first, end), *border] if s < 70}
        for step in range(first, end):
            assert pattern[int(fronts.rows[step])] <= held


@settings(max_examples=40)
@given(soups, st.floats(1e-3, 10.0))
def test_any_graph_can_be_solved(faces, shift):
    block = unordered(faces, 70)
    columns = hash_columns(70, 3)
    shifted = dense_laplacian(block) + shift * np.eye(70)
    expected = np.linalg.solve(shifted, columns)
    found = solve(factorize(laplacian_of(block), shift), columns)
    assert np.allclose(found, expected, rtol=0, atol=1e-4 / shift**0.5 * np.abs(expected).max())
