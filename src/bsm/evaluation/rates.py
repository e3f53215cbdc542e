"""Comparing rate-distortion curves: at equal quality, and on average over a range (Bjontegaard)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PchipInterpolator

Floats = npt.NDArray[np.float64]
MEASURES = ("nmsve_db", "theta_deg")


@dataclass(frozen=True, eq=False)
class RateCurve:
    """Logarithm of the rate as a function of a distortion, between the measured points."""

    distortions: Floats
    log_rates: Floats

    @property
    def span(self) -> tuple[float, float]:
        """Least and largest distortion measured."""
        return float(self.distortions[0]), float(self.distortions[-1])

    def log_rate(self, distortion: float) -> float | None:
        """Interpolated (piecewise cubic, monotone); None outside the measured range or with a single point."""
        low, high = self.span
        if not low <= distortion <= high or len(self.distortions) < 2:
            return None
        return float(PchipInterpolator(self.distortions, self.log_rates)(distortion))

    def rate(self, distortion: float) -> float | None:
        """Bits per vertex, interpolated as `log_rate`."""
        log_rate = self.log_rate(distortion)
        return None if log_rate is None else float(np.exp(log_rate))


def rate_curve(rates: Sequence[float], distortions: Sequence[float]) -> RateCurve:
    """Curve through the points that no other point beats in both rate and distortion."""
    order = np.lexsort((rates, distortions))
    kept: list[int] = []
    # From the largest distortion down, a point is of use only if it costs more than all before it.
    least = np.inf
    for index in order:
        if rates[index] < least:
            kept.append(index)
            least = rates[index]
    x = np.array([distortions[i] for i in kept], dtype=np.float64)
    y = np.log(np.array([rates[i] for i in kept], dtype=np.float64))
    distinct = np.concatenate([[True], np.diff(x) > 0]) if len(x) else np.zeros(0, bool)
    return RateCurve(x[distinct], y[distinct])


def rate_curve_of(points: Sequence[dict[str, Any]], measure: str, rate: str = "bpv_total") -> RateCurve:
    """Curve of a result's points: a rate against one of `MEASURES`; lossless points are left out."""
    usable = [point for point in points if point[measure] is not None and scaled(point[measure], measure) is not None]
    return rate_curve([p[rate] for p in usable], [scaled(p[measure], measure) or 0.0 for p in usable])


def scaled(value: float, measure: str) -> float | None:
    """A distortion on the scale that curves are interpolated over: theta becomes 10 log10(theta)."""
    if measure != "theta_deg":
        return value
    return 10.0 * float(np.log10(value)) if value > 0.0 else None


def bd_rate(reference: RateCurve, tested: RateCurve) -> float | None:
    """Bjontegaard's average difference of rate at equal distortion, over the range that both curves cover."""
    if min(len(reference.distortions), len(tested.distortions)) < 2:
        return None
    low = max(reference.span[0], tested.span[0])
    high = min(reference.span[1], tested.span[1])
    if not low < high:
        return None
    areas = [
        PchipInterpolator(curve.distortions, curve.log_rates).integrate(low, high) for curve in (reference, tested)
    ]
    return float(100.0 * np.expm1((areas[1] - areas[0]) / (high - low)))


def rate_ratio(reference: RateCurve, tested: RateCurve, distortion: float) -> float | None:
    """Bits of `tested` over bits of `reference` at one distortion, None where one of them does not reach it."""
    rates = reference.log_rate(distortion), tested.log_rate(distortion)
    if rates[0] is None or rates[1] is None:
        return None
    return float(np.exp(rates[1] - rates[0]))


def compare_curves(reference: dict[str, Any], tested: dict[str, Any], angles: Sequence[float] = (7.0, 10.0)) -> Any:
    """What a table says about one codec against another on one mesh."""
    curves = {m: (rate_curve_of(reference["points"], m), rate_curve_of(tested["points"], m)) for m in MEASURES}
    return {
        "mesh": tested["mesh"]["name"],
        "codec": tested["codec"],
        "reference": reference["codec"],
        "bd_rate_percent": {measure: bd_rate(*pair) for measure, pair in curves.items()},
        "bytes_at_theta": {
            f"{angle:g}": rate_ratio(*curves["theta_deg"], scaled(angle, "theta_deg") or 0.0) for angle in angles
        },
    }
