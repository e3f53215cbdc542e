"""Scans of one view: a regular grid of pixels seen from an eye, with noise along the rays of the camera.

The inverse depth of a plane is linear over the pixels. So the filter looks for the surface of fewest bends near the
measured one.
"""

from dataclasses import dataclass, replace
from operator import itemgetter

import numpy as np

from bsm.codec.arrays import Floats, Positions
from bsm.codec.denoise.bends import fewer_bends
from bsm.codec.denoise.noise.causes import rounding_step
from bsm.codec.denoise.noise.probe import SHARE, Probe
from bsm.codec.denoise.surface import Topology

FAR = 1e3  # extents between an eye and the mesh from which on rays are parallel
REGULAR, ONE_SIDED = 0.08, 0.98
"""Middle distance of pixels from the mean of their neighbors, in edges, and share of the faces seen from one side."""


@dataclass(frozen=True, eq=False)
class View:
    """Where the camera is, the direction that it looks in, and how strong its noise is, in pixels' widths."""

    eye: Floats
    axis: Floats
    level: float = 0.0
    stepped: bool = False  # whether the camera tells depths, or their inverses, apart in steps only

    def plane(self, positions: Positions) -> Floats:
        """Where the vertices are in the picture, shape (n, 2)."""
        rays = positions - self.eye
        # Any two directions at right angles to the axis will do.
        across = np.linalg.svd(self.axis[None])[2][1:]
        return np.asarray(rays @ across.T / (rays @ self.axis)[:, None])

    def heights(self, positions: Positions, topology: Topology) -> Floats:
        """Inverse depths, shape (n,), whose unit is a pixel's width where the mesh is."""
        depth = (positions - self.eye) @ self.axis
        return np.asarray(depth.mean() / depth / pixel(self.plane(positions), topology))

    def at(self, positions: Positions, before: Floats, after: Floats) -> Positions:
        """Positions moved along their rays from some inverse depths to others."""
        return np.asarray(self.eye + (positions - self.eye) * (before / after)[:, None])

    def flattened(self, positions: Positions, topology: Topology, strength: float) -> Positions:
        given = self.heights(positions, topology)[:, None]
        plane = self.plane(positions)
        heights = fewer_bends(
            given, plane / pixel(plane, topology), topology, strength * self.level
        )
        return self.at(positions, given[:, 0], heights[:, 0])


def pixel(plane: Floats, topology: Topology) -> float:
    """Mean distance of neighbors in the picture."""
    starts, members = topology.neighbors
    owners = np.repeat(np.arange(topology.n), np.diff(starts))
    return float(np.linalg.norm(plane[owners] - plane[members], axis=1).mean()) or 1.0


def find_view(positions: Positions, probe: Probe) -> View | None:
    """The camera that a scan of one view was made with, wherever it is; its noise is not looked at."""
    topology = probe.topology
    middle, extent = positions.mean(axis=0), float(np.ptp(positions, axis=0).max())
    off = positions - probe.average @ positions
    off[~probe.counted] = 0.0
    length = np.linalg.norm(off, axis=1)
    if not extent > 0.0 or not length.any():
        return None
    off *= np.minimum(1.0, np.quantile(length[probe.counted], 0.8) / np.maximum(length, 1e-300))[
        :, None
    ]
    # Noise of a camera is along its rays, so it is strongest along the axis of the camera.
    main = np.linalg.eigh(off.T @ off)[1][:, 2]
    # Noise along rays p - c: the eye c is where the lines along the noise come closest to each other.
    square = np.square(off).sum(axis=1)
    matrix = square.sum() * np.eye(3) - off.T @ off
    eye = np.linalg.lstsq(
        matrix, square @ positions - off.T @ np.einsum("ij,ij->i", off, positions), rcond=1e-12
    )[0]
    # Scans are often given in the frame of the camera, with the eye at the origin. Otherwise it is found from the
    # noise, or the camera is so far away that rays are parallel.
    eyes = [np.zeros(3), eye, *(middle - FAR * extent * axis for axis in (main, *np.eye(3)))]
    views = [View(eye, (middle - eye) / (np.linalg.norm(middle - eye) or 1.0)) for eye in eyes]
    irregular, best = min(
        ((_irregular(view, positions, probe), view) for view in views), key=itemgetter(0)
    )
    if irregular > REGULAR:
        return None
    a, b, c = best.plane(positions)[topology.faces.T]
    area = np.linalg.det(np.stack([b - a, c - a], axis=1))
    # A view shows one side of every face. Other surfaces have a back.
    seen = max((area > 0.0).mean(), (area < 0.0).mean()) > ONE_SIDED
    return replace(best, stepped=_stepped(positions - best.eye)) if seen else None


def _stepped(rays: Positions) -> bool:
    """Return whether depths along an axis, or their inverses, are multiples of a step."""
    for depth in rays.T:
        if (np.abs(depth) > 0.05 * np.abs(depth).max()).all():
            steps = (rounding_step(values) for values in (depth, 1.0 / depth))
            if any(steps):
                return True
    return False


def _irregular(view: View, positions: Positions, probe: Probe) -> float:
    depth = (positions - view.eye) @ view.axis
    if not depth.min() > 0.05 * depth.mean():
        return np.inf
    plane = view.plane(positions)
    off = np.linalg.norm(plane - probe.average @ plane, axis=1)[probe.counted]
    return float(np.quantile(off, SHARE)) / pixel(plane, probe.topology)
