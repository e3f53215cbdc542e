"""The coarse step: keep the low graph frequencies of every block, and blend the blocks (paper, sections 6 and 7.2).

``v^ = U_c U_c^T v`` in each overlapping block; the copies of a vertex are averaged with the vertex's degree in each
block as weight. Noise that changes from frame to frame leaves the same blocks by their singular values over time.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import scipy.linalg

from bsm.codec.arrays import Faces, Floats, Indices, Positions
from bsm.codec.blocks.overlap import Blend, Blocks, block_size, grow_blocks, metis_partition
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import Around, Chain, ChainRules, Columns, Overrides
from bsm.codec.threads import ordered_map

BLOCK_SIZE = 500  # about the paper's; half or twice of it leaves 2.4 and 0.6 % more of the angle
OVERLAP = 1.15
KEEP = 0.10
FEWEST_FRAMES = 8
SHORTEST = 0.1  # of mean edges: the length from which on an edge is not shorter to the weights
# More iterations than a stream would send, since no decoder has to repeat them; no springs, as in the paper.
RULES = ChainRules(
    exact=False,
    key_interval=16,
    power=3,
    iterations=2,
    key_iterations=4,
    shift=0.125,
    springs=False,
)


def overlapping(faces: Faces, n: int, block: int = BLOCK_SIZE) -> tuple[Blocks, int]:
    """Overlapping blocks of about `block` vertices more than the overlap, and the vertices of each."""
    graph = graph_of_faces(np.ascontiguousarray(faces, dtype=np.int32), n)
    partition = metis_partition(graph, max(1, round(n / block)))
    size = block_size(partition, OVERLAP)
    return grow_blocks(graph, partition, size), size


class CoarseFilter:
    """A low-pass filter of everything that lives on the vertices of one connectivity."""

    def __init__(
        self,
        faces: Faces,
        n: int,
        keep: float = KEEP,
        block: int = BLOCK_SIZE,
        rules: ChainRules = RULES,
    ) -> None:
        blocks, self._size = overlapping(faces, n, block)
        self._blocks = _dictionaries(blocks, self._width(keep), rules)

    def __call__(self, values: Floats, keep: float = KEEP) -> Floats:
        """Filter `values`, shape (n, 3); `keep` is at most the filter's."""
        width = self._width(keep)
        blend = Blend(len(values))
        for vertices, copies, dictionary in self._blocks:
            subspace = dictionary[:, :width]
            # Constants are in the subspace but for rounding, which far from the origin would be all there is.
            center = values[vertices].mean(axis=0)
            # Twice a thin product, never the n x n projection.
            blend.add(
                vertices, subspace @ (subspace.T @ (values[vertices] - center)) + center, copies
            )
        return blend.all_positions()

    def _width(self, keep: float) -> int:
        return max(1, round(keep * self._size))


def _dictionaries(
    blocks: Blocks, width: int, rules: ChainRules
) -> list[tuple[Indices, Floats, Floats]]:
    """Vertices of every block, their weights, and its dictionary; chains run in parallel."""

    def dictionaries_of(indices: range) -> list[tuple[Indices, Floats, Floats]]:
        chain = Chain(rules, blocks)
        found = []
        for index in indices:
            vertices, _, weights = chain.begin(index)
            dictionary = chain.dictionary(width)
            # The next dictionary starts from this one. Positions do not matter here, for nothing is predicted.
            chain.commit(dictionary.shape[1], np.zeros((len(vertices), 3)))
            found.append((vertices, weights, dictionary.astype(np.float64)))
        return found

    return [
        each
        for found in ordered_map(dictionaries_of, rules.chains(blocks.count), None)
        for each in found
    ]


def by_lengths(positions: Positions) -> ChainRules:
    """The rules with L's edges weighted by one over their length, the root of equation 2, exactly solved."""

    def dictionary(site: Around, width: int, _: Columns) -> Floats:
        rows = np.repeat(np.arange(len(site.vertices)), np.diff(site.offsets))
        sides = positions[site.vertices[rows]] - positions[site.vertices[site.neighbors]]
        lengths = np.sqrt(np.square(sides).sum(axis=1))
        mean = lengths.sum() / max(len(lengths), 1) or 1.0
        # Dense: LAPACK finds the lowest vectors of a few hundred vertices sooner than a sparse solver would.
        laplacian = np.zeros((len(site.vertices),) * 2)
        laplacian[rows, site.neighbors] = -1.0 / np.maximum(lengths / mean, SHORTEST)
        np.fill_diagonal(laplacian, -laplacian.sum(axis=1))
        lowest: Floats = scipy.linalg.eigh(
            laplacian, subset_by_index=(0, min(width, len(laplacian)) - 1)
        )[1]
        return lowest

    return replace(RULES, overrides=Overrides(dictionary))


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
        deviations = list(
            ordered_map(lambda index: noise_deviation(trajectories(index)), indices, None)
        )
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
