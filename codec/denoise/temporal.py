"""Noise that changes from frame to frame taken out of a sequence, before any frame is looked at by itself."""

from functools import lru_cache

import numpy as np

from bsm.codec.arrays import Faces, Floats, Positions
from bsm.codec.denoise.coarse import overlapping
from bsm.codec.threads import ordered_map

FEWEST_FRAMES = 8


class TemporalFilter:
    """The filter with its blocks, which are found once."""

    def __init__(self, faces: Faces, n: int) -> None:
        blocks, _ = overlapping(faces, n)
        self._blocks = [blocks.members_of(index) for index in range(blocks.count)]
        self._copies = np.bincount(np.concatenate(self._blocks), minlength=n)

    def __call__(self, frames: Positions) -> tuple[Positions, float, float]:
        """At least `FEWEST_FRAMES` frames, (T, n, 3), without noise; its deviation, and the share that remains."""
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
        return np.ascontiguousarray(result), deviation, float(np.sqrt(remaining))


def noise_deviation(values: Floats) -> float:
    """Standard deviation of white noise in a matrix of low rank, shape (k, d): by the median of its singular values."""
    short, long = sorted(values.shape)
    singular = np.linalg.svd(values - values.mean(axis=0), compute_uv=False)
    return float(np.median(singular) / _median_of_noise(short, long))


def shrunk(values: Floats, deviation: float) -> tuple[Floats, int]:
    """The matrix, shape (k, d), its singular values shrunk for white noise of `deviation`, and how many are left."""
    short, long = sorted(values.shape)
    if deviation <= np.finfo(np.float64).eps * float(np.abs(values).max()):
        return values, short
    mean, ratio = values.mean(axis=0), short / long
    left, singular, right = np.linalg.svd(values - mean, full_matrices=False)
    above = np.square(singular) / (long * deviation**2)
    rank = int((above > (1.0 + np.sqrt(ratio)) ** 2).sum())
    shrinking = np.sqrt((above[:rank] - ratio - 1.0) ** 2 - 4.0 * ratio) / above[:rank]
    return (left[:, :rank] * (shrinking * singular[:rank])) @ right[:rank] + mean, rank + 1


@lru_cache(maxsize=64)
def _median_of_noise(short: int, long: int) -> float:
    """Median singular value of white noise of deviation one, which varies little from draw to draw."""
    noise = np.random.default_rng(0).normal(size=(short, long))
    return float(np.median(np.linalg.svd(noise - noise.mean(axis=0), compute_uv=False)))
