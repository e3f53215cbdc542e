"""Causes that the coordinates tell, and how far each lets a vertex be from the surface.

Rounding to a grid and marching cubes of a binary volume leave a vertex within half a cell, and noise along an axis on a
line.
"""

from dataclasses import dataclass

import numpy as np

from bsm.codec.arrays import Faces, Floats, Indices, Positions
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.surface import Topology, surface_normals
from bsm.codec.geometry.welding import weld

FEWEST_VALUES = 16  # with fewer different values of a coordinate, a grid looks like a few planes
# Files write six or seven digits, so a grid is met only nearly.
NEAR = 0.02  # distance from a multiple, in steps, that the precision of files explains
SAME = 1e-6  # values closer together, as a share of the extent, are one value
# Rounding puts neighbors at one place, and faces without area tell no normal.
SPREADS = 3  # averagings that part vertices that rounding has merged

FEW_VALUES = 4  # of a coordinate that lies on half-cells


@dataclass(frozen=True, eq=False)
class Spacing:
    """Cells within which positions are indistinguishable."""

    steps: Floats

    def round(self, positions: Positions, offset: Floats) -> Positions:
        """Positions in the middle of their cells, of which one has its middle at `offset`, shape (3,)."""
        safe = np.where(self.steps > 0.0, self.steps, 1.0)
        return np.where(self.steps > 0.0, np.round((positions - offset) / safe) * safe + offset, positions)

    def levels(self, normals: Floats) -> Floats:
        """Standard deviation along normals, shape (n, 3), of what rounding takes away or adds, shape (n,)."""
        return np.asarray(np.sqrt(np.square(normals * self.steps).sum(axis=1) / 12.0))

    def within(self, given: Positions, moved: Positions) -> Positions:
        # Rounded values are within half a step of the true ones: the one thing that is certain.
        half = np.where(self.steps > 0.0, 0.5 * self.steps, np.inf)
        return np.clip(moved, given - half, given + half)

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
    known = [step for step in steps if step is not None]
    return Spacing(np.array(known)) if len(known) == 3 and sum(step > 0.0 for step in known) >= 2 else None


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
    return step if off.max() < NEAR and len(values) * 8 > count else None


@dataclass(frozen=True, eq=False)
class Box:
    """Axes along which vertices were moved, the rows of `frame`, and how far at most."""

    frame: Floats
    half: Floats

    def within(self, given: Positions, moved: Positions) -> Positions:
        return np.asarray(given + np.clip((moved - given) @ self.frame.T, -self.half, self.half) @ self.frame)


FARTHEST, ASIDE = 5.0, 1.5
"""Levels of noise that a vertex moves at most; and those along the surface that it approaches, however far it would
slide. Both leave the angles of noise along normals and of single vertices as they are or better."""


@dataclass(frozen=True, eq=False)
class Reach:
    """Where noise may have come from: its levels, shape (n,), and whether it moves vertices along the surface, too."""

    topology: Topology
    levels: Floats
    slides: bool

    def within(self, given: Positions, moved: Positions) -> Positions:
        way, level = moved - given, np.maximum(self.levels, 1e-300)[:, None]
        if not self.slides:
            normals = surface_normals(moved, self.topology)
            along = np.einsum("ij,ij->i", way, normals)[:, None] * normals
            across = way - along
            # Motion along the surface is damped and not cut, so that no vertex sticks at a bound.
            way = along + across / (1.0 + np.linalg.norm(across, axis=1, keepdims=True) / (ASIDE * level))
        far = np.linalg.norm(way, axis=1, keepdims=True) / (FARTHEST * level)
        return np.asarray(given + way / np.maximum(far, 1.0))


Confines = Spacing | Box | Reach
"""Where a vertex may be: `within` brings moved positions, shape (n, 3), back to where those that were given may be."""
