"""Noise along one direction, as a depth camera leaves it: as strong as the direction of the surface says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.denoise.filters.vertex_update import Floats
from bsm.codec.denoise.noise.finding import UNEVEN, Evidence, Finding, is_random, spread
from bsm.codec.denoise.noise.probe import BOUND, SHARE
from bsm.codec.denoise.noise.windows import FEWEST, Windows

FEWEST_WINDOWS = 5
"""In which the direction shows, without which nothing is said."""
LEAST_REACHED = 0.1
"""Share of the mesh that it has to reach."""
AXIS_LEVEL, AXIS_RANK, AXIS_REACH, AXIS_CALM, AXIS_FEWEST = 0.1, 0.3, 0.4, 0.6, 40
"""Noise along an axis: how strong at least, how much weaker in the second direction, where it shows and where not."""
AXIS_TAIL = 2.0
"""Tails of what an axis explains, over the normal distribution's, that noise does not have: creases do."""
DEPTH_FEWEST, DEPTH_WORTH, DEPTH_MOST = 12, 0.7, 3.0
"""Noise that grows with depth: windows that are needed, what is left of the spread, and the logarithm of the ratio
between both ends."""


def one_axis(positions: Positions, evidence: Evidence) -> Finding | None:
    """Noise of `positions`, shape (n, 3), as strong as the direction of the surface says."""
    chosen = evidence.probe.counted
    normals, along = evidence.normals[chosen], np.abs(evidence.along[chosen])
    folded = normals @ _hemisphere().T
    facing = np.abs(folded).argmax(axis=1)
    order = np.argsort(facing, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(facing[order])) + 1)
    groups = [group for group in groups if len(group) >= FEWEST]
    if len(groups) < 6:
        return None
    levels = np.array([np.quantile(along[group], SHARE) for group in groups]) / BOUND
    moments = np.stack([normals[group].T @ normals[group] / len(group) for group in groups])
    weights = np.sqrt([float(len(group)) for group in groups])
    values, vectors = np.linalg.eigh(_covariance(moments, levels**2, weights))
    if values[1] > AXIS_RANK * values[2]:
        return None
    # Cameras look along an axis of their own coordinates, which often are the file's.
    found = [_along(axis, positions, evidence) for axis in (vectors[:, 2], *np.eye(3))]
    best = min(found, key=lambda one: one.spread)
    if best.spread > UNEVEN or best.level < AXIS_LEVEL or best.calm > AXIS_CALM * best.level:
        return None
    facing_it = np.abs(evidence.normals @ best.axis)
    reached = evidence.probe.counted & (facing_it > AXIS_REACH)
    explained = evidence.along[reached] / (best.level * best.growth * facing_it)[reached]
    if not is_random(explained) or np.quantile(np.abs(explained), 0.95) > AXIS_TAIL * 1.96:
        return None
    amount = best.level * best.growth * facing_it * evidence.edge
    reason = f"noise along one axis ({', '.join(f'{component:.2f}' for component in best.axis)})"
    grows = bool((best.growth != 1.0).any())
    if grows:
        reason += f", {best.growth.max() / best.growth.min():.1f} times as strong at one end as at the other"
    growth = best.growth if grows else None
    return Finding("axis", best.level * evidence.edge, amount, evidence.edge, reason, axis=best.axis, growth=growth)


@dataclass(frozen=True, eq=False)
class _Axis:
    """How well noise along one axis explains what is there: its level, its spread, and the level where it is not."""

    axis: Floats
    level: float
    spread: float
    calm: float
    growth: Floats


def _along(axis: Floats, positions: Positions, evidence: Evidence) -> _Axis:
    probe = evidence.probe
    slope = np.abs(evidence.normals @ axis)
    reached = probe.counted & (slope > AXIS_REACH)
    windows = Windows.of_labels(probe.windows, reached, AXIS_FEWEST)
    growth = np.ones(len(slope))
    if reached.sum() < LEAST_REACHED * len(reached) or windows.valid.sum() < FEWEST_WINDOWS:
        return _Axis(axis, 0.0, np.inf, 0.0, growth)
    levels = windows.quantiles(np.abs(evidence.along) / np.maximum(slope, AXIS_REACH), SHARE)[windows.valid] / BOUND
    uneven = spread(levels, windows)
    depth = positions @ axis
    depth = (depth - depth.min()) / (np.ptp(depth) or 1.0)
    if len(levels) >= DEPTH_FEWEST and levels.min() > 0.0:
        rate = _rate(windows.means(depth)[windows.valid], np.log(levels))
        even = levels / np.exp(rate * (windows.means(depth)[windows.valid] - 0.5))
        if abs(rate) < DEPTH_MOST and spread(even, windows) < DEPTH_WORTH * uneven:
            growth, levels, uneven = np.exp(rate * (depth - 0.5)), even, spread(even, windows)
    still = probe.counted & (slope < 0.5 * AXIS_REACH)
    calm = float(np.quantile(np.abs(evidence.along[still]), SHARE)) / BOUND if still.sum() >= FEWEST else 0.0
    return _Axis(axis, float(np.median(levels)), uneven, calm, growth)


def _rate(depth: Floats, logarithms: Floats) -> float:
    """Slope of a line through the points; those far above it (creases) weigh less."""
    weights, line = np.ones(len(depth)), np.zeros(2)
    for _ in range(8):
        line = np.polyfit(depth, logarithms, 1, w=np.sqrt(weights))
        above = np.maximum(logarithms - np.polyval(line, depth), 0.0)
        weights = 1.0 / (1.0 + np.square(above / 0.2))
    return float(line[0])


def _hemisphere(count: int = 48) -> Floats:
    """Directions spread evenly over half a sphere (a Fibonacci lattice)."""
    place = np.arange(count) + 0.5
    height, angle = 1.0 - place / count, np.pi * (1.0 + np.sqrt(5.0)) * place
    radius = np.sqrt(1.0 - height**2)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)


def _covariance(moments: Floats, measured: Floats, trust: Floats) -> Floats:
    """Symmetric positive S with ``tr(S M)`` near the measured squares; large ones (creases) weigh less."""
    rows, columns = np.triu_indices(3)
    design = moments[:, rows, columns] * np.where(rows == columns, 1.0, 2.0)
    weights = trust
    covariance = np.zeros((3, 3))
    for _ in range(12):
        solution = np.linalg.lstsq(design * weights[:, None], measured * weights, rcond=None)[0]
        covariance = np.zeros((3, 3))
        covariance[rows, columns] = solution
        covariance[columns, rows] = solution
        values, vectors = np.linalg.eigh(covariance)
        covariance = (vectors * np.maximum(values, 0.0)) @ vectors.T
        predicted = np.maximum(np.einsum("ijk,jk->i", moments, covariance), 1e-4)
        weights = trust / (predicted * (1.0 + np.abs(measured - predicted) / (0.2 * predicted)))
    return covariance
