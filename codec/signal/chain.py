"""A chain: a key block and the blocks that follow it, each of which may look back as far as the key block.

Encoder and decoder step through the same chain with the same calls: `around`, `dictionary`, `commit`. Different
chains know nothing of each other, which bounds what a lost block costs and lets chains run in parallel.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from bsm.codec.arrays import Basis, Matrix
from bsm.codec.basis.cost import Steps, unpaid
from bsm.codec.basis.laplacian import laplacian_of
from bsm.codec.basis.orthogonal_iteration import (
    completed_steps,
    exact_steps,
    first_columns,
    follow_columns,
    iteration_steps,
)
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import Graph, is_connected
from bsm.codec.signal.predict import Known, Surroundings, Suspended, unheld

Columns: TypeAlias = Callable[[int], Basis]
Dictionary: TypeAlias = Callable[[Surroundings, int, Columns], Matrix]
Predictor: TypeAlias = Callable[[Surroundings], Matrix]


@dataclass(frozen=True)
class Overrides:
    """What is tried in place of what the specification says; nothing, unless somebody asks for it."""

    dictionary: Dictionary | None = None
    predictor: Predictor | None = None


AS_SPECIFIED = Overrides()


@dataclass(frozen=True)
class ChainRules:
    """What the stream's header says about dictionaries and chains."""

    exact: bool
    key_interval: int
    power: int
    iterations: int
    key_iterations: int
    shift: float
    stiffness: float
    whole: int = 0
    overrides: Overrides = AS_SPECIFIED

    @property
    def alone(self) -> bool:
        """Whether every block is a chain of its own, so that none knows of another."""
        return self.key_interval == 1

    def iterated(self, rows: int) -> int:
        """Columns of a dictionary of so many rows, at most, that follow from its Laplacian."""
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


def key_steps(rules: ChainRules, around: Suspended, width: int) -> Steps:
    """U of a block that follows no other, with `width` columns, and the price of each step."""
    block = around.laplacian.block
    most = rules.iterated(block.size)
    start = first_columns(block.size, min(width, most), rules.exact or in_pieces(block))
    if rules.exact:
        steps = exact_steps(around.laplacian, start, around.springs)
    else:
        steps = iteration_steps(around.factor, start, power=rules.power, iterations=rules.key_iterations)
    return completed_steps(steps, block.size, most, width)


def in_pieces(block: Block) -> bool:
    """Whether a block has several components."""
    return not is_connected(Graph(block.offsets, block.neighbours))


class Chain:
    """State of one chain: the latest subspace, and the positions known so far."""

    def __init__(self, rules: ChainRules, graph: Graph) -> None:
        self._rules = rules
        self._known = None if rules.stiffness == 0.0 or rules.alone else Known(graph, rules.stiffness)
        self._subspace: Basis | None = None

    def around(self, block: Block) -> Surroundings:
        """What the chain knows around a block."""
        laplacian = laplacian_of(block)
        shift = self._rules.shift
        return unheld(laplacian, shift) if self._known is None else self._known.around(laplacian, shift)

    def dictionary(self, around: Surroundings, width: int) -> Basis:
        """U of a block of n_i rows, shape (n_i, width), a function of connectivity and earlier widths only."""
        return unpaid(self.steps(around, width))

    def steps(self, around: Surroundings, width: int) -> Steps:
        """`dictionary`, with the price of each step."""
        width, own = min(width, around.laplacian.block.size), self._rules.overrides.dictionary
        return self._specified(around, width) if own is None else self._tried(own, around, width)

    def continuation(self, around: Surroundings) -> Matrix:
        """What a block is predicted to be, shape (n_i, 3)."""
        own = self._rules.overrides.predictor
        return around.continuation if own is None else np.ascontiguousarray(own(around), np.float64)

    def _specified(self, around: Surroundings, width: int) -> Steps:
        rules, block, previous = self._rules, around.laplacian.block, self._subspace
        if previous is None or len(previous) != block.size:
            return key_steps(rules, around, width)
        most = rules.iterated(block.size)
        first = min(width, most)
        start = follow_columns(previous, first, in_pieces(block))
        steps = iteration_steps(around.factor, start, power=rules.power, iterations=rules.iterations, width=first)
        return completed_steps(steps, block.size, most, width)

    def _tried(self, own: Dictionary, around: Surroundings, width: int) -> Steps:
        """A dictionary of somebody's own, whose price nobody knows."""
        yield from ()
        columns = own(around, width, lambda width: unpaid(self._specified(around, width)))
        return np.ascontiguousarray(columns, np.float32)

    def commit(self, block: Block, subspace: Basis, positions: Matrix) -> None:
        """Make a block, its subspace and its decoded positions, shape (n_i, 3), the predecessor's."""
        self._subspace = subspace
        if self._known is not None:
            self._known.add(block, positions)
