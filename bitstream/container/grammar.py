"""Which packet may follow which, and what a packet must have to agree with the header; one table for both sides."""

from bsm.bitstream.container import packets
from bsm.bitstream.container.header import CORNER, RECOMPUTED, Declaration
from bsm.bitstream.container.wire import FrameType

_BODY = frozenset({FrameType.BLOCK, FrameType.GOP, FrameType.GRID, FrameType.REFINEMENT, FrameType.END})
_TAIL = frozenset({FrameType.VALUES, FrameType.END})

FOLLOWERS: dict[FrameType | None, frozenset[FrameType]] = {
    None: frozenset({FrameType.HEADER}),
    FrameType.HEADER: frozenset({FrameType.CONNECTIVITY}),
    FrameType.CONNECTIVITY: _BODY | {FrameType.PARTITION, FrameType.ORDER, FrameType.ATTRIBUTE},
    FrameType.PARTITION: _BODY | {FrameType.ORDER, FrameType.ATTRIBUTE},
    FrameType.ORDER: _BODY | {FrameType.ATTRIBUTE},
    FrameType.ATTRIBUTE: _BODY | {FrameType.ATTRIBUTE, FrameType.VALUES},
    FrameType.BLOCK: _TAIL | {FrameType.BLOCK, FrameType.GOP, FrameType.REFINEMENT},
    FrameType.GOP: frozenset({FrameType.GOP, FrameType.HEADER, FrameType.END}),
    FrameType.GRID: _TAIL | {FrameType.GRID},
    FrameType.REFINEMENT: _TAIL | {FrameType.REFINEMENT},
    FrameType.VALUES: _TAIL | {FrameType.GOP},
    FrameType.END: frozenset(),
}
"""What may follow a frame of each type (None: the preamble), METADATA and skippable frames left aside."""


RESUMING = _BODY | {FrameType.HEADER}
"""What reading may go on with behind damage (F 8.2), if it depends on nothing that is lost."""


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


ANNOUNCED: dict[int, str] = {
    FrameType.GRID: "grid",
    FrameType.REFINEMENT: "refinement",
    FrameType.ATTRIBUTE: "attributes",
    FrameType.VALUES: "attributes",
}
"""The field of the header that says whether frames of a type may come."""


class Grammar:
    """Follows a stream packet by packet; the writer and the reader both ask it."""

    def __init__(self, *, joining: bool = False) -> None:
        self.header: packets.Header | None = None
        self._joining = joining
        self._last: FrameType | None = None
        self._allowed = FOLLOWERS[None]
        self._resuming = False
        self._named: set[str] = set()  # names of metadata
        self._next_frame = 0
        self._begin_mesh()

    def _begin_mesh(self) -> None:
        """Forget what belongs to the mesh of one run."""
        self._next_block = 0
        self._next_vertex = 0  # of the grid, or of the layer
        self._declared: dict[int, Declaration] = {}
        self._valued = 0  # the attribute that values have come for last
        self._next_value = 0
        self._lossy = False

    @property
    def ended(self) -> bool:
        return self._last is FrameType.END

    @property
    def expected(self) -> frozenset[FrameType]:
        closed = self.header is None or self.ended or self._resuming
        return self._allowed if closed else self._allowed | {FrameType.METADATA}

    def announces(self, frame_type: int) -> bool:
        """Whether the header says that frames of this type may come; of those it need not announce, always."""
        if self.header is None or frame_type not in ANNOUNCED:
            return True
        return bool(getattr(self.header, ANNOUNCED[frame_type]))

    def problem(self, packet: packets.Packet) -> str | None:
        frame_type = packets.FRAME_TYPES[type(packet)]
        if frame_type not in self.expected:
            expected = ", ".join(item.name for item in sorted(self.expected)) or "nothing"
            return f"{frame_type.name} may not come here, only {expected}"
        return self._disagreement(packet)

    def advance(self, packet: packets.Packet) -> None:
        """Take note of a packet that has no problem."""
        frame_type = packets.FRAME_TYPES[type(packet)]
        if isinstance(packet, packets.Header):
            self._begin_mesh()
            self.header = packet
        if isinstance(packet, packets.Block):
            self._next_block = packet.index + 1
        if isinstance(packet, packets.Gop):
            self._next_frame = packet.index + 1
        if isinstance(packet, packets.Grid | packets.Refinement):
            self._next_vertex = packet.first + packet.count
        if isinstance(packet, packets.Attribute):
            self._declared[packet.index] = packet.declaration
        if isinstance(packet, packets.Values):
            self._valued, self._next_value = packet.attribute, packet.first + packet.count
        if isinstance(packet, packets.Metadata):
            self._named |= packet.entries.keys()
        else:
            self._last, self._resuming = frame_type, False
            begun = isinstance(packet, packets.Header) and packet.again is not None
            self._allowed = frozenset({FrameType.GOP}) if begun else FOLLOWERS[frame_type]

    def lose(self) -> None:
        """Take note that an unknown number of frames is missing here: what does not depend on them may come now."""
        self._allowed = _reachable(self._last) & RESUMING
        self._lossy = self._resuming = True

    def _disagreement(self, packet: packets.Packet) -> str | None:
        if self.header is None:
            late = isinstance(packet, packets.Header) and packet.run_number > 0 and not self._joining
            return "the stream begins within a sequence; a tolerant decoder joins it there" if late else None
        if isinstance(packet, packets.Header):
            return self._run_problem(self.header, packet)
        if isinstance(
            packet, packets.Block | packets.Gop | packets.Grid | packets.Values | packets.End
        ) and self._lacks_attributes(self.header):
            return f"{len(self._declared)} of {self.header.attributes} attributes are declared"
        match packet:
            case packets.Metadata() if again := sorted(self._named & packet.entries.keys()):
                return f"METADATA speaks of {again[0]!r} again"
            case packets.Attribute():
                return self._attribute_problem(self.header, packet)
            case packets.Values():
                return self._values_problem(packet)
            case packets.Block():
                return self._block_disagreement(self.header, packet)
            case packets.Gop():
                return self._gop_disagreement(self.header, packet)
            case packets.Grid() | packets.Refinement():
                return self._chunk_disagreement(self.header, packet, self._next_vertex)
            case packets.Partition() if self.header.grid:
                return "a PARTITION where there are no blocks"
            case packets.End() if not self._lossy:
                return self._missing_values() or self._missing_positions(self.header)
        return None

    def _missing_positions(self, header: packets.Header) -> str | None:
        short = header.grid and self._next_vertex < header.vertices
        return f"the positions end at vertex {self._next_vertex} of {header.vertices}" if short else None

    def _run_problem(self, before: packets.Header, header: packets.Header) -> str | None:
        """What keeps a run from following another."""
        if not (before.gop_frames and header.gop_frames):
            return "a second HEADER of a static mesh"
        number, following = header.run_number, before.run_number + 1
        if number < following or (number > following and not self._lossy):
            return f"run {number} where run {following} must follow"
        if header.frames != before.frames:
            return f"a run of a sequence of {header.frames} frames in one of {before.frames}"
        return None if self._lossy else self._missing_values()

    def _lacks_attributes(self, header: packets.Header) -> bool:
        return len(self._declared) < header.attributes and not self._lossy

    def _attribute_problem(self, header: packets.Header, attribute: packets.Attribute) -> str | None:
        index, declaration = attribute.index, attribute.declaration
        following = len(self._declared)
        if index != following or index >= header.attributes:
            return f"attribute {index} of {header.attributes}, where attribute {following} must follow"
        if declaration.name in {other.name for other in self._declared.values()}:
            return f"a second attribute is called {declaration.name!r}"
        if attribute.seams and (declaration.domain != CORNER or declaration.seams_of):
            return "seams of an attribute that has none of its own"
        if declaration.seams_of:
            shared = self._declared.get(declaration.seams_of - 1)
            if shared is None:
                return f"the seams of attribute {declaration.seams_of - 1}, which does not come before"
            if shared.domain != CORNER or shared.seams_of:
                return f"the seams of attribute {declaration.seams_of - 1}, which has none of its own"
        if declaration.leans and not header.grid:
            return "an attribute that leans on positions which are on no grid"
        if declaration.moves and not header.gop_frames:
            return "an attribute of one mesh that moves"
        if header.gop_frames and declaration.coding == RECOMPUTED:
            return "an attribute of a sequence that is recomputed from positions"
        return None

    def _values_problem(self, values: packets.Values) -> str | None:
        declared = self._declared.get(values.attribute)
        if declared is None:
            return f"values of attribute {values.attribute}, which is not declared"
        if values.attribute < self._valued:
            return f"values of attribute {values.attribute} come behind those of {self._valued}; they must ascend"
        following = self._next_value if values.attribute == self._valued else 0
        if values.first != following:
            return f"values from {values.first} on where those from {following} on must follow"
        if not 0 < values.count <= declared.rows - values.first:
            return f"{values.count} values from {values.first} on, of {declared.rows}"
        return self._missing_values(before=values.attribute) if values.attribute > self._valued else None

    def _missing_values(self, before: int | None = None) -> str | None:
        """What lacks of the values of the attributes, or of those before one."""
        for index, declared in self._declared.items():
            if before is not None and index >= before:
                break
            done = declared.rows if index < self._valued else self._next_value if index == self._valued else 0
            if done < declared.rows:
                return f"the values of attribute {index} end at {done} of {declared.rows}"
        return None

    def _block_disagreement(self, header: packets.Header, block: packets.Block) -> str | None:
        if block.index < self._next_block:
            return _not_ascending(block.index, self._next_block)
        if block.index >= header.blocks:
            return f"block {block.index} of {header.blocks}"
        if self._resuming and block.index % (header.key_interval or header.blocks):
            return f"block {block.index} depends on one that is lost"
        if block.coefficients > header.coefficients:
            return f"{block.coefficients} coefficients where the header allows {header.coefficients}"
        return None

    def _chunk_disagreement(
        self, header: packets.Header, chunk: packets.Grid | packets.Refinement, following: int
    ) -> str | None:
        if not self.announces(packets.FRAME_TYPES[type(chunk)]):
            return f"{packets.FRAME_TYPES[type(chunk)].name} in a stream whose header does not announce it"
        if chunk.first != following:
            return f"vertices from {chunk.first} on where those from {following} on must follow"
        if not 0 < chunk.count <= header.vertices - chunk.first:
            return f"{chunk.count} vertices from {chunk.first} on, of {header.vertices}"
        return None

    def _gop_disagreement(self, header: packets.Header, gop: packets.Gop) -> str | None:
        if gop.index < self._next_frame:
            return _not_ascending(gop.index, self._next_frame)
        if header.gop_frames == 0:
            return "a GOP in the stream of a static mesh"
        if 0 < header.frames <= gop.index:
            return f"a GOP from frame {gop.index} on, of {header.frames} frames"
        return None
