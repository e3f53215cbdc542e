"""What a contract is about: the farthest vertex, and the angle between normals that a viewer sees; cheap to measure."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Indices, Mask, Positions
from bsm.codec.geometry.metrics import Floats

LOST = math.pi
"""Angle of a face without area; no rounding of its vertices can give it a normal that is farther off."""


@dataclass(frozen=True)
class Closeness:
    """How close a decoded mesh is to the original."""

    farthest: float
    angle: float


class Original:
    """An original, prepared so that one decoded version after another is measured in one pass over the faces."""

    def __init__(self, positions: Positions, faces: Faces, *, by_area: bool = True) -> None:
        self.positions: Positions = np.ascontiguousarray(positions, np.float64)
        self.faces: Indices = np.ascontiguousarray(faces, np.int32)
        areas, self.normals = np.empty(len(self.faces)), np.empty((len(self.faces), 3))
        _kernels.face_geometry(self.positions, self.faces, np.empty((len(self.faces), 3)), areas, self.normals)
        counts = areas if by_area else (areas > 0.0).astype(np.float64)
        total = counts.sum()
        self.weights: Floats = counts / total if total > 0.0 else np.zeros(len(areas))

    def angle(self, decoded: Positions) -> float:
        """Mean angle, degrees, between corresponding normals of this and of `decoded`, shape (n, 3)."""
        decoded = np.ascontiguousarray(decoded, np.float64)
        return math.degrees(_kernels.weighted_angle(self.normals, self.weights, decoded, self.faces, LOST))

    def angle_of(self, rows: Mask, decoded: Positions) -> float:
        """What some faces, `rows`, shape (m,), contribute to `angle` of `decoded`, shape (n, 3)."""
        normals, weights, faces = self.normals[rows], self.weights[rows], self.faces[rows]
        return math.degrees(_kernels.weighted_angle(normals, weights, decoded, faces, LOST))

    def farthest(self, decoded: Positions) -> float:
        """Largest distance of a vertex of `decoded`, shape (n, 3), from its place."""
        return _kernels.farthest_apart(self.positions, np.ascontiguousarray(decoded, np.float64))

    def closeness(self, decoded: Positions) -> Closeness:
        """Farthest distance and mean angle of a decoded mesh, shape (n, 3)."""
        return Closeness(self.farthest(decoded), self.angle(decoded))
