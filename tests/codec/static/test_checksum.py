"""The checksum of decoded positions: who has them all compares it, who has not does without."""

import pytest

from bsm import END_OF_STREAM, CorruptError, Decoder, EndEvent, FrameEvent, LossEvent, SequenceDecoder, decode
from tools.surgery import frames_of, stream_of
from tools.vectors.store import FOLDER

STATIC = "chain", "ordered", "refined", "smoothing", "grid", "light", "exact", "attribute-recomputed"
SEQUENCES = "learnt", "low-delay", "runs", "moving-ordered"


def good(name):
    return (FOLDER / f"good-{name}.bsm").read_bytes()


def unlike(stream):
    """The stream with another checksum of positions."""
    return stream_of(frames_of(stream), positions=b"\xba\xdb\xad\x00")


def events_of(decoder, data):
    events = []
    with decoder:
        decoder.receive_data(data)
        decoder.receive_eof()
        try:
            while (event := decoder.next_event()) is not END_OF_STREAM:
                events.append(event)
        except CorruptError as error:
            events.append(error)
    return events


@pytest.mark.parametrize("name", STATIC)
def test_other_positions_than_the_encoders_are_an_error(name):
    data = unlike(good(name))
    with pytest.raises(CorruptError, match="encoder saw"):
        decode(data)
    *events, last = events_of(Decoder(), data)
    assert "encoder saw" in str(last) and len(events) == len(events_of(Decoder(), good(name))) - 1
    *_, loss, end = events_of(Decoder(tolerant=True), data)
    assert isinstance(loss, LossEvent) and "encoder saw" in str(loss.error) and isinstance(end, EndEvent)


@pytest.mark.parametrize("name", SEQUENCES)
def test_other_frames_than_the_encoders_are_an_error(name):
    data = unlike(good(f"sequence-{name}"))
    *events, last = events_of(SequenceDecoder(), data)
    assert "encoder saw" in str(last) and len(events) == len(events_of(SequenceDecoder(), good(f"sequence-{name}"))) - 1
    *_, loss, end = events_of(SequenceDecoder(tolerant=True), data)
    assert isinstance(loss, LossEvent) and "encoder saw" in str(loss.error) and isinstance(end, EndEvent)
    later = events_of(SequenceDecoder(start=2), data)
    assert isinstance(later[-1], EndEvent) and any(isinstance(event, FrameEvent) for event in later)


def test_a_part_of_it_is_decoded_without():
    data = unlike(good("refined"))
    with Decoder(layers=1) as decoder:
        decoder.receive_data(data)
        decoder.decode_rest()


def test_what_is_lost_is_reported_once():
    damaged = bytearray(unlike(good("refined")))
    damaged[-30] ^= 1  # in the layer
    events = events_of(Decoder(tolerant=True), bytes(damaged))
    assert [type(event) for event in events[-2:]] == [LossEvent, EndEvent]
    assert not any("encoder saw" in str(event.error) for event in events if isinstance(event, LossEvent))


@pytest.mark.parametrize("name", STATIC)
def test_a_stream_may_do_without(name):
    decode(stream_of(frames_of(good(name))))
