"""Which packet may follow which, and what a packet must have to agree with the header; one table for both sides."""

from __future__ import annotations

from bitstream.container.layout import FRAME_TYPES
from bitstream.container.packets import Block, End, Gop, Grid, Header, Packet, Partition, Refinement
from bitstream.container.wire import FrameType

_BODY = frozenset({FrameType.BLOCK, FrameType.GOP, FrameType.GRID, FrameType.REFINEMENT, FrameType.END})

FOLLOWERS: dict[FrameType | None, frozenset[FrameType]] = {
    None: frozenset({FrameType.HEADER}),
    FrameType.HEADER: frozenset({FrameType.CONNECTIVITY}),
    FrameType.CONNECTIVITY: _BODY | {FrameType.PARTITION, FrameType.ORDER},
    FrameType.PARTITION: _BODY | {FrameType.ORDER},
    FrameType.ORDER: _BODY,
    FrameType.BLOCK: frozenset({FrameType.BLOCK, FrameType.GOP, FrameType.REFINEMENT, FrameType.END}),
    FrameType.GOP: frozenset({FrameType.GOP, FrameType.END}),
    FrameType.GRID: frozenset({FrameType.GRID, FrameType.END}),
    FrameType.REFINEMENT: frozenset({FrameType.REFINEMENT, FrameType.END}),
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


def _not_ascending(index: int, following: int) -> str:
    return f"index {index} comes behind index {following - 1}; they must ascend"


class Grammar:
    """Follows a stream packet by packet; the writer and the reader both ask it."""

    def __init__(self) -> None:
        self.header: Header | None = None
        self._last: FrameType | None = None
        self._allowed = FOLLOWERS[None]
        self._metadata_seen = False
        self._next_block = 0
        self._next_frame = 0
        self._next_vertex = 0  # of the grid, or of the layer
        self._layer = 0
        self._lossy = False

    @property
    def ended(self) -> bool:
        """Whether END was there."""
        return self._last is FrameType.END

    @property
    def expected(self) -> frozenset[FrameType]:
        """The types of frame that may come next."""
        metadata = self._last in METADATA_FOLLOWS and not self._metadata_seen
        return self._allowed | {FrameType.METADATA} if metadata else self._allowed

    def announces(self, frame_type: int) -> bool:
        """Whether the header says that frames of this type may come; of those it need not announce, always."""
        announced: dict[int, bool] = {}
        if self.header is not None:
            announced = {
                FrameType.GRID: bool(self.header.grid),
                FrameType.REFINEMENT: bool(self.header.refinements),
            }
        return announced.get(frame_type, True)

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
        if isinstance(packet, Grid | Refinement):
            self._next_vertex = packet.first + packet.count
        if isinstance(packet, Refinement):
            self._layer = packet.layer
        if frame_type is FrameType.METADATA:
            self._metadata_seen = True
        else:
            self._last = frame_type
            self._allowed = FOLLOWERS[frame_type]

    def lose(self) -> None:
        """Take note that an unknown number of frames is missing here: everything that can come later may come now."""
        self._allowed = _reachable(self._last)
        self._lossy = True

    def _disagreement(self, packet: Packet) -> str | None:
        if self.header is None:
            return None
        match packet:
            case Block():
                return self._block_disagreement(self.header, packet)
            case Gop():
                return self._gop_disagreement(self.header, packet)
            case Grid():
                return self._chunk_disagreement(self.header, packet, self._next_vertex)
            case Refinement():
                return self._refinement_disagreement(self.header, packet)
            case Partition() if self.header.grid:
                return "a PARTITION where there are no blocks"
            case End() if self.header.grid and self._next_vertex < self.header.vertices and not self._lossy:
                return f"the positions end at vertex {self._next_vertex} of {self.header.vertices}"
        return None

    def _block_disagreement(self, header: Header, block: Block) -> str | None:
        if block.index < self._next_block:
            return _not_ascending(block.index, self._next_block)
        if block.index >= header.blocks:
            return f"block {block.index} of {header.blocks}"
        if block.coefficients > header.coefficients:
            return f"{block.coefficients} coefficients where the header allows {header.coefficients}"
        return None

    def _refinement_disagreement(self, header: Header, refinement: Refinement) -> str | None:
        layers = len(header.refinements) // 2
        if refinement.layer >= layers:
            return f"layer {refinement.layer} of {layers}"
        if refinement.layer < self._layer:
            return f"layer {refinement.layer} comes behind layer {self._layer}; they must ascend"
        following = self._next_vertex if refinement.layer == self._layer else 0
        return self._chunk_disagreement(header, refinement, following)

    def _chunk_disagreement(self, header: Header, chunk: Grid | Refinement, following: int) -> str | None:
        if not self.announces(FRAME_TYPES[type(chunk)]):
            return f"{FRAME_TYPES[type(chunk)].name} in a stream whose header does not announce it"
        if chunk.first < following or (chunk.first > following and not self._lossy):
            return f"vertices from {chunk.first} on where those from {following} on must follow"
        if not 0 < chunk.count <= header.vertices - chunk.first:
            return f"{chunk.count} vertices from {chunk.first} on, of {header.vertices}"
        return None

    def _gop_disagreement(self, header: Header, gop: Gop) -> str | None:
        if gop.index < self._next_frame:
            return _not_ascending(gop.index, self._next_frame)
        if header.gop_frames == 0:
            return "a GOP in the stream of a static mesh"
        if 0 < header.frames <= gop.index:
            return f"a GOP from frame {gop.index} on, of {header.frames} frames"
        return None
