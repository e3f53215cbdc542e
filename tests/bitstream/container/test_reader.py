import binascii
import itertools
import zlib
from dataclasses import replace

import numpy as np
import pytest

from bsm.bitstream.container import wire
from bsm.bitstream.container.header import Declaration
from bsm.bitstream.container.packets import (
    Attribute,
    Block,
    Connectivity,
    End,
    Gop,
    Grid,
    Metadata,
    Order,
    Partition,
    Refinement,
    Values,
    write_metadata,
)
from bsm.bitstream.container.reader import END_OF_STREAM, NEED_DATA, Reader, TolerantReader
from bsm.bitstream.container.wire import write_frame, write_preamble, write_varint
from bsm.bitstream.container.writer import Writer, write_stream
from bsm.bitstream.errors import (
    ArgumentError,
    BsmError,
    CorruptError,
    FormatError,
    LimitError,
    OptionError,
    TruncatedError,
    UnsupportedError,
)
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from tests.bitstream.streams import (
    ANIMATED,
    BARE,
    GRID,
    REFINED,
    SMALL_HEADER,
    STATIC,
    STREAMS,
    encoded,
    frame_ends,
    read_all,
)

names = pytest.mark.parametrize("name", STREAMS)


def stream_of(*frames: bytes) -> bytes:
    """A stream of the frames given, with a right END."""
    body = write_preamble() + b"".join(frames)
    return body + write_frame(15, write_varint(len(frames)) + zlib.crc32(body).to_bytes(4, "little"))


HEADER_FRAME = encoded("bare")[5 : frame_ends(encoded("bare"))[1]]
CONNECTIVITY_FRAME = write_frame(3, b"\x00\x01")


def test_known_bytes_of_a_whole_stream():
    header = bytes.fromhex("c10185016402ccbe0303043c050a")  # 12 bytes, type 1
    connectivity = bytes.fromhex("230001")  # two bytes, type 3
    body = b"\x89BSM\x10"
    body += header + binascii.crc_hqx(header, 0).to_bytes(2, "little")
    body += connectivity + binascii.crc_hqx(connectivity, 0).to_bytes(2, "little")
    end = b"\x5f\x02" + zlib.crc32(body).to_bytes(4, "little")  # five bytes, type 15
    assert encoded("bare") == body + end + binascii.crc_hqx(end, 0).to_bytes(2, "little")


@names
@pytest.mark.parametrize("step", [None, 1, 7])
def test_round_trip_however_it_is_cut(name, step):
    *packets, end = read_all(encoded(name), step)
    assert packets == STREAMS[name]
    assert end.frames == len(packets)


@names
@pytest.mark.parametrize("tail", [b"\x00", encoded("bare")])
def test_trailing_bytes(name, tail):
    data = encoded(name) + tail
    for step in (None, 1):
        with pytest.raises(CorruptError, match="trailing") as caught:
            read_all(data, step)
        assert caught.value.offset == len(encoded(name))


@names
def test_every_truncation(name):
    data = encoded(name)
    for end in range(len(data)):
        with pytest.raises(TruncatedError) as caught:
            read_all(data[:end])
        assert caught.value.offset == end


@names
def test_every_changed_byte(name):
    data = encoded(name)
    for index in range(len(data)):
        for mask in (0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80, 0xFF):
            damaged = bytearray(data)
            damaged[index] ^= mask
            with pytest.raises(BsmError) as caught:
                read_all(bytes(damaged))
            assert caught.value.offset is not None


@names
def test_every_missing_and_every_doubled_frame(name):
    data = encoded(name)
    ends = frame_ends(data)
    for start, end in itertools.pairwise(ends):
        for changed in (data[:start] + data[end:], data[:end] + data[start:]):
            with pytest.raises(BsmError):
                read_all(changed)


def test_packets_come_as_soon_as_their_bytes_are_there():
    data = encoded("static")
    ends = frame_ends(data)
    reader = Reader()
    for index in range(len(data)):
        assert reader.next_packet() is NEED_DATA
        reader.receive_data(data[index : index + 1])
        if index + 1 in ends[1:]:
            number = ends.index(index + 1) - 1
            packet = reader.next_packet()
            assert packet == STATIC[number] if number < len(STATIC) else isinstance(packet, End)
            assert reader.last_frame.number == number
            assert (reader.last_frame.offset, reader.last_frame.length) == (ends[number], index + 1 - ends[number])
    assert reader.next_packet() is NEED_DATA
    reader.receive_eof()
    assert reader.next_packet() is END_OF_STREAM
    assert reader.next_packet() is END_OF_STREAM


def test_byte_by_byte_every_byte_is_summed_a_bounded_number_of_times(monkeypatch):
    data = write_stream([*BARE, *(Block(index, 3, bytes(200)) for index in range(3))])
    summed = []
    honest = wire.checksum
    monkeypatch.setattr(wire, "checksum", lambda kind, part: summed.append(len(part)) or honest(kind, part))
    read_all(data, 1)
    assert sum(summed) < len(data)


def test_errors_are_sticky_and_say_where():
    data = bytearray(encoded("static"))
    ends = frame_ends(bytes(data))
    data[ends[6] + 2] ^= 1
    reader = Reader()
    reader.receive_data(data)
    for packet in STATIC[:6]:
        assert reader.next_packet() == packet
    for _ in range(2):
        with pytest.raises(CorruptError) as caught:
            reader.next_packet()
        assert (caught.value.offset, caught.value.frame) == (ends[6], 6)
        reader.receive_data(b"more")


def test_no_bytes_behind_eof():
    reader = Reader()
    reader.receive_eof()
    with pytest.raises(OptionError):
        reader.receive_data(b"x")


@pytest.mark.parametrize("data", [b"solid cube", b"ply\n", b"\x89PNG", b"\x00"])
def test_other_files(data):
    with pytest.raises(FormatError):
        read_all(data)


def test_other_versions():
    data = bytearray(encoded("bare"))
    data[4] = 1
    with pytest.raises(UnsupportedError) as caught:
        read_all(bytes(data))
    assert caught.value.offset == 4


@pytest.mark.parametrize("frame_type", [0, 12, 13, 14])
def test_unknown_frames_are_unsupported(frame_type):
    with pytest.raises(UnsupportedError, match=str(frame_type)):
        read_all(stream_of(HEADER_FRAME, write_frame(frame_type, b"?"), CONNECTIVITY_FRAME))


@pytest.mark.parametrize("frame_type", [8, 9, 10, 11])
def test_skippable_frames_are_skipped(frame_type):
    data = stream_of(HEADER_FRAME, write_frame(frame_type, b"?"), CONNECTIVITY_FRAME, write_frame(frame_type, b""))
    assert read_all(data)[:-1] == BARE


def test_the_header_comes_first():
    for first in (write_frame(8, b""), CONNECTIVITY_FRAME, write_frame(2, b"\x80")):
        with pytest.raises(BsmError):
            read_all(stream_of(first, HEADER_FRAME, CONNECTIVITY_FRAME))


def test_limits_apply_before_the_bytes_are_there():
    reader = Reader()
    reader.receive_data(write_preamble() + HEADER_FRAME + write_varint((2**31 - 1) << 4 | 3))
    assert reader.next_packet() == SMALL_HEADER
    with pytest.raises(LimitError) as caught:
        reader.next_packet()
    assert (caught.value.offset, caught.value.frame) == (5 + len(HEADER_FRAME), 1)


def test_limits_of_the_header():
    with pytest.raises(LimitError, match="vertices"):
        read_all(encoded("bare"), reader=Reader(replace(DEFAULT_LIMITS, vertices=99)))


HEADER, CONNECTIVITY, PARTITION, ORDER = SMALL_HEADER, Connectivity(b""), Partition(b""), Order(b"")
META, B0, B1, B2 = Metadata({}), Block(0, 1, b""), Block(1, 1, b""), Block(2, 1, b"")
COLOUR = Attribute(0, Declaration(name="colour", rows=100, largest=(255,)), b"")
COLOURS = Values(0, 0, 100, b"")
COLOURED = replace(SMALL_HEADER, attributes=1)
ILLEGAL = [
    [],
    [META],
    [HEADER],
    [HEADER, HEADER, CONNECTIVITY],
    [HEADER, B0],
    [HEADER, PARTITION, CONNECTIVITY],
    [HEADER, CONNECTIVITY, CONNECTIVITY],
    [HEADER, CONNECTIVITY, ORDER, PARTITION],
    [HEADER, CONNECTIVITY, PARTITION, PARTITION],
    [META, HEADER, CONNECTIVITY],
    [HEADER, Metadata({"a": 1}), CONNECTIVITY, B0, Metadata({"b": 1, "a": 2})],
    [HEADER, CONNECTIVITY, B0, PARTITION],
    [HEADER, CONNECTIVITY, B0, B0],
    [HEADER, CONNECTIVITY, B1, B0],
    [HEADER, CONNECTIVITY, Block(3, 1, b"")],
    [HEADER, CONNECTIVITY, Block(0, 11, b"")],
    [HEADER, CONNECTIVITY, Gop(0, b"")],
    [ANIMATED[0], CONNECTIVITY, Gop(0, b""), B0],
    [ANIMATED[0], CONNECTIVITY, Gop(50, b"")],
    [ANIMATED[0], CONNECTIVITY, Gop(3, b""), Gop(3, b"")],
    [GRID[0], CONNECTIVITY],
    [GRID[0], CONNECTIVITY, PARTITION, Grid(0, 100, b"")],
    [GRID[0], CONNECTIVITY, B0, Grid(0, 100, b"")],
    [GRID[0], CONNECTIVITY, Grid(0, 101, b"")],
    [GRID[0], CONNECTIVITY, Grid(0, 0, b""), Grid(0, 100, b"")],
    [GRID[0], CONNECTIVITY, Grid(0, 99, b"")],
    [GRID[0], CONNECTIVITY, Grid(1, 99, b"")],
    [GRID[0], CONNECTIVITY, Grid(0, 50, b""), Grid(51, 49, b"")],
    [GRID[0], CONNECTIVITY, Grid(0, 50, b""), Grid(49, 51, b"")],
    [REFINED[0], CONNECTIVITY, Refinement(0, 100, b""), B0],
    [REFINED[0], CONNECTIVITY, Refinement(0, 101, b"")],
    [REFINED[0], CONNECTIVITY, Refinement(1, 99, b"")],
    [REFINED[0], CONNECTIVITY, Refinement(0, 0, b"")],
    [REFINED[0], CONNECTIVITY, Refinement(0, 100, b""), Refinement(0, 100, b"")],
    [HEADER, CONNECTIVITY, B0, B1, CONNECTIVITY, B2],
    [COLOURED, CONNECTIVITY, B0, B1, COLOUR, B2, COLOURS],
    [COLOURED, CONNECTIVITY, B0, B1, B2],
    [COLOURED, CONNECTIVITY, COLOUR, B0, COLOURS, B1],
]
LEGAL = [
    [GRID[0], CONNECTIVITY, META, ORDER, Grid(0, 1, b""), Grid(1, 99, b"")],
    [REFINED[0], CONNECTIVITY, PARTITION, ORDER, B0, B1],
    [REFINED[0], CONNECTIVITY, B0, Refinement(0, 3, b"")],
    [REFINED[0], CONNECTIVITY, B0, Refinement(0, 3, b""), Refinement(3, 2, b"")],
    [REFINED[0], CONNECTIVITY, Refinement(0, 100, b"")],
    [HEADER, META, CONNECTIVITY, META, PARTITION, META, ORDER, META, B1, META, B2, META],
    [GRID[0], CONNECTIVITY, META, Grid(0, 100, b""), META],
    [COLOURED, CONNECTIVITY, META, COLOUR, B0, B1, B2, COLOURS],
]
UNANNOUNCED = [
    [HEADER, CONNECTIVITY, Grid(0, 100, b"")],
    [HEADER, CONNECTIVITY, B0, Refinement(0, 100, b"")],
    [GRID[0], CONNECTIVITY, Refinement(0, 100, b"")],
    [REFINED[0], CONNECTIVITY, Grid(0, 100, b"")],
]


def frames_of(packets) -> list[bytes]:
    from bsm.bitstream.container.packets import FRAME_TYPES, WRITERS

    return [write_frame(FRAME_TYPES[type(packet)], WRITERS[FRAME_TYPES[type(packet)]](packet)) for packet in packets]


@pytest.mark.parametrize("packets", ILLEGAL)
def test_both_sides_refuse_the_same_orders(packets):
    with pytest.raises(OptionError):
        write_stream(packets)
    with pytest.raises(CorruptError):
        read_all(stream_of(*frames_of(packets)))


@pytest.mark.parametrize("packets", LEGAL)
def test_both_sides_accept_the_same_orders(packets):
    assert read_all(write_stream(packets))[:-1] == packets


@pytest.mark.parametrize("packets", UNANNOUNCED)
def test_frames_that_the_header_does_not_announce_are_unsupported(packets):
    with pytest.raises(OptionError):
        write_stream(packets)
    with pytest.raises(UnsupportedError):
        read_all(stream_of(*frames_of(packets)))


def test_metadata_may_be_many_and_are_bounded_together():
    packets = [HEADER, Metadata({"a": 1}), CONNECTIVITY, PARTITION, ORDER, B0, Metadata({"b": 2})]
    data = stream_of(*frames_of(packets))
    assert read_all(data)[:-1] == packets
    size = len(write_metadata(Metadata({"a": 1})))
    assert read_all(data, reader=Reader(Limits(metadata_bytes=2 * size)))
    with pytest.raises(LimitError, match="metadata_bytes"):
        read_all(data, reader=Reader(Limits(metadata_bytes=2 * size - 1)))
    with pytest.raises(CorruptError, match="'a' again"):
        read_all(stream_of(*frames_of([*packets, Metadata({"c": 1, "a": 2})])))


def test_end_must_agree():
    body = write_preamble() + HEADER_FRAME + CONNECTIVITY_FRAME
    crc = zlib.crc32(body).to_bytes(4, "little")
    for end in (b"\x01" + crc, b"\x03" + crc, b"\x02" + bytes(4)):
        with pytest.raises(CorruptError):
            read_all(body + write_frame(15, end))


def test_writer_protocol():
    writer = Writer()
    with pytest.raises(OptionError):
        writer.write(SMALL_HEADER)
    with pytest.raises(OptionError):
        writer.end()
    writer.start()
    with pytest.raises(OptionError):
        writer.start()
    with pytest.raises(OptionError):
        writer.end()
    with pytest.raises(OptionError):
        writer.write(End(0, 0))
    for packet in BARE:
        writer.write(packet)
    writer.end()
    for late in (META, B0):
        with pytest.raises(OptionError):
            writer.write(late)


def test_writer_refuses_what_its_readers_would():
    for limits in (Limits(frame_bytes=5), Limits(vertices=99), Limits(metadata_bytes=3)):
        with pytest.raises(LimitError):
            write_stream([SMALL_HEADER, Metadata({"a": 5.5}), CONNECTIVITY], limits)


@pytest.mark.parametrize("wrong", ["text", 5, None, [1, 2], object(), np.array(["2001-01-01"], "M8[s]")])
def test_what_is_no_buffer_is_refused(wrong):
    with pytest.raises(ArgumentError, match="bytes of a stream"):
        Reader().receive_data(wrong)


def test_every_frame_is_paid_for():
    paid = []
    reader = Reader(spend=lambda work, received: paid.append((work, received)))
    stream = encoded("static")
    header = frame_ends(stream)[1]
    stream = stream[:header] + write_frame(8, b"") * 10 + stream[header:]
    reader.receive_data(stream)
    count = 0
    with pytest.raises(CorruptError, match="END counts"):
        while reader.next_packet() is not NEED_DATA:
            count += 1
    frames = [received for work, received in paid if received and work >= 8e3]
    assert len(frames) == count + 1 + 10
    assert sum(frames) == len(stream) - 5


@pytest.mark.parametrize("reader", [Reader, TolerantReader])
def test_work_that_is_refused_is_no_damage(reader):
    def refuse(work, received):
        raise LimitError("no more")

    given = reader(spend=refuse)
    given.receive_data(encoded("static"))
    for _ in range(2):
        with pytest.raises(LimitError, match="no more"):
            given.next_packet()
