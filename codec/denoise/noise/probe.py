"""A lens for noise: windows to take statistics in, and high-pass filters of known effect on white noise.

The random-walk Laplacian I - P, applied again and again, leaves little of a surface and most of the noise. Dividing
each vertex by the norm of its row makes white noise of standard deviation s come out with standard deviation s.
"""

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse

from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Floats, Indices, Mask, Positions
from bsm.codec.blocks.overlap import metis_partition
from bsm.codec.denoise.surface import Topology, surface_normals, unit
from bsm.codec.geometry.graph import Graph, graph_of_faces

WINDOW = 200
"""Vertices of a window: fewer are judged by chance, and more hide where noise ends. Half of it leaves 2 % more of the
angle, twice 31 %, nearly all of it on one of four meshes."""
FEWEST_IN_WINDOW = 20  # vertices of a window that say anything


def grouped_quantiles(
    values: Floats, groups: npt.NDArray[Any], sizes: npt.NDArray[Any], share: float
) -> Floats:
    """Interpolated quantiles of the values of each group; any number for an empty one."""
    # One sort for all groups, instead of a loop over thousands of them.
    ordered = np.append(values[np.lexsort((values, groups))], 0.0)
    place = share * np.maximum(sizes - 1, 0)
    below = np.floor(place).astype(np.int64)
    first, rest = np.cumsum(sizes) - sizes + below, place - below
    return np.asarray(
        (1.0 - rest) * ordered[first] + rest * ordered[np.minimum(first + 1, len(values))]
    )


class Windows:
    """Disjoint connected pieces of about `WINDOW` vertices."""

    def __init__(self, graph: Graph, labels: Indices, counted: Mask) -> None:
        self._graph, self.labels = graph, labels
        self.count = int(labels.max()) + 1
        self._members = np.flatnonzero(counted)
        self._windows = labels[self._members]
        self._sizes = np.bincount(self._windows, minlength=self.count)
        self.valid: Mask = self._sizes >= FEWEST_IN_WINDOW
        self.usual_size = float(self._sizes[self.valid].mean()) if self.valid.any() else 0.0

    def beside(self, chosen: Mask) -> Mask:
        """Windows that have an edge to one of the chosen windows, shape (count,)."""
        ends = np.repeat(self.labels, np.diff(self._graph.offsets))
        return np.isin(np.arange(self.count), ends[chosen[self.labels[self._graph.neighbors]]])

    def quantiles(self, values: Floats, share: float) -> Floats:
        """Interpolated quantiles of the counted vertices of each window, shape (count,); NaN where it is not valid."""
        quantiles = grouped_quantiles(values[self._members], self._windows, self._sizes, share)
        return np.where(self.valid, quantiles, np.nan)

    def means(self, values: Floats) -> Floats:
        """Mean over the counted vertices of each window, shape (count,); NaN where a window is not valid."""
        sums = np.bincount(self._windows, values[self._members], self.count)
        return np.where(self.valid, sums / np.maximum(self._sizes, 1), np.nan)


FINEST, GAIN_PROBES, NORMAL_PASSES = 6, 24, 2
SHARE, BOUND = 0.6, 0.8416
"""So much of a standard normal variable is this close to zero: nearly as sure as the variance, deaf to creases."""


class Probe:
    """Measures noise on meshes of one connectivity."""

    def __init__(self, topology: Topology) -> None:
        self.topology = topology
        starts, members = topology.neighbors
        degrees = np.diff(starts)
        lonely = degrees == 0
        weights = np.repeat(1.0 / np.maximum(degrees, 1), degrees)
        average = sparse.csr_matrix((weights, members, starts), shape=(topology.n, topology.n))
        self.average = (
            average + sparse.diags(lonely.astype(np.float64)) if lonely.any() else average
        )
        # At a border the Laplacian sees only one side, and finds curvature where there is none.
        self.counted: Mask = (degrees >= 3) & ~topology.boundary

    @cached_property
    def windows(self) -> Windows:
        graph = graph_of_faces(self.topology.faces, self.topology.n)
        parts = max(1, round(int(self.counted.sum()) / WINDOW))
        # Connected pieces of equal size, on any mesh: a grid in space would mix both sides of a thin wall.
        return Windows(graph, metis_partition(graph, parts).labels, self.counted)

    @cached_property
    def fine_operator(self) -> tuple[sparse.csr_matrix, Floats]:
        """Two Laplacians as one matrix, shape (n, n), and the norms of its rows, shape (n,)."""
        step = sparse.identity(self.topology.n, format="csr") - self.average
        operator = (step @ step).tocsr()
        return operator, np.sqrt(np.asarray(operator.multiply(operator).sum(axis=1)).ravel())

    @cached_property
    def _gains(self) -> Floats:
        """Strength of white noise after the finest and the broad filter, shape (2, n)."""
        # Random signs measure the gain of a filter without making its matrix, which would be nearly full.
        signs = np.random.default_rng(0).choice(
            np.array([-1.0, 1.0]), (self.topology.n, GAIN_PROBES)
        )
        gains = np.sqrt(
            [np.square(filtered(signs)).mean(axis=1) for filtered in (self._repeated, self._band)]
        )
        return np.where(gains > 0.0, gains, np.inf)

    def fine(self, values: Floats) -> Floats:
        """What two Laplacians leave of `values`, shape (n, d), as standard deviations of white noise."""
        operator, gain = self.fine_operator
        return np.asarray(operator @ values / np.where(gain > 0.0, gain, np.inf)[:, None])

    def finest(self, values: Floats) -> Floats:
        """What six Laplacians leave of `values`, shape (n, d), as standard deviations of white noise."""
        return self._repeated(values) / self._gains[0, :, None]

    def broad(self, values: Floats) -> Floats:
        """What two averagings and two Laplacians leave of `values`, shape (n, d), as `fine` does."""
        return self._band(values) / self._gains[1, :, None]

    def _band(self, values: Floats) -> Floats:
        operator = self.fine_operator[0]
        return np.asarray(operator @ (self.average @ (self.average @ values)))

    def smooth_normals(self, positions: Positions, passes: int = NORMAL_PASSES) -> Floats:
        """Unit vertex normals, shape (n, 3), after as many averagings of the positions; averaged once more."""
        smooth = positions
        for _ in range(passes):
            smooth = self.average @ smooth
        normals = surface_normals(smooth, self.topology)
        return unit(normals + self.average @ normals)

    def correlated(self, white: Floats, steps: int) -> Floats:
        """White values, shape (n, d), averaged half and half with their neighbors as often as `steps` says."""
        for _ in range(steps):
            white = 0.5 * (white + self.average @ white)
        return white

    def levels(self, along: Floats) -> Floats:
        return self.windows.quantiles(np.abs(along), SHARE) / BOUND

    def _repeated(self, values: Floats) -> Floats:
        # Each application leaves less of the shape: six leave only what changes from vertex to vertex.
        for _ in range(FINEST):
            values = values - self.average @ values
        return values
