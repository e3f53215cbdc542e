"""How far attributes are from what they were, at the corners of faces: whoever holds them, they show there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces, Matrix
from bsm.codec.geometry.attributes import Attribute


@dataclass(frozen=True)
class AttributeComparison:
    """An attribute, before and after."""

    max_error: float
    mean_error: float
    range: float
    max_angle_deg: float | None = None
    mean_angle_deg: float | None = None


def at_corners(attribute: Attribute, faces: Faces) -> npt.NDArray[Any]:
    """The value of each corner of each face, shape (m, 3, c)."""
    if attribute.domain == "face":
        return np.repeat(attribute.values[:, None], 3, axis=1)
    found: npt.NDArray[Any] = attribute.values[faces if attribute.indices is None else attribute.indices]
    return found


def compare_values(original: npt.NDArray[Any], decoded: npt.NDArray[Any], *, normals: bool) -> AttributeComparison:
    """Compare values of corresponding corners, shapes (..., c); `normals`: by their angles as well."""
    before, after = (values.reshape(-1, values.shape[-1]).astype(np.float64) for values in (original, decoded))
    error = np.abs(after - before)
    spread = float(np.ptp(before))
    if not normals:
        return AttributeComparison(float(error.max()), float(error.mean()), spread)
    angles = _angles(before, after)
    mean_angle = float(angles.mean()) if len(angles) else 0.0
    return AttributeComparison(
        float(error.max()), float(error.mean()), spread, float(angles.max(initial=0.0)), mean_angle
    )


def _angles(before: Matrix, after: Matrix) -> Matrix:
    """Between vectors, in degrees; by half angles, which keeps small ones exact."""
    lengths = [np.linalg.norm(vectors, axis=1, keepdims=True) for vectors in (before, after)]
    known = ((lengths[0] > 0) & (lengths[1] > 0))[:, 0]
    a, b = before[known] / lengths[0][known], after[known] / lengths[1][known]
    angles: Matrix = np.degrees(2 * np.arctan2(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1)))
    return angles
