"""What is known about the noise of a mesh, and the evidence that it is concluded from."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces, Indices, Positions
from bsm.codec.denoise.noise.probe import Probe, Windows
from bsm.codec.denoise.noise.view import View
from bsm.codec.denoise.surface import Floats, Topology
from bsm.codec.geometry.welding import weld

FEWEST_VALUES = 16  # with fewer different values of a coordinate, a grid looks like a few planes
NEAR = 0.02  # distance from a multiple, in steps, that the precision of files explains
SAME = 1e-6  # values closer together, as a share of the extent, are one value
SPREADS = 3  # averagings that part vertices that rounding has merged


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells within which positions are indistinguishable."""

    steps: Floats

    def round(self, positions: Positions, offset: Floats) -> Positions:
        """Positions in the middle of their cells, of which one has its middle at `offset`, shape (3,)."""
        safe = np.where(self.steps > 0.0, self.steps, 1.0)
        return np.where(self.steps > 0.0, np.round((positions - offset) / safe) * safe + offset, positions)

    def levels(self, normals: Floats) -> Floats:
        """Standard deviation along normals, shape (n, 3), of what rounding takes away or adds, shape (n,)."""
        return np.asarray(np.sqrt(np.square(normals * self.steps).sum(axis=1) / 12.0))

    def within_cells(self, rounded: Positions, moved: Positions) -> Positions:
        """Moved positions, shape (n, 3), brought back into the cells of the rounded ones."""
        half = np.where(self.steps > 0.0, 0.5 * self.steps, np.inf)
        return np.clip(moved, rounded - half, rounded + half)

    def parted(self, rounded: Positions, probe: Probe) -> Positions:
        """Rounded positions, shape (n, 3); neighbours at one position are drawn to their other neighbours."""
        starts, members = probe.topology.neighbours
        owners = np.repeat(np.arange(len(rounded)), np.diff(starts))
        merged = np.unique(owners[(rounded[owners] == rounded[members]).all(axis=1)])
        result, around = rounded.copy(), probe.average[merged]
        for _ in range(SPREADS if len(merged) else 0):
            result[merged] = self.within_cells(rounded[merged], around @ result)
        return result


def find_grid(positions: Positions) -> Grid | None:
    """The grid that the positions, shape (n, 3), were rounded to, in all coordinates."""
    steps = [_step(positions[:, axis]) for axis in range(3)]
    known = [step for step in steps if step is not None]
    return Grid(np.array(known)) if len(known) == 3 and sum(step > 0.0 for step in known) >= 2 else None


def weld_seams(positions: Positions, faces: Faces) -> tuple[Positions, Faces, Indices]:
    """What `weld` makes of positions, shape (n, 3); but of those that lie on a grid only vertices of the boundary are
    welded, as those of seams and soups are: others have been merged by rounding."""
    welded, joined, index = weld(positions, faces)
    n = len(positions)
    if len(welded) == n or find_grid(welded) is None:
        return welded, joined, index
    index = np.where(Topology(faces, n).boundary, n + index, np.arange(n))
    index = np.unique(index, return_inverse=True)[1].ravel().astype(np.int32)
    return positions[np.unique(index, return_index=True)[1]], index[faces], index


def _step(coordinate: Floats) -> float | None:
    """Size of a cell; 0 where there are too few values to tell, None where they are not rounded."""
    extent = float(np.ptp(coordinate))
    values = np.unique(coordinate)
    gaps = np.diff(values)
    gaps = gaps[gaps > SAME * extent]
    if len(gaps) < FEWEST_VALUES:
        return 0.0
    count = round(extent / float(gaps.min()))
    # One gap alone is known no better than the file's last digits: all of them together say it.
    step = extent / count
    for _ in range(3):
        numbers = np.round((values - values[0]) / step)
        step = float(numbers @ (values - values[0]) / (numbers @ numbers))
    off = np.abs((values - values[0]) / step - np.round((values - values[0]) / step))
    return step if off.max() < NEAR and len(values) * 8 > count else None


LATTICE_HEAP, LATTICE_USUAL = 8, 0.25  # vertices that a plane of a lattice has at least, and over the usual
LATTICE_SHARE = 0.9  # of the vertices that lie on its lines


def lattice_step(positions: Positions) -> float:
    """Step of the cubic lattice on whose lines the positions lie, as those of marching cubes do; 0 if there is none."""
    extent = float(np.ptp(positions, axis=0).max())
    planes = []
    for column in positions.T:
        values, counts = np.unique(np.round((column - column.min()) / (SAME * extent or 1.0)), return_counts=True)
        values, counts = values[counts >= LATTICE_HEAP], counts[counts >= LATTICE_HEAP]
        # Symmetric shapes have smaller heaps beside.
        usual = np.median(np.repeat(counts, counts)) if len(counts) else 0.0
        planes.append(values[counts > LATTICE_USUAL * usual] * SAME * extent)
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
    return step if (lies >= 2).mean() > LATTICE_SHARE else 0.0


UNEVEN = 0.26  # largest spread of the levels of strong noise (logarithms) beyond chance
LEVEL_SPREAD = 0.92  # chance makes levels of windows of w vertices spread by about this over sqrt(w)
ASIDE = 0.2  # largest median of the standardised residual: noise lies on both sides
CENTRE = (0.55, 1.6)  # share of residuals about zero, as a multiple of the normal distribution's


@dataclass(frozen=True, eq=False)
class Finding:
    kind: str
    level: float
    levels: Floats
    edge: float
    reason: str
    axis: Floats | None = None
    growth: Floats | None = None
    grid: Grid | None = None
    whiteness: float = 1.0
    view: View | None = None
    clear: bool = True  # whether what lies beside the noise has none

    @property
    def noisy(self) -> bool:
        return self.kind not in ("none", "unknown")

    def on(self, members: npt.NDArray[np.int64]) -> Finding:
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
