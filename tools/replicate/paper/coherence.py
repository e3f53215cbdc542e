"""Whether segments of a model resemble each other more than those of other models (Table 5, Figure 8)."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bsm.codec.blocks.overlap import Block, grow_blocks, metis_partition
from bsm.codec.geometry.graph import graph_of_faces
from tools.laplacians import dense_laplacian
from tools.replicate.paper.dictionaries import Floats, in_file_order
from tools.replicate.paper.figures import save_matrices
from tools.replicate.paper.models import Model, Study
from tools.replicate.paper.published import COHERENCE, claim, printed
from tools.replicate.rates import Row

SEGMENTS, ROWS = 40, 100
SHIFTS = (2.0**-7, 0.1, 1.0)
"""Values of delta, which the paper calls small."""


def segments(model: Model, count: int = SEGMENTS) -> list[Block]:
    """The first segments of exactly 100 vertices."""
    graph = graph_of_faces(model.faces, len(model.clean))
    blocks = grow_blocks(graph, metis_partition(graph, max(2, round(len(model.clean) / 87))), ROWS)
    found = (blocks.block(index) for index in range(blocks.count))
    return [block for block in found if block.size == ROWS][:count]


@dataclass(frozen=True)
class Weights:
    """How edges are weighted: all alike, or by inverse squares of lengths (2), with sums of weights as diagonal or,
    as equation 1 is printed, numbers of neighbors.
    """

    by_length: bool = True
    printed: bool = False

    def laplacian(self, model: Model, block: Block) -> Floats:
        """L of a segment."""
        if not self.by_length:
            return dense_laplacian(block).astype(np.float64)
        rows = np.repeat(np.arange(block.size), block.degrees)
        positions = model.clean[block.vertices]
        squares = np.square(positions[rows] - positions[block.neighbors]).sum(axis=1)
        laplacian = np.zeros((block.size, block.size))
        laplacian[rows, block.neighbors] = -1.0 / np.maximum(squares, 1e-12)
        np.fill_diagonal(laplacian, block.degrees if self.printed else -laplacian.sum(axis=1))
        return laplacian


def resolvent(laplacian: Floats, shift: float) -> Floats:
    """R = (L + delta I)^-1."""
    return np.asarray(np.linalg.inv(laplacian + shift * np.eye(len(laplacian))), np.float64)


def coherence_errors(matrices: list[Floats]) -> Floats:
    """Mean squared error between the first matrix of each model (rows) and the mean of each model (columns)."""
    return np.array(
        [[np.square(own[0] - other.mean(axis=0)).mean() for other in matrices] for own in matrices]
    )


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
    """The paper's table, and how many segments are nearest to their own model, by R, and by L."""
    models = {role: study.model(role) for role in COHERENCE}
    blocks = {role: segments(model) for role, model in models.items()}

    def by_model(weights: Weights, shift: float = 0.0, *, sort: bool = False) -> list[Floats]:
        found = []
        for role, model in models.items():
            own = [
                weights.laplacian(model, block if sort else in_file_order(block))
                for block in blocks[role]
            ]
            found.append(
                np.array([resolvent(matrix, shift) if shift else matrix for matrix in own])
            )
        return found

    best = by_model(Weights(), SHIFTS[1])
    table = coherence_errors([matrices[:3] for matrices in best])
    diagonal = int((table.argmin(axis=1) == np.arange(len(table))).sum())
    yield printed(
        "The paper, 6.4 (Table 5): coherence of segments",
        COHERENCE,
        [
            (f"{role} ({models[role].name})", tuple(map(float, row)), there)
            for (role, there), row in zip(COHERENCE.items(), table, strict=True)
        ],
        "Mean squared error between a segment's R and the mean R of a model, the first three segments of each model. "
        f"R = (L + delta I)^-1 as in section 4, delta = {SHIFTS[1]:g}; weights by equation 2, rows as in the file. The "
        "paper does not give delta. Sizes follow the unit of a mesh: compare within a row. The least entry stands on "
        f"the diagonal in {diagonal} of {len(table)} rows.",
        numbers={"diagonal": f"{diagonal} of {len(table)}"},
    )
    ways = {f"R, delta = {shift:.3g}": by_model(Weights(), shift) for shift in SHIFTS}
    ways |= {
        f"R, delta = {shift:.3g}, no weights": by_model(Weights(by_length=False), shift)
        for shift in SHIFTS
    }
    ways |= {
        f"R, delta = {SHIFTS[1]:g}, our order of rows": by_model(Weights(), SHIFTS[1], sort=True)
    }
    ways |= {
        "L as printed": by_model(Weights(printed=True)),
        "L, no weights": by_model(Weights(by_length=False)),
    }
    counts = {name: nearest_to_own(matrices) for name, matrices in ways.items()}
    whole = {name: sum(own) for name, own in counts.items()}
    by_r, of = [whole[f"R, delta = {shift:.3g}"] for shift in SHIFTS], sum(map(len, best))
    numbers = {
        "r": f"{by_r[0]}, {by_r[1]} and {by_r[2]}",
        "l": str(whole["L as printed"]),
        "of": str(of),
    }
    numbers |= {
        "plain": str(whole["L, no weights"]),
        "sorted": str(whole[f"R, delta = {SHIFTS[1]:g}, our order of rows"]),
    }
    yield printed(
        "The paper, 6.4: segments nearest to their own model",
        [*COHERENCE, "all"],
        [(name, (*map(float, own), float(whole[name])), ()) for name, own in counts.items()],
        f"Of {SEGMENTS} segments a model, each left out of its own mean; chance is a fifth. The text is open: it "
        "compares R, and calls R a Laplacian matrix. Both are given; the verdict is that of R.",
        claim(
            "A segment is nearest to its own model",
            min(by_r) > 0.75 * of,
            f"it is for {numbers['r']} of {of} with R, {numbers['l']} with L as printed. A few edges of almost no "
            f"length rule L. Our order of rows makes models more alike: {numbers['sorted']} of {of}.",
            *models.values(),
            value=100 * min(by_r) / of,
            unit="% of the segments with R",
        ),
        numbers=numbers,
    )
    save_matrices(
        study.output,
        {
            models[role].name: [np.array(own[k]) for k in range(3)]
            for role, own in zip(COHERENCE, best)
        },
    )
