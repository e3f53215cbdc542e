"""A lens for noise: high-pass filters of which it is known how much of white noise they let through.

The random-walk Laplacian I - P, applied again and again, leaves little of a surface and most of the noise. Dividing
each vertex by the norm of its row makes white noise of standard deviation s come out with standard deviation s.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from scipy import sparse

from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Positions
from bsm.codec.denoise.filters.topology import Mask, Topology
from bsm.codec.denoise.filters.vertex_update import Floats, face_geometry, vertex_normals
from bsm.codec.denoise.noise.windows import Windows

FINE = 2
FINEST = 6
GAIN_PROBES = 24
NORMAL_PASSES = 2
SHARE, BOUND = 0.6, 0.8416
"""So much of a standard normal variable is this close to zero: nearly as sure as the variance, deaf to creases."""


class Probe:
    """Measures what is noise-like on the meshes of one connectivity."""

    def __init__(self, topology: Topology) -> None:
        self.topology = topology
        starts, members = topology.neighbours
        degrees = np.diff(starts)
        lonely = degrees == 0
        weights = np.repeat(1.0 / np.maximum(degrees, 1), degrees)
        average = sparse.csr_matrix((weights, members, starts), shape=(topology.n, topology.n))
        self.average = average + sparse.diags(lonely.astype(np.float64)) if lonely.any() else average
        self.counted: Mask = (degrees >= 3) & ~topology.boundary

    @cached_property
    def windows(self) -> Windows:
        """Where statistics are taken."""
        return Windows(self.topology, self.counted)

    @cached_property
    def fine_operator(self) -> tuple[sparse.csr_matrix, Floats]:
        """Two Laplacians as one matrix, shape (n, n), and the norms of its rows, shape (n,)."""
        step = sparse.identity(self.topology.n, format="csr") - self.average
        operator = (step @ step).tocsr()
        return operator, np.sqrt(np.asarray(operator.multiply(operator).sum(axis=1)).ravel())

    @cached_property
    def _finest_gain(self) -> Floats:
        return self._gain(self._repeated)

    def _gain(self, filtered: Callable[[Floats], Floats]) -> Floats:
        signs = np.random.default_rng(0).choice(np.array([-1.0, 1.0]), (self.topology.n, GAIN_PROBES))
        gain = np.sqrt(np.square(filtered(signs)).mean(axis=1))
        return np.asarray(np.where(gain > 0.0, gain, np.inf))

    def fine(self, values: Floats) -> Floats:
        """What two Laplacians leave of `values`, shape (n, d), as standard deviations of white noise."""
        operator, gain = self.fine_operator
        return np.asarray(operator @ values / np.where(gain > 0.0, gain, np.inf)[:, None])

    def finest(self, values: Floats) -> Floats:
        """What six Laplacians leave of `values`, shape (n, d), as standard deviations of white noise."""
        return self._repeated(values) / self._finest_gain[:, None]

    def broad(self, values: Floats) -> Floats:
        """What two averagings and two Laplacians leave of `values`, shape (n, d), as `fine` does."""
        return self._band(values) / self._gain(self._band)[:, None]

    def _band(self, values: Floats) -> Floats:
        operator = self.fine_operator[0]
        return np.asarray(operator @ (self.average @ (self.average @ values)))

    def smooth_normals(self, positions: Positions, passes: int = NORMAL_PASSES) -> Floats:
        """Unit vertex normals, shape (n, 3), after as many averagings of the positions; averaged once more."""
        smooth = positions
        for _ in range(passes):
            smooth = self.average @ smooth
        normals = vertex_normals(
            face_geometry(np.ascontiguousarray(smooth), self.topology.faces).normals, self.topology.around
        )
        normals = normals + self.average @ normals
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.asarray(normals / np.where(length > 0.0, length, 1.0))

    def correlated(self, white: Floats, steps: int) -> Floats:
        """White values, shape (n, d), averaged half and half with their neighbours as often as `steps` says."""
        for _ in range(steps):
            white = 0.5 * (white + self.average @ white)
        return white

    def levels(self, along: Floats) -> Floats:
        """Standard deviations of `along`, shape (n,), in the windows, shape (windows.count,)."""
        return self.windows.quantiles(np.abs(along), SHARE) / BOUND

    def _repeated(self, values: npt.NDArray[np.float64]) -> Floats:
        for _ in range(FINEST):
            values = values - self.average @ values
        return values
