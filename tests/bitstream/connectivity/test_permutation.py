"""Permutations, rotations and partitions: what they cost, and what cannot be written."""

from math import lgamma, log

import numpy as np
import pytest

from bsm import OptionError
from bsm.bitstream.connectivity.order import write_permutation, write_rotations
from bsm.bitstream.connectivity.partition import encode_labels
from bsm.bitstream.entropy.range_coder import finish_writing, start_writing
from bsm.codec.geometry.graph import graph_of_faces
from tests.shapes import grid_faces


def encode(write, values) -> bytes:
    return finish_writing(write(start_writing(0), np.array(values, np.int32)))


def test_random_order_costs_about_its_entropy_and_runs_cost_little() -> None:
    size = 5000
    order = np.random.default_rng(0).permutation(size)
    assert 8 * len(encode(write_permutation, order)) < 1.1 * lgamma(size + 1) / log(2)
    assert len(encode(write_permutation, np.arange(size))) < 40
    assert len(encode(write_permutation, np.arange(size)[::-1])) < 60
    assert len(encode(write_permutation, np.roll(np.arange(size), 1234))) < 50
    assert len(encode(write_permutation, np.arange(size).reshape(50, 100).T.ravel())) < 0.2 * size


@pytest.mark.parametrize("order", [[0, 0], [1, 2], [-1, 0], [[0, 1]]])
def test_what_is_no_permutation_is_refused(order: list[int]) -> None:
    with pytest.raises(OptionError):
        encode(write_permutation, order)
    with pytest.raises(OptionError):
        encode(write_rotations, [0, 1, 3])


def test_compact_parts_cost_little():
    graph = graph_of_faces(grid_faces(60, 60), 3600)
    labels = np.add.outer(np.arange(60) // 20 * 3, np.arange(60) // 20).ravel().astype(np.int32)
    data = encode_labels(graph.offsets, graph.neighbors, labels, 9)
    assert 8 * len(data) < 0.2 * len(labels)
