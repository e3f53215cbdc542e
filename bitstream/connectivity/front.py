"""The front of the conquest: closed polygons of nodes, each node one visit of a vertex, and buckets by free degree.

A node stands for a vertex on the border of what is conquered; its *free degree* is the number of the vertex's edges
that lie in the unconquered wedge at that place. The polygon edge from a node to its next node is a *gate*: on its other
side lies an unconquered triangle. The node with the least free degree goes first, and among equals the earliest:
breadth first, so that the front seldom meets itself.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int32]

_NODE_COLUMNS = 8
_BUCKETS = 8
_MADE, _ALIVE, _TAILS = _BUCKETS, _BUCKETS + 1, _BUCKETS + 2


class Front(NamedTuple):
    """Polygons that bound the conquered faces."""

    nodes: Ints
    heads: Ints


def make_front(capacity: int) -> Front:
    """An empty front for at most `capacity` nodes."""
    heads = np.full(_TAILS + _BUCKETS, -1, np.int32)
    heads[_MADE] = heads[_ALIVE] = 0
    return Front(np.empty((capacity, _NODE_COLUMNS), np.int32), heads)


def enlarge_front(front: Front) -> Front:
    """A front with twice the capacity."""
    return Front(np.concatenate([front.nodes, np.empty_like(front.nodes)]), front.heads)
