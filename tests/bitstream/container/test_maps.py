"""What is no map is refused; the decoder checks that maps are canonical."""

import pytest

from bsm.bitstream.container.packets import parse_metadata
from bsm.bitstream.container.wire import parse_map, write_map
from bsm.bitstream.errors import CorruptError

WRONG = {
    "arrays in an array": b"\x81\x01" + b"\x91" * 100_000 + b"\x01",
    "maps in maps": b"\x81\x01" * 100_000 + b"\x01",
    "a text that is longer than all": b"\x81\x01\xdb\xff\xff\xff\xff",
    "an array that is longer than all": b"\x81\x01\xdd\xff\xff\xff\xff",
    "an array": b"\x91\x01",
    "nothing": b"",
}


@pytest.mark.parametrize("payload", WRONG.values(), ids=WRONG)
def test_what_is_no_map_is_refused(payload):
    with pytest.raises(CorruptError):
        parse_map(payload)


def test_maps_come_back():
    assert parse_map(write_map([(1, [1] * 200), (2, "x")])) == [(1, [1] * 200), (2, "x")]


def test_metadata_that_is_none_is_refused():
    for payload in (b"\x81\x01\x01", b"\x81\x91\x01\x01", b"\x81\xa1a\x91\x01"):
        with pytest.raises(CorruptError):
            parse_metadata(payload)
