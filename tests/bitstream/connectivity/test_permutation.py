"""Permutations, rotations and the original order of a mesh: exact round trips, and damage is noticed."""

from __future__ import annotations

from math import lgamma, log

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bsm import BsmError, CorruptError, OptionError, TruncatedError
from bsm.bitstream import _kernels
from bsm.bitstream.connectivity.order import permutation_bank, rotation_bank, write_permutation, write_rotations
from bsm.bitstream.connectivity.partition import encode_labels
from bsm.bitstream.entropy.range_coder import finish_writing, start_writing
from tools.payloads import decode_labels, finish_reading, start_reading

quick = settings(max_examples=100)


def encode(write, values) -> bytes:
    return finish_writing(write(start_writing(0), np.array(values, np.int32)))


def decode(write, payload: bytes, size: int) -> np.ndarray:
    values, coder = np.zeros(size, np.int32), start_reading(payload)
    if write is write_permutation:
        legal = _kernels.code_steps(coder, permutation_bank(), values, np.empty(size + 1, np.int32))
    else:
        legal = _kernels.code_turns(coder, rotation_bank(), values)
    finish_reading(coder)
    if not legal:
        raise CorruptError("not a permutation")
    return values


@quick
@given(st.integers(0, 300).flatmap(lambda n: st.permutations(range(n))))
def test_permutations_round_trip(order: list[int]) -> None:
    np.testing.assert_array_equal(decode(write_permutation, encode(write_permutation, order), len(order)), order)


@quick
@given(st.lists(st.integers(0, 2), max_size=300))
def test_rotations_round_trip(rotations: list[int]) -> None:
    np.testing.assert_array_equal(
        decode(write_rotations, encode(write_rotations, rotations), len(rotations)), rotations
    )


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


def test_damage_to_a_permutation_is_noticed_or_gives_another() -> None:
    rng = np.random.default_rng(1)
    payload = encode(write_permutation, rng.permutation(300))
    damaged = [payload[:size] for size in range(len(payload) - 4)]
    for _ in range(500):
        data = bytearray(payload)
        data[rng.integers(0, len(data))] ^= int(rng.integers(1, 256))
        damaged.append(bytes(data))
    noticed = 0
    for data in damaged:
        try:
            order = decode(write_permutation, data, 300)
        except (CorruptError, TruncatedError):
            noticed += 1
            continue
        np.testing.assert_array_equal(np.sort(order), np.arange(300))
    assert noticed > 0.8 * len(damaged)


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
