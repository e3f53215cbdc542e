"""The two-sided Hausdorff distance of two surfaces: exact distances from dense samples to triangles.

Samples are the vertices and points spread evenly over the area, so the result is a lower bound that rises towards the
true distance with their number; the distance of each sample is exact, found in a tree of bounding boxes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.geometry.mesh import Faces, Positions

Floats = npt.NDArray[np.float64]

SAMPLES = 100_000
LEAF = 4


@dataclass(frozen=True)
class SurfaceDistance:
    """Distances between two surfaces, in their unit.

    Attributes
    ----------
    hausdorff : float
        The larger of the two largest distances.
    forward, backward : float
        Largest distance from the first surface to the second, and back.
    mean : float
        The larger of the two mean distances, over samples spread evenly by area.
    """

    hausdorff: float
    forward: float
    backward: float
    mean: float


def surface_distance(
    first: Positions, first_faces: Faces, second: Positions, second_faces: Faces, samples: int = SAMPLES, seed: int = 0
) -> SurfaceDistance:
    """Distances between two surfaces, which need not share connectivity.

    Parameters
    ----------
    first, second : ndarray of float64, shape (n, 3) and (n', 3)
    first_faces, second_faces : ndarray of int32, shape (m, 3) and (m', 3)
    samples : int
        Points on each surface besides its vertices.
    seed : int
        Of the points' places.
    """
    forward, forward_mean = _one_sided(first, first_faces, second, second_faces, samples, seed)
    backward, backward_mean = _one_sided(second, second_faces, first, first_faces, samples, seed)
    return SurfaceDistance(max(forward, backward), forward, backward, max(forward_mean, backward_mean))


def sample_surface(positions: Positions, faces: Faces, samples: int, seed: int) -> Floats:
    """Points spread evenly over the area, shape (samples, 3); no points if there is no area."""
    corners = positions[faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    if not areas.sum() > 0.0:
        return np.empty((0, 3))
    random = np.random.default_rng(seed)
    chosen = corners[random.choice(len(faces), samples, p=areas / areas.sum())]
    # The square root makes the triangle's share of each height right.
    height, along = np.sqrt(random.random((samples, 1))), random.random((samples, 1))
    points: Floats = (
        (1.0 - height) * chosen[:, 0] + height * (1.0 - along) * chosen[:, 1] + height * along * chosen[:, 2]
    )
    return points


def distances_to_surface(points: Floats, positions: Positions, faces: Faces) -> Floats:
    """Exact distance of each point to the nearest triangle, shape (k,)."""
    corners = np.ascontiguousarray(positions[faces], dtype=np.float64)
    order, low, high, first, count = _build(corners.min(axis=1), corners.max(axis=1))
    distances: Floats = _nearest(np.ascontiguousarray(points), corners[order], low, high, first, count)
    return distances


def _one_sided(
    source: Positions, source_faces: Faces, target: Positions, target_faces: Faces, samples: int, seed: int
) -> tuple[float, float]:
    spread = distances_to_surface(sample_surface(source, source_faces, samples, seed), target, target_faces)
    corners = distances_to_surface(source[np.unique(source_faces)], target, target_faces)
    mean = float(spread.mean()) if len(spread) else float(corners.mean())
    return float(max(corners.max(), spread.max(initial=0.0))), mean


@njit(cache=True, nogil=True)
def _build(lowest, highest):  # type: ignore[no-untyped-def]
    """Split the boxes at the median of their widest axis until few are left; nodes in pre-order.

    The first child of node k is k + 1; `first[k]` is its other child (count 0) or its first triangle (count > 0).
    """
    m = len(lowest)
    order = np.arange(m)
    centres = 0.5 * (lowest + highest)
    size = 2 * m + 1
    low, high = np.empty((size, 3)), np.empty((size, 3))
    first, count = np.zeros(size, np.int64), np.zeros(size, np.int64)
    stack = np.empty((128, 3), np.int64)
    stack[0, 0], stack[0, 1], stack[0, 2] = 0, m, -1
    depth, nodes = 1, 0
    while depth > 0:
        depth -= 1
        begin, end, parent = stack[depth]
        node = nodes
        nodes += 1
        if parent >= 0:
            first[parent] = node
        for axis in range(3):
            low[node, axis], high[node, axis] = math.inf, -math.inf
            for k in range(begin, end):
                low[node, axis] = min(low[node, axis], lowest[order[k], axis])
                high[node, axis] = max(high[node, axis], highest[order[k], axis])
        if end - begin <= LEAF:
            first[node], count[node] = begin, end - begin
            continue
        widest = np.argmax(high[node] - low[node])
        part = order[begin:end]
        order[begin:end] = part[np.argsort(centres[part, widest], kind="mergesort")]
        middle = (begin + end) // 2
        stack[depth, 0], stack[depth, 1], stack[depth, 2] = middle, end, node
        stack[depth + 1, 0], stack[depth + 1, 1], stack[depth + 1, 2] = begin, middle, -1
        depth += 2
    return order, low[:nodes].copy(), high[:nodes].copy(), first[:nodes].copy(), count[:nodes].copy()


@njit(cache=True, nogil=True)
def _nearest(points, triangles, low, high, first, count):  # type: ignore[no-untyped-def]
    distances = np.empty(len(points))
    stack = np.empty(128, np.int64)
    for i in range(len(points)):
        p = points[i]
        best = math.inf
        stack[0] = 0
        depth = 1
        while depth > 0:
            depth -= 1
            node = stack[depth]
            if _to_box(p, low[node], high[node]) >= best:
                continue
            if count[node] > 0:
                for k in range(first[node], first[node] + count[node]):
                    best = min(best, _to_triangle(p, triangles[k, 0], triangles[k, 1], triangles[k, 2]))
                continue
            near, far = node + 1, first[node]
            if _to_box(p, low[near], high[near]) > _to_box(p, low[far], high[far]):
                near, far = far, near
            stack[depth], stack[depth + 1] = far, near
            depth += 2
        distances[i] = math.sqrt(best)
    return distances


@njit(cache=True, nogil=True)
def _to_box(p, low, high):  # type: ignore[no-untyped-def]
    total = 0.0
    for axis in range(3):
        beyond = max(low[axis] - p[axis], p[axis] - high[axis], 0.0)
        total += beyond * beyond
    return total


@njit(cache=True, nogil=True)
def _to_segment(p, a, b):  # type: ignore[no-untyped-def]
    length = along = 0.0
    for axis in range(3):
        length += (b[axis] - a[axis]) ** 2
        along += (b[axis] - a[axis]) * (p[axis] - a[axis])
    t = min(max(along / length, 0.0), 1.0) if length > 0.0 else 0.0
    total = 0.0
    for axis in range(3):
        total += (a[axis] + t * (b[axis] - a[axis]) - p[axis]) ** 2
    return total


@njit(cache=True, nogil=True)
def _to_triangle(p, a, b, c):  # type: ignore[no-untyped-def]
    """Squared distance: to the plane where the foot lies inside, otherwise to the nearest edge."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    wx, wy, wz = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    square = nx * nx + ny * ny + nz * nz
    if square > 0.0:
        # Barycentric coordinates of the foot, times the square.
        at_c = (uy * wz - uz * wy) * nx + (uz * wx - ux * wz) * ny + (ux * wy - uy * wx) * nz
        at_b = (wy * vz - wz * vy) * nx + (wz * vx - wx * vz) * ny + (wx * vy - wy * vx) * nz
        if at_b >= 0.0 and at_c >= 0.0 and at_b + at_c <= square:
            height = wx * nx + wy * ny + wz * nz
            return height * height / square
    return min(_to_segment(p, a, b), _to_segment(p, b, c), _to_segment(p, c, a))
