"""Overlapping blocks of equal size, in a chain (paper, sections 4, 6.1 and 6.3).

Each part of the partition is grown by breadth-first rings into its neighbours until it holds n_d vertices; the blocks
are visited along a chain in which each lies beside its predecessor where the mesh allows it; and the rows of each
block are brought into the order of a full bisection, so that row r means about the same place in every block.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.basis.solver.fronts import Fronts, find_fronts
from codec.blocks.bisection import bisect_csr
from codec.blocks.partition import Partition
from codec.geometry.graph import Graph, Indices

_FREE = np.uint32(0xFFFFFFFF)


@dataclass(frozen=True, eq=False)
class Block:
    """One overlapping block: its vertices in row order, and the graph among them in row numbers.

    Parameters
    ----------
    vertices : int32 array, shape (n_i,)
        Vertex of the mesh behind each row.
    offsets, neighbours : int32 arrays
        The block's own graph, CSR, in row numbers.
    """

    vertices: Indices
    offsets: Indices
    neighbours: Indices

    @property
    def size(self) -> int:
        """Number of rows n_i."""
        return len(self.vertices)

    @cached_property
    def degrees(self) -> Indices:
        """Neighbours of each row inside the block: the weights of the blend."""
        return np.diff(self.offsets)

    @cached_property
    def fronts(self) -> Fronts:
        """How matrices with the block's pattern are factorised."""
        return find_fronts(self.offsets, self.neighbours)


@dataclass(frozen=True, eq=False)
class Blocks:
    """All blocks of a mesh, in the order of the chain.

    Parameters
    ----------
    graph : Graph
        Of the whole mesh.
    chain : int32 array, shape (k,)
        Part of the partition that each block grew from.
    cores : int32 array, shape (k,)
        Size of that part; the first `cores[i]` entries of a block's `members` are the part itself.
    starts : int64 array, shape (k + 1,)
    members : int32 array
        Vertices of block i, as they were found: `members[starts[i]:starts[i + 1]]`.
    """

    graph: Graph
    chain: Indices
    cores: Indices
    starts: npt.NDArray[np.int64]
    members: Indices

    @property
    def count(self) -> int:
        """Number of blocks k."""
        return len(self.chain)

    def members_of(self, index: int) -> Indices:
        """Vertices of one block in the order in which they were found."""
        return self.members[self.starts[index] : self.starts[index + 1]]

    def block(self, index: int) -> Block:
        """Order the rows of one block."""
        return Block(*_ordered(self.graph.offsets, self.graph.neighbours, self.members_of(index)))

    def core(self, index: int) -> Indices:
        """Vertices of the part that one block grew from."""
        return self.members[self.starts[index] : self.starts[index] + self.cores[index]]


def block_size(partition: Partition, overlap: float) -> int:
    """n_d: `overlap` times the largest part, rounded, at most the number of vertices."""
    largest = int(np.diff(partition.bounds).max())
    return min(len(partition.order), max(largest, round(overlap * largest)))


def grow_blocks(graph: Graph, partition: Partition, size: int) -> Blocks:
    """Put the parts into a chain and grow each by breadth-first rings to `size` vertices (n_d).

    From part 0 on, the next part is the unvisited neighbour of the current one that shares most edges with all parts
    visited so far (ties: the lowest number). Where there is none, it is the lowest unvisited neighbour of the latest
    part that has one, and where no part has, the lowest unvisited part.

    A block does not grow over vertices with more than `size` neighbours, so that no mesh makes it look at many edges.
    A part whose surroundings hold fewer than `size` vertices that it may grow over stays smaller.
    """
    chain = _chain(graph.offsets, graph.neighbours, partition.labels, partition.parts)
    starts, members = _grow_all(graph.offsets, graph.neighbours, partition.order, partition.bounds, chain, size)
    cores = np.diff(partition.bounds)[chain]
    return Blocks(graph, chain, cores, starts, members)


@njit(cache=True, nogil=True)
def _ordered(offsets, neighbours, rows):  # type: ignore[no-untyped-def]
    local_offsets, local_neighbours = _induced(offsets, neighbours, rows)
    order, _ = bisect_csr(local_offsets, local_neighbours, len(rows))
    vertices = rows[order]
    local_offsets, local_neighbours = _permuted(local_offsets, local_neighbours, order)
    return vertices, local_offsets, local_neighbours


@njit(cache=True, nogil=True)
def _hash_slot(table, key):  # type: ignore[no-untyped-def]
    """Slot of `key` in an open-addressed table of keys (a power of two long, `_FREE` where free)."""
    mask = np.uint64(len(table) - 1)
    slot = ((np.uint64(key) * np.uint64(2654435761)) >> np.uint64(7)) & mask
    while table[slot] != key and table[slot] != _FREE:
        slot = (slot + np.uint64(1)) & mask
    return slot


@njit(cache=True, nogil=True)
def _grow_all(offsets, neighbours, order, bounds, chain, size):  # type: ignore[no-untyped-def]
    """Breadth-first from each part, neighbours in ascending order, until `size` vertices are found."""
    parts = len(chain)
    seen = np.full(len(order), -1, np.int32)
    starts = np.zeros(parts + 1, np.int64)
    members = np.empty(parts * size, np.int32)
    count = np.int64(0)
    for index in range(parts):
        head = count
        starts[index] = count
        full = count + size
        for i in range(bounds[chain[index]], bounds[chain[index] + 1]):
            members[count] = order[i]
            seen[order[i]] = index
            count += 1
        while head < count and count < full:
            v = members[head]
            head += 1
            for i in range(offsets[v], offsets[v + 1]):
                w = neighbours[i]
                if seen[w] != index and count < full and offsets[w + 1] - offsets[w] <= size:
                    seen[w] = index
                    members[count] = w
                    count += 1
    starts[parts] = count
    return starts, members[:count].copy()


@njit(cache=True, nogil=True)
def _induced(offsets, neighbours, rows):  # type: ignore[no-untyped-def]
    """Graph among the vertices `rows`, in row numbers; rows of the result are in the mesh's neighbour order."""
    offsets, neighbours, rows = offsets.view(np.uint32), neighbours.view(np.uint32), rows.view(np.uint32)
    n = len(rows)
    capacity = 16
    while capacity < 2 * n:
        capacity *= 2
    table = np.full(capacity, _FREE, np.uint32)
    number = np.empty(capacity, np.int32)
    total = 0
    for r in range(n):
        slot = _hash_slot(table, rows[r])
        table[slot] = rows[r]
        number[slot] = r
        total += offsets[rows[r] + np.uint64(1)] - offsets[rows[r]]
    local_offsets = np.empty(n + 1, np.int32)
    local_neighbours = np.empty(total + 1, np.int32)
    filled = np.uint64(0)
    local_offsets[0] = 0
    for r in range(n):
        for i in range(offsets[rows[r]], offsets[rows[r] + np.uint64(1)]):
            # Without a branch, which the processor could not predict: what is not in `rows` is overwritten.
            slot = _hash_slot(table, neighbours[i])
            local_neighbours[filled] = number[slot]
            filled += np.uint64(table[slot] != _FREE)
        local_offsets[r + 1] = filled
    return local_offsets, local_neighbours[:filled].copy()


@njit(cache=True, nogil=True)
def _permuted(offsets, neighbours, order):  # type: ignore[no-untyped-def]
    """The same graph with vertex `order[r]` called r."""
    n = len(order)
    rank = np.empty(n, np.int32)
    for r in range(n):
        rank[order[r]] = r
    new_offsets = np.empty(n + 1, np.int32)
    new_neighbours = np.empty(len(neighbours), np.int32)
    filled = 0
    new_offsets[0] = 0
    for r in range(n):
        for i in range(offsets[order[r]], offsets[order[r] + 1]):
            new_neighbours[filled] = rank[neighbours[i]]
            filled += 1
        new_offsets[r + 1] = filled
    return new_offsets, new_neighbours


@njit(cache=True, nogil=True)
def _part_graph(offsets, neighbours, labels, parts):  # type: ignore[no-untyped-def]
    """CSR of the parts, with the number of mesh edges between each two neighbouring parts."""
    n = len(offsets) - 1
    crossing = 0
    for v in range(n):
        for i in range(offsets[v], offsets[v + 1]):
            if labels[v] != labels[neighbours[i]]:
                crossing += 1
    keys = np.empty(crossing, np.int64)
    crossing = 0
    for v in range(n):
        for i in range(offsets[v], offsets[v + 1]):
            if labels[v] != labels[neighbours[i]]:
                keys[crossing] = np.int64(labels[v]) * parts + labels[neighbours[i]]
                crossing += 1
    keys.sort()
    starts = np.zeros(parts + 1, np.int64)
    ends = np.empty(crossing, np.int32)
    edges = np.zeros(crossing, np.int64)
    count = 0
    for i in range(crossing):
        if i == 0 or keys[i] != keys[i - 1]:
            ends[count] = keys[i] % parts
            starts[keys[i] // parts + 1] += 1
            count += 1
        edges[count - 1] += 1
    for p in range(parts):
        starts[p + 1] += starts[p]
    return starts, ends, edges


@njit(cache=True, nogil=True)
def _chain(offsets, neighbours, labels, parts):  # type: ignore[no-untyped-def]
    starts, ends, edges = _part_graph(offsets, neighbours, labels, parts)
    chain = np.empty(parts, np.int32)
    visited = np.zeros(parts, np.bool_)
    shared = np.zeros(parts, np.int64)
    # The way back: a part leaves it once it has no unvisited neighbours, and is not looked at again.
    trail = np.empty(parts, np.int32)
    seen = starts[:-1].copy()
    length = 0
    lowest = 0
    current = 0
    for step in range(parts):
        chain[step] = current
        visited[current] = True
        trail[length] = current
        length += 1
        best = -1
        for i in range(starts[current], starts[current + 1]):
            p = ends[i]
            shared[p] += edges[i]
            if not visited[p] and (best == -1 or shared[p] > shared[best]):
                best = p
        while best == -1 and length > 0:
            last = trail[length - 1]
            while seen[last] < starts[last + 1] and visited[ends[seen[last]]]:
                seen[last] += 1
            if seen[last] < starts[last + 1]:
                best = ends[seen[last]]
            else:
                length -= 1
        if best == -1:
            while lowest < parts and visited[lowest]:
                lowest += 1
            best = lowest
        current = best
    return chain
