"""One connectivity, and what is known of it and of the mesh that is being denoised: found once, asked for often."""

from __future__ import annotations

from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise.coarse import CoarseFilter
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.learnt.cascade import Learner
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.recipe import Treatments
from bsm.codec.geometry.metrics import mean_edge_length

BLOCK_SIZE = 500
"""About the paper's; half or twice of it leaves 2.4 and 0.6 % more of the angle (tools.constants)."""


class Patient:
    """A mesh that is welded, or a part of one."""

    def __init__(self, faces: Faces, n: int) -> None:
        self.topology = Topology(faces, n)
        self.probe = Probe(self.topology)
        self.learner = Learner(self.topology)
        self._last: Treatments | None = None
        self._coarse: CoarseFilter | None = None
        self._keep = 0.0

    def expect(self, keep: float) -> None:
        """Be ready for coarse meshes of up to that fraction of the frequencies."""
        if self._coarse is None or self._keep < keep:
            self._keep = keep
            self._coarse = CoarseFilter(self.topology.faces, self.topology.n, keep, BLOCK_SIZE)

    def smooth(self, positions: Positions, keep: float) -> Positions:
        """The coarse mesh, shape (n, 3), as `positions` are."""
        self.expect(keep)
        assert self._coarse is not None
        return self._coarse(positions, keep)

    def edge(self, positions: Positions) -> float:
        """Mean edge length of `positions`, shape (n, 3)."""
        return mean_edge_length(positions, self.topology.faces)

    def treated(self, positions: Positions) -> Treatments:
        """What recipes make of `positions`, shape (n, 3)."""
        return Treatments(positions, lambda keep: self.smooth(positions, keep), self.topology)

    def treatments(self, positions: Positions) -> Treatments:
        """What `treated` makes of `positions`, shape (n, 3), kept until others are asked for; by any thread."""
        last = self._last
        if last is None or last.noisy is not positions:
            last = self.treated(positions)
            self._last = last
        return last
