"""The denoising methods that the paper's Figure 14 names, written from their papers over arrays.

S. Fleishman, I. Drori, D. Cohen-Or, "Bilateral mesh denoising", 2003. T. R. Jones, F. Durand, M. Desbrun,
"Non-iterative, feature-preserving mesh smoothing", 2003. X. Sun, P. L. Rosin, R. R. Martin, F. C. Langbein, "Fast and
effective feature-preserving mesh denoising", 2007. Y. Zheng, H. Fu, O. K.-C. Au, C.-L. Tai, "Bilateral normal filtering
for mesh denoising", 2011. L. He, S. Schaefer, "Mesh denoising via L0 minimization", 2013. W. Zhang, B. Deng, J. Zhang,
S. Bouaziz, L. Liu, "Guided mesh normal filtering", 2015. The last one's program also holds the others; its settings are
those here, and tests compare the angles that come out.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.linalg import splu

from bsm.codec.arrays import Faces, Floats, Positions
from bsm.codec.denoise.surface import (
    Topology,
    bilateral_normal_filtering,
    follow_normals,
    guided_normal_filtering,
    surface_normals,
)
from bsm.codec.geometry.graph import Lists
from bsm.codec.geometry.metrics import face_geometry, face_normals, mean_edge_length

Whole = npt.NDArray[np.int64]

FLEISHMAN_ITERATIONS = 5
SUN_THRESHOLD, SUN_NORMALS, SUN_VERTICES = 0.5, 20, 50
NORMAL_ITERATIONS = 20
"""Of the normals, by Zheng and by Zhang; ten updates of the vertices follow each time."""
JONES_WIDTH = 1.0
"""Both Gaussians, in mean edges."""
L0_ALPHA, L0_LAMBDA, L0_GROWTH, L0_FIRST, L0_LAST = 0.1, 0.5, 2.0**0.5, 1e-3, 1e3
"""He and Schaefer: alpha in mean dihedral angles, lambda in those times squared mean edges; beta's growth and range."""


def owners(rows: Lists) -> Whole:
    """The row of each member."""
    return np.repeat(np.arange(len(rows.starts) - 1), np.diff(rows.starts))


def reached(
    first: tuple[Whole, Whole],
    adjacent: Lists,
    centers: Positions,
    points: Positions,
    radii: Floats,
) -> tuple[Whole, Whole]:
    """Points within a radius of each center that a path of such points connects with it, as (center, point) pairs.

    `first` are the pairs to begin with, of which those within the radius count.
    """

    def near(of: Whole, to: Whole) -> npt.NDArray[np.bool_]:
        return np.asarray(np.square(points[to] - centers[of]).sum(axis=1) <= np.square(radii[of]))

    size, counts = len(points), np.diff(adjacent.starts)
    of, to = first
    keep = near(of, to)
    of, to = of[keep], to[keep]
    seen = edge = np.unique(of * size + to)
    while len(edge):
        of, to = edge // size, edge % size
        steps = counts[to]
        behind = np.arange(steps.sum()) - np.repeat(np.cumsum(steps) - steps, steps)
        of, to = (
            np.repeat(of, steps),
            adjacent.members[np.repeat(adjacent.starts[to], steps) + behind].astype(np.int64),
        )
        keep = near(of, to)
        edge = np.setdiff1d(np.unique(of[keep] * size + to[keep]), seen, assume_unique=True)
        seen = np.union1d(seen, edge)
    return seen // size, seen % size


def fleishman(
    positions: Positions, faces: Faces, iterations: int = FLEISHMAN_ITERATIONS
) -> Positions:
    """Move each vertex along its normal by the bilateral mean of its neighbors' heights.

    The spatial width is the shortest edge at the vertex, and neighbors lie within twice of it; the other width is the
    standard deviation of their heights.
    """
    n, topology = len(positions), Topology(faces, len(positions))
    near = topology.neighbors
    row, moved = owners(near), np.array(positions, np.float64)
    everywhere = np.arange(n)
    for _ in range(iterations):
        lengths = np.linalg.norm(moved[near.members] - moved[row], axis=1)
        width = np.full(n, np.inf)
        np.minimum.at(width, row, lengths)
        width = np.where(np.isfinite(width), width, 1.0)
        of, to = reached((everywhere, everywhere), near, moved, moved, 2.0 * width)
        offsets = moved[to] - moved[of]
        heights = np.einsum("ij,ij->i", offsets, surface_normals(moved, topology)[of])
        count = np.bincount(of, minlength=n)
        mean = np.bincount(of, np.abs(heights), n) / count
        spread = np.sqrt(np.bincount(of, np.square(np.abs(heights) - mean[of]), n) / count)
        spread = np.where(spread < 1e-12, spread + 1e-12, spread)
        weights = np.exp(-0.5 * np.square(offsets).sum(axis=1) / np.square(width[of]))
        weights *= np.exp(-0.5 * np.square(heights / spread[of]))
        along = np.bincount(of, weights * heights, n) / np.bincount(of, weights, n)
        moved = moved + along[:, None] * surface_normals(moved, topology)
    return moved


def jones(positions: Positions, faces: Faces, width: float = JONES_WIDTH) -> Positions:
    """Predict each vertex once from the planes of the faces around it, whose normals are smoothed before."""
    n, topology = len(positions), Topology(faces, len(positions))
    centroids, areas, _ = face_geometry(positions, faces)
    sigma = width * mean_edge_length(positions, faces)
    around = topology.around
    begin = owners(around), around.members.astype(np.int64)
    of, to = reached(begin, topology.patches, positions, centroids, np.full(n, 2.0 * sigma))
    squared = np.square(centroids[to] - positions[of]).sum(axis=1)

    def mean(weights: Floats, values: Floats) -> Floats:
        total = np.bincount(of, weights, n)
        sums = np.stack([np.bincount(of, weights * column, n) for column in values.T], axis=1)
        return np.where(
            total[:, None] > 0.0, sums / np.where(total > 0.0, total, 1.0)[:, None], positions
        )

    smooth = mean(areas[to] * np.exp(-0.5 * squared / (0.5 * sigma) ** 2), centroids[to])
    normals = face_normals(smooth, faces)[to]
    heights = np.einsum("ij,ij->i", positions[of] - centroids[to], normals)
    weights = areas[to] * np.exp(-0.5 * (squared + np.square(heights)) / sigma**2)
    return mean(weights, positions[of] - heights[:, None] * normals)


def sun(positions: Positions, faces: Faces, iterations: int = SUN_NORMALS) -> Positions:
    """Average the normals of faces that share a vertex, by how far their cosine is above a threshold."""
    topology = Topology(faces, len(positions))
    rows = topology.patches
    of, to, normals = owners(rows), rows.members, face_normals(positions, faces)
    for _ in range(iterations):
        alike = np.einsum("ij,ij->i", normals[of], normals[to]) - SUN_THRESHOLD
        weights = sparse.csr_matrix(
            (np.square(np.maximum(alike, 0.0)), to, rows.starts), (len(faces), len(faces))
        )
        summed = weights @ normals
        lengths = np.linalg.norm(summed, axis=1, keepdims=True)
        normals = np.where(lengths > 0.0, summed / np.where(lengths > 0.0, lengths, 1.0), normals)
    return follow_normals(positions, topology, normals, SUN_VERTICES, ~topology.boundary)


class Edges(NamedTuple):
    """Inner edges with the corners opposite to them: the four vertices of each, shape (e, 4), p1 and p3 on the edge."""

    corners: Whole

    def operator(self, positions: Positions) -> Floats:
        """He and Schaefer's coefficients of the four vertices, by areas, shape (e, 4)."""
        p1, p2, p3, p4 = (positions[corner] for corner in self.corners.T)

        def dot(a: Floats, b: Floats) -> Floats:
            return np.asarray(np.einsum("ij,ij->i", a, b))

        one = 0.5 * np.linalg.norm(np.cross(p2 - p1, p3 - p1), axis=1)
        two = 0.5 * np.linalg.norm(np.cross(p3 - p1, p4 - p1), axis=1)
        whole = np.maximum(one + two, 1e-300)
        scale = np.maximum(dot(p1 - p3, p1 - p3), 1e-300) * whole
        return np.stack(
            [
                (one * dot(p3 - p4, p1 - p3) - two * dot(p1 - p3, p2 - p3)) / scale,
                two / whole,
                (-one * dot(p1 - p3, p1 - p4) - two * dot(p1 - p2, p1 - p3)) / scale,
                one / whole,
            ],
            axis=1,
        )


def inner_edges(faces: Faces) -> Edges:
    """Edges of exactly two faces."""
    halves = np.concatenate([faces, np.roll(faces, -1, axis=1), np.roll(faces, -2, axis=1)]).astype(
        np.int64
    )
    start, end, tip = halves.T
    key = np.minimum(start, end) << 32 | np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    _, first, uses = np.unique(key[order], return_index=True, return_counts=True)
    one, two = order[first[uses == 2]], order[first[uses == 2] + 1]
    return Edges(np.stack([start[one], tip[two], end[one], tip[one]], axis=1))


def mean_dihedral(positions: Positions, edges: Edges) -> float:
    """Mean angle between the two faces of the edges, radians."""
    p1, p2, p3, p4 = (positions[corner] for corner in edges.corners.T)
    first, second = np.cross(p2 - p1, p3 - p1), np.cross(p3 - p1, p4 - p1)
    sines = np.linalg.norm(np.cross(first, second), axis=1)
    return float(np.arctan2(sines, np.einsum("ij,ij->i", first, second)).mean())


def minimize_l0(positions: Positions, edges: Edges, alpha: float, weight: float) -> Positions:
    """Minimize the number of edges that are not flat, by alternating thresholds and least squares."""
    n, count = len(positions), len(edges.corners)
    rows = np.repeat(np.arange(count), 4)

    def matrix(values: Floats) -> sparse.csr_matrix:
        return sparse.csr_matrix((values.ravel(), (rows, edges.corners.ravel())), (count, n))

    signs = matrix(np.tile([1.0, -1.0, 1.0, -1.0], (count, 1)))
    even, one = (signs.T @ signs).tocsc(), sparse.identity(n, format="csc")
    moved, beta = np.array(positions, np.float64), L0_FIRST
    while beta < L0_LAST:
        operator = matrix(edges.operator(moved))
        bends = operator @ moved
        bends[np.square(bends).sum(axis=1) < weight / beta] = 0.0
        whole = (one + alpha * even + beta * (operator.T @ operator)).tocsc()
        options = {"SymmetricMode": True}
        solver = splu(whole, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
        moved = solver.solve(positions + beta * (operator.T @ bends))
        beta, alpha = L0_GROWTH * beta, 0.5 * alpha
    return moved


def l0(positions: Positions, faces: Faces) -> Positions:
    """He and Schaefer with the settings of their paper."""
    edges = inner_edges(faces)
    angle, length = mean_dihedral(positions, edges), mean_edge_length(positions, faces)
    return minimize_l0(positions, edges, L0_ALPHA * angle, L0_LAMBDA * length**2 * angle)


RIVALS: dict[str, Callable[[Positions, Faces], Positions]] = {
    "bilateral (Fleishman)": fleishman,
    "non-iterative (Jones)": jones,
    "fast and effective (Sun)": sun,
    "bilateral normal (Zheng)": lambda positions, faces: bilateral_normal_filtering(
        positions, faces, NORMAL_ITERATIONS
    ),
    "guided normal (Zhang)": lambda positions, faces: guided_normal_filtering(
        positions, faces, NORMAL_ITERATIONS
    ),
    "L0 (He, Schaefer)": l0,
}
