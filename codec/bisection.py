"""Recursive bisection of a graph: one integer-only rule that gives the partition and the order of rows in a block.

A set of vertices is laid out between two vertices b and a that are far apart, by distance to b minus distance to
a, and cut in two; each half is laid out and cut in the same way. Cut into k parts it is a partition that needs no
bits; cut down to single vertices it is an order in which row r means about the same place in every block, which is
what makes the subspace of one block a good start for the next.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from codec.graph import Graph, Indices


def bisect(graph: Graph, parts: int) -> tuple[Indices, Indices]:
    """Cut a graph into parts whose sizes differ by as little as proportional halving allows.

    Parameters
    ----------
    graph : Graph
        On n vertices.
    parts : int
        From 1 to n.

    Returns
    -------
    order : int32 array, shape (n,)
        The vertices, part after part.
    bounds : int32 array, shape (parts + 1,)
        Part p is `order[bounds[p]:bounds[p + 1]]`.
    """
    return bisect_csr(graph.offsets, graph.neighbours, parts)


@njit(cache=True, nogil=True)
def bisect_csr(offsets, neighbours, parts):  # type: ignore[no-untyped-def]
    """Compiled body of `bisect`."""
    n = len(offsets) - 1
    order = np.arange(n, dtype=np.int32)
    bounds = np.zeros(parts + 1, np.int32)
    bounds[parts] = n
    owner = np.zeros(n, np.int32)
    seen = np.zeros(n, np.int32)
    near = np.empty(n, np.int32)
    far = np.empty(n, np.int32)
    queue = np.empty(n, np.int32)
    stack = np.empty((128, 4), np.int64)
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = 0, n, 0, parts
    depth = 1
    stamp = 0
    while depth > 0:
        depth -= 1
        first, last, part, count = stack[depth, 0], stack[depth, 1], stack[depth, 2], stack[depth, 3]
        if count == 1:
            continue
        if last - first > 2:
            stamp = _lay_out(offsets, neighbours, order, first, last, owner, seen, stamp, near, far, queue)
        half = count // 2
        cut = first + (last - first) * half // count
        bounds[part + half] = cut
        for i in range(cut, last):
            owner[order[i]] = cut
        stack[depth, 0], stack[depth, 1], stack[depth, 2], stack[depth, 3] = cut, last, part + half, count - half
        depth += 1
        stack[depth, 0], stack[depth, 1], stack[depth, 2], stack[depth, 3] = first, cut, part, half
        depth += 1
    return order, bounds


@njit(cache=True, nogil=True)
def _lay_out(offsets, neighbours, order, first, last, owner, seen, stamp, near, far, queue):  # type: ignore[no-untyped-def]
    """Reorder one segment of `order`, component after component; returns the last stamp used."""
    segment = owner[order[first]]
    done = first
    # The components of the segment are taken in the order of their first vertices; `pending` keeps that order
    # while `order` is being rewritten.
    pending = order[first:last].copy()
    start_stamp = stamp
    for p in range(last - first):
        if seen[pending[p]] > start_stamp:
            continue
        stamp += 1
        count = _distances(offsets, neighbours, owner, segment, pending[p], seen, stamp, far, queue)
        a = queue[count - 1]
        stamp += 1
        _distances(offsets, neighbours, owner, segment, a, seen, stamp, far, queue)
        b = queue[count - 1]
        span = far[b]
        stamp += 1
        _distances(offsets, neighbours, owner, segment, b, seen, stamp, near, queue)
        buckets = np.zeros(2 * span + 2, np.int32)
        for i in range(count):
            buckets[near[queue[i]] - far[queue[i]] + span + 1] += 1
        for i in range(2 * span + 1):
            buckets[i + 1] += buckets[i]
        for i in range(count):
            key = near[queue[i]] - far[queue[i]] + span
            order[done + buckets[key]] = queue[i]
            buckets[key] += 1
        done += count
    return stamp


@njit(cache=True, nogil=True)
def _distances(offsets, neighbours, owner, segment, start, seen, stamp, distance, queue):  # type: ignore[no-untyped-def]
    """Breadth-first distances from `start` within its segment; returns how many vertices `queue` holds."""
    queue[0] = start
    seen[start] = stamp
    distance[start] = 0
    head, tail = 0, 1
    while head < tail:
        v = queue[head]
        head += 1
        for i in range(offsets[v], offsets[v + 1]):
            w = neighbours[i]
            if seen[w] != stamp and owner[w] == segment:
                seen[w] = stamp
                distance[w] = distance[v] + 1
                queue[tail] = w
                tail += 1
    return tail
