"""The largest step that keeps bounds."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

SLACK = 0.03
"""How far below a bound the search for a step may stay."""
ROOM = 0.08
"""How far below a look its pictures may stay, in logarithms; half of it is aimed at."""
GLANCES, CONFIRMATIONS = 2, 5
"""Steps that are looked at from a few sides, and from all."""

Found = TypeVar("Found")


@dataclass(frozen=True)
class Trial(Generic[Found]):
    """What a step came to.

    Parameters
    ----------
    step : float
    excess : float
        Logarithm of what came over what may, of normals or pictures: above 0 they are too far off.
    near : bool
        Whether every vertex is near enough.
    found : object
    """

    step: float
    excess: float
    near: bool
    found: Found

    @property
    def kept(self) -> bool:
        """Whether all bounds are kept."""
        return self.near and self.excess <= 0.0


def widest_step(
    measure: Callable[[float], Trial[Found]],
    first: float,
    *,
    tries: int,
    most: float,
    slopes: tuple[float, float],
    slack: float = SLACK,
) -> Trial[Found] | None:
    """About the largest step whose trial keeps the bounds: a secant in the logarithms, within brackets.

    Parameters
    ----------
    measure : callable
        Tries a step.
    first : float
        To begin with.
    tries : int
    most : float
        The largest step that may be tried.
    slack : float
        The search ends where a trial is below its bound by at most this share of it.
    slopes : (float, float)
        How the excess grows with the step's logarithm, at least and at most; at most as long as nobody knows.
    """
    aim = math.log(1.0 - slack / 2.0)
    best: Trial[Found] | None = None
    good: tuple[float, float] | None = None
    bad: tuple[float, float] | None = None
    step, slope = min(first, most), slopes[1]
    before: tuple[float, float] | None = None
    for _ in range(tries):
        trial = measure(step)
        within = trial.excess <= 0.0
        at = math.log(step), trial.excess
        if before is not None and at[0] != before[0]:
            slope = min(max((at[1] - before[1]) / (at[0] - before[0]), slopes[0]), slopes[1])
        before = at
        if trial.kept:
            if best is None or step > best.step:
                best, good = trial, at
            if trial.excess > math.log(1.0 - slack) or step >= most:
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
    return best


def looked_for(
    measure: Callable[[float, bool], Trial[Found]],
    first: float,
    *,
    most: float,
    slopes: tuple[float, float],
    glances: int = GLANCES,
) -> Trial[Found] | None:
    """About the widest step that keeps a look: from a few sides first, and from all of them in the end.

    Parameters
    ----------
    measure : callable
        Tries a step, and looks at what it comes to; from all sides if its second argument is true.
    first, most, slopes
        As of `widest_step`.
    glances : int
        Steps that are looked at from a few sides.
    """
    trials = list[Trial[Found]]()

    def glance(step: float) -> Trial[Found]:
        trials.append(measure(step, False))
        return trials[-1]

    slope = math.sqrt(slopes[0] * slopes[1])

    def following(trial: Trial[Found]) -> float:
        more = trial.excess + ROOM / 2.0 if trial.near else max(trial.excess, 0.3)
        return min(trial.step * math.exp(min(max(-more / slope, -1.2), 1.2)), most)

    widest_step(glance, first, tries=glances, most=most, slopes=slopes, slack=ROOM)
    near = min(trials, key=lambda trial: abs(trial.excess + ROOM / 2.0), default=None)
    step = min(first, most) if near is None else following(near)
    best: Trial[Found] | None = None
    for number in range(CONFIRMATIONS):
        trial = measure(step, True)
        if trial.kept and (best is None or trial.step > best.step):
            best = trial
        if best is not None and (number or trial.excess > -2.0 * ROOM or step >= most):
            break
        step = following(trial)
    return best
