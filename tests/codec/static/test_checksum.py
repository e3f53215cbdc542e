"""The checksum of decoded positions: who has them all compares it, who has not does without."""

from contextlib import suppress

import pytest

from bsm import (
    CorruptError,
    Decoder,
    EndEvent,
    FrameEvent,
    LossEvent,
    SequenceDecoder,
    decode,
    decode_frames,
)
from tests.streams import all_events
from tools.surgery import frames_of, stream_of
from tools.vectors.store import FOLDER

STATIC = (
    "chain",
    "ordered",
    "refined",
    "smoothing",
    "grid",
    "light",
    "exact",
    "attribute-recomputed",
)
SEQUENCES = "learnt", "low-delay", "runs", "moving-ordered"


def good(name):
    return (FOLDER / f"good-{name}.bsm").read_bytes()


def unlike(stream):
    """The stream with another checksum of positions."""
    return stream_of(frames_of(stream), positions=b"\xba\xdb\xad\x00")


def events_of(decoder, data):
    events = []
    with decoder, suppress(CorruptError):
        events.extend(all_events(decoder, [data]))
    return events


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        *((name, Decoder) for name in STATIC),
        *((f"sequence-{name}", SequenceDecoder) for name in SEQUENCES),
    ],
)
def test_other_positions_than_the_encoders_are_an_error(name, kind):
    data = unlike(good(name))
    with pytest.raises(CorruptError, match="encoder saw"):
        decode(data) if kind is Decoder else list(decode_frames(data))
    assert len(events_of(kind(), data)) == len(events_of(kind(), good(name))) - 1
    *_, loss, end = events_of(kind(tolerant=True), data)
    assert (
        isinstance(loss, LossEvent)
        and "encoder saw" in str(loss.error)
        and isinstance(end, EndEvent)
    )


@pytest.mark.parametrize("name", SEQUENCES)
def test_who_has_not_all_frames_does_without(name):
    later = events_of(SequenceDecoder(start=2), unlike(good(f"sequence-{name}")))
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
    assert not any(
        "encoder saw" in str(event.error) for event in events if isinstance(event, LossEvent)
    )


@pytest.mark.parametrize("name", STATIC)
def test_a_stream_may_do_without(name):
    decode(stream_of(frames_of(good(name))))
