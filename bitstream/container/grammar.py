"""Which packet may follow which, and what a packet must have to agree with the header; one table for both sides."""

from __future__ import annotations

from bitstream.container.layout import FRAME_TYPES
from bitstream.container.packets import Block, Gop, Header, Packet
from bitstream.container.wire import FrameType

_BODY = frozenset({FrameType.BLOCK, FrameType.GOP, FrameType.END})

FOLLOWERS: dict[FrameType | None, frozenset[FrameType]] = {
    None: frozenset({FrameType.HEADER}),
    FrameType.HEADER: frozenset({FrameType.CONNECTIVITY}),
    FrameType.CONNECTIVITY: _BODY | {FrameType.PARTITION, FrameType.ORDER},
    FrameType.PARTITION: _BODY | {FrameType.ORDER},
    FrameType.ORDER: _BODY,
    FrameType.BLOCK: frozenset({FrameType.BLOCK, FrameType.GOP, FrameType.END}),
    FrameType.GOP: frozenset({FrameType.GOP, FrameType.END}),
    FrameType.END: frozenset(),
}
"""What may follow a frame of each type (None: the preamble), METADATA and skippable frames left aside."""

METADATA_FOLLOWS: frozenset[FrameType | None] = frozenset(
    {FrameType.HEADER, FrameType.CONNECTIVITY, FrameType.PARTITION, FrameType.ORDER}
)


def _reachable(start: FrameType | None) -> frozenset[FrameType]:
    """Everything that may come at any distance behind a frame of type `start`."""
    found: set[FrameType] = set()
    pending = list(FOLLOWERS[start])
    while pending:
        current = pending.pop()
        if current not in found:
            found.add(current)
            pending.extend(FOLLOWERS[current])
    return frozenset(found)


class Grammar:
    """Follows a stream packet by packet; the writer and the reader both ask it."""

    def __init__(self) -> None:
        self.header: Header | None = None
        self._last: FrameType | None = None
        self._allowed = FOLLOWERS[None]
        self._metadata_seen = False
        self._next_block = 0
        self._next_frame = 0

    @property
    def ended(self) -> bool:
        """Whether END was there."""
        return self._last is FrameType.END

    @property
    def expected(self) -> frozenset[FrameType]:
        """The types of frame that may come next."""
        metadata = self._last in METADATA_FOLLOWS and not self._metadata_seen
        return self._allowed | {FrameType.METADATA} if metadata else self._allowed

    def problem(self, packet: Packet) -> str | None:
        """Why `packet` may not come here, or None if it may."""
        frame_type = FRAME_TYPES[type(packet)]
        if frame_type not in self.expected:
            expected = ", ".join(item.name for item in sorted(self.expected)) or "nothing"
            return f"{frame_type.name} may not come here, only {expected}"
        return self._disagreement(packet)

    def advance(self, packet: Packet) -> None:
        """Take note of a packet that has no problem."""
        frame_type = FRAME_TYPES[type(packet)]
        if isinstance(packet, Header):
            self.header = packet
        if isinstance(packet, Block):
            self._next_block = packet.index + 1
        if isinstance(packet, Gop):
            self._next_frame = packet.index + 1
        if frame_type is FrameType.METADATA:
            self._metadata_seen = True
        else:
            self._last = frame_type
            self._allowed = FOLLOWERS[frame_type]

    def lose(self) -> None:
        """Take note that an unknown number of frames is missing here: everything that can come later may come now."""
        self._allowed = _reachable(self._last)

    def _disagreement(self, packet: Packet) -> str | None:
        if self.header is None or not isinstance(packet, Block | Gop):
            return None
        following = self._next_frame if isinstance(packet, Gop) else self._next_block
        if packet.index < following:
            return f"index {packet.index} comes behind index {following - 1}; they must ascend"
        if isinstance(packet, Gop):
            return self._gop_disagreement(self.header, packet)
        if packet.index >= self.header.blocks:
            return f"block {packet.index} of {self.header.blocks}"
        if packet.coefficients > self.header.coefficients:
            return f"{packet.coefficients} coefficients where the header allows {self.header.coefficients}"
        return None

    def _gop_disagreement(self, header: Header, gop: Gop) -> str | None:
        if header.gop_frames == 0:
            return "a GOP in the stream of a static mesh"
        if 0 < header.frames <= gop.index:
            return f"a GOP from frame {gop.index} on, of {header.frames} frames"
        return None
