"""Reaching a quality or a size: a search over the quantization step, on decoded results."""

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from operator import itemgetter
from typing import Any, Protocol, TypeVar

from bsm.bitstream.errors import OptionError, TargetError, public
from bsm.codec.geometry.metrics import decibel

ANY_ANGLE = 180.0
WIDEST = 0.1  # bound or step, of the diagonal: who asks for a wider one took one unit for another


@public
@dataclass(frozen=True)
class Contract:
    """Bounds on a decoded mesh.

    Parameters
    ----------
    farthest : float
        Largest distance of any vertex from its original. The Hausdorff distance of the surfaces is at most as large.
    angle : float
        Mean angle between corresponding normals, degrees, faces counted by their area; 180: any.
    absolute : bool
        `farthest` is in the mesh's unit, and not relative to the diagonal of its bounding box.
    look : float
        Look distance (`codec.look`): at 1 the mesh looks the same; infinite: any.
    alike : bool
        In `angle` all faces have the same weight.
    visual : float
        Normalized mean visual error (`codec.geometry.metrics.Reference.nmsve`); infinite: any.
    by_part : float
        The same as `farthest`, but relative to the diagonal of each connected part, down to a tenth of the whole's.
        Parts near each other keep their order in depth. Infinite: no such bound.

    Raises
    ------
    OptionError
        If a bound is not positive.

    Examples
    --------
    >>> import bsm
    >>> promise = bsm.Contract(0.005, look=2.0)  # 0.5 % of the diagonal, look distance 2
    >>> data = bsm.encode("bunny.ply", bsm.EncodeOptions(contract=promise))
    """

    farthest: float
    angle: float = ANY_ANGLE
    absolute: bool = False
    look: float = math.inf
    by_part: float = math.inf
    alike: bool = False
    visual: float = math.inf

    def __post_init__(self) -> None:
        if not 0.0 < self.farthest < float("inf"):
            raise OptionError(f"a bound on vertex errors must be above 0, not {self.farthest:g}")
        if not self.absolute and self.farthest > WIDEST:
            raise OptionError(
                f"a bound on vertex errors must be at most {WIDEST:.0%} of the bounding-box diagonal, not "
                f"{self.farthest:.4g} times it; a number without a unit is a share of the diagonal: 0.001 is 0.1%"
            )
        if not 0.0 < self.angle <= ANY_ANGLE:
            raise OptionError(
                f"a mean angle must be within 0 to {ANY_ANGLE:g} degrees, not {self.angle:g}"
            )
        if not self.visual > 0.0:
            raise OptionError(f"a visual error must be above 0, not {self.visual:g}")
        if not self.by_part > 0.0:
            raise OptionError(
                f"a bound on the vertices of a part must be above 0, not {self.by_part:g}"
            )
        if not self.look > 0.0:
            raise OptionError(
                f"a look must be above 0, not {self.look:g}: 1 looks the same, 3 is a preview"
            )

    def reach(self, diagonal: float, unit: float) -> float:
        """Return the largest error of a vertex of a mesh of this diagonal, in multiples of `unit`."""
        if self.absolute:
            return self.farthest / unit
        return self.farthest * diagonal / unit

    def doubt(self, diagonal: float, unit: str) -> str:
        """Return a question about the unit if the bound is about as large as a mesh of this diagonal; empty if not.

        Raises
        ------
        OptionError
            If no other bound would keep the mesh recognizable.
        """
        if not self.absolute or self.farthest <= WIDEST * diagonal or not diagonal > 0.0:
            return ""
        noun, question = "", "is that its unit?"
        if unit:
            noun = f" {unit}"
            question = f"is its unit {unit}?"
        share = f"{self.farthest / diagonal:.0%} of this mesh's size ({diagonal:.3g}{noun})"
        text = f"{self.farthest:.3g}{noun} is {share}: {question}"
        if math.isinf(self.by_part):
            raise OptionError(text)
        return text

    def worded(self, farther: float, angle: float, look: float, visual: float) -> str:
        """Describe the bounds that are broken: how many times too far a vertex is, degrees, look distance, error."""
        broken = []
        if farther > 1.0:
            broken.append(vertex_error(self.farthest * farther, self.absolute))
        if angle > self.angle:
            broken.append(f"normal error {angle:.4g} degrees")
        if self.look < look < math.inf:  # infinite: not measured
            broken.append(f"look {look:.3g}")
        if visual > self.visual:
            broken.append(f"visual error {decibel(visual):.6g} dB")
        return ", ".join(broken)

    def __str__(self) -> str:
        bounds = [vertex_error(self.farthest, self.absolute)]
        if self.angle < ANY_ANGLE:
            bounds.append(f"normal error {self.angle:g} degrees")
        if self.visual < math.inf:
            bounds.append(f"visual error {decibel(self.visual):.6g} dB")
        if self.look < math.inf:
            bounds.append(f"look {self.look:g}")
        return ", ".join(bounds)


def vertex_error(value: float, absolute: bool) -> str:
    """A bound on vertices in words: a length, or a fraction of the diagonal."""
    if absolute:
        return f"vertex error {value:.4g}"
    return f"vertex error {100.0 * value:.4g} % of the diagonal"


TARGETS = ("nmsve_db", "theta_deg", "bpv", "size")
SEQUENCE_TARGETS = ("kg", "theta_deg", "nmsve_db", "bpvf")
SIZES = ("bpv", "bpvf", "size")
UNITS = {
    "nmsve_db": "visual error {:.6g} dB",
    "theta_deg": "mean angle {:.6g} degrees",
    "bpv": "{:.6g} bits per vertex",
    "size": "{:.0f} bytes",
    "kg": "KG error {:.6g} %",
    "bpvf": "{:.6g} bits per vertex and frame",
}
"""Describe a value of a target of a mesh or a sequence."""
SLACK, TRIES = 0.03, 7
"""How far below a bound, in logarithms, the search for a step may stay, and how many steps it tries."""


class Attempted(Protocol):
    """What an attempt to encode came to; sizes that may be targets are attributes of it, errors of its comparison."""

    @property
    def comparison(self) -> Any:
        """The decoded result against the original."""


@public
@dataclass(frozen=True)
class Target:
    """A quality or size of a mesh or a sequence to reach.

    Parameters
    ----------
    kind : str
        "nmsve_db", "theta_deg" (at most this error), of a mesh "bpv" or "size" (at most this many bits per vertex, or
        bytes, of the whole file), of a sequence "kg" (percent) or "bpvf" (at most this many bits per vertex and frame
        of the whole file).
    value : float

    Raises
    ------
    OptionError
        If the target is unknown.

    Examples
    --------
    >>> import bsm
    >>> options = bsm.EncodeOptions(target=bsm.Target("theta_deg", 5.0))
    >>> bsm.compare("bunny.ply", bsm.encode("bunny.ply", options)).theta_deg <= 5
    True
    """

    kind: str
    value: float

    def __post_init__(self) -> None:
        self._require_kind(tuple(UNITS), "a mesh or sequence")
        low, high = 1e-30, 1e30
        if self.kind == "nmsve_db":
            low, high = -300.0, 300.0
        if not low <= self.value <= high:
            raise OptionError(
                f"{self.worded(self.value)} cannot be a target: those from {low:g} to {high:g} can"
            )

    def _require_kind(self, kinds: tuple[str, ...], what: str) -> None:
        if self.kind not in kinds:
            raise OptionError(
                f"a target of {what} must be one of {', '.join(kinds)}, not {self.kind!r}"
            )

    def reached(self, outcome: Attempted) -> float:
        """Return the outcome's value of the target's measure."""
        if self.kind in SIZES:
            return float(getattr(outcome, self.kind))
        return float(getattr(outcome.comparison, self.kind))

    def excess(self, outcome: Attempted) -> float:
        """Return the logarithm of the outcome's value over the target's; up to 0 the target is met."""
        value = self.reached(outcome)
        if self.kind == "nmsve_db":
            return (value - self.value) * math.log(10.0) / 10.0
        return math.log(max(value, sys.float_info.min) / self.value)

    def worded(self, value: float) -> str:
        """Return a value of the target's measure, in words."""
        return UNITS[self.kind].format(value)

    @property
    def shrinks_with_step(self) -> bool:
        """Whether a coarser step lowers the value (a size) instead of raising it (an error)."""
        return self.kind in SIZES


def secant(
    excess: Callable[[float], float],
    first: float,
    least: float,
    most: float,
    tries: int = TRIES,
    rise: float = 1.0,
    slack: float = SLACK,
) -> None:
    """Try numbers, to come to about the largest one whose excess is at most 0."""
    low = math.log(least)
    high = math.log(most)
    sides = dict[bool, tuple[float, float]]()
    at = min(max(math.log(first), low), high)
    before = math.nan
    for _ in range(tries):
        if at == before:
            return
        before = at
        value = excess(math.exp(at)) + slack / 2.0
        sides[value > slack / 2.0] = at, value
        if abs(value) < slack / 2.0:
            return
        if len(sides) > 1:  # from the bad side to the good one
            bad, over = sides[True]
            good, under = sides[False]
            share = under / (under - over)
            at = good + (bad - good) * min(max(share, 0.1), 0.9)
        else:
            at = min(max(at - value / rise, low), high)
            rise /= 2.0


Found = TypeVar("Found", bound=Attempted)


def search_step(
    attempt: Callable[[float], Found],
    target: Target,
    first: float,
    finest: float,
    rise: float = 1.0,
) -> Found:
    """Find a step whose outcome meets the target."""
    outcomes: list[tuple[float, Found]] = []

    def tried(step: float) -> float:
        outcome = attempt(max(step, finest))
        excess = target.excess(outcome)
        outcomes.append((excess, outcome))
        return excess

    power = -1.0 if target.shrinks_with_step else 1.0
    least, most = sorted((finest**power, WIDEST**power))
    secant(lambda tested: tried(tested**power), first**power, least, most, 2 * TRIES, rise)
    met = [outcome for outcome in outcomes if outcome[0] <= 0.0]
    if met:
        _, closest = max(met, key=itemgetter(0))
        return closest
    best = min(target.reached(outcome) for _, outcome in outcomes)
    error = TargetError(
        f"{target.worded(target.value)} at most cannot be reached; the best possible is {target.worded(best)}"
    )
    error.best = best
    raise error
