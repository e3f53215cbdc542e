"""What readers and decoders say of streams."""

import gc
import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from bsm import END_OF_STREAM, Decoder, FrameEvent, SequenceDecoder, Signal
from bsm.bitstream.container.packets import Packet, SectionWriter
from bsm.files.inspection import StreamInfo, inspect_stream
from tools.surgery import scan


def write_stream(packets: list[Packet]) -> bytes:
    """Return a whole stream: preamble, the packets given, END."""
    writer = SectionWriter()
    return b"".join([writer.start(), *(writer.write(packet) for packet in packets), writer.end()])


def info_of(data: bytes) -> StreamInfo:
    """What a stream says of itself, as `bsm info` reads it."""
    return inspect_stream(iter([data]))


def events_of(data: bytes, pieces: Sequence[bytes] | None = None, **options: Any) -> list[Any]:
    """Everything that a decoder says of a mesh, which comes in pieces."""
    with Decoder(**options) as decoder:
        return list(all_events(decoder, pieces or [data]))


def moving_events_of(
    data: bytes, pieces: Sequence[bytes] | None = None, **options: Any
) -> list[Any]:
    """Everything that a decoder says of a sequence, which comes in pieces."""
    with SequenceDecoder(**{"threads": 1, **options}) as decoder:
        return list(all_events(decoder, pieces or [data]))


def all_events(decoder: Decoder | SequenceDecoder, pieces: Sequence[bytes]) -> Iterator[Any]:
    """The events of a decoder, each as early as it can be had."""
    for piece in pieces:
        decoder.receive_data(piece)
        while not isinstance(event := decoder.next_event(), Signal):
            yield event
    decoder.receive_eof()
    while (event := decoder.next_event()) is not END_OF_STREAM:
        assert not isinstance(event, Signal)
        yield event


def frames_in(events: Sequence[Any]) -> dict[int, FrameEvent]:
    """Frames among events, by number."""
    return {event.index: event for event in events if isinstance(event, FrameEvent)}


def packets_of(data: bytes, kind: type = object) -> list[tuple[Any, int, int]]:
    """The packets of a kind in a stream, with offset and length of the frame of each."""
    return [
        (packet, span.offset, span.length)
        for packet, span in scan(data)
        if isinstance(packet, kind)
    ]


def frame_ends(data: bytes) -> list[int]:
    """Return where the preamble ends, and where each frame does, in bytes."""
    return [5, *(span.offset + span.length for _, span in scan(data))]


def without(data: bytes, packet: type, index: int, how: str) -> bytes:
    """A stream whose packet number `index` of a kind is "removed" or "changed"."""
    _, offset, length = packets_of(data, packet)[index]
    middle = offset + length // 2
    if how == "removed":
        return data[:offset] + data[offset + length :]
    return data[:middle] + bytes([data[middle] ^ 0xFF]) + data[middle + 1 :]


def peak_of(work: Callable[[], object]) -> int:
    """Most bytes held while `work` runs."""
    gc.collect()
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@contextmanager
def memory_below(most: float) -> Iterator[None]:
    """A block that holds fewer bytes than these at any time."""
    gc.collect()
    tracemalloc.start()
    try:
        yield
        assert tracemalloc.get_traced_memory()[1] < most
    finally:
        tracemalloc.stop()
