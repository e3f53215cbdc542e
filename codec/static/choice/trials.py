"""What every way to code a mesh offers: an estimate of its bytes, steps, and a trial of each step."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Matrix, Positions
from bsm.codec.static.preamble_encoding import Draft
from bsm.codec.static.targets import SLACK

# Of a vertex, that a step e times as wide saves where most levels are not 0.
BYTES = 3.0 / math.log(256.0)
DOUBT = 0.15  # standard deviation of the logarithm of a first guess; of a slope, over the slope


@dataclass(frozen=True, eq=False)
class Trial:
    """A way at a step: decoded positions, in BSM units, shape (n, 3), and the stream, which is coded when needed."""

    step: float
    positions: Matrix
    code: Callable[[], Draft]
    settled: bool = False  # whether levels are kept within reach, whatever the step is
    decoded: Positions | None = None  # in the unit of the mesh, where `positions` are rounded
    complete: Callable[[Draft], Draft] = lambda draft: draft  # takes longer, and saves some bytes

    @cached_property
    def draft(self) -> Draft:
        return self.code()

    @cached_property
    def final(self) -> Draft:
        """The stream, completed by steps that are not worth their time in every trial."""
        return self.complete(self.draft)


@dataclass(frozen=True)
class Estimate:
    """About the bytes of a way at its first step, and the standard deviation of their logarithm."""

    size: float
    doubt: float
    saving: float  # bytes that a step e times as wide saves
    trial: Trial | None = None  # that of the first step, where it is coded
    # Steps whose trials are coded with the first one, until bytes rise.
    also: tuple[float, ...] = ()
    slope_doubt: float = DOUBT  # standard deviation of that saving, over itself
    # Ways with the same word err together: the first trial of one corrects the estimates of the others.
    kin: str = ""


class Way(Protocol):
    """A way to code a mesh at one step after another. It remembers nothing of its trials.

    `first` is the step with which a search begins, `ladder` the logarithms of all steps that it may try, which do not
    depend on the promised look. Steps between them, from `least` to `most`, are for targets without a look.
    """

    name: str
    least: float
    most: float

    @property
    def first(self) -> float: ...
    @property
    def ladder(self) -> Matrix: ...
    def estimate(self, rival: float) -> Estimate:
        """Return about the bytes of a trial at the first step. It may be rough if it is far above those of a rival."""

    def at(self, step: float) -> Trial: ...
    def mended(self, trial: Trial) -> Trial | None:
        """Return another trial of the step of a trial, with fewer folds; None: all trials have few."""


def ladder_of(least: float, most: float) -> Matrix:
    """Return the logarithms of steps between two bounds, which are at the same places for all meshes and promises."""
    low = math.log(least)
    high = math.log(most)
    first = math.ceil(low / SLACK)
    last = math.floor(high / SLACK)
    if last < first:
        return np.array([high])
    return np.asarray(SLACK * np.arange(first, last + 1), np.float64)


def on_ladder(step: float) -> float:
    """Return the step of the ladder that is nearest to a step."""
    return math.exp(SLACK * round(math.log(step) / SLACK))
