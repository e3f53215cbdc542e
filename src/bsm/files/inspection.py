"""Reports on streams, without decoding them."""

import base64
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from bsm._core import Decoder, SkimmedPacket
from bsm.bitstream.container.header import (
    BITS,
    LEVELS,
    OCTAHEDRAL,
    RECOMPUTED,
    TANGENTS,
    Header,
    MetadataValue,
    values_of,
)
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.attributes import DOMAINS, KINDS, SEMANTICS


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
    """An attribute: its declaration, number of values, and bytes including seams."""

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
    """The contents of a stream, known without decoding it; sizes in bytes."""

    header: Header
    metadata: dict[str, MetadataValue]
    coefficients: tuple[int, ...]
    gops: tuple[GopInfo, ...]
    attributes: tuple[AttributeInfo, ...]
    # Bytes by what they carry, "framing" nothing of all that; "total" is the whole.
    sizes: dict[str, int]
    # Bytes of positions by kind, see `KINDS_OF_POSITIONS`; they add up to "coefficients".
    positions: dict[str, int]
    runs: tuple[RunInfo, ...]
    checksum: int | None  # of decoded positions
    version: int
    brief: bool  # one frame is the whole stream

    @property
    def frames(self) -> int:
        return sum(gop.frames for gop in self.gops)

    @property
    def bpvf_total(self) -> float | None:
        """Bits of the whole stream per vertex and frame; None for a mesh."""
        samples = sum(run.vertices * run.frames for run in self.runs)
        if not samples:
            return None
        return 8 * self.sizes["total"] / samples

    @property
    def is_paper(self) -> bool:
        """Whether it has all that the preset "paper" sets; c may differ. Overlaps show in the sum of block sizes."""
        how, header = self.header.constants, self.header
        plain = not (header.key_interval or header.smoothing or header.refinement or header.grid)
        # Overlaps have no mark in a header. They make the blocks' sizes sum up to more than the vertices, by 15 % or
        # more with the paper's overlap.
        grown = (
            self.sizes["partition"]
            and header.blocks * (header.block_size + 0.5) >= 1.15 * header.vertices
        )
        settings = (
            how.bits,
            how.exact,
            how.power,
            how.iterations,
            how.shift,
            how.springs,
            header.onorm,
        )
        return (
            plain
            and settings == (12, 1, 2, 1, 2.0**-7, 0, 2)
            and (header.blocks == 1 or bool(grown))
        )

    def bpv(self, carried: str = "total") -> float:
        return 8 * self.sizes[carried] / self.header.vertices

    @property
    def bpv_paper(self) -> float:
        """3 q_c c k / n, the paper's measure: c k summed over blocks, q_c as declared or the average size."""
        bits, count = self.header.constants.bits, sum(self.coefficients)
        mean = 8 * self.sizes["coefficients"] / (3 * max(1, count))
        return 3 * (bits or mean) * count / self.header.vertices


POSITIONS = {
    FrameType.BLOCK: "blocks",
    FrameType.GRID: "grid",
    FrameType.GOP: "frames",
    FrameType.REFINEMENT: "levels_of_vertices",
}
LEVELS_OF_CELLS = "levels_of_cells"
KINDS_OF_POSITIONS = ("grid", "frames", "blocks", LEVELS_OF_CELLS, "levels_of_vertices")
"""Names of the kinds of positions. Cells have lower numbers than vertices, and no REFINEMENT has levels of both."""

_CARRIED = {
    FrameType.CONNECTIVITY: "connectivity",
    FrameType.PARTITION: "partition",
    FrameType.ORDER: "order",
    **dict.fromkeys(POSITIONS, "coefficients"),
}


class Skimmer:
    """Checks the packets of a stream that arrives in pieces without decoding them."""

    def __init__(self, limits: Limits = DEFAULT_LIMITS) -> None:
        self.engine = Decoder(limits)

    def receive(self, chunk: bytes | None) -> Iterator[SkimmedPacket]:
        """Take more bytes, or None at the end; yield the packets that are complete now."""
        if chunk is None:
            self.engine.finish()
        elif len(chunk):
            self.engine.push(np.frombuffer(chunk, np.uint8))
        while (section := self.engine.skim()) is not None:
            yield section

    @property
    def header(self) -> Header:
        """Header of the latest run."""
        return Header(**values_of(Header, self.engine.header()))


def inspect_stream(chunks: Iterable[bytes], limits: Limits = DEFAULT_LIMITS) -> StreamInfo:
    """Read a stream to its end, check every checksum, and count."""
    skimmer, headers = Skimmer(limits), list[Header]()
    runs, gops, coefficients = list[RunInfo](), list[GopInfo](), list[int]()
    sizes = dict.fromkeys((*dict.fromkeys(_CARRIED.values()), "attributes", "metadata"), 0)
    positions = dict.fromkeys(KINDS_OF_POSITIONS, 0)
    declared, lengths = list[SkimmedPacket](), Counter[int]()
    checksum: int | None = None
    total = entries = version = levels = 0
    brief = False
    for packet in chain.from_iterable(map(skimmer.receive, chain(chunks, (None,)))):
        total, version = packet.offset + packet.length, packet.version
        match packet.type:
            case FrameType.HEADER:
                # Asked for at once: the engine only holds the header of the latest run.
                headers.append(header := skimmer.header)
                mesh = header.run_number if header.mesh_of is None else header.mesh_of
                runs.append(
                    RunInfo(sum(gop.frames for gop in gops), 0, header.vertices, header.faces, mesh)
                )
            case FrameType.METADATA:
                entries = packet.entries
                sizes["metadata"] += packet.payload
            case FrameType.ATTRIBUTE:
                if len(runs) == 1:
                    declared.append(packet)
                lengths[packet.index] += packet.payload
            case FrameType.VALUES:
                lengths[packet.index] += packet.data
            case FrameType.END:
                checksum = None
                if packet.positions >= 0:
                    checksum = packet.positions
            case carried:
                brief |= packet.length == 0
                sizes[_CARRIED[FrameType(carried)]] += packet.data
                if carried in POSITIONS:
                    kind = POSITIONS[FrameType(carried)]
                    levels_of_cells, *_ = headers[0].base or (0,)
                    if carried == FrameType.REFINEMENT and levels < levels_of_cells:
                        kind = LEVELS_OF_CELLS
                    positions[kind] += packet.data
        if packet.type == FrameType.REFINEMENT:
            levels += packet.count
        if packet.type == FrameType.BLOCK:
            coefficients.append(packet.count)
        if packet.type == FrameType.GOP:
            runs[-1] = replace(runs[-1], frames=runs[-1].frames + packet.count)
            gops.append(GopInfo(packet.index, packet.count, packet.offset, packet.length))
    # At the end: a later packet may replace entries of an earlier one.
    metadata = dict(sorted(skimmer.engine.metadata(entry) for entry in range(entries)))
    attributes = tuple(_attribute_info(packet, lengths[packet.index]) for packet in declared)
    sizes["attributes"] = sum(attribute.bytes for attribute in attributes)
    sizes |= {"framing": total - sum(sizes.values()), "total": total}
    run_table: tuple[RunInfo, ...] = ()
    if headers[0].gop_frames:
        run_table = tuple(runs)
    return StreamInfo(
        headers[0],
        metadata,
        tuple(coefficients),
        tuple(gops),
        attributes,
        sizes,
        positions,
        run_table,
        checksum,
        version,
        brief,
    )


_CODINGS = {
    LEVELS: "levels",
    OCTAHEDRAL: "octahedral",
    BITS: "bits",
    RECOMPUTED: "recomputed",
    TANGENTS: "tangents",
}


def _attribute_info(packet: SkimmedPacket, size: int) -> AttributeInfo:
    coding = _CODINGS[packet.coding]
    if packet.moves:
        coding = "moving levels"
    meanings = DOMAINS[packet.domain], SEMANTICS[packet.semantic], KINDS[packet.kind]
    return AttributeInfo(
        packet.name, *meanings, packet.components, packet.rows, coding, packet.data, size
    )


def summarize_stream(info: StreamInfo) -> dict[str, Any]:
    """Return the facts of a stream, ready for JSON."""
    header, sizes = info.header, info.sizes
    extensions = {
        "order": sizes["order"] > 0,
        "light": header.light > 0,
        "congruence": header.congruence > 0,
        # A part of the law of its own: older drafts had none, and decoders may lack it.
        "whole": header.whole,  # vertices where images of others are take one decision
        "turn": any(header.turn),
        "base": bool(header.base),
        "swift": header.swift > 0,
        "repeats": header.repeats > 0,
        "brief": info.brief,
        "paper": bool(header.paper) or sizes["partition"] > 0,
        "attributes": header.attributes > 0,
        "sequence": bool(header.sequence),
    }
    preset: str | None = None
    if info.is_paper:
        preset = "paper"
    checksum: str | None = None
    if info.checksum is not None:
        checksum = f"{info.checksum:08x}"
    images = {name: value for name, value in info.metadata.items() if isinstance(value, bytes)}
    # JSON has no bytes.
    texts = {name: base64.b64encode(value).decode() for name, value in images.items()}
    return {
        "version": f"{info.version >> 4}.{info.version & 15}",
        "extensions": [name for name, used in extensions.items() if used],
        "preset": preset,
        "vertices": header.vertices,
        "faces": header.faces,
        "blocks": header.blocks,
        "block_size": header.block_size,
        "coefficients": list(info.coefficients),
        "bytes": info.sizes,
        "positions": info.positions,
        "checksum": checksum,
        "frames": info.frames,
        "gops": [asdict(gop) for gop in info.gops],
        "runs": [asdict(run) for run in info.runs],
        "attributes": [asdict(attribute) for attribute in info.attributes],
        "bpv_total": info.bpv(),
        "bpvf_total": info.bpvf_total,
        "bpv_geometry": info.bpv("coefficients"),
        "bpv_paper": info.bpv_paper,
        "header": {name: getattr(header, name) for name in header.__dataclass_fields__},
        "metadata": {**info.metadata, **texts},
        "metadata_bytes": {name: len(value) for name, value in images.items()},
    }
