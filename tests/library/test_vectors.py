"""The decoder in C, compiled from one file, against all test vectors."""

import ctypes
from pathlib import Path

import pytest

import bsm
from bsm.bitstream.container.packets import Connectivity, Header
from tests.streams import events_of, frame_ends, write_stream
from tools.attack.library import compare
from tools.bsmdec import decode, of_sequence, released
from tools.vectors.store import Vector, read_manifest

STATUS = {"format": 3, "corrupt": 4, "unsupported": 5, "limit": 6, "numeric": 7, "truncated": 12}


@pytest.mark.parametrize("vector", read_manifest(), ids=lambda vector: vector.name)
def test_vector(library: ctypes.CDLL, vector: Vector) -> None:
    found = decode(library, Path(vector.stream).read_bytes())
    if found.status == STATUS["unsupported"] and vector.error != "unsupported":
        pytest.skip(found.message)
    assert found.status == STATUS.get(vector.error or "", 0), found.message
    if vector.error is None:
        arrays = of_sequence(found) if "-sequence" in vector.name else dict(found.arrays)
        complaint = vector.complaint(arrays.pop("positions"), arrays.pop("faces"), arrays)
        assert complaint is None, complaint


def test_the_decoder_of_1_0_and_todays_agree_on_mutants() -> None:
    tally, found = compare(released(), 150, "test")
    # Release 1.0 compares rows of attributes with the mesh before it decodes the section; the first error counts.
    # It does not know the fields that came with 1.1.
    assert not [
        text
        for text in found
        if "values where" not in text and "is unknown to this decoder" not in text
    ]
    assert tally["status 4"] > 50
    assert tally["status 0"] > 0


def test_a_length_that_cannot_be_is_over_a_limit_and_to_those_who_tolerate_damage_damage() -> None:
    stream = write_stream([Header(vertices=9, faces=9, grid=(1, 1, 1)), Connectivity(b"\0\x01")])
    header = frame_ends(stream)[1]
    broken = stream[:header] + b"\xff\xff\xff\xff\x7f" + stream[header:]
    for tolerant, error in ((False, bsm.LimitError), (True, bsm.CorruptError)):
        with pytest.raises(error, match="frame_bytes"):
            events_of(broken, tolerant=tolerant)
