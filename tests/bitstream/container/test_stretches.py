from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm.bitstream.container.gop import write_stretches
from tools.payloads import parse_stretches
from tools.surgery import Cursor


@given(st.lists(st.integers(0, 40), min_size=41, max_size=60))
def test_any_order_of_frames_comes_back(shown):
    cursor = Cursor(write_stretches(np.array(shown)) + b"rest")
    assert parse_stretches(cursor, len(shown)) == shown
    assert cursor.rest() == b"rest"


@pytest.mark.parametrize(
    ("shown", "coded"),
    [
        ([*range(24), *range(24)], b"\x02\x00\x18\x8d\x01\x18"),  # 24 on from 0; 24 on from 0, 24 behind what is due
        ([0, 0, 1, 1, 2, 2], b"\x03\x01\x02\x01\x02\x01\x02"),  # each is shown twice
        ([0, 1, 2, 3, 2, 1, 0], b"\x02\x00\x04\x0b\x03"),  # there, and back
        ([0, 2, 1, 1], b"\x03\x00\x01\x08\x02\x03\x01"),
    ],
)
def test_known_stretches(shown, coded):
    assert write_stretches(np.array(shown)) == coded
    assert parse_stretches(Cursor(coded), len(shown)) == shown


def test_frames_in_order_are_one_byte():
    assert write_stretches(None) == b"\0"
    assert parse_stretches(Cursor(b"\0"), 3) == [0, 1, 2]
