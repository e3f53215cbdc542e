import binascii
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm.bitstream.container.wire import (
    MAX_VARINT,
    Cursor,
    parse_frame,
    parse_preamble,
    parse_varint,
    write_frame,
    write_preamble,
    write_varint,
)
from bsm.bitstream.errors import CorruptError, FormatError, LimitError, OptionError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits


@pytest.mark.parametrize(
    ("value", "expected"), [(0, "00"), (1, "01"), (127, "7f"), (128, "8001"), (300, "ac02"), (2**35 - 1, "ffffffff7f")]
)
def test_varint_known_bytes(value, expected):
    assert write_varint(value).hex() == expected
    assert parse_varint(bytes.fromhex(expected) + b"tail", 0) == (value, len(expected) // 2)


@given(st.integers(0, MAX_VARINT))
def test_varint_round_trip_and_truncation(value):
    data = write_varint(value)
    assert parse_varint(b"?" + data, 1) == (value, 1 + len(data))
    assert all(parse_varint(data[:end], 0) is None for end in range(len(data)))


@pytest.mark.parametrize("data", ["8000", "ff00", "808080808001", "ffffffffff"])
def test_varint_refuses_long_forms(data):
    with pytest.raises(CorruptError):
        parse_varint(bytes.fromhex(data), 0)


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


@given(st.integers(0, 15), st.binary(max_size=300))
def test_frame_round_trip_and_truncation(frame_type, payload):
    data = write_frame(frame_type, payload)
    frame = parse_frame(data + b"tail", 0, DEFAULT_LIMITS)
    assert frame is not None
    assert (frame.type, frame.payload, frame.size) == (frame_type, payload, len(data))
    assert all(parse_frame(data[:end], 0, DEFAULT_LIMITS) is None for end in range(len(data)))


def test_a_frame_too_long_is_refused_before_it_is_there():
    tag = write_varint((1 << 28) + 1 << 4 | 3)
    with pytest.raises(LimitError):
        parse_frame(tag, 0, DEFAULT_LIMITS)
    assert parse_frame(tag, 0, Limits(frame_bytes=1 << 29)) is None


def test_preamble():
    assert write_preamble() == b"\x89BSM\x10"
    assert parse_preamble(b"\x89BSM\x10more") and parse_preamble(b"\x89BSM\x1f")
    assert not any(parse_preamble(b"\x89BSM\x10"[:end]) for end in range(5))
    with pytest.raises(FormatError):
        parse_preamble(b"\x89BX")
    with pytest.raises(UnsupportedError, match=r"version 0 of the format.* encode the source again"):
        parse_preamble(b"\x89BSM\x00")
    with pytest.raises(UnsupportedError, match="version 2 of the format, and this reads 1: a later release"):
        parse_preamble(b"\x89BSM\x20")


def test_cursor_wants_neither_more_nor_less():
    cursor = Cursor(b"\x01\x80")
    assert cursor.varint() == 1
    with pytest.raises(CorruptError):
        cursor.varint()
    with pytest.raises(CorruptError):
        cursor.take(2)
    with pytest.raises(CorruptError):
        cursor.finish()
    assert cursor.rest() == b"\x80"
    cursor.finish()
