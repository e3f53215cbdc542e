"""The coarse step: keep the low graph frequencies of every block, and blend the blocks (paper, sections 6 and 7.2).

``v^ = U_c U_c^T v`` in each overlapping block; the copies of a vertex are averaged with the vertex's degree in each
block as weight.
"""

from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces, Indices
from bsm.codec.blocks.overlap import Blend, Block, Blocks, block_size, degree_weights, grow_blocks, metis_partition
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import Chain, ChainRules
from bsm.codec.threads import ordered_map

Floats = npt.NDArray[np.float64]
Weights = Callable[[Indices], Floats]

BLOCK_SIZE = 500  # about the paper's; half or twice of it leaves 2.4 and 0.6 % more of the angle
OVERLAP = 1.15
KEEP = 0.10
RULES = ChainRules(exact=False, key_interval=16, power=3, iterations=2, key_iterations=4, shift=0.125, stiffness=0.0)


class CoarseFilter:
    """A low-pass filter of everything that lives on the vertices of one connectivity."""

    def __init__(
        self,
        faces: Faces,
        n: int,
        keep: float = KEEP,
        block: int = BLOCK_SIZE,
        rules: ChainRules = RULES,
        *,
        overlap: float = OVERLAP,
        weights: Weights = degree_weights,
    ) -> None:
        graph = graph_of_faces(np.ascontiguousarray(faces, dtype=np.int32), n)
        partition = metis_partition(graph, max(1, round(n / block)))
        self._size = block_size(partition, overlap)
        blocks = grow_blocks(graph, partition, self._size)
        self._blocks = [
            (block.vertices, weights(block.degrees), dictionary)
            for block, dictionary in _dictionaries(blocks, self._width(keep), rules)
        ]

    def __call__(self, values: Floats, keep: float = KEEP) -> Floats:
        """Filter `values`, shape (n, 3); `keep` is at most the filter's."""
        width = self._width(keep)
        blend = Blend(len(values))
        for vertices, copies, dictionary in self._blocks:
            subspace = dictionary[:, :width]
            # Constants are in the subspace but for rounding, which far from the origin would be all there is.
            center = values[vertices].mean(axis=0)
            blend.add(vertices, subspace @ (subspace.T @ (values[vertices] - center)) + center, copies)
        return blend.all_positions()

    def _width(self, keep: float) -> int:
        return max(1, round(keep * self._size))


def _dictionaries(blocks: Blocks, width: int, rules: ChainRules) -> Iterator[tuple[Block, Floats]]:
    """Every block and its dictionary; chains run in parallel."""

    def chain_from(first: int) -> list[tuple[Block, Floats]]:
        chain = Chain(rules, blocks.graph)
        found = []
        for index in range(first, min(first + rules.chain_length(blocks.count), blocks.count)):
            block = blocks.block(index)
            dictionary = chain.dictionary(chain.around(block), width)
            chain.commit(block, dictionary, np.zeros((block.size, 3)))
            found.append((block, dictionary.astype(np.float64)))
        return found

    for found in ordered_map(chain_from, rules.chain_starts(blocks.count), None):
        yield from found
