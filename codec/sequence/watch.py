"""Looking after promises: the step that is just fine enough for every frame. The encoder's own business."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np

from bsm.bitstream.errors import MeshError, TargetError
from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import LookMetric
from bsm.codec.sequence.level_writer import ROUNDS
from bsm.codec.sequence.promise import Promise
from bsm.codec.static.targets import COARSEST_STEP

KNOTS = 10
"""Frames, evenly over a GOP, that pictures are drawn of at every attempt."""
MORE = 6
"""If all is well there, so many of those that may be the worst are drawn as well."""
DEVIATIONS = 5.0
"""An attempt is taken once all frames are drawn that may look worse than the bound, by so many standard deviations."""
KEPT = 1 << 26
"""Bytes of pictures of originals that are kept from attempt to attempt."""
SLACK, SLACK_OF_ONE = 0.04, 0.15
"""Part of a bound that may be left, in a GOP and in a frame by itself, which must be quick."""
ROUGH = 1
"""Rounds over levels in a first attempt, which only tells what weights frames need: a third of the time."""
SLOPE, SLOPES = 0.7, (0.4, 2.5)
"""What is seen grows with about this power of the step; and the range of what two attempts may say about it."""
EVENING, SMOOTHNESS = 0.8, 2.0
"""Frames are weighed by this power of what would make all look alike, smoothly over so many frames: weights that
change quickly are dear in the temporal basis."""
WIDEST = 1.0
"""Logarithm of the largest weight, and of one over the smallest."""
_TRIES = 20
_PIXEL = 4 * 14
"""Bytes of a `LookMetric` for each pixel of its pictures' side, squared."""


class Attempt(Protocol):
    """Frames that were encoded with some step."""

    @property
    def decoded(self) -> Positions:
        """What the decoder makes of them, shape (T, n, 3)."""


Found = TypeVar("Found", bound=Attempt)


class Watch:
    """Looks at the frames of a GOP."""

    def __init__(self, frames: Positions, faces: Faces, promise: Promise, scale: float, threads: int | None) -> None:
        self._frames, self._faces, self._promise, self._threads = frames, faces, promise, threads
        self._reach = promise.reach(scale)
        self._lookers: dict[int, LookMetric | None] = {}
        self._room = KEPT
        self._knots: list[int] = []
        if promise.look < math.inf:
            self._shading = Shading(frames.shape[1], faces)
            self._knots = np.linspace(0, len(frames) - 1, min(KNOTS, len(frames))).round().astype(int).tolist()

    def settle(self, attempt: Callable[[float, Matrix | None, int], Found], first: float, finest: float) -> Found:
        """What keeps the promise in every frame with little to spare."""
        low, high = math.log(finest), math.log(COARSEST_STEP)
        at = min(max(math.log(first), low), high)
        weights = None
        if self._knots and len(self._frames) > 1:
            sight = self._see(attempt(math.exp(at), None, ROUGH).decoded)
            weights = _evening(sight.shares)
            at = min(max(at - (min(sight.excess, 3.0) + SLACK / 2) / SLOPE, low), high)
        slack = SLACK if len(self._frames) > 1 else SLACK_OF_ONE
        kept: tuple[float, Sight, Found] | None = None  # the first is the logarithm of the step
        broken: tuple[float, float] | None = None  # that, and the excess
        before: tuple[float, float] | None = None
        for tries in range(_TRIES):
            found = attempt(math.exp(at), weights, ROUNDS)
            sight = self._see(found.decoded)
            excess = sight.excess
            if excess <= 0.0 and (kept is None or at > kept[0]):
                kept = at, sight, found
            elif excess > 0.0 and (broken is None or at < broken[0]):
                broken = at, excess
            if kept is None and at <= low:
                break
            if kept is not None and (kept[1].excess > -slack * (1 + tries / 4) or at >= high):
                break
            slope = SLOPE
            if before is not None and before[0] != at:
                slope = min(max((excess - before[1]) / (at - before[0]), SLOPES[0]), SLOPES[1])
            before = at, excess
            at -= (min(excess, 3.0) + slack / 2) / slope
            if kept is not None and broken is not None:
                room = broken[0] - kept[0]
                if room < slack / 4:
                    break
                at = min(max(at, kept[0] + 0.1 * room), broken[0] - 0.1 * room)
            at = min(max(at, low), high)
        if kept is None:
            raise self._refusal(math.exp(at))
        at, sight, found = kept
        for _ in range(_TRIES):
            self._look_at_doubtful(sight, found.decoded)
            if sight.excess <= 0.0:
                return found
            if at <= low:
                break
            at = max(at - (sight.excess + slack / 2) / SLOPE, low)
            found = attempt(math.exp(at), weights, ROUNDS)
            sight = self._see(found.decoded)
        raise self._refusal(math.exp(at))

    def _refusal(self, step: float) -> TargetError:
        return TargetError(f"{self._promise} in every frame cannot be kept, not even with a step of {step:.2g}")

    def _see(self, decoded: Positions) -> Sight:
        """How the frames look, by those all over the GOP, and, if all is well there, a few that may be the worst."""
        pairs = list(zip(self._frames, decoded, strict=True))
        farthest = math.sqrt(max(float(np.square(a - b).sum(axis=1).max()) for a, b in pairs)) / self._reach
        if not self._knots:
            return Sight(farthest, np.zeros(0), {})
        errors = np.array([self._shading.error(self._shading.normals(a), b) for a, b in pairs]).clip(1e-12)
        sight = Sight(farthest, errors, {index: self._look(index, decoded) for index in self._knots})
        for _ in range(MORE):
            index = sight.doubtful
            if index is None or sight.excess > 0.0 or sight.most[index] < 1.0 - 2.0 * SLACK:
                break
            sight.drawn[index] = self._look(index, decoded)
        return sight

    def _look_at_doubtful(self, sight: Sight, decoded: Positions) -> None:
        while sight.excess <= 0.0 and (index := sight.doubtful) is not None and sight.most[index] > 1.0:
            sight.drawn[index] = self._look(index, decoded)

    def _look(self, index: int, decoded: Positions) -> float:
        """Share of the bound; 0 for a frame of which nothing is seen."""
        if index not in self._lookers:
            looker = self._looker(index)
            held = _PIXEL * looker.pixels**2 if looker else 0
            if held <= self._room:
                self._room -= held
                self._lookers[index] = looker
        else:
            looker = self._lookers[index]
        return 0.0 if looker is None else looker.look(decoded[index]).moving / self._promise.look

    def _looker(self, index: int) -> LookMetric | None:
        """None for a frame of which nothing is seen."""
        try:
            return LookMetric(TriangleMesh(self._frames[index], self._faces), threads=self._threads)
        except MeshError:
            return None


@dataclass(eq=False)
class Sight:
    """What is known of the frames of one attempt, in shares of their bounds."""

    farthest: float
    errors: Matrix
    drawn: dict[int, float]

    @property
    def excess(self) -> float:
        """Logarithm of the largest share, drawn or expected."""
        return math.log(max(self.farthest, float(self.shares.max(initial=1e-9))))

    @property
    def shares(self) -> Matrix:
        """Looks of all frames, shape (T,): of those not drawn what is expected."""
        return self._judged(0.0)

    @property
    def most(self) -> Matrix:
        """What the looks may be, shape (T,)."""
        return self._judged(DEVIATIONS)

    @property
    def doubtful(self) -> int | None:
        """The frame that may be the worst of those not drawn; None if all are, or none needs to be."""
        most = self.most
        most[list(self.drawn)] = 0.0
        return int(most.argmax()) if most.any() else None

    def _judged(self, deviations: float) -> Matrix:
        """Looks, so many standard deviations above what is expected."""
        shares = self.errors.copy()
        seen = np.array(sorted(index for index, share in self.drawn.items() if share > 0.0), np.int64)
        if len(seen):
            ratios = np.log([self.drawn[index] for index in seen]) - np.log(self.errors[seen])
            steps = np.diff(seen)
            rate = float(np.mean(np.diff(ratios) ** 2 / steps)) if len(steps) else 1.0
            frames = np.arange(len(shares))
            since = frames - seen[np.maximum(np.searchsorted(seen, frames, side="right") - 1, 0)]
            until = seen[np.minimum(np.searchsorted(seen, frames), len(seen) - 1)] - frames
            inside = np.minimum(since, until) >= 0
            spans = np.where(inside, since * until / np.maximum(since + until, 1), np.maximum(since, until))
            shares *= np.exp(np.interp(frames, seen, ratios) + deviations * np.sqrt(rate * spans))
        else:
            shares[:] = 0.0
        for index, share in self.drawn.items():
            shares[index] = share
        return shares


def _evening(shares: Matrix) -> Matrix:
    """Weights of frames, shape (T,), with which all of them would look about alike."""
    logarithms = np.log(np.maximum(shares, 1e-3 * shares.max()))
    reach = int(4.0 * SMOOTHNESS)
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / SMOOTHNESS) ** 2)
    padded = np.pad(EVENING / SLOPE * (logarithms - logarithms.mean()), reach, mode="edge")
    weights = np.convolve(padded, bell / bell.sum(), mode="valid")
    evening: Matrix = np.exp(np.clip(weights - weights.mean(), -WIDEST, WIDEST))
    return evening


class Shading:
    """How faces are shaded, for a measure that is much cheaper than pictures: by normals of vertices alone."""

    def __init__(self, vertices: int, faces: Faces) -> None:
        self._faces, self._count = np.ascontiguousarray(faces, np.int32), vertices

    def normals(self, positions: Positions) -> tuple[Matrix, Matrix]:
        """Normals of vertices, shape (n, 3), with the areas around them, shape (n,), of `positions`, shape (n, 3)."""
        sums, areas = np.zeros((self._count, 3)), np.zeros(self._count)
        _kernels.crosses_around(np.ascontiguousarray(positions, np.float64), self._faces, sums, areas)
        lengths = np.sqrt(np.einsum("ij,ij->i", sums, sums))[:, None]
        return np.divide(sums, lengths, out=sums, where=lengths > 0.0), areas

    def error(self, original: tuple[Matrix, Matrix], decoded: Positions) -> float:
        """How far normals of vertices of `decoded`, shape (n, 3), are off those that `normals` gives of the original"""
        (own, areas), (other, _) = original, self.normals(decoded)
        cosines = np.minimum(np.einsum("ij,ij->i", own, other), 1.0)
        total = float(areas.sum())
        return float(areas @ np.sqrt(1.0 - cosines)) / total if total else 0.0
