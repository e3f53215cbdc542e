"""A chain: a key block and the blocks that follow it, each of which may look back as far as the key block.

Encoder and decoder step through the same chain with the same calls: `dictionary`, `prediction`, `commit`. Different
chains know nothing of each other, which bounds what a lost block costs and lets chains run in parallel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from codec.blend import Blend, degree_weights
from codec.blocks import Block
from codec.predict import PriorModel, predict_coefficients
from codec.subspace import cosine_columns, exact_basis, orthogonal_iteration, resized

Matrix = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ChainRules:
    """What the stream's header says about dictionaries and chains.

    Parameters
    ----------
    exact : bool
        Exact eigenbasis of every block instead of orthogonal iterations.
    independent : bool
        Every block starts from cosines and is a chain of its own.
    key_interval : int
        Blocks per chain; 0: one chain.
    power, iterations, key_iterations, shift
        z, t_max, t_max of a block without predecessor, and delta.
    prior : PriorModel, optional
        Of the prediction; None: no prediction.
    """

    exact: bool
    independent: bool
    key_interval: int
    power: int
    iterations: int
    key_iterations: int
    shift: float
    prior: PriorModel | None

    def chain_starts(self, blocks: int) -> range:
        """Indices of the key blocks among `blocks` blocks."""
        return range(0, blocks, self.chain_length(blocks))

    def chain_length(self, blocks: int) -> int:
        """Blocks in a chain (the last one may be shorter)."""
        return 1 if self.independent else self.key_interval or blocks


class Chain:
    """State of one chain: the latest subspace, and the positions known so far."""

    def __init__(self, rules: ChainRules, vertices: int) -> None:
        self._rules = rules
        self._blend = Blend(vertices)
        self._subspace: Matrix | None = None

    def dictionary(self, block: Block, width: int) -> Matrix:
        """U of a block with `width` columns (at most its rows), a function of (U of the predecessor, width) only."""
        rules = self._rules
        width = min(width, block.size)
        if rules.exact:
            return exact_basis(block, width)
        follows = self._subspace is not None and len(self._subspace) == block.size and not rules.independent
        if follows:
            assert self._subspace is not None
            start = resized(self._subspace, width)
        else:
            start = cosine_columns(block.size, 0, width)
        iterations = rules.iterations if follows or rules.independent else rules.key_iterations
        return orthogonal_iteration(block, start, shift=rules.shift, power=rules.power, iterations=iterations)

    def prediction(self, block: Block, subspace: Matrix) -> Matrix:
        """Expected coefficients of a block, shape (width, 3); zero where the chain predicts nothing."""
        if self._rules.prior is None:
            return np.zeros((subspace.shape[1], 3))
        rows = np.flatnonzero(self._blend.known(block.vertices))
        return predict_coefficients(subspace, rows, self._blend.positions(block.vertices[rows]), self._rules.prior)

    def commit(self, block: Block, subspace: Matrix, coefficients: Matrix) -> Matrix:
        """Reconstruct a block's positions, shape (n_i, 3), and make block and subspace the predecessor's."""
        positions = subspace @ coefficients
        self._subspace = subspace
        if self._rules.prior is not None:
            self._blend.add(block.vertices, positions, degree_weights(block.degrees))
        return positions
