"""Levels chosen by what errors cost where they are seen, which is measured in pictures. Encoder only.

Errors show where there are contours, creases and reflections, and hardly where a surface is rough anyway, hidden, or
flat and moved in its plane. How much, pictures of a noisy mesh tell for every vertex; what is cheap to code is taken
where it costs little.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Indices, Levels, Matrix, Positions
from bsm.codec.geometry.graph import Graph, vertex_faces
from bsm.codec.look.measure import DISSIMILAR, POWER, LookMetric
from bsm.codec.look.pictures import CREASE, MOST_AROUND
from bsm.codec.signal.smooth import in_frames, local_frames, tangent_steps

PULL = 0.8  # a level is expected at so much of the mean of its neighbours'
AROUND, SIZES = 10, 16
"""Classes of the neighbours' mean size, and sizes of what is left of a level, that bits are estimated for."""
BITS = 2.0 * np.log2(1.0 + np.arange(SIZES)) + 0.5  # what they are before any is counted
SPREADS = 2  # costs are as those of neighbours, so often over: what a vertex was blamed for is part chance
LEAST = 0.1
"""What errors cost at least, of their mean cost: nothing is hidden from all sides that somebody may look from."""
ASIDE, RATIO = 0.35, 10.0
"""What rounding along a tangent costs over what it costs along the normal, where steps are as of a layer of this
ratio."""
CROWD = 21_000  # vertices of a mesh on which chosen errors show as the costs say: of more they show less
SWEEPS = 2  # more move few levels, and take no bytes off: over all axes, and over those along the surface
SHADED = 0.5  # how unlike pixels count that a crease shades otherwise which is there in only one of two pictures
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


class Sensitivity:
    """What errors of each vertex cost in pictures."""

    def __init__(self, positions: Positions, faces: Levels, graph: Graph, metric: LookMetric, step: float) -> None:
        self._positions, self._faces, self._graph = positions, faces, graph
        self._metric, self._step = metric, step

    @cached_property
    def costs(self) -> tuple[Matrix, Matrix]:
        """What pictures differ by per square of an error, along the normal and along a tangent, shapes (n,)."""
        aside = tangent_steps(self._positions, self._faces, 1.0, RATIO)
        # All errors of a direction alike, so that no vertex costs more than another by chance.
        noise = np.where(np.random.default_rng(0).random(self._positions.shape) < 0.5, -1.0, 1.0)
        noise[:, 1:] *= aside[:, None]
        blame = self._metric.blame(self._positions + self._step * np.einsum("na,nad->nd", noise, self._frames))
        normal = self._spread(blame / self._step**2 / (1.0 + 2.0 * ASIDE))
        return normal, ASIDE * normal / np.square(aside)

    def first_step(self, distance: float) -> float:
        """The step that is about right, in BSM units."""
        return self.even_step(distance) * math.pow(len(self._positions) / CROWD, 1.0 / 6.0)

    def even_step(self, distance: float) -> float:
        """The step that would be right if errors had nothing to do with each other, in BSM units."""
        unlike = DISSIMILAR * distance ** (1.0 / POWER)
        return math.sqrt(12.0 * unlike / (float(self.costs[0].sum()) * (1.0 + 2.0 * ASIDE)))

    def levels(
        self,
        offsets: Matrix,
        frames: Matrix,
        steps: Matrix,
        known: Callable[[Levels], Matrix],
        worth: float,
        reach: Matrix,
        even: float = math.inf,
    ) -> Levels:
        """Return levels that are worth their bits, shape (n, axes), also if errors count whether seen or not: as much
        as rounding to steps of `even` would trade them for bits."""
        normal, tangent = self.costs
        count, axes = steps.shape
        unit = worth * float(normal.mean()) * float(steps[0, 0]) ** 2
        losses = np.column_stack([np.maximum(normal - tangent, 0.0), tangent]) / max(unit, 1e-300)
        if even < math.inf:
            losses[:, 1] += 1.0 / (worth * even**2)
        normals = in_frames(self._frames[:, 0], frames)
        levels = np.rint(offsets[:, :axes] / steps).astype(np.int32)
        creases = self._creases._replace(costs=self._creases.costs * (SHADED / max(unit, 1e-300)))
        given, moved = np.ascontiguousarray(frames), np.empty((count, 3))
        rates, counts = np.tile(BITS, (AROUND * axes, 1)), np.empty((AROUND * axes, SIZES))

        def sweep(steps: Matrix, fixed: int) -> int:
            return _kernels.settle_levels(
                np.ascontiguousarray(offsets), normals, losses,
                np.ascontiguousarray(np.broadcast_to(steps, (count, 3))), np.ascontiguousarray(reach, np.float64),
                self._graph.offsets, self._graph.neighbours, rates, PULL, fixed, creases, self._positions, given, moved,
                levels, counts,
            )  # fmt: skip

        for _ in range(SWEEPS):
            any_moved = sweep(steps, 0)
            rates = _bits(counts)
            if not any_moved:
                break
        for _ in range(SWEEPS if axes > 1 else 0):
            sweep(known(levels), 1)
        return levels

    @cached_property
    def _creases(self) -> Creases:
        return creases_of(self._positions, self._faces)

    @cached_property
    def _frames(self) -> Matrix:
        return local_frames(self._positions, self._faces).reshape(-1, 3, 3)

    def _spread(self, blame: Matrix) -> Matrix:
        """From faces to vertices, and half of it to their neighbours, `SPREADS` times."""
        graph, count = self._graph, len(self._positions)
        cost = np.bincount(self._faces.ravel(), np.repeat(blame / 3.0, 3), count).astype(np.float64)
        degree = np.diff(graph.offsets)
        rows = np.repeat(np.arange(count), degree)
        for _ in range(SPREADS):
            around = np.bincount(rows, cost[graph.neighbours], count) / np.maximum(degree, 1)
            cost = (cost + around) / 2.0
        return np.maximum(cost, max(LEAST * float(cost.mean()), 1e-300))


def _bits(counts: Matrix) -> Matrix:
    """Bits of sizes that come so often, in each class; one of any sign has a bit more than none."""
    trusted = counts + np.exp2(-BITS)
    bits = np.log2(trusted.sum(axis=1, keepdims=True) / trusted)
    bits[:, 1:] += 1.0
    return np.ascontiguousarray(bits)


def creases_of(positions: Positions, faces: Faces) -> Creases:
    """The creases of a mesh, and what is almost one."""
    count = len(positions)
    around = vertex_faces(faces, count)
    crosses = np.empty((len(faces), 4))
    middle = math.degrees(math.acos(CREASE))
    bends = CREASE, math.cos(math.radians(middle + WITHIN)), math.cos(math.radians(middle - WITHIN))

    def collect(room: int) -> tuple[int, Indices, npt.NDArray[np.uint8], Matrix]:
        pairs, sharp, costs = np.empty((room, 2), np.int32), np.empty(room, np.uint8), np.empty(room)
        found = _kernels.collect_creases(
            positions, faces, around.starts, around.members, MOST_AROUND, *bends, crosses, pairs, sharp, costs
        )
        return found, pairs, sharp, costs

    _, pairs, sharp, costs = collect(collect(0)[0])
    starts, members = np.empty(count + 1, np.int32), np.empty(6 * len(pairs), np.int32)
    hanging = _kernels.hang_creases(faces, pairs, starts, members)
    area = max(float(crosses[:, 3].sum()), 1e-300)
    return Creases(faces, pairs, sharp, costs / area, starts, members[:hanging].copy(), CREASE)
