"""What is known about the noise of a mesh, and the evidence that it is concluded from."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Positions
from bsm.codec.denoise.filters.vertex_update import Floats
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.noise.rounding import Grid
from bsm.codec.denoise.noise.windows import Windows

UNEVEN = 0.26
"""Largest spread of the levels of strong noise (logarithms) beyond chance."""
LEVEL_SPREAD = 0.92
"""Chance makes levels of windows of w vertices spread by about this over sqrt(w)."""
ASIDE = 0.2
"""Largest median of the standardised residual: noise lies on both sides."""
CENTRE = (0.55, 1.6)
"""Share of residuals about zero, as a multiple of the normal distribution's."""


@dataclass(frozen=True, eq=False)
class Finding:
    """What is known about the noise of a mesh."""

    kind: str
    level: float
    levels: Floats
    edge: float
    reason: str
    axis: Floats | None = None
    growth: Floats | None = None
    grid: Grid | None = None
    whiteness: float = 1.0

    @property
    def noisy(self) -> bool:
        """Whether there is anything to remove."""
        return self.kind not in ("none", "unknown")

    def on(self, members: npt.NDArray[np.int64]) -> Finding:
        """The finding for some of the vertices, `members`, shape (k,)."""
        growth = None if self.growth is None else self.growth[members]
        return replace(self, levels=self.levels[members], growth=growth)


@dataclass(frozen=True, eq=False)
class Evidence:
    """Fine residuals along the normals, and their levels in the windows, in mean edges."""

    probe: Probe
    normals: Floats
    along: Floats
    levels: Floats
    edge: float


def look(positions: Positions, probe: Probe, edge: float, passes: int) -> Evidence:
    """The evidence of positions, shape (n, 3), with normals from so many averagings of them."""
    normals = probe.smooth_normals(positions, passes)
    along = np.einsum("ij,ij->i", probe.fine(positions / edge), normals)
    return Evidence(probe, normals, along, probe.levels(along), edge)


def spread(levels: Floats, windows: Windows) -> float:
    """Spread of the lower half of levels, shape (k,), beyond what chance makes; creases are in the upper one."""
    bottom, middle = np.quantile(levels, [0.1, 0.5])
    if bottom <= 0.0:
        return float("inf")
    chance = LEVEL_SPREAD / np.sqrt(windows.usual_size)
    return float(np.sqrt(max((np.log(middle / bottom) / 1.2816) ** 2 - chance**2, 0.0)))


def is_random(values: Floats) -> bool:
    """Whether standardised values, shape (k,), lie on both sides, with neither a heap of zeros nor a hole there."""
    centre = float(np.mean(np.abs(values) < 0.1)) / 0.0797
    return abs(float(np.median(values))) < ASIDE and CENTRE[0] < centre < CENTRE[1]
