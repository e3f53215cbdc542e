"""Links."""

import pytest

from tools.measure.speed import Delivery, break_even


def test_the_link_on_which_both_are_as_quick():
    ours, theirs = Delivery(1_000, 7.0, 0.05), Delivery(11_000, 6.9, 0.01)
    assert break_even(ours, theirs) == pytest.approx(2.0)  # 80,000 bits in 40 ms
    assert break_even(Delivery(1_000, 7.0, 0.01), theirs) == float("inf")
    assert break_even(Delivery(11_000, 7.0, 0.05), theirs) == 0.0
