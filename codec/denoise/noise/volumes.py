"""Binary volumes: surfaces in stairs, which marching cubes leave halfway between cells.

The finer half of a vertex's place is known: the surface crosses the edge between two cells along which the vertex lies,
anywhere on it. So the filter looks for the surface of fewest bends within these bounds (iteratively reweighted least
squares; accelerated projected gradients, Beck and Teboulle 2009), however thick the slices are.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from bsm.codec.arrays import Floats, Order, Positions
from bsm.codec.denoise.noise.causes import FEW_VALUES, FEWEST_VALUES, Box, rounding_step
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.surface import Topology

HALFWAY = 0.98  # share of the vertices of a binary volume that lie halfway between two cells
ALIKE, TOGETHER = 1e-3, 1e-4  # directions that are one, and coordinates of one level, in extents
SAMPLE, DIRECTIONS = 10_000, 5  # faces to look at, and directions of edges that are considered
ROUNDS, STEPS = 3, 75


@dataclass(frozen=True, eq=False)
class Cells(Box):
    """Cells of a binary volume along the rows of `frame`, and how far each vertex may move along these."""

    steps: Floats
    thick: float = 1.0  # cells of a slice
    thin: float = 0.0  # share of the stairs along an axis that bound walls of one cell

    @property
    def flatness(self) -> float:
        """The largest step over the smallest, those of slices of many cells included."""
        return float(self.steps.max() / self.steps.min())

    def flattened(self, positions: Positions, topology: Topology) -> Positions:
        """The surface of fewest bends within the bounds, shape (n, 3)."""
        bends = (sparse.identity(topology.n, format="csr") - Probe(topology).average).tocsr()
        back = bends.T.tocsr()
        given = found = positions @ self.frame.T
        weights = np.ones((topology.n, 1))
        for turn in range(ROUNDS + 1):
            if turn:
                bent = np.linalg.norm(bends @ found, axis=1, keepdims=True)
                weights = 1.0 / np.maximum(np.hypot(bent, np.median(bent)), 1e-300)
                weights /= weights.max()
            # A step above the inverse of the curvature diverges. The start is fixed, so that results are.
            start = np.random.default_rng(0).normal(size=topology.n)
            curve = linalg.svds(bends.multiply(np.sqrt(weights)), 1, v0=start, return_singular_vectors=False)
            step, ahead, pace = 1.0 / max(float(curve[0]) ** 2, 1e-300), found, 1.0
            for _ in range(STEPS):
                slope = back @ (weights * (bends @ ahead))
                last, found = found, np.clip(ahead - step * slope, given - self.half, given + self.half)
                # Acceleration is given up where it points uphill (O'Donoghue and Candes 2015), or it would swing about
                # the solution.
                uphill = ((ahead - found) * (found - last)).sum() > 0.0
                before, pace = (1.0, 1.0) if uphill else (pace, 0.5 + np.sqrt(0.25 + pace * pace))
                ahead = found + (before - 1.0) / pace * (found - last)
        return np.asarray(found @ self.frame)


def find_cells(positions: Positions, topology: Topology) -> Cells | None:
    """The cells of a binary volume whose surface by marching cubes positions, shape (n, 3), are, in any direction."""
    cells = _cells(positions, np.eye(3))
    # Most volumes are aligned to x, y and z. Turned ones are looked for only after that.
    for frame in () if cells else _frames(positions, topology):
        cells = cells or _cells(np.stack([_snapped(column) for column in frame @ positions.T], axis=1), frame)
    return cells


def _cells(places: Positions, frame: Floats) -> Cells | None:
    halves = np.array([rounding_step(column, FEW_VALUES) or 0.0 for column in places.T])
    if not halves.all():
        return None
    numbers = np.round((places - places.min(axis=0)) / halves).astype(np.int64)
    axes = np.array([1, 2, 4])
    counts = np.bincount((numbers & 1) @ axes, minlength=8)
    offset = max(range(8), key=lambda offset: int(counts[axes ^ offset].sum()))
    # Each vertex of marching cubes on a binary volume is halfway along one axis and on cells along the other two.
    if counts[axes ^ offset].sum() < HALFWAY * len(places):
        return None
    between = ((numbers ^ (offset >> np.arange(3))) & 1).astype(np.bool_)
    size = int(numbers.max()) + 3
    scales = np.array([1, size, size * size])
    thin = 0.0
    for axis, scale in enumerate(scales):
        stairs = numbers[between[:, axis]] @ scales
        thin = max(thin, 2.0 * float(np.isin(stairs + 2 * scale, stairs).mean())) if len(stairs) else thin
    levels = [np.unique(numbers[between[:, axis], axis]) for axis in range(3)]
    steps, thick = 2.0 * halves, 1.0
    half = np.where(between, halves, halves.min())
    gaps = [int(np.diff(level).min()) // 2 if len(level) > 1 else 0 for level in levels]
    axis = int(np.argmax(gaps))
    planes = levels[axis]
    # Stairs that somebody built have broad steps along other axes as well, or few and equal ones.
    few = FEW_VALUES - (len(np.unique(np.diff(planes))) > 1)
    fine = all(len(levels[k]) >= FEWEST_VALUES and gaps[k] == 1 for k in range(3) if k != axis)
    if fine and len(planes) > few and gaps[axis] > 1 and (thick := slice_thickness(planes)) > 1.0:
        steps[axis] *= thick
        place = np.clip(np.searchsorted(planes, numbers[:, axis]), 1, len(planes) - 1)
        # Only the middle of a slice was sampled.
        aside = np.abs(numbers[:, axis] - 0.5 * (planes[place - 1] + planes[place])) > 1.0
        half[aside | between[:, axis]] = np.inf
        half[aside | between[:, axis], axis] = thick * halves[axis]
    return Cells(frame, half, steps, thick, thin)


def slice_thickness(planes: Order) -> float:
    """Cells of even slices of which planes, ascending in half-cells, are the ends, rounded to cells; 1 of others."""
    heights, gaps = 0.5 * (planes - planes[0]), 0.5 * np.diff(planes)
    thick, begin = float(gaps[gaps <= gaps.min() + 1.0].mean()), 0.0
    for _ in range(3):
        numbers = np.round((heights - begin) / thick)
        # Slices are rarely a whole number of cells thick, so ends are rounded up and down by turns.
        thick, begin = np.polyfit(numbers, heights, 1)
    return float(thick) if np.abs(heights - begin - thick * numbers).max() < 1.0 else 1.0


def _frames(positions: Positions, topology: Topology) -> list[Floats]:
    """Right-angled frames of directions that many edges have, as those of stairs do."""
    faces = topology.faces[:: 1 + len(topology.faces) // SAMPLE]
    ways = (positions[np.roll(faces, 1, axis=1)] - positions[faces]).reshape(-1, 3)
    lengths = np.linalg.norm(ways, axis=1, keepdims=True)
    ways = ways[lengths[:, 0] > 0.0] / lengths[lengths[:, 0] > 0.0]
    ways *= np.where(np.take_along_axis(ways, np.abs(ways).argmax(axis=1)[:, None], axis=1) < 0.0, -1.0, 1.0)
    keys, counts = np.unique(np.round(ways / ALIKE).astype(np.int64), axis=0, return_counts=True)
    order = np.argsort(-counts, kind="stable")[: 2 * DIRECTIONS]
    found: list[Floats] = []
    for key in keys[order] * ALIKE:
        if len(found) < DIRECTIONS and all(np.linalg.norm(key - other) > 4.0 * ALIKE for other in found):
            mean = ways[np.linalg.norm(ways - key, axis=1) < 2.0 * ALIKE].sum(axis=0)
            found.append(mean / np.linalg.norm(mean))
    square = [pair for pair in combinations(found, 2) if abs(float(pair[0] @ pair[1])) < 4.0 * ALIKE]
    return [np.linalg.qr(np.stack([*pair, np.cross(*pair)], axis=1))[0].T for pair in square]


def _snapped(column: Floats) -> Floats:
    """Coordinates that lie close together become one."""
    order = np.argsort(column, kind="stable")
    number = np.zeros(len(column), dtype=np.int64)
    number[order[1:]] = np.cumsum(np.diff(column[order]) > TOGETHER * np.ptp(column))
    return np.asarray((np.bincount(number, column) / np.bincount(number))[number])
