"""Maps are looked through before anything is made of them."""

import tracemalloc

import pytest

from bsm.bitstream.container.packets import MOST_DECLARATION, MOST_HEADER, parse_attribute, parse_header
from bsm.bitstream.container.wire import parse_map, write_map, write_varint
from bsm.bitstream.errors import CorruptError
from bsm.bitstream.limits import DEFAULT_LIMITS

DEEP = b"\x91" * 400 + b"\x01"
BOMBS = {
    "arrays in an array": b"\x81\x01\xdc\x01\x00" + DEEP * 10_000,
    "maps in maps": b"\x81\x01" * 1_000_000 + b"\x01",
    "a long array": b"\x81\x01\xdd\x00\x40\x00\x00" + b"\x01" * (1 << 22),
    "a long map": b"\xdf\x00\x40\x00\x00" + b"\x01\x01" * (1 << 22),
    "many arrays": b"\xde\x01\x00" + b"".join(b"\xcc%c\xdc\x01\x00" % i + b"\x01" * 256 for i in range(128, 256)),
    "a text that is longer than all": b"\x81\x01\xdb\xff\xff\xff\xff",
    "nothing": b"",
}


@pytest.mark.parametrize("payload", BOMBS.values(), ids=BOMBS)
def test_what_is_nested_or_long_is_refused_before_it_is_made(payload):
    tracemalloc.start()
    try:
        with pytest.raises(CorruptError):
            parse_map(payload)
        assert tracemalloc.get_traced_memory()[1] < 100_000
    finally:
        tracemalloc.stop()


def test_all_arrays_of_a_map_have_256_entries_together():
    assert parse_map(write_map([(1, [1] * 200), (2, [1] * 56)])) == [(1, [1] * 200), (2, [1] * 56)]
    with pytest.raises(CorruptError, match="more than 256 entries"):
        parse_map(write_map([(1, [1] * 200), (2, [1] * 57)]))


def test_a_header_and_a_declaration_have_bounds_of_their_own():
    with pytest.raises(CorruptError, match="a header of 65537 bytes"):
        parse_header(bytes(MOST_HEADER + 1), DEFAULT_LIMITS)
    with pytest.raises(CorruptError, match="a declaration of"):
        parse_attribute(b"\0" + write_varint(MOST_DECLARATION + 1), DEFAULT_LIMITS)
