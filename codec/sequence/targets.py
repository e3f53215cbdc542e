"""What a sequence is to reach: the targets of static meshes, over all of its frames."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bsm.bitstream.public import public
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.metrics import Reference, kg_error
from bsm.codec.static.targets import Target


@dataclass(frozen=True)
class SequenceComparison:
    """A decoded sequence against its original.

    Attributes
    ----------
    kg : float
        Karni and Gotsman's error, percent.
    theta_deg, nmsve_db : float
        Means over the frames (of NMSVE itself, not of its decibels).
    rms_relative, max_error_relative : float
        Over all frames, in diagonals of the first frame.
    flicker : float
        How much the error changes from frame to frame, its second difference in time, in percent of the motion's own;
        0 for fewer than three frames, infinity where nothing moves but the error.
    """

    kg: float
    theta_deg: float
    nmsve_db: float
    rms_relative: float
    max_error_relative: float
    flicker: float


def compare_sequences(original: Positions, decoded: Positions, faces: Faces) -> SequenceComparison:
    """Compare frames, both of shape (T, n, 3), that share their faces and the order of their vertices."""
    kg = kg_error(original, decoded)
    each = [Reference(a, faces).compare(b) for a, b in zip(original, decoded, strict=True)]
    diagonal = float(np.linalg.norm(np.ptp(original[0], axis=0))) or 1.0
    nmsve = float(np.mean([frame.nmsve for frame in each]))
    return SequenceComparison(
        kg=kg,
        theta_deg=float(np.mean([frame.theta_deg for frame in each])),
        nmsve_db=10.0 * math.log10(nmsve) if nmsve > 0.0 else -math.inf,
        rms_relative=math.sqrt(float(np.mean([frame.rms**2 for frame in each]))) / diagonal,
        max_error_relative=max(frame.max_error for frame in each) / diagonal,
        flicker=flicker_of(original, decoded),
    )


def flicker_of(original: Positions, decoded: Positions) -> float:
    """`SequenceComparison.flicker` of frames, both of shape (T, n, 3)."""
    wrong, own = (float(np.linalg.norm(np.diff(part, 2, axis=0))) for part in (decoded - original, original))
    if wrong == 0.0:
        return 0.0
    return 100.0 * wrong / own if own else math.inf


@public
@dataclass(frozen=True)
class SequenceTarget(Target):
    """What to reach.

    Parameters
    ----------
    kind : str
        "kg" (percent), "theta_deg", "nmsve_db" (at most so much error), or "bpvf" (at most so many bits per vertex and
        frame of the whole file).
    value : float

    Raises
    ------
    OptionError
        If there is no such target.

    Examples
    --------
    >>> import bsm
    >>> options = bsm.SequenceOptions(target=bsm.SequenceTarget("kg", 0.5))
    >>> data = bsm.encode_sequence(*bsm.decode_sequence("dance.bsm"), options)
    """

    KINDS: ClassVar[tuple[str, ...]] = ("kg", "theta_deg", "nmsve_db", "bpvf")
