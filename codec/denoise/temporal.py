"""Noise that changes from frame to frame taken out of a sequence, before any frame is looked at by itself."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces
from bsm.codec.blocks.overlap import block_size, grow_blocks, metis_partition
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.threads import ordered_map

Frames = npt.NDArray[np.float64]
Floats = npt.NDArray[np.float64]

BLOCK_SIZE = 500
OVERLAP = 1.25
FEWEST_FRAMES = 8


@dataclass(frozen=True, eq=False)
class Steadied:
    """Frames after the filter, the deviation of their noise, and the share of it that remains."""

    frames: Frames
    deviation: float
    remaining: float


class TemporalFilter:
    """The filter with its blocks, which are found once."""

    def __init__(self, faces: Faces, n: int) -> None:
        graph = graph_of_faces(faces, n)
        partition = metis_partition(graph, max(1, round(n / BLOCK_SIZE)))
        blocks = grow_blocks(graph, partition, block_size(partition, OVERLAP))
        self._blocks = [blocks.members[blocks.starts[i] : blocks.starts[i + 1]] for i in range(blocks.count)]
        self._copies = np.bincount(np.concatenate(self._blocks), minlength=n)

    def __call__(self, frames: Frames) -> Steadied:
        """Filter frames of shape (T, n, 3), at least `FEWEST_FRAMES`."""
        count, n, _ = frames.shape

        def trajectories(index: int) -> Floats:
            vertices = self._blocks[index]
            return frames[:, vertices].transpose(1, 0, 2).reshape(len(vertices), 3 * count)

        indices = range(len(self._blocks))
        deviations = list(ordered_map(lambda index: noise_deviation(trajectories(index)), indices, None))
        deviation = float(np.median(deviations))
        sums, kept = np.zeros((n, 3 * count)), np.zeros(n)
        smaller = ordered_map(lambda index: shrunk(trajectories(index), deviation), indices, None)
        for vertices, (filtered, rank) in zip(self._blocks, smaller, strict=True):
            sums[vertices] += filtered
            kept[vertices] += rank / len(vertices) + rank / (3 * count)
        result = (sums / self._copies[:, None]).reshape(n, count, 3).transpose(1, 0, 2)
        remaining = min(1.0, float(np.mean(kept / self._copies)))
        return Steadied(np.ascontiguousarray(result), deviation, float(np.sqrt(remaining)))


def noise_deviation(values: Floats) -> float:
    """Standard deviation of white noise in a matrix of low rank, shape (k, d): by the median of its singular values."""
    energies, _ = _components(values - values.mean(axis=0))
    short, long = int(min(values.shape)), int(max(values.shape))
    return float(np.sqrt(max(np.median(energies), 0.0) / (long * _median_energy(round(short / long, 3)))))


def shrunk(values: Floats, deviation: float) -> tuple[Floats, int]:
    """The matrix, shape (k, d), its singular values shrunk for white noise of `deviation`, and how many are left."""
    mean = values.mean(axis=0)
    centered = values - mean
    short, long = int(min(values.shape)), int(max(values.shape))
    if deviation == 0.0:
        return values, short
    energies, vectors = _components(centered)
    ratio = short / long
    above = np.maximum(energies, 0.0) / (long * deviation**2)
    excess = np.maximum((above - ratio - 1.0) ** 2 - 4.0 * ratio, 0.0)
    kept = above > (1.0 + np.sqrt(ratio)) ** 2
    factor = np.sqrt(excess[kept]) / above[kept]
    basis = vectors[:, kept]
    if len(vectors) == values.shape[1]:
        return (centered @ basis * factor) @ basis.T + mean, int(kept.sum()) + 1
    return basis @ (factor[:, None] * (basis.T @ centered)) + mean, int(kept.sum()) + 1


def _components(values: Floats) -> tuple[Floats, Floats]:
    energies, vectors = np.linalg.eigh(values.T @ values if values.shape[1] <= values.shape[0] else values @ values.T)
    return energies, vectors


@lru_cache(maxsize=64)
def _median_energy(ratio: float) -> float:
    """Median of the Marchenko-Pastur distribution: the squared singular values of white noise, over the long side."""
    root = np.sqrt(ratio)
    energy = np.linspace((1.0 - root) ** 2, (1.0 + root) ** 2, 20001)[1:-1]
    density = np.sqrt(np.maximum((energy - (1.0 - root) ** 2) * ((1.0 + root) ** 2 - energy), 0.0)) / energy
    mass = np.cumsum(density)
    return float(energy[np.searchsorted(mass, 0.5 * mass[-1])])
