"""Scans of one view: a regular grid of pixels seen from an eye, with noise along the rays of the camera.

The inverse depth of a plane is linear over the pixels. So the filter looks for the surface of fewest bends near the
measured one: ``min sum d (w - w0)^2 + s sum l |bend w|`` (total variation of the gradient, Rudin, Osher,
Fatemi 1992; by reweighted least squares), where vertices that stand out count less.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from bsm.codec.arrays import Positions
from bsm.codec.denoise.noise.probe import SHARE, Probe
from bsm.codec.denoise.surface import Floats, Topology

FAR = 1e3  # extents between an eye and the mesh from which on rays are parallel
REGULAR, ONE_SIDED = 0.08, 0.98
"""Middle distance of pixels from the mean of their neighbors, in edges, and share of the faces seen from one side."""
BEND = 0.05  # change of slope up to which bends are rounded, not sharp
ROUNDS, STEPS, EXACT, STAND_OUT = 6, 120, 1e-5, 2.0


@dataclass(frozen=True, eq=False)
class View:
    """Where the camera is, the direction that it looks in, and how strong its noise is, in pixels' widths."""

    eye: Floats
    axis: Floats
    level: float = 0.0
    terraced: bool = False

    def plane(self, positions: Positions) -> Floats:
        """Where the vertices are in the picture, shape (n, 2)."""
        rays = positions - self.eye
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
        given = self.heights(positions, topology)
        plane = self.plane(positions)
        bends, lengths = bending(plane / pixel(plane, topology), topology)
        heights, trust = given.copy(), np.ones(len(given))
        for turn in range(ROUNDS):
            bent = np.abs(bends @ heights)
            least = max(BEND, float(np.median(bent))) if turn == 0 else BEND
            weights = sparse.diags(strength * self.level * lengths / np.maximum(bent, least))
            system = (sparse.diags(trust) + bends.T @ weights @ bends).tocsr()
            heights, _ = linalg.cg(
                system, trust * given, heights, rtol=EXACT, maxiter=STEPS, M=sparse.diags(1.0 / system.diagonal())
            )
            off = np.abs(heights - given)
            usual = STAND_OUT * float(np.median(off)) / 0.6745
            trust = np.minimum(1.0, usual / np.maximum(off, 1e-9)) if usual > 0.0 else trust
        return self.at(positions, given, heights)


def pixel(plane: Floats, topology: Topology) -> float:
    """Mean distance of neighbors in the picture."""
    starts, members = topology.neighbors
    owners = np.repeat(np.arange(topology.n), np.diff(starts))
    return float(np.linalg.norm(plane[owners] - plane[members], axis=1).mean()) or 1.0


def bending(plane: Floats, topology: Topology) -> tuple[sparse.csr_matrix, Floats]:
    """How the gradient of values on the vertices changes over each edge between two faces; and the edges' lengths."""
    first, second = (topology.faces[topology.pairs[:, side]] for side in range(2))
    equal = first[:, :, None] == second[:, None, :]
    hinge = equal.any(axis=2).sum(axis=1) == 2
    first, second, equal = first[hinge], second[hinge], equal[hinge]
    lone = equal.any(axis=2).argmin(axis=1)
    rows = np.arange(len(first))
    ends = [first[rows, (lone + turn) % 3] for turn in (1, 2)]
    tips = [first[rows, lone], second[rows, equal.any(axis=1).argmin(axis=1)]]
    begin, along = plane[ends[0]], plane[ends[1]] - plane[ends[0]]
    lengths = np.maximum(np.linalg.norm(along, axis=1), 1e-9)
    along /= lengths[:, None]
    weights = np.zeros((len(first), 4))
    for column, tip in enumerate(tips, start=2):
        apart = plane[tip] - begin
        share = np.einsum("ij,ij->i", apart, along) / lengths
        height = np.abs(apart[:, 0] * along[:, 1] - apart[:, 1] * along[:, 0])
        weights[:, column] = 1.0 / np.maximum(height, 0.1)
        weights[:, 0] -= (1.0 - share) * weights[:, column]
        weights[:, 1] -= share * weights[:, column]
    where = np.repeat(rows, 4), np.stack([*ends, *tips], axis=1).ravel()
    return sparse.csr_matrix((weights.ravel(), where), shape=(len(first), topology.n)), lengths


def find_view(positions: Positions, probe: Probe) -> View | None:
    """The camera that a scan of one view was made with, wherever it is; its noise is not looked at."""
    topology = probe.topology
    middle, extent = positions.mean(axis=0), float(np.ptp(positions, axis=0).max())
    off = positions - probe.average @ positions
    off[~probe.counted] = 0.0
    length = np.linalg.norm(off, axis=1)
    if not extent > 0.0 or not length.any():
        return None
    off *= np.minimum(1.0, np.quantile(length[probe.counted], 0.8) / np.maximum(length, 1e-300))[:, None]
    main = np.linalg.eigh(off.T @ off)[1][:, 2]
    # Noise along rays p - c: the eye c is where the lines along the noise come closest to each other.
    square = np.square(off).sum(axis=1)
    matrix = square.sum() * np.eye(3) - off.T @ off
    eye = np.linalg.lstsq(matrix, square @ positions - off.T @ np.einsum("ij,ij->i", off, positions), rcond=1e-12)[0]
    eyes = [np.zeros(3), eye, *(middle - FAR * extent * axis for axis in (main, *np.eye(3)))]
    views = [View(eye, (middle - eye) / (np.linalg.norm(middle - eye) or 1.0)) for eye in eyes]
    best = min(views, key=lambda view: _irregular(view, positions, probe))
    if _irregular(best, positions, probe) > REGULAR:
        return None
    plane = best.plane(positions)
    a, b, c = (plane[topology.faces[:, corner]] for corner in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    return best if max((area > 0.0).mean(), (area < 0.0).mean()) > ONE_SIDED else None


def _irregular(view: View, positions: Positions, probe: Probe) -> float:
    depth = (positions - view.eye) @ view.axis
    if not depth.min() > 0.05 * depth.mean():
        return np.inf
    plane = view.plane(positions)
    off = np.linalg.norm(plane - probe.average @ plane, axis=1)[probe.counted]
    return float(np.quantile(off, SHARE)) / pixel(plane, probe.topology)
