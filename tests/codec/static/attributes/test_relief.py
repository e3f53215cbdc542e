"""Positions as whole numbers that all decoders agree on."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm.bitstream.container.wire import write_varint
from bsm.bitstream.errors import CorruptError
from bsm.codec.static.attributes.relief import MARGIN, Solid, relief_exponent


@given(st.integers(0, 2**32 - 1), st.integers(1, 20))
def test_what_decoders_may_differ_by_changes_nothing(seed, exponent):
    random = np.random.default_rng(seed)
    positions = random.uniform(-0.5, 0.5, (40, 3))
    ties = random.integers(-(2 ** (exponent - 1)), 2 ** (exponent - 1), (40, 3)) + 0.5
    positions = np.where(random.random((40, 3)) < 0.3, ties / 2.0**exponent, positions)
    positions += random.normal(0, MARGIN / 20, (40, 3))
    solid = Solid(positions)
    doubts = solid.doubts(exponent)
    other = Solid(positions + random.uniform(-0.9, 0.9, (40, 3)) * MARGIN)
    assert (other.relief(exponent, doubts) == solid.relief(exponent, doubts)).all()
    assert np.abs(solid.relief(exponent, doubts) - positions * 2.0**exponent).max() <= 0.5 + 2 * MARGIN * 2.0**exponent


def test_doubts_of_other_positions_are_refused():
    solid = Solid(np.zeros((2, 3)))
    for doubts in (b"\x0c", b"\x02\x01", b"\x80", b"\x80\x00", b"\xff" * 6, write_varint(2**34)):
        with pytest.raises(CorruptError):
            solid.relief(3, doubts)
    assert solid.relief(3, b"").tolist() == [[0] * 3] * 2
    assert solid.relief(3, b"\x00\x0b").ravel().tolist() == [-1, 0, 0, 0, 0, 0]
    assert solid.relief(3, b"\x0a").ravel().tolist() == [0, 0, 0, 0, 0, -1]


def test_the_step_follows_the_edges():
    faces = np.array([[0, 1, 2]])
    small = relief_exponent(np.eye(3) / 1000, faces)
    assert relief_exponent(np.eye(3), faces) < small <= 20
    assert relief_exponent(np.zeros((3, 3)), faces) == 1
