import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm.bitstream.coefficients.packed import compress, decompress, pack_coefficients, unpack_coefficients
from bsm.bitstream.errors import CorruptError, OptionError


def test_packed_known_bytes():
    # 101 011 110 000, then zeros to the byte
    assert pack_coefficients(np.array([5, 3, 6, 0]), 3).hex() == "af00"
    assert unpack_coefficients(bytes.fromhex("af00"), 4, 3).tolist() == [5, 3, 6, 0]


@given(st.integers(1, 32), st.data())
def test_packed_round_trip(bits, data):
    values = np.array(data.draw(st.lists(st.integers(0, 2**bits - 1), max_size=200)), dtype=np.uint32)
    packed = pack_coefficients(values, bits)
    assert len(packed) <= (values.size * bits + 7) // 8
    assert np.array_equal(unpack_coefficients(packed, values.size, bits), values)


def test_packing_refuses_what_does_not_fit():
    for values, bits in [([8], 3), ([-1], 3), ([0.5], 3), ([0], 0), ([0], 33)]:
        with pytest.raises(OptionError):
            pack_coefficients(np.array(values), bits)


def test_unpacking_refuses_other_sizes():
    packed = pack_coefficients(np.array([5, 3, 6]), 3)
    for count in (0, 2, 6, 1000):
        with pytest.raises(CorruptError):
            unpack_coefficients(packed, count, 3)
    with pytest.raises(CorruptError, match="not 0"):
        unpack_coefficients(b"\xaf\x01", 4, 3)


@given(st.binary(max_size=500))
def test_compressed_round_trip(data):
    assert decompress(compress(data), len(data)) == data
    assert decompress(compress(data * 20), len(data) * 20) == data * 20


def test_decompression_yields_exactly_what_is_expected():
    data = compress(bytes(1000))
    assert len(data) < 20
    for size in (0, 999, 1001, 1 << 40):
        with pytest.raises(CorruptError):
            decompress(data, size)
