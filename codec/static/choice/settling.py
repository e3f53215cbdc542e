"""Levels chosen by rate and distortion: of those near the right one, a level that is cheap to code. Encoder only.

Errors along the normal count most, and those in the plane of a surface hardly where it is flat.
"""

import math
from collections.abc import Callable
from functools import cached_property, lru_cache, partial
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.codec.arrays import Faces, Indices, Levels, Matrix, Positions
from bsm.codec.geometry.graph import Graph, vertex_faces
from bsm.codec.look.pictures import CREASE, MOST_AROUND
from bsm.codec.signal.smooth import in_frames, local_frames, tangent_steps

PULL = 0.8  # a level is expected at so much of the mean of its neighbors'
ASIDE, RATIO = 0.35, 10.0
"""Cost of rounding along a tangent over that along the normal, where the steps of a layer have this ratio."""
CREASED = 2.5
"""The cost of a crease in one of two pictures only, over an error of a step at its share of vertices."""
WITHIN = 8.0  # degrees, on both sides of the angle that makes a crease, in which bends are watched


class Creases(NamedTuple):
    """Bends near the angle from which on faces are shaded each by itself; the struct with this name in `choice.h`."""

    faces: Faces
    pairs: Indices
    sharp: npt.NDArray[np.uint8]
    costs: Matrix
    starts: Indices
    members: Indices
    cosine: float


class Settler:
    """Chooses levels of a mesh; errors of all its vertices cost alike."""

    def __init__(self, positions: Positions, faces: Levels, graph: Graph) -> None:
        self._positions = positions
        self._faces = faces
        self._graph = graph
        self._tangents = lru_cache(1)(partial(tangent_steps, positions, faces, 1.0))

    def levels(
        self,
        offsets: Matrix,
        frames: Matrix,
        steps: Matrix,
        known_steps: Callable[[Levels], Matrix],
        worth: float,
        reach: Matrix,
        ratio: float = RATIO,
    ) -> Levels:
        """Return levels that are worth their bits, shape (n, 3)."""
        count = len(steps)
        unit = worth * float(steps[0, 0]) ** 2
        tangent = ASIDE / np.square(self._tangents(ratio))
        losses = np.column_stack([np.maximum(1.0 - tangent, 0.0), tangent]) / max(unit, 1e-300)
        normals = in_frames(self._normals, frames)
        levels = np.rint(offsets / steps).astype(np.int32)
        crease_worth = CREASED * count / max(worth, 1e-300)
        creases = self._creases._replace(costs=self._creases.costs * crease_worth)
        axes = np.ascontiguousarray(frames)
        goals = self._positions, axes, np.ascontiguousarray(offsets), normals, losses, reach
        around = self._graph.offsets, self._graph.neighbors
        moved = np.empty((count, 3))
        # The kernel's rows: each axis and mean size of neighbors; columns: each size.
        counts = np.zeros((30, 16))
        # More sweeps, over all axes and along the surface, move few levels.
        for fixed in (0, 0, 1, 1):
            if fixed:
                steps = known_steps(levels)
            rates = _bits(counts), PULL, counts
            _kernels.settle_levels(goals, steps, *around, rates, fixed, creases, moved, levels)
        return levels

    @cached_property
    def _creases(self) -> Creases:
        return creases_of(self._positions, self._faces)

    @cached_property
    def _normals(self) -> Matrix:
        # A copy: a view would keep the tangents.
        return local_frames(self._positions, self._faces)[:, :3].copy()


def _bits(counts: Matrix) -> Matrix:
    """Bits of sizes that come so often, in each class; one of any sign has a bit more than none."""
    sizes = np.arange(counts.shape[1])
    signs = np.minimum(sizes, 1)
    trusted = counts + np.exp2(signs) / np.square(1.0 + sizes)  # before any is counted
    total = trusted.sum(axis=1, keepdims=True)
    return np.ascontiguousarray(np.log2(total / trusted) + signs)


def creases_of(positions: Positions, faces: Faces) -> Creases:
    """The creases of a mesh, and near-creases."""
    count = len(positions)
    around = vertex_faces(faces, count)
    crosses = np.empty((len(faces), 4))
    middle = math.degrees(math.acos(CREASE))
    least_cosine = math.cos(math.radians(middle + WITHIN))
    most_cosine = math.cos(math.radians(middle - WITHIN))
    bends = CREASE, least_cosine, most_cosine

    def collect(room: int) -> tuple[int, Indices, npt.NDArray[np.uint8], Matrix]:
        pairs = np.empty((room, 2), np.int32)
        sharp = np.empty(room, np.uint8)
        costs = np.empty(room)
        creases = pairs, sharp, costs
        number = _kernels.collect_creases(
            positions, faces, around, MOST_AROUND, bends, crosses, creases
        )
        return number, pairs, sharp, costs

    _, pairs, sharp, costs = collect(collect(0)[0])
    starts, members = vertex_faces(faces[pairs].reshape(-1, 6), count)
    area = max(float(crosses[:, 3].sum()), 1e-300)
    return Creases(faces, pairs, sharp, costs / area, starts.astype(np.int32), members, CREASE)
