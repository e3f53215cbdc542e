"""Filters for any mesh: a hand-over from the coarse step, iterations of a normal filter, and a finish."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice

import numpy as np

from bsm.bitstream.errors import OptionError, public
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Positions
from bsm.codec.choices import check_options
from bsm.codec.denoise.bends import flattened
from bsm.codec.denoise.coarse import BLOCK_SIZE, KEEP, CoarseFilter
from bsm.codec.denoise.learnt import Learnt, joined, learnt
from bsm.codec.denoise.noise.causes import FARTHEST, Cells, Spacing
from bsm.codec.denoise.noise.finding import Finding
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.paper import POWER, ROUNDS
from bsm.codec.denoise.planes import Planes, find_planes
from bsm.codec.denoise.surface import (
    FINE_STEPS,
    Guide,
    GuidedFilter,
    Topology,
    patch_guidance,
    surface_normals,
)
from bsm.codec.denoise.variation import varied_little
from bsm.codec.geometry.metrics import face_normals

GUIDES: dict[str, Guide] = {
    "patches": patch_guidance,
    "own": lambda geometry, topology: geometry.normals,
}
# Of options; without options, the data choose.
METHODS = ("spectral", "oi", "guided", "tgv", "learnt")
WITHOUT_COARSE = METHODS[2:]
RAYS, BENDS, TGV = "rays", "bends", "tgv"
"""Hand-overs without a coarse step: the surface of fewest bends along camera rays (`View.flattened`), or within cells
(`Cells.flattened`) or on its own; and total generalized variation of normals. `Filter.keep` is their weight."""

HandOver = Callable[[Positions, Positions, GuidedFilter], Positions]
"""From noisy and coarse positions, both (n, 3), to those from which the fine step starts (a new array)."""


def coarse_heights(noisy: Positions, coarse: Positions, guided: GuidedFilter) -> Positions:
    """Move the noisy vertices, shape (n, 3), along the normals of the coarse mesh, shape (n, 3), as far as that is."""
    normals = surface_normals(coarse, guided.topology)
    return np.asarray(noisy + np.einsum("ij,ij->i", coarse - noisy, normals)[:, None] * normals)


def coarse_normals(noisy: Positions, coarse: Positions, guided: GuidedFilter) -> Positions:
    """Keep the noisy positions, shape (n, 3), after one joint bilateral pass that the coarse mesh's normals guide."""
    guide = face_normals(coarse, guided.topology.faces)
    return guided.step(noisy, lambda *_: guide)


HAND_OVERS: dict[str, HandOver] = {
    "positions": lambda noisy, coarse, guided: np.array(coarse),  # the paper's
    "heights": coarse_heights,
    "normals": coarse_normals,
    "none": lambda noisy, coarse, guided: np.array(noisy),
}


@public
@dataclass(frozen=True, kw_only=True)
class DenoiseOptions:
    """Options of denoising by a coarse spectral step and a fine step on face normals.

    Parameters
    ----------
    method : str
        Method, or basis of the coarse step. "spectral": of one mesh, exact eigenvectors of a Laplacian whose edges
        weigh one over their length; this is not the paper's. Frames of a sequence share bases by orthogonal iterations
        without weights. "oi" (the paper's): orthogonal iterations without weights, in one chain of blocks.
        Three methods have no coarse step. "guided": the guided filter of normals. "tgv": total generalized variation
        of normals. "learnt": normals by trained networks.
    power, rounds : int
        With "oi", z of the iterated matrix R^z, and the iterations of each block but the first.
    hand_over : str
        "positions" (the paper's: the fine step sees the coarse mesh), "heights" (the same, but no vertex slides
        along the surface), "normals" (the noisy mesh, after a pass guided by the coarse mesh's normals) or "none" (no
        coarse step).
    fine : str
        Name of the fine step, see `codec.denoise.surface.FINE_STEPS`.
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

    method: str = METHODS[0]
    power: int = POWER
    rounds: int = ROUNDS
    hand_over: str = "positions"
    fine: str = "guided"
    iterations: int | None = None
    keep: float = KEEP
    block_size: int = BLOCK_SIZE

    def __post_init__(self) -> None:
        choices = {"method": METHODS, "hand_over": tuple(HAND_OVERS), "fine": tuple(FINE_STEPS)}
        counts = {
            "power": (1, 255),
            "rounds": (1, 255),
            "iterations": (0, 1 << 20),
            "block_size": (1, 1 << 20),
        }
        check_options(self, choices, {**counts, "keep": (1e-6, 1.0)})
        coarse = self.hand_over, self.keep, self.block_size
        if self.method in WITHOUT_COARSE and coarse != ("positions", KEEP, BLOCK_SIZE):
            raise OptionError(
                f"method {self.method} has no coarse step; leave out hand_over, keep and block_size"
            )
        if self.method in ("tgv", "learnt") and (self.fine, self.iterations) != ("guided", None):
            raise OptionError(
                f"method {self.method} has no fine step; leave out fine and iterations"
            )
        if self.method != "oi" and (self.power, self.rounds) != (POWER, ROUNDS):
            raise OptionError(f"power and rounds are for method oi, not for {self.method}")


# Share of learnt normals; and of frequencies that most coarse steps keep at most.
LEARNT, USUAL_KEPT = 0.6, 0.2


@dataclass(frozen=True)
class Filter:
    """Settings of a filter, without the number of iterations."""

    hand_over: str
    keep: float
    sigma_r: float
    guide: str = "own"

    @property
    def needs_coarse(self) -> bool:
        return self.hand_over not in ("none", RAYS, BENDS, TGV)


@dataclass(frozen=True)
class Step:
    filter: Filter
    iterations: int


class Filters:
    """The faces of a mesh, with what filters need of them, which is found once."""

    def __init__(self, faces: Faces, n: int) -> None:
        self.topology = Topology(faces, n)
        self.probe = Probe(self.topology)
        self._last: Filtered | None = None
        self._coarse: dict[float, CoarseFilter] = {}

    def smooth(self, positions: Positions, filter_: Filter) -> Positions:
        """The coarse mesh, shape (n, 3), that a filter needs; `positions` if it needs none."""
        if not filter_.needs_coarse:
            return positions
        most = max(filter_.keep, USUAL_KEPT)
        if most not in self._coarse:
            self._coarse[most] = CoarseFilter(
                self.topology.faces, self.topology.n, most, BLOCK_SIZE
            )
        return self._coarse[most](positions, filter_.keep)

    def filtered(self, positions: Positions, finding: Finding) -> "Filtered":
        """Return the filtered `positions`, shape (n, 3), and keep them until others are asked for; thread-safe."""
        last = self._last
        if last is None or last.positions is not positions:
            self._last = last = Filtered(positions, self, finding)
        return last


class Filtered:
    """Results of filters on one mesh; those with the same hand-over share their start."""

    def __init__(
        self, positions: Positions, surface: Filters, finding: Finding | None = None
    ) -> None:
        self.positions, self._surface, self._topology, self._finding = (
            positions,
            surface,
            surface.topology,
            finding,
        )
        self._noisy = positions
        self._within: Callable[[Positions], Positions] = np.asarray
        if finding is not None and isinstance(finding.bound, Spacing):
            self._noisy = finding.bound.parted(positions, surface.probe)
        if finding is not None and finding.bound is not None:
            self._within = partial(finding.bound.within, self._noisy)
        self._smoothed = surface.probe.average @ self._noisy
        self._guided = GuidedFilter(self._smoothed, self._topology, self._within)
        self._starts: dict[tuple[str, float], Positions] = {}
        self._results: dict[Step, Positions] = {}

    def iterates(self, filter_: Filter) -> Iterator[Positions]:
        """The positions, shape (n, 3), after the hand-over and 0, 1, 2, ... iterations, without end."""
        where = (filter_.hand_over, filter_.keep)
        if where not in self._starts:
            self._starts[where] = self._within(self._hand_over(filter_))
        return self._guided.iterates(self._starts[where], GUIDES[filter_.guide], filter_.sigma_r)

    def _hand_over(self, filter_: Filter) -> Positions:
        """Return the positions, shape (n, 3), from which the fine step starts."""
        noisy, topology, finding = self._noisy, self._topology, self._finding
        if filter_.hand_over == RAYS:
            assert finding is not None and finding.view is not None
            return finding.view.flattened(noisy, topology, filter_.keep)
        if filter_.hand_over == TGV:
            return varied_little(noisy, self._smoothed, topology, filter_.keep)
        if filter_.hand_over == BENDS and finding is not None and isinstance(finding.bound, Cells):
            return finding.bound.flattened(noisy, topology)
        if filter_.hand_over == BENDS:
            return flattened(noisy, self._smoothed, topology, filter_.keep)
        return HAND_OVERS[filter_.hand_over](
            noisy, self._surface.smooth(noisy, filter_), self._guided
        )

    def mean(self, steps: tuple[Step, ...]) -> Positions:
        """The mean result of the steps, shape (n, 3): errors of different filters partly cancel."""
        for step in steps:
            if step not in self._results:
                self._results[step] = next(
                    islice(self.iterates(step.filter), step.iterations, None)
                )
        return np.asarray(np.mean([self._results[step] for step in steps], axis=0))

    def finished(self, result: Positions, finish: str) -> Positions:
        """A result, shape (n, 3), with learnt normals, on the planes that explain it, or both, as the finish says."""
        moved = result
        if "learnt" in finish:
            moved = self._within(joined(result, self.learnt, LEARNT, self._topology))
        if "flat" not in finish:
            return moved
        put = self.planes(result).put(moved, self._topology)
        assert self._finding is not None
        far = np.linalg.norm(put - self._noisy, axis=1) > FARTHEST * self._finding.level
        return np.where(far[:, None], moved, put)

    def planes(self, result: Positions) -> Planes:
        """The planes that explain the noisy mesh where a result, shape (n, 3), shows them."""
        assert self._finding is not None
        return find_planes(self._noisy, result, self._finding.level, self._topology)

    @cached_property
    def learnt(self) -> Learnt:
        """The networks' result."""
        if self._finding is None:
            return learnt(self._noisy, self._topology)
        return learnt(self._noisy, self._topology, self._finding.levels > 0.0)
