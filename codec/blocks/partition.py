"""Cutting a mesh into parts: METIS, as in the paper, or a rule that both sides follow (paper, sections 4, 6.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from codec.blocks.bisection import bisect
from codec.geometry.graph import Graph, Indices

REFINEMENT_PASSES = 2
"""How often the derived partition goes over its boundaries; part of the format."""


@dataclass(frozen=True, eq=False)
class Partition:
    """Disjoint, non-empty parts that cover a graph.

    Parameters
    ----------
    order : int32 array, shape (n,)
        The vertices, part after part, ascending within each.
    bounds : int32 array, shape (k + 1,)
        Part p is `order[bounds[p]:bounds[p + 1]]`.
    labels : int32 array, shape (n,)
        Part of each vertex.
    """

    order: Indices
    bounds: Indices
    labels: Indices

    @property
    def parts(self) -> int:
        """Number of parts k."""
        return len(self.bounds) - 1


def partition_of_labels(labels: Indices) -> Partition:
    """Partition whose parts are the distinct labels, numbered by the first vertex that has them."""
    _, first, compact = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int32)
    rank[np.argsort(first)] = np.arange(len(first), dtype=np.int32)
    return _grouped(rank[compact])


def derive_partition(graph: Graph, parts: int) -> Partition:
    """Recursive bisection, then two passes that move boundary vertices to where most of their neighbours are.

    Integers only, so that a decoder arrives at the same parts from the decoded faces, and no label is sent.
    """
    order, bounds = bisect(graph, parts)
    labels = np.empty(graph.size, np.int32)
    labels[order] = np.repeat(np.arange(parts, dtype=np.int32), np.diff(bounds))
    _refine(graph.offsets, graph.neighbours, labels, parts)
    return _grouped(labels)


def metis_partition(graph: Graph, parts: int) -> Partition:
    """METIS k-way partition; its labels differ between builds, so a stream has to carry them."""
    import pymetis

    if parts == 1:
        return partition_of_labels(np.zeros(graph.size, np.int32))
    adjacency = pymetis.CSRAdjacency(graph.offsets, graph.neighbours)
    _, labels = pymetis.part_graph(parts, adjacency)
    return partition_of_labels(np.asarray(labels, dtype=np.int32))


def _grouped(labels: Indices) -> Partition:
    counts = np.bincount(labels)
    bounds = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    return Partition(np.argsort(labels, kind="stable").astype(np.int32), bounds, labels)


@njit(cache=True, nogil=True)
def _refine(offsets, neighbours, labels, parts):  # type: ignore[no-untyped-def]
    """Greedy: a vertex moves to the part that most of its neighbours have, unless that part is full.

    On a draw it moves only from a larger part to one at least two smaller; a part holds at most 3 % more than its
    share, and never less than one vertex.
    """
    n = len(labels)
    sizes = np.zeros(parts, np.int64)
    for v in range(n):
        sizes[labels[v]] += 1
    room = n * 103 // (parts * 100) + 1
    votes = np.zeros(parts, np.int32)
    for _ in range(REFINEMENT_PASSES):
        for v in range(n):
            own = labels[v]
            first, last = offsets[v], offsets[v + 1]
            inside = True
            for i in range(first, last):
                if labels[neighbours[i]] != own:
                    inside = False
                    break
            if inside:
                continue
            for i in range(first, last):
                votes[labels[neighbours[i]]] += 1
            best = own
            for i in range(first, last):
                part = labels[neighbours[i]]
                if part in (own, best) or sizes[part] >= room:
                    continue
                if votes[part] > votes[best] or (
                    votes[part] == votes[best] and sizes[part] + (1 if best == own else 0) < sizes[best]
                ):
                    best = part
            if best != own and sizes[own] > 1:
                labels[v] = best
                sizes[own] -= 1
                sizes[best] += 1
            votes[own] = 0
            for i in range(first, last):
                votes[labels[neighbours[i]]] = 0
