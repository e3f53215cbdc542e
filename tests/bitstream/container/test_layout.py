import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm import OptionError
from bsm.bitstream.container.packets import (
    WRITERS,
    Block,
    Connectivity,
    End,
    Gop,
    Metadata,
    Order,
    Partition,
    metadata_of,
)
from bsm.bitstream.container.wire import FrameType
from tools.surgery import parse_packet

CASES = [
    (Metadata({}), "80"),
    (Metadata({"b": 1, "a": 2.5, "c": b"\x00", "d": "x"}), "84a161ca40200000a16201a163c40100a164a178"),
    (Connectivity(b"xyz"), "78797a"),
    (Partition(b""), ""),
    (Order(b"\x07"), "07"),
    (Block(300, 58, b"abc"), "ac023a616263"),
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
    st.text(), st.binary(), st.integers(-(2**63), 2**64 - 1), st.floats(allow_nan=False, allow_infinity=False)
)


@given(st.dictionaries(st.text(), values, max_size=20))
def test_metadata_round_trip(entries):
    assert parse_packet(FrameType.METADATA, write(Metadata(entries))) == Metadata(entries)


@pytest.mark.parametrize(
    "entries", [{"a": None}, {"a": True}, {1: "a"}, {"a": [1]}, {"a": float("nan")}, {"a": 2**64}, {"a": "\ud800"}]
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
