"""What to expect of trials that were not made: bytes and errors of a way, at each of its steps.

Of each way, two laws say what to expect, and how far luck may be from that: the bytes, and the error as a share of its
bound. A trial has two stages of one price, coding and pictures. The stage that is expected to save most is next, as far
as chance lets the trial keep its bound. (M. Weitzman, Optimal search for the best alternative, 1979.)
"""

import math

import numpy as np

from bsm.codec.arrays import Matrix
from bsm.codec.static.choice.bounds import LEAST
from bsm.codec.static.choice.trials import DOUBT, Estimate, Trial, Way
from bsm.codec.static.targets import SLACK, TRIES

TRUST = 2  # trials that the usual luck stands for
MOST_CODED = 3 * TRIES  # trials of a way
# Of the bytes, as a logarithm: by so much, ways whose errors are unknown may do better.
UNTRIED = 2.0 * SLACK
LOGISTIC = math.sqrt(3.0) / math.pi  # scale of a logistic distribution, over its standard deviation


class Law:
    """Logarithms of a value at steps: a line through known values, of which far ones tell less.

    `mean` and `spread` are the expected value at each step, and the scale of the logistic distribution around it.
    """

    def __init__(
        self,
        steps: Matrix,
        first: float,
        guess: float,
        doubt: float,
        slope: float,
        luck: float,
        slope_doubt: float,
    ) -> None:
        self._steps = steps
        self._slope = slope
        self._luck = luck**2
        self._trust_in_slope = 1.0 / (2.0 * slope_doubt * slope) ** 2
        self.places = [first]
        self.values = [guess]
        self._doubt = doubt
        self._squares = TRUST * self._luck
        self._fit()

    @property
    def count(self) -> int:
        """How many values are known."""
        return len(self.places) - 1

    def learn(self, index: int, value: float) -> None:
        """Take in the value of a trial, and, from the second one on, how lucky it was."""
        surprise = 1.0
        if self.count:
            deviation = value - self.mean[index]
            surprise = 3.0 * (deviation / (math.pi * self.spread[index])) ** 2
        self._squares += self._luck * surprise
        self.places.append(float(self._steps[index]))
        self.values.append(value)
        self._luck = self._squares / (TRUST + self.count)
        self._fit()

    def shift(self, by: float, doubt: float) -> None:
        """Correct the first guess."""
        self.values[0] += by
        self._doubt = doubt
        self._fit()

    def _fit(self) -> None:
        places = np.array(self.places)
        values = np.array(self.values)
        doubts = np.zeros(len(places))
        doubts[0] = self._doubt
        distances = self._steps[:, None] - places
        slope_doubt = (DOUBT * self._slope) ** 2
        slope = self._slope
        if self.count:
            centered = places[1:] - places[1:].mean()
            trust_in_slope = self._luck * self._trust_in_slope
            deviations = values[1:] - slope * centered
            slope += centered @ deviations / (centered @ centered + trust_in_slope)
        variances = doubts**2 + self._luck + slope_doubt * distances**2
        weights = 1.0 / variances
        total = weights.sum(axis=1)
        expected = values + slope * distances
        self.mean: Matrix = (weights * expected).sum(axis=1) / total
        self.spread: Matrix = LOGISTIC * np.sqrt(self._luck + 1.0 / total)
        rows = np.searchsorted(self._steps, places[1:])
        self.mean[rows] = values[1:]
        self.spread[rows] = LEAST


UNCODED, CODED, DONE = 2, 1, 0  # stages that are left


class Prospect:
    """A way, and what its trials may come to; `luck`: standard deviation of errors around their law."""

    def __init__(self, way: Way, estimate: Estimate, rise: float, luck: float) -> None:
        self.way = way
        self.estimate = estimate
        self.steps = way.ladder
        self.first = self.index_of(way.first)
        place = float(self.steps[self.first])
        guess = math.log(estimate.size), estimate.doubt
        slope = -estimate.saving / estimate.size
        self.sizes = Law(self.steps, place, *guess, slope, SLACK, estimate.slope_doubt)
        self.errors = Law(self.steps, place, 0.0, DOUBT, rise, luck, DOUBT)
        self.states = np.full(len(self.steps), UNCODED)
        self.coded: dict[int, Trial] = {}

    @property
    def is_open(self) -> bool:
        return bool(self.states.any())

    def index_of(self, step: float) -> int:
        """Return the index of the nearest step that may be tried."""
        distances = np.abs(self.steps - math.log(step))
        return int(distances.argmin())

    def close(self, steps: Matrix) -> None:
        """Open none of these steps any more."""
        self.states[steps] = DONE
        self.coded = {index: trial for index, trial in self.coded.items() if self.states[index]}

    def add(self, index: int, trial: Trial, size: float) -> None:
        """Take in a coded trial, and the logarithm of its bytes."""
        self.sizes.learn(index, size)
        self.states[index] = CODED
        self.coded[index] = trial
        if self.sizes.count > MOST_CODED:
            self.states[self.states == UNCODED] = DONE

    def judge(self, index: int, error: float) -> Trial:
        """Take in the logarithm of the error of a coded trial, and return the trial."""
        self.states[index] = DONE
        self.errors.learn(index, error)
        return self.coded.pop(index)

    def next_stage(self, least: float, price: float) -> tuple[float, int]:
        """Return the expected saving of the best stage, less its price, and the index of its step."""
        errors = self.errors
        closed = self.states == DONE
        distance = np.abs(errors.mean + errors.spread)
        distance[closed] = math.inf
        safest = int(distance.argmin())
        if least == math.inf:  # until a bound is kept, nothing else counts
            index = min(self.coded, key=lambda index: abs(index - safest), default=safest)
            gain = -float(self.sizes.mean[index])
            if not errors.count:
                gain += UNTRIED
            return gain, index
        excess = errors.mean / errors.spread
        chance = np.exp(-np.logaddexp(0.0, excess))
        paid = least - price / np.maximum(chance, LEAST)
        sizes = self.sizes
        saved = (paid - sizes.mean) / sizes.spread
        savings = sizes.spread * np.logaddexp(0.0, saved)
        gains = chance * savings - price * (self.states == UNCODED)
        gains[closed] = -math.inf
        best = int(gains.argmax())
        if not self.sizes.count:
            return float(gains[best]), safest
        return float(gains[best]), best
