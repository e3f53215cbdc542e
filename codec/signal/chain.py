"""A chain: a key block and the blocks that follow it, each of which may look back as far as the key block.

The encoder steps through a chain with the calls `around`, `dictionary`, `commit`; the decoder is chain.c.
Chains are independent, which bounds the loss by a damaged block and lets chains run in parallel.

Not in the paper: a block is predicted from the known vertices around it, and its dictionary uses these. Every edge that
leaves the block to a known vertex is a spring of stiffness 1 to where that vertex is, as every edge is in the quadratic
form of L; a known vertex inside the block has a spring to its own place. With S the stiffnesses at each row and y
their pulls, the surface that continues known vertices is the equilibrium (L + S)^-1 y: the harmonic extension. Only the
difference from it is coded. It is small beside known vertices and free elsewhere, and so are the lowest eigenvectors of
L + S: they, not those of L, are the dictionary. The delta of Algorithm 1 serves for both, so that one factorisation
does.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np

from bsm._core import codec as _kernels
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Basis, Matrix
from bsm.codec.basis.laplacian import (
    Factor,
    Laplacian,
    check_rows,
    dictionary_cost,
    factor_room,
    factorize,
    laplacian_of,
    solving_room,
)
from bsm.codec.basis.orthogonal_iteration import (
    EXACT_ITERATIONS,
    EXACT_POWER,
    completed,
    exact_basis,
    first_columns,
    follow_columns,
    orthogonal_iteration,
)
from bsm.codec.blocks.overlap import Blend, Block, degree_weights
from bsm.codec.geometry.graph import Graph, is_connected


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
    """The known values around a block, as springs and their pulls."""

    pulls: Matrix

    @cached_property
    def factor(self) -> Factor:
        return self._ground[0]

    @property
    def continuation(self) -> Matrix:
        """Positions that continue the known ones, shape (n, 3); zero without any known position."""
        return self._ground[1]

    @cached_property
    def _ground(self) -> tuple[Factor, Matrix]:
        block, fronts, rows = self.laplacian.block, self.laplacian.fronts, len(self.springs)
        values, inverse, continued = factor_room(fronts), np.empty(rows, np.float32), np.empty((rows, 3))
        given = block.offsets, block.neighbors, self.laplacian.weights, self.laplacian.diagonal, fronts
        scratch = np.empty(rows), np.empty(rows + 1, np.uint32), solving_room(rows, 3)
        _kernels.suspend(*given, self.springs, self.pulls, self.shift, *scratch, values, inverse, continued)
        return Factor(fronts, values, inverse), continued


class Known:
    """The decoded part of a chain."""

    def __init__(self, graph: Graph, stiffness: float) -> None:
        self._graph = graph
        self._stiffness = stiffness
        self._blend = Blend(graph.size)
        self._inside = np.zeros(graph.size, np.uint8)

    def add(self, block: Block, positions: Matrix) -> None:
        """Remember one copy of a block's vertices, shape (n_i, 3)."""
        self._blend.add(block.vertices, positions, degree_weights(block.degrees))

    def around(self, laplacian: Laplacian, shift: float) -> Surroundings:
        """Return the known values around a block."""
        graph, blend, block = self._graph, self._blend, laplacian.block
        found = Surroundings(laplacian, np.empty(block.size), shift, np.empty((block.size, 3)))
        given = graph.offsets, graph.neighbors, block.vertices, self._inside, blend.sums, blend.weights
        _kernels.look_around(*given, self._stiffness, found.springs, found.pulls)
        return found


def continued(factor: Factor, springs: Matrix, pulls: Matrix) -> Matrix:
    """Values that continue the known ones into the rows of a block: mean + (L + S + delta)^-1 (y - S mean)."""
    rows, columns = pulls.shape
    check_rows(factor, rows)
    values = np.empty((rows, columns))
    given = factor.fronts, factor.values, factor.inverse, springs, np.ascontiguousarray(pulls)
    _kernels.continue_known(*given, solving_room(rows, columns), values)
    return values


Columns: TypeAlias = Callable[[int], Basis]
Dictionary: TypeAlias = Callable[[Surroundings, int, Columns], Matrix]
Predictor: TypeAlias = Callable[[Surroundings], Matrix]


@dataclass(frozen=True)
class Overrides:
    """Replacements for parts of the specification, for research; empty by default."""

    dictionary: Dictionary | None = None
    predictor: Predictor | None = None


AS_SPECIFIED = Overrides()


@dataclass(frozen=True)
class ChainRules:
    """The settings of dictionaries and chains in the header of the stream."""

    exact: bool
    key_interval: int
    power: int
    iterations: int
    key_iterations: int
    shift: float
    stiffness: float
    apart: int = 0
    """Onorm follows each of so many solutions, in doubles; 0: each solution."""
    whole: int = 0
    overrides: Overrides = AS_SPECIFIED

    @property
    def alone(self) -> bool:
        """Whether every block is a chain of its own, so that none knows of another."""
        return self.key_interval == 1

    def iterated(self, rows: int) -> int:
        """Return the largest number of columns of a dictionary that follow from its Laplacian."""
        return -(-rows // 2) if rows <= self.whole else rows

    def chain_starts(self, blocks: int) -> range:
        """Indices of the key blocks among `blocks` blocks."""
        return range(0, blocks, self.chain_length(blocks))

    def chains(self, blocks: int) -> list[range]:
        """Indices of the blocks of each chain."""
        length = self.chain_length(blocks)
        return [range(first, min(first + length, blocks)) for first in self.chain_starts(blocks)]

    def chain_length(self, blocks: int) -> int:
        """Blocks in a chain (the last one may be shorter)."""
        return self.key_interval or blocks


def even_interval(interval: int, blocks: int) -> int:
    """The length of chains that are as many as with `interval`, and as equal as can be; 0: one chain."""
    return -(-blocks // -(-blocks // interval)) if interval else 0


def key_dictionary(rules: ChainRules, around: Suspended, width: int) -> Basis:
    """U of a block that follows no other, with `width` columns."""
    block = around.laplacian.block
    start = first_columns(block.size, min(width, rules.iterated(block.size)), rules.exact or in_pieces(block))
    if rules.exact:
        return completed(exact_basis(around.laplacian, start, around.springs), width)
    first = orthogonal_iteration(
        around.factor, start, power=rules.power, iterations=rules.key_iterations, apart=rules.apart
    )
    return completed(first, width)


def in_pieces(block: Block) -> bool:
    return not is_connected(Graph(block.offsets, block.neighbors))


class Chain:
    """State of one chain: the latest subspace, and the positions known so far."""

    def __init__(self, rules: ChainRules, graph: Graph) -> None:
        self._rules = rules
        self._known = None if rules.stiffness == 0.0 or rules.alone else Known(graph, rules.stiffness)
        self._subspace: Basis | None = None

    def around(self, block: Block) -> Surroundings:
        """Return the known values around a block."""
        laplacian = laplacian_of(block)
        shift = self._rules.shift
        if self._known is None:
            return Surroundings(laplacian, np.zeros(block.size), shift, np.zeros((block.size, 3)))
        return self._known.around(laplacian, shift)

    def dictionary(self, around: Surroundings, width: int) -> Basis:
        """U of a block of n_i rows, shape (n_i, width), a function of connectivity and earlier widths only."""
        width, own = min(width, around.laplacian.block.size), self._rules.overrides.dictionary
        if own is None:
            return self._specified(around, width)
        return np.ascontiguousarray(own(around, width, partial(self._specified, around)), np.float32)

    def work(self, around: Surroundings, width: int) -> float:
        """Work of `dictionary`, nanoseconds; the work of a user's own dictionary is not counted."""
        rules = self._rules
        if rules.overrides.dictionary is not None:
            return 0.0
        fronts = around.laplacian.fronts
        if self._follows(around.laplacian.block):
            return dictionary_cost(fronts, width, rules.power, rules.iterations, rules.apart)
        if rules.exact:
            return dictionary_cost(fronts, width, EXACT_POWER, EXACT_ITERATIONS)
        return dictionary_cost(fronts, width, rules.power, rules.key_iterations, rules.apart)

    def continuation(self, around: Surroundings) -> Matrix:
        """Return the prediction of a block, shape (n_i, 3)."""
        own = self._rules.overrides.predictor
        return around.continuation if own is None else np.ascontiguousarray(own(around), np.float64)

    def _follows(self, block: Block) -> bool:
        return self._subspace is not None and len(self._subspace) == block.size

    def _specified(self, around: Surroundings, width: int) -> Basis:
        rules, block, previous = self._rules, around.laplacian.block, self._subspace
        if previous is None or not self._follows(block):
            return key_dictionary(rules, around, width)
        first = min(width, rules.iterated(block.size))
        start = follow_columns(previous, first, in_pieces(block))
        subspace = orthogonal_iteration(
            around.factor, start, power=rules.power, iterations=rules.iterations, width=first, apart=rules.apart
        )
        return completed(subspace, width)

    def commit(self, block: Block, subspace: Basis, positions: Matrix) -> None:
        """Make a block, its subspace and its decoded positions, shape (n_i, 3), the predecessor's."""
        self._subspace = subspace
        if self._known is not None:
            self._known.add(block, positions)
