import binascii
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm import FormatError, LimitError, Limits, OptionError, UnsupportedError
from bsm.bitstream.container.gop import write_stretches
from bsm.bitstream.container.packets import (
    WRITERS,
    Coefficients,
    Connectivity,
    End,
    Gop,
    Labels,
    Metadata,
    Order,
    metadata_of,
)
from bsm.bitstream.container.wire import (
    MAX_VARINT,
    FrameType,
    write_frame,
    write_preamble,
    write_varint,
)
from bsm.files.inspection import Skimmer
from tools.payloads import parse_stretches
from tools.surgery import Cursor, parse_packet

CASES = [
    (Metadata({}), "80"),
    (
        Metadata({"b": 1, "a": 2.5, "c": b"\x00", "d": "x"}),
        "84a161ca40200000a16201a163c40100a164a178",
    ),
    (Connectivity(b"xyz"), "78797a"),
    (Labels(b""), ""),
    (Order(b"\x07"), "07"),
    (Coefficients(300, 58, b"abc"), "ac023a616263"),
    (Gop(2, b"abc"), "02616263"),
    (End(5, 0x12345678), "0578563412"),
]


def write(packet):
    return WRITERS[type(packet)][1](packet)


@pytest.mark.parametrize(("packet", "expected"), CASES)
def test_known_bytes(packet, expected):
    assert write(packet).hex() == expected
    assert parse_packet(WRITERS[type(packet)][0], bytes.fromhex(expected)) == packet


values = st.one_of(
    st.text(),
    st.binary(),
    st.integers(-(2**63), 2**64 - 1),
    st.floats(allow_nan=False, allow_infinity=False),
)


@given(st.dictionaries(st.text(), values, max_size=20))
def test_metadata_round_trip(entries):
    assert parse_packet(FrameType.METADATA, write(Metadata(entries))) == Metadata(entries)


@pytest.mark.parametrize(
    "entries",
    [
        {"a": None},
        {"a": True},
        {1: "a"},
        {"a": [1]},
        {"a": float("nan")},
        {"a": 2**64},
        {"a": "\ud800"},
    ],
)
def test_metadata_that_cannot_be_stored(entries):
    with pytest.raises(OptionError):
        write(Metadata(entries))


def test_metadata_of_numpy():
    assert Metadata({"a": np.float64(2), "b": np.int64(3)}) == Metadata({"a": 2.0, "b": 3})


def test_metadata_of_too_many_entries():
    many = {f"{i:03}": i for i in range(257)}
    packets = metadata_of(tuple(many.items()))
    assert [len(packet.entries) for packet in packets] == [256, 1]
    found = [parse_packet(FrameType.METADATA, write(packet)) for packet in packets]
    assert {name: value for packet in found for name, value in packet.entries.items()} == many


@given(st.lists(st.integers(0, 40), min_size=41, max_size=60))
def test_any_order_of_frames_comes_back(shown):
    cursor = Cursor(write_stretches(np.array(shown)) + b"rest")
    assert parse_stretches(cursor, len(shown)) == shown
    assert cursor.rest() == b"rest"


@pytest.mark.parametrize(
    ("shown", "coded"),
    [
        # 24 from 0 on, then 24 from 24 before the next.
        ([*range(24), *range(24)], b"\x02\x00\x18\x8d\x01\x18"),
        ([0, 0, 1, 1, 2, 2], b"\x03\x01\x02\x01\x02\x01\x02"),  # each is shown twice
        ([0, 1, 2, 3, 2, 1, 0], b"\x02\x00\x04\x0b\x03"),  # forward, then back
        ([0, 2, 1, 1], b"\x03\x00\x01\x08\x02\x03\x01"),
    ],
)
def test_known_stretches(shown, coded):
    assert write_stretches(np.array(shown)) == coded
    assert parse_stretches(Cursor(coded), len(shown)) == shown


def test_frames_in_order_are_one_byte():
    assert write_stretches(None) == b"\0"
    assert parse_stretches(Cursor(b"\0"), 3) == [0, 1, 2]


@pytest.mark.parametrize(
    ("value", "expected"),
    [(0, "00"), (1, "01"), (127, "7f"), (128, "8001"), (300, "ac02"), (2**35 - 1, "ffffffff7f")],
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
    for kind, payload, tag in (
        (6, b"abc", b"\x36"),
        (3, b"abc", b"\x33"),
        (3, b"a" * 127, b"\xf3\x0f"),
    ):
        frame = tag + payload
        assert write_frame(kind, payload) == frame + binascii.crc_hqx(frame, 0).to_bytes(
            2, "little"
        )
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
    with pytest.raises(
        UnsupportedError, match=r"version 0 of the format.* encode the source again"
    ):
        skim(b"\x89BSM\x00")
    with pytest.raises(
        UnsupportedError, match="version 2 of the format, and this reads 1: a later release"
    ):
        skim(b"\x89BSM\x20")
