"""Streams taken apart for a report, without decoding them."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from bsm._engine import Decoder
from bsm.bitstream.container import packets
from bsm.bitstream.container.gop import frames_of_gop
from bsm.bitstream.container.packets import write_attribute, write_metadata
from bsm.bitstream.container.scanner import FrameSpan, Scanner
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits


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
                mesh = packet.run_number if packet.mesh_of is None else packet.mesh_of
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
    sizes["attributes"] = sum(attribute.bytes for attribute in attributes)
    sizes |= {"framing": total - sum(sizes.values()), "total": total}
    numbers, known = tuple(coefficients), tuple(runs) if headers[0].gop_frames else ()
    return StreamInfo(headers[0], metadata, numbers, tuple(gops), attributes, sizes, known, checksum, scanner.version)


def _checked(chunks: Iterable[bytes], limits: Limits, scanner: Scanner) -> Iterator[tuple[packets.Packet, FrameSpan]]:
    """The packets of a stream that the decoder would accept, as far as that is known without decoding it."""
    checks = Decoder(limits)
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
