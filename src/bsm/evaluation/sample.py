"""A mesh made by formula, to try the codec on where there is none at hand."""

import numpy as np
import numpy.typing as npt
from scipy.spatial import Delaunay

from bsm.codec.geometry.mesh import TriangleMesh

Doubles = npt.NDArray[np.float64]

_TUBE = 0.5
_ASPECT = 10.0  # length of the knot over the circumference of its tube, about


def knot(vertices: int = 20_000, seed: int = 1) -> TriangleMesh:
    """A closed tube along a trefoil, twisted like a rope, with dents and grain: detail at three scales."""
    random = np.random.default_rng(seed)
    # Points in the unit square, one in each cell of a brick wall whose bricks are square on the tube.
    across = max(4, round((vertices / _ASPECT) ** 0.5))
    along = max(12, round(vertices / across))
    cells = np.stack(
        np.meshgrid(np.arange(along), np.arange(across), indexing="ij"), axis=-1
    ).reshape(-1, 2)
    bricks = cells + (0.0, 0.5) * (cells[:, :1] % 2)
    places = np.asarray((bricks + random.uniform(0.25, 0.75, cells.shape)) / (along, across) % 1.0)
    return TriangleMesh(_tube(*places.T), _periodic_triangles(places))


def _periodic_triangles(places: Doubles) -> npt.NDArray[np.int32]:
    """Delaunay triangles of points in the unit square, whose opposite sides are one."""
    shifts = np.array(
        [(0, 0), *((x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if (x, y) != (0, 0))]
    )
    copies = (places + shifts[:, None]).reshape(-1, 2)
    # Nothing beyond a margin of a few cells can matter.
    near = np.flatnonzero((np.abs(copies - 0.5) < 0.7).all(axis=1))
    # The corners are turned so that the faces look outwards on the tube.
    triangles = near[Delaunay(copies[near] * (_ASPECT, 1.0)).simplices[:, ::-1]]
    center = copies[triangles].mean(axis=1)
    inside = ((center >= 0.0) & (center < 1.0)).all(axis=1)
    wrapped: npt.NDArray[np.int32] = (triangles[inside] % len(places)).astype(np.int32)
    return wrapped


def _tube(along: Doubles, around: Doubles) -> Doubles:
    """The point at `along` of the knot and `around` of its tube, both in 0..1."""
    t, v = 2 * np.pi * along, 2 * np.pi * around
    center = _trefoil(t)
    step = 1e-3
    before, after = _trefoil(t - step), _trefoil(t + step)
    tangent = _unit(after - before)
    binormal = _unit(np.cross(tangent, after - 2 * center + before))
    normal = np.cross(binormal, tangent)
    rope = 0.13 * np.cos(4 * v + 20 * t)
    dents = 0.05 * np.cos(36 * t) * np.cos(3 * v)
    grain = 0.008 * np.sin(90 * t) * np.sin(16 * v)
    radius = (_TUBE * (1 + rope + dents + grain))[:, None]
    return np.asarray(
        center + radius * (np.cos(v)[:, None] * normal + np.sin(v)[:, None] * binormal)
    )


def _trefoil(t: Doubles) -> Doubles:
    ring = 2.2 + np.cos(3 * t)
    return np.column_stack([ring * np.cos(2 * t), ring * np.sin(2 * t), np.sin(3 * t)])


def _unit(vectors: Doubles) -> Doubles:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
