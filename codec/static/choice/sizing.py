"""The best look of a size: of each way the finest rungs of a ladder that fit.

Rungs are an eighth of an octave apart and the same for all sizes, so that a larger size has all candidates of a smaller
one, or finer ones. Looks depend on luck, so several rungs of a way are drawn: more than luck can turn around.
"""

import math
from collections.abc import Callable, Iterator

import numpy as np

from bsm.bitstream.errors import LimitError
from bsm.codec.arrays import Matrix
from bsm.codec.static.choice.bounds import Bounds
from bsm.codec.static.choice.trace import Trace
from bsm.codec.static.choice.trials import BYTES, Trial, Way
from bsm.codec.static.preamble_encoding import Draft

RUNG = math.log(2.0) / 8.0
SPARSE = 3  # rungs from one trial to the next, where the search found none that fits
# Logarithm of a look, by which a way is expected to be worse than another one, and is not opened.
WORSE = 0.35
# Of the way from a first step to the one that is expected to fit, which may be wrong by so much.
FAR = 0.25


class SizeSearch:
    """Looks for the best trials of at most so many bytes."""

    def __init__(
        self, bounds: Bounds, size: Callable[[Draft], int], additions: int, trace: Trace
    ) -> None:
        self._bounds = bounds
        self._size = size
        self._additions = additions
        self._trace = trace
        graph_size = bounds.measures.prepared.graph.size
        self.usual_size = math.inf  # about the bytes of the default, once ways have told theirs
        self._saving = BYTES * graph_size
        # Rungs of a way, by how lucky looks may be.
        self._drawn = 1 + math.ceil(graph_size**-0.25 / RUNG)

    def trials(self, ways: list[Way], most: float) -> Iterator[tuple[float, Trial]]:
        """Yield trials of at most `most` bytes with their quality, as a logarithm; the lowest is best."""
        for way in self._promising(ways, most):
            for trial in self._fitting(way, most):
                quality = self._bounds.quality(trial)
                size = trial.draft.size
                error = math.exp(quality)
                self._trace.note("draw", way.name, step=trial.step, size=size, error=error)
                if self._bounds.keeps(trial):
                    yield quality, trial

    def _promising(self, ways: list[Way], most: float) -> list[Way]:
        """Return the ways whose steps at the size are not expected to look much worse than those of another way."""
        finest: dict[str, float] = {}
        errors: dict[str, float] = {}
        rival = math.inf
        for way in ways:
            try:
                estimate = way.estimate(rival)
            except LimitError:  # blocks that decoders would refuse
                continue
            rival = min(rival, estimate.size)
            self._trace.note("estimate", way.name, step=way.first, size=estimate.size)
            over = estimate.size + self._additions - most
            distance = over / max(estimate.saving, 1.0)
            finest[way.name] = math.log(way.first) + distance
            errors[way.name] = FAR * abs(distance)
        self.usual_size = rival + self._additions
        least = min(finest[name] + errors[name] for name in finest)
        promising = [
            way
            for way in ways
            if way.name in finest and finest[way.name] - errors[way.name] <= least + WORSE
        ]
        return sorted(promising, key=lambda way: finest[way.name])

    def _fitting(self, way: Way, most: float) -> list[Trial]:
        """Return the trials of the finest rungs of a way that fit."""
        rungs = _every(way.ladder)
        trials: dict[int, Trial] = {}

        def excess(index: int) -> float:
            """Return by how many bytes a rung is too large."""
            if index not in trials:
                trial = trials[index] = way.at(math.exp(rungs[index]))
                size = self._size(trial.draft)
                self._trace.note("code", way.name, step=trial.step, size=size)
            return self._size(trials[index].final) - most

        finest = self._finest(way, rungs, excess)
        if finest is None:
            return []
        return [
            trials[index]
            for index in range(finest, min(finest + self._drawn, len(rungs)))
            if excess(index) <= 0.0
        ]

    def _finest(self, way: Way, rungs: Matrix, excess: Callable[[int], float]) -> int | None:
        """Return the index of the finest rung that fits; None: none does."""
        low, high = -1, len(rungs)  # too fine; coarse enough
        index = begin = int(abs(rungs - math.log(way.first)).argmin())
        # Sizes depend on luck, so a slope may lead nowhere: until a rung fits and another does not, strides double.
        # Between such rungs bytes fall about evenly; every other time the middle is taken, where they do not.
        stride, halves = 1, False
        while high - low > 1:
            over = excess(index)
            if over > 0.0:
                low = index
            else:
                high = index
            if low >= 0 and high < len(rungs):
                share = 0.5
                if not halves:
                    share = excess(low) / (excess(low) - excess(high))
                target = low + round(share * (high - low))
                halves = not halves
            else:
                rungs_away = abs(over) / (self._saving * RUNG)
                jump = max(math.floor(rungs_away), stride)
                if over <= 0.0:
                    jump = -jump
                target = index + jump
                stride *= 2
            index = min(max(target, low + 1), high - 1)
        if high < len(rungs):
            return high
        # Wide steps move vertices so far that images no longer help: sizes fall, and rise again.
        sparse = range(begin, len(rungs), SPARSE)
        return next((index for index in sparse if excess(index) <= 0.0), None)


def _every(ladder: Matrix) -> Matrix:
    """Return the rungs of a ladder that are an eighth of an octave apart; its only one, if it has no more."""
    if len(ladder) == 1:
        return ladder
    first = math.ceil(ladder[0] / RUNG)
    last = math.floor(ladder[-1] / RUNG)
    if last < first:
        return ladder[-1:]
    return RUNG * np.arange(first, last + 1)
