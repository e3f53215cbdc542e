import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm import BsmError
from bsm.bitstream.connectivity.partition import encode_labels
from tools.payloads import decode_labels


def grid(rows, columns):
    """CSR of a grid with diagonals, rows sorted."""
    index = np.arange(rows * columns).reshape(rows, columns)
    pairs = [(index[:, 1:], index[:, :-1]), (index[1:], index[:-1]), (index[1:, 1:], index[:-1, :-1])]
    a = np.concatenate([p.ravel() for p, _ in pairs])
    b = np.concatenate([q.ravel() for _, q in pairs])
    ends = sorted(zip(np.r_[a, b].tolist(), np.r_[b, a].tolist(), strict=True))
    offsets = np.searchsorted([v for v, _ in ends], np.arange(rows * columns + 1)).astype(np.int32)
    return offsets, np.array([w for _, w in ends], np.int32)


def numbered(labels):
    """Labels numbered by first appearance."""
    _, first, compact = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    return rank[compact].astype(np.int32)


GRID = grid(6, 7)


@given(hnp.arrays(np.int32, 42, elements=st.integers(0, 41)))
def test_any_labels_come_back(labels):
    labels = numbered(labels)
    parts = int(labels.max()) + 1
    assert np.array_equal(decode_labels(encode_labels(*GRID, labels, parts), *GRID, parts), labels)


def test_compact_parts_cost_little():
    offsets, neighbors = grid(60, 60)
    labels = numbered(np.add.outer(np.arange(60) // 20 * 3, np.arange(60) // 20).ravel())
    data = encode_labels(offsets, neighbors, labels, 9)
    assert 8 * len(data) < 0.2 * len(labels)


def test_another_number_of_parts_is_refused():
    data = encode_labels(*GRID, numbered(np.arange(42) // 10), 5)
    for parts in (4, 6):
        with pytest.raises(BsmError):
            decode_labels(data, *GRID, parts)
