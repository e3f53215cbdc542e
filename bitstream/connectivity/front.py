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

from bitstream.entropy.range_coder import leaf

Ints = npt.NDArray[np.int32]

VERTEX, FREE, NEXT, PREVIOUS, GATE, APEX, UP, DOWN = range(8)
"""Columns of a node: vertex, free degree, neighbours in the polygon, half-edge on the far side of the gate (encoder
only), vertex behind the gate, and links within the bucket."""

DEAD = -1
BUCKETS = 8
MADE, ALIVE, _TAILS = BUCKETS, BUCKETS + 1, BUCKETS + 2


class Front(NamedTuple):
    """All polygons.

    Attributes
    ----------
    nodes : int32 array, shape (capacity, 8)
        One row per node, columns as above; FREE is DEAD for a node that was closed.
    heads : int32 array, shape (2 * BUCKETS + 2,)
        First node of each bucket or -1; MADE, the number of nodes made; ALIVE, of those not closed; last nodes.
    """

    nodes: Ints
    heads: Ints


def make_front(capacity: int) -> Front:
    """An empty front for at most `capacity` nodes."""
    heads = np.full(_TAILS + BUCKETS, -1, np.int32)
    heads[MADE] = heads[ALIVE] = 0
    return Front(np.empty((capacity, 8), np.int32), heads)


def enlarge_front(front: Front) -> Front:
    """The same front with twice the capacity."""
    return Front(np.concatenate([front.nodes, np.empty_like(front.nodes)]), front.heads)


@leaf
def add_node(front: Front, vertex: int, free: int) -> int:
    """Make a node that is not linked to any other yet and has no gate."""
    nodes, heads = front
    node = heads[MADE]
    heads[MADE] += 1
    heads[ALIVE] += 1
    nodes[node, VERTEX] = vertex
    nodes[node, FREE] = free
    nodes[node, APEX] = vertex
    nodes[node, GATE] = 0
    _enter_bucket(front, node)
    return node


@leaf
def link_nodes(front: Front, node: int, following: int) -> None:
    """Make a polygon edge."""
    front.nodes[node, NEXT] = following
    front.nodes[following, PREVIOUS] = node


@leaf
def set_free(front: Front, node: int, free: int) -> None:
    """Change the free degree; DEAD closes the node."""
    _leave_bucket(front, node)
    front.nodes[node, FREE] = free
    if free == DEAD:
        front.heads[ALIVE] -= 1
    else:
        _enter_bucket(front, node)


@leaf
def first_node(front: Front) -> int:
    """The node to go on with, -1 if there is none."""
    for bucket in range(BUCKETS):
        if front.heads[bucket] >= 0:
            return front.heads[bucket]
    return -1


@leaf
def _bucket(free: int) -> int:
    return min(free, BUCKETS - 1)


@leaf
def _enter_bucket(front: Front, node: int) -> None:
    nodes, heads = front
    bucket = _bucket(nodes[node, FREE])
    last = heads[_TAILS + bucket]
    nodes[node, UP] = last
    nodes[node, DOWN] = -1
    if last >= 0:
        nodes[last, DOWN] = node
    else:
        heads[bucket] = node
    heads[_TAILS + bucket] = node


@leaf
def _leave_bucket(front: Front, node: int) -> None:
    nodes, heads = front
    bucket, up, down = _bucket(nodes[node, FREE]), nodes[node, UP], nodes[node, DOWN]
    if up >= 0:
        nodes[up, DOWN] = down
    else:
        heads[bucket] = down
    if down >= 0:
        nodes[down, UP] = up
    else:
        heads[_TAILS + bucket] = up
