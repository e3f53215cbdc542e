"""Putting decoded blocks together: which vertices have moved, which are final, which are missing."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Indices, Mask, Matrix, Order
from bsm.codec.basis.laplacian import Spend, free
from bsm.codec.blocks.overlap import Blend, Blocks
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.signal.smooth import DEGREE, LocalFilter, Rings, smooth
from bsm.codec.static.attributes.surface import Solid
from bsm.codec.static.events import Changes, Losses
from bsm.codec.static.numbering import Numbering
from bsm.codec.static.units import Units

COPY = 90.0  # nanoseconds for saying where a vertex is


@dataclass(frozen=True, eq=False)
class DecodedBlock:
    """A block's own reconstruction, before it is blended with others; positions in BSM units."""

    index: int
    vertices: Indices
    positions: Matrix
    weights: Matrix


def blended(size: int, blocks: Iterable[DecodedBlock]) -> Matrix:
    """Positions of all `size` vertices, shape (size, 3), in BSM units, from all blocks."""
    blend = Blend(size)
    for block in blocks:
        blend.add(block.vertices, block.positions, block.weights)
    return blend.all_positions()


class Assembly:
    """Blends the blocks of one mesh."""

    def __init__(
        self, blocks: Blocks, smoothing: float, units: Units, numbering: Numbering, spend: Spend = free
    ) -> None:
        graph = blocks.graph
        self._graph = graph
        self._blocks = blocks
        self._smoothing = smoothing
        self._units = units
        self._numbering = numbering
        self._spend = spend
        self._blend = Blend(graph.size)
        self._lost: list[int] = []

    # Made for who asks what each block changes.

    @cached_property
    def _missing(self) -> Order:
        return np.bincount(self._blocks.members, minlength=self._graph.size)

    @cached_property
    def _blended(self) -> Matrix:
        return np.zeros((self._graph.size, 3))

    @cached_property
    def _final(self) -> Mask:
        return np.zeros(self._graph.size, np.bool_)

    @cached_property
    def _filter(self) -> LocalFilter:
        return LocalFilter(self._graph, self._smoothing)

    def _rings(self, vertices: Indices, rings: int) -> Rings:
        found = self._filter.around(vertices, rings)
        self._spend(found.work)
        return found

    def _around(self, vertices: Indices, rings: int) -> Indices:
        return self._rings(vertices, rings).rows

    def _smoothed(self, vertices: Indices) -> Matrix:
        if self._smoothing == 0.0:
            return self._blended[vertices]
        return self._filter.smoothed(self._blended, self._rings(vertices, DEGREE))

    def add(self, block: DecodedBlock) -> None:
        self._blend.add(block.vertices, block.positions, block.weights)

    def lose(self, number: int) -> None:
        self._lost.append(number)

    def mesh(self, checksum: int | None = None) -> TriangleMesh:
        """The mesh in its own unit, once every block is in."""
        smoothed = smooth(self._graph, self._blend.all_positions(), self._smoothing)
        decoded = self._units.back(smoothed, out=smoothed)
        return self._numbering.mesh(decoded, checksum if self.whole else None)

    @property
    def whole(self) -> bool:
        return not self._lost

    def solid(self) -> Solid | None:
        """Decoded positions, once every block is in; None if one was lost."""
        if not self.whole:
            return None
        return Solid(smooth(self._graph, self._blend.all_positions(), self._smoothing))

    def base(self) -> tuple[Matrix, Mask]:
        """What refinement adds to, shape (n, 3), 0 where unknown, and which, with those beside, are as they were."""
        everything = np.arange(self._graph.size, dtype=np.int32)
        if self.whole:
            whole = np.ones(len(everything), np.bool_)
            return smooth(self._graph, self._blend.all_positions(), self._smoothing), whole
        known = self._blend.known(everything)
        positions = np.zeros((len(everything), 3))
        positions[known] = self._blend.positions(everything[known])
        spoilt = self._around(self._touched(), (DEGREE if self._smoothing else 0) + 1)
        whole = np.ones(len(everything), np.bool_)
        whole[spoilt] = False
        return smooth(self._graph, positions, self._smoothing), whole

    def changes(self, block: DecodedBlock) -> Changes:
        """Blend one block in and say what it changed."""
        self.add(block)
        seen = block.vertices[self._blend.known(block.vertices)]
        self._blended[seen] = self._blend.positions(seen)
        self._missing[block.vertices] -= 1
        finished = self._finished(block.vertices[self._missing[block.vertices] == 0])
        self._final[finished] = True
        moved = seen[~self._final[seen]]
        done = self._smoothed(finished)
        changed = np.concatenate([moved, finished])
        positions = self._units.back(np.concatenate([self._blended[moved], done]))
        numbers, rows = self._numbering.spread(changed)
        self._spend(COPY * len(numbers))
        return Changes(numbers, positions[rows], (np.arange(len(changed)) >= len(changed) - len(finished))[rows])

    def losses(self) -> Losses:
        """What the blocks that were lost leave missing or less good."""
        if self.whole:
            return Losses()
        touched = self._touched()
        known = self._blend.known(touched)
        reach = DEGREE if self._smoothing else 0
        around = self._around(touched, reach)
        degraded = around[self._blend.known(around)]
        return Losses(self._numbering.of(touched[~known]), self._numbering.of(np.sort(degraded)))

    def _touched(self) -> Indices:
        own = [self._blocks.members_of(index) for index in self._lost]
        return np.unique(np.concatenate([np.empty(0, np.int32), *own]))

    def _finished(self, complete: Indices) -> Indices:
        """Vertices that become final when all copies of `complete` have come: none that the filter sees is missing."""
        if self._smoothing == 0.0:
            return complete
        around = self._around(complete, 2 * DEGREE)
        waiting = self._around(around[self._missing[around] > 0], DEGREE)
        candidates = self._around(complete, DEGREE)
        return np.setdiff1d(candidates[~self._final[candidates]], waiting)
