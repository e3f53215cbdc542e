"""Mesh denoising via L0 minimisation (He, Schaefer 2013) with the area-based edge operator."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from bsm.codec.arrays import Faces, Indices, Positions
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.filters.vertex_update import Floats, face_geometry
from bsm.codec.geometry.metrics import mean_edge_length

BETA_FIRST = 1e-3
BETA_LAST = 1e3
FAIRNESS = 0.1
SPARSITY = 0.2


def l0_minimisation(positions: Positions, faces: Faces, iterations: int = 40) -> Positions:
    """Denoise by pressing most creases to exactly flat, few of them left."""
    original = np.ascontiguousarray(positions, dtype=np.float64)
    if iterations == 0:
        return original.copy()
    topology = Topology(faces, len(original))
    stencils = edge_stencils(topology.faces, topology.pairs)
    bend = _mean_dihedral(face_geometry(original, topology.faces).normals, topology.pairs)
    fairness = _as_matrix(stencils, np.tile([1.0, -1.0, 1.0, -1.0], (len(stencils), 1)), len(original))
    fairness = (fairness.T @ fairness).tocsc()
    alpha = FAIRNESS * bend
    sparsity = SPARSITY * mean_edge_length(original, faces) ** 2 * bend
    identity = sparse.identity(len(original), format="csc")
    current = original
    for beta in BETA_FIRST * (BETA_LAST / BETA_FIRST) ** (np.arange(iterations) / iterations):
        operator = _as_matrix(stencils, _area_weights(current, stencils), len(original))
        creases = operator @ current
        creases[np.square(creases).sum(axis=1) < sparsity / beta] = 0.0
        system = identity + alpha * fairness + beta * (operator.T @ operator)
        solver = splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        current = solver.solve(original + beta * (operator.T @ creases))
        alpha *= 0.5
    return current


def edge_stencils(faces: Faces, pairs: Indices) -> Indices:
    """Vertices (a, left, b, right) of each pair of faces that share the edge a-b; shape (p, 4)."""
    first, second = faces[pairs[:, 0]], faces[pairs[:, 1]]
    # A corner stands across from the common edge where the other face does not have it.
    left = ~(first[:, :, None] == second[:, None, :]).any(axis=2)
    k = np.flatnonzero(left.any(axis=1))
    corner = left[k].argmax(axis=1)
    first, second = first[k], second[k]
    rows = np.arange(len(k))
    a, b = first[rows, (corner + 1) % 3], first[rows, (corner + 2) % 3]
    right = (second != a[:, None]) & (second != b[:, None])
    found = right.any(axis=1)
    stencils = np.stack([a, first[rows, corner], b, second[rows, right.argmax(axis=1)]], axis=1)
    return np.ascontiguousarray(stencils[found])


def _mean_dihedral(normals: Floats, pairs: Indices) -> float:
    cosine = np.clip(np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]]), -1.0, 1.0)
    return float(np.arccos(cosine).mean()) if len(pairs) else 0.0


def _as_matrix(stencils: Indices, weights: Floats, n: int) -> sparse.csr_array:
    rows = np.arange(0, 4 * len(stencils) + 1, 4)
    return sparse.csr_array((weights.ravel(), stencils.ravel(), rows), shape=(len(stencils), n))


def _area_weights(positions: Positions, stencils: Indices) -> Floats:
    """Weights that make a function linear over both faces vanish; zero where the edge or both faces have no extent."""
    origin = positions[stencils[:, 0]]
    left, edge, right = (positions[stencils[:, k]] - origin for k in (1, 2, 3))
    square, along_left, along_right = _dot(edge, edge), _dot(edge, left), _dot(edge, right)
    area_left = np.sqrt(np.maximum(_dot(left, left) * square - along_left**2, 0.0))
    area_right = np.sqrt(np.maximum(_dot(right, right) * square - along_right**2, 0.0))
    total = area_left + area_right
    proper = (square > 0.0) & (total > 0.0)
    square, total = np.where(proper, square, 1.0), np.where(proper, total, 1.0)
    # left and right weigh by the other's area; what they project on the edge is taken off its two ends.
    at_left, at_right = area_right / total, area_left / total
    at_b = (at_left * along_left + at_right * along_right) / square
    return np.where(proper[:, None], np.stack([at_b - 1.0, at_left, -at_b, at_right], axis=1), 0.0)


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.einsum("ij,ij->i", a, b))
