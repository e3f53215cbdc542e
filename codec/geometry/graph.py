"""The graph of a mesh: its vertices, and an edge wherever two of them share a face.

Everything that encoder and decoder derive from connectivity starts here. Rows are stored compressed (CSR) and
sorted, so that every rule built on "the first neighbour" is the same on both sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

Indices = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Graph:
    """An undirected graph without loops or repeated edges.

    Parameters
    ----------
    offsets : int32 array, shape (n + 1,)
        Neighbours of vertex v are `neighbours[offsets[v]:offsets[v + 1]]`.
    neighbours : int32 array
        In ascending order for each vertex.
    """

    offsets: Indices
    neighbours: Indices

    @property
    def size(self) -> int:
        """Number of vertices."""
        return len(self.offsets) - 1


def graph_of_faces(faces: Indices, size: int) -> Graph:
    """Graph on `size` vertices of the triangles `faces`, shape (m, 3); degenerate corners make no edges."""
    return Graph(*_collect_edges(faces, size))


@njit(cache=True, nogil=True)
def _collect_edges(faces, size):  # type: ignore[no-untyped-def]
    offsets = np.zeros(size + 1, np.int32)
    for f in range(faces.shape[0]):
        for i in range(3):
            if faces[f, i] != faces[f, (i + 1) % 3]:
                offsets[faces[f, i] + 1] += 1
                offsets[faces[f, (i + 1) % 3] + 1] += 1
    for v in range(size):
        offsets[v + 1] += offsets[v]
    filled = offsets[:-1].copy()
    ends = np.empty(offsets[size], np.int32)
    for f in range(faces.shape[0]):
        for i in range(3):
            a, b = faces[f, i], faces[f, (i + 1) % 3]
            if a != b:
                ends[filled[a]] = b
                filled[a] += 1
                ends[filled[b]] = a
                filled[b] += 1
    # Each row is now complete but unsorted, and an edge stands in it once for every face beside it.
    kept = 0
    for v in range(size):
        first, last = offsets[v], offsets[v + 1]
        row = ends[first:last]
        if last - first > 32:
            row.sort()
        else:
            for i in range(1, last - first):
                value = row[i]
                j = i - 1
                while j >= 0 and row[j] > value:
                    row[j + 1] = row[j]
                    j -= 1
                row[j + 1] = value
        offsets[v] = kept
        previous = -1
        for i in range(first, last):
            if ends[i] != previous:
                previous = ends[i]
                ends[kept] = previous
                kept += 1
    offsets[size] = kept
    return offsets, ends[:kept].copy()
