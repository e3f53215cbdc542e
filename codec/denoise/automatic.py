"""Denoising that chooses its own settings, and does not change a mesh that it cannot improve."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from bsm.bitstream.errors import counted
from bsm.codec.arrays import Faces, Floats, Mask, Order, Positions
from bsm.codec.blocks.overlap import metis_partition
from bsm.codec.choices import named
from bsm.codec.denoise.filters import BENDS, RAYS, TGV, Filter, Filters, Step
from bsm.codec.denoise.noise.causes import Cells, Reach
from bsm.codec.denoise.noise.finding import Finding, NoiseLevel, estimate_noise
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.noise.search import FAINTEST
from bsm.codec.denoise.rehearsal import GOALS, Forecast, Progress, Rehearsal
from bsm.codec.denoise.surface import Topology, mend_folds
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.metrics import face_normals

# Vertices of pieces on which meshes are rehearsed that are larger than one piece more.
PIECE, PIECES = 2000, 2


def sample(faces: Faces, levels: Floats) -> tuple[Order, Faces]:
    """Vertices of the sample, ascending, and its faces in their numbers; all of a mesh that is not large."""
    n = len(levels)
    if n <= (PIECES + 1) * PIECE:
        return np.arange(n), faces
    labels = metis_partition(graph_of_faces(faces, n), round(n / PIECE)).labels
    means = np.bincount(labels, levels) / np.bincount(labels)
    means = np.round(means / means.max(), 6)
    # Equal means keep the order of the parts, which lie all over the surface; rounded, no draw changes it.
    order = np.argsort(means, kind="stable")
    order = order[means[order] > 0.5]
    chosen = order[
        np.linspace(0, len(order) - 1, min(PIECES, len(order)) + 2).astype(np.int64)[1:-1]
    ]
    inside = np.isin(labels, chosen)
    number = np.cumsum(inside) - 1
    return np.flatnonzero(inside), number[faces[inside[faces].all(axis=1)]].astype(np.int32)


CANDIDATES = (
    Filter("normals", 0.2, 0.25),  # makes the first guess
    Filter("heights", 0.2, 0.4),
    Filter("heights", 0.1, 0.55),
    Filter(TGV, 1.0, 0.25),
)
# Noise along the surface slides vertices, which then go back there.
SLIDING = tuple(
    replace(each, hand_over=each.hand_over.replace("heights", "positions")) for each in CANDIDATES
)
# Makes the first guess where noise is along an axis, or rounding.
PATCHES = Filter("normals", 0.2, 0.35, "patches")
# Noise along an axis slides vertices as well.
AXIAL = (
    PATCHES,
    CANDIDATES[0],
    *(Filter("positions", *way) for way in ((0.4, 0.4), (0.2, 0.25), (0.1, 0.55))),
)
SEEN = tuple(
    Filter(RAYS, keep, sigma_r)
    for keep, sigma_r in ((0.3, 0.4), (1.0, 0.4), (0.3, 0.25), (1.0, 0.55))
)
"""For scans of one view."""
STEPPED = 0.7  # weight of bends where depths are in steps, which hide the level of the noise
FUSED = tuple(Filter(BENDS, weight, 0.3) for weight in (0.15, 0.3, 0.6))
SPECIAL = {"view": SEEN, "axis": AXIAL, "fused": FUSED}
EVEN, FUSED_UNEVEN, FUSED_MOST = 0.2, 7.0, 2.5
"""For volumes, whose noise is even and as fine as their cells. Noise of cameras is uneven, and too broad to rehearse
with: the weight of bends over the unevenness, and its bound."""
CELL_ITERATIONS = 15  # for binary volumes
THICK, BENDS_WIDTH, BENDS_ITERATIONS = 2.5, 0.3, (8, 12)
"""Slices from `THICK` cells across on also get the surface of fewest bends, from twice that on in two versions. It is
best on smooth shapes; its mean with the other filter loses nothing where detail is finer than slices."""
# Share of the stairs on walls of one slice, from which on a filter without a coarse step joins.
WALLS = 0.6
# That progress tells of: noise is found, filters are rehearsed twice, and the choice is carried out.
STAGES = 4
MOST_TAUGHT = 40_000
"""Vertices up to which white noise is removed with learnt normals, which leave 3 % less of it, and any noise by total
generalized variation, whose linear systems take two kilobytes of memory a vertex."""
# Shares of the faces on planes from which on these count, and networks do not.
SOME_FLAT, MOST_FLAT = 0.33, 0.8
# The rehearsal has to promise an error below this multiple of what doing nothing leaves.
WORTH = 0.9
AS_LARGE = 1.05
"""Rehearsed error over the change, from which on nothing tells noise from shape; and over the error before, as
roughness tells it, from which on thin parts became worse."""
MOST, MOST_UNKNOWN = 1.9, 1.25
"""Movement along the normals over noise, above which a window has lost more than noise: where noise is known, which
varies by chance between windows if neighbors share it, and with the slant in scans of one view; and where it is not."""
# At most, correlated noise over its finest frequencies, a ratio that is the same everywhere.
MOST_CORRELATED = 4.0
DETAIL_LOST = {"shading": 0.075, "shape": 0.03, "both": 0.03}
"""Noise may hold detail where rehearsals for a goal lose more roughness than this (a logarithm)."""
NOISE_ALONE, DETAIL_SLOPE, DETAIL_MOST = 1.03, 4.0, 0.4
"""Its level over that in the finest frequencies without detail, the share of movements that is not made for each unit
more, and the largest one."""
REACHED = 0.5  # share of the level of the noise from which on a window counts for the whole
# Error to expect where detail is as fine as the noise, which no rehearsal sees, over the rehearsed one.
DETAIL = 1.65
FAILED_SHARE = 0.3  # a result that fails in more of the mesh fails as a whole


BY_CAUSE = "by the cause of the noise"


@dataclass(frozen=True)
class AutomaticChoice:
    steps: tuple[Step, ...]
    kind: str
    reason: str
    noise: NoiseLevel
    untreated: float
    expected: float
    finish: str = "none"
    detailed: bool = False
    outliers: int = 0
    forecast: Forecast | None = None
    why: str = BY_CAUSE  # these steps were chosen

    @property
    def reliable(self) -> bool:
        """Whether the expected errors can be relied on."""
        return self.forecast is None or (self.forecast.reliable and self.expected < self.untreated)

    @property
    def at_most(self) -> float:
        """The error to expect where detail is as fine as the noise."""
        most = DETAIL if self.forecast else 1.0
        return max(min(most * self.expected, self.untreated), self.expected)

    def doubted(self, changed: float) -> Self:
        """The choice, or none if its expected error is too large beside that of doing nothing, or beside the change."""
        least_forecast = np.inf
        if self.forecast is not None:
            least_forecast = self.forecast.untreated
        doubts = {
            "any filter would cost more than it gains": WORTH * self.untreated,
            # Noise reads 0.15 to 1.01 of it, clean meshes that were taken for noisy 1.1, 1.2 and 2.1.
            "the expected error is as large as the change": AS_LARGE * changed,
            "the triangles are so uneven that any filter would turn their normals farther": AS_LARGE
            * least_forecast,
        }
        for doubt, most in doubts.items():
            if self.steps and self.expected > most:
                return replace(
                    self, steps=(), expected=self.untreated, reason=f"{self.reason}, but {doubt}"
                )
        return self

    def carried_out(
        self, share: float, full: Positions, result: Positions, noisy: Mask, topology: Topology
    ) -> Self:
        """Return the choice with the angles of the whole mesh, whose errors count by the share that is applied."""
        assert self.forecast is not None
        full_normals, normals = (
            face_normals(full, topology.faces),
            face_normals(result, topology.faces),
        )
        half_chord = 0.5 * np.linalg.norm(full_normals - normals, axis=1)
        undone = np.degrees(2.0 * np.arcsin(np.minimum(half_chord, 1.0)))
        touched = noisy[topology.faces].any(axis=1)
        errors = np.hypot(undone, share * self.forecast.expected)
        expected = float((touched * errors).mean())
        return replace(
            self, untreated=self.forecast.untreated * float(touched.mean()), expected=expected
        )

    def after(self, outliers: int) -> Self:
        """The choice for a mesh of which outliers have been put back."""
        if self.steps or not outliers:
            return replace(self, outliers=outliers)
        reason = f"{counted(vertices=outliers)} that stood out"
        return replace(self, kind="outliers", reason=reason, outliers=outliers)


def choose(
    positions: Positions, finding: Finding, surface: Filters, goal: str, progress: Progress
) -> AutomaticChoice:
    """Rehearse on `positions`, shape (n, 3), or a part of them if they are many, and pick what did best."""
    if not finding.noisy:
        return AutomaticChoice((), finding.kind, finding.reason, NoiseLevel(0.0, 0.0), 0.0, 0.0)
    if finding.kind == "cells" or finding.uneven > EVEN or finding.stepped:
        return _by_cause(finding)
    special = SPECIAL.get(finding.kind)
    members, part = sample(surface.topology.faces, finding.levels)
    chosen = positions
    if len(members) < len(positions):
        surface, chosen = Filters(part, len(members)), positions[members]
    first = (special or CANDIDATES)[0]
    level = estimate_noise(chosen, surface.smooth(chosen, first), surface.probe)
    small = len(positions) <= MOST_TAUGHT
    filters = special or _general_filters(finding, level, small)
    part_finding = finding.on(members).reaching(surface.topology, level.slides)
    mesh = surface.filtered(chosen, part_finding)
    rehearsal = Rehearsal(
        mesh, surface, part_finding, level, filters[0], named("goal", GOALS, goal)
    )
    flat = 0.0
    if finding.kind == "white":
        flat = mesh.planes(rehearsal.truth.positions).share
    finishes = ["none"]
    learnable = small or finding.kind not in ("white", "unsteady")
    if special is None and learnable and not level.slides and flat < MOST_FLAT:
        finishes.append("learnt")
    winner = rehearsal.compete(
        filters, finishes, lambda name, share: progress(name, (1.0 + share) / STAGES)
    )
    steadied = finding.kind == "unsteady"
    if not steadied:
        # The result of some filters is a better guess. A third round would repeat its own mistakes.
        rehearsal.again(winner)
        winner = rehearsal.compete(
            filters, finishes, lambda name, share: progress(name, (2.0 + share) / STAGES)
        )
    if flat > SOME_FLAT:
        winner = rehearsal.flattened(winner, finishes)
    noise = NoiseLevel(level.normal / finding.edge, level.tangential / finding.edge)
    why = f"these of {len(filters)} filters left the least error on the result with new noise"
    choice = AutomaticChoice(
        winner.steps,
        finding.kind,
        finding.reason,
        noise,
        rehearsal.untreated,
        winner.error,
        winner.finish,
        why=why,
    )
    detailed = finding.kind == "white" and rehearsal.lost(winner) > DETAIL_LOST[goal]
    changed, forecast = np.inf, None
    if not steadied:
        changed = rehearsal.changed(winner)
    if goal == "shading" or not finding.clear:
        forecast = rehearsal.forecast(winner)
    return replace(choice, detailed=detailed, forecast=forecast).doubted(changed)


def _general_filters(finding: Finding, level: NoiseLevel, small: bool) -> tuple[Filter, ...]:
    """Return the filters that may be best for noise without a cause of its own."""
    filters: tuple[Filter, ...] = CANDIDATES
    if level.slides:
        filters = SLIDING
    if not small:
        filters = tuple(each for each in filters if each.hand_over != TGV)
    if finding.kind == "grid":
        filters = (PATCHES, *filters)
    return filters


def _by_cause(finding: Finding) -> AutomaticChoice:
    """Choose the filter that suits the cause, without a rehearsal."""
    steps: tuple[Step, ...]
    if finding.stepped:
        assert finding.view is not None
        steps = (Step(Filter(RAYS, STEPPED / finding.view.level, 0.4), 2),)
    elif finding.kind == "fused":
        weight = min(FUSED_UNEVEN * finding.uneven, FUSED_MOST)
        steps = (Step(Filter(BENDS, weight, 0.4), 0),)
    else:
        assert isinstance(finding.bound, Cells)
        flat, stored = finding.bound.flatness, finding.bound.thick > 1
        versions = 1 if stored else int(flat // THICK)
        more = BENDS_ITERATIONS[:versions]
        steps = tuple(Step(Filter(BENDS, 0.0, BENDS_WIDTH), count) for count in more)
        if more and not stored and finding.bound.thin > WALLS:
            steps = (*steps, Step(Filter("none", 0.0, 0.4), BENDS_ITERATIONS[0]))
        if not stored:
            # Stairs of thick slices are steeper.
            width = min(CANDIDATES[0].sigma_r * flat ** (2.0 / 3.0), 1.0)
            steps = (*steps, Step(Filter("positions", CANDIDATES[0].keep, width), CELL_ITERATIONS))
    noise = NoiseLevel(finding.level / finding.edge, 0.0)
    unknown = Forecast(0.0, 0.0, reliable=False)
    return AutomaticChoice(steps, finding.kind, finding.reason, noise, 0.0, 0.0, forecast=unknown)


def treat(
    choice: AutomaticChoice,
    noisy: Positions,
    finding: Finding,
    surface: Filters,
    strength: float = 1.0,
) -> tuple[Positions, AutomaticChoice]:
    """Apply the choice to `noisy`, shape (n, 3), where it is safe; also return it as carried out, with its angles."""
    if not choice.steps:
        return noisy, choice
    finding, touched = finding.reaching(surface.topology, choice.noise.slides), finding.levels > 0.0
    filtered = surface.filtered(noisy, finding)
    full = filtered.finished(filtered.mean(choice.steps), choice.finish)
    if isinstance(finding.bound, Reach):
        full = mend_folds(full, surface.topology, surface.probe.average)
    full = np.where(touched[:, None], full, noisy)
    # Filters part vertices that rounding has merged, and hold them to their cells from there.
    if finding.exact and finding.bound is not None:
        full = finding.bound.within(noisy, full)
    good, reason = judge(noisy, full, finding, surface.probe)
    if reason:
        return noisy, replace(choice, steps=(), reason=reason)
    share, result = 1.0, full
    if choice.detailed:
        share = restraint(finding, choice.noise.normal * finding.edge)
    if share < 1.0:
        result = noisy + share * (full - noisy)
    result = np.where(good[:, None], result, noisy)
    if choice.forecast:
        part = noisy + strength * (result - noisy)
        choice = choice.carried_out(share * strength, full, part, touched, surface.topology)
    return result, choice


def judge(noisy: Positions, result: Positions, finding: Finding, probe: Probe) -> tuple[Mask, str]:
    """Return which vertices may take the result, by its movement in each window, and why it may not as a whole."""
    everywhere = np.ones(len(noisy), dtype=np.bool_)
    windows = probe.windows
    if finding.kind == "cells":
        return everywhere, ""  # within the bound of the cause
    unsure = finding.kind == "unknown" and bool(windows.valid.any())
    if not finding.noisy and not unsure:
        # This check uses no statistics, because their absence may be why no noise was found.
        if np.linalg.norm(noisy - result, axis=1).max(initial=0.0) <= FAINTEST * finding.edge:
            return everywhere, ""
        return ~everywhere, f"{finding.reason}, and the result moves vertices nevertheless"
    normals = probe.smooth_normals(result, passes=0)
    removed = probe.levels(np.einsum("ij,ij->i", noisy - result, normals))
    measured = probe.levels(np.einsum("ij,ij->i", probe.fine(noisy), normals))
    expected, trust = windows.means(finding.levels), 0.5
    if unsure:
        expected = measured
    if finding.kind == "grid":
        # Rounding is known from its grid, and may hide from the finest frequencies where it has merged vertices.
        trust = 1.0
    present = np.where(expected > 0.0, np.maximum(measured, trust * expected), 0.0)
    ratio = removed / np.maximum(present, FAINTEST * finding.edge)
    # Where an axis hardly reaches, windows are put back one by one but do not count against the whole.
    judged = windows.valid & (expected > max(0.0, REACHED * finding.level))
    movement = float(np.median(ratio[judged])) if judged.any() else 0.0
    most = MOST
    if unsure:
        most = MOST_UNKNOWN
    elif finding.kind in ("correlated", "view", "fused"):
        most *= min(max(movement, 1.0), MOST_CORRELATED)
    bad = windows.valid & ~(ratio <= most)
    if not judged.any() or bad[judged].mean() <= FAILED_SHARE:
        return ~bad[windows.labels], ""
    reason = (
        f"the result moves vertices by {movement:.2f} times the noise, and takes shape away with it"
    )
    return ~bad[windows.labels], reason


def restraint(finding: Finding, finest: float) -> float:
    """How much of a movement to make where white noise, of this level in the finest frequencies, may hold detail."""
    if finest <= 0.0:
        return 1.0
    excess = finding.level / finest - NOISE_ALONE
    return 1.0 - min(max(DETAIL_SLOPE * excess, 0.0), DETAIL_MOST)
