"""Noise like that which was found, to rehearse with."""

from __future__ import annotations

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.filters.vertex_update import Floats, face_geometry, vertex_normals
from bsm.codec.denoise.noise.finding import Finding
from bsm.codec.denoise.noise.probe import Probe

MOST_STEPS = 12


class Synthesis:
    """Draws noise of the kind and strength of a finding."""

    def __init__(self, finding: Finding, probe: Probe, tangential: float) -> None:
        self._finding, self._probe, self._tangential = finding, probe, tangential
        self._steps, self._strength = 0, 1.0
        if finding.kind == "correlated":
            self._steps, self._strength = _correlation(finding.whiteness, probe)

    @property
    def strength(self) -> float:
        """Standard deviation along the normals over the level of the finding, which fine frequencies alone gave."""
        return self._strength

    def draw(self, positions: Positions, seed: int) -> Positions:
        """Positions with noise."""
        finding, topology = self._finding, self._probe.topology
        random = np.random.default_rng(seed)
        if finding.grid is not None:
            return finding.grid.round(positions, finding.grid.steps * random.random(3))
        white = random.normal(size=positions.shape)
        if finding.axis is not None:
            growth = 1.0 if finding.growth is None else finding.growth[:, None]
            return np.asarray(positions + finding.level * growth * white[:, :1] * finding.axis)
        normals = _normals(positions, topology)
        along = np.einsum("ij,ij->i", white, normals)[:, None]
        amount = self._probe.correlated(along, self._steps)
        if self._steps:
            amount *= self._strength / amount.std()
        across = np.where(finding.levels > 0.0, self._tangential, 0.0)[:, None] * (white - along * normals)
        return np.asarray(positions + finding.levels[:, None] * amount * normals + across)


def _normals(positions: Positions, topology: Topology) -> Floats:
    return vertex_normals(face_geometry(positions, topology.faces).normals, topology.around)


def _correlation(whiteness: float, probe: Probe) -> tuple[int, float]:
    """How often white noise is averaged until its spectrum falls off as steeply, and its strength over fine levels."""
    noise = np.random.default_rng(0).normal(size=(probe.topology.n, 4))
    strengths = []
    for _ in range(MOST_STEPS):
        noise = probe.correlated(noise, 1)
        fine, finest = (values[probe.counted].std() for values in (probe.fine(noise), probe.finest(noise)))
        strengths.append((float(finest / fine), float(noise[probe.counted].std() / fine)))
    steps = min(range(MOST_STEPS), key=lambda index: abs(strengths[index][0] - whiteness))
    return steps + 1, strengths[steps][1]
