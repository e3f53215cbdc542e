"""Small sequences with known properties."""

from __future__ import annotations

import numpy as np

from bsm.codec.arrays import Faces, Positions
from tests.shapes import torus


def bending(frames: int, rows: int = 30, columns: int = 16) -> tuple[Positions, Faces]:
    """A torus that turns, stretches and waves; shape (T, n, 3)."""
    mesh = torus(rows, columns)
    x, y, z = mesh.positions.T
    result = []
    for t in np.arange(frames) / 12:
        c, s = np.cos(t), np.sin(t)
        wave = 0.1 * np.sin(3 * x + 2 * t)
        result.append(np.stack([c * x - s * y, (s * x + c * y) * (1 + 0.2 * np.sin(t)), z + wave], axis=1))
    return np.array(result), mesh.faces


def turning(frames: int) -> tuple[Positions, Faces]:
    """A torus that turns about an axis and moves away, rigidly."""
    mesh = torus(30, 16)
    x, y, z = mesh.positions.T
    angles = np.arange(frames) / 7
    turned = [np.stack([np.cos(t) * x - np.sin(t) * z + t, y, np.sin(t) * x + np.cos(t) * z], axis=1) for t in angles]
    return np.array(turned), mesh.faces
