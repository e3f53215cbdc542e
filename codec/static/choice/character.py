"""What of a surface tells which way is smallest, and at what step: measures on samples, cheap enough to ask often."""

from __future__ import annotations

import numpy as np

from bsm.bitstream.once import cached_property
from bsm.codec import _kernels
from bsm.codec.arrays import Indices, Matrix
from bsm.codec.geometry.mesh import box_around
from bsm.codec.geometry.metrics import LOST, Original

MOST_FLAPS = 1 << 11
"""Second differences that entropy is measured on."""
EXTRA = np.concatenate([np.zeros(16), 2.0 + np.arange(64) // 4])
"""Bits that tell second differences apart which are counted together (see `bucket` in shaping.c)."""
MOST_FACES, MOST_EDGES = 1 << 10, 1 << 13
"""What angles and lengths are measured on."""
SHARP = 0.4
"""Of the mean angle between faces beside each other: with a median below it, a surface has sharp edges."""
FLAT, UNEVEN = 0.3, 0.35
"""Of that mean, a third quartile below which nearly all of it is flat; of the mean area of a face, a median below which
a few faces are most of the surface."""


class Character:
    """Measures of a surface."""

    def __init__(self, original: Original, flaps: Indices) -> None:
        self._original = original
        self._flaps = flaps[:: max(1, len(flaps) // MOST_FLAPS)]
        self._low: Matrix = box_around(original.positions)[0]

    @cached_property
    def mean_edge(self) -> float:
        """Mean length of an edge, as faces count it: of the first edge of some."""
        faces, positions = self._original.faces, self._original.positions
        some = faces[:: max(1, len(faces) // MOST_EDGES), :2]
        a, b = positions[some[:, 0]], positions[some[:, 1]]
        return float(np.sqrt(np.square(a - b).sum(axis=1)).mean())

    def entropy(self, step: float) -> float:
        """Bytes of the mesh on a rounded grid, if each place took what a second difference takes, by a histogram."""
        counts = np.empty((3, len(EXTRA)), np.int32)
        _kernels.count_bends_on(self._corners, step, counts)
        return self._bytes(counts)

    def entropy_of(self, bends: Indices) -> float:
        """Entropy of given second differences, shape (k, 3)."""
        counts = np.empty((3, len(EXTRA)), np.int32)
        _kernels.count_bends(bends, max(1, len(bends) // MOST_FLAPS), counts)
        return self._bytes(counts)

    def rounded_angle(self, step: float) -> float:
        """Mean angle of normals, degrees, on a rounded grid."""
        corners, faces, normals, weights = self._faces
        places = np.floor(corners * (1.0 / step) + 0.5) * step
        return float(np.degrees(_kernels.weighted_angle(normals, weights, places, faces, LOST)))

    def step_of(self, angle: float, most: float) -> float:
        """About the step on which rounding bends normals by so much, degrees; at most `most`."""
        step = most
        for _ in range(6):
            found = self.rounded_angle(step)
            if step >= most and found <= angle:
                break
            ratio = angle / max(found, 1e-6)
            if 0.97 < ratio < 1.03:
                break
            step = min(step * min(max(ratio, 1.0 / 16.0), 16.0), most)
        return step

    @property
    def roughness(self) -> float:
        """Mean angle between faces beside each other, degrees."""
        return float(np.degrees(self._dihedrals.mean())) if len(self._dihedrals) else 0.0

    @cached_property
    def is_sharp(self) -> bool:
        """Whether the surface is flat nearly everywhere, and bent at few edges: as models are, and scans are not."""
        return bool(len(self._dihedrals) == 0 or np.median(self._dihedrals) < SHARP * self._dihedrals.mean())

    @cached_property
    def is_model(self) -> bool:
        """Whether it is sharp and no scan at all: nearly all flat, or most of it a few large faces."""
        if not self.is_sharp or len(self._dihedrals) == 0:
            return False
        weights = self._original.weights
        flat = np.quantile(self._dihedrals, 0.75) < FLAT * self._dihedrals.mean()
        return bool(flat or np.median(weights) < UNEVEN * weights.mean())

    def _bytes(self, counts: Indices) -> float:
        total = float(counts[0].sum())
        if not total:
            return 0.0
        shares = counts[counts > 0] / total
        bits = float(counts.sum(axis=0) @ EXTRA) / total - float((shares * np.log2(shares)).sum())
        signs = 3.0 - float(counts[:, 0].sum()) / total
        return len(self._original.positions) / 8.0 * (bits + signs)

    @cached_property
    def _corners(self) -> Matrix:
        return np.ascontiguousarray((self._original.positions[self._flaps] - self._low).reshape(-1, 12))

    @cached_property
    def _faces(self) -> tuple[Matrix, Indices, Matrix, Matrix]:
        """Faces, drawn by their weight: corners from the lower corner of the mesh on, and what goes with these."""
        original = self._original
        count = min(MOST_FACES, len(original.faces))
        at = np.cumsum(original.weights)
        chosen = np.minimum(np.searchsorted(at, (np.arange(count) + 0.5) / count), len(at) - 1)
        corners = original.positions[original.faces[chosen]].reshape(-1, 3) - self._low
        faces = np.arange(3 * count, dtype=np.int32).reshape(-1, 3)
        return corners, faces, original.normals[chosen], np.full(count, 1.0 / count)

    @cached_property
    def _dihedrals(self) -> Matrix:
        """Angles between faces beside each other, of some flaps."""
        some = self._original.positions[self._flaps]
        edge = some[:, 1] - some[:, 0]
        first, second = np.cross(edge, some[:, 2] - some[:, 0]), np.cross(some[:, 3] - some[:, 0], edge)
        across = np.cross(first, second)
        return np.asarray(np.arctan2(np.sqrt((across * across).sum(axis=1)), (first * second).sum(axis=1)))
