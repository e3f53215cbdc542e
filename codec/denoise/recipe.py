"""Recipes for any mesh: a hand-over from the coarse step, then iterations of a normal filter."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice

import numpy as np

from bsm.bitstream.errors import public
from bsm.codec.arrays import Faces, Mask, Positions
from bsm.codec.choices import check_options, named
from bsm.codec.denoise.bends import fewer_bends
from bsm.codec.denoise.coarse import BLOCK_SIZE, KEEP, CoarseFilter
from bsm.codec.denoise.learnt.cascade import Learnt, joined, learnt
from bsm.codec.denoise.noise.causes import Bound, Grid
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.noise.view import View
from bsm.codec.denoise.noise.volumes import Cells
from bsm.codec.denoise.normals import FINE_STEPS, Guide, GuidedFilter, filtered_normals, patch_guidance
from bsm.codec.denoise.surface import Topology, surface_normals
from bsm.codec.geometry.metrics import face_normals, mean_edge_length

GUIDES: dict[str, Guide] = {"patches": patch_guidance, "own": lambda geometry, topology: geometry.normals}
LOCAL = "local"
RAYS = "rays"  # the hand-over of scans of one view, see `View.flattened`; what is kept is its strength then
BENDS = "bends"  # of thick slices, see `Cells.flattened`, and of fused views, where `keep` is the weight of bends
SIGMA_R = 0.3  # width of the range kernel; half or twice of it leaves 0.1 and 1.1 % more of the angle

HandOver = Callable[[Positions, Positions, GuidedFilter], Positions]
"""From noisy and coarse positions, both (n, 3), to those from which the fine step starts (a new array)."""


def coarse_heights(noisy: Positions, coarse: Positions, guided: GuidedFilter) -> Positions:
    """Move the noisy vertices, shape (n, 3), along the normals of the coarse mesh, shape (n, 3), as far as that is."""
    normals = surface_normals(coarse, guided.topology)
    return np.asarray(noisy + np.einsum("ij,ij->i", coarse - noisy, normals)[:, None] * normals)


def coarse_normals(noisy: Positions, coarse: Positions, guided: GuidedFilter) -> Positions:
    """Keep the noisy positions, shape (n, 3), after one joint bilateral pass that the coarse mesh's normals guide."""
    guide = face_normals(coarse, guided.topology.faces)
    return guided.step(noisy, lambda *_: guide, SIGMA_R)


HAND_OVERS: dict[str, HandOver] = {
    "positions": lambda noisy, coarse, guided: np.array(coarse),  # the paper's
    "heights": coarse_heights,
    "normals": coarse_normals,
    "none": lambda noisy, coarse, guided: np.array(noisy),
}


@public
@dataclass(frozen=True, kw_only=True)
class DenoiseOptions:
    """Options of denoising. The defaults are the paper's coarse-to-fine scheme.

    Parameters
    ----------
    hand_over : str
        "positions" (the paper's: the fine step sees the coarse mesh), "heights" (the same, but no vertex slides
        along the surface), "normals" (the noisy mesh, after a pass guided by the coarse mesh's normals) or "none" (no
        coarse step).
    fine : str
        Name of the fine step, see `codec.denoise.normals.FINE_STEPS`.
    iterations : int, optional
        Of the fine step; None: the method's own number, 0: only the coarse step.
    keep : float
        Fraction of each block's frequencies that the coarse step keeps.
    block_size : int
        Approximate vertices of a block before overlap.

    Raises
    ------
    OptionError
        If a name is unknown or a number outside its range.

    Examples
    --------
    >>> import bsm
    >>> own = bsm.DenoiseOptions(hand_over="normals", fine="guided", iterations=10)
    >>> clean = bsm.denoise("scan.ply", own)
    """

    hand_over: str = "positions"
    fine: str = "guided"
    iterations: int | None = None
    keep: float = KEEP
    block_size: int = BLOCK_SIZE

    def __post_init__(self) -> None:
        choices = {"hand_over": tuple(HAND_OVERS), "fine": tuple(FINE_STEPS)}
        check_options(self, choices, {"iterations": (0, 1 << 20), "keep": (1e-6, 1.0), "block_size": (1, 1 << 20)})


@dataclass(frozen=True)
class Recipe:
    """Settings of one way to filter a noisy mesh, without the number of iterations."""

    hand_over: str
    keep: float
    guide: str
    sigma_r: float

    @property
    def needs_coarse(self) -> bool:
        return self.hand_over not in ("none", RAYS, BENDS)


@dataclass(frozen=True)
class Step:
    recipe: Recipe
    iterations: int


class Treatments:
    """Results of recipes on one mesh; those with the same hand-over share their start."""

    def __init__(self, noisy: Positions, patient: Patient) -> None:
        self._given, self._patient, self._topology = noisy, patient, patient.topology
        self.noisy = noisy = patient.parted(noisy)
        self._within = np.asarray if patient.bound is None else partial(patient.bound.within, noisy)
        self._guided = GuidedFilter(patient.probe.average @ noisy, self._topology, self._within)
        self._starts: dict[tuple[str, float], Positions] = {}
        self._results: dict[Step, Positions] = {}

    def iterates(self, recipe: Recipe) -> Iterator[Positions]:
        """The positions, shape (n, 3), after the hand-over and 0, 1, 2, ... iterations, without end."""
        where = (recipe.hand_over, 0.0 if recipe.hand_over == "none" else recipe.keep)
        start = self._starts.get(where)
        if start is None:
            view, bound = self._patient.view, self._patient.bound
            if recipe.hand_over == RAYS and view:
                positions = view.flattened(self.noisy, self._topology, recipe.keep)
            elif recipe.hand_over == BENDS and isinstance(bound, Cells):
                positions = bound.flattened(self.noisy, self._topology)
            elif recipe.hand_over == BENDS:
                middle, unit = self.noisy.mean(axis=0), mean_edge_length(self.noisy, self._topology.faces)
                given = (self.noisy - middle) / unit
                places = self._patient.probe.average @ given
                positions = middle + unit * fewer_bends(given, places, self._topology, recipe.keep)
            else:
                smooth = self._patient.smooth(self.noisy, recipe.keep) if recipe.needs_coarse else self.noisy
                positions = HAND_OVERS[recipe.hand_over](self.noisy, smooth, self._guided)
            start = self._starts[where] = self._within(positions)
        if recipe.guide == LOCAL:
            return filtered_normals(start, self._topology, recipe.sigma_r)
        return self._guided.iterates(start, named("guide", GUIDES, recipe.guide), recipe.sigma_r)

    def mean(self, steps: tuple[Step, ...], share: float = 0.0) -> Positions:
        """Return the mean result of the steps, shape (n, 3), with `share` of the learnt normals; thread-safe."""
        for step in steps:
            if step not in self._results:
                self._results[step] = next(islice(self.iterates(step.recipe), step.iterations, None))
        result = blend([self._results[step] for step in steps])
        return joined(result, self._patient.learnt(self._given), share, self._topology) if share > 0.0 else result


def blend(results: list[Positions]) -> Positions:
    """The mean of several results, each of shape (n, 3): errors of different recipes partly cancel."""
    return results[0] if len(results) == 1 else np.asarray(np.mean(results, axis=0))


class Patient:
    def __init__(self, faces: Faces, n: int) -> None:
        self.topology = Topology(faces, n)
        self.probe = Probe(self.topology)
        self.view: View | None = None
        self.bound: Bound | None = None
        self.noisy: Mask | None = None
        self.part: Callable[[], Learnt] | None = None  # learnt normals of the whole mesh, of which this is a sample
        self._last: tuple[Positions, Treatments] | None = None
        self._learnt: tuple[Positions, Learnt] | None = None
        self._coarse: CoarseFilter | None = None
        self._keep = 0.0

    def expect(self, keep: float) -> None:
        """Be ready for coarse meshes of up to that fraction of the frequencies."""
        if keep > self._keep:
            self._keep, self._coarse = keep, CoarseFilter(self.topology.faces, self.topology.n, keep, BLOCK_SIZE)

    def smooth(self, positions: Positions, keep: float) -> Positions:
        """The coarse mesh, shape (n, 3), as `positions` are."""
        self.expect(keep)
        assert self._coarse is not None
        return self._coarse(positions, keep)

    def parted(self, positions: Positions) -> Positions:
        return self.bound.parted(positions, self.probe) if isinstance(self.bound, Grid) else positions

    def learnt(self, positions: Positions) -> Learnt:
        """Return the networks' result on `positions`, shape (n, 3), and keep it until others are asked for."""
        last = self._learnt
        if last is None or last[0] is not positions:
            found = self.part() if self.part else learnt(self.parted(positions), self.topology, self.noisy)
            self._learnt = last = positions, found
        return last[1]

    def treatments(self, positions: Positions) -> Treatments:
        """Return treatments of `positions`, shape (n, 3), and keep them until others are asked for; thread-safe."""
        last = self._last
        if last is None or last[0] is not positions:
            self._last = last = positions, Treatments(positions, self)
        return last[1]
