"""Seeded noise on vertices, its strength in mean edge lengths; the same seed gives the same noise.

The kinds are those that scanners, cameras and careless exports leave behind: white noise along the normals or in all
directions, white noise of bounded size, outliers, noise along one axis (a depth camera's), noise that neighbors share
(a line scanner's or a filtered depth map's), waves, noise that grows with the distance from a camera, coordinates
rounded to a grid, and noise in one part of the mesh only.
"""

import numpy as np

from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Faces, Floats, Positions
from bsm.codec.denoise import AutomaticChoice, FrameDenoiser
from bsm.codec.denoise.surface import Topology, surface_normals
from bsm.codec.geometry.graph import vertex_neighbors
from bsm.codec.geometry.metrics import mean_edge_length


def gaussian_along_normals(
    positions: Positions, faces: Faces, sigma: float, seed: int
) -> Positions:
    """Move every vertex along its normal by a zero-mean Gaussian amount."""
    amounts = np.random.default_rng(seed).normal(
        0.0, _length(positions, faces, sigma), (len(positions), 1)
    )
    return positions + amounts * _directions(positions, faces)


def gaussian_isotropic(positions: Positions, faces: Faces, sigma: float, seed: int) -> Positions:
    """Move every coordinate of every vertex, shape (n, 3), by a zero-mean Gaussian amount."""
    return positions + np.random.default_rng(seed).normal(
        0.0, _length(positions, faces, sigma), positions.shape
    )


def impulsive(
    positions: Positions, faces: Faces, sigma: float, fraction: float, seed: int
) -> Positions:
    """Move a random choice of vertices along their normals by Gaussian amounts, and leave the others where they are."""
    _refuse_fraction(fraction)
    random = np.random.default_rng(seed)
    chosen = random.permutation(len(positions))[: round(fraction * len(positions))]
    amounts = np.zeros((len(positions), 1))
    amounts[chosen, 0] = random.normal(0.0, _length(positions, faces, sigma), len(chosen))
    return positions + amounts * _directions(positions, faces)


def uniform_along_normals(positions: Positions, faces: Faces, sigma: float, seed: int) -> Positions:
    """Move every vertex, shape (n, 3), along its normal by an amount from a symmetric interval."""
    largest = np.sqrt(3.0) * _length(positions, faces, sigma)
    amounts = np.random.default_rng(seed).uniform(-largest, largest, (len(positions), 1))
    return positions + amounts * _directions(positions, faces)


def gaussian_along_axis(
    positions: Positions,
    faces: Faces,
    sigma: float,
    seed: int,
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0),
) -> Positions:
    """Move every vertex, shape (n, 3), along one direction by a Gaussian amount."""
    length = float(np.linalg.norm(axis))
    if not 0.0 < length < np.inf:
        raise OptionError(f"the axis must have a direction, not {axis}")
    amounts = np.random.default_rng(seed).normal(
        0.0, _length(positions, faces, sigma), (len(positions), 1)
    )
    return positions + amounts * (np.asarray(axis, dtype=np.float64) / length)


def correlated_along_normals(
    positions: Positions, faces: Faces, sigma: float, seed: int, rounds: int = 2
) -> Positions:
    """Move every vertex along its normal by an amount that it shares in part with its neighbors."""
    neighbors = vertex_neighbors(faces, len(positions))
    degrees = np.diff(neighbors.starts)
    owners = np.repeat(np.arange(len(positions)), degrees)
    amounts = np.random.default_rng(seed).normal(size=len(positions))
    for _ in range(rounds):
        sums = np.bincount(owners, amounts[neighbors.members], len(positions))
        amounts = np.where(degrees > 0, 0.5 * (amounts + sums / np.maximum(degrees, 1)), amounts)
    amounts *= _length(positions, faces, sigma) / (float(np.sqrt(np.square(amounts).mean())) or 1.0)
    return positions + amounts[:, None] * _directions(positions, faces)


def gaussian_with_range(
    positions: Positions,
    faces: Faces,
    sigma: float,
    seed: int,
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0),
    ratio: float = 4.0,
) -> Positions:
    """Move every vertex along one direction, the more the further it is away (a depth camera's noise)."""
    depth = positions @ np.asarray(axis, dtype=np.float64)
    place = (depth - depth.min()) / (float(np.ptp(depth)) or 1.0)
    strength = np.square(1.0 + (np.sqrt(ratio) - 1.0) * place)[:, None]
    moved = gaussian_along_axis(positions, faces, sigma, seed, axis) - positions
    return np.asarray(positions + moved * (strength / float(np.sqrt(np.square(strength).mean()))))


def ripples_along_normals(
    positions: Positions, faces: Faces, sigma: float, seed: int, length: float = 6.0
) -> Positions:
    """Move every vertex along its normal by the sum of three waves of random directions (a scanner that trembles)."""
    random = np.random.default_rng(seed)
    directions = random.normal(size=(3, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    turns = 2.0 * np.pi / (length * (mean_edge_length(positions, faces) or 1.0))
    waves = np.sin(turns * (positions @ directions.T) + random.uniform(0.0, 2.0 * np.pi, 3)).sum(
        axis=1
    )
    amounts = waves * (
        _length(positions, faces, sigma) / (float(np.sqrt(np.square(waves).mean())) or 1.0)
    )
    return np.asarray(positions + amounts[:, None] * _directions(positions, faces))


def rounded(positions: Positions, faces: Faces, sigma: float, seed: int) -> Positions:
    """Round every coordinate to a grid."""
    step = np.sqrt(12.0) * _length(positions, faces, sigma) or 1.0
    offset = step * np.random.default_rng(seed).random(3)
    return (
        np.asarray(np.round((positions - offset) / step) * step + offset)
        if sigma > 0.0
        else np.array(positions)
    )


def gaussian_in_part(
    positions: Positions, faces: Faces, sigma: float, fraction: float, seed: int
) -> Positions:
    """Move the vertices at one end of the mesh along their normals by Gaussian amounts, and no others."""
    _refuse_fraction(fraction)
    place = positions[:, int(np.argmax(np.ptp(positions, axis=0)))]
    chosen = np.argsort(place, kind="stable")[len(place) - round(fraction * len(place)) :]
    result = np.array(positions)
    result[chosen] = gaussian_along_normals(positions, faces, sigma, seed)[chosen]
    return result


def _refuse_fraction(fraction: float) -> None:
    if not 0.0 <= fraction <= 1.0:
        raise OptionError(f"the fraction of vertices must be between 0 and 1, not {fraction}")


def _directions(positions: Positions, faces: Faces) -> Floats:
    return surface_normals(positions, Topology(faces, len(positions)))


def _length(positions: Positions, faces: Faces, sigma: float) -> float:
    if not 0.0 <= sigma < np.inf:
        raise OptionError(f"the standard deviation must be finite and not negative, not {sigma}")
    return sigma * mean_edge_length(positions, faces)


def denoise_automatically(
    points: Positions, faces: Faces, goal: str = "shading"
) -> tuple[Positions, AutomaticChoice]:
    """Return denoised positions, shape (n, 3), of one mesh and the choice that was made for it."""
    denoiser = FrameDenoiser(points, faces, goal=goal)
    (result,) = denoiser([points])
    assert denoiser.choice is not None
    return result, denoiser.choice
