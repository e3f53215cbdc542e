"""Reaching a quality or a size: a search over the quantization step, on what the decoder will see."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, TypeVar

from bsm.bitstream.errors import OptionError, TargetError
from bsm.bitstream.public import public

SIZES = ("bpv", "bpvf", "size")
UNITS = {
    "nmsve_db": "a visual error of {:.6g} dB",
    "theta_deg": "a mean angle of {:.6g} degrees",
    "bpv": "{:.6g} bits per vertex",
    "size": "{:.0f} bytes",
    "kg": "a KG error of {:.6g} %",
    "bpvf": "{:.6g} bits per vertex and frame",
}
"""What is said of a value, of a mesh's targets and of a sequence's."""
TOLERANCE = 0.02
TOLERANCE_DB = 0.1
COARSEST_STEP = 0.1
_TRIES = 24


class Outcome(Protocol):
    """What an attempt to encode came to; sizes that may be targets are attributes of it, errors of its comparison."""

    @property
    def comparison(self) -> Any:
        """What is decoded against the original."""


@public
@dataclass(frozen=True)
class Target:
    """What to reach.

    Parameters
    ----------
    kind : str
        "nmsve_db", "theta_deg" (at most so much error), "bpv" or "size" (at most so many bits per vertex, or bytes, of
        the whole file).
    value : float

    Raises
    ------
    OptionError
        If there is no such target.

    Examples
    --------
    >>> import bsm
    >>> options = bsm.EncodeOptions(target=bsm.Target("theta_deg", 5.0))
    >>> bsm.compare("bunny.ply", bsm.encode("bunny.ply", options)).theta_deg <= 5
    True
    """

    KINDS: ClassVar[tuple[str, ...]] = ("nmsve_db", "theta_deg", "bpv", "size")

    kind: str
    value: float

    def __post_init__(self) -> None:
        if self.kind not in self.KINDS:
            raise OptionError(f"a target must be one of {', '.join(self.KINDS)}, not {self.kind!r}")
        if not math.isfinite(self.value) or (self.kind != "nmsve_db" and self.value <= 0):
            raise OptionError(f"{self.kind} cannot be {self.value:g}")

    def reached(self, outcome: Outcome) -> float:
        """The outcome's value of what the target is about."""
        return float(getattr(outcome if self.kind in SIZES else outcome.comparison, self.kind))

    def excess(self, outcome: Outcome) -> float:
        """How far over the target an outcome is, in units of the tolerance; in -1 .. 0 it is met."""
        value = self.reached(outcome)
        if self.kind == "nmsve_db":
            return (value - self.value) / TOLERANCE_DB
        return math.log(max(value, 1e-300) / self.value) / TOLERANCE

    def bytes_of(self, vertices: int) -> float:
        """The size that is asked for, of a mesh of so many vertices."""
        return self.value if self.kind == "size" else self.value * vertices / 8.0

    def worded(self, value: float) -> str:
        """A value of what the target is about, in words."""
        return UNITS[self.kind].format(value)

    @property
    def shrinks_with_step(self) -> bool:
        """Whether a coarser step lowers the value (a size) instead of raising it (an error)."""
        return self.kind in SIZES


Found = TypeVar("Found", bound=Outcome)


def search_step(attempt: Callable[[float], Found], target: Target, first: float, finest: float) -> Found:
    """Find a step whose outcome meets the target."""
    low, high = math.log(finest), math.log(COARSEST_STEP)
    sign = -1.0 if target.shrinks_with_step else 1.0
    under: tuple[float, float] | None = None  # step and signed excess on the fine side
    over: tuple[float, float] | None = None
    right: tuple[float, Found] | None = None
    best: float | None = None
    at = min(max(math.log(first), low), high)
    for _ in range(_TRIES):
        outcome = attempt(max(math.exp(at), finest))
        excess = target.excess(outcome)
        value = target.reached(outcome)
        best = value if best is None else min(best, value)
        if excess <= 0 and (right is None or excess > right[0]):
            right = excess, outcome
        if -1.0 <= excess <= 0.0:
            break
        # On the fine side of the answer the signed excess is negative.
        if sign * excess < 0:
            under = at, sign * excess
        else:
            over = at, sign * excess
        following = _next_try(under, over, low, high)
        if abs(following - at) < 1e-4:
            break
        at = following
    if right is None:
        assert best is not None
        error = TargetError(
            f"{target.worded(target.value)} at most cannot be reached; the best that can be had is "
            f"{target.worded(best)}"
        )
        error.best = best
        raise error
    return right[1]


def _next_try(under: tuple[float, float] | None, over: tuple[float, float] | None, low: float, high: float) -> float:
    """A step (its logarithm) between the two sides, or beyond the only one."""
    if under is None or over is None:
        if over is not None:
            return max(low, over[0] - max(0.3, min(1.5, 0.02 * over[1])))
        assert under is not None
        return min(high, under[0] + max(0.3, min(1.5, -0.02 * under[1])))
    share = -under[1] / (over[1] - under[1])
    return under[0] + min(max(share, 0.08), 0.92) * (over[0] - under[0])
