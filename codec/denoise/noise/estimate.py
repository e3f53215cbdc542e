"""How noisy a mesh is, from the mesh itself.

The random-walk Laplacian, applied four times, leaves little of a surface and most of the noise. What it leaves along
the normals and across them is compared, by medians, with what it leaves of white noise on the same mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Positions
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.filters.vertex_update import Floats, face_geometry, vertex_normals
from bsm.codec.geometry.metrics import mean_edge_length

ORDER = 4
IRREGULARITY = 0.15
"""What irregular triangles alone leave across the normals, in mean edges: at most about this on the meshes tried."""


@dataclass(frozen=True)
class NoiseLevel:
    """Standard deviations of white noise, in the unit of the mesh."""

    normal: float
    tangential: float


def estimate_noise(positions: Positions, smooth: Positions, topology: Topology, seed: int = 0) -> NoiseLevel:
    """Estimate the noise on `positions`."""
    normals = vertex_normals(face_geometry(smooth, topology.faces).normals, topology.around)
    white = np.random.default_rng(seed).normal(size=positions.shape)
    counted = np.diff(topology.neighbours.starts) > 0
    if (counted & ~topology.boundary).any():
        counted &= ~topology.boundary
    normal, tangential = _split(_high_pass(positions, topology)[counted], normals[counted])
    white_normal, white_tangential = _split(_high_pass(white, topology)[counted], normals[counted])
    along = normal / white_normal if white_normal > 0.0 else 0.0
    across = tangential / white_tangential if white_tangential > 0.0 else 0.0
    floor = IRREGULARITY * mean_edge_length(positions, topology.faces)
    return NoiseLevel(along, min(along, math.sqrt(max(across * across - floor * floor, 0.0))))


def add_noise(positions: Positions, level: NoiseLevel, topology: Topology, seed: int) -> Positions:
    """Positions, shape (n, 3), with white Gaussian noise of the given level."""
    normals = vertex_normals(face_geometry(positions, topology.faces).normals, topology.around)
    white = np.random.default_rng(seed).normal(size=positions.shape)
    along = np.einsum("ij,ij->i", white, normals)[:, None] * normals
    return np.asarray(positions + level.normal * along + level.tangential * (white - along))


def _split(vectors: Floats, normals: Floats) -> tuple[float, float]:
    """Medians of the lengths of vectors along normals and across them; 0 where there are none."""
    if len(vectors) == 0:
        return 0.0, 0.0
    along = np.einsum("ij,ij->i", vectors, normals)
    across = np.linalg.norm(vectors - along[:, None] * normals, axis=1)
    return float(np.median(np.abs(along))), float(np.median(across))


def _high_pass(values: Floats, topology: Topology) -> Floats:
    for _ in range(ORDER):
        rest = np.empty_like(values)
        _kernels.minus_mean(values, *topology.neighbours, rest)
        values = rest
    return values
