import numpy as np
import pytest

from bsm import BlockEvent, BsmError, EncodeOptions, EndEvent, LossEvent, Paper, decode, encode
from bsm.bitstream.container.packets import Coefficients
from tests.shapes import torus
from tests.streams import events_of, packets_of, without

SMALL = {"block_size": 100, "keep": 0.3, "step": 0.003}
KEY_INTERVAL = 4


def stream(**options):
    return encode(
        torus(48, 32), EncodeOptions(**{**SMALL, "key_interval": KEY_INTERVAL, **options})
    )


def lost_blocks(events):
    return sorted(
        {
            event.block
            for event in events
            if isinstance(event, LossEvent) and event.block is not None
        }
    )


@pytest.mark.parametrize("how", ["removed", "changed"])
@pytest.mark.parametrize("index", [0, 1, 5, 6, 7, 14])
def test_a_lost_block_costs_its_chain_at_the_most(index, how):
    data = stream()
    events = events_of(without(data, Coefficients, index, how), tolerant=True)
    chain_end = min((index // KEY_INTERVAL + 1) * KEY_INTERVAL, len(packets_of(data, Coefficients)))
    assert lost_blocks(events) == list(range(index, chain_end))
    assert isinstance(events[-1], EndEvent)


@pytest.mark.parametrize("smoothing", [0.0, 2.0])
def test_an_independent_stream_loses_the_block_alone_and_says_what_is_missing(smoothing):
    data = stream(key_interval=1, smoothing=smoothing)
    whole = decode(data).positions
    events = events_of(without(data, Coefficients, 5, "changed"), tolerant=True)
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


def test_a_stream_cut_short_gives_the_blocks_that_came():
    data = stream()
    _, offset, length = packets_of(data, Coefficients)[9]
    events = events_of(data[: offset + length], tolerant=True)
    assert [event.index for event in events if isinstance(event, BlockEvent)] == list(range(10))
    assert lost_blocks(events) == list(range(10, len(packets_of(data, Coefficients))))
    assert isinstance(events[-1], EndEvent) and len(events[-1].losses.missing) > 0


def test_damage_before_the_first_block_is_raised():
    data = stream(paper=Paper(partition="metis"))
    first = packets_of(data, Coefficients)[0][1]
    for place in range(5, first, 11):
        broken = bytearray(data)
        broken[place] ^= 0x55
        with pytest.raises(BsmError):
            events_of(bytes(broken), tolerant=True)
