"""Section 7.3: one dictionary for all frames of a sequence."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from bsm.codec.arrays import Faces
from bsm.codec.basis.laplacian import Laplacian, laplacian_of
from bsm.codec.blocks.overlap import block_size, grow_blocks
from bsm.codec.blocks.partition import metis_partition
from bsm.codec.denoise.coarse import BLOCK_SIZE, KEEP, OVERLAP, RULES, CoarseFilter
from bsm.codec.denoise.frames import GROUP, Frames, filter_frames
from bsm.codec.geometry.graph import Graph, graph_of_faces
from bsm.codec.geometry.metrics import theta
from bsm.codec.signal.chain import Chain, ChainRules
from bsm.codec.signal.predict import unheld
from tools.measure.paper.iterations import fastest
from tools.measure.paper.pictures import portrait
from tools.measure.paper.report import Cell, Column, Exhibit, Table
from tools.measure.paper.study import Study
from tools.noise import gaussian_along_normals

SIGMA = 0.2
SHOWN = 3


def iterate(laplacians: Iterable[Laplacian], graph: Graph, width: int, rules: ChainRules) -> None:
    """Orthogonal iterations for all blocks, as a frame needs them that shares no dictionary."""
    chain = Chain(rules, graph)
    for laplacian in laplacians:
        positions = np.zeros((laplacian.block.size, 3))
        chain.commit(laplacian.block, chain.dictionary(unheld(laplacian, rules.shift), width), positions)


@dataclass(frozen=True)
class SequenceTimes:
    """Seconds a frame of the coarse step, and whether frames in one product come out as on their own."""

    difference: float
    shared: float
    single: float
    iterations: float
    remade: float
    whole: float


def time_sequence(noisy: Frames, faces: Faces, repeats: int) -> tuple[SequenceTimes, Frames]:
    """Times, and the coarse frames; least of `repeats` runs, `noisy` of shape (T, n, 3)."""
    count, n, _ = noisy.shape
    filter_ = CoarseFilter(faces, n)
    batched = filter_frames(filter_, noisy, KEEP)
    difference = max(float(np.abs(filter_(frame) - other).max()) for frame, other in zip(noisy, batched, strict=True))

    graph = graph_of_faces(faces, n)
    partition = metis_partition(graph, max(1, round(n / BLOCK_SIZE)))
    grown = grow_blocks(graph, partition, block_size(partition, OVERLAP))
    prepared = [laplacian_of(grown.block(index)) for index in range(grown.count)]

    def remake() -> None:
        made = (laplacian_of(grown.block(index)) for index in range(grown.count))
        iterate(made, graph, width, rules)

    width = max(1, round(KEEP * filter_.size))
    rules = replace(RULES, key_interval=0)
    iterate(prepared, graph, width, rules)
    groups = [noisy[first : first + GROUP] for first in range(0, count, GROUP)]
    single = fastest(lambda: [filter_(frame) for frame in noisy], repeats) / count
    times = SequenceTimes(
        difference=difference,
        shared=fastest(lambda: [filter_frames(filter_, group, KEEP) for group in groups], repeats) / count,
        single=single,
        iterations=single + fastest(lambda: iterate(prepared, graph, width, rules), repeats),
        remade=single + fastest(remake, repeats),
        whole=single + fastest(lambda: CoarseFilter(faces, n), repeats),
    )
    return times, batched


def noisy_frames(clean: Frames, faces: Faces) -> Frames:
    """Every frame with noise of its own."""
    return np.stack([gaussian_along_normals(frame, faces, SIGMA, seed) for seed, frame in enumerate(clean)])


def sequences(study: Study) -> Exhibit:
    """Time of a frame with shared dictionaries and with orthogonal iterations of its own, and whether they agree."""
    model, clean = study.sequence()
    name, faces = model.name, model.faces
    count, n, _ = clean.shape
    study.note(f"{name}: {count} frames")
    noisy = noisy_frames(clean, faces)
    times, coarse = time_sequence(noisy, faces, study.effort.repeats)
    columns = (Column("ms a frame", 2), Column("times the shared one", 1))
    rows = tuple(
        (way, (Cell(1e3 * seconds), Cell(seconds / times.shared)))
        for way, seconds in (
            (f"dictionaries shared, {GROUP} frames in one product per block", times.shared),
            ("dictionaries shared, frame by frame", times.single),
            ("iterations for each frame, rows and pattern of the factors shared", times.iterations),
            ("dictionaries for each frame: row order, factors, iterations", times.remade),
            ("everything for each frame, segmentation too", times.whole),
        )
    )
    middle = count // 2
    angles = [theta(clean[middle], stage[middle], faces) for stage in (noisy, coarse)]
    pictures = tuple(
        portrait(f"frame {index}, {what}", model, stage[index], study.effort.pixels, like=clean[index])
        for index in np.linspace(0, count - 1, SHOWN).astype(int)
        for what, stage in (("noisy", noisy), ("coarse", coarse))
    )
    return Exhibit(
        f"Sequences: {name}",
        "section 7.3, schema of the dynamic case",
        (Table(f"Coarse step of {count} frames of {n} vertices, CPU time", "", columns, rows),),
        pictures,
        (
            f"Shared dictionaries take {times.remade / times.shared:.0f} times less than dictionaries made for each "
            f"frame; frames in one product and frames on their own differ by {times.difference:.0e} at most.",
            f"Theta of frame {middle}: {angles[0]:.1f} degrees noisy, {angles[1]:.1f} coarse.",
            "The paper prints a schema here and no numbers. Frames are independent of each other, and only a few of "
            "them are in memory at any time.",
        ),
    )
