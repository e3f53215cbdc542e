"""A way of denoising that can be run on any mesh: a hand-over, then iterations of a guided filter."""

from __future__ import annotations

from collections.abc import Callable, Iterator
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
    """What is done to the noisy mesh; how often the filter is repeated is not part of it."""

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


class Treatments:
    """What recipes make of one mesh: where they start is found once for all that start there, and so are results."""

    def __init__(self, noisy: Positions, smooth: Callable[[float], Positions], topology: Topology) -> None:
        self.noisy, self._smooth, self._topology = noisy, smooth, topology
        self._starts: dict[tuple[str, float], GuidedFilter] = {}
        self._results: dict[Step, Positions] = {}

    def iterates(self, recipe: Recipe) -> Iterator[Positions]:
        """The positions, shape (n, 3), after the hand-over and 0, 1, 2, ... iterations, without end."""
        where = (recipe.hand_over, recipe.keep if recipe.needs_coarse else 0.0)
        start = self._starts.get(where)
        if start is None:
            smooth = self._smooth(recipe.keep) if recipe.needs_coarse else self.noisy
            positions = hand_over(recipe.hand_over)(self.noisy, smooth, self._topology)
            start = self._starts[where] = GuidedFilter(positions, self._topology)
        if recipe.guide == LOCAL:
            return filtered_normals(start.positions, self._topology, recipe.sigma_r)
        return _guided(start, named("guide", GUIDES, recipe.guide), recipe.sigma_r)

    def mean(self, steps: tuple[Step, ...]) -> Positions:
        """The mean of what the steps make, shape (n, 3); any number of threads may ask."""
        for step in steps:
            if step not in self._results:
                self._results[step] = next(islice(self.iterates(step.recipe), step.iterations, None))
        return blend([self._results[step] for step in steps])


def blend(results: list[Positions]) -> Positions:
    """The mean of several results, each of shape (n, 3): errors of different recipes partly cancel."""
    mean: Positions = results[0] if len(results) == 1 else np.mean(results, axis=0)
    return mean


def _guided(start: GuidedFilter, guide: Guide, sigma_r: float) -> Iterator[Positions]:
    positions = start.positions
    while True:
        yield positions
        positions = start.step(positions, guide, sigma_r)
