"""The dictionaries of a sequence, built once, and the way between vertices and coefficients.

The parts of the mesh are taken in the order of the chain, without overlap. Each hangs with springs on the parts before
it, where they have a common edge: the harmonic extension of what is known there is its prediction, the lowest
eigenvectors of its held Laplacian L + S are its dictionary, and what is coded is the difference from the extension (see
`codec.signal.predict`; here edges have weights, and the extension is computed in the dictionary, where it costs little:
U^T (L + S)^-1 y = diag(1 / lambda) U^T y). All of this is linear, so that it may be applied to positions, to
differences of frames and to components of trajectories alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from codec.arrays import Faces, Indices, Matrix, Positions
from codec.basis.orthogonal_iteration import canonical_eigenvectors
from codec.basis.weighted import binary_weights, cotangent_weights, held_laplacian
from codec.blocks.overlap import Blocks
from codec.threads import ordered_map

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix


FREE = 1e-8
"""A column whose eigenvalue is below hangs on nothing, and is not extended."""


@dataclass(frozen=True, eq=False)
class Part:
    """A part of the mesh and its dictionary.

    Parameters
    ----------
    vertices : int32 array, shape (n_i,)
        Ascending.
    basis : float64 array, shape (n_i, c_i)
        U, orthonormal columns.
    springs : csr_matrix, shape (b, n)
        Weights between the rows that hang on known vertices, and these.
    extension : float64 array, shape (c_i, b)
        Coefficients of the extension for given pulls at these rows.
    """

    vertices: Indices
    basis: Matrix
    springs: csr_matrix
    extension: Matrix

    def extend(self, field: Matrix) -> Matrix:
        """Coefficients, shape (c_i, m), that continue what a field, shape (n, m), holds before this part."""
        return np.asarray(self.extension @ (self.springs @ field))

    def difference(self, field: Matrix) -> Matrix:
        """Coefficients of a known field, shape (n, m), less those of its extension."""
        return np.asarray(self.basis.T @ field[self.vertices]) - self.extend(field)

    def place(self, field: Matrix, difference: Matrix) -> None:
        """Fill this part of a field from its difference to the extension, shape (c_i, m)."""
        field[self.vertices] = self.basis @ (difference + self.extend(field))


def differences(parts: tuple[Part, ...], field: Matrix) -> list[Matrix]:
    """Of all parts, in their order."""
    return [part.difference(field) for part in parts]


def build_dictionaries(
    blocks: Blocks, faces: Faces, first_frame: Positions, width: int, cotangent: bool, threads: int | None
) -> tuple[Part, ...]:
    """The exact eigenbasis of every part, in the order of the chain, with weights from the decoded first frame.

    Parameters
    ----------
    blocks, faces
        Of the mesh; only the blocks' cores are used.
    first_frame : float64 array, shape (n, 3)
        As the decoder has it.
    width : int
        Columns of each dictionary, at most; a part has no more of them than vertices.
    cotangent : bool
        Cotangent weights; otherwise all weights are one and `first_frame` is not looked at.
    threads : int, optional
    """
    # Not needed by static meshes, whose decoding it would delay.
    from scipy.sparse import csr_matrix

    graph = blocks.graph
    weights = cotangent_weights(graph, faces, first_frame) if cotangent else binary_weights(graph)
    cores = [np.sort(blocks.core(index)) for index in range(blocks.count)]
    rank = np.empty(graph.size, np.int32)
    for index, vertices in enumerate(cores):
        rank[vertices] = index

    def build(vertices: Indices) -> Part:
        held = held_laplacian(graph, weights, vertices, rank)
        values, basis = canonical_eigenvectors(held.matrix, min(width, len(vertices)))
        rows, which = np.unique(held.rows, return_inverse=True)
        springs = csr_matrix((held.weights, (which, held.outer)), shape=(len(rows), graph.size))
        inverse = np.where(values > FREE, 1.0 / np.maximum(values, FREE), 0.0)
        return Part(vertices, basis, springs, np.ascontiguousarray(basis[rows].T * inverse[:, None]))

    return tuple(ordered_map(build, cores, threads))
