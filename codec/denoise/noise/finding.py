"""Findings about the noise of a mesh, and the evidence for them."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from bsm.codec.arrays import Floats, Mask, Order, Positions
from bsm.codec.denoise.noise.causes import FEWEST_VALUES, NEAR, SAME, Confines, Reach, Spacing
from bsm.codec.denoise.noise.probe import Probe, Windows
from bsm.codec.denoise.noise.view import View
from bsm.codec.denoise.noise.volumes import HALFWAY, Cells
from bsm.codec.denoise.surface import Topology

LATTICE_USUAL = 0.25  # vertices that a plane of a lattice has at least, over the usual


def lattice_step(positions: Positions) -> float:
    """Step of the cubic lattice on whose lines the positions lie, as those of marching cubes do; 0 if there is none."""
    extent = float(np.ptp(positions, axis=0).max())
    planes = []
    for column in positions.T:
        # Marching cubes leave two coordinates of each vertex on planes of the lattice: heaps of equal values.
        values, counts = np.unique(np.round((column - column.min()) / (SAME * extent or 1.0)), return_counts=True)
        # Symmetric shapes have smaller heaps beside.
        usual = np.median(np.repeat(counts, counts))
        planes.append(values[counts > LATTICE_USUAL * usual] * SAME * extent)
    # A box has heaps as well, at its sides.
    if min(len(heaps) for heaps in planes) < FEWEST_VALUES:
        return 0.0
    step = float(np.median(np.concatenate([np.diff(heaps) for heaps in planes])))
    apart = np.concatenate([heaps - heaps[len(heaps) // 2] for heaps in planes])
    numbers = np.round(apart / step)
    step = float(numbers @ apart / (numbers @ numbers))
    lies = np.zeros(len(positions), dtype=np.int64)
    for column, heaps in zip(positions.T, planes, strict=True):
        place = (column - column.min() - heaps[len(heaps) // 2]) / step
        lies += np.abs(place - np.round(place)) < NEAR
    return step if (lies >= 2).mean() > HALFWAY else 0.0


ASIDE = 0.2  # largest median of values over their levels: noise lies on both sides
HEAP = 1.6  # largest share of values about zero, as a multiple of the normal distribution's
LEVEL_SPREAD = 0.92  # chance makes levels of windows of w vertices spread by about this over sqrt(w)


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

    def on(self, members: Order) -> Self:
        growth = None if self.growth is None else self.growth[members]
        return replace(self, levels=self.levels[members], growth=growth)

    def reaching(self, topology: Topology, slides: bool) -> Self:
        """The finding with a bound to where noise that is not bound otherwise may have moved vertices from."""
        free = self.bound is None and self.kind in ("white", "correlated", "local")
        # Fine levels hold little of noise that neighbors share: about the square of their share in the finest.
        # A bound by the noise itself, where coordinates tell none: no vertex was moved by more than a few deviations.
        return replace(self, bound=Reach(topology, self.levels / self.whiteness**2, slides)) if free else self


MEASURES = ("level", "whiteness", "off", "uneven", "broadly uneven", "irregular", "few")
MANY_WINDOWS = 25  # fewer say less about the spread of levels
SLOPE, SHIFT = 0.6, 0.15  # of the broad level over the whiteness (logarithms), for all lengths of correlation


@dataclass(frozen=True, eq=False)
class Evidence:
    """What filters leave of a mesh along and across a direction at each vertex; windows' levels in mean edges."""

    probe: Probe
    normals: Floats
    edge: float
    along: Floats
    across: Floats
    levels: Floats
    broad: Floats
    finest: Floats

    def level(self, windows: Mask) -> float:
        return float(np.median(self.levels[windows]))

    def whiteness(self, windows: Mask) -> float:
        """Level of the finest frequencies over the fine ones: 1 for white noise, less if neighbors share it."""
        # The lower quarter: creases are in the upper parts of both.
        return float(np.quantile(self.finest[windows], 0.25) / max(np.quantile(self.levels[windows], 0.25), 1e-9))

    def is_random(self, windows: Mask) -> bool:
        """Whether counted vertices of these windows lie on both sides of the surface, and no heap of them on it."""
        chosen = windows[self.probe.windows.labels] & self.probe.counted
        values = self.along[chosen] / np.maximum(self.levels[self.probe.windows.labels[chosen]], 1e-9)
        # The share of a standard normal distribution within a tenth of a deviation is 0.0797.
        return bool(abs(np.median(values)) < ASIDE and (np.abs(values) < 0.1).mean() < HEAP * 0.0797)

    def measures(self, windows: Mask) -> Floats:
        """Return what rules weigh, in the order of `MEASURES`; level, whiteness and irregularity are logarithms."""
        fine, broad = self.levels[windows], self.broad[windows]
        broader = np.log(max(np.median(broad / np.maximum(fine, 1e-9)), 1e-9))
        level, whiteness = np.log(np.maximum([self.level(windows), self.whiteness(windows)], 1e-9))
        uneven = (min(spread(levels, self.probe.windows), 1.5) for levels in (fine, broad))
        off = abs(broader + SLOPE * whiteness + SHIFT)
        across = self.across[windows[self.probe.windows.labels] & self.probe.counted]
        irregular = np.log(max(float(np.quantile(across, 0.9)), 1e-9))
        # Few windows make every measure uncertain, and rules want more evidence then.
        few = max(1.0 / np.sqrt(len(fine)) - 1.0 / np.sqrt(MANY_WINDOWS), 0.0)
        return np.array([level, whiteness, off, *uneven, irregular, few])

    def weakened(self, growth: Floats) -> Self:
        """Evidence of noise without its growth, shape (n,)."""
        here = self.probe.windows.means(growth)
        levels, broad, finest = (values / here for values in (self.levels, self.broad, self.finest))
        return replace(self, along=self.along / growth, levels=levels, broad=broad, finest=finest)


def look(probe: Probe, values: Floats, directions: Floats, edge: float) -> Evidence:
    """See `values`, shape (n, d), along `directions`, shape (n, d)."""
    fine, broad, finest = (filtered(values) for filtered in (probe.fine, probe.broad, probe.finest))
    along, *others = (np.einsum("ij,ij->i", seen, directions) for seen in (fine, broad, finest))
    across = np.linalg.norm(fine - along[:, None] * directions, axis=1)
    levels = (probe.levels(each) for each in (along, *others))
    return Evidence(probe, directions, edge, along, across, *levels)


def spread(levels: Floats, windows: Windows) -> float:
    """Spread of the lower half of levels, shape (k,), beyond what chance makes; creases are in the upper one."""
    # Robust against the upper half, where shape adds to noise.
    bottom, middle = np.quantile(levels, [0.1, 0.5])
    if bottom <= 0.0:
        return float("inf")
    chance = LEVEL_SPREAD / np.sqrt(windows.usual_size)
    return float(np.sqrt(max((np.log(middle / bottom) / 1.2816) ** 2 - chance**2, 0.0)))
