import binascii
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm import FormatError, LimitError, Limits, OptionError, UnsupportedError
from bsm.bitstream.container.wire import MAX_VARINT, write_frame, write_preamble, write_varint
from bsm.files.inspection import Skimmer
from tools.surgery import Cursor


@pytest.mark.parametrize(
    ("value", "expected"), [(0, "00"), (1, "01"), (127, "7f"), (128, "8001"), (300, "ac02"), (2**35 - 1, "ffffffff7f")]
)
def test_varint_known_bytes(value, expected):
    assert write_varint(value).hex() == expected


@given(st.integers(0, MAX_VARINT))
def test_varints_round_trip(value):
    cursor = Cursor(b"?" + write_varint(value) + b"tail", 1)
    assert cursor.varint() == value and cursor.rest() == b"tail"


@pytest.mark.parametrize("value", [-1, 2**35])
def test_varint_refuses_what_does_not_fit(value):
    with pytest.raises(OptionError):
        write_varint(value)


def test_blocks_and_short_frames_have_short_checksums():
    for kind, payload, tag in ((6, b"abc", b"\x36"), (3, b"abc", b"\x33"), (3, b"a" * 127, b"\xf3\x0f")):
        frame = tag + payload
        assert write_frame(kind, payload) == frame + binascii.crc_hqx(frame, 0).to_bytes(2, "little")
    block = b"\x86\x10" + b"a" * 128
    assert write_frame(6, b"a" * 128) == block + binascii.crc_hqx(block, 0).to_bytes(2, "little")
    other = b"\x83\x10" + b"a" * 128
    assert write_frame(3, b"a" * 128) == other + zlib.crc32(other).to_bytes(4, "little")


def skim(data, limits=Limits()):  # noqa: B008
    return list(Skimmer(limits).receive(data))


def test_a_frame_too_long_is_refused_before_it_is_there():
    beginning = write_preamble() + write_varint((1 << 28) + 1 << 4 | 3)
    with pytest.raises(LimitError):
        skim(beginning)
    assert skim(beginning, Limits(frame_bytes=1 << 29)) == []


def test_preamble():
    assert write_preamble() == b"\x89BSM\x10"
    assert not any(skim(b"\x89BSM\x10"[:end]) for end in range(6))
    with pytest.raises(FormatError):
        skim(b"\x89BX")
    with pytest.raises(UnsupportedError, match=r"version 0 of the format.* encode the source again"):
        skim(b"\x89BSM\x00")
    with pytest.raises(UnsupportedError, match="version 2 of the format, and this reads 1: a later release"):
        skim(b"\x89BSM\x20")
