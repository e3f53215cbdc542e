"""What `python -m tools.measure look` prints."""

import numpy as np
import pytest

from bsm.codec.look.measure import judged
from tools.measure.look import Draco, size_at


def test_sizes_lie_between_those_of_two_numbers_of_bits():
    curve = [Draco(9, 1000, judged(0.08, 0.0, 0.0)), Draco(10, 2000, judged(0.02, 0.0, 0.0))]
    assert size_at(curve, 0.08) == pytest.approx(1000)
    assert size_at(curve, 0.02) == pytest.approx(2000)
    assert size_at(curve, 0.04) == pytest.approx(2**0.5 * 1000)
    assert np.isnan(size_at(curve, 0.1))
