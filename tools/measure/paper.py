"""The tables of the paper, measured again: `python -m tools.measure paper --meshes FOLDER`.

Arvanitis, Lalos, Moustakas, "Block-Based Spectral Processing of Static and Dynamic 3D Meshes using Orthogonal
Iterations". Beside each number, in parentheses, the one that the paper prints, with a star where the two differ by more
than is to be expected; then what the paper says in words, and whether it came out here.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property, partial
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
import scipy.linalg
from scipy.sparse import csr_matrix
from threadpoolctl import threadpool_limits

from bsm.bitstream.errors import OptionError
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.arrays import Faces, Positions
from bsm.codec.basis.laplacian import Laplacian, dense_laplacian, laplacian_of
from bsm.codec.blocks.overlap import (
    Blend,
    Block,
    Blocks,
    Partition,
    block_size,
    degree_weights,
    derive_partition,
    grow_blocks,
    metis_partition,
)
from bsm.codec.denoise import FINE_STEPS, denoise_automatically
from bsm.codec.denoise.coarse import BLOCK_SIZE, KEEP, OVERLAP, RULES, CoarseFilter
from bsm.codec.denoise.frames import GROUP, filter_frames
from bsm.codec.denoise.normals import GuidedFilter, guided_normal_filtering
from bsm.codec.denoise.surface import Topology
from bsm.codec.geometry.graph import Graph, graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference, decibel, theta
from bsm.codec.signal.chain import Chain, ChainRules, unheld
from bsm.codec.static.choice.blocks import Planner
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions, changed
from bsm.codec.static.preamble_encoding import Parts, join, prepare
from bsm.codec.static.ways.block_coder import encode_blocks
from bsm.console import Console, print_json
from bsm.decoding import decode
from bsm.evaluation.curve import PAPER_KEEPS, Curve, Spectral, paper_curves, paper_options, run_curve
from bsm.evaluation.sample import knot
from bsm.files.formats.npz import read_arrays
from bsm.files.inspection import StreamInfo, inspect_stream
from bsm.files.mesh import format_of_name, read_mesh
from tools.command import run_command
from tools.noise import gaussian_along_normals

Floats = npt.NDArray[np.float64]
Item = TypeVar("Item")
EXACT = replace(RULES, exact=True, key_interval=1)
"""The exact basis, which the paper computes by SVD where it does not say otherwise."""

# ------------------------------------------------------------------------------------------------- published numbers


@dataclass(frozen=True)
class Claim:
    """Something that the paper says in words, whether it came out here, and what was found."""

    says: str
    holds: bool
    found: str


Row = tuple[str, tuple[float, ...], tuple[float | None, ...]]
"""A label, our numbers, and those of the paper, as many as it prints."""


@dataclass(frozen=True)
class Table:
    """Rows of numbers; of each column, by how much of the paper's ours may differ, if they compare at all."""

    title: str
    columns: Mapping[str, float | None]
    rows: list[Row]
    remarks: tuple[str, ...] = ()
    claims: tuple[Claim, ...] = ()

    def pairs(self, row: Row) -> list[tuple[float, float | None, bool | None]]:
        """Our numbers, the paper's, and whether they agree."""
        _, ours, theirs = row
        found = []
        for number, other, most in zip(ours, (*theirs, *[None] * (len(ours) - len(theirs))), self.columns.values()):
            near = None if other is None or most is None else abs(number - other) <= most * abs(other)
            found.append((number, other, near))
        return found

    def score(self) -> tuple[int, int]:
        """How many numbers agree with the paper's, of how many."""
        agree = [pair[2] for row in self.rows for pair in self.pairs(row) if pair[2] is not None]
        return sum(agree), len(agree)

    def text(self) -> str:
        """Return the table in Markdown, and the text below it."""
        lines = [f"### {self.title}\n", "| | " + " | ".join(self.columns) + " |", "|---|" + "---:|" * len(self.columns)]
        for row in self.rows:
            cells = (
                f"{ours:.5g}" + (f" ({theirs:.5g})" if theirs is not None else "") + "*" * (agrees is False)
                for ours, theirs, agrees in self.pairs(row)
            )
            lines.append(f"| {row[0]} | " + " | ".join(cells) + " |")
        verdicts = (f"- {c.says} **{'Holds' if c.holds else 'Does not hold'}**: {c.found}" for c in self.claims)
        return "\n".join([*lines, "", *self.remarks, *verdicts, ""])


# ----------------------------------------------------------------------------------------------- the paper's numbers
OVERLAPS = (1.0, 1.05, 1.10, 1.15, 1.20, 1.25)
"""n_d over the largest segment."""

JULIO = {
    50: (
        (741, 778, 815, 852, 889, 926),
        (0.1229, 0.1207, 0.1188, 0.1172, 0.116, 0.1159),
        (0.1167, 0.1166, 0.1163, 0.116, 0.1159, 0.1158),
    ),
    70: (
        (532, 558, 585, 611, 638, 665),
        (0.1248, 0.1228, 0.1203, 0.1188, 0.1174, 0.1164),
        (0.1176, 0.1173, 0.1172, 0.1169, 0.1169, 0.1164),
    ),
    100: (
        (372, 390, 409, 427, 446, 465),
        (0.1276, 0.1248, 0.1228, 0.1208, 0.1184, 0.1175),
        (0.1189, 0.1187, 0.1185, 0.1183, 0.1174, 0.1168),
    ),
}
"""Section 6.3, by segments and, in the order of `OVERLAPS`, overlap: n_d, mean normal difference coarse, and fine."""

BUNNY = {
    25: (0.0921, 0.0915),
    40: (0.0931, 0.0925),
    50: (0.0941, 0.0934),
    70: (0.0960, 0.0952),
    100: (0.0988, 0.0980),
    200: (0.1039, 0.1028),
    500: (0.1163, 0.1150),
}
"""Section 6.2: mean normal difference by number of segments; simple, then weighted average."""

COHERENCE = {
    "armadillo": (0.0606, 13.9720, 10.0905, 1.2347, 37.4199),
    "fandisk": (15.6144, 1.4120, 11.1582, 8.4506, 29.8815),
    "sphere": (10.4615, 11.4700, 0.8857, 3.9065, 26.4125),
    "star": (1.3122, 8.5019, 3.919, 0.6095, 29.6996),
    "twelve": (37.8481, 30.2103, 26.6648, 30.0618, 4.5641),
}
"""Section 6.4: mean squared error between one matrix of a model (rows) and the mean of each (columns, same order)."""

TIMES = {
    "armadillo": {
        10: (-47.5668, -47.4145, 8.65, 0.40, 22),
        15: (-47.6641, -47.5263, 8.80, 0.53, 16),
        20: (-47.7428, -47.6195, 9.06, 0.65, 14),
        25: (-47.8301, -47.7097, 9.16, 0.80, 12),
    },
    "hand": {
        10: (-59.0354, -58.8521, 48.36, 0.54, 89),
        15: (-58.872, -58.7107, 48.85, 0.69, 70),
        20: (-58.6218, -58.489, 49.14, 1.05, 46),
        25: (-58.3314, -58.2215, 49.53, 1.31, 37),
    },
}
"""Section 8.2, by c in percent of n_d: NMSVE of SVD and OI in dB, seconds of both, speed-up.

The paper has a misprint, -475263, for OI at 15 % on the Armadillo.
"""

_POWERS = (*(f"R^{power}" for power in range(1, 10)), "SVD")
POWERS: dict[str, dict[str, tuple[float, float]]] = {
    "twelve": dict(
        zip(
            _POWERS,
            zip(
                (0.031, 0.049, 0.099, 0.114, 0.136, 0.142, 0.157, 0.184, 0.201, 0.901),
                (11.57, 10.26, 13.97, 13.84, 13.7, 13.59, 13.57, 13.55, 13.53, 9.83),
            ),
        )
    ),
    "fandisk": dict(
        zip(
            _POWERS,
            zip(
                (0.077, 0.11, 0.17, 0.202, 0.242, 0.297, 0.313, 0.355, 0.407, 1.953),
                (16.36, 14.75, 14.54, 14.54, 14.44, 14.5, 14.52, 14.84, 15.6, 14.56),
            ),
        )
    ),
}
"""Section 8.2: seconds and theta in degrees after the coarse step, by the power of R."""

# ------------------------------------------------------------------------------------------------------------- models


ROLES = {
    "bunny": ("bunny_34834", "bunny_34834_noisy", 0.2, 34_817),
    "julio": ("julius_36201", "julius_36201_noisy", 0.2, 36_201),
    "twelve": ("twelve_dodecahedron", "twelve_dodecahedron_noisy", 0.3, 0),
    "fandisk": ("fandisk_6475", "fandisk_0.7_noisy", 0.7, 0),
    "fandisk 0.3": ("fandisk_6475", "fandisk_0.3_noisy", 0.3, 0),
    "armadillo": ("armadillo_20002_derived", "", 0.2, 20_002),
    "hand": ("", "", 0.2, 327_323),
    "sphere": ("sharpsphere", "sharpsphere_noisy", 0.3, 0),
    "star": ("trim_star", "trim_star_noisy", 0.5, 0),
}
"""Of each model of the paper: our file, a noisy one or how strong the noise is, and the paper's vertices where known.

The authors' Armadillo is not published: another reduction of the same scan to as many vertices. Nor is the Hand: the
largest mesh of the folder takes its place, in blocks of the size that the Hand's had.
"""
MOVING = "samba"
SEGMENTS = {"armadillo": 20, "hand": 800}
"""The Armadillo's are the paper's; those of the Hand make n_d 470, of which the paper's c = 47 is a tenth."""


@dataclass(frozen=True, eq=False)
class Model:
    """A model as it is used; `vertices` are the paper's."""

    name: str
    clean: Positions
    noisy: Positions
    faces: Faces
    vertices: int

    @cached_property
    def reference(self) -> Reference:
        """The clean mesh, prepared for comparison."""
        return Reference(self.clean, self.faces)

    @property
    def mesh(self) -> TriangleMesh:
        """The clean mesh, without vertices that no face has."""
        return TriangleMesh(self.clean, self.faces).without_isolated_vertices()[0]

    def segments(self, paper: int) -> int:
        """As many segments as make segments of the paper's size, where the paper has `paper` of them."""
        return max(2, round(paper * len(self.clean) / (self.vertices or len(self.clean))))

    def block(self, paper: int) -> int:
        """Vertices of a segment before overlap, where the paper has `paper` of them."""
        return round(len(self.clean) / self.segments(paper))

    def coarse(self, segments: int, **how: Any) -> CoarseFilter:
        """The coarse step in as many segments as the paper has."""
        return CoarseFilter(self.faces, len(self.clean), block=self.block(segments), **how)

    def blocks(self, segments: int) -> Blocks:
        """The overlapping blocks that grow from the parts that METIS finds."""
        graph = graph_of_faces(self.faces, len(self.clean))
        partition = metis_partition(graph, self.segments(segments))
        return grow_blocks(graph, partition, block_size(partition, OVERLAP))


@dataclass(frozen=True, eq=False)
class Study:
    """Where tables get their models: of a folder, or generated; `quick` tries few settings on small ones."""

    folder: Path | None
    quick: bool
    note: Callable[[str], None]
    _models: dict[str, Model] = field(default_factory=dict, init=False)

    @property
    def repeats(self) -> int:
        """How many times what is timed runs."""
        return 1 if self.quick else 3

    def some(self, values: Iterable[Item]) -> list[Item]:
        """The values that are tried."""
        every = list(values)
        return [v for i, v in enumerate(every) if not self.quick or i % 4 == 0 or i == len(every) - 1]

    def model(self, role: str) -> Model:
        """The model that plays a role of the paper."""
        if role not in self._models:
            self._models[role] = self._made(role)
        return self._models[role]

    def _made(self, role: str) -> Model:
        file, noisy, sigma, vertices = ROLES[role]
        self.note(f"the model {role}")
        if self.folder is None:
            mesh = knot(min(vertices or 6000, 1200 if self.quick else 12_000), 1 + list(ROLES).index(role))
        else:
            file = file or max((p.stat().st_size, p.stem) for p in self._files("static", "*"))[1]
            mesh = read_mesh(self._files("static", f"{file}.*")[0]).mesh
        if self.folder is not None and noisy:
            moved = read_mesh(self._files("noisy", f"{noisy}.*")[0]).mesh.positions
        else:
            moved = gaussian_along_normals(mesh.positions, mesh.faces, sigma, seed=1)
        return Model(file if self.folder else f"generated {role}", mesh.positions, moved, mesh.faces, vertices)

    def _files(self, part: str, pattern: str) -> list[Path]:
        assert self.folder is not None
        found = [path for path in sorted((self.folder / part).glob(pattern)) if format_of_name(path)]
        if not found:
            raise OptionError(f"{self.folder / part} holds no mesh {pattern}")
        return found

    def sequence(self) -> tuple[str, Floats, Faces]:
        """A sequence's name, its frames, shape (T, n, 3), and its faces."""
        count = 12 if self.quick else 1000
        if self.folder is None:
            mesh = knot(1200 if self.quick else 9_971)
            stretch = 1.0 + 0.2 * np.sin(np.arange(min(48, count)) / 8.0)
            return "generated", mesh.positions * stretch[:, None, None], mesh.faces
        positions, faces = read_arrays(self.folder / "dynamic" / f"{MOVING}.npz", "positions", "faces")
        return MOVING, positions[:count].astype(np.float64), faces.astype(np.int32)


def fastest(work: Callable[[], object], repeats: int) -> float:
    """CPU seconds of the fastest run, with one BLAS thread, so that what else the machine does counts for little."""
    seconds = []
    with threadpool_limits(1):
        for _ in range(repeats):
            begin = time.process_time()
            work()
            seconds.append(time.process_time() - begin)
    return min(seconds)


# --------------------------------------------------------------------------------------- errors in blocks, their order

Weighing = Callable[[Blocks, int, Block], Floats]
"""The weights, shape (n_i,), with which a block's copies count: from all blocks, its number, and itself."""

OVERLAP_CASES: dict[str, tuple[dict[str, Any], Weighing]] = {
    "no overlap": ({"overlap": 1.0}, lambda blocks, i, block: np.isin(block.vertices, blocks.core(i)).astype(float)),
    "simple average": ({}, lambda blocks, i, block: np.ones(block.size)),
    "weighted average": ({}, lambda blocks, i, block: degree_weights(block.degrees)),
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
    step = options.step if options.sets_coding else options.first_step
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


def _deviations(error: Floats, labels: npt.NDArray[np.int32], parts: int) -> Floats:
    counts = np.bincount(labels, minlength=parts)
    present = counts > 0
    sums = np.stack([np.bincount(labels, error[:, axis], parts) for axis in range(3)], axis=1)
    means = sums[present] / counts[present, None]
    number = np.cumsum(present) - 1
    distance = np.square(error - means[number[labels]]).sum(axis=1)
    return np.asarray(np.sqrt(np.bincount(labels, distance, parts)[present] / counts[present]))


def blend_blocks(mesh: TriangleMesh, options: EncodeOptions, weigh: Weighing) -> BlockView:
    """The error of a mesh whose blocks are coded as by `view_blocks`, and joined with other weights, unsmoothed."""
    view = view_blocks(mesh, options)
    prepared = prepare(join(mesh, keep=False).mesh, Parts(options.block_size, options.overlap), keep_order=False)
    scheme = Planner(prepared, options).scheme(options.step or options.first_step)
    blocks, blend = view.blocks(), Blend(view.graph.size)
    for coded in encode_blocks(scheme, prepared.positions, threads=options.threads, doi=options.paper.doi):
        block = blocks.block(coded.decoded.index)
        blend.add(block.vertices, coded.decoded.positions, weigh(blocks, coded.decoded.index, block))
    return replace(view, error=blend.all_positions() - prepared.positions)


def errors_along_chain(view: BlockView) -> Floats:
    """For each block in order: mean squared error of its own part's vertices, and its coefficients; shape (b, 2)."""
    blocks = view.blocks()
    squared = np.square(view.error).sum(axis=1)
    return np.array([(squared[blocks.core(index)].mean(), size) for index, size in enumerate(view.info.coefficients)])


def spread(rows: Floats) -> float:
    """Standard deviation over mean of the blocks' errors (root mean square)."""
    errors = np.sqrt(rows[:, 0])
    return float(errors.std() / errors.mean())


def dynamic_comparison(mesh: TriangleMesh, block_size: int, keep: float = 0.10) -> tuple[Floats, Floats]:
    """Errors along the chain for a fixed size and for one that follows the error, at about the same rate."""
    settings: dict[str, Any] = {"block_size": block_size, "power": 2}
    fixed = dynamic = errors_along_chain(view_blocks(mesh, paper_options(**settings, keep=keep)))
    wanted = fixed[:, 1].sum()
    low, high = 1e-4, 10.0
    for _ in range(12):
        middle = float(np.sqrt(low * high))
        options = paper_options(**settings, keep=min(1.0, 5 * keep), doi=(0.9 * middle, middle))
        dynamic = errors_along_chain(view_blocks(mesh, options))
        kept = dynamic[:, 1].sum()
        if abs(kept / wanted - 1) < 0.01:
            break
        low, high = (middle, high) if kept > wanted else (low, middle)
    return fixed, dynamic


def in_bisection_order(blocks: Blocks, index: int) -> Laplacian:
    """Laplacian of a block as the codec has it."""
    return laplacian_of(blocks.block(index))


def in_breadth_first_order(blocks: Blocks, index: int) -> Laplacian:
    """Laplacian of a block with its rows as growing found them: its part in mesh order, then ring after ring."""
    laplacian, found = laplacian_of(blocks.block(index)), blocks.members_of(index)
    block, fronts = laplacian.block, laplacian.fronts
    by_vertex = np.argsort(block.vertices)
    rows = by_vertex[np.searchsorted(block.vertices, found, sorter=by_vertex)]
    entries = np.ones(len(block.neighbours), np.int8)
    graph = csr_matrix((entries, block.neighbours, block.offsets), shape=(block.size, block.size))[rows][:, rows]
    graph.sort_indices()
    other = Block(block.vertices[rows], graph.indptr.astype(np.int32), graph.indices.astype(np.int32))
    # The order of elimination is the same: fronts found from rows in another order than bisection's would be huge.
    places = np.argsort(rows).astype(np.uint32)
    moved = fronts._replace(rows=places[fronts.rows], steps=fronts.steps[rows].astype(np.uint32))
    return Laplacian(other, moved, np.ones(len(other.neighbours)), laplacian.diagonal[rows])


# ------------------------------------------------------------------------------- section 6: segments, how they overlap


def segmentation(study: Study) -> Iterable[Table]:
    """The clean mesh, 10 % of the frequencies kept, without and with overlap."""
    model = study.model("bunny")
    clean = replace(model, noisy=model.clean)
    rows: list[Row] = []
    for segments in study.some((70, 100, 200)):
        alone, joint = (joined(clean, segments, way) for way in ("no overlap", "weighted average"))
        rows.append((f"{segments} segments", (model.reference.mnd(alone), model.reference.mnd(joint)), ()))
    yield Table("6.1 Segmentation: Bunny", {"MND without overlap": None, "MND with overlap": None}, rows)


def joined(model: Model, segments: int, way: str) -> Positions:
    """The coarse step's result with the paper's number of segments and one way of joining them."""
    weights = np.ones_like if way == "simple average" else degree_weights
    overlap = 1.0 if way == "no overlap" else OVERLAP
    weigh = lambda degrees: weights(degrees).astype(np.float64)  # noqa: E731
    return model.coarse(segments, rules=EXACT, overlap=overlap, weights=weigh)(model.noisy)


def boundary(study: Study) -> Iterable[Table]:
    """Quartiles of the error inside segments and at their edges."""
    model = study.model("bunny")
    options = paper_options(keep=0.1, power=2, block_size=round(len(model.mesh.positions) / model.segments(70)))
    rows: list[Row] = []
    ratios = []
    for case, (changes, weigh) in OVERLAP_CASES.items():
        found = boundary_deviations(blend_blocks(model.mesh, replace(options, **changes), weigh))
        for where, values in found.items():
            rows.append((f"{case}, {where}", tuple(1e3 * np.percentile(values, (25, 50, 75))), ()))
        ratios.append(f"{rows[-1][1][1] / rows[-2][1][1]:.2f} ({case})")
    columns = dict.fromkeys(("lower quartile", "median", "upper quartile"))
    remark = f"Median at the edges over that inside: {', '.join(ratios)}; with weights there is next to no difference."
    yield Table("6.1 Standard deviation of the error, thousandths of the diagonal", columns, rows, (remark,))


def transition(study: Study) -> Iterable[Table]:
    """Fandisk in 10, 15 and 20 segments, joined in three ways: theta after the coarse step."""
    model = study.model("fandisk 0.3")
    rows: list[Row] = [
        (f"{count} segments", tuple(model.reference.theta(joined(model, count, way)) for way in OVERLAP_CASES), ())
        for count in study.some((10, 15, 20))
    ]
    yield Table("6.1 Transition between segments: Fandisk, theta", dict.fromkeys(OVERLAP_CASES), rows)


def number_of_segments(study: Study) -> Iterable[Table]:
    """Mean normal difference by number of segments."""
    model = study.model("bunny")
    rows: list[Row] = []
    for count, published in study.some(BUNNY.items()):
        errors = [model.reference.mnd(joined(model, count, way)) for way in ("simple average", "weighted average")]
        rows.append((f"{count} segments", (model.block(count), *errors), (round(34_817 / count), *published)))
    columns = {"vertices per segment": 0.03, "MND, simple average": 0.05, "MND, weighted average": 0.05}
    gains = sum(simple > weighted for _, (_, simple, weighted), _ in rows)
    claims = (
        Claim("The error rises with segments.", _falls(rows[::-1], 2), "each keeps its own lowest tenth."),
        Claim("Weights are better.", gains == len(rows), f"in {gains} of {len(rows)} rows."),
    )
    remark = "The paper does not say how strong its noise is, and the level of MND follows it; compare the trend."
    yield Table("6.2 Number of segments: Bunny", columns, rows, (remark,), claims)


def _falls(rows: list[Row], column: int) -> bool:
    return bool((np.diff([ours[column] for _, ours, _ in rows]) < 0).all())


def overlap(study: Study) -> Iterable[Table]:
    """Mean normal difference by segments and overlap."""
    model = study.model("julio")
    for count, (sizes, coarse_there, fine_there) in JULIO.items():
        rows: list[Row] = []
        for factor, *published in study.some(zip(OVERLAPS, sizes, coarse_there, fine_there, strict=True)):
            study.note(f"Julio, {count} segments, overlap {factor}")
            filter_ = model.coarse(count, rules=EXACT, overlap=factor)
            coarse = filter_(model.noisy)
            errors = (model.reference.mnd(p) for p in (coarse, guided_normal_filtering(coarse, model.faces, 2)))
            rows.append((f"{factor:.2f} max", (filter_.size, *errors), tuple(published)))
        columns = {"n_d": 0.03, "coarse MND": 0.04, "fine MND": 0.03}
        claim = Claim("More overlap is better, coarse.", _falls(rows, 1), "c is 10 % of n_d, which grows with it.")
        remark = "METIS labels differ between builds; the noisy Julio and the fine step's constants are not published."
        yield Table(f"6.3 Size of the overlapping segments: Julio, {count}", columns, rows, (remark,), (claim,))


def laplacians(model: Model, count: int) -> Floats:
    """Laplacians of the first segments of exactly 100 vertices, shape (count or fewer, 100, 100)."""
    graph = graph_of_faces(model.faces, len(model.clean))
    blocks = grow_blocks(graph, metis_partition(graph, max(2, round(len(model.clean) / 87))), 100)
    found = (blocks.block(index) for index in range(blocks.count))
    return np.array([dense_laplacian(block) for block in found if block.size == 100][:count])


def coherence_errors(matrices: list[Floats]) -> Floats:
    """Mean squared error between the first matrix of each model (rows) and the mean of each model (columns)."""
    return np.array([[np.square(own[0] - other.mean(axis=0)).mean() for other in matrices] for own in matrices])


def left_out(matrices: list[Floats]) -> Floats:
    """Errors where a model's first matrix is no part of its own mean."""
    table = coherence_errors(matrices)
    np.fill_diagonal(table, [np.square(own[0] - own[1:].mean(axis=0)).mean() for own in matrices])
    return table


def smallest_on_diagonal(table: Floats) -> int:
    """In how many rows a model is nearest to itself."""
    return int((table.argmin(axis=1) == np.arange(len(table))).sum())


def coherence(study: Study) -> Iterable[Table]:
    """How near segments are to their own model's, as printed, and with the tested one left out of its mean."""
    for count in (3, 40):
        matrices = [laplacians(study.model(role), count) for role in COHERENCE]
        for name, measure in (("part of its own mean", coherence_errors), ("left out of its own mean", left_out)):
            found = measure(matrices)
            printed = count == 3 and measure is coherence_errors
            rows: list[Row] = [
                (role, tuple(map(float, row)), there if printed else ())
                for (role, there), row in zip(COHERENCE.items(), found, strict=True)
            ]
            nearest = smallest_on_diagonal(found)
            claim = Claim("A model is nearest to itself.", nearest == len(rows), f"in {nearest} of {len(rows)} rows.")
            title = f"6.4 Coherence of segments: first of {count}, {name}"
            yield Table(title, dict.fromkeys(COHERENCE), rows, (), (claim,))


# ------------------------------------------------------------------------------- section 7: denoising, moving meshes


def normals(study: Study) -> Iterable[Table]:
    """The normals of the dodecahedron: noisy, smoothed."""
    model = study.model("twelve")
    stages = {"noisy": model.noisy, "coarse": model.coarse(10)(model.noisy)}
    rows: list[Row] = [(k, (model.reference.theta(p), model.reference.mnd(p)), ()) for k, p in stages.items()]
    yield Table("7.2 Normals and the coarse step: Twelve", {"theta": None, "MND": None}, rows)


def iterate(laplacians: Iterable[Laplacian], graph: Graph, width: int, rules: ChainRules) -> None:
    """Orthogonal iterations for all blocks, as a frame needs them that shares no dictionary."""
    chain = Chain(rules, graph)
    for laplacian in laplacians:
        positions = np.zeros((laplacian.block.size, 3))
        chain.commit(laplacian.block, chain.dictionary(unheld(laplacian, rules.shift), width), positions)


def sequences(study: Study) -> Iterable[Table]:
    """Time of a frame with shared dictionaries and with orthogonal iterations of its own, and whether they agree."""
    name, clean, faces = study.sequence()
    noisy = np.stack([gaussian_along_normals(frame, faces, 0.2, seed) for seed, frame in enumerate(clean)])
    count, n, _ = noisy.shape
    filter_ = CoarseFilter(faces, n)
    coarse = filter_frames(filter_, noisy, KEEP)
    difference = max(float(np.abs(filter_(frame) - other).max()) for frame, other in zip(noisy, coarse, strict=True))
    graph = graph_of_faces(faces, n)
    partition = metis_partition(graph, max(1, round(n / BLOCK_SIZE)))
    grown = grow_blocks(graph, partition, block_size(partition, OVERLAP))
    width, rules = max(1, round(KEEP * filter_.size)), replace(RULES, key_interval=0)

    def made() -> Iterable[Laplacian]:
        return (laplacian_of(grown.block(index)) for index in range(grown.count))

    prepared = list(made())
    groups = [noisy[first : first + GROUP] for first in range(0, count, GROUP)]
    time_of = partial(fastest, repeats=study.repeats)
    shared = time_of(lambda: [filter_frames(filter_, group, KEEP) for group in groups]) / count
    single = time_of(lambda: [filter_(frame) for frame in noisy]) / count
    times = {
        f"dictionaries shared, {GROUP} frames in one product per block": shared,
        "dictionaries shared, frame by frame": single,
        "iterations for each frame": single + time_of(lambda: iterate(prepared, graph, width, rules)),
        "dictionaries for each frame": single + time_of(lambda: iterate(made(), graph, width, rules)),
        "everything for each frame": single + time_of(lambda: CoarseFilter(faces, n)),
    }
    rows: list[Row] = [(way, (1e3 * seconds, seconds / shared), ()) for way, seconds in times.items()]
    middle = count // 2
    before, after = (theta(clean[middle], stage[middle], faces) for stage in (noisy, coarse))
    remark = f"Frames in one product and on their own differ by {difference:.0e} at most."
    angles = f"Theta of frame {middle}: {before:.1f} degrees noisy, {after:.1f} coarse."
    columns = {"CPU ms a frame": None, "times the shared one": None}
    yield Table(f"7.3 Sequences: coarse step of {count} frames of {name}", columns, rows, (remark, angles))


# ------------------------------------------------------------------------- section 8: rates, the subspace size, times


def rates(study: Study) -> Iterable[Table]:
    """Bits per vertex against NMSVE at the least and at the largest rate; times are wall-clock, of single runs."""
    model = study.model("bunny")
    curves: tuple[Curve, ...] = paper_curves(model.block(70))
    if study.quick:
        least = ("svd", "oi-r1", "oi-r1-cold", "oi-r2", "doi-r1")
        every = paper_curves(model.block(70), PAPER_KEEPS[:4])
        curves = tuple(Curve(c.name, c.label, c.codecs[1::2]) for c in every if c.name in least)
    ends: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {}
    for curve in curves:
        study.note(f"{model.name}: {curve.label}")
        points = sorted(run_curve(curve, model.mesh, model.name)["points"], key=lambda point: point["bpv_paper"])
        ends[curve.name] = (curve.label, points[0], points[-1])
    svd, rows = ends["svd"][2]["decode_seconds"], list[Row]()
    for codec, (label, low, high) in ends.items():
        seconds = high["decode_seconds"]
        numbers = (low["bpv_paper"], low["nmsve_db"], high["bpv_paper"], high["nmsve_db"], seconds, svd / seconds)
        rows.append((label, numbers, (*[None] * 5, 20.0) if codec == "oi-r1" else ()))
    claims = []
    for name in ("oi-r1", "oi-r2"):
        if f"{name}-cold" in ends:
            (label, _, warm), (_, _, cold) = ends[name], ends[f"{name}-cold"]
            found = f"{warm['nmsve_db']:.2f} dB and {cold['nmsve_db']:.2f} dB at the largest rate."
            better = warm["nmsve_db"] < cold["nmsve_db"]
            claims.append(Claim(f"{label}: a warm start brings a smaller error than starting anew.", better, found))
    columns = ("bpv, least", "NMSVE there, dB", "bpv, largest", "NMSVE there, dB ", "decoding, s", "SVD's time over it")
    remark = "The last column has the paper's at most; ours are times of whole decoders, and an exact basis is eigh's."
    limits = dict(zip(columns, (*[None] * 5, 0.2)))
    yield Table("8.1 Rate against error: Bunny, 70 segments, 12 bits", limits, rows, (remark,), tuple(claims))


def dynamic(study: Study) -> Iterable[Table]:
    """Error and c per segment for a fixed and for a dynamic subspace size."""
    model = study.model("bunny")
    chains = dynamic_comparison(model.mesh, round(len(model.mesh.positions) / model.segments(70)))
    rows: list[Row] = [
        (label, (chain[:, 1].sum(), chain[:, 1].min(), chain[:, 1].max(), spread(chain)), ())
        for label, chain in zip(("fixed", "dynamic"), chains, strict=True)
    ]
    fixed, varied = map(spread, chains)
    jump = float((np.abs(np.diff(chains[1][:, 1])) / chains[1][:, 1].mean()).max(initial=0.0))
    claims = (
        Claim(
            "The error is more stable with a dynamic size.", varied < fixed, f"spread {varied:.3f}, not {fixed:.3f}."
        ),
        Claim("The dynamic c changes without jumps.", jump <= 0.25, f"by {100 * jump:.0f} % of its mean at most."),
    )
    columns = dict.fromkeys(("sum of c", "least c", "largest c", "spread of errors"))
    yield Table("8.1 Dynamic orthogonal iterations: Bunny, 70 segments", columns, rows, (), claims)


def coarse_to_fine(study: Study) -> Iterable[Table]:
    """Where the coarse step helps the guided filter, and where not: theta by iteration."""
    counts, paid, rows = (1, 2, 5, 20), 0, list[Row]()
    for role in ("armadillo", "fandisk", "fandisk 0.3", "julio"):
        study.note(f"{role}: coarse to fine")
        model = study.model(role)
        size = len(model.clean)
        filter_ = model.coarse(20) if role == "armadillo" else CoarseFilter(model.faces, size, block=500)
        automatic = model.reference.theta(denoise_automatically(model.noisy, model.faces)[0])
        best = []
        for way, start in (("alone", model.noisy), ("coarse first", filter_(model.noisy))):
            iterates = GuidedFilter(start, Topology(model.faces, size)).iterates()
            angles = [model.reference.theta(positions) for positions in islice(iterates, counts[-1] + 1)]
            best.append(min(angles))
            rows.append((f"{role}, {way}", (*(angles[count] for count in counts), best[-1], automatic), ()))
        paid += best[1] < best[0]
    claim = Claim("The coarse step helps.", paid == 4, f"both at their best iteration: in {paid} of 4 cases.")
    columns = dict.fromkeys((*map(str, counts), "best", "automatic mode"))
    yield Table("8.2 Coarse to fine: theta after iterations of guided filtering", columns, rows, (), (claim,))


def companions(study: Study) -> Iterable[Table]:
    """Every companion alone and behind the coarse step."""
    model = study.model("fandisk")
    coarse = model.coarse(10)(model.noisy)
    rows: list[Row] = [("none", (model.reference.theta(model.noisy), model.reference.theta(coarse)), ())]
    for name, step in FINE_STEPS.items():
        study.note(f"{model.name}: {name}")
        rows.append((name, tuple(model.reference.theta(step(p, model.faces)) for p in (model.noisy, coarse)), ()))
    gains = sum(after < alone for _, (alone, after), _ in rows[1:])
    claim = Claim("All gain from the coarse step.", gains == len(FINE_STEPS), f"{gains} of {len(FINE_STEPS)} do.")
    columns = {"alone": None, "after the coarse step": None}
    yield Table("8.2 Companions: Fandisk, noise 0.7, theta", columns, rows, (), (claim,))


def hand(study: Study) -> Iterable[Table]:
    """The Hand, coarsely denoised by OI, SVD and DOI."""
    model, segments = study.model("hand"), SEGMENTS["hand"]
    tracked = model.coarse(segments)(model.noisy)
    blocks = model.blocks(segments)
    norms = [np.linalg.norm((model.noisy - tracked)[blocks.members_of(index)]) for index in range(blocks.count)]
    threshold = float(np.median(norms)) / TriangleMesh(model.clean, model.faces).diagonal
    doi = (0.9 * threshold, threshold)  # as many coefficients as hold a segment's residual near the median of OI's
    codec = Spectral(paper_options(keep=0.3, power=3, block_size=model.block(segments), doi=doi))
    mesh, kept = TriangleMesh(model.noisy, model.faces).without_isolated_vertices()
    data, align = codec.encode(mesh)
    varied = np.array(model.noisy)
    varied[kept] = align(codec.decode(data))
    results = {"OI": tracked, "SVD": model.coarse(segments, rules=EXACT)(model.noisy), "dynamic OI": varied}
    rows: list[Row] = [
        (name, (model.reference.theta(positions), model.reference.compare(positions).nmsve_db), ())
        for name, positions in results.items()
    ]
    yield Table(f"8.2 OI, SVD and dynamic OI: {model.name} for the Hand", {"theta": None, "NMSVE, dB": None}, rows)


def svd_seconds(blocks: Blocks) -> float:
    """Time of the full dense SVD of every block: the paper's yardstick."""
    laplacians = (dense_laplacian(blocks.block(index)) for index in range(blocks.count))
    return sum(fastest(partial(np.linalg.svd, laplacian), 1) for laplacian in laplacians)


def subset_seconds(blocks: Blocks, keep: float) -> float:
    """Time of LAPACK's solver for just the lowest eigenvectors of every block."""
    total = 0.0
    for index in range(blocks.count):
        laplacian = dense_laplacian(blocks.block(index))
        span = [0, max(0, round(keep * len(laplacian)) - 1)]
        total += fastest(partial(scipy.linalg.eigh, laplacian, subset_by_index=span), 1)
    return total


def times(study: Study) -> Iterable[Table]:
    """NMSVE and CPU seconds of one thread; those of OI have the segmentation and the order of rows in them."""
    for role, published in TIMES.items():
        model, shares = study.model(role), study.some(published)
        blocks = model.blocks(SEGMENTS[role])
        exact = model.coarse(SEGMENTS[role], keep=max(shares) / 100, rules=EXACT)
        svd, rows = svd_seconds(blocks), list[Row]()
        for share in shares:
            study.note(f"{model.name}, c = {share} %")
            # One chain, so that one thread does all the work, as the SVD's does.
            build = partial(model.coarse, SEGMENTS[role], keep=share / 100, rules=replace(RULES, key_interval=0))
            seconds = fastest(build, study.repeats)
            errors = [decibel(model.reference.nmsve(f(model.noisy, share / 100))) for f in (exact, build())]
            ours = (*errors, errors[1] - errors[0], svd, seconds, svd / seconds)
            there = published[share]
            numbers = (*ours, subset_seconds(blocks, share / 100) / seconds)
            rows.append((f"{share} %", numbers, (*there[:2], there[1] - there[0], *there[2:])))
        columns = {"SVD, dB": 0.01, "OI, dB": 0.01, "OI less SVD, dB": 0.25, "SVD, s": 0.1, "OI, s": 0.1}
        remark = "Machine, libraries, files and samples of noise are others: ratios and distances in a row compare."
        more = {"speed-up": 0.2, "against eigh of c vectors": None}
        yield Table(f"8.2 NMSVE and times: {role}, {model.name}", {**columns, **more}, rows, (remark,))


def coarse_in_order(model: Model, blocks: Blocks, order: Callable[[Blocks, int], Laplacian]) -> Positions:
    """The coarse step with one orthogonal iteration of R^1, c = 10 %, and the rows of blocks in a given order."""
    chain = Chain(replace(RULES, power=1, iterations=1, key_interval=0), blocks.graph)
    blend = Blend(len(model.clean))
    for index in range(blocks.count):
        laplacian = order(blocks, index)
        block = laplacian.block
        subspace = chain.dictionary(unheld(laplacian, RULES.shift), max(1, round(KEEP * block.size)))
        positions = subspace @ (subspace.T @ model.noisy[block.vertices])
        chain.commit(block, subspace, positions)
        blend.add(block.vertices, positions, degree_weights(block.degrees))
    return blend.positions(np.arange(len(model.clean), dtype=np.int32))


def powers(study: Study) -> Iterable[Table]:
    """Theta and time by the power of R."""
    for role, published in POWERS.items():
        model, rows = study.model(role), list[Row]()
        blocks = model.blocks(10)
        for name, there in study.some(published.items()):
            study.note(f"{model.name}, {name}")
            exact = name == "SVD"
            # One iteration for every block but the first, whose start has no predecessor.
            power = 1 if exact else int(name[2:])
            rules = replace(RULES, exact=exact, power=power, iterations=1, key_interval=int(exact))
            build = partial(model.coarse, 10, rules=rules)
            seconds = svd_seconds(blocks) if exact else fastest(build, study.repeats)
            rows.append((name, (seconds, model.reference.theta(build()(model.noisy))), there))
        found, ordered = (
            model.reference.theta(coarse_in_order(model, blocks, order))
            for order in (in_breadth_first_order, in_bisection_order)
        )
        remark = f"One iteration of R^1: {found:.1f} degrees with rows as they were found, {ordered:.1f} by bisection."
        columns = {"t, s": 0.1, "theta, degrees": 0.05}
        yield Table(f"8.2 Powers of R: {role}, 10 segments, c = 10 %", columns, rows, (remark,))


_SIX = (segmentation, boundary, transition, number_of_segments, overlap, coherence)
_SEVEN_AND_EIGHT = (normals, sequences, rates, dynamic, coarse_to_fine, companions, hand, times, powers)
TABLES: dict[str, Callable[[Study], Iterable[Table]]] = {
    made.__name__.replace("_", "-"): made for made in (*_SIX, *_SEVEN_AND_EIGHT)
}


def make_tables(study: Study, names: Iterable[str]) -> list[Table]:
    """Some of `TABLES`."""
    if unknown := set(names) - {*TABLES}:
        raise OptionError(f"no table is called {', '.join(sorted(unknown))}; there are {', '.join(TABLES)}")
    return [table for name in names for table in TABLES[name](study)]


def work(args: argparse.Namespace, console: Console) -> None:
    """Measure, print, and say how many numbers agree with the paper's and how many claims hold."""
    folder = Path(args.meshes) if args.meshes else None
    if folder is not None and not (folder / "static").is_dir():
        raise OptionError(f"{folder} has no folder static/")
    tables = make_tables(Study(folder, args.quick, console.note), args.only.split(",") if args.only else [*TABLES])
    if args.json:
        print_json({"tables": [asdict(table) for table in tables]})
        return
    print("\n".join(table.text() for table in tables))
    if folder is None:
        print("Not comparable with the paper: generated meshes stand in for its models.")
    agree, numbers = (sum(counts) for counts in zip(*(table.score() for table in tables), strict=True))
    claims = [claim.holds for table in tables for claim in table.claims]
    print(f"{agree} of {numbers} numbers agree with the paper's, {sum(claims)} of {len(claims)} claims hold.")


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshes", metavar="FOLDER", help="with static/, noisy/, dynamic/ (default: generated meshes)")
    parser.add_argument("--only", metavar="LIST", help=f"of {', '.join(TABLES)} (default: all)")
    parser.add_argument("--quick", action="store_true", help="few settings and small meshes: seconds, not minutes")
    parser.add_argument("--json", action="store_true", help="print the data of all tables as JSON")
    run_command(parser, work)
