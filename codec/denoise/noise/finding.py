"""Findings of noise in a mesh, its strength along and across the surface, and more of it to rehearse with."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from bsm.codec.arrays import Floats, Order, Positions
from bsm.codec.denoise.noise.causes import Cells, Confines, Reach, Spacing
from bsm.codec.denoise.noise.probe import BOUND, SHARE, Probe
from bsm.codec.denoise.noise.view import View
from bsm.codec.denoise.surface import Topology, surface_normals
from bsm.codec.geometry.metrics import mean_edge_length


@dataclass(frozen=True, eq=False)
class Finding:
    kind: str
    level: float
    levels: Floats
    edge: float
    reason: str
    axis: Floats | None = None
    growth: Floats | None = None
    bound: Confines | None = None
    whiteness: float = 1.0
    view: View | None = None
    uneven: float = 0.0
    clear: bool = True  # whether what lies beside the noise has none

    @property
    def exact(self) -> bool:
        """Whether the coordinates tell the cause, so that nothing has to be guessed."""
        return isinstance(self.bound, (Cells, Spacing))

    @property
    def noisy(self) -> bool:
        return self.kind not in ("none", "unknown")

    @property
    def stepped(self) -> bool:
        """Whether a camera tells depths apart in steps only."""
        return self.view is not None and self.view.stepped

    def on(self, members: Order) -> Self:
        growth = None if self.growth is None else self.growth[members]
        return replace(self, levels=self.levels[members], growth=growth)

    def reaching(self, topology: Topology, slides: bool) -> Self:
        """The finding with a bound to where noise that is not bound otherwise may have moved vertices from."""
        free = self.bound is None and self.kind in ("white", "correlated", "local")
        # Fine levels hold little of noise that neighbors share: about the square of their share in the finest.
        return (
            replace(self, bound=Reach(topology, self.levels / self.whiteness**2, slides))
            if free
            else self
        )


TENTH_ACROSS = 0.4590  # a tenth of the lengths of two standard normal numbers is below this
IRREGULARITY = 0.16
"""Level across the normals, in mean edges, up to which irregular triangles explain it: they read up to 0.143 on twenty
meshes, and noise of 0.2 mean edges in all directions at least 0.176."""


@dataclass(frozen=True)
class NoiseLevel:
    """Standard deviations of white noise along the normals and along the surface, in the unit of the mesh."""

    normal: float
    tangential: float

    @property
    def slides(self) -> bool:
        """Whether noise has moved vertices along the surface, so that they have to move back there."""
        return self.tangential > 0.0


def estimate_noise(positions: Positions, smooth: Positions, probe: Probe) -> NoiseLevel:
    """Return the noise of `positions`, shape (n, 3), along and across the normals of a smooth version of them."""
    counted = probe.counted if probe.counted.any() else np.ones(len(positions), dtype=np.bool_)
    normals = surface_normals(smooth, probe.topology)[counted]
    finest = probe.finest(positions)[counted]
    normal = float(np.quantile(np.abs(np.einsum("ij,ij->i", finest, normals)), SHARE)) / BOUND
    # Six Laplacians carry the irregularity of a few triangles far, two leave most of the mesh without it.
    fine = probe.fine(positions)[counted]
    lengths = np.linalg.norm(fine - np.einsum("ij,ij->i", fine, normals)[:, None] * normals, axis=1)
    # Triangles are irregular here and there, and noise is everywhere: its tenth part tells.
    across = float(np.quantile(lengths, 0.1)) / TENTH_ACROSS
    if across <= IRREGULARITY * mean_edge_length(positions, probe.topology.faces):
        return NoiseLevel(normal, 0.0)
    return NoiseLevel(normal, min(normal, across))


# Averagings for noise that neighbors share, and those for the pixels of a camera's window.
MOST_STEPS = 12
SHARED = 0.6  # strength of noise that the pixels of a window share, over that of single pixels


class Synthesis:
    """Draws noise of the kind and strength of a finding."""

    def __init__(self, finding: Finding, probe: Probe, tangential: float) -> None:
        self._finding, self._probe, self._tangential = finding, probe, tangential
        correlated = finding.kind in ("correlated", "fused")
        self._steps, self._strength = (
            _correlation(finding.whiteness, probe) if correlated else (0, 1.0)
        )

    def draw(self, positions: Positions, seed: int) -> Positions:
        finding = self._finding
        random = np.random.default_rng(seed)
        if isinstance(finding.bound, Spacing):
            return finding.bound.round(positions, finding.bound.steps * random.random(3))
        white = random.normal(size=positions.shape)
        # A rehearsal needs noise of the same kind: a filter that is good for one is bad for another.
        if finding.axis is not None:
            growth = 1.0 if finding.growth is None else finding.growth[:, None]
            return np.asarray(positions + finding.level * growth * white[:, :1] * finding.axis)
        topology = self._probe.topology
        if finding.view is not None:
            seen = finding.view.heights(positions, topology)
            shared = self._probe.correlated(white[:, 1], MOST_STEPS)
            noise = white[:, 0] + SHARED * shared / shared.std()
            return finding.view.at(positions, seen, seen + finding.view.level * noise)
        normals = surface_normals(positions, topology)
        along = np.einsum("ij,ij->i", white, normals)[:, None]
        amount = self._probe.correlated(along, self._steps)
        if self._steps:
            # Averaging takes strength away, and the level is that of fine frequencies, not of all.
            amount *= self._strength / amount.std()
        across = np.where(finding.levels > 0.0, self._tangential, 0.0)[:, None] * (
            white - along * normals
        )
        return np.asarray(positions + finding.levels[:, None] * amount * normals + across)


def _correlation(whiteness: float, probe: Probe) -> tuple[int, float]:
    """How often white noise is averaged until its spectrum falls off as steeply, and its strength over fine levels."""
    noise = np.random.default_rng(0).normal(size=(probe.topology.n, 4))
    strengths = []
    for _ in range(MOST_STEPS):
        noise = probe.correlated(noise, 1)
        fine, finest = (
            values[probe.counted].std() for values in (probe.fine(noise), probe.finest(noise))
        )
        strengths.append((float(finest / fine), float(noise[probe.counted].std() / fine)))
    steps = min(range(MOST_STEPS), key=lambda index: abs(strengths[index][0] - whiteness))
    return steps + 1, strengths[steps][1]
