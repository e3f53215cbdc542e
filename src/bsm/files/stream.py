"""Streams from files and pipes: as they come, decoded in part or whole, and taken apart for a report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from bsm._engine import Decoder as Engine
from bsm.bitstream.container import packets
from bsm.bitstream.container.gop import frames_of_gop
from bsm.bitstream.container.packets import Header, write_attribute, write_metadata
from bsm.bitstream.container.scanner import FrameSpan, Scanner
from bsm.bitstream.container.wire import MAGIC
from bsm.bitstream.errors import BsmError, MeshError, OptionError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.pipes import Source, as_input, is_pipe

if TYPE_CHECKING:
    from bsm.decoding import Decoder
    from bsm.events import AttributeEvent

Progress = Callable[[int, int], None]


def is_stream(source: Source) -> bool:
    """Whether something begins like a stream; nothing is taken from an `Input`, and the path of a pipe is not asked."""
    return not is_pipe(source) and as_input(source).peek(len(MAGIC)) == MAGIC


@dataclass(frozen=True)
class GopInfo:
    first: int
    frames: int
    offset: int
    bytes: int


@dataclass(frozen=True)
class RunInfo:
    """A run of a sequence: its first frame, how many it has, its mesh, and the run that brought that."""

    first: int
    frames: int
    vertices: int
    faces: int
    mesh: int


@dataclass(frozen=True)
class AttributeInfo:
    """An attribute: what it is, how many values it has, and its bytes, seams among them."""

    name: str
    domain: str
    semantic: str
    kind: str
    components: int
    values: int
    coding: str
    seams: int
    bytes: int


@dataclass(frozen=True)
class StreamInfo:
    """What a stream consists of, known without decoding it; sizes in bytes."""

    header: packets.Header
    metadata: packets.Metadata
    coefficients: tuple[int, ...]
    gops: tuple[GopInfo, ...]
    attributes: tuple[AttributeInfo, ...]
    sizes: dict[str, int]  # bytes by what they carry, "framing" nothing of all that; "total" is the whole
    runs: tuple[RunInfo, ...]
    checksum: int | None  # of decoded positions
    version: int

    @property
    def frames(self) -> int:
        return sum(gop.frames for gop in self.gops)

    @property
    def bpvf_total(self) -> float | None:
        """Bits of the whole stream per vertex and frame; None for a mesh."""
        samples = sum(run.vertices * run.frames for run in self.runs)
        return 8 * self.sizes["total"] / samples if samples else None

    def bpv(self, carried: str = "total") -> float:
        return 8 * self.sizes[carried] / self.header.vertices

    @property
    def bpv_paper(self) -> float:
        """3 q_c c k / n, the paper's measure: c k as the sum over the blocks, n the vertices of the mesh; q_c is as
        declared for packed coefficients, and for others what they take on average."""
        bits, count = self.header.constants.bits, sum(self.coefficients)
        mean = 8 * self.sizes["coefficients"] / (3 * max(1, count))
        return 3 * (bits or mean) * count / self.header.vertices


_CARRIED: dict[type, str] = {
    packets.Connectivity: "connectivity",
    packets.Partition: "partition",
    packets.Order: "order",
    **dict.fromkeys((packets.Block, packets.Gop, packets.Grid, packets.Refinement), "coefficients"),
}


def inspect_stream(chunks: Iterator[bytes], limits: Limits = DEFAULT_LIMITS) -> StreamInfo:
    """Read a stream to its end, check every checksum, and count."""
    headers: list[packets.Header] = []
    metadata = packets.Metadata()
    runs: list[RunInfo] = []
    coefficients: list[int] = []
    gops: list[GopInfo] = []
    carried = (*dict.fromkeys(_CARRIED.values()), "attributes", "metadata")
    sizes = dict.fromkeys(carried, 0)
    declared: list[packets.Attribute] = []
    lengths: Counter[int] = Counter()
    checksum: int | None = None
    scanner = Scanner(limits)
    total = 0
    for packet, frame in _checked(chunks, limits, scanner):
        total = frame.offset + frame.length
        match packet:
            case packets.Header():
                headers.append(packet)
                mesh = packet.run_number if packet.again is None else packet.again
                runs.append(RunInfo(sum(gop.frames for gop in gops), 0, packet.vertices, packet.faces, mesh))
            case packets.Metadata(entries):
                metadata = packets.Metadata({**metadata.entries, **entries})
                sizes["metadata"] += len(write_metadata(packet))
            case packets.Attribute():
                declared += [packet] if len(runs) == 1 else []
                lengths[packet.index] += len(write_attribute(packet))
            case packets.Values():
                lengths[packet.attribute] += len(packet.data)
            case packets.End():
                checksum = packet.positions
            case _:
                sizes[_CARRIED[type(packet)]] += len(packet.data)
        if isinstance(packet, packets.Block):
            coefficients.append(packet.coefficients)
        if isinstance(packet, packets.Gop):
            frames = frames_of_gop(packet.data, headers[-1].gop_frames, headers[-1].run_number)
            runs[-1] = replace(runs[-1], frames=runs[-1].frames + frames)
            gops.append(GopInfo(packet.index, frames, frame.offset, frame.length))
    attributes = tuple(_attribute_info(packet, lengths[packet.index]) for packet in declared)
    sizes["attributes"] = sum(one.bytes for one in attributes)
    sizes |= {"framing": total - sum(sizes.values()), "total": total}
    numbers, known = tuple(coefficients), tuple(runs) if headers[0].gop_frames else ()
    return StreamInfo(headers[0], metadata, numbers, tuple(gops), attributes, sizes, known, checksum, scanner.version)


def _checked(chunks: Iterable[bytes], limits: Limits, scanner: Scanner) -> Iterator[tuple[packets.Packet, FrameSpan]]:
    """The packets of a stream that the decoder would accept, as far as that is known without decoding it."""
    checks = Engine(limits)
    for chunk in chunks:
        if len(chunk):
            checks.push(np.frombuffer(chunk, np.uint8))
            checks.skim()
            yield from scanner.receive(chunk)
    checks.finish()
    checks.skim()


def _attribute_info(packet: packets.Attribute, size: int) -> AttributeInfo:
    declared = packet.declaration
    return AttributeInfo(
        declared.name,
        ("vertex", "corner", "face")[declared.domain],
        ("generic", "color", "normal", "texcoord")[declared.semantic],
        ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")[declared.kind],
        declared.components,
        declared.rows,
        "moving levels" if declared.moves else ("levels", "octahedral", "bits", "recomputed")[declared.coding],
        len(packet.seams),
        size,
    )


def decode_whole(
    chunks: Iterator[bytes], limits: Limits = DEFAULT_LIMITS, threads: int | None = None, *, layers: int | None = None
) -> TriangleMesh:
    from bsm.decoding import Decoder

    with Decoder(limits, threads, layers=layers) as decoder:
        for chunk in chunks:
            decoder.receive_data(chunk)
        return decoder.finish()


def decode_blocks(
    chunks: Iterator[bytes], count: int, progress: Progress, limits: Limits = DEFAULT_LIMITS
) -> TriangleMesh:
    """Decode the first `count` blocks, read no further, and return the faces whose vertices have all arrived."""
    from bsm.decoding import Decoder
    from bsm.events import BlockEvent, EndEvent, HeaderEvent

    if count < 1:
        raise OptionError("at least one block must be decoded")
    wanted, done = count, 0

    def enough(event: Any) -> bool:
        nonlocal wanted, done
        if isinstance(event, HeaderEvent):
            wanted = count if event.header.grid else min(count, event.header.blocks)
        elif isinstance(event, BlockEvent):
            done += 1
            progress(done, wanted)
        return done == wanted or isinstance(event, EndEvent)

    return _decode_until(Decoder(limits), chunks, enough)


def decode_what_is_left(
    chunks: Iterator[bytes], report: Callable[[str], None], limits: Limits = DEFAULT_LIMITS
) -> TriangleMesh:
    """Decode every block of a damaged stream that does not depend on lost data; call `report` for each loss."""
    from bsm.decoding import Decoder
    from bsm.events import EndEvent, LossEvent

    def reported(event: Any) -> bool:
        match event:
            case LossEvent(_, error):
                report(f"lost: {error}")
            case EndEvent(losses) if len(losses.missing) or len(losses.degraded):
                report(f"{len(losses.missing)} vertices are missing, {len(losses.degraded)} less good than they were")
        return False

    return _decode_until(Decoder(limits, tolerant=True), chunks, reported)


def _decode_until(decoder: Decoder, chunks: Iterator[bytes], enough: Callable[[Any], bool]) -> TriangleMesh:
    """Decode until an event is enough, or to the end; the faces whose vertices have all arrived."""
    part = _Part()
    with decoder:
        for event in decoder.events(chunks):
            part.take(event)
            if enough(event):
                break
    return replace(part.mesh(), metadata=decoder.metadata)


class _Part:
    """What is known of a mesh while its blocks arrive."""

    def __init__(self) -> None:
        self._faces: npt.NDArray[np.int32] = np.empty((0, 3), np.int32)
        self._positions, self._known = np.empty((0, 3)), np.empty(0, np.bool_)
        self._values: dict[str, list[AttributeEvent]] = {}

    def take(self, event: Any) -> None:
        from bsm.events import AttributeEvent, BlockEvent, ConnectivityEvent, RefinementEvent

        match event:
            case ConnectivityEvent(faces, vertices):
                self._faces, self._positions, self._known = faces, np.zeros((vertices, 3)), np.zeros(vertices, np.bool_)
            case BlockEvent() | RefinementEvent():
                self._positions[event.vertices] = event.positions
                self._known[event.vertices] = True
            case AttributeEvent(name):
                self._values.setdefault(name, []).append(event)

    def mesh(self) -> TriangleMesh:
        """The faces whose vertices are known, with the attributes that have come as a whole."""
        complete = np.flatnonzero(self._known[self._faces].all(axis=1))
        if len(complete) == 0:
            raise MeshError("no face is complete in the blocks that are there")
        every_vertex = np.arange(len(self._positions))
        attributes = [
            found.taken(every_vertex, complete) for found in map(self._attribute, self._values.values()) if found
        ]
        return TriangleMesh(self._positions, self._faces[complete], tuple(attributes)).without_isolated_vertices()[0]

    def _attribute(self, events: list[AttributeEvent]) -> Attribute | None:
        """The attribute that events tell of, None if values of it are missing."""
        first = events[0]
        rows = np.concatenate([event.rows for event in events])
        sizes = {"vertex": len(self._positions), "face": len(self._faces)}
        size = sizes[first.domain] if first.indices is None else int(first.indices.max()) + 1
        if len(np.unique(rows)) < size:
            return None
        values = np.zeros((size, first.values.shape[1]), first.values.dtype)
        values[rows] = np.concatenate([event.values for event in events])
        return Attribute(first.name, values, first.domain, first.semantic, first.indices)


# ---------------------------------------------------------------------------------------------------------------- loops


_POINTS = 64
MOST_FRAMES = 4096  # not for longer sequences: each frame is compared with each


class Loops:
    """Remembers a few vertices of each frame, and tells which frames repeat others."""

    def __init__(self) -> None:
        self._kept: list[npt.NDArray[np.float64]] = []
        self._diagonal = 0.0

    def take(self, frame: Positions) -> None:
        if not self._kept:
            self._diagonal = float(np.linalg.norm(np.ptp(frame, axis=0)))
        if len(self._kept) <= MOST_FRAMES:
            rows = np.linspace(0, len(frame) - 1, min(_POINTS, len(frame))).astype(np.int64)
            self._kept.append(frame[rows].reshape(-1))

    def found(self, tolerance: float = 1e-4) -> tuple[range, int] | None:
        """The frames that repeat, and how many frames before them those are that they repeat."""
        count = len(self._kept)
        if not 4 <= count <= MOST_FRAMES or len({len(kept) for kept in self._kept}) > 1:
            return None  # or frames of other numbers of vertices
        table, near = np.array(self._kept), tolerance * self._diagonal
        if np.abs(table - table[0]).max() <= near:
            return None
        for period in range(2, count // 2 + 1):
            alike = np.abs(table[period:] - table[:-period]).max(axis=1) <= near
            edges = np.flatnonzero(np.diff(np.concatenate([[0], alike.astype(np.int8), [0]])))
            runs = [(end - start, -start) for start, end in zip(edges[::2].tolist(), edges[1::2].tolist())]
            length, start = max(runs, default=(0, 0))  # of the longest ones the first
            start = -start
            if length >= period and np.abs(table[start : start + period] - table[start]).max() > near:
                return range(start + period, start + period + length), period
        return None

    def said(self) -> tuple[str, ...]:
        found = self.found()
        if found is None:
            return ()
        frames, period = found
        first, last = frames.start, frames.stop - 1
        return (f"frames {first} to {last} repeat {first - period} to {first - 1}",)


# ------------------------------------------------------------------------------------------------------------ sequences


Note = Callable[[str], None]
MOST_SAID = 12


def peek_header(chunks: Iterator[bytes]) -> tuple[Header | None, Iterator[bytes]]:
    """The header of a stream, and all of its bytes again; None where the stream is too short or no stream at all."""
    taken: list[bytes] = []
    scanner = Scanner()
    for chunk in chunks:
        taken.append(chunk)
        try:
            packet, _ = next(scanner.receive(chunk), (None, None))
        except BsmError:  # whoever decodes it will say so
            break
        if packet is not None:
            return packet if isinstance(packet, Header) else None, chain(taken, chunks)
    return None, chain(taken, chunks)


class SequenceStream:
    """A stream that is decoded while its frames are asked for."""

    def __init__(
        self, chunks: Iterator[bytes], note: Note | None = None, start: int = 0, limits: Limits = DEFAULT_LIMITS
    ) -> None:
        from bsm.decoding import SequenceDecoder
        from bsm.events import ConnectivityEvent, HeaderEvent

        self.header: Header
        self.faces: Faces
        self.run_starts: list[int] = []
        self._note = note
        self._present: tuple[Attribute, ...] | None = None
        decoder = SequenceDecoder(limits, tolerant=note is not None, start=start)
        self._decoder = decoder
        self._events = decoder.events(chunks)
        for event in self._events:
            if isinstance(event, HeaderEvent):
                self.header = event.header
            elif isinstance(event, ConnectivityEvent):
                self.faces = event.faces
                return
        raise TruncatedError("the stream ends before its faces")

    @property
    def attributes(self) -> tuple[Attribute, ...]:
        """What the frame that was given last carries; before the first one, as far as they have come."""
        return self._decoder.attributes if self._present is None else self._present

    @property
    def metadata(self) -> Metadata:
        return self._decoder.metadata

    def frames(self) -> Iterator[tuple[int, Positions]]:
        """Number and positions, shape (n, 3), of one frame after the other."""
        for index, positions in self.changing_frames():
            if self.run_starts:
                raise MeshError(f"the faces change at frame {index}; only bsm decode and bsm compare take that")
            yield index, positions

    def changing_frames(self) -> Iterator[tuple[int, Positions]]:
        """Frames and their indices, where `faces` may change from frame to frame."""
        from bsm.events import FrameEvent, LossEvent

        given = False
        for event in self._events:
            match event:
                case FrameEvent(index, positions, faces, attributes):
                    self._present = attributes
                    if faces is not self.faces and not np.array_equal(faces, self.faces):
                        if given:
                            self.run_starts.append(index)
                        self.faces = faces
                    given = True
                    yield index, positions
                case LossEvent(_, error, frames):
                    assert self._note is not None
                    first, last = frames.start, frames.stop - 1
                    what = f"frame {first} is" if first == last else f"frames {first} to {last} are"
                    self._note(f"{what if frames else f'what follows frame {first} is'} lost: {error}")


def said_of_runs(starts: Sequence[int]) -> str:
    """In words, the frames before which faces change."""
    some = ", ".join(map(str, starts[:MOST_SAID]))
    rest = f" and {len(starts) - MOST_SAID} more" if len(starts) > MOST_SAID else ""
    return f"connectivity changes at frame{'s' if len(starts) > 1 else ''} {some}{rest}"


def numbered(faces: Faces, vertices: int) -> TriangleMesh:
    """A mesh whose positions are the numbers of its vertices: what reorders meshes then tells their order."""
    return TriangleMesh(np.repeat(np.arange(vertices, dtype=np.float64)[:, None], 3, axis=1), faces)


def numbers_of(positions: Positions) -> npt.NDArray[np.int64]:
    return positions[:, 0].astype(np.int64)


def decode_through(chunks: Iterator[bytes], limits: Limits = DEFAULT_LIMITS) -> int:
    """Decode a sequence to its end and keep nothing; the number of frames."""
    return sum(1 for _ in SequenceStream(chunks, limits=limits).changing_frames())


Pieces = list[tuple[Positions, Faces]]
"""Frames, shape (T, n, 3), and their faces, shape (m, 3), of one run after the other."""


def all_frames(stream: SequenceStream) -> Pieces:
    return pieces_of((frame, stream.faces) for _, frame in stream.changing_frames())


def pieces_of(frames: Iterable[tuple[Positions, Faces]]) -> Pieces:
    found: list[tuple[list[Positions], Faces]] = []
    for positions, faces in frames:
        same = found and len(found[-1][0][0]) == len(positions) and np.array_equal(found[-1][1], faces)
        if not same:
            found.append(([], faces))
        found[-1][0].append(positions)
    return [(np.array(positions), faces) for positions, faces in found]
