"""Which step to try next: how much wider others are, times how likely they keep a bound, from those tried before."""

import math

import numpy as np

UNIT = math.log(2.0) / 64.0  # between logarithms of steps, the same for all promises, so that the same are tried
CHANCE = 0.05  # deviation of the logarithm of a share of a bound from its trend, which is about that of the step


def hoped(
    seen: list[tuple[float, float]], first: float, low: float, high: float, beyond: float = -math.inf
) -> tuple[float, float]:
    """By how much a step from `low` to `high` can be hoped to be wider than known ones, and which: logarithms, as in
    `seen`, with those of shares of a bound; `first`: a guess; `beyond`: another known step."""
    steps, excesses = np.array(seen or [(first, 0.0)]).T
    far, near = np.abs(excesses), 10.0 * CHANCE  # a try so much farther from the bound than another counts half
    whole = (weights := 1.0 / (1.0 + ((far - far.min()) / near) ** 2)).sum()
    middle, mean = weights @ steps / whole, weights @ excesses / whole
    away, rest = steps - middle, excesses - mean - (steps - middle)
    noise, spread = (2.0 * CHANCE**2 + weights @ rest**2) / (1.0 + whole), weights @ away**2 + near**2
    slope = max(1.0 + float(weights @ (away * rest)) / spread, 0.5)
    kept = [step for step, excess in seen if excess <= 0.0]
    sure = max(kept, default=middle - (mean + 2.0 * math.sqrt(noise)) / slope)
    others = np.append(UNIT * np.arange(math.ceil(low / UNIT), math.floor(high / UNIT) + 1), high)
    away = others - middle
    deviation = np.sqrt(noise * (1.0 + 1.0 / whole + away**2 / spread) + (not seen) * near**2)
    over = np.clip((mean + slope * away) / deviation, -7.0, 7.0)
    odds = 1.0 / (1.0 + np.exp(1.6 * over + 0.07 * over**3))  # about those of a normal distribution
    odds[np.abs(others[:, None] - steps).min(axis=1) < UNIT / 2.0] = 0.0
    hopes = odds * (others - max(sure, beyond))
    best = int((hopes if kept or hopes.max() > 0.0 else odds).argmax())
    return float(hopes[best]), float(others[best])
