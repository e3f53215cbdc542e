"""Targets of a sequence: those of static meshes, over all frames."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.metrics import Comparison, Reference
from bsm.codec.static.targets import Target

# The power of the step that errors grow with, where it is known before two are tried; 1 elsewhere.
RISES = {"kg": 0.78}


@dataclass(frozen=True)
class SequenceComparison:
    """A decoded sequence against its original; `kg` is 100 ||P - P~|| / ||P - E(P)|| (Karni and Gotsman, 2004)."""

    kg: float
    theta_deg: float
    nmsve_db: float
    rms_relative: float
    max_error: float
    max_error_relative: float
    flicker: float


def compare_sequences(original: Positions, decoded: Positions, faces: Faces) -> SequenceComparison:
    """Compare frames, both of shape (T, n, 3), that share their faces and the order of their vertices."""
    return compare_runs([(original, decoded, faces)])[0]


Runs: TypeAlias = Sequence[tuple[Positions, Positions, Faces]]


def compare_runs(runs: Runs) -> tuple[SequenceComparison, list[dict[str, float]]]:
    """Compare runs of frames, the decoded ones, and their faces; return also the errors of each frame."""
    comparisons: list[Comparison] = []
    each: list[dict[str, float]] = []
    wrong = extent = flicker = motion = 0.0
    for original, decoded, faces in runs:
        of_run = [Reference(a, faces).compare(b) for a, b in zip(original, decoded, strict=True)]
        diagonal = float(np.linalg.norm(np.ptp(original[0], axis=0))) or 1.0
        each += [
            {"rms_relative": f.rms / diagonal, "max_error_relative": f.max_error / diagonal}
            for f in of_run
        ]
        comparisons += of_run
        wrong += float(np.square(original - decoded).sum())
        # Karni and Gotsman divide by the motion about the mean of each frame, so that a walk across the room counts
        # nothing.
        extent += float(np.square(original - original.mean(axis=1, keepdims=True)).sum())
        # Second differences: an error that stays is not seen, and one that jumps is.
        flicker += float(np.square(np.diff(decoded - original, 2, axis=0)).sum())
        motion += float(np.square(np.diff(original, 2, axis=0)).sum())
    nmsve = float(np.mean([frame.nmsve for frame in comparisons]))
    compared = SequenceComparison(
        kg=_percent(wrong, extent),
        theta_deg=float(np.mean([frame.theta_deg for frame in comparisons])),
        nmsve_db=10.0 * math.log10(nmsve) if nmsve > 0.0 else -math.inf,
        rms_relative=math.sqrt(float(np.mean([frame["rms_relative"] ** 2 for frame in each]))),
        max_error=max(frame.max_error for frame in comparisons),
        max_error_relative=max(frame["max_error_relative"] for frame in each),
        # Less is a constant speed, rounded.
        flicker=_percent(flicker, motion if motion > 1e-13 * extent else 0.0),
    )
    return compared, each


def _percent(part: float, total: float) -> float:
    if part == 0.0:
        return 0.0
    # Of a motionless original any error is infinitely large.
    return 100.0 * math.sqrt(part / total) if total else math.inf


SequenceTarget = Target
"""Its name where the target is one of a sequence."""
