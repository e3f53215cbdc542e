"""Recursive bisection of a graph: one integer-only rule that gives the partition and the order of rows in a block.

A set of vertices lies between two ends, low and high, that are far apart. It is sorted by distance to the low end
minus distance to the high end and cut in two. Each half keeps the end it contains, and the distances to it; its
other end is the vertex farthest from that one, and one breadth-first sweep gives the distances to it. Cut into k
parts this is a partition that needs no bits; cut down to a few vertices it is an order in which row r means about
the same place in every block, which is what makes the subspace of one block a good start for the next.
"""

from __future__ import annotations

import numpy as np

from bsm.bitstream.errors import OptionError
from bsm.codec import _kernels
from bsm.codec.arrays import Indices
from bsm.codec.geometry.graph import Graph
from bsm.codec.threads import available_threads, side_by_side

WORTH_A_THREAD = 8192
"""Vertices of a graph from which on a second thread gains more than it costs."""


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
