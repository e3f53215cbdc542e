"""Bytes to packets, without input or output of its own: the caller brings the bytes as they come."""

import zlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, TypeAlias

import numpy.typing as npt

from bsm.bitstream.container.grammar import Grammar
from bsm.bitstream.container.packets import PARSERS, Damaged, End, Header, Metadata, Packet
from bsm.bitstream.container.wire import (
    PREAMBLE_BYTES,
    SKIPPABLE_TYPES,
    VERSION,
    Frame,
    FrameType,
    parse_frame,
    parse_preamble,
    parse_tag,
)
from bsm.bitstream.errors import (
    ArgumentError,
    BsmError,
    CorruptError,
    OptionError,
    TruncatedError,
    UnsupportedError,
    public,
)
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits, as_limits


@public
class Signal(Enum):
    """What `Reader.next_packet` returns where there is no packet.

    Examples
    --------
    >>> import bsm
    >>> with bsm.Decoder() as decoder:
    ...     decoder.next_event() is bsm.NEED_DATA
    True
    """

    NEED_DATA = "give more bytes to receive_data, or call receive_eof"
    END_OF_STREAM = "END was read and nothing follows"


FRAME_COST, BYTE_COST = 8e3, 8.0
"""Nanoseconds of a processor core for reading a frame, whatever it is, and for each of its bytes."""
METADATA_COST, ENTRY_COST = 2e4, 8e3  # the same for metadata besides, and for each of their entries


def reading_cost(size: int) -> float:
    return FRAME_COST + BYTE_COST * size


Buffer: TypeAlias = bytes | bytearray | memoryview | npt.NDArray[Any]
Spend: TypeAlias = Callable[[float, int], None]
"""Is told of work, and of the bytes that ask for it, and may refuse it by raising `LimitError`."""


def unpaid(work: float, received: int) -> None:
    """Who reads packets alone need not ask."""


NEED_DATA = Signal.NEED_DATA
END_OF_STREAM = Signal.END_OF_STREAM
Event: TypeAlias = Packet | Damaged | Signal


@dataclass(frozen=True)
class FrameSpan:
    """Where a frame lies in the stream: its number from 0, its first byte, and its bytes with tag and checksum."""

    number: int
    offset: int
    length: int


class Reader:
    """Strict: the first thing wrong is raised, and raised again by every later call."""

    def __init__(self, limits: Limits = DEFAULT_LIMITS, spend: Spend = unpaid) -> None:
        self.last_frame: FrameSpan | None = None
        self._limits = as_limits(limits)
        self._spend = spend
        self._buffer = bytearray()
        self._offset = 0  # of the buffer's first byte in the stream
        self._frames = 0
        self._crc = 0
        self.version = VERSION
        self._metadata_bytes = 0
        self._started = False
        self._eof = False
        self._grammar = self._fresh_grammar()
        self._error: BsmError | None = None

    def _fresh_grammar(self) -> Grammar:
        return Grammar()

    def receive_data(self, data: Buffer) -> None:
        """Take more bytes of the stream, any number of them."""
        given: Any = data
        try:
            view = memoryview(given)
        except (TypeError, ValueError):
            raise ArgumentError(f"bytes of a stream are expected, not {type(data).__name__}") from None
        if self._eof:
            raise OptionError("bytes were given to a reader after receive_eof")
        if self._error is None:
            with view:
                self._buffer += view if view.c_contiguous and view.nbytes == len(view) else view.tobytes()

    def receive_eof(self) -> None:
        """Take note that no more bytes will come."""
        self._eof = True

    def next_packet(self) -> Event:
        """The next packet, `NEED_DATA` if it is not complete, or `END_OF_STREAM` after END and `receive_eof`."""
        if self._error is not None:
            raise self._error
        try:
            return self._next()
        except BsmError as error:
            self._error = error.located(offset=self._offset, frame=self._frames if self._started else None)
            self._buffer = bytearray()
            raise

    def _next(self) -> Event:
        if not self._started and not self._start():
            return NEED_DATA
        while not self._grammar.ended:
            frame = parse_frame(self._buffer, 0, self._limits)
            if frame is None:
                return self._incomplete()
            self._spend(reading_cost(frame.size), frame.size)
            packet = self._parse(frame)
            if isinstance(packet, Metadata):
                self._spend(METADATA_COST + ENTRY_COST * len(packet.entries), 0)
            self._consume(frame, packet)
            if packet is not None:
                return packet
        if self._buffer:
            raise CorruptError("trailing bytes after END")
        return END_OF_STREAM if self._eof else NEED_DATA

    def _start(self) -> bool:
        preamble = bytes(self._buffer[:PREAMBLE_BYTES])
        if not parse_preamble(preamble):
            self._incomplete()
            return False
        self.version, self._crc = preamble[-1], zlib.crc32(preamble)
        self._drop(PREAMBLE_BYTES)
        self._started = True
        return True

    def _incomplete(self) -> Event:
        if self._eof:
            end = self._offset + len(self._buffer)
            raise TruncatedError("the stream ends before its END frame; get the rest of it", offset=end)
        return NEED_DATA

    def _parse(self, frame: Frame) -> Packet | None:
        """The packet in a frame, checked against everything before it; None for a frame to be skipped."""
        if frame.type in SKIPPABLE_TYPES:
            if self._grammar.header is None:
                raise CorruptError("the first frame must be HEADER")
            return None
        if frame.type not in PARSERS:
            raise UnsupportedError(f"frame type {frame.type} is unknown to this decoder")
        if not self._grammar.announces(frame.type):
            raise UnsupportedError(f"frame type {frame.type} is none that the header announces")
        packet = PARSERS[FrameType(frame.type)](frame.payload, self._limits)
        problem = self._grammar.problem(packet)
        if problem:
            raise CorruptError(problem)
        if isinstance(packet, Metadata):
            self._limits.check("metadata_bytes", self._metadata_bytes + len(frame.payload))
        if isinstance(packet, End):
            self._check_end(packet)
        return packet

    def _check_end(self, end: End) -> None:
        if end.frames != self._frames:
            raise CorruptError(f"END counts {end.frames} frames before it, there were {self._frames}")
        if end.crc != self._crc:
            raise CorruptError("the CRC-32 of the whole stream is wrong")

    def _consume(self, frame: Frame, packet: Packet | None) -> None:
        self.last_frame = FrameSpan(self._frames, self._offset, frame.size)
        if packet is not None:
            self._grammar.advance(packet)
        if isinstance(packet, Metadata):
            self._metadata_bytes += len(frame.payload)
        with memoryview(self._buffer) as view:
            self._crc = zlib.crc32(view[: frame.size], self._crc)
        self._frames += 1
        self._drop(frame.size)

    def _drop(self, count: int) -> None:
        del self._buffer[:count]  # a bytearray does this in amortised constant time
        self._offset += count


def read_packets(chunks: Iterable[bytes], reader: Reader) -> Iterator[Packet | Damaged]:
    """The packets of a stream that comes in `chunks`, each as soon as its bytes are there; raises as `reader` does."""
    for chunk in chunks:
        reader.receive_data(chunk)
        yield from _drain(reader)
    reader.receive_eof()
    yield from _drain(reader)


def _drain(reader: Reader) -> Iterator[Packet | Damaged]:
    while not isinstance(event := reader.next_packet(), Signal):
        yield event


SCAN_BYTES = 1 << 20
SCAN_FACTOR = 64
STRIDE = 4096  # places that are looked at before they are paid for again
PLACE_COST = 4e3
MAP_COST = 6e5  # nanoseconds of looking for a frame at one place, and of looking into one whose checksum is right


@dataclass
class _Damage:
    """Bytes that cannot be read, at the buffer's start, while what follows them is looked for."""

    reason: str
    type: FrameType | None
    ways: list[tuple[int, bool]]
    """Places from which to look, the last one first, and whether frames should stand there one behind the other."""
    place: int = 0
    sure: bool = True


class TolerantReader(Reader):
    """Returns a `Damaged` packet where a `Reader` raises, and goes on with what depends on nothing that is lost."""

    def __init__(self, limits: Limits = DEFAULT_LIMITS, spend: Spend = unpaid) -> None:
        super().__init__(limits, self._pay)
        self._payer = spend
        self._refused: BsmError | None = None
        self._damage: _Damage | None = None
        self._scan_work = 0
        self._lossy = False
        self._behind_damage = False

    def _next(self) -> Event:
        if self._behind_damage and self._grammar.ended:  # bytes behind END were told of
            self._drop(len(self._buffer))
            return END_OF_STREAM if self._eof else NEED_DATA
        if self._behind_damage and self._eof and not self._buffer:
            return END_OF_STREAM
        if self._damage is None:
            try:
                event = super()._next()
                self._behind_damage = self._behind_damage and event is NEED_DATA
                return event
            except BsmError as error:
                if self._grammar.header is None or error is self._refused:
                    raise
                self._damage = self._inspect(error)
        return self._recover(self._damage)

    def _pay(self, work: float, received: int) -> None:
        """Spend; what there is no more work for is no damage."""
        try:
            self._payer(work, received)
        except BsmError as error:
            self._refused = error
            raise

    def _fresh_grammar(self) -> Grammar:
        return Grammar(joining=True)

    def _consume(self, frame: Frame, packet: Packet | None) -> None:
        self._lossy = self._lossy or (
            self._grammar.header is None and isinstance(packet, Header) and packet.run_number > 0
        )
        super()._consume(frame, packet)

    def _parse(self, frame: Frame) -> Packet | None:
        packet = super()._parse(frame)
        return replace(packet, positions=None) if isinstance(packet, End) and self._lossy else packet

    def _check_end(self, end: End) -> None:
        if not self._lossy:
            super()._check_end(end)

    def _inspect(self, error: BsmError) -> _Damage:
        self._lossy = True
        self._grammar.lose()
        try:
            tag = parse_tag(self._buffer, 0)
        except BsmError:
            tag = None
        kind = FrameType(tag.type) if tag is not None and tag.type not in SKIPPABLE_TYPES else None
        by_its_length = [(tag.end, True)] if tag is not None and tag.end <= len(self._buffer) else []
        return _Damage(error.message, kind, [(1, False), *by_its_length])

    def _recover(self, damage: _Damage) -> Event:
        """Report the damage once it is known how far it reaches."""
        length = self._reach(damage)
        if length is None:
            return NEED_DATA
        self._damage = None
        self._behind_damage = True
        self.last_frame = FrameSpan(self._frames, self._offset, length)
        event = Damaged(damage.type if length else FrameType.END, self._offset, length, damage.reason)
        self._frames += 1
        self._drop(length)
        return event

    def _reach(self, damage: _Damage) -> int | None:
        """Bytes up to where reading goes on, or to the end of the data; None if more data must come first."""
        available = len(self._buffer)
        while not self._grammar.ended and (damage.ways or damage.place < available):
            if damage.place % STRIDE == 1:
                self._pay(PLACE_COST * STRIDE, STRIDE)
            step = self._step(damage.place, damage.sure)
            if step is None:
                return None
            if step == 0:
                return damage.place
            if step > 1:
                damage.place += step
                damage.ways.clear()
            else:
                damage.place, damage.sure = damage.ways.pop() if damage.ways else (damage.place + 1, False)
        return available if self._eof or self._grammar.ended else None

    def _step(self, place: int, sure: bool) -> int | None:
        """Bytes of the frame at `place`; 0: reading goes on there, 1: there is none, None: more data must come."""
        try:
            tag = parse_tag(self._buffer, place)
            if tag is not None:
                cost = tag.end - place
                budget = SCAN_BYTES + SCAN_FACTOR * (self._offset + len(self._buffer))
                if self._scan_work + cost > budget or not (sure or tag.type in self._grammar.expected):
                    return 1
                if tag.end <= len(self._buffer):
                    self._scan_work += cost
            frame = parse_frame(self._buffer, place, self._limits)
        except BsmError:
            return 1
        if frame is None:
            return 1 if self._eof else None
        if place > 0 and frame.type in self._grammar.expected:
            self._pay(MAP_COST + BYTE_COST * frame.size, 0)
            try:
                self._parse(frame)
                return 0
            except BsmError:
                pass
        return frame.size
