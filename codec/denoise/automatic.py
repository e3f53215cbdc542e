"""Denoising that chooses its own settings, by rehearsal (a parametric bootstrap).

The clean mesh is unknown, but a good guess at it can be made noisy again, with noise of the level that was estimated
on the input. On this rehearsal mesh the answer is known, so every way of denoising can be tried and measured.

The guess matters: one that still has noise in it takes the noise for detail and asks for too few iterations, one that
is too smooth asks for too many. So the guess is the noisy mesh after t iterations of a base recipe, and t rises from 1
until the rehearsal asks for hardly more iterations than the guess itself was given. On that last rehearsal all
candidates compete, doing nothing among them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from codec.denoise.coarse import CoarseFilter
from codec.denoise.estimate import NoiseLevel, add_noise, estimate_noise
from codec.denoise.filters.topology import Topology
from codec.denoise.recipe import Recipe, iterates
from codec.geometry.mesh import Faces, Positions
from codec.geometry.metrics import Reference, mean_edge_length
from codec.threads import ordered_map

MOST_ITERATIONS = 30
PATIENCE = 5
BASE = Recipe("normals", 0.20, "patches", 0.35)
CANDIDATES = tuple(
    Recipe(hand_over, 0.20, "own", sigma_r) for hand_over in ("normals", "positions") for sigma_r in (0.25, 0.4, 0.5)
)
LARGEST_KEEP = max(recipe.keep for recipe in (BASE, *CANDIDATES))
SEED = 1


@dataclass(frozen=True)
class AutomaticChoice:
    """What was chosen, and why.

    Attributes
    ----------
    recipe : Recipe, optional
        None: the mesh is best left alone.
    iterations : int
        Of the recipe's filter.
    noise : NoiseLevel
        Estimated on the input, in mean edge lengths.
    expected_theta : float
        Mean angle between the face normals of result and clean mesh in the last rehearsal, degrees. Real meshes have
        detail that the rehearsal lacks: take it as a lower bound.
    rehearsals : int
        How many there were.
    """

    recipe: Recipe | None
    iterations: int
    noise: NoiseLevel
    expected_theta: float
    rehearsals: int


@dataclass(frozen=True)
class _Trial:
    """The best that a recipe can do on a rehearsal mesh."""

    recipe: Recipe | None
    iterations: int
    theta: float


def denoise_automatically(positions: Positions, faces: Faces) -> tuple[Positions, AutomaticChoice]:
    """Denoise with settings that the noisy mesh itself suggests.

    Parameters
    ----------
    positions : ndarray of float64, shape (n, 3)
    faces : ndarray of int32, shape (m, 3)

    Returns
    -------
    ndarray of float64, shape (n, 3)
    AutomaticChoice
    """
    positions = np.array(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    coarse = CoarseFilter(faces, len(positions), LARGEST_KEEP)
    choice = choose(positions, coarse, topology)
    smooth = positions if choice.recipe is None else coarse(positions, choice.recipe.keep)
    return apply(choice, positions, smooth, topology), choice


def apply(choice: AutomaticChoice, noisy: Positions, smooth: Positions, topology: Topology) -> Positions:
    """Do what was chosen; `smooth` is the coarse mesh at the chosen fraction of the frequencies."""
    if choice.recipe is None:
        return noisy.copy()
    return _after(iterates(choice.recipe, noisy, smooth, topology), choice.iterations)


def choose(positions: Positions, coarse: CoarseFilter, topology: Topology) -> AutomaticChoice:
    """Estimate the noise and rehearse, see the module's description."""
    edge = mean_edge_length(positions, topology.faces)
    smooth = coarse(positions, BASE.keep)
    level = estimate_noise(positions, smooth, topology)
    base = iterates(BASE, positions, smooth, topology)
    given, done, rehearsals = 1, -1, 0
    while True:
        guess = _after(base, given - done - 1)
        done = given
        rehearsals += 1
        rehearsal = add_noise(guess, level, topology, SEED)
        truth = Reference(guess, topology.faces)
        wanted = _try(BASE, rehearsal, truth, coarse, topology).iterations
        if wanted <= 1.5 * given + 0.5:
            break
        given = wanted

    def attempt(recipe: Recipe) -> _Trial:
        return _try(recipe, rehearsal, truth, coarse, topology)

    nothing = _Trial(None, 0, truth.theta(rehearsal))
    best = min([nothing, *ordered_map(attempt, CANDIDATES, None)], key=lambda trial: trial.theta)
    noise = NoiseLevel(level.normal / edge, level.tangential / edge)
    return AutomaticChoice(best.recipe, best.iterations, noise, best.theta, rehearsals)


def _try(recipe: Recipe, noisy: Positions, truth: Reference, coarse: CoarseFilter, topology: Topology) -> _Trial:
    """Iterate until nothing has improved for a while."""
    best = _Trial(recipe, 0, np.inf)
    run = iterates(recipe, noisy, coarse(noisy, recipe.keep), topology)
    for count, positions in enumerate(islice(run, MOST_ITERATIONS + 1)):
        angle = truth.theta(positions)
        if angle < best.theta:
            best = _Trial(recipe, count, angle)
        elif count >= best.iterations + PATIENCE:
            break
    return best


def _after(run: Iterator[Positions], count: int) -> Positions:
    """The result `count` places further on."""
    return next(islice(run, count, None))
