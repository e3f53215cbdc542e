"""The dictionaries of a sequence, built once, and the way between vertices and coefficients.

The parts of the mesh are taken in the order of the chain, without overlap. Each hangs with springs on the parts before
it, where they have a common edge: the harmonic extension of what is known there is its prediction, orthogonal
iterations with its held Laplacian L + S give its dictionary, and what is coded is the difference from the extension
(see `codec.signal.predict`; here edges have weights). All of this is linear, so that it may be applied to positions, to
differences of frames and to components of trajectories alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from codec.arrays import Faces, Indices, Matrix, Positions
from codec.basis.cost import factor_cost
from codec.basis.laplacian import Factor
from codec.basis.weighted import Held, binary_weights, cotangent_weights, hold
from codec.blocks.overlap import Blocks
from codec.signal.chain import ChainRules, key_dictionary
from codec.signal.predict import Suspended, continued
from codec.signal.transform import project, reconstruct
from codec.static.work import Allowance, block_cost, block_memory, part_memory
from codec.threads import ordered_map

TETHER = 2.0**-16
"""Stiffness with which every row hangs on the mean of the pulls; it places what no spring reaches."""


@dataclass(frozen=True, eq=False)
class Part:
    """A part of the mesh and its dictionary.

    Parameters
    ----------
    held : Held
        What it hangs on.
    factor : Factor
        Of its Laplacian, its springs and `TETHER`.
    basis : float64 array, shape (n_i, c_i)
        U, orthonormal columns.
    """

    held: Held
    factor: Factor
    basis: Matrix

    @property
    def vertices(self) -> Indices:
        """Vertex of the mesh behind each row, shape (n_i,)."""
        return self.held.laplacian.block.vertices

    def extend(self, field: Matrix) -> Matrix:
        """Rows, shape (n_i, m), that continue what a field, shape (n, m), holds before this part."""
        return continued(self.factor, self.held.springs, self.held.pulls(field))

    def difference(self, wanted: Matrix, field: Matrix) -> Matrix:
        """Coefficients, shape (c_i, m), of what a field is wanted to be here less what the parts before let expect."""
        return project(self.basis, wanted[self.vertices] - self.extend(field), self.basis.shape[1])

    def place(self, field: Matrix, difference: Matrix) -> None:
        """Fill this part of a field from its difference to the extension, shape (c_i, m)."""
        field[self.vertices] = self.extend(field) + reconstruct(self.basis, difference)


def differences(parts: tuple[Part, ...], field: Matrix) -> list[Matrix]:
    """Of all parts, in their order."""
    return [part.difference(field, field) for part in parts]


def build_dictionaries(
    blocks: Blocks,
    faces: Faces,
    first_frame: Positions,
    rules: ChainRules,
    *,
    width: int,
    cotangent: bool,
    threads: int | None,
    allowance: Allowance,
) -> tuple[Part, ...]:
    """The dictionary of every part, in the order of the chain, with weights from the decoded first frame.

    Parameters
    ----------
    blocks, faces
        Of the mesh; only the blocks' cores are used.
    first_frame : float64 array, shape (n, 3)
        As the decoder has it.
    rules : ChainRules
        Those of a key block are made.
    width : int
        Columns of each dictionary, at most; a part has no more of them than vertices.
    cotangent : bool
        Cotangent weights; otherwise all weights are one and `first_frame` is not looked at.
    threads : int, optional
    allowance : Allowance
        What a decoder may still do.

    Raises
    ------
    LimitError
        If this is more than that.
    """
    graph = blocks.graph
    weights = cotangent_weights(graph, faces, first_frame) if cotangent else binary_weights(graph)
    rank = np.empty(graph.size, np.int32)
    for index in range(blocks.count):
        rank[blocks.core(index)] = index

    def build(index: int) -> Part:
        size = len(blocks.core(index))
        columns = min(width, size)
        allowance.spend(block_cost(size, blocks.edges_of(index), 0))
        held = hold(graph, weights, rank, blocks.part(index))
        allowance.keep(part_memory(held.laplacian.fronts, columns))
        allowance.spend(2.0 * factor_cost(held.laplacian.fronts))
        with allowance.hold(block_memory(held.laplacian, columns)):
            suspended = Suspended(held.laplacian, held.springs, rules.shift)
            basis = key_dictionary(rules, suspended, columns, allowance.spend)
        return Part(held, Suspended(held.laplacian, held.springs, TETHER).factor, basis)

    return tuple(ordered_map(build, range(blocks.count), threads))
