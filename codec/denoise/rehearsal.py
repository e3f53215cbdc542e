"""Rehearsal (a parametric bootstrap): a good guess at the clean mesh is made noisy again, and the answer is known.

A guess that still has noise in it asks for too few iterations, one that is too smooth for too many. So the guess is
the noisy mesh after t iterations of a base filter, and t rises until the rehearsal asks for hardly more iterations than
the guess was given. Noise of the kind that was found is drawn anew.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.denoise.filters import Filter, Filtered, Filters, Step
from bsm.codec.denoise.noise.finding import Finding, NoiseLevel, Synthesis
from bsm.codec.denoise.surface import pair_distances
from bsm.codec.geometry.metrics import Reference, face_geometry, face_normals, mean_edge_length
from bsm.codec.threads import ordered_map

MOST_ITERATIONS = 100  # no filter has wanted as many; it keeps the work bounded
PATIENCE = 2  # iterations that are tried after the best one
MOST_MEMBERS = 4  # of a blend; two leave 2.2 % more of the angle, eight 0.7 % less and take longer
# Members join while the error stays below this multiple: several make fewer mistakes than one.
GAIN = 1.01
# What errors after learnt normals count: true shapes have less noise, and more detail, than guesses.
EASIER = 0.93
FINE_SHAPE, FILTERED = 1.3, 0.6
"""Finest frequencies of steadied frames over their noise, from which on they hold detail of the shape; and the share of
an iteration in the guess at other frames."""
NOISE_OVER = (0.25, 4.0)  # bounds of the noise's energy over that of the rehearsal
# Share of faces lower than the noise is high, from which on angles cannot be estimated.
MOST_DROWNED = 0.1

Goal = Callable[[Reference, Positions], float]
Progress = Callable[[str, float], None]


def shape(reference: Reference, positions: Positions) -> float:
    """Root mean square distance of the vertices from `positions`, shape (n, 3), in mean edges."""
    distance = np.sqrt(np.square(reference.positions - positions).sum(axis=1).mean())
    return float(distance) / mean_edge_length(reference.positions, reference.faces)


GOALS: dict[str, Goal] = {
    "shading": Reference.theta,
    "shape": shape,
    "both": lambda reference, positions: reference.theta(positions) * shape(reference, positions),
}


@dataclass(frozen=True, eq=False)
class Rehearsed:
    """Steps and a finish, their error in a rehearsal, and their result, shape (n, 3)."""

    steps: tuple[Step, ...]
    error: float
    result: Positions
    finish: str = "none"


@dataclass(frozen=True)
class Forecast:
    """Angles to expect where there is noise, without and with the filter, and whether they can be known at all."""

    untreated: float
    expected: float
    reliable: bool


class Rehearsal:
    """A mesh, a guess at it without noise, and the guess with noise again."""

    def __init__(
        self,
        mesh: Filtered,
        surface: Filters,
        finding: Finding,
        level: NoiseLevel,
        base: Filter,
        goal: Goal,
    ) -> None:
        self._mesh, self._surface, self._topology, self._goal = (
            mesh,
            surface,
            surface.topology,
            goal,
        )
        self._finding, self._level, self._touched = finding, level, finding.levels > 0.0
        self._synthesis = Synthesis(finding, surface.probe, level.tangential)
        if finding.kind == "unsteady":
            self._rehearse(self._guess_steadied(base))
            return
        iterations = 1
        for count, guess in enumerate(mesh.iterates(base)):
            if count < iterations:
                continue
            self._rehearse(self._within(guess, mesh.positions))
            best_count = self.attempt(base).steps[0].iterations
            if best_count <= 1.5 * iterations + 0.5:
                break
            iterations = best_count

    def _guess_steadied(self, base: Filter) -> Positions:
        """Guess at a mesh, shape (n, 3), with little noise: one without any has lost detail, and all asks for none."""
        positions = self._mesh.positions
        if self._level.normal > FINE_SHAPE * self._finding.level:
            return positions
        filtered = self._within(next(islice(self._mesh.iterates(base), 1, None)), positions)
        return np.asarray(positions + FILTERED * (filtered - positions))

    def _rehearse(self, guess: Positions, seed: int = 1) -> None:
        """Make a guess, shape (n, 3), noisy."""
        self.truth = Reference(guess, self._topology.faces)
        self.noisy = self._synthesis.draw(guess, seed)
        self._trial = Filtered(self.noisy, self._surface, self._finding)

    def again(self, outcome: Rehearsed) -> None:
        """Rehearse with the result of an outcome on the mesh as the guess."""
        self._rehearse(self._performed(outcome), seed=2)

    def _performed(self, outcome: Rehearsed) -> Positions:
        result = self._mesh.finished(self._mesh.mean(outcome.steps), outcome.finish)
        return self._within(result, self._mesh.positions)

    def changed(self, outcome: Rehearsed) -> float:
        """How far the mesh that is rehearsed for is from its result, in the unit of the errors."""
        return self._goal(
            Reference(self._performed(outcome), self._topology.faces), self._mesh.positions
        )

    def lost(self, winner: Rehearsed) -> float:
        """Return the roughness that the filter takes from the guess, a logarithm; 0 where there is none."""
        before = self._roughness(self.truth.positions)
        after = self._roughness(winner.result)
        if not (before > 0.0 and after > 0.0):
            return 0.0
        return float(np.log(before / after))

    def forecast(self, winner: Rehearsed) -> Forecast:
        """Return the angles to expect on the rehearsed mesh."""
        noisy_share = float(self._touched[self._topology.faces].any(axis=1).mean()) or 1.0
        reliable = self._finding.clear and self._drowned < MOST_DROWNED
        shape_energy = self._roughness(self.truth.positions) ** 2
        drawn = self._roughness(self.noisy) ** 2 - shape_energy
        present = self._roughness(self._mesh.positions) ** 2 - shape_energy
        strength = 1.0
        if drawn > 0.0:
            # Rehearsals draw more noise than there is where triangles are thin.
            strength = float(np.sqrt(np.clip(present / drawn, *NOISE_OVER)))
        return Forecast(
            strength * self.untreated / noisy_share, winner.error / noisy_share, reliable
        )

    @property
    def _drowned(self) -> float:
        """The share of the faces that are lower than the noise is high, whose normals it may turn anywhere."""
        positions, faces = self.truth.positions, self._topology.faces
        sides = positions[faces] - positions[np.roll(faces, 1, axis=1)]
        longest = np.sqrt(np.square(sides).sum(axis=2).max(axis=1))
        heights = 2.0 * face_geometry(positions, faces).areas / np.maximum(longest, 1e-300)
        return float((heights < self._level.normal + self._level.tangential).mean())

    def _roughness(self, positions: Positions) -> float:
        """Mean distance between the normals of neighboring faces."""
        normals = face_normals(positions, self._topology.faces)
        return float(pair_distances(normals, self._topology.pairs).mean())

    @property
    def untreated(self) -> float:
        return self._goal(self.truth, self.noisy)

    def attempt(self, filter_: Filter) -> Rehearsed:
        """Iterate until nothing has improved for a while."""
        best = Rehearsed((Step(filter_, 0),), np.inf, self.noisy)
        run = self._trial.iterates(filter_)
        for count, positions in enumerate(islice(run, MOST_ITERATIONS + 1)):
            result = self._within(positions, self.noisy)
            error = self._goal(self.truth, result)
            if error < best.error:
                best = Rehearsed((Step(filter_, count),), error, result)
            elif count >= best.steps[0].iterations + PATIENCE:
                break
        return best

    def compete(
        self, filters: tuple[Filter, ...], finishes: list[str], progress: Progress
    ) -> Rehearsed:
        """The steps whose mean is best, found greedily, with the best finish."""
        alone = []
        for number, outcome in enumerate(ordered_map(self.attempt, filters, None), start=1):
            progress(f"rehearsing {number} of {len(filters)}", number / len(filters))
            alone.append(outcome)
        alone.sort(key=lambda outcome: outcome.error)
        chosen, best = [alone[0]], alone[0]
        while len(chosen) < MOST_MEMBERS:
            members = [member.result for member in chosen]
            means = [np.mean([*members, candidate.result], axis=0) for candidate in alone]
            errors = [self._goal(self.truth, mean) for mean in means]
            number = int(np.argmin(errors))
            if errors[number] > GAIN * best.error:
                break
            chosen.append(alone[number])
            steps = tuple(member.steps[0] for member in chosen)
            best = Rehearsed(steps, errors[number], means[number])
        return self._finished(best, finishes)

    def _finished(self, best: Rehearsed, finishes: list[str]) -> Rehearsed:
        """The result of some steps with the best finish."""
        outcomes, handicapped = [], []
        for finish in finishes:
            result = self._within(self._trial.finished(best.result, finish), self.noisy)
            error = self._goal(self.truth, result)
            outcomes.append(replace(best, error=error, result=result, finish=finish))
            if "learnt" in finish:
                error *= EASIER
            handicapped.append(error)
        return outcomes[int(np.argmin(handicapped))]

    def flattened(self, winner: Rehearsed, finishes: list[str]) -> Rehearsed:
        """The winner, put on planes, with the finish that is best then, with its own result as the guess."""
        on_planes = {"none": "flat", "learnt": "flat, learnt"}
        self.again(replace(winner, finish=on_planes[winner.finish]))
        result = self._trial.mean(winner.steps)
        return self._finished(
            replace(winner, result=result), [on_planes[finish] for finish in finishes]
        )

    def _within(self, positions: Positions, otherwise: Positions) -> Positions:
        if self._finding.exact and self._finding.bound is not None:
            positions = self._finding.bound.within(otherwise, positions)
        return (
            positions
            if self._touched.all()
            else np.where(self._touched[:, None], positions, otherwise)
        )
