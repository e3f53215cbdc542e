"""The coarse step: keep the low graph frequencies of every block, and blend the blocks (paper, sections 6 and 7.2).

``v^ = U_c U_c^T v`` in each overlapping block; the copies of a vertex are averaged with the vertex's degree in each
block as weight.
"""

from dataclasses import replace

import numpy as np
import scipy.linalg

from bsm.codec.arrays import Faces, Floats, Indices, Positions
from bsm.codec.blocks.overlap import Blend, Blocks, block_size, grow_blocks, metis_partition
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import Around, Chain, ChainRules, Columns, Overrides
from bsm.codec.threads import ordered_map

BLOCK_SIZE = 500  # about the paper's; half or twice of it leaves 2.4 and 0.6 % more of the angle
OVERLAP = 1.15
KEEP = 0.10
SHORTEST = 0.1  # of mean edges: the length from which on an edge is not shorter to the weights
# More iterations than a stream would send, since no decoder has to repeat them; no springs, as in the paper.
RULES = ChainRules(exact=False, key_interval=16, power=3, iterations=2, key_iterations=4, shift=0.125, springs=False)


def overlapping(faces: Faces, n: int, block: int = BLOCK_SIZE) -> tuple[Blocks, int]:
    """Overlapping blocks of about `block` vertices more than the overlap, and the vertices of each."""
    graph = graph_of_faces(np.ascontiguousarray(faces, dtype=np.int32), n)
    partition = metis_partition(graph, max(1, round(n / block)))
    size = block_size(partition, OVERLAP)
    return grow_blocks(graph, partition, size), size


class CoarseFilter:
    """A low-pass filter of everything that lives on the vertices of one connectivity."""

    def __init__(
        self, faces: Faces, n: int, keep: float = KEEP, block: int = BLOCK_SIZE, rules: ChainRules = RULES
    ) -> None:
        blocks, self._size = overlapping(faces, n, block)
        self._blocks = _dictionaries(blocks, self._width(keep), rules)

    def __call__(self, values: Floats, keep: float = KEEP) -> Floats:
        """Filter `values`, shape (n, 3); `keep` is at most the filter's."""
        width = self._width(keep)
        blend = Blend(len(values))
        for vertices, copies, dictionary in self._blocks:
            subspace = dictionary[:, :width]
            # Constants are in the subspace but for rounding, which far from the origin would be all there is.
            center = values[vertices].mean(axis=0)
            # Twice a thin product, never the n x n projection.
            blend.add(vertices, subspace @ (subspace.T @ (values[vertices] - center)) + center, copies)
        return blend.all_positions()

    def _width(self, keep: float) -> int:
        return max(1, round(keep * self._size))


def _dictionaries(blocks: Blocks, width: int, rules: ChainRules) -> list[tuple[Indices, Floats, Floats]]:
    """Vertices of every block, their weights, and its dictionary; chains run in parallel."""

    def dictionaries_of(indices: range) -> list[tuple[Indices, Floats, Floats]]:
        chain = Chain(rules, blocks)
        found = []
        for index in indices:
            vertices, _, weights = chain.begin(index)
            dictionary = chain.dictionary(width)
            # The next dictionary starts from this one. Positions do not matter here, for nothing is predicted.
            chain.commit(dictionary.shape[1], np.zeros((len(vertices), 3)))
            found.append((vertices, weights, dictionary.astype(np.float64)))
        return found

    return [each for found in ordered_map(dictionaries_of, rules.chains(blocks.count), None) for each in found]


def by_lengths(positions: Positions) -> ChainRules:
    """The rules with L's edges weighted by one over their length, the root of equation 2, exactly solved."""

    def dictionary(site: Around, width: int, _: Columns) -> Floats:
        rows = np.repeat(np.arange(len(site.vertices)), np.diff(site.offsets))
        sides = positions[site.vertices[rows]] - positions[site.vertices[site.neighbors]]
        lengths = np.sqrt(np.square(sides).sum(axis=1))
        mean = lengths.sum() / max(len(lengths), 1) or 1.0
        # Dense: a block has a few hundred vertices, and LAPACK finds its lowest vectors sooner than a sparse solver
        # would.
        laplacian = np.zeros((len(site.vertices),) * 2)
        laplacian[rows, site.neighbors] = -1.0 / np.maximum(lengths / mean, SHORTEST)
        np.fill_diagonal(laplacian, -laplacian.sum(axis=1))
        lowest: Floats = scipy.linalg.eigh(laplacian, subset_by_index=(0, min(width, len(laplacian)) - 1))[1]
        return lowest

    return replace(RULES, overrides=Overrides(dictionary))
