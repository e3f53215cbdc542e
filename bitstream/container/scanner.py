"""Bytes to packets, each checked alone: for reports and tools. The decoder (`engine/`) checks the stream as a whole."""

from collections.abc import Iterator
from dataclasses import dataclass

from bsm.bitstream.container.packets import PARSERS, End, Packet
from bsm.bitstream.container.wire import (
    PREAMBLE_BYTES,
    SKIPPABLE_TYPES,
    VERSION,
    FrameType,
    parse_frame,
    parse_preamble,
)
from bsm.bitstream.errors import BsmError, CorruptError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits


@dataclass(frozen=True)
class FrameSpan:
    """Where a frame lies in the stream: its number from 0, its first byte, and its bytes with tag and checksum."""

    number: int
    offset: int
    length: int


class Scanner:
    """Splits a stream that arrives in pieces into packets; what decoders skip is left out."""

    def __init__(self, limits: Limits = DEFAULT_LIMITS) -> None:
        self.version = VERSION
        self.ended = False
        self._limits = limits
        self._buffer = bytearray()
        self._offset = 0  # of the buffer's first byte in the stream
        self._frames = 0

    def receive(self, data: bytes) -> Iterator[tuple[Packet, FrameSpan]]:
        """Take more bytes, and give the packets that are complete now; what is no frame or packet is an error."""
        self._buffer += data
        try:
            yield from self._complete()
        except BsmError as error:
            raise error.located(offset=self._offset, frame=self._frames if self._offset else None) from None

    def _complete(self) -> Iterator[tuple[Packet, FrameSpan]]:
        if self._offset == 0:
            preamble = bytes(self._buffer[:PREAMBLE_BYTES])
            if not parse_preamble(preamble):
                return
            self.version = preamble[-1]
            self._drop(PREAMBLE_BYTES)
        while not self.ended and (frame := parse_frame(self._buffer, 0, self._limits)) is not None:
            span = FrameSpan(self._frames, self._offset, frame.size)
            if frame.type not in SKIPPABLE_TYPES:
                if frame.type not in PARSERS:
                    raise UnsupportedError(f"frame type {frame.type} is unknown")
                packet = PARSERS[FrameType(frame.type)](frame.payload)
                self.ended = isinstance(packet, End)
                yield packet, span
            self._frames += 1
            self._drop(frame.size)
        if self.ended and self._buffer:
            raise CorruptError("data after END")

    def _drop(self, count: int) -> None:
        del self._buffer[:count]  # a bytearray does this in amortised constant time
        self._offset += count
