"""A few mutants by the decoder of release 1.0 and by today's; `python -m tests.engine.mutants` takes any number."""

import pytest

import bsm
from tests.bitstream.streams import encoded, frame_ends
from tests.engine.decoding import released
from tests.engine.mutants import compare


def test_the_decoder_of_1_0_and_todays_agree_on_mutants() -> None:
    tally, found = compare(released(), 150, "test", tolerant=True)
    # Release 1.0 compares rows of attributes with the mesh before it decodes the section; the first error counts.
    assert not [text for text in found if "values where" not in text]
    assert tally["status 4"] > 50
    assert tally["status 0"] > 0


def test_a_length_that_cannot_be_is_over_a_limit_and_to_those_who_tolerate_damage_damage() -> None:
    stream = encoded("bare")
    header = frame_ends(stream)[1]
    broken = stream[:header] + b"\xff\xff\xff\xff\x7f" + stream[header:]
    for tolerant, error in ((False, bsm.LimitError), (True, bsm.CorruptError)):
        with bsm.Decoder(tolerant=tolerant) as decoder:
            decoder.receive_data(broken)
            decoder.receive_eof()
            with pytest.raises(error, match="frame_bytes"):
                while decoder.next_event() is not bsm.END_OF_STREAM:
                    pass
