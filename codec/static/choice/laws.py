"""The price of a trial, and the hope in it: which step of which way is opened next, and when the search ends.

A trial is a way to code a mesh at a step. Of each way, two laws say what to expect at all of its steps, and how far
luck may be from that: the bytes, and the error as a share of its bound. A trial is opened in two stages of one price,
coding and pictures. The stage that is expected to save most is next, as far as chance lets the trial keep its bound;
the search ends when no stage is worth its price. (M. Weitzman, Optimal search for the best alternative, 1979.)
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import LimitError
from bsm.codec.arrays import Matrix
from bsm.codec.static.choice.blocks import Plain, Refined
from bsm.codec.static.choice.bounds import LEAST, Trial
from bsm.codec.static.choice.grids import Gridded
from bsm.codec.static.targets import SLACK, TRIES

DOUBT = 0.15  # of a first guess, in logarithms, and of a slope, over the slope
TRUST = 2  # trials that the usual luck stands for
Way = Gridded | Plain | Refined  # ways to code a mesh at one step after another: pure functions of the step


class Aim(Protocol):
    """What trials come to, in logarithms, and how much finer a step must be where they are refused."""

    def bytes(self, way: Way, made: Trial) -> float: ...
    def error(self, made: Trial) -> float: ...
    def finer(self, made: Trial) -> float: ...


class Law:
    """Logarithms of a value at steps: a line through known trials, of which far ones tell less."""

    def __init__(self, steps: Matrix, first: float, guess: float, slope: float, doubt: float, luck: float) -> None:
        self._steps, self.slope, self._luck = steps, slope, luck**2
        self.mean: Matrix = steps
        self.spread: Matrix = steps
        self.known = [(first, guess, doubt)]  # steps, values, and their doubts
        self._fit(TRUST * luck**2)

    def learn(self, at: int, value: float) -> None:
        """Take in the value of a trial, and, but for the first one, how lucky it was."""
        surprise = 3.0 * ((value - self.mean[at]) / (math.pi * self.spread[at])) ** 2 if len(self.known) > 1 else 1.0
        self.known.append((self._steps[at], value, 0.0))
        self._fit(self._squares + self._luck * surprise)

    def over(self, unit: float) -> None:
        """Take all values over another unit, given as a logarithm."""
        self.known = [(step, value - unit, doubt) for step, value, doubt in self.known]
        self.mean = self.mean - unit

    def _fit(self, squares: float) -> None:
        """The expected value at each step, and the scale of the logistic distribution around it."""
        places, values, doubts = np.array(self.known).T
        self._squares, self._luck = squares, squares / (TRUST + len(places) - 1)
        apart, unsure = self._steps[:, None] - places, (DOUBT * self.slope) ** 2
        own = places[1:] - places[1:].sum() / max(len(places) - 1, 1)
        slope = self.slope + own @ (values[1:] - self.slope * own) / (own @ own + self._luck / (4.0 * unsure))
        trust = 1.0 / (doubts**2 + self._luck + unsure * apart**2)
        total = trust.sum(axis=1)
        self.mean = (trust * (values + slope * apart)).sum(axis=1) / total
        self.spread = np.sqrt(3.0 * (self._luck + 1.0 / total)) / math.pi
        known = np.searchsorted(self._steps, places[1:])
        self.mean[known], self.spread[known] = values[1:], LEAST


@dataclass(eq=False)
class Hopes:
    """A way, and what its trials may come to: bytes, and errors.

    One of both shall be low, the other must not be above 0: errors, or bytes if `fitting`."""

    way: Way
    steps: Matrix
    bytes: Law
    errors: Law
    fitting: bool = False
    coded: dict[int, Trial] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.left = np.full(len(self.steps), 2)  # stages

    @property
    def low(self) -> Law:
        return self.errors if self.fitting else self.bytes

    @property
    def bound(self) -> Law:
        return self.bytes if self.fitting else self.errors

    def fit(self, most: float, error: float) -> None:
        """Change the roles: bytes over the most that there may be, errors over that of 1; both in logarithms."""
        self.fitting = True
        self.bytes.over(most)
        self.errors.over(error)
        self.left[:] = 2  # what was refused may fit
        self.left[np.searchsorted(self.steps, [step for step, *_ in self.errors.known[1:]])] = 0
        self.left[[*self.coded]] = 1
        self.close((self.left == 1) & (self.bytes.mean > 0.0))

    def close(self, steps: npt.NDArray[np.bool_]) -> None:
        """Open none of these steps any more."""
        self.left[steps] = 0
        self.coded = {at: made for at, made in self.coded.items() if self.left[at]}

    def begin(self, made: Trial, size: float) -> None:
        """Take in a trial that is coded, and its bytes."""
        at = int(np.abs(self.steps - math.log(made.step)).argmin())
        self.bytes.learn(at, size)
        self.left[at] = not (self.fitting and self.bytes.mean[at] > 0.0)
        if self.left[at]:
            self.coded[at] = made

    def next(self, least: float, price: float) -> tuple[float, int]:
        """Expected saving of the next stage, less its price, in logarithms; and the number of its step."""
        low, bound, closed = self.low, self.bound, self.left == 0
        safe = int(np.where(closed, math.inf, np.abs(bound.mean + bound.spread)).argmin())
        if least == math.inf:  # until a bound is kept, nothing else counts
            at = min(self.coded, key=lambda at: abs(at - safe), default=safe)
            return -float(low.mean[at]), at
        chance = np.exp(-np.logaddexp(0.0, bound.mean / bound.spread))
        paid = least - price / np.maximum(chance, LEAST)
        gains = chance * low.spread * np.logaddexp(0.0, (paid - low.mean) / low.spread) - price * (self.left > 1)
        gains[closed] = -math.inf
        return float(gains.max()), int(gains.argmax()) if len(self.bytes.known) > 1 else safe


def steps_of(way: Way) -> tuple[float, Matrix]:
    """The logarithms of a way's first step and of those that may be tried, which are the same for all promises."""
    low, high = math.log(way.least), math.log(way.most)
    first = min(max(math.log(way.first), low), high)
    steps = np.union1d(SLACK * np.arange(math.ceil(low / SLACK), math.floor(high / SLACK)), first)
    if isinstance(way, Gridded) and way.spacing:
        steps = np.log(np.unique(way.dividing(np.exp(steps[steps > first - 1.0]))))
        first = float(steps[np.abs(steps - first).argmin()])
    return first, steps


def search(queue: list[Hopes], aim: Aim, price: float, least: float, searches: int) -> Iterator[Trial]:
    """Open trials until none is worth its price; yield each one that is the best so far. So many searches there are."""
    while queue:
        (gain, at), hopes = max(((hopes.next(least, price), hopes) for hopes in queue), key=lambda of: of[0][0])
        if least < math.inf and gain <= 0.0:
            return
        try:
            if hopes.left[at] > 1:
                made = hopes.way.at(math.exp(hopes.steps[at]))
                hopes.begin(made, aim.bytes(hopes.way, made))
            else:
                made, hopes.left[at] = hopes.coded.pop(at), 0
                hopes.errors.learn(at, aim.error(made))
                if hopes.bound.mean[at] <= 0.0 and hopes.low.mean[at] < least:
                    if finer := aim.finer(made):
                        hopes.close(hopes.steps > hopes.steps[at] - finer)
                    else:
                        least = float(hopes.low.mean[at])
                        yield made
            if len(hopes.bytes.known) > 3 * TRIES * searches or not hopes.left.any():
                queue.remove(hopes)
        except LimitError:  # blocks that decoders would refuse
            queue.remove(hopes)
