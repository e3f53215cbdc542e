"""The dictionaries of all blocks of a sequence, built once, and the way between vertices and coefficients."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from codec.blend import degree_weights
from codec.blocks import Block, Blocks
from codec.mesh import Faces, Positions
from codec.parallel import ordered_map
from codec.weighted import binary_weights, cotangent_weights, weighted_basis

Matrix = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Dictionaries:
    """Orthonormal columns for every block of a mesh.

    Parameters
    ----------
    blocks : tuple of Block
    bases : tuple of float64 arrays, shapes (n_i, c_i)
    weights : float64 array, shape (n,)
        Sum of the blending weights of each vertex over its copies.
    """

    blocks: tuple[Block, ...]
    bases: tuple[Matrix, ...]
    weights: Matrix

    @property
    def rows(self) -> list[int]:
        """c_i of each block."""
        return [basis.shape[1] for basis in self.bases]

    def analyse(self, field: Matrix, threads: int | None = 1) -> list[Matrix]:
        """Coefficients of a field over the vertices, shape (n, m): one array of shape (c_i, m) per block."""
        pairs = zip(self.blocks, self.bases)
        return list(ordered_map(lambda pair: pair[1].T @ field[pair[0].vertices], pairs, threads))

    def synthesise(self, coefficients: Sequence[Matrix]) -> Matrix:
        """Field of given coefficients, the copies of a vertex blended by its degree in their blocks; shape (n, m)."""
        field = np.zeros((len(self.weights), coefficients[0].shape[1]))
        for block, basis, values in zip(self.blocks, self.bases, coefficients):
            share = degree_weights(block.degrees) / self.weights[block.vertices]
            field[block.vertices] += (basis * share[:, None]) @ values
        return field


def build_dictionaries(
    blocks: Blocks, faces: Faces, first_frame: Positions, width: int, cotangent: bool, threads: int | None
) -> Dictionaries:
    """The exact eigenbasis of every block, with weights from the decoded first frame.

    Parameters
    ----------
    blocks, faces
        Of the mesh.
    first_frame : float64 array, shape (n, 3)
        As the decoder has it.
    width : int
        Columns of each dictionary, at most; a block has no more of them than vertices.
    cotangent : bool
        Cotangent weights; otherwise all weights are one and `first_frame` is not looked at.
    threads : int, optional
    """
    graph = blocks.graph
    weights = cotangent_weights(graph, faces, first_frame) if cotangent else binary_weights(graph)
    members = tuple(blocks.block(index) for index in range(blocks.count))
    bases = ordered_map(lambda b: weighted_basis(graph, weights, b, min(width, b.size)), members, threads)
    total = np.zeros(graph.size)
    for block in members:
        total[block.vertices] += degree_weights(block.degrees)
    return Dictionaries(members, tuple(bases), total)
