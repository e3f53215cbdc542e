from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm.bitstream.container import wire
from bsm.bitstream.container.packets import Block, Connectivity, Damaged, End
from bsm.bitstream.container.reader import SCAN_BYTES, SCAN_FACTOR, Signal, TolerantReader
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.container.writer import write_stream
from bsm.bitstream.errors import BsmError
from tests.bitstream.streams import SMALL_HEADER, STATIC, STREAMS, encoded, frame_ends, read_all

KEYED = [replace(STATIC[0], key_interval=1), *STATIC[1:]]
"""Blocks of which none depends on another."""
LONG = [
    replace(SMALL_HEADER, key_interval=1),
    Connectivity(bytes(range(256)) * 8),
    *(Block(i, 5, bytes([i]) * 60) for i in range(3)),
]


def read(data: bytes, step: int | None = None) -> list:
    return read_all(data, step, TolerantReader())


@pytest.mark.parametrize("name", STREAMS)
@pytest.mark.parametrize("step", [None, 1])
def test_a_sound_stream_is_read_as_ever(name, step):
    assert read(encoded(name), step)[:-1] == STREAMS[name]


@pytest.mark.parametrize("step", [None, 1])
def test_a_damaged_block_is_lost_alone(step):
    data = bytearray(write_stream(KEYED))
    ends = frame_ends(bytes(data))
    data[ends[6] - 20] ^= 1
    packets = read(bytes(data), step)
    assert packets[:5] == KEYED[:5]
    damaged = packets[5]
    assert (damaged.type, damaged.offset, damaged.length) == (FrameType.BLOCK, ends[5], ends[6] - ends[5])
    assert "checksum" in damaged.reason
    assert packets[6:-1] == KEYED[6:]
    assert isinstance(packets[-1], End)


@pytest.mark.parametrize("interval", [0, 2])
@pytest.mark.parametrize("number", [0, 1, 2, 3])
@pytest.mark.parametrize("step", [None, 1])
def test_reading_goes_on_at_the_next_key_block(interval, number, step):
    header = replace(SMALL_HEADER, vertices=200, faces=390, blocks=4, key_interval=interval)
    stream = [header, Connectivity(b"faces"), *(Block(i, 5, bytes([i]) * 60) for i in range(4))]
    data = bytearray(write_stream(stream))
    data[frame_ends(bytes(data))[number + 3] - 5] ^= 1
    packets = read(bytes(data), step)
    behind = 4 if interval == 0 else 2 * (number // 2 + 1)
    assert packets[: 2 + number] == stream[: 2 + number]
    assert isinstance(packets[2 + number], Damaged)
    assert packets[3 + number : -1] == stream[2 + behind :]
    assert isinstance(packets[-1], End)


@pytest.mark.parametrize(
    ("name", "number", "behind"),
    [("grid", 3, 5), ("grid", 4, 5), ("refined", 2, 3), ("refined", 3, 5), ("animated", 2, 3)],
)
def test_what_depends_on_what_is_lost_is_not_read(name, number, behind):
    data = bytearray(encoded(name))
    data[frame_ends(bytes(data))[number + 1] - 5] ^= 1
    packets = read(bytes(data))
    assert isinstance(packets[number], Damaged)
    assert packets[:number] + packets[number + 1 : -1] == STREAMS[name][:number] + STREAMS[name][behind:]


def test_a_stream_cut_behind_its_blocks_has_them_all():
    data = encoded("refined")
    packets = read(data[: frame_ends(data)[3]])
    assert packets[:3] == STREAMS["refined"][:3]
    assert packets[3].type is FrameType.END


@pytest.mark.parametrize("number", range(1, len(KEYED)))
def test_a_frame_whose_length_is_wrong_costs_no_key_block_behind_it(number):
    data = bytearray(write_stream(KEYED))
    ends = frame_ends(bytes(data))
    data[ends[number]] ^= 0x30
    packets = read(bytes(data))
    behind = max(number + 1, 5)
    found = [packet for packet in packets[:-1] if not isinstance(packet, Damaged)]
    assert found == KEYED[:number] + KEYED[behind:]
    assert isinstance(packets[-1], End)


@pytest.mark.parametrize("step", [None, 1])
def test_a_length_that_is_wrong_and_ends_where_the_data_do_swallows_nothing(step):
    data = bytearray(write_stream(LONG))
    ends = frame_ends(bytes(data))
    for length in range(128, 1024):  # as many bytes of tag
        data[ends[2] : ends[2] + 2] = wire.write_varint(length << 4 | FrameType.BLOCK)
        tag = wire.parse_tag(data, ends[2])
        if tag is not None and tag.end == len(data):
            break
    else:
        raise AssertionError("no length ends there")
    packets = read(bytes(data), step)
    assert isinstance(packets[2], Damaged)
    assert packets[2].length == ends[3] - ends[2]
    assert packets[3:-1] == LONG[3:]
    assert isinstance(packets[-1], End)


def test_a_malformed_payload_is_lost_alone():
    sound = write_stream(LONG)
    ends = frame_ends(sound)
    illegal = wire.write_frame(6, b"\x01")  # a block without a number of coefficients
    packets = read(sound[: ends[3]] + illegal + sound[ends[4] :])
    assert packets[3] == Damaged(FrameType.BLOCK, ends[3], len(illegal), "payload ends inside a varint")
    assert packets[4] == LONG[4]


def test_a_missing_frame_shows_at_the_end():
    sound = write_stream(LONG)
    ends = frame_ends(sound)
    packets = read(sound[: ends[3]] + sound[ends[4] :])
    assert packets[:-1] == [*LONG[:3], LONG[4]]
    assert packets[-1].type is FrameType.END


@pytest.mark.parametrize("step", [None, 1])
def test_a_missing_end_and_a_torn_frame(step):
    sound = write_stream(LONG)
    ends = frame_ends(sound)
    packets = read(sound[: ends[-2]], step)
    assert packets[:-1] == LONG
    assert (packets[-1].type, packets[-1].length) == (FrameType.END, 0)
    packets = read(sound[: ends[4] + 20], step)
    assert packets[:-1] == LONG[:4]
    assert (packets[-1].type, packets[-1].offset, packets[-1].length) == (FrameType.BLOCK, ends[4], 20)


def test_trailing_bytes_are_damage():
    packets = read(encoded("bare") + b"more")
    assert isinstance(packets[-2], End)
    assert (packets[-1].offset, packets[-1].length) == (len(encoded("bare")), 4)


def test_a_damaged_header_is_fatal():
    data = encoded("static")
    for index in range(frame_ends(data)[1]):
        damaged = bytearray(data)
        damaged[index] ^= 0x55
        with pytest.raises(BsmError):
            read(bytes(damaged))


@pytest.mark.parametrize("step", [None, 1])
def test_every_changed_byte_behind_the_header_is_damage(step):
    data = write_stream(KEYED)
    for index in range(frame_ends(data)[1], len(data)):
        for mask in (0x01, 0x10, 0x80, 0xFF):
            damaged = bytearray(data)
            damaged[index] ^= mask
            assert check_cover(bytes(damaged), step) >= 4


@given(st.lists(st.tuples(st.integers(0, 10**6), st.binary(max_size=40)), max_size=5), st.integers(1, 50))
def test_anything_behind_the_header_is_packets_or_damage(cuts, step):
    data = write_stream(LONG)
    start = frame_ends(data)[1]
    for place, noise in cuts:
        at = start + place % (len(data) - start)
        data = data[:at] + noise + data[at + len(noise) // 2 :]
    check_cover(data, step)


def check_cover(data: bytes, step: int | None) -> int:
    """Frames and damage must lie one behind the other up to the end; the number of frames that are whole."""
    reader = TolerantReader()
    covered, whole = 5, 0
    step = step or len(data)
    for start in range(0, len(data) + step, step):
        if start < len(data):
            reader.receive_data(data[start : start + step])
        else:
            reader.receive_eof()
        while not isinstance(event := reader.next_packet(), Signal):
            assert reader.last_frame.offset == covered
            covered += reader.last_frame.length
            whole += not isinstance(event, Damaged)
    assert covered == len(data)
    return whole


def test_the_search_is_bounded(monkeypatch):
    # tags of frames that claim 100 kB each, one behind the other: without a bound 10 GB of checksums
    tag = wire.write_varint(100_000 << 4 | 3)
    data = encoded("bare")[: frame_ends(encoded("bare"))[1]]
    data += tag * 70_000
    summed = []
    honest = wire.checksum
    monkeypatch.setattr(wire, "checksum", lambda kind, part: summed.append(len(part)) or honest(kind, part))
    packets = read(data)
    assert isinstance(packets[-1], Damaged)
    assert sum(summed) <= 2 * (SCAN_BYTES + SCAN_FACTOR * len(data))
