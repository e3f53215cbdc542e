"""What every frame of a sequence keeps to, and the step that is just fine enough: the encoder's own business."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np

from bsm.bitstream.errors import MeshError, OptionError, TargetError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import Looker

WATCHED = 8
"""Frames that every attempt is looked at in."""
MARGIN = 1.1
"""One that is good enough there is looked at in all others but those that would not break the promise if they looked by
so much worse, for the error of their normals, than any that was looked at."""
ENOUGH = 3
"""Frames that break a promise before another step is tried."""
SLACK = 0.06
"""Part of a bound that may be left."""
SLOPE = 0.85
"""What is seen grows with about this power of the step."""
COARSEST_STEP = 0.1
_TRIES = 20


@dataclass(frozen=True)
class Promise:
    """What holds in every frame, checked on what is decoded.

    Parameters
    ----------
    farthest : float
        How far a vertex may be off, in diagonals of the first frame.
    look : float
        Distance in pictures (`codec.look`): 1 looks the same; infinite: any.
    absolute : bool
        `farthest` is in the mesh's unit.

    Raises
    ------
    OptionError
        If a bound is not above 0.
    """

    farthest: float
    look: float = math.inf
    absolute: bool = False

    def __post_init__(self) -> None:
        if not (0.0 < self.farthest < math.inf and self.look > 0.0):
            raise OptionError(f"bounds must be above 0, not {self.farthest:g} and a look of {self.look:g}")

    def reach(self, scale: float) -> float:
        """How far a vertex may be off in BSM units, `scale` of the mesh's own each."""
        return float(self.farthest / scale if self.absolute else self.farthest)

    @property
    def first_step(self) -> float:
        """A step to try first."""
        farthest = 0.01 if self.absolute else self.farthest
        return min(0.25 * farthest, 6e-4 * min(self.look, 1e3))

    def __str__(self) -> str:
        bound = f"no vertex farther off than {self.farthest:.4g}{'' if self.absolute else ' diagonals'}"
        return bound if math.isinf(self.look) else f"{bound} and a look of {self.look:g}"


PROMISES = {
    "small": Promise(0.02, 3.0),
    "balanced": Promise(0.01, 1.0),
    "fine": Promise(0.005, 0.5),
    "near-lossless": Promise(0.0005),
}
"""The presets of sequences, with the bounds of those of meshes."""


class Attempt(Protocol):
    """Frames that were encoded with some step."""

    @property
    def decoded(self) -> Positions:
        """What the decoder makes of them, shape (T, n, 3)."""


Found = TypeVar("Found", bound=Attempt)


class Watch:
    """Looks at the frames of a GOP.

    Parameters
    ----------
    frames : float64 array, shape (T, n, 3)
        In BSM units.
    faces : int32 array, shape (m, 3)
    promise : Promise
    scale : float
        Of a BSM unit, in the mesh's own.
    threads : int, optional
    """

    def __init__(self, frames: Positions, faces: Faces, promise: Promise, scale: float, threads: int | None) -> None:
        self._frames, self._faces, self._promise, self._threads = frames, faces, promise, threads
        self._reach = promise.reach(scale)
        self._lookers: dict[int, Looker | None] = {}
        if promise.look < math.inf:
            for index in np.linspace(0, len(frames) - 1, min(WATCHED, len(frames))).round().astype(int).tolist():
                self._lookers[index] = self._looker(index)

    def settle(self, attempt: Callable[[float], Found], first: float, finest: float) -> tuple[float, Found]:
        """The step that keeps the promise in every frame with little to spare, and its attempt.

        Raises
        ------
        TargetError
            If no step down to `finest` keeps it.
        """
        while True:
            step, found = self._search(attempt, first, finest)
            worst = self._worst_of_others(found.decoded)
            if worst <= 0.0:
                return step, found
            first = step * math.exp(-(worst + SLACK / 2) / SLOPE)

    def _search(self, attempt: Callable[[float], Found], first: float, finest: float) -> tuple[float, Found]:
        """`settle`, with regard to the frames that are watched."""
        kept: tuple[float, float, Found] | None = None  # logarithms of step and excess
        broken: tuple[float, float] | None = None
        at = min(max(math.log(first), math.log(finest)), math.log(COARSEST_STEP))
        for _ in range(_TRIES):
            found = attempt(math.exp(at))
            excess = self._excess(found.decoded)
            if excess <= 0.0 and (kept is None or at > kept[0]):
                kept = at, excess, found
            elif excess > 0.0 and (broken is None or at < broken[0]):
                broken = at, excess
            if kept is not None and (kept[1] > -SLACK or at >= math.log(COARSEST_STEP)):
                break
            if kept is None and at <= math.log(finest):
                break
            if kept is None or broken is None:
                following = at - (min(excess, 3.0) + SLACK / 2) / SLOPE
            else:
                share = (-SLACK / 2 - kept[1]) / (broken[1] - kept[1])
                following = kept[0] + min(max(share, 0.1), 0.9) * (broken[0] - kept[0])
                if broken[0] - kept[0] < SLACK / 4:
                    break
            at = min(max(following, math.log(finest)), math.log(COARSEST_STEP))
        if kept is None:
            raise TargetError(
                f"{self._promise} in every frame cannot be kept, not even with a step of {math.exp(at):.2g}"
            )
        return math.exp(kept[0]), kept[2]

    def _excess(self, decoded: Positions) -> float:
        """Logarithm of the largest share of a bound, farthest vertices of all frames, looks of those watched."""
        farthest = max(float(np.square(a - b).sum(axis=1).max()) for a, b in zip(self._frames, decoded, strict=True))
        shares = [math.sqrt(farthest) / self._reach]
        shares += [self._look(looker, decoded[index]) for index, looker in self._lookers.items()]
        return math.log(max(*shares, 1e-9))

    def _worst_of_others(self, decoded: Positions) -> float:
        """The largest excess of looks of frames that are not watched; those that break the promise are from now on."""
        worst = -math.inf
        if math.isinf(self._promise.look):
            return worst
        errors = np.array([normal_error(a, b, self._faces) for a, b in zip(self._frames, decoded, strict=True)])
        ratio = max(self._look(looker, decoded[k]) / max(errors[k], 1e-12) for k, looker in self._lookers.items())
        broken = 0
        for index in np.argsort(-errors).tolist():
            if index in self._lookers:
                continue
            if MARGIN * ratio * errors[index] < 1.0 or broken == ENOUGH:
                break
            looker = self._looker(index)
            share = self._look(looker, decoded[index])
            ratio = max(ratio, share / max(errors[index], 1e-12))
            if share > 1.0:
                broken += 1
                self._lookers[index] = looker
                worst = max(worst, math.log(share))
        return worst

    def _looker(self, index: int) -> Looker | None:
        """None for a frame of which nothing is seen."""
        try:
            return Looker(TriangleMesh(self._frames[index], self._faces), threads=self._threads)
        except MeshError:
            return None

    def _look(self, looker: Looker | None, decoded: Positions) -> float:
        """Share of the bound."""
        return 0.0 if looker is None else looker.distance(decoded) / self._promise.look


def normal_error(original: Positions, decoded: Positions, faces: Faces) -> float:
    """Root mean square of how far normals of faces are off, by area: a cheap hint of how a frame looks."""

    def normals(positions: Positions) -> Positions:
        corners = positions[faces]
        return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    own, other = normals(original), normals(decoded)
    areas, lengths = np.linalg.norm(own, axis=1), np.linalg.norm(other, axis=1)
    cosines = np.einsum("ij,ij->i", own, other) / np.maximum(areas * lengths, 1e-300)
    total = float(areas.sum())
    return math.sqrt(float(areas @ (1.0 - np.minimum(cosines, 1.0))) / total) if total else 0.0
