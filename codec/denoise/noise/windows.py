"""Small pieces of a surface, in which statistics are taken."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Indices
from bsm.codec.blocks.partition import metis_partition
from bsm.codec.denoise.filters.topology import Mask, Topology
from bsm.codec.geometry.graph import graph_of_faces

Floats = npt.NDArray[np.float64]

SIZE = 200
"""Vertices of a window: fewer are judged by chance, and more hide where noise ends. Half of it leaves 2 % more of the
angle, twice 31 %, nearly all of it on one of four meshes (tools.constants)."""
FEWEST = 20
"""Vertices of a window that say anything."""


class Windows:
    """Disjoint connected pieces of about `SIZE` vertices."""

    def __init__(self, topology: Topology, counted: Mask) -> None:
        self._graph = graph_of_faces(topology.faces, topology.n)
        self._count(metis_partition(self._graph, max(1, round(int(counted.sum()) / SIZE))).labels, counted)

    @staticmethod
    def of_labels(windows: Windows, counted: Mask, fewest: int = FEWEST) -> Windows:
        """These windows with other vertices counted, shape (n,), `fewest` of them in a valid one."""
        other = object.__new__(Windows)
        other._graph = windows._graph
        other._count(windows.labels, counted, fewest)
        return other

    def _count(self, labels: Indices, counted: Mask, fewest: int = FEWEST) -> None:
        self.labels = labels
        self.count = int(labels.max()) + 1
        self._members = np.flatnonzero(counted)
        self._windows = labels[self._members]
        self._sizes = np.bincount(self._windows, minlength=self.count)
        self._starts = np.concatenate([[0], np.cumsum(self._sizes)])
        self.valid: Mask = self._sizes >= fewest

    @property
    def usual_size(self) -> float:
        """Mean number of counted vertices of the valid windows."""
        return float(self._sizes[self.valid].mean())

    def beside(self, chosen: Mask) -> Mask:
        """Windows that have an edge to one of the chosen windows, shape (count,)."""
        ends = np.repeat(self.labels, np.diff(self._graph.offsets))
        beside = np.zeros(self.count, dtype=np.bool_)
        beside[ends[chosen[self.labels[self._graph.neighbours]]]] = True
        return beside

    def medians(self, values: Floats) -> Floats:
        """Median of the counted vertices of each window, shape (count,); NaN where a window is not valid."""
        return self.quantiles(values, 0.5)

    def quantiles(self, values: Floats, share: float) -> Floats:
        """The value below which `share` of the counted vertices of each window lie, interpolated."""
        chosen = values[self._members]
        ordered = chosen[np.lexsort((chosen, self._windows))]
        place = share * (self._sizes[self.valid] - 1)
        below = np.floor(place).astype(np.int64)
        first = self._starts[:-1][self.valid] + below
        last = np.minimum(first + 1, self._starts[1:][self.valid] - 1)
        rest = place - below
        result = np.full(self.count, np.nan)
        result[self.valid] = (1.0 - rest) * ordered[first] + rest * ordered[last]
        return result

    def means(self, values: Floats) -> Floats:
        """Mean over the counted vertices of each window, shape (count, ...); NaN where a window is not valid."""
        chosen = values[self._members].reshape(len(self._members), -1)
        sums = np.stack([np.bincount(self._windows, column, self.count) for column in chosen.T], axis=1)
        result = np.full((self.count, chosen.shape[1]), np.nan)
        result[self.valid] = sums[self.valid] / self._sizes[self.valid, None]
        return result.reshape(self.count, *values.shape[1:])
