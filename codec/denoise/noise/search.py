"""Whether a mesh is noisy, how much, and of what kind: all of it from the mesh itself.

Noise is as strong in one place as in another (or follows the direction of the surface, where a camera has put it, or
covers a part of the mesh), on both sides of the surface alike, and prefers no value. Detail and creases are strong in
some places and weak in others. Coordinates tell rounding and binary volumes. Other kinds are suspected
by their cause, and accepted by `RULES`, which weigh a few measures. All other meshes are "none", small ones "unknown".
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np
from scipy.cluster.vq import kmeans

from bsm.codec.arrays import Floats, Mask, Positions
from bsm.codec.denoise.noise.causes import (
    FARTHEST,
    Box,
    Spacing,
    find_cells,
    find_grid,
    lattice_step,
)
from bsm.codec.denoise.noise.finding import Finding
from bsm.codec.denoise.noise.probe import FEWEST_IN_WINDOW, SHARE, Probe, Windows
from bsm.codec.denoise.noise.view import find_view, pixel
from bsm.codec.denoise.surface import unit
from bsm.codec.geometry.metrics import mean_edge_length

RULES = {
    "white": (2.94, 12.52, -3.53, -9.01, 0.00, -1.10, -9.80, 7.71),
    "correlated": (0.00, 1.56, -5.68, -16.67, -2.00, -1.33, 0.00, 3.71),
    "local": (4.60, 15.14, -4.08, 0.00, 0.00, -4.03, -6.65, 6.41),
    "view": (6.95, -6.13, 0.00, -24.18, 0.00, 0.00, -23.39, 14.50),
    "axis": (3.58, 15.95, 0.00, -27.46, 0.00, -3.24, -14.37, 8.02),
}
"""Of each kind, the weights of `measures` and a constant: noise is believed if the sum is positive. `tools.train_noise`
fits them, and names the meshes that it holds out."""
FAINTEST = 0.03  # level in mean edges, or widths of pixels, below which nothing is suspected
# If whiteness is below the second: fine levels hold little of such noise.
FAINTEST_SHARED, MUCH_SHARED = 0.024, 0.6
FEWEST_WINDOWS = 5  # for an estimate
WHITE = 0.82  # whiteness below which noise is correlated
NEARBY = 4  # rings of a vertex that tell the side where noise ends
NARROWER = 1.04
"""What broad filters may see of views fused on a lattice, over their level: .9 to 1.0; of fields without noise they see
1.05 (a fractal) to 1.9."""
# Share of the stairs of a binary volume, from which on all its walls are one cell thick.
ONE_CELL = 0.9
# Largest share of vertices that show nothing of rounding: shapes drawn on a grid have more.
ROUNDED_ZEROS = 0.15
# Averagings before the normals that tell sides from ends: noise along an axis turns normals far.
AXIS_PASSES = 8
AXIS_ALONE, AXIS_EVEN = 1.25, (0.55, 1.7)
"""Noise along an axis over that across; and on sides along the axis over that at its ends: noise along normals reads 0
to 0.8 there, triangles that are longer one way 1.8 and more."""
AXIS_BARE = 0.58
"""On sides along the axis, noise along normals over that along it: detail reads up to 0.45, noise along normals 0.7."""
SNAP = 0.995  # cosine from which on an axis is x, y or z
DEPTH_WORTH = 0.7  # of noise that grows with depth: the rest of the spread


ASIDE = 0.2  # largest median of values over their levels: noise lies on both sides
HEAP = 1.6  # largest share of values about zero, as a multiple of the normal distribution's
# Chance makes levels of windows of w vertices spread by about this over sqrt(w).
LEVEL_SPREAD = 0.92
MEASURES = ("level", "whiteness", "off", "uneven", "broadly uneven", "irregular", "few")
MANY_WINDOWS = 25  # fewer say less about the spread of levels
# Of the broad level over the whiteness (logarithms), for all lengths of correlation.
SLOPE, SHIFT = 0.6, 0.15


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
        return float(
            np.quantile(self.finest[windows], 0.25)
            / max(np.quantile(self.levels[windows], 0.25), 1e-9)
        )

    def is_random(self, windows: Mask) -> bool:
        """Whether counted vertices of these windows lie on both sides of the surface, and no heap of them on it."""
        chosen = windows[self.probe.windows.labels] & self.probe.counted
        values = self.along[chosen] / np.maximum(
            self.levels[self.probe.windows.labels[chosen]], 1e-9
        )
        # The share of a standard normal distribution within a tenth of a deviation is 0.0797.
        return bool(
            abs(np.median(values)) < ASIDE and (np.abs(values) < 0.1).mean() < HEAP * 0.0797
        )

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


class Suspect(NamedTuple):
    """A finding, the rule that it has to pass, and the measures for it."""

    finding: Finding
    rule: str
    measures: Floats

    @property
    def score(self) -> float:
        *weights, constant = RULES[self.rule]
        return float(self.measures @ np.array(weights) + constant)


def find_noise(positions: Positions, probe: Probe) -> Finding:
    """Return the first kind of noise that the coordinates tell, or that its rule believes."""
    edge, nothing = mean_edge_length(positions, probe.topology.faces), np.zeros(probe.topology.n)
    # Coordinates that tell a cause come first: nothing has to be guessed then.
    if cells := _cells(positions, probe, edge):
        return cells
    # A spread over three windows says nothing. "Unknown" is honest, and nothing is changed.
    if int(probe.windows.valid.sum()) < FEWEST_WINDOWS:
        return Finding("unknown", 0.0, nothing, edge, "too few vertices to tell noise from shape")
    evidence = surface(positions, probe, edge)
    if finding := _rounded(positions, evidence) or _fused(positions, evidence):
        return finding
    # The most special first: noise along an axis would also pass as noise all over, which is treated worse.
    for suspect in suspects(positions, evidence):
        if suspect.score > 0.0:
            return suspect.finding
    level = float(np.nanmedian(evidence.levels))
    reason = "its roughness follows the shape, as detail and edges do and noise does not"
    if level < FAINTEST:
        reason = f"at most {level:.3f} mean edges of noise, no more than a clean mesh has detail"
    return Finding("none", 0.0, nothing, edge, reason)


def surface(positions: Positions, probe: Probe, edge: float) -> Evidence:
    """Return what filters see along the normals of a surface, in mean edges."""
    return look(probe, positions / edge, probe.smooth_normals(positions), edge)


def suspects(positions: Positions, evidence: Evidence) -> Iterator[Suspect]:
    """Yield the kinds of noise that there may be, the most special first."""
    for test in (_seen, _one_axis, _everywhere, _here_and_there):
        if suspect := test(positions, evidence):
            yield suspect


def _cells(positions: Positions, probe: Probe, edge: float) -> Finding | None:
    """On the edges between cells of a volume."""
    cells = find_cells(positions, probe.topology)
    if cells is None:
        return None
    if cells.thin > ONE_CELL:
        reason = "its walls are one cell of a binary volume thick, too thin to tell their shape"
        return Finding("none", 0.0, np.zeros(len(positions)), edge, reason, bound=cells)
    levels = Spacing(cells.steps).levels(probe.smooth_normals(positions) @ cells.frame.T)
    sizes = " x ".join(f"{step:.3g}" for step in cells.steps)
    where = "x, y and z" if np.array_equal(cells.frame, np.eye(3)) else "axes of its own"
    reason = f"stairs along {where} of a binary volume of cells of {sizes}; no vertex leaves its half-cell"
    if cells.thick > 1:
        reason = f"stairs along {where} of a volume of slices, {cells.thick:.3g} cells thick, of cells of {sizes}"
    return Finding("cells", float(np.median(levels)), levels, edge, reason, bound=cells)


def _rounded(positions: Positions, evidence: Evidence) -> Finding | None:
    """Known from the coordinates, and as strong as the cells are large."""
    grid = find_grid(positions)
    if grid is None:
        return None
    expected = grid.levels(evidence.normals) / evidence.edge
    level = float(np.median(expected))
    unmoved = np.abs(evidence.along) <= 0.1 * expected
    if level < FAINTEST or unmoved[evidence.probe.counted].mean() > ROUNDED_ZEROS:
        return None
    reason = (
        f"positions rounded to a grid of {float(grid.steps.max()) / evidence.edge:.2f} mean edges"
    )
    return Finding(
        "grid", level * evidence.edge, expected * evidence.edge, evidence.edge, reason, bound=grid
    )


def _fused(positions: Positions, evidence: Evidence) -> Finding | None:
    """On the lattice of a field of distances, and as strong in one place as in another."""
    everywhere = evidence.probe.windows.valid
    levels = evidence.levels[everywhere]
    level, uneven = float(np.median(levels)), spread(levels, evidence.probe.windows)
    if level < FAINTEST or not lattice_step(positions):
        return None
    if not np.quantile(evidence.broad[everywhere] / levels, 0.25) <= NARROWER:
        return None
    amount = np.full(len(positions), level * evidence.edge)
    reason = "noise of a volume, or of views fused on a lattice"
    return Finding(
        "fused", level * evidence.edge, amount, evidence.edge, reason, uneven=uneven, clear=False
    )


def _seen(positions: Positions, evidence: Evidence) -> Suspect | None:
    """On a grid of pixels, along the rays to them."""
    probe, edge = evidence.probe, evidence.edge
    view = find_view(positions, probe)
    if view is None:
        return None
    along = look(
        probe, view.heights(positions, probe.topology)[:, None], np.ones((len(positions), 1)), edge
    )
    level = along.level(probe.windows.valid)
    rays = positions - view.eye
    width = pixel(view.plane(positions), probe.topology) * (rays @ view.axis)
    amount = level * width * np.abs(np.einsum("ij,ij->i", unit(rays), evidence.normals))
    reason, view = "noise of a camera, along its rays", replace(view, level=level)
    reason += ", with depths in steps" if view.stepped else ""
    return _suspect(
        "view", along, Finding("view", float(np.median(amount)), amount, edge, reason, view=view)
    )


def _suspect(
    rule: str, evidence: Evidence, finding: Finding, windows: Mask | None = None
) -> Suspect | None:
    """Return the suspect if values in these windows are as random as noise."""
    chosen = evidence.probe.windows.valid if windows is None else windows
    faintest = FAINTEST
    if evidence.whiteness(chosen) < MUCH_SHARED:
        faintest = FAINTEST_SHARED
    if evidence.level(chosen) <= faintest or not evidence.is_random(chosen):
        return None
    return Suspect(finding, rule, evidence.measures(chosen))


def _one_axis(positions: Positions, evidence: Evidence) -> Suspect | None:
    """As strong along one direction, whichever way the surface faces."""
    probe, chosen, edge = evidence.probe, evidence.probe.counted, evidence.edge
    fine = probe.fine(positions / edge)
    length = np.linalg.norm(fine, axis=1)
    # A few creases must not set the direction, so long vectors are shortened.
    calm = (
        fine
        * np.minimum(1.0, np.quantile(length[chosen], 0.8) / np.maximum(length, 1e-300))[:, None]
    )
    values, vectors = np.linalg.eigh(calm[chosen].T @ calm[chosen] / chosen.sum())
    if values[2] < AXIS_ALONE**2 * values[1]:
        return None
    axis = vectors[:, 2] * np.sign(vectors[np.abs(vectors[:, 2]).argmax(), 2])
    # Cameras and printers are aligned to an axis much more often than nearly aligned.
    axis = np.round(axis) if np.abs(axis).max() > SNAP else axis
    normals = probe.smooth_normals(positions, AXIS_PASSES)
    facing = np.abs(normals @ axis)
    beside, ends = (chosen & (facing < 0.35)), (chosen & (facing >= 0.7))
    if min(beside.sum(), ends.sum()) < FEWEST_IN_WINDOW:
        return None
    seen = (
        (fine @ axis)[beside],
        (fine @ axis)[ends],
        np.einsum("ij,ij->i", fine, normals)[beside],
    )
    side, end, bare = (float(np.quantile(np.abs(values), SHARE)) for values in seen)
    if not AXIS_EVEN[0] * end < side < AXIS_EVEN[1] * end or bare > AXIS_BARE * side:
        return None
    along = look(probe, positions / edge, np.tile(axis, (len(positions), 1)), edge)
    growth = _growth(along, positions @ axis)
    along = along if growth is None else along.weakened(growth)
    # The shape adds as much along the axis as across it, where it is seen alone.
    level = float(np.sqrt(max(along.level(probe.windows.valid) ** 2 - values[1], 0.0)))
    if level < FAINTEST:
        return None
    amount = level * edge * (np.ones(len(positions)) if growth is None else growth)
    reason = f"noise along one axis ({', '.join(f'{component:.2f}' for component in axis)})"
    if growth is not None:
        reason += f", {growth.max() / growth.min():.1f} times as strong at one end as at the other"
    facing = np.abs(evidence.normals @ axis)
    bound = Box(axis[None], FARTHEST * amount.max(keepdims=True))
    finding = Finding(
        "axis", level * edge, amount * facing, edge, reason, axis=axis, growth=growth, bound=bound
    )
    return _suspect("axis", along, finding)


def _growth(along: Evidence, depth: Floats) -> Floats | None:
    """How many times as strong noise is at each depth as in the middle; None: as strong, or not told by depth."""
    windows = along.probe.windows
    depth = (depth - depth.min()) / (np.ptp(depth) or 1.0) - 0.5
    levels, middles = along.levels[windows.valid], windows.means(depth)[windows.valid]
    rate = np.polyfit(middles, np.log(np.maximum(levels, 1e-9)), 1)[0]
    even = spread(levels / np.exp(rate * middles), windows) < DEPTH_WORTH * spread(levels, windows)
    return np.exp(rate * depth) if even else None


def _everywhere(positions: Positions, evidence: Evidence) -> Suspect | None:
    """As strong in one place as in another."""
    valid = evidence.probe.windows.valid
    level, whiteness = evidence.level(valid), evidence.whiteness(valid)
    kind = "correlated" if whiteness < WHITE else "white"
    amount = np.full(len(positions), level * evidence.edge)
    reason = "noise that neighbors share, all over" if kind == "correlated" else "noise all over"
    finding = Finding(
        kind, level * evidence.edge, amount, evidence.edge, reason, whiteness=whiteness
    )
    return _suspect(kind, evidence, finding)


def _here_and_there(positions: Positions, evidence: Evidence) -> Suspect | None:
    """Strong and even in some windows, weak in the others."""
    probe, windows = evidence.probe, evidence.probe.windows
    levels = np.where(windows.valid, evidence.levels, 0.0)
    logarithms = np.log(np.maximum(levels[windows.valid], 0.02))
    # The centers of the two groups that differ most.
    centers, _ = kmeans(logarithms, np.array([logarithms.min(), logarithms.max()]))
    above = levels > np.exp(centers.mean())
    inner = above & ~windows.beside(~above & windows.valid)
    if not inner.any():
        return None
    level, weak = float(np.median(levels[inner])), float(np.median(levels[windows.valid & ~above]))
    # Where windows of both sorts meet, the vertices decide: by what is about each of them.
    inside = inner[windows.labels]
    unsure = ((above & ~inner) | (~above & windows.beside(above)))[windows.labels]
    nearby = np.square(np.minimum(np.abs(evidence.along), 3.0 * level))
    # Windows are coarser than the edge of a noisy part. Near it, each vertex is judged by its surroundings.
    for _ in range(NEARBY):
        nearby = probe.average @ nearby
    inside[unsure] = nearby[unsure] > (0.5 * level) ** 2
    amount = np.where(inside, level * evidence.edge, 0.0)
    share = f"noise in {100.0 * inside.mean():.0f} % of the mesh"
    finding = Finding(
        "local", level * evidence.edge, amount, evidence.edge, share, clear=weak < FAINTEST
    )
    return _suspect("local", evidence, finding, inner)
