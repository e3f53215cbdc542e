"""Who is near whom on a surface, as far as the faces alone say it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.geometry.graph import Indices
from codec.geometry.incidence import Rows, vertex_faces, vertex_neighbours
from codec.geometry.mesh import Faces

Mask = npt.NDArray[np.bool_]

CROWD = 32


@dataclass(frozen=True, eq=False)
class Topology:
    """Neighbourhoods of faces; what not every filter needs is found when it is first asked for.

    Parameters
    ----------
    faces : ndarray of int32, shape (m, 3)
    n : int
        Number of vertices.
    """

    faces: Faces
    n: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "faces", np.ascontiguousarray(self.faces, dtype=np.int32))

    @cached_property
    def around(self) -> Rows:
        """Faces around each vertex."""
        return vertex_faces(self.faces, self.n)

    @cached_property
    def neighbours(self) -> Rows:
        """Neighbours of each vertex."""
        return vertex_neighbours(self.faces, self.n)

    @cached_property
    def patches(self) -> Rows:
        """Faces that share a vertex with each face; itself comes first.

        In a fan of more than 64 faces only the 32 before and the 32 after in order of index count, lest the hub of a
        wheel make everybody everybody's neighbour.
        """
        return Rows(*_patches(self.faces, self.around.starts, self.around.members, CROWD))

    @cached_property
    def pairs(self) -> Indices:
        """Two faces that share an edge, shape (p, 2); where more than two meet, each with the next in order."""
        pairs: Indices = _equal_runs(*self._edges)
        return pairs

    @cached_property
    def inner(self) -> Rows:
        """For each patch, the rows of `pairs` of which both faces lie in it."""
        return Rows(*_inner_pairs(self.patches.starts, self.patches.members, self.pairs))

    @cached_property
    def boundary(self) -> Mask:
        """True for the vertices of edges that only one face has, shape (n,)."""
        key, _ = self._edges
        alone = np.ones(len(key), dtype=np.bool_)
        same = key[1:] == key[:-1]
        alone[1:] &= ~same
        alone[:-1] &= ~same
        boundary = np.zeros(self.n, dtype=np.bool_)
        boundary[key[alone] >> 32] = True
        boundary[key[alone] & 0xFFFFFFFF] = True
        return boundary

    @cached_property
    def _edges(self) -> tuple[npt.NDArray[np.int64], Indices]:
        """The edges of all faces as ``smaller << 32 | larger``, ascending, and the face of each; loops left out."""
        owner = np.repeat(np.arange(len(self.faces), dtype=np.int32), 3)
        ends = self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64)
        key = ends.min(axis=1) << 32 | ends.max(axis=1)
        proper = ends[:, 0] != ends[:, 1]
        key, owner = key[proper], owner[proper]
        order = np.argsort(key, kind="stable")
        return key[order], owner[order]


def without_first(rows: Rows) -> Rows:
    """Rows without their first members; every row must have one."""
    kept = np.ones(len(rows.members), dtype=np.bool_)
    kept[rows.starts[:-1]] = False
    return Rows(rows.starts - np.arange(len(rows.starts)), rows.members[kept])


@njit(cache=True, nogil=True)
def _equal_runs(key, owner):  # type: ignore[no-untyped-def]
    """Neighbouring owners of equal keys."""
    pairs = np.empty((len(key), 2), dtype=np.int32)
    count = 0
    for k in range(1, len(key)):
        if key[k] == key[k - 1] and owner[k] != owner[k - 1]:
            pairs[count, 0], pairs[count, 1] = owner[k - 1], owner[k]
            count += 1
    return pairs[:count].copy()


@njit(cache=True, nogil=True)
def _patches(faces, around_starts, around, crowd):  # type: ignore[no-untyped-def]
    m = len(faces)
    starts = np.zeros(m + 1, dtype=np.int64)
    bound = m
    for f in range(m):
        for corner in range(3):
            v = faces[f, corner]
            bound += min(around_starts[v + 1] - around_starts[v], 2 * crowd + 1)
    members = np.empty(bound, dtype=np.int32)
    seen = np.full(m, -1, dtype=np.int32)
    end = 0
    for f in range(m):
        seen[f] = f
        members[end] = f
        end += 1
        for corner in range(3):
            v = faces[f, corner]
            first, last = around_starts[v], around_starts[v + 1]
            if last - first > 2 * crowd:
                place = first + np.searchsorted(around[first:last], f)
                first, last = max(first, place - crowd), min(last, place + crowd + 1)
            for k in range(first, last):
                g = around[k]
                if seen[g] != f:
                    seen[g] = f
                    members[end] = g
                    end += 1
        starts[f + 1] = end
    return starts, members[:end].copy()


@njit(cache=True, nogil=True)
def _inner_pairs(starts, members, pairs):  # type: ignore[no-untyped-def]
    m = len(starts) - 1
    first = np.zeros(m + 1, dtype=np.int64)
    for p in range(len(pairs)):
        first[pairs[p, 0] + 1] += 1
    for f in range(m):
        first[f + 1] += first[f]
    fill = first[:-1].copy()
    own = np.empty(len(pairs), dtype=np.int32)
    for p in range(len(pairs)):
        own[fill[pairs[p, 0]]] = p
        fill[pairs[p, 0]] += 1

    inner_starts = np.zeros(m + 1, dtype=np.int64)
    inside = np.full(m, -1, dtype=np.int32)
    inner = np.empty(0, dtype=np.int32)
    for filling in range(2):
        end = 0
        inside[:] = -1
        for f in range(m):
            for k in range(starts[f], starts[f + 1]):
                inside[members[k]] = f
            for k in range(starts[f], starts[f + 1]):
                g = members[k]
                for q in range(first[g], first[g + 1]):
                    if inside[pairs[own[q], 1]] == f:
                        if filling == 1:
                            inner[end] = own[q]
                        end += 1
            inner_starts[f + 1] = end
        if filling == 0:
            inner = np.empty(end, dtype=np.int32)
    return inner_starts, inner
