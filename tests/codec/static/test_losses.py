import numpy as np
import pytest

from bsm.bitstream.container.packets import Block
from bsm.bitstream.container.reader import END_OF_STREAM, Reader, Signal
from bsm.bitstream.errors import BsmError, CorruptError
from bsm.codec.static.decoder import Decoder, decode
from bsm.codec.static.encoder import encode
from bsm.codec.static.events import BlockEvent, EndEvent, LossEvent
from bsm.codec.static.options import EncodeOptions, Paper
from tests.shapes import torus

SMALL = {"block_size": 100, "keep": 0.3, "step": 0.003}
KEY_INTERVAL = 4


def stream(**options):
    return encode(torus(48, 32), EncodeOptions(**{**SMALL, "key_interval": KEY_INTERVAL, **options}))


def spans(data):
    """Offset and length of each block's frame."""
    reader = Reader()
    reader.receive_data(data)
    found = {}
    while not isinstance(packet := reader.next_packet(), Signal):
        if isinstance(packet, Block):
            found[packet.index] = (reader.last_frame.offset, reader.last_frame.length)
    return found


def recover(data):
    with Decoder(tolerant=True) as decoder:
        decoder.receive_data(data)
        decoder.receive_eof()
        events = []
        while (event := decoder.next_event()) is not END_OF_STREAM:
            events.append(event)
    return events


def damaged(data, index, how):
    offset, length = spans(data)[index]
    if how == "removed":
        return data[:offset] + data[offset + length :]
    broken = bytearray(data)
    broken[offset + length // 2] ^= 0xFF
    return bytes(broken)


def lost_blocks(events):
    return sorted({event.block for event in events if isinstance(event, LossEvent) and event.block is not None})


@pytest.mark.parametrize("how", ["removed", "changed"])
@pytest.mark.parametrize("index", [0, 1, 5, 6, 7, 14])
def test_a_lost_block_costs_its_chain_at_the_most(index, how):
    data = stream()
    events = recover(damaged(data, index, how))
    chain_end = min((index // KEY_INTERVAL + 1) * KEY_INTERVAL, len(spans(data)))
    assert lost_blocks(events) == list(range(index, chain_end))
    assert isinstance(events[-1], EndEvent)


@pytest.mark.parametrize("smoothing", [0.0, 2.0])
def test_an_independent_stream_loses_the_block_alone_and_says_what_is_missing(smoothing):
    data = stream(key_interval=1, smoothing=smoothing)
    whole = decode(data).positions
    events = recover(damaged(data, 5, "changed"))
    assert lost_blocks(events) == [5]
    positions, final = np.full_like(whole, np.nan), np.zeros(len(whole), bool)
    for event in events:
        if isinstance(event, BlockEvent):
            positions[event.vertices] = event.positions
            final[event.vertices[event.final]] = True
    losses = events[-1].losses
    assert len(losses.missing) > 0 and np.isnan(positions[losses.missing]).all()
    sound = np.setdiff1d(np.arange(len(whole)), np.concatenate([losses.missing, losses.degraded]))
    assert np.array_equal(positions[sound], whole[sound])
    assert final[sound].all()
    assert np.isfinite(positions[losses.degraded]).all()


def test_a_strict_decoder_raises_on_what_a_tolerant_one_reports():
    data = stream()
    for how in ("removed", "changed"):
        with pytest.raises(CorruptError):
            decode(damaged(data, 6, how))


def test_a_stream_cut_short_gives_the_blocks_that_came():
    data = stream()
    offset, length = spans(data)[9]
    events = recover(data[: offset + length])
    assert [event.index for event in events if isinstance(event, BlockEvent)] == list(range(10))
    assert lost_blocks(events) == list(range(10, len(spans(data))))
    assert isinstance(events[-1], EndEvent) and len(events[-1].losses.missing) > 0


def test_a_whole_stream_loses_nothing():
    events = recover(stream())
    assert not any(isinstance(event, LossEvent) for event in events)
    assert len(events[-1].losses.missing) == len(events[-1].losses.degraded) == 0


def test_damage_before_the_first_block_is_raised():
    data = stream(paper=Paper(partition="metis"))
    first = spans(data)[0][0]
    for place in range(5, first, 11):
        broken = bytearray(data)
        broken[place] ^= 0x55
        with pytest.raises(BsmError):
            recover(bytes(broken))
