"""Section 7.3: one dictionary for all frames of a sequence."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from codec.blocks import Block, block_size, grow_blocks
from codec.chain import Chain, ChainRules
from codec.denoise.coarse import BLOCK_SIZE, KEEP, OVERLAP, RULES, CoarseFilter
from codec.denoise.frames import GROUP, filter_frames
from codec.denoise.noise import gaussian_along_normals
from codec.graph import Graph, graph_of_faces
from codec.metrics import theta
from codec.partition import metis_partition
from codec.predict import unheld
from tools.paper.exhibit import Cell, Column, Exhibit, Table
from tools.paper.iterations import fastest
from tools.paper.pictures import rendering
from tools.paper.study import Study

SIGMA = 0.2
SHOWN = 3


def iterate(blocks: Iterable[Block], graph: Graph, width: int, rules: ChainRules) -> None:
    """Orthogonal iterations for all blocks, as a frame needs them that shares no dictionary."""
    chain = Chain(rules, graph)
    for block in blocks:
        chain.commit(block, chain.dictionary(block, unheld(block), width), np.zeros((block.size, 3)))


def sequences(study: Study) -> Exhibit:
    """Time of a frame with shared dictionaries and with orthogonal iterations of its own, and whether they agree."""
    name, clean, faces = study.sequence()
    count, n, _ = clean.shape
    study.note(f"{name}: {count} frames")
    noisy = np.stack([gaussian_along_normals(frame, faces, SIGMA, seed) for seed, frame in enumerate(clean)])
    repeats = study.effort.repeats
    filter_ = CoarseFilter(faces, n)
    batched = filter_frames(filter_, noisy, KEEP)
    alone = np.stack([filter_(frame) for frame in noisy])
    difference = float(np.abs(batched - alone).max())

    graph = graph_of_faces(faces, n)
    partition = metis_partition(graph, max(1, round(n / BLOCK_SIZE)))
    grown = grow_blocks(graph, partition, block_size(partition, OVERLAP))
    prepared = [grown.block(index) for index in range(grown.count)]
    width = max(1, round(KEEP * filter_.size))
    rules = replace(RULES, key_interval=0)
    iterate(prepared, graph, width, rules)
    groups = [noisy[first : first + GROUP] for first in range(0, count, GROUP)]
    shared = fastest(lambda: [filter_frames(filter_, group, KEEP) for group in groups], repeats) / count
    single = fastest(lambda: [filter_(frame) for frame in noisy], repeats) / count
    iterations = fastest(lambda: iterate(prepared, graph, width, rules), repeats)
    own = fastest(lambda: iterate(map(grown.block, range(grown.count)), graph, width, rules), repeats)
    whole = fastest(lambda: CoarseFilter(faces, n), repeats)
    columns = (Column("ms a frame", 2), Column("times the shared one", 1))
    rows = tuple(
        (way, (Cell(1e3 * seconds), Cell(seconds / shared)))
        for way, seconds in (
            (f"dictionaries shared, {GROUP} frames in one product per block", shared),
            ("dictionaries shared, frame by frame", single),
            ("iterations for each frame, rows and pattern of the factors shared", iterations + single),
            ("dictionaries for each frame: row order, factors, iterations", own + single),
            ("everything for each frame, segmentation too", whole + single),
        )
    )
    middle = count // 2
    angles = [theta(clean[middle], stage[middle], faces) for stage in (noisy, batched)]
    pictures = tuple(
        rendering(f"frame {index}, {what}", stage[index], faces, study.effort.pixels)
        for index in np.linspace(0, count - 1, SHOWN).astype(int)
        for what, stage in (("noisy", noisy), ("coarse", batched))
    )
    return Exhibit(
        f"Sequences: {name}",
        "section 7.3, schema of the dynamic case",
        (Table(f"Coarse step of {count} frames of {n} vertices", "", columns, rows),),
        pictures,
        (
            f"Shared dictionaries take {(own + single) / shared:.0f} times less than dictionaries made for each "
            f"frame; frames in one product and frames on their own differ by {difference:.0e} at most.",
            f"Theta of frame {middle}: {angles[0]:.1f} degrees noisy, {angles[1]:.1f} coarse.",
            "The paper prints a schema here and no numbers. Frames are independent of each other, and only a few of "
            "them are in memory at any time.",
        ),
    )
