"""Seeded noise on vertices, its strength in mean edge lengths; the same seed gives the same noise."""

from __future__ import annotations

import numpy as np

from bitstream.errors import OptionError
from codec.denoise.filters.vertex_update import Floats, face_geometry, vertex_normals
from codec.geometry.incidence import vertex_faces
from codec.geometry.mesh import Faces, Positions
from codec.geometry.metrics import mean_edge_length


def gaussian_along_normals(positions: Positions, faces: Faces, sigma: float, seed: int) -> Positions:
    """Move every vertex along its normal by a zero-mean Gaussian amount.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    faces : ndarray of int32, shape (m, 3)
    sigma : float
        Standard deviation over the mean edge length.
    seed : int

    Raises
    ------
    OptionError
        If `sigma` is negative or not finite.
    """
    amounts = np.random.default_rng(seed).normal(0.0, _length(positions, faces, sigma), (len(positions), 1))
    return positions + amounts * _directions(positions, faces)


def gaussian_isotropic(positions: Positions, faces: Faces, sigma: float, seed: int) -> Positions:
    """Move every coordinate of every vertex by a zero-mean Gaussian amount; parameters as `gaussian_along_normals`."""
    return positions + np.random.default_rng(seed).normal(0.0, _length(positions, faces, sigma), positions.shape)


def impulsive(positions: Positions, faces: Faces, sigma: float, fraction: float, seed: int) -> Positions:
    """Move a random choice of vertices along their normals by Gaussian amounts, and leave the others where they are.

    Parameters
    ----------
    positions, faces, sigma, seed
        As in `gaussian_along_normals`.
    fraction : float
        Share of the vertices that move, between 0 and 1; rounded to a whole number of vertices.

    Raises
    ------
    OptionError
        If `sigma` is negative or not finite, or `fraction` is outside 0..1.
    """
    if not 0.0 <= fraction <= 1.0:
        raise OptionError(f"the fraction of vertices must be between 0 and 1, not {fraction}")
    random = np.random.default_rng(seed)
    chosen = random.permutation(len(positions))[: round(fraction * len(positions))]
    amounts = np.zeros((len(positions), 1))
    amounts[chosen, 0] = random.normal(0.0, _length(positions, faces, sigma), len(chosen))
    return positions + amounts * _directions(positions, faces)


def _directions(positions: Positions, faces: Faces) -> Floats:
    return vertex_normals(face_geometry(positions, faces).normals, vertex_faces(faces, len(positions)))


def _length(positions: Positions, faces: Faces, sigma: float) -> float:
    if not 0.0 <= sigma < np.inf:
        raise OptionError(f"the standard deviation must be finite and not negative, not {sigma}")
    return sigma * mean_edge_length(positions, faces)
