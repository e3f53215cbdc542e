"""Predicting a block from the vertices around it that are known already, and letting its dictionary know of them.

Not in the paper. Every edge that leaves the block to a known vertex is a spring of stiffness 1 to where that vertex
is, as every edge is in the quadratic form of L; a known vertex inside the block hangs on a spring to its own place.
With S the stiffnesses at each row and y their pulls, the surface that continues what is known is the equilibrium
(L + S)^-1 y: the harmonic extension. Only the difference from it is coded. It is small beside known vertices and free
elsewhere, and so are the lowest eigenvectors of L + S: they, not those of L, are the dictionary. The delta of
Algorithm 1 serves for both, so that one factorisation does.
"""

from dataclasses import dataclass

import numpy as np

from bsm.bitstream.once import cached_property
from bsm.codec import _kernels
from bsm.codec.arrays import Matrix
from bsm.codec.basis.laplacian import Factor, Laplacian, check_rows, factor_room, factorize, solving_room
from bsm.codec.blocks.overlap import Blend, Block, degree_weights
from bsm.codec.geometry.graph import Graph


@dataclass(frozen=True, eq=False)
class Suspended:
    """A block on springs."""

    laplacian: Laplacian
    springs: Matrix
    shift: float

    @cached_property
    def factor(self) -> Factor:
        """Factorisation of L + S + delta I: for the block's dictionary, and for what continues its surroundings."""
        return factorize(self.laplacian, self.springs + self.shift)


@dataclass(frozen=True, eq=False)
class Surroundings(Suspended):
    """What holds a block."""

    pulls: Matrix

    @cached_property
    def factor(self) -> Factor:
        return self._ground[0]

    @property
    def continuation(self) -> Matrix:
        """Positions that continue what is known, shape (n, 3); zero where nothing is known."""
        return self._ground[1]

    @cached_property
    def _ground(self) -> tuple[Factor, Matrix]:
        block, fronts, rows = self.laplacian.block, self.laplacian.fronts, len(self.springs)
        values, inverse, continued = factor_room(fronts), np.empty(rows, np.float32), np.empty((rows, 3))
        given = block.offsets, block.neighbours, self.laplacian.weights, self.laplacian.diagonal, fronts
        scratch = np.empty(rows), np.empty(rows + 1, np.uint32), solving_room(rows, 3)
        _kernels.suspend(*given, self.springs, self.pulls, self.shift, *scratch, values, inverse, continued)
        return Factor(fronts, values, inverse), continued


class Known:
    """What a chain has decoded so far."""

    def __init__(self, graph: Graph, stiffness: float) -> None:
        self._graph = graph
        self._stiffness = stiffness
        self._blend = Blend(graph.size)
        self._inside = np.zeros(graph.size, np.uint8)

    def add(self, block: Block, positions: Matrix) -> None:
        """Remember one copy of a block's vertices, shape (n_i, 3)."""
        self._blend.add(block.vertices, positions, degree_weights(block.degrees))

    def around(self, laplacian: Laplacian, shift: float) -> Surroundings:
        """What holds a block."""
        graph, blend, block = self._graph, self._blend, laplacian.block
        found = Surroundings(laplacian, np.empty(block.size), shift, np.empty((block.size, 3)))
        given = graph.offsets, graph.neighbours, block.vertices, self._inside, blend.sums, blend.weights
        _kernels.look_around(*given, self._stiffness, found.springs, found.pulls)
        return found


def unheld(laplacian: Laplacian, shift: float) -> Surroundings:
    """Surroundings of a block that knows of nothing."""
    size = laplacian.block.size
    return Surroundings(laplacian, np.zeros(size), shift, np.zeros((size, 3)))


def continued(factor: Factor, springs: Matrix, pulls: Matrix) -> Matrix:
    """Values that continue what is known into the rows of a block: mean + (L + S + delta)^-1 (y - S mean)."""
    rows, columns = pulls.shape
    check_rows(factor, rows)
    values = np.empty((rows, columns))
    given = factor.fronts, factor.values, factor.inverse, springs, np.ascontiguousarray(pulls)
    _kernels.continue_known(*given, solving_room(rows, columns), values)
    return values
