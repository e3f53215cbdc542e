"""Whether segments of a model resemble each other more than those of other models (Table 5, Figure 8)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from bsm.codec.basis.laplacian import dense_laplacian
from bsm.codec.blocks.overlap import Block, grow_blocks, metis_partition
from bsm.codec.geometry.graph import graph_of_faces
from tools.replicate.paper.dictionaries import Floats, in_file_order
from tools.replicate.paper.figures import save_matrices
from tools.replicate.paper.models import Model, Study
from tools.replicate.paper.published import COHERENCE, claim, printed
from tools.replicate.rates import Row

SEGMENTS, ROWS = 40, 100


def segments(model: Model, count: int = SEGMENTS) -> list[Block]:
    """The first segments of exactly 100 vertices."""
    graph = graph_of_faces(model.faces, len(model.clean))
    blocks = grow_blocks(graph, metis_partition(graph, max(2, round(len(model.clean) / 87))), ROWS)
    found = (blocks.block(index) for index in range(blocks.count))
    return [block for block in found if block.size == ROWS][:count]


def printed_laplacian(model: Model, block: Block) -> Floats:
    """L by equations 1 and 2 as they are printed: numbers of neighbors, less inverse squares of lengths."""
    rows = np.repeat(np.arange(block.size), block.degrees)
    positions = model.clean[block.vertices]
    squares = np.square(positions[rows] - positions[block.neighbors]).sum(axis=1)
    laplacian = np.zeros((block.size, block.size))
    laplacian[rows, block.neighbors] = -1.0 / np.maximum(squares, 1e-12)
    np.fill_diagonal(laplacian, block.degrees)
    return laplacian


def coherence_errors(matrices: list[Floats]) -> Floats:
    """Mean squared error between the first matrix of each model (rows) and the mean of each model (columns)."""
    return np.array([[np.square(own[0] - other.mean(axis=0)).mean() for other in matrices] for own in matrices])


def nearest_to_own(matrices: list[Floats]) -> list[int]:
    """Count, for each model, its matrices that are nearest to its own mean, of which they are left out."""
    found = []
    for own in matrices:
        count, total, right = len(own), own.sum(axis=0), 0
        means = [other.mean(axis=0) for other in matrices if other is not own]
        for matrix in own:
            mine = np.square(matrix - (total - matrix) / (count - 1)).mean()
            right += bool(mine < min(np.square(matrix - mean).mean() for mean in means))
        found.append(right)
    return found


def coherence(study: Study) -> Iterator[Row]:
    """The paper's table with its matrix and its order of rows, and how many segments are nearest to their own model."""
    models = {role: study.model(role) for role in COHERENCE}
    blocks = {role: segments(model) for role, model in models.items()}
    ways: dict[str, list[Floats]] = {
        "the paper's weights, rows as in the file": [
            np.array([printed_laplacian(models[r], in_file_order(b)) for b in blocks[r]]) for r in COHERENCE
        ],
        "the paper's weights, our order of rows": [
            np.array([printed_laplacian(models[r], b) for b in blocks[r]]) for r in COHERENCE
        ],
        "no weights, rows as in the file": [
            np.array([dense_laplacian(in_file_order(b)) for b in blocks[r]]) for r in COHERENCE
        ],
        "no weights, our order of rows": [np.array([dense_laplacian(b) for b in blocks[r]]) for r in COHERENCE],
    }
    first, *_ = ways.values()
    table = coherence_errors([matrices[:3] for matrices in first])
    yield printed(
        "The paper, 6.4 (Table 5): coherence of segments",
        COHERENCE,
        [
            (f"{role} ({models[role].name})", tuple(map(float, row)), there)
            for (role, there), row in zip(COHERENCE.items(), table, strict=True)
        ],
        "Mean squared error between a segment's L and the mean L of a model. L as printed (equations 1 and 2), rows as "
        "in the file, the first three segments of each model. Sizes follow the unit of a mesh: compare within a row.",
    )
    counts = {name: nearest_to_own(matrices) for name, matrices in ways.items()}
    whole = {name: (sum(own), sum(map(len, matrices))) for (name, own), matrices in zip(counts.items(), ways.values())}
    right, of = whole["the paper's weights, rows as in the file"]
    plain = whole["no weights, rows as in the file"][0]
    sorted_rows = whole["no weights, our order of rows"][0]
    yield printed(
        "The paper, 6.4: segments nearest to their own model",
        [*COHERENCE, "all"],
        [(name, (*map(float, own), float(whole[name][0])), ()) for name, own in counts.items()],
        f"Of {SEGMENTS} segments a model, each left out of its own mean; chance is a fifth.",
        claim(
            "A segment is nearest to its own model",
            min(counts["the paper's weights, rows as in the file"]) > SEGMENTS / 2,
            f"it is for {right} of {of} with the paper's matrix, {plain} of {of} without weights in file order. "
            f"Our order of rows makes all models alike: {sorted_rows} of {of}.",
            *models.values(),
        ),
        numbers={"paper": str(right), "plain": str(plain), "sorted": str(sorted_rows), "of": str(of)},
    )
    save_matrices(
        study.output, {models[role].name: [np.array(own[k]) for k in range(3)] for role, own in zip(COHERENCE, first)}
    )
