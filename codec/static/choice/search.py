"""The largest step that keeps bounds."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

SLACK = 0.03
"""How far below a bound the search for a step may stay."""
THOROUGH = 9, 0.015
"""Steps that are tried, and how far below, where the search is to be thorough."""
LOOK_SLACK, LOOK_TRIES = 0.05, 6
"""The same of a look, and how many steps are looked at."""

Found = TypeVar("Found")


@dataclass(frozen=True)
class Trial(Generic[Found]):
    """What a step came to."""

    step: float
    excess: float
    near: bool
    found: Found
    sure: bool = True

    @property
    def within(self) -> bool:
        """Whether all bounds are kept, as far as is known."""
        return self.near and self.excess <= 0.0

    @property
    def kept(self) -> bool:
        """Whether all bounds are kept."""
        return self.sure and self.within


def widest_step(
    measure: Callable[[float, bool], Trial[Found]],
    first: float,
    *,
    tries: int,
    most: float,
    slopes: tuple[float, float],
    slack: float = SLACK,
) -> Trial[Found] | None:
    """About the largest step whose trial keeps the bounds: a secant in the logarithms, within brackets."""
    aim = math.log(1.0 - slack / 2.0)
    best: Trial[Found] | None = None
    widest: Trial[Found] | None = None
    good: tuple[float, float] | None = None
    bad: tuple[float, float] | None = None
    step, slope = min(first, most), slopes[1]
    before: tuple[float, float] | None = None
    for _ in range(tries):
        trial = measure(step, False)
        within = trial.excess <= 0.0
        at = math.log(step), trial.excess
        if before is not None and at[0] != before[0]:
            slope = min(max((at[1] - before[1]) / (at[0] - before[0]), slopes[0]), slopes[1])
        before = at
        if trial.within:
            if widest is None or step > widest.step:
                widest, good = trial, at
            if trial.kept and (best is None or step > best.step):
                best = trial
            if (trial.sure and trial.excess > math.log(1.0 - slack)) or step >= most:
                break
        elif bad is None or at[0] < bad[0]:
            bad = at[0], math.log(1.05) if within else at[1]
        if good is not None and bad is not None:
            if bad[0] - good[0] < slack:
                break
            share = (aim - good[1]) / max(bad[1] - good[1], 1e-9)
            step = math.exp(good[0] + min(max(share, 0.15), 0.85) * (bad[0] - good[0]))
        elif within and not trial.near:
            step *= 0.8
        else:
            # Too fine a step can be coarser next time; too coarse ones come to nothing.
            gentle = slope if within else math.sqrt(slopes[0] * slope)
            step *= math.exp(min(max((aim - at[1]) / gentle, -1.2), 1.2))
        step = min(step, most)
    if widest is not None and not widest.sure:
        trial = measure(widest.step, True)
        if trial.kept:
            return trial
    return best
