import numpy as np
import pytest

from bsm import CorruptError, OptionError
from bsm.bitstream.coefficients.packed import compress, pack_coefficients, unpack_coefficients
from bsm.bitstream.container.gop import MAX_EXPONENT, GopBody, GopField, GopMethod, write_gop_body

MOVING = GopField(3, 0.5, 3, np.array([7, 3, 40], np.int32), b"basis", b"levels")


def test_known_bytes_of_a_body():
    # method 0, T = 4, no stretches, step 0.5, r = 3, zigzag differences 7, -4, 37, length 5
    assert (
        write_gop_body(GopBody(GopMethod.LEARNT, 4, (MOVING,)))
        == b"\x00\x04\x00\x00\x00\x00\x3f\x03\x0e\x07\x4a\x05basislevels"
    )


def test_illegal_steps_cannot_be_written():
    # 0.1 is not exact in single precision.
    for step in (0.0, -1.0, float("inf"), float("nan"), 0.1):
        with pytest.raises(OptionError):
            write_gop_body(
                GopBody(
                    GopMethod.LEARNT, 1, (GopField(3, step, 0, np.empty(0, np.int32), b"", b""),)
                )
            )
    assert MAX_EXPONENT == 400


def test_packed_known_bytes():
    # 101 011 110 000, then zeros to the byte
    assert pack_coefficients(np.array([5, 3, 6, 0]), 3).hex() == "af00"


def test_packing_comes_back_and_unpacking_refuses_what_does_not_fit():
    assert len(compress(bytes(1000))) < 20 and compress(b"abc") == b"abc"
    for values in (np.arange(8), np.zeros(999, np.int64)):
        packed = pack_coefficients(values, 3)
        assert np.array_equal(unpack_coefficients(packed, 3, len(values)), values)
        for data in (packed[:-1], packed + b"0", compress(bytes(1 << 20)), b""):
            with pytest.raises(CorruptError):
                unpack_coefficients(data, 3, len(values))
