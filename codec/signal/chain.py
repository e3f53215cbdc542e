"""A chain: a key block and the blocks that follow it, each of which may look back as far as the key block.

Encoder and decoder step through the same chain with the same calls: `around`, `dictionary`, `commit`. Different
chains know nothing of each other, which bounds what a lost block costs and lets chains run in parallel.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from bsm.codec.arrays import Matrix
from bsm.codec.basis.cost import Spend, careful_dictionary_cost, dictionary_cost, free
from bsm.codec.basis.laplacian import laplacian_of
from bsm.codec.basis.orthogonal_iteration import (
    EXACT_ITERATIONS,
    EXACT_POWER,
    exact_basis,
    first_columns,
    follow_columns,
    orthogonal_iteration,
)
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import Graph, is_connected
from bsm.codec.signal.predict import Known, Surroundings, Suspended, unheld

Rounding: TypeAlias = Callable[[Matrix], Matrix]
Columns: TypeAlias = Callable[[int], Matrix]
Dictionary: TypeAlias = Callable[[Surroundings, int, Columns], Matrix]
Predictor: TypeAlias = Callable[[Surroundings], Matrix]


def unchanged(values: Matrix) -> Matrix:
    """The values themselves."""
    return values


@dataclass(frozen=True)
class Trial:
    """What is tried in place of what the specification says; nothing, unless somebody asks for it.

    Parameters
    ----------
    rounding : callable
        What becomes of the numbers that dictionaries and predictions start from, see `codec.steadiness`.
    dictionary : callable, optional
        Takes what holds a block, the number c of columns, and a function that gives ours with so many; gives U, shape
        (n_i, c). See `research`.
    predictor : callable, optional
        Takes what holds a block; gives positions, shape (n_i, 3), of which only the differences are coded.
    """

    rounding: Rounding = unchanged
    dictionary: Dictionary | None = None
    predictor: Predictor | None = None


AS_SPECIFIED = Trial()


@dataclass(frozen=True)
class ChainRules:
    """What the stream's header says about dictionaries and chains.

    Parameters
    ----------
    exact : bool
        Exact eigenbasis of blocks without predecessor, as the paper seeds its first block; see
        `codec.basis.orthogonal_iteration.exact_basis`.
    key_interval : int
        Blocks per chain; 0: one chain. 1: every block is on its own.
    power, iterations, key_iterations, shift
        z, t_max, t_max of a block without predecessor, and delta.
    stiffness : float
        Of the springs in the prediction, see `codec.signal.predict`; 0: no prediction.
    trial : Trial
        What is tried in place of what the specification says.
    """

    exact: bool
    key_interval: int
    power: int
    iterations: int
    key_iterations: int
    shift: float
    stiffness: float
    trial: Trial = AS_SPECIFIED

    def schedule(self, follows: bool) -> tuple[int, int]:
        """Power and iterations of a block that follows another, or of one that does not."""
        if self.exact and not follows:
            return EXACT_POWER, EXACT_ITERATIONS
        return self.power, self.iterations if follows else self.key_iterations

    @property
    def alone(self) -> bool:
        """Whether every block is a chain of its own, so that none knows of another."""
        return self.key_interval == 1

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


def key_dictionary(rules: ChainRules, around: Suspended, width: int, spend: Spend = free) -> Matrix:
    """U of a block that follows no other, with `width` columns; `spend` is told of the work."""
    block = around.laplacian.block
    start = rules.trial.rounding(first_columns(block.size, width, rules.exact or in_pieces(block)))
    if rules.exact:
        return exact_basis(around.laplacian, start, around.springs, spend)
    return orthogonal_iteration(around.factor, start, power=rules.power, iterations=rules.key_iterations, spend=spend)


def in_pieces(block: Block) -> bool:
    """Whether a block has several components."""
    return not is_connected(Graph(block.offsets, block.neighbours))


class Chain:
    """State of one chain: the latest subspace, and the positions known so far.

    Parameters
    ----------
    rules : ChainRules
    graph : Graph
        Of the whole mesh.
    spend : callable, optional
        Is told of the work of each dictionary before it is done.
    """

    def __init__(self, rules: ChainRules, graph: Graph, spend: Spend = free) -> None:
        self._rules = rules
        self._spend = spend
        self._known = None if rules.stiffness == 0.0 or rules.alone else Known(graph, rules.stiffness)
        self._subspace: Matrix | None = None

    def around(self, block: Block) -> Surroundings:
        """What the chain knows around a block."""
        laplacian = laplacian_of(block)
        shift = self._rules.shift
        return unheld(laplacian, shift) if self._known is None else self._known.around(laplacian, shift)

    def costs(self, around: Surroundings, width: int) -> tuple[float, float]:
        """What `dictionary` of some width costs, and what it costs besides where it would lose columns."""
        fronts, block = around.laplacian.fronts, around.laplacian.block
        schedule = self._rules.schedule(self._follows(block))
        return dictionary_cost(fronts, width, *schedule), careful_dictionary_cost(fronts, width, *schedule)

    def _follows(self, block: Block) -> bool:
        return self._subspace is not None and len(self._subspace) == block.size

    def dictionary(self, around: Surroundings, width: int) -> Matrix:
        """U of a block with `width` columns (at most its rows), a function of connectivity and earlier widths only."""
        width, own = min(width, around.laplacian.block.size), self._rules.trial.dictionary
        if own is None:
            return self._specified(around, width)
        return np.ascontiguousarray(own(around, width, lambda width: self._specified(around, width)), np.float64)

    def continuation(self, around: Surroundings) -> Matrix:
        """What a block is predicted to be, shape (n_i, 3)."""
        own = self._rules.trial.predictor
        return around.continuation if own is None else np.ascontiguousarray(own(around), np.float64)

    def _specified(self, around: Surroundings, width: int) -> Matrix:
        rules, laplacian = self._rules, around.laplacian
        if not self._follows(laplacian.block):
            return key_dictionary(rules, around, width, self._spend)
        assert self._subspace is not None
        start = rules.trial.rounding(follow_columns(self._subspace, width, in_pieces(laplacian.block)))
        return orthogonal_iteration(
            around.factor, start, power=rules.power, iterations=rules.iterations, width=width, spend=self._spend
        )

    def commit(self, block: Block, subspace: Matrix, positions: Matrix) -> None:
        """Make a block, its subspace and its decoded positions, shape (n_i, 3), the predecessor's."""
        self._subspace = subspace
        if self._known is not None:
            self._known.add(block, self._rules.trial.rounding(positions))
