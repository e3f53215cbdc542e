"""Parts that are encoded one by one as they arrive (section 6.3), beside the whole mesh in overlapping blocks."""

import time
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.wire import FrameType
from bsm.codec.arrays import Positions
from bsm.codec.blocks.overlap import block_size, grow_blocks, metis_partition
from bsm.codec.denoise.coarse import OVERLAP
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import decibel
from bsm.evaluation.curve import Spectral, paper_options
from bsm.files.inspection import Skimmer, inspect_stream
from bsm.research import MARK, PartCoder
from tools.replicate.paper.models import Model, Study
from tools.replicate.paper.published import Line, printed
from tools.replicate.rates import Row

SEGMENTS = {"bunny": 70, "fandisk 0.3": 15}
COLUMNS = (
    *(
        "bpv of files",
        "bpv of coefficients",
        "s to the first",
        "kB to the first",
        "s",
        "NMSVE, averaged, dB",
    ),
    *("border over inside", "NMSVE, last copy, dB", "border over inside"),
)
Mask = npt.NDArray[np.bool_]


def cut(model: Model, segments: float) -> tuple[list[Mask], list[Mask]]:
    """Masks of the faces of METIS's parts, each face in one, and of the blocks that grow from these."""
    graph = graph_of_faces(model.faces, len(model.clean))
    partition = metis_partition(graph, model.segments(segments))
    blocks = grow_blocks(graph, partition, block_size(partition, OVERLAP))
    owner = partition.labels[model.faces].min(axis=1)
    grown = [
        np.asarray(np.isin(model.faces, blocks.members_of(k)).all(axis=1))
        for k in range(blocks.count)
    ]
    return [owner == part for part in range(partition.parts)], grown


def errors(model: Model, positions: Positions, border: Mask) -> tuple[float, float]:
    """NMSVE as printed, and the mean error of vertices on borders over that of others."""
    off = np.linalg.norm(positions - model.clean, axis=1)
    level = decibel(model.reference.nmsve(positions) * model.reference.scale)
    return level, float(off[border].mean() / off[~border].mean())


def whole(model: Model, segments: float, border: Mask) -> tuple[float, ...]:
    """The row of the preset."""
    codec, begin = Spectral(paper_options(block_size=model.block(segments))), time.thread_time()
    data, align = codec.encode(model.mesh)
    seconds, rate = time.thread_time() - begin, inspect_stream([data]).bpv_paper
    block = next(packet for packet in Skimmer().receive(data) if packet.type == FrameType.BLOCK)
    found, first = (
        errors(model, align(codec.decode(data)), border),
        1e-3 * (block.offset + block.length),
    )
    return 8 * len(data) / len(model.clean), rate, seconds, first, seconds, *found, *found


def one_by_one(model: Model, masks: Sequence[Mask], border: Mask) -> tuple[float, ...]:
    """The row of parts that arrive one by one."""
    encoder, coefficients, sums, last = (
        PartCoder(threads=1),
        0.0,
        np.zeros((len(model.clean), 4)),
        model.clean.copy(),
    )
    sizes, seconds = list[int](), list[float]()
    for mask in masks:
        used, corners = np.unique(model.faces[mask], return_inverse=True)
        faces, begin = corners.reshape(-1, 3).astype(np.int32), time.thread_time()
        data, decoded = encoder.encode(TriangleMesh(model.clean[used], faces))
        seconds.append(time.thread_time() - begin)
        sizes.append(len(data))
        coefficients += (
            inspect_stream([data.removeprefix(MARK)]).bpv_paper * len(used) / len(model.clean)
        )
        vertices = used[encode_connectivity(faces, len(used)).vertex_order]
        degrees = np.diff(graph_of_faces(decoded.faces, len(used)).offsets)[:, None]
        sums[vertices] += degrees * np.column_stack([decoded.positions, np.ones(len(used))])
        last[vertices] = decoded.positions
    means = errors(model, sums[:, :3] / sums[:, 3:], border)
    rates, times = (
        (8 * sum(sizes) / len(model.clean), coefficients),
        (seconds[0], 1e-3 * sizes[0], sum(seconds)),
    )
    return *rates, *times, *means, *errors(model, last, border)


def parts(study: Study) -> Iterator[Row]:
    """What parts that arrive one by one take and lose, beside the whole mesh."""
    rows, numbers, lost = list[Line](), dict[str, str](), 0
    for role, segments in SEGMENTS.items():
        model = study.model(role)
        apart, grown = cut(model, segments)
        copies = np.concatenate([np.unique(model.faces[mask]) for mask in apart])
        border = np.bincount(copies, minlength=len(model.clean)) > 1
        lost += int((~np.any(grown, axis=0)).sum())
        found = {
            "whole mesh": whole(model, segments, border),
            "parts": one_by_one(model, apart, border),
            "parts that overlap": one_by_one(model, grown, border),
        }
        rows += [
            (f"{model.name}, {len(apart)} blocks, {way}", own, ()) for way, own in found.items()
        ]
        for way, own in found.items():
            numbers |= {
                f"{role.split()[0]} {way} {at}": f"{value:.2f}" for at, value in enumerate(own)
            }
    yield printed(
        "The paper, 6.3: parts that arrive one by one",
        COLUMNS,
        rows,
        "By research.PartCoder, beside preset paper; seconds of one thread, with the check of the decoded result. "
        "Parts are those of METIS, each face in one, or overlap by 15 %, each face in all blocks that have its corners "
        f"({lost} faces: in none). The whole mesh sends all connectivity before its first block. Vertices on borders "
        "come once from each part. A receiver who knows which are the same may average them by degrees, as the whole "
        "mesh does; otherwise the last copy counts.",
        numbers=numbers,
    )
