"""The two-sided Hausdorff distance of two surfaces: exact distances from dense samples to triangles.

Samples are the vertices and points spread evenly over the area, so the result is a lower bound that rises towards the
true distance with their number; the distance of each sample is exact, found in a tree of bounding boxes.
"""

from dataclasses import dataclass

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Matrix, Order, Positions

Floats = Matrix

SAMPLES = 100_000


@dataclass(frozen=True)
class SurfaceDistance:
    """Distances between two surfaces, in their unit."""

    hausdorff: float
    forward: float
    backward: float
    mean: float


def surface_distance(
    first: Positions, first_faces: Faces, second: Positions, second_faces: Faces, samples: int = SAMPLES, seed: int = 0
) -> SurfaceDistance:
    """Distances between two surfaces, which need not share connectivity."""
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
    distances = np.empty(len(points))
    _kernels.nearest_distances(np.ascontiguousarray(points), *_tree(positions, faces), distances)
    return distances


def farthest_from_surface(points: Floats, positions: Positions, faces: Faces) -> float:
    """The largest of these distances, much sooner; consecutive points should be near each other."""
    return float(_kernels.farthest_distance(np.ascontiguousarray(points), *_tree(positions, faces)))


def _tree(positions: Positions, faces: Faces) -> tuple[Floats, Floats, Floats, Order, Order]:
    """Triangles in the order of a tree of boxes; its nodes: lowest, highest corner, what is first, how many."""
    corners = np.ascontiguousarray(positions[faces], dtype=np.float64)
    m = len(corners)
    order, first, count = (np.empty(size, np.int64) for size in (m, 2 * m + 1, 2 * m + 1))
    low, high = np.empty((2 * m + 1, 3)), np.empty((2 * m + 1, 3))
    _kernels.build_tree(corners.min(axis=1), corners.max(axis=1), order, low, high, first, count)
    return corners[order].reshape(m, 9), low, high, first, count


def _one_sided(
    source: Positions, source_faces: Faces, target: Positions, target_faces: Faces, samples: int, seed: int
) -> tuple[float, float]:
    spread = distances_to_surface(sample_surface(source, source_faces, samples, seed), target, target_faces)
    corners = distances_to_surface(source[np.unique(source_faces)], target, target_faces)
    mean = float(spread.mean()) if len(spread) else float(corners.mean())
    return float(max(corners.max(), spread.max(initial=0.0))), mean
