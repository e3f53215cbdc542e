"""Edges weighed by geometry that both sides already know: the decoded first frame of a sequence.

The paper's Laplacian is the binary one because a decoder knows connectivity only. The frames of a sequence are
different: once one of them is decoded, the others may be transformed in a basis that knows the shape of the triangles.
Decoders know that frame to rounding, so that the weights are smooth functions of it which make little of little: soft
cotangents, whose denominators stay away from zero, within soft bounds above zero (cotangents may be negative, and L
indefinite, where a triangle is obtuse).

References
----------
U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates", 1993, section 4.
"""

from dataclasses import dataclass

import numpy as np

from bsm.bitstream.errors import NumericError
from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Indices, Matrix, Positions
from bsm.codec.basis.laplacian import Laplacian, weighted_laplacian
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import Graph

FLATNESS = 2.0**-12  # share of the squared sum of squared sides that is added to a triangle's squared doubled area
SMALLNESS = 2.0**-48  # what else is added to it: the square of the area that counts as none, in BSM units
SMALLEST_WEIGHT, LARGEST_WEIGHT = 2.0**-5, 8.0  # soft bounds of a weight: it is above the first, and below their sum
BEND = 2.0**-6  # how softly negative sums of cotangents become zero


def cotangent_weights(graph: Graph, faces: Faces, positions: Positions) -> Matrix:
    """Weight of every entry of `graph.neighbours`: half the cotangents opposite to the edge, softly bounded."""
    if positions.shape != (graph.size, 3):
        raise ValueError(f"positions of shape {positions.shape} for {graph.size} vertices")
    sums = np.zeros(len(graph.neighbours))
    positions = np.ascontiguousarray(positions)
    _kernels.cotangents(graph.offsets, graph.neighbours, faces, positions, FLATNESS, SMALLNESS, sums)
    if not np.isfinite(sums).all():
        raise NumericError("the first frame is too large for weights of its edges")
    positive = 0.5 * (sums + np.sqrt(sums * sums + BEND))
    return SMALLEST_WEIGHT + LARGEST_WEIGHT * positive / (LARGEST_WEIGHT + positive)


@dataclass(frozen=True, eq=False)
class Held:
    """A part that hangs, by springs, on what is known before it: its edges to those parts."""

    laplacian: Laplacian
    springs: Matrix
    starts: Indices
    around: Indices
    outer: Indices
    stiffness: Matrix

    def pulls(self, ends: Matrix) -> Matrix:
        """Sum of stiffness times what a field is at the other end, for each row: shape (n_i, m)."""
        pulls = np.empty((len(self.springs), ends.shape[1]))
        _kernels.pull(self.starts, self.outer, self.stiffness, np.ascontiguousarray(ends), pulls)
        return pulls


def hold(graph: Graph, weights: Matrix, rank: Indices, block: Block) -> Held:
    """Hang a part on the parts before it."""
    if len(weights) != len(graph.neighbours) or len(rank) != graph.size:
        raise ValueError(f"{len(weights)} weights and {len(rank)} ranks for a graph of {graph.size} vertices")
    vertices = block.vertices
    room = int((graph.offsets[vertices + 1] - graph.offsets[vertices]).sum())
    inner, springs = np.empty(len(block.neighbours)), np.empty(block.size)
    starts, outer, stiffness = np.empty(block.size + 1, np.int32), np.empty(room, np.int32), np.empty(room)
    given = graph.offsets, graph.neighbours, weights, rank, vertices, block.offsets, block.neighbours
    count = _kernels.hold(*given, inner, springs, starts, outer, stiffness)
    around, ends = np.unique(outer[:count], return_inverse=True)
    laplacian = weighted_laplacian(block, inner)
    return Held(laplacian, springs, starts, around, ends.astype(np.int32), stiffness[:count].copy())
