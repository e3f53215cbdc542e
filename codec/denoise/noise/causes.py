"""Causes that the coordinates tell, and how far each lets a vertex be from the surface.

Rounding to a grid leaves a vertex within half a cell, and noise along an axis on a line. Marching cubes of a binary
volume leave stairs: the surface crosses the edge between two cells along which a vertex lies, anywhere on it. So the
surface of fewest bends within these bounds is looked for (iteratively reweighted least squares; accelerated projected
gradients, Beck and Teboulle 2009), however thick the slices are.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from bsm.codec.arrays import Faces, Floats, Indices, Order, Positions
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.surface import Topology, surface_normals
from bsm.codec.geometry.welding import weld

FEWEST_VALUES = 16  # with fewer different values of a coordinate, a grid looks like a few planes
NEAR = 0.02  # distance from a multiple, in steps, that the six or seven digits of files explain
SAME = 1e-6  # values closer together, as a share of the extent, are one value
# Averagings that part vertices that rounding has merged: faces without area tell no normal.
SPREADS = 3
FEW_VALUES = 4  # of a coordinate that lies on half-cells
HALFWAY = 0.98  # share of the vertices of a binary volume that lie halfway between two cells
ALIKE, TOGETHER = 1e-3, 1e-4  # directions that are one, and coordinates of one level, in extents
SAMPLE, DIRECTIONS = 10_000, 5  # faces to look at, and directions of edges that are considered
ROUNDS, STEPS = 3, 75
LATTICE_USUAL = 0.25  # vertices that a plane of a lattice has at least, over the usual


@dataclass(frozen=True, eq=False)
class Spacing:
    """Cells within which positions are indistinguishable."""

    steps: Floats

    def round(self, positions: Positions, offset: Floats) -> Positions:
        """Positions in the middle of their cells, of which one has its middle at `offset`, shape (3,)."""
        safe = np.where(self.steps > 0.0, self.steps, 1.0)
        return np.where(
            self.steps > 0.0, np.round((positions - offset) / safe) * safe + offset, positions
        )

    def levels(self, normals: Floats) -> Floats:
        """Standard deviation along normals, shape (n, 3), of what rounding takes away or adds, shape (n,)."""
        return np.asarray(np.sqrt(np.square(normals * self.steps).sum(axis=1) / 12.0))

    def within(self, noisy: Positions, moved: Positions) -> Positions:
        # Rounded values are within half a step of the true ones: the one thing that is certain.
        half = np.where(self.steps > 0.0, 0.5 * self.steps, np.inf)
        return np.clip(moved, noisy - half, noisy + half)

    def parted(self, rounded: Positions, probe: Probe) -> Positions:
        """Rounded positions, shape (n, 3); neighbors at one position are drawn to their other neighbors."""
        starts, members = probe.topology.neighbors
        owners = np.repeat(np.arange(len(rounded)), np.diff(starts))
        merged = np.unique(owners[(rounded[owners] == rounded[members]).all(axis=1)])
        result, around = rounded.copy(), probe.average[merged]
        for _ in range(SPREADS if len(merged) else 0):
            result[merged] = self.within(rounded[merged], around @ result)
        return result


def find_grid(positions: Positions) -> Spacing | None:
    """The grid that the positions, shape (n, 3), were rounded to, in all coordinates."""
    steps = [rounding_step(positions[:, axis]) for axis in range(3)]
    # A flat part may have one coordinate that tells nothing. Two that do are evidence enough.
    sizes = np.array([step for step in steps if step is not None])
    if len(sizes) < 3 or np.count_nonzero(sizes > 0.0) < 2:
        return None
    return Spacing(sizes)


def weld_seams(positions: Positions, faces: Faces) -> tuple[Positions, Faces, Indices]:
    """What `weld` makes of positions, shape (n, 3); on a grid only vertices of the boundary are welded."""
    welded, joined, index = weld(positions, faces)
    n = len(positions)
    if len(welded) == n or find_grid(welded) is None:
        return welded, joined, index
    # On a grid, vertices meet by chance. Only those of borders are seams.
    index = np.where(Topology(faces, n).boundary, n + index, np.arange(n))
    index = np.unique(index, return_inverse=True)[1].ravel().astype(np.int32)
    return positions[np.unique(index, return_index=True)[1]], index[faces], index


def rounding_step(coordinate: Floats, fewest: int = FEWEST_VALUES) -> float | None:
    """Size of a cell; 0 where there are too few values to tell, None where they are not rounded."""
    extent = float(np.ptp(coordinate))
    values = np.unique(coordinate)
    gaps = np.diff(values)
    gaps = gaps[gaps > SAME * extent]
    if len(gaps) < fewest:
        return 0.0
    # The smallest gap between values is one step, unless few values are seen.
    count = round(extent / float(gaps.min()))
    # One gap alone is known no better than the file's last digits: all of them together say it.
    step = extent / count
    for _ in range(3):
        numbers = np.round((values - values[0]) / step)
        step = float(numbers @ (values - values[0]) / (numbers @ numbers))
    off = np.abs((values - values[0]) / step - np.round((values - values[0]) / step))
    # Any few numbers are multiples of a tiny step. Enough places of the grid must be taken.
    rounded = off.max() < NEAR and len(values) * 8 > count
    return step if rounded else None


@dataclass(frozen=True, eq=False)
class Box:
    """Axes along which vertices were moved, the rows of `frame`, and how far at most."""

    frame: Floats
    half: Floats

    def within(self, noisy: Positions, moved: Positions) -> Positions:
        way = np.clip((moved - noisy) @ self.frame.T, -self.half, self.half)
        return np.asarray(noisy + way @ self.frame)


FARTHEST, ASIDE = 5.0, 1.5
"""Levels of noise that a vertex moves at most; and those along the surface that it approaches, however far it would
slide. Both leave the angles of noise along normals and of single vertices as they are or better."""


@dataclass(frozen=True, eq=False)
class Reach:
    """Where noise may have come from: its levels, shape (n,), and whether it moves vertices along the surface, too."""

    topology: Topology
    levels: Floats
    slides: bool

    def within(self, noisy: Positions, moved: Positions) -> Positions:
        way = moved - noisy
        level = np.maximum(self.levels, 1e-300)[:, None]
        if not self.slides:
            normals = surface_normals(moved, self.topology)
            along = np.einsum("ij,ij->i", way, normals)[:, None] * normals
            across = way - along
            # Motion along the surface is damped and not cut, so that no vertex sticks at a bound.
            way = along + across / (
                1.0 + np.linalg.norm(across, axis=1, keepdims=True) / (ASIDE * level)
            )
        far = np.linalg.norm(way, axis=1, keepdims=True) / (FARTHEST * level)
        return np.asarray(noisy + way / np.maximum(far, 1.0))


Confines = Spacing | Box | Reach
"""Where a vertex may be: `within` brings moved positions, shape (n, 3), back to where the noisy ones may be."""


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
        middles = places = positions @ self.frame.T
        lowest, highest = middles - self.half, middles + self.half
        weights = np.ones((topology.n, 1))
        for turn in range(ROUNDS + 1):
            if turn:
                bent = np.linalg.norm(bends @ places, axis=1, keepdims=True)
                weights = 1.0 / np.maximum(np.hypot(bent, np.median(bent)), 1e-300)
                weights /= weights.max()
            # A step above the inverse of the curvature diverges. The start is fixed, so that results are.
            start = np.random.default_rng(0).normal(size=topology.n)
            curve = linalg.svds(
                bends.multiply(np.sqrt(weights)), 1, v0=start, return_singular_vectors=False
            )
            step = 1.0 / max(float(curve[0]) ** 2, 1e-300)
            ahead, pace = places, 1.0
            for _ in range(STEPS):
                slope = back @ (weights * (bends @ ahead))
                last_places, places = places, np.clip(ahead - step * slope, lowest, highest)
                moves = places - last_places
                last_pace, pace = pace, 0.5 + np.sqrt(0.25 + pace * pace)
                uphill = ((ahead - places) * moves).sum() > 0.0
                if uphill:
                    # Acceleration would swing about the solution, and starts again (O'Donoghue and Candes 2015).
                    last_pace, pace = 1.0, 1.0
                ahead = places + (last_pace - 1.0) / pace * moves
        return np.asarray(places @ self.frame)


def find_cells(positions: Positions, topology: Topology) -> Cells | None:
    """The cells of a binary volume whose surface by marching cubes positions, shape (n, 3), are, in any direction."""
    if cells := _cells(positions, np.eye(3)):
        return cells
    # Most volumes are aligned to x, y and z. Turned ones are looked for only after that.
    for frame in _frames(positions, topology):
        columns = [_snapped(column) for column in frame @ positions.T]
        if cells := _cells(np.stack(columns, axis=1), frame):
            return cells
    return None


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
        if len(stairs):
            thin = max(thin, 2.0 * float(np.isin(stairs + 2 * scale, stairs).mean()))
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
    even = np.abs(heights - begin - thick * numbers).max() < 1.0
    return float(thick) if even else 1.0


def _frames(positions: Positions, topology: Topology) -> list[Floats]:
    """Right-angled frames of directions that many edges have, as those of stairs do."""
    faces = topology.faces[:: 1 + len(topology.faces) // SAMPLE]
    ways = (positions[np.roll(faces, 1, axis=1)] - positions[faces]).reshape(-1, 3)
    lengths = np.linalg.norm(ways, axis=1, keepdims=True)
    ways = ways[lengths[:, 0] > 0.0] / lengths[lengths[:, 0] > 0.0]
    ways *= np.where(
        np.take_along_axis(ways, np.abs(ways).argmax(axis=1)[:, None], axis=1) < 0.0, -1.0, 1.0
    )
    keys, counts = np.unique(np.round(ways / ALIKE).astype(np.int64), axis=0, return_counts=True)
    order = np.argsort(-counts, kind="stable")[: 2 * DIRECTIONS]
    directions = np.zeros((0, 3))
    for key in keys[order] * ALIKE:
        distinct = (np.linalg.norm(directions - key, axis=1) > 4.0 * ALIKE).all()
        if len(directions) < DIRECTIONS and distinct:
            mean = ways[np.linalg.norm(ways - key, axis=1) < 2.0 * ALIKE].sum(axis=0)
            directions = np.append(directions, [mean / np.linalg.norm(mean)], axis=0)
    frames = []
    for first, second in combinations(directions, 2):
        if abs(float(first @ second)) < 4.0 * ALIKE:
            axes = np.stack([first, second, np.cross(first, second)], axis=1)
            frames.append(np.linalg.qr(axes)[0].T)
    return frames


def _snapped(column: Floats) -> Floats:
    """Coordinates that lie close together become one."""
    order = np.argsort(column, kind="stable")
    number = np.zeros(len(column), dtype=np.int64)
    number[order[1:]] = np.cumsum(np.diff(column[order]) > TOGETHER * np.ptp(column))
    return np.asarray((np.bincount(number, column) / np.bincount(number))[number])


def lattice_step(positions: Positions) -> float:
    """Step of the cubic lattice on whose lines the positions lie, as those of marching cubes do; 0 if there is none."""
    extent = float(np.ptp(positions, axis=0).max())
    planes = []
    for column in positions.T:
        # Marching cubes leave two coordinates of each vertex on planes of the lattice: heaps of equal values.
        values, counts = np.unique(
            np.round((column - column.min()) / (SAME * extent or 1.0)), return_counts=True
        )
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
