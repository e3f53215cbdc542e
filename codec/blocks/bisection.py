"""Recursive bisection of a graph: one integer-only rule that gives the partition and the order of rows in a block.

A set of vertices lies between two ends, low and high, that are far apart. It is sorted by distance to the low end
minus distance to the high end and cut in two. Each half keeps the end it contains, and the distances to it; its
other end is the vertex farthest from that one, and one breadth-first sweep gives the distances to it. Cut into k
parts this is a partition that needs no bits; cut down to a few vertices it is an order in which row r means about
the same place in every block, which is what makes the subspace of one block a good start for the next.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from codec.geometry.graph import Graph, Indices

LEAF = 8
"""Segments of at most so many vertices keep the order they have; part of the format."""

_ONE = np.uint64(1)


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
    # Indices are unsigned in all inner loops: compiled code then need not provide for negative ones.
    offsets, neighbours = offsets.view(np.uint32), neighbours.view(np.uint32)
    n = len(offsets) - 1
    order = np.empty(n, np.uint32)
    for v in range(n):
        order[v] = v
    bounds = np.zeros(parts + 1, np.int32)
    bounds[parts] = n
    colours = np.zeros(n, np.uint32)
    # distances[0] are those to the low end of the segment that a vertex is in, distances[1] those to the high end.
    distances = np.empty((2, n), np.int32)
    queue = np.empty(n + 1, np.uint32)
    keys = np.empty(n, np.uint32)
    buckets = np.empty(8 * n + 4, np.uint32)
    # Segments to be cut: first, last, number of the first part, parts, kept end.
    stack = np.empty((64, 5), np.int64)
    stack[0] = (0, n, 0, parts, 0)
    # The low end of the whole is the vertex that a sweep from vertex 0 reaches last.
    if n > LEAF:
        _sweep(offsets, neighbours, order, np.uint32(0), colours, distances[1], queue)
        _sweep(offsets, neighbours, order, queue[np.uint64(n - 1)], colours, distances[0], queue)
    colour = np.uint32(2)
    depth = 1
    while depth > 0:
        depth -= 1
        first, last, part, count, kept = stack[depth]
        if count == 1:
            continue
        segment = order[first:last]
        if len(segment) > LEAF:
            far = _farthest(segment, distances[kept])
            _sweep(offsets, neighbours, segment, far, colours, distances[1 - kept], queue)
            _sort(segment, distances[0], distances[1], queue, keys, buckets)
        half = count // 2
        cut = first + (last - first) * half // count
        bounds[part + half] = cut
        stack[depth] = (cut, last, part + half, count - half, 1)
        stack[depth + 1] = (first, cut, part, half, 0)
        depth += 2
        colour += np.uint32(4)
        for v in order[first:cut]:
            colours[v] = colour
        for v in order[cut:last]:
            colours[v] = colour + np.uint32(2)
    return order.view(np.int32), bounds


@njit(cache=True, nogil=True)
def _farthest(segment, distance):  # type: ignore[no-untyped-def]
    """The first of the vertices that are farthest away."""
    far = segment[0]
    for v in segment:
        if distance[v] > distance[far]:
            far = v
    return far


@njit(cache=True, nogil=True)
def _sweep(offsets, neighbours, segment, start, colours, distance, queue):  # type: ignore[no-untyped-def]
    """Breadth-first distances from `start` within a segment; `queue` gets its vertices in the order of discovery.

    The vertices of a segment share a colour, which the sweep raises by one. Where it comes to an end before all are
    found, it goes on, one step farther away, from the last vertex of the segment that is still missing.
    """
    colour = colours[start]
    colours[start] = colour + np.uint32(1)
    queue[0] = start
    head, tail, size = np.uint64(0), _ONE, np.uint64(len(segment))
    missing = size
    level = 0
    while True:
        end = tail
        while head < end:
            v = queue[head]
            head += _ONE
            distance[v] = level
            for i in range(offsets[v], offsets[v + _ONE]):
                # Without a branch, which the processor could not predict: what is not new is overwritten.
                w = neighbours[i]
                new = np.uint32(colours[w] == colour)
                colours[w] += new
                queue[tail] = w
                tail += new
        level += 1
        if tail == end:
            if tail == size:
                break
            missing -= _ONE
            while colours[segment[missing]] != colour:
                missing -= _ONE
            queue[tail] = segment[missing]
            colours[segment[missing]] += np.uint32(1)
            tail += _ONE


@njit(cache=True, nogil=True)
def _sort(segment, low, high, queue, keys, buckets):  # type: ignore[no-untyped-def]
    """Sort a segment by distance to its low end minus distance to its high end, ties by place in `queue`."""
    size = np.uint64(len(segment))
    least, most = low[queue[0]] - high[queue[0]], low[queue[0]] - high[queue[0]]
    for i in range(size):
        difference = low[queue[i]] - high[queue[i]]
        least, most = min(least, difference), max(most, difference)
    for i in range(size):
        keys[queue[i]] = low[queue[i]] - high[queue[i]] - least
    # Counting sort, in one pass unless there are far more values than vertices.
    bits = 1
    while (most - least) >> bits > 0 and size << np.uint64(2) >> np.uint64(bits) > 0:
        bits += 1
    mask = np.uint32((1 << bits) - 1)
    source, target = queue[: len(segment)], segment
    shift = np.uint32(0)
    while True:
        for k in range(np.uint64(mask) + np.uint64(2)):
            buckets[k] = 0
        for i in range(size):
            buckets[((keys[source[i]] >> shift) & mask) + _ONE] += np.uint32(1)
        for k in range(np.uint64(mask)):
            buckets[k + _ONE] += buckets[k]
        for i in range(size):
            v = source[i]
            k = (keys[v] >> shift) & mask
            target[buckets[k]] = v
            buckets[k] += np.uint32(1)
        source, target = target, source
        shift += np.uint32(bits)
        if np.uint32(most - least) >> shift == 0:
            break
    segment[:] = source
