"""A mesh cut into parts and overlapping blocks, in a chain; the blend of copies of a vertex (paper, sections 4 and 6).

Each part of the partition is grown by breadth-first rings into its neighbors until it holds n_d vertices; the blocks
are visited along a chain in which each lies beside its predecessor where the mesh allows it; and the rows of each block
are brought into the order of a full bisection, so that row r means about the same place in every block.

The rule, which both sides follow, is recursive bisection, of integers only. A set of vertices lies between two ends,
low and high, that are far apart. It is sorted by distance to the low end minus distance to the high end and cut in two.
Each half keeps the end it contains, and the distances to it; its other end is the vertex farthest from that one, and
one breadth-first sweep gives the distances to it. Cut into k parts this is a partition that needs no bits; cut down to
a few vertices it is an order in which row r means about the same place in every block, which is what makes the subspace
of one block a good start for the next.
"""

import importlib.util
from dataclasses import dataclass, field

import numpy as np

from bsm._core import Cut
from bsm._core import codec as _kernels
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Basis, Indices, Matrix, Order
from bsm.codec.geometry.graph import Graph
from bsm.codec.geometry.welding import group_rows

# Asked for without loading it: few streams use METIS, and every start would pay.
# PyPI lacks it for Windows and for Linux on arm64.
HAS_METIS = importlib.util.find_spec("pymetis") is not None


@dataclass(frozen=True, eq=False)
class Partition:
    """Disjoint, non-empty parts that cover a graph."""

    labels: Indices

    @cached_property
    def sizes(self) -> Order:
        """Vertices of each part."""
        return np.bincount(self.labels)

    @property
    def parts(self) -> int:
        return len(self.sizes)


def partition_of_labels(labels: Indices) -> Partition:
    """Partition whose parts are the distinct labels, shape (n,), numbered by the first vertex that has them."""
    # Numbered by first vertices, so that any program that finds the same parts sends the same labels.
    return Partition(group_rows(labels.astype(np.int64)[:, None]))


def derive_partition(graph: Graph, parts: int) -> Partition:
    """Recursive bisection, then two passes that move boundary vertices to where most of their neighbors are."""
    return Partition(Cut(graph.offsets, graph.neighbors).labels(parts))


def metis_partition(graph: Graph, parts: int) -> Partition:
    """METIS k-way partition, or the derived one without METIS; labels differ, so a stream has to carry them."""
    # Streams carry their labels in this mode, so any cut decodes. Only the rate differs.
    if parts == 1 or not HAS_METIS:
        return partition_of_labels(derive_partition(graph, parts).labels)
    metis = importlib.import_module("pymetis")
    _, labels = metis.part_graph(parts, metis.CSRAdjacency(graph.offsets, graph.neighbors))
    return partition_of_labels(np.asarray(labels, dtype=np.int32))


@dataclass(frozen=True, eq=False)
class Block:
    """One overlapping block: its vertices in row order, and the graph among them in row numbers."""

    vertices: Indices
    offsets: Indices
    neighbors: Indices

    @property
    def size(self) -> int:
        return len(self.vertices)

    # A vertex in the middle of a block counts more than one at its rim, where the dictionary knows little.
    @cached_property
    def degrees(self) -> Indices:
        """Neighbors of each row inside the block, shape (n_i,): the weights of the blend."""
        return self.offsets[1:] - self.offsets[:-1]

    def iterated(
        self,
        start: Matrix | Basis,
        shift: float,
        power: int = 1,
        iterations: int = 1,
        apart: int = 0,
    ) -> Basis:
        """U of L + `shift` after orthogonal iterations from a start, shape (n_i, c)."""
        cut, begin = Cut(self.offsets, self.neighbors), np.ascontiguousarray(start, np.float32)
        return cut.iterate(shift, begin, power, iterations, apart)


@dataclass(frozen=True, eq=False)
class Blocks:
    """All blocks of a mesh, or of a section of one, in the order of the chain."""

    graph: Graph
    cores: Indices
    starts: Order
    edges: Order
    members: Indices
    exact: dict[int, Basis] = field(default_factory=dict, init=False, repr=False)
    """Exact bases of blocks, as wide as they were made (`codec/signal/chain.py`)."""

    @property
    def count(self) -> int:
        return len(self.cores)

    def members_of(self, index: int) -> Indices:
        """Vertices of one block, shape (n_i,), in the order in which they were found."""
        return self.members[self.starts[index] : self.starts[index + 1]]

    def block(self, index: int) -> Block:
        return Block(*Cut(self.graph.offsets, self.graph.neighbors).rows(self.members_of(index)))


def block_size(partition: Partition, overlap: float) -> int:
    """n_d: `overlap` times the largest part, rounded, at most the number of vertices."""
    largest = int(partition.sizes.max())
    # One size for all blocks, since dictionaries start from those before: rows must match.
    return min(len(partition.labels), max(largest, round(overlap * largest)))


def grow_blocks(graph: Graph, partition: Partition, size: int) -> Blocks:
    """Put the parts into a chain and grow each by breadth-first rings to `size` vertices (n_d)."""
    cut = Cut(graph.offsets, graph.neighbors)
    return Blocks(graph, *cut.blocks(partition.labels, partition.parts, size))


class Blend:
    """Weighted sums over the copies of each of n vertices."""

    def __init__(self, vertices: int) -> None:
        # Zeros cost memory only where they are touched.
        self.sums: Matrix = np.zeros((vertices, 3))
        self.weights: Matrix = np.zeros(vertices)

    def add(self, vertices: Indices, positions: Matrix, weights: Matrix) -> None:
        """Add one copy of each vertex in `vertices`, shape (n_i,), at `positions`, shape (n_i, 3)."""
        _kernels.add_copies(self.sums, self.weights, vertices, positions, weights)

    def all_positions(self) -> Matrix:
        """Weighted averages of all vertices, all of them known, shape (n, 3)."""
        # A weighted mean and not a choice of one copy, so that no step shows where blocks meet.
        return self.sums / self.weights[:, None]
