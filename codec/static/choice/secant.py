"""Looking for a step: the widest at which a way to code a mesh keeps bounds."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

from bsm.bitstream.errors import LimitError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Matrix
from bsm.codec.static.choice.bounds import Bounds
from bsm.codec.static.draft import Draft

SEEN, UNSEEN = (0.05, 6), (0.015, 10)
"""How far below a bound the search for a step may stay, and how many steps are tried: where pictures are looked at, and
elsewhere."""
SLOPES = (0.5, 2.0)
"""How errors grow with steps, in their logarithms."""
BEYOND = (1.04, 1.08, 1.13)
"""Steps that are tried besides, over the widest that keeps bounds, where errors do not grow steadily with steps."""
DEARER = 1.08
"""A way is left alone whose first step takes so many times the bytes of what was found."""
STRIDE, NEAREST = 2.0, 0.1
"""Between two tries, in the logarithm; and where both sides of a bound are known, the part of what is between them that
a try stays away from both."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """What a step comes to: positions as decoded, in BSM units, shape (n, 3), and the stream."""

    step: float
    positions: Matrix
    make: Callable[[], Draft]

    @cached_property
    def draft(self) -> Draft:
        """The stream, written when it is asked for."""
        return self.make()


class Way(Protocol):
    """A way to code a mesh, at one step after another: a pure function of the step."""

    first: float
    least: float
    most: float
    erratic: bool

    def at(self, step: float) -> Candidate:
        """What a step comes to."""


def secant(
    excess: Callable[[float], float | None], first: float, least: float, most: float, effort: tuple[float, int] = UNSEEN
) -> None:
    """Try numbers, to come to about the largest one whose excess is at most 0; None says that no other is wanted."""
    slack, tries = effort
    low, high = math.log(least), math.log(most)
    at, slope, before = min(max(math.log(first), low), high), 1.0, (math.nan, math.nan)
    tried: list[tuple[float, float]] = []
    for _ in range(tries):
        value = excess(math.exp(at))
        if value is None:
            return
        if before[0] != at:
            found = (value - before[1]) / (at - before[0])
            slope = min(max(found, SLOPES[0]), SLOPES[1]) if math.isfinite(found) else slope
        before = at, value
        tried.append(before)
        good = max((one for one in tried if one[1] <= 0.0), default=None)
        bad = min((one for one in tried if one[1] > 0.0 and (good is None or one[0] > good[0])), default=None)
        values = [over for _, over in tried]
        if good is None and len(tried) > 3 and min(values[-2:]) > min(values[:-2]) - slack:
            return  # what breaks a bound is not the step
        if (-slack < value <= 0.0) or (bad is None and at >= high) or (good is None and at <= low):
            return
        if good is None or bad is None:
            at += min(max((-slack / 2.0 - value) / slope, -STRIDE), STRIDE)
        elif bad[0] - good[0] < slack / 2.0:
            return
        else:
            share = (-slack / 2.0 - good[1]) / (bad[1] - good[1])
            at = good[0] + min(max(share, NEAREST), 1.0 - NEAREST) * (bad[0] - good[0])
        at = min(max(at, low), high)


def widest(way: Way, bounds: Bounds, most_bytes: float = math.inf) -> Candidate | None:
    """The smallest candidate that is found to keep bounds, unless it would not be smaller than so many bytes."""
    kept, excess = list[Candidate](), bounds.excess()
    effort = UNSEEN if bounds.contract.look == math.inf else SEEN
    first = way.at(min(max(way.first, way.least), way.most)) if most_bytes < math.inf else None
    if first is not None and first.draft.size > DEARER * most_bytes:
        return None

    def at(step: float) -> float | None:
        candidate = first if first is not None and math.isclose(step, first.step) else way.at(step)
        over = excess(candidate.positions)
        if over <= 0.0:
            kept.append(candidate)
        # A step twice as wide saves three bits of a vertex at most; what is finer is larger.
        wider = max(-over, 0.0) / SLOPES[0] / math.log(2.0)
        if most_bytes < math.inf and candidate.draft.size - wider * 3.0 / 8.0 * len(candidate.positions) >= most_bytes:
            return None
        return over

    with suppress(LimitError):  # blocks that decoders would refuse
        secant(at, way.first, way.least, way.most, effort)
        if kept and way.erratic:
            widest_kept = max(one.step for one in kept)
            for factor in BEYOND:
                at(widest_kept * factor)
    kept.sort(key=lambda candidate: candidate.draft.size)
    return next((one for one in kept if bounds.keeps(one.positions)), None)
