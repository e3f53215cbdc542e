"""A reader that goes on behind damage."""

from __future__ import annotations

from dataclasses import dataclass

from bsm.bitstream.container.grammar import Grammar
from bsm.bitstream.container.packets import Damaged, End, Header, Packet
from bsm.bitstream.container.reader import (
    BYTE_COST,
    END_OF_STREAM,
    NEED_DATA,
    Event,
    FrameSpan,
    Reader,
    Spend,
    unpaid,
)
from bsm.bitstream.container.wire import Frame, FrameType, Tag, parse_frame, parse_tag
from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

SCAN_BYTES = 1 << 20
SCAN_FACTOR = 64
STRIDE = 4096
"""Places that are looked at before they are paid for again."""
PLACE_COST = 4e3
MAP_COST = 6e5
"""Nanoseconds of looking for a frame at one place, and of looking into one whose checksum is right."""


@dataclass
class _Damage:
    """What is known of the damage at the buffer's start while its end is looked for."""

    reason: str
    tag: Tag | None
    whole: bool
    """Whether the checksum is right, and so the length in the tag too."""
    scanned: int = 0
    """Offset before which no frame begins; 0 while the length in the tag is not refuted."""


class TolerantReader(Reader):
    """Returns a `Damaged` packet where a `Reader` raises, and goes on with the next frame that is whole."""

    def __init__(self, limits: Limits = DEFAULT_LIMITS, spend: Spend = unpaid) -> None:
        super().__init__(limits, self._pay)
        self._payer = spend
        self._refused: BsmError | None = None
        self._damage: _Damage | None = None
        self._scan_work = 0
        self._lossy = False
        self._behind_damage = False

    def _next(self) -> Event:
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

    def _check_end(self, end: End) -> None:
        if not self._lossy:
            super()._check_end(end)

    def _inspect(self, error: BsmError) -> _Damage:
        self._lossy = True
        self._grammar.lose()
        try:
            tag = parse_tag(self._buffer, 0)
            whole = parse_frame(self._buffer, 0, self._limits) is not None
        except BsmError:
            tag, whole = _readable_tag(self._buffer), False
        return _Damage(error.message, tag, whole)

    def _recover(self, damage: _Damage) -> Event:
        """Report the damage once it is known how far it reaches."""
        length = self._reach(damage)
        if length is None:
            return NEED_DATA
        self._damage = None
        self._behind_damage = True
        self.last_frame = FrameSpan(self._frames, self._offset, length)
        seems = _frame_type(damage.tag) if length else FrameType.END
        event = Damaged(seems, self._offset, length, damage.reason)
        self._frames += 1
        self._drop(length)
        return event

    def _reach(self, damage: _Damage) -> int | None:
        """Bytes up to the next whole frame or the end of the data; None if more data must come first."""
        available = len(self._buffer)
        if self._grammar.ended:
            return available
        if damage.tag is not None and damage.tag.end <= available and damage.scanned == 0:
            if damage.whole:
                return damage.tag.end
            fits = self._fits(damage.tag.end)
            if fits or fits is None:
                return damage.tag.end if fits else None
        for start in range(max(damage.scanned, 1), available):
            if start % STRIDE == 1:
                self._pay(PLACE_COST * STRIDE, STRIDE)
            damage.scanned = start
            fits = self._fits(start)
            if fits or fits is None:
                return start if fits else None
        return available if self._eof else None

    def _fits(self, start: int) -> bool | None:
        """Whether a whole frame that may come here begins at `start`; None if more data must come first."""
        try:
            tag = parse_tag(self._buffer, start)
            if tag is not None:
                cost = tag.end - start
                budget = SCAN_BYTES + SCAN_FACTOR * (self._offset + len(self._buffer))
                if tag.type not in self._grammar.expected or self._scan_work + cost > budget:
                    return False
                if tag.end <= len(self._buffer):
                    self._scan_work += cost
            frame = parse_frame(self._buffer, start, self._limits)
            if frame is not None:
                self._pay(MAP_COST + BYTE_COST * frame.size, 0)
                self._parse(frame)
                return True
        except BsmError as error:
            if error is self._refused:
                raise
            return False
        return False if self._eof else None


def _readable_tag(data: bytearray) -> Tag | None:
    try:
        return parse_tag(data, 0)
    except BsmError:
        return None


def _frame_type(tag: Tag | None) -> FrameType | None:
    try:
        return None if tag is None else FrameType(tag.type)
    except ValueError:
        return None
