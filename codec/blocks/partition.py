"""Cutting a mesh into parts: METIS, as in the paper, or a rule that both sides follow (paper, sections 4, 6.2).

The rule is recursive bisection, of integers only. A set of vertices lies between two ends, low and high, that are far
apart. It is sorted by distance to the low end minus distance to the high end and cut in two. Each half keeps the end
it contains, and the distances to it; its other end is the vertex farthest from that one, and one breadth-first sweep
gives the distances to it. Cut into k parts this is a partition that needs no bits; cut down to a few vertices it is an
order in which row r means about the same place in every block, which is what makes the subspace of one block a good
start for the next.
"""

from dataclasses import dataclass

import numpy as np

from bsm.bitstream.errors import OptionError
from bsm.bitstream.extras import imported
from bsm.codec import _kernels
from bsm.codec.arrays import Indices
from bsm.codec.geometry.graph import Graph
from bsm.codec.geometry.welding import group_rows
from bsm.codec.threads import available_threads, side_by_side

WORTH_A_THREAD = 8192  # vertices of a graph from which on a second thread gains more than it costs


def bisect(graph: Graph, parts: int, threads: int | None = 1) -> tuple[Indices, Indices]:
    """Cut a graph into parts whose sizes differ by as little as proportional halving allows."""
    order, bounds = np.empty(graph.size, np.int32), np.empty(parts + 1, np.int32)
    scratch = np.empty(_kernels.bisection_scratch(graph.size), np.uint32)
    arrays = graph.offsets, graph.neighbours, order, bounds
    if parts > 1 and graph.size >= WORTH_A_THREAD and (threads or available_threads()) > 1:
        second = np.empty_like(scratch)
        done = _kernels.bisect_once(*arrays, scratch, second) and all(
            side_by_side(
                lambda: _kernels.bisect_half(*arrays, 0, scratch), lambda: _kernels.bisect_half(*arrays, 1, second)
            )
        )
    else:
        done = _kernels.bisect(*arrays, scratch)
    if not done:
        raise OptionError(f"{graph.size} vertices cannot be cut into {parts} parts")
    return order, bounds


REFINEMENT_PASSES = 2  # how often the derived partition goes over its boundaries; part of the format


@dataclass(frozen=True, eq=False)
class Partition:
    """Disjoint, non-empty parts that cover a graph."""

    order: Indices
    bounds: Indices
    labels: Indices

    @property
    def parts(self) -> int:
        return len(self.bounds) - 1


def partition_of_labels(labels: Indices) -> Partition:
    """Partition whose parts are the distinct labels, shape (n,), numbered by the first vertex that has them."""
    return _grouped(group_rows(labels.astype(np.int64)[:, None]))


def derive_partition(graph: Graph, parts: int, threads: int | None = 1) -> Partition:
    """Recursive bisection, then two passes that move boundary vertices to where most of their neighbours are."""
    order, bounds = bisect(graph, parts, threads)
    labels = np.empty(graph.size, np.int32)
    _kernels.label_parts(order, bounds, labels)
    sizes, votes = np.empty(parts, np.int64), np.empty(parts, np.int32)
    _kernels.refine_partition(graph.offsets, graph.neighbours, labels, REFINEMENT_PASSES, sizes, votes)
    return _grouped(labels)


def metis_partition(graph: Graph, parts: int) -> Partition:
    """METIS k-way partition; its labels differ between builds, so a stream has to carry them."""
    pymetis = imported("pymetis", "METIS is not installed", "denoise")
    if parts == 1:
        return partition_of_labels(np.zeros(graph.size, np.int32))
    adjacency = pymetis.CSRAdjacency(graph.offsets, graph.neighbours)
    _, labels = pymetis.part_graph(parts, adjacency)
    return partition_of_labels(np.asarray(labels, dtype=np.int32))


def _grouped(labels: Indices) -> Partition:
    order, bounds = np.empty(len(labels), np.int32), np.empty(int(labels.max()) + 2, np.int32)
    _kernels.group_by_label(labels, bounds, order)
    return Partition(order, bounds, labels)
