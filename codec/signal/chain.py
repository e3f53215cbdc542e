"""A chain: a key block and the blocks that follow it, each of which may look back as far as the key block.

Encoders step through chains by `begin`, `dictionary` and `commit`, which chain.c does for decoders, too. Chains
are independent, which bounds the loss by a damaged block and lets chains run in parallel.

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
from typing import NamedTuple, TypeAlias

import numpy as np

from bsm._core import Chain as Steps
from bsm.codec.arrays import Basis, Indices, Matrix
from bsm.codec.basis.orthogonal_iteration import cosine_columns
from bsm.codec.blocks.overlap import Blocks

HELD = 1 << 26  # bytes of exact bases that are kept for other attempts at a mesh
ROUGH_SHIFT = 1 / 32  # delta of a basis that only estimates


class Around(NamedTuple):
    """A block that is not coded yet: its graph, springs, shape (n,), their pulls and what continues these, (n, 3)."""

    vertices: Indices
    offsets: Indices
    neighbors: Indices
    springs: Matrix
    pulls: Matrix
    continuation: Matrix


Columns: TypeAlias = Callable[[int], Basis]
Dictionary: TypeAlias = Callable[[Around, int, Columns], Matrix]
Predictor: TypeAlias = Callable[[Around], Matrix]


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
    springs: bool
    apart: int = 0
    """Onorm follows each of so many solutions, in doubles; 0: each solution."""
    whole: int = 0
    overrides: Overrides = AS_SPECIFIED

    def chains(self, blocks: int) -> list[range]:
        """Indices of the blocks of each chain."""
        # Eight blocks a chain by default: enough that the key block hardly counts, and enough chains for several cores.
        length = self.key_interval or blocks
        return [range(first, min(first + length, blocks)) for first in range(0, blocks, length)]


def even_interval(interval: int, blocks: int) -> int:
    """The length of chains that are as many as with `interval`, and as equal as can be; 0: one chain."""
    # 17 blocks in chains of 8 would leave one block alone; 6, 6 and 5 decode in parallel.
    return -(-blocks // -(-blocks // interval)) if interval else 0


class Chain(Steps):
    """The blocks of one chain after the other; a dictionary and predictions may be a user's."""

    def __init__(self, rules: ChainRules, blocks: Blocks, width: int = 0) -> None:
        graph, self._own = blocks.graph, rules.overrides
        self._blocks, self._keeps, self._rows = blocks, rules.exact and not rules.springs, 0
        arrays = (
            graph.offsets,
            graph.neighbors,
            blocks.cores,
            blocks.starts,
            blocks.edges,
            blocks.members,
        )
        # Overrides are functions of Python, which the chain in C knows nothing of.
        given = {name: value for name, value in vars(rules).items() if name != "overrides"}
        super().__init__(*arrays, **given, width=width)

    def begin(self, index: int) -> tuple[Indices, Matrix, Matrix]:
        """Return the vertices of the next block, its prediction, shape (n_i, 3), and its weights in a blend."""
        vertices, prediction, weights = super().begin(index)
        self._index, self.is_exact, self._rows = (
            index,
            self._keeps and len(vertices) != self._rows,
            len(vertices),
        )
        # The site costs copies of arrays, and only researchers ask for it.
        if self._own is not AS_SPECIFIED:
            self._site = Around(vertices, *self.site(), prediction)
            if self._own.predictor is not None:
                prediction = np.ascontiguousarray(self._own.predictor(self._site), np.float64)
        return vertices, prediction, weights

    def dictionary(self, width: int) -> Basis:
        """U of the block, shape (n_i, width), a function of connectivity and earlier widths only."""
        if self._own.dictionary is None:
            return self._exact(width) if self.is_exact else super().dictionary(width)
        own = np.ascontiguousarray(
            self._own.dictionary(self._site, width, super().dictionary), np.float32
        )
        # The next block starts from this dictionary, as a decoder with the same override would.
        self.give(own)
        return own

    def _exact(self, width: int) -> Basis:
        """The exact basis of a block: it takes long, and depends on nothing but the block, so that it is kept."""
        held = self._blocks.exact
        if self.held >= width:
            basis = np.ascontiguousarray(held[self._index][:, :width])
            self.give(basis)
            return basis
        basis = super().dictionary(width)
        if sum(other.nbytes for other in list(held.values())) + basis.nbytes <= HELD:
            held[self._index] = basis
        return basis

    @property
    def held(self) -> int:
        """Columns of the exact basis that are kept."""
        return self._blocks.exact[self._index].shape[1] if self._index in self._blocks.exact else 0

    def rough(self, width: int) -> Basis:
        """About the exact basis, by a few iterations from cosines."""
        return self._blocks.block(self._index).iterated(
            cosine_columns(self._rows, width), ROUGH_SHIFT, 2, 4
        )

    def costs(self, width: int) -> tuple[float, float, float]:
        """Work of the dictionary and of the rest of the block, nanoseconds, and memory, by decoders' estimate."""
        dictionary, rest, memory = super().costs(width)
        # The law cannot know what a user's function costs.
        return dictionary if self._own.dictionary is None else 0.0, rest, memory
