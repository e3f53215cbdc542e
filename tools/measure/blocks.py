"""Errors inside blocks, at their boundaries and along their chain: for the report on the paper, and for figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.basis.laplacian import Laplacian, laplacian_of
from bsm.codec.blocks.overlap import Blend, Block, Blocks, degree_weights, grow_blocks
from bsm.codec.blocks.partition import Partition, derive_partition
from bsm.codec.geometry.graph import Graph, graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.choice.plan import Planner
from bsm.codec.static.decoder import decode
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.joining import join
from bsm.codec.static.options import EncodeOptions, changed
from bsm.codec.static.preamble_encoding import Parts, prepare
from bsm.codec.static.ways.block_coder import encode_blocks
from bsm.evaluation.curve import paper_options
from bsm.evaluation.plots import draw_axes, new_figure, save_figure
from bsm.files.stream import StreamInfo, inspect_stream

Floats = npt.NDArray[np.float64]

Weighing = Callable[[Blocks, int, Block], Floats]
"""The weights, shape (n_i,), with which a block's copies count: from all blocks, its number, and itself."""


def only_its_own(blocks: Blocks, number: int, block: Block) -> Floats:
    """Only the copies in the block whose part they belong to."""
    return np.isin(block.vertices, blocks.core(number)).astype(np.float64)


def all_alike(blocks: Blocks, number: int, block: Block) -> Floats:
    """Every copy as much as any other."""
    return np.ones(block.size)


def by_degree(blocks: Blocks, number: int, block: Block) -> Floats:
    """Copies by their degree in the block, as the paper has it, and the codec."""
    return degree_weights(block.degrees)


OVERLAP_CASES: dict[str, tuple[dict[str, Any], Weighing]] = {
    "no overlap": ({"overlap": 1.0}, only_its_own),
    "simple average": ({}, all_alike),
    "weighted average": ({}, by_degree),
}
"""The three cases of the paper's box plot (section 6.1): options, and how copies of a vertex count."""


@dataclass(frozen=True, eq=False)
class BlockView:
    """A mesh coded with derived parts, its error, and the parts, all in the decoder's order of vertices."""

    error: Floats
    graph: Graph
    partition: Partition
    info: StreamInfo

    def blocks(self) -> Blocks:
        """The blocks in the order of the stream."""
        return grow_blocks(self.graph, self.partition, self.info.header.block_size)


def view_blocks(mesh: TriangleMesh, options: EncodeOptions) -> BlockView:
    """Encode a mesh in blocks and decode it, and derive its parts as both sides did."""
    step = options.step if options.says_how else options.first_step
    encoder = Encoder(mesh, changed(options, step=step, partition="derived", keep_order=False))
    data = encoder.encode()
    decoded = decode(data, NAMED_LIMITS[options.limits]())
    info = inspect_stream(iter([data]))
    graph = graph_of_faces(decoded.faces, len(decoded.positions))
    error = (decoded.positions - encoder.mesh.positions) / (encoder.mesh.diagonal or 1.0)
    return BlockView(error, graph, derive_partition(graph, info.header.blocks), info)


def boundary_deviations(view: BlockView) -> dict[str, Floats]:
    """Standard deviation of the error of each part's vertices, ``inside`` it and at its ``boundary``."""
    labels, parts = view.partition.labels, view.partition.parts
    tails = np.repeat(np.arange(view.graph.size), np.diff(view.graph.offsets))
    at_boundary = np.zeros(view.graph.size, dtype=bool)
    at_boundary[tails[labels[tails] != labels[view.graph.neighbours]]] = True
    return {
        name: _deviations(view.error[chosen], labels[chosen], parts)
        for name, chosen in (("inside", ~at_boundary), ("boundary", at_boundary))
    }


def boundary_table(mesh: TriangleMesh, options: EncodeOptions) -> dict[str, dict[str, Floats]]:
    """`boundary_deviations` for each of `OVERLAP_CASES`; smoothing is left out."""
    return {
        case: boundary_deviations(blend_blocks(mesh, replace(options, **changes), weigh))
        for case, (changes, weigh) in OVERLAP_CASES.items()
    }


def blend_blocks(mesh: TriangleMesh, options: EncodeOptions, weigh: Weighing) -> BlockView:
    """The error of a mesh whose blocks are coded as by `view_blocks`, and joined with other weights."""
    view = view_blocks(mesh, options)
    prepared = prepare(join(mesh, keep=False).mesh, Parts(options.block_size, options.overlap), keep_order=False)
    scheme = Planner(prepared, options).scheme(options.step or options.first_step)
    blocks, blend = view.blocks(), Blend(view.graph.size)
    for coded in encode_blocks(scheme, prepared.positions, threads=options.threads, doi=options.paper.doi):
        block = blocks.block(coded.decoded.index)
        blend.add(block.vertices, coded.decoded.positions, weigh(blocks, coded.decoded.index, block))
    return replace(view, error=blend.all_positions() - prepared.positions)


def quartiles(deviations: Floats) -> dict[str, float | None]:
    """``lower``, ``median`` and ``upper`` quartile over the blocks; None where there are no blocks to speak of."""
    if len(deviations) == 0:
        return {"lower": None, "median": None, "upper": None}
    return dict(zip(("lower", "median", "upper"), map(float, np.percentile(deviations, [25, 50, 75]))))


def errors_along_chain(view: BlockView) -> list[dict[str, float]]:
    """For each block in order: mean ``squared_error`` of its own part's vertices, and its ``coefficients`` c_i."""
    blocks = view.blocks()
    squared = np.square(view.error).sum(axis=1)
    return [
        {"squared_error": float(squared[blocks.core(index)].mean()), "coefficients": float(size)}
        for index, size in enumerate(view.info.coefficients)
    ]


def spread(rows: list[dict[str, float]]) -> float:
    """Standard deviation over mean of the blocks' errors (root mean square)."""
    errors = np.sqrt([row["squared_error"] for row in rows])
    return float(errors.std() / errors.mean())


def _deviations(error: Floats, labels: npt.NDArray[np.int32], parts: int) -> Floats:
    counts = np.bincount(labels, minlength=parts)
    present = counts > 0
    sums = np.stack([np.bincount(labels, error[:, axis], parts) for axis in range(3)], axis=1)
    means = sums[present] / counts[present, None]
    number = np.cumsum(present) - 1
    distance = np.square(error - means[number[labels]]).sum(axis=1)
    deviations: Floats = np.sqrt(np.bincount(labels, distance, parts)[present] / counts[present])
    return deviations


def block_size_for(mesh: TriangleMesh, blocks: int) -> int:
    """The option `block_size` that cuts a mesh into so many blocks."""
    return round(len(mesh.positions) / blocks)


def dynamic_comparison(mesh: TriangleMesh, block_size: int, keep: float = 0.10) -> dict[str, list[dict[str, float]]]:
    """Errors along the chain for a fixed size and for one that follows the error, at about the same rate."""
    settings: dict[str, Any] = {"block_size": block_size, "power": 2}
    fixed = errors_along_chain(view_blocks(mesh, paper_options(**settings, keep=keep)))
    wanted = sum(block["coefficients"] for block in fixed)
    low, high = 1e-4, 10.0
    dynamic = fixed
    for _ in range(12):
        middle = float(np.sqrt(low * high))
        options = paper_options(**settings, keep=min(1.0, 5 * keep), doi=(0.9 * middle, middle))
        dynamic = errors_along_chain(view_blocks(mesh, options))
        kept = sum(block["coefficients"] for block in dynamic)
        if abs(kept / wanted - 1) < 0.01:
            break
        low, high = (middle, high) if kept > wanted else (low, middle)
    return {"fixed": fixed, "dynamic": dynamic}


RowOrder = Callable[[Blocks, int], Laplacian]


def in_bisection_order(blocks: Blocks, index: int) -> Laplacian:
    """Laplacian of a block as the codec has it."""
    return laplacian_of(blocks.block(index))


def in_breadth_first_order(blocks: Blocks, index: int) -> Laplacian:
    """Laplacian of a block with its rows as growing found them: its part in mesh order, then ring after ring."""
    block = blocks.block(index)
    found = blocks.members_of(index)
    by_vertex = np.argsort(block.vertices)
    return permuted(laplacian_of(block), by_vertex[np.searchsorted(block.vertices, found, sorter=by_vertex)])


def permuted(laplacian: Laplacian, rows: npt.NDArray[np.integer]) -> Laplacian:
    """A Laplacian with its row `rows[r]` as row r."""
    block, fronts = laplacian.block, laplacian.fronts
    entries = np.ones(len(block.neighbours), np.int8)
    graph = csr_matrix((entries, block.neighbours, block.offsets), shape=(block.size, block.size))
    graph = graph[rows][:, rows]
    graph.sort_indices()
    other = Block(block.vertices[rows], graph.indptr.astype(np.int32), graph.indices.astype(np.int32))
    # The order of elimination is the same: fronts found from rows in another order than bisection's would be huge.
    places = np.argsort(rows).astype(np.uint32)
    return Laplacian(
        other,
        fronts._replace(rows=places[fronts.rows], steps=fronts.steps[rows].astype(np.uint32)),
        np.ones(len(other.neighbours)),
        laplacian.diagonal[rows],
    )


def draw_per_block(blocks: Mapping[str, Sequence[Mapping[str, float]]], stem: Path) -> list[Path]:
    """Squared error and coefficients of each block along the chain, one line per label: the paper's second figure."""

    figure = new_figure()
    upper, lower = figure.subplots(2, 1, sharex=True)
    for label, rows in blocks.items():
        upper.plot([row["squared_error"] for row in rows], lw=1, label=label)
        lower.step(range(len(rows)), [row["coefficients"] for row in rows], where="mid", lw=1, label=label)
    upper.set(yscale="log", ylabel="mean squared error")
    lower.set(xlabel="block", ylabel="coefficients kept")
    upper.legend(fontsize=7)
    return save_figure(figure, stem)


def draw_boxes(groups: Mapping[str, Mapping[str, npt.NDArray[np.float64]]], stem: Path) -> list[Path]:
    """Box plots of deviations: for each case one box per group of values (inside blocks, at their boundaries)."""

    def draw(axes: Any) -> None:
        names = [f"{case}\n{group}" for case, values in groups.items() for group in values]
        axes.boxplot([1e3 * v for values in groups.values() for v in values.values()], tick_labels=names)
        axes.tick_params(axis="x", labelsize=7)
        axes.set_ylabel("standard deviation of the error, thousandths of the diagonal")

    return draw_axes(draw, stem)
