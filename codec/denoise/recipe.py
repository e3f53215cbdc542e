"""A way of denoising that can be run on any mesh: a hand-over, then iterations of a guided filter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.choices import named
from bsm.codec.denoise.filters.bilateral_normal import filtered_normals
from bsm.codec.denoise.filters.guidance import patch_guidance
from bsm.codec.denoise.filters.guided import Guide, GuidedFilter, own_normals
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.handover import hand_over

GUIDES: dict[str, Guide] = {"patches": patch_guidance, "own": own_normals}
LOCAL = "local"


@dataclass(frozen=True)
class Recipe:
    """What is done to the noisy mesh; how often the filter is repeated is not part of it.

    Attributes
    ----------
    hand_over : str
        Name of a hand-over, see `codec.denoise.handover`.
    keep : float
        Fraction of the frequencies that the coarse mesh keeps, c over n_d; of no account without a hand-over.
    guide : str
        "patches": guided normal filtering; "own": bilateral filtering, the vertices following at once; "local":
        bilateral filtering of the normals over faces that touch, the vertices following at the end.
    sigma_r : float
        Width of the filter's range kernel.
    """

    hand_over: str
    keep: float
    guide: str
    sigma_r: float

    @property
    def needs_coarse(self) -> bool:
        """Whether the coarse mesh has a part in it."""
        return self.hand_over != "none"


@dataclass(frozen=True)
class Step:
    """A recipe and how often its filter is repeated."""

    recipe: Recipe
    iterations: int


def iterates(recipe: Recipe, noisy: Positions, smooth: Positions, topology: Topology) -> Iterator[Positions]:
    """The positions, shape (n, 3), after the hand-over and 0, 1, 2, ... iterations, without end.

    `noisy` and `smooth`, the coarse mesh, have that shape too.
    """
    positions = hand_over(recipe.hand_over)(noisy, smooth, topology)
    if recipe.guide == LOCAL:
        return filtered_normals(positions, topology, recipe.sigma_r)
    return _guided(positions, named("guide", GUIDES, recipe.guide), recipe.sigma_r, topology)


def perform(step: Step, noisy: Positions, smooth: Positions, topology: Topology) -> Positions:
    """The positions, shape (n, 3), after the step, from the noisy and the coarse ones."""
    return next(islice(iterates(step.recipe, noisy, smooth, topology), step.iterations, None))


def blend(results: list[Positions]) -> Positions:
    """The mean of several results, each of shape (n, 3): errors of different recipes partly cancel."""
    mean: Positions = results[0] if len(results) == 1 else np.mean(results, axis=0)
    return mean


def _guided(positions: Positions, guide: Guide, sigma_r: float, topology: Topology) -> Iterator[Positions]:
    filter_ = GuidedFilter(positions, topology)
    while True:
        yield positions
        positions = filter_.step(positions, guide, sigma_r)
