"""A way of denoising that can be run on any mesh: a hand-over, then iterations of a guided filter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from codec.choices import named
from codec.denoise.filters.guidance import patch_guidance
from codec.denoise.filters.guided import Guide, GuidedFilter, own_normals
from codec.denoise.filters.topology import Topology
from codec.denoise.handover import hand_over
from codec.geometry.mesh import Positions

GUIDES: dict[str, Guide] = {"patches": patch_guidance, "own": own_normals}


@dataclass(frozen=True)
class Recipe:
    """What is done to the noisy mesh; how often the filter is repeated is not part of it.

    Attributes
    ----------
    hand_over : str
        Name of a hand-over: "positions", "normals" or "none".
    keep : float
        Fraction of the frequencies that the coarse mesh keeps, c over n_d.
    guide : str
        "patches": guided normal filtering; "own": bilateral filtering.
    sigma_r : float
        Width of the filter's range kernel.
    """

    hand_over: str
    keep: float
    guide: str
    sigma_r: float


def iterates(recipe: Recipe, noisy: Positions, smooth: Positions, topology: Topology) -> Iterator[Positions]:
    """The positions after the hand-over and 0, 1, 2, ... iterations, without end; `smooth` is the coarse mesh."""
    positions = hand_over(recipe.hand_over)(noisy, smooth, topology)
    guide = named("guide", GUIDES, recipe.guide)
    filter_ = GuidedFilter(positions, topology)
    while True:
        yield positions
        positions = filter_.step(positions, guide, recipe.sigma_r)
