import numpy as np
import pytest

from bsm import OptionError
from bsm.bitstream.coefficients.packed import compress, pack_coefficients


def test_packed_known_bytes():
    # 101 011 110 000, then zeros to the byte
    assert pack_coefficients(np.array([5, 3, 6, 0]), 3).hex() == "af00"


def test_packing_refuses_what_does_not_fit():
    assert len(compress(bytes(1000))) < 20 and compress(b"abc") == b"abc"
    for values, bits in [([8], 3), ([-1], 3), ([0.5], 3), ([0], 0), ([0], 33)]:
        with pytest.raises(OptionError):
            pack_coefficients(np.array(values), bits)
