"""The widest step with which every frame keeps a promise; no part of the format."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np

from bsm._core import codec as _kernels
from bsm.bitstream.errors import MeshError, TargetError
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import POWER, LookMetric
from bsm.codec.sequence.frames import same_frames
from bsm.codec.static.targets import COARSEST_STEP, Contract
from bsm.codec.threads import ordered_map

KNOTS = 8  # frames, evenly over a GOP, that are drawn at every attempt, besides the worst one of each attempt
DEVIATIONS = 4.0
"""Standard deviations: an attempt is accepted once all frames that may exceed the bound within them are drawn."""
KEPT = 1 << 27  # bytes of pictures of originals that are kept from attempt to attempt
SLACK, SLACK_OF_ONE = 0.06, 0.15
"""Part of a bound that may be left, in a GOP and in a frame by itself, which must be quick."""
TWIN_STEP, TWIN = 1 / 16, 1.005
"""A step, in reaches, far below which frames are the same; and how much worse than another one may look."""
EVENING, LEAST_LOOK, WIDEST = 1.6, 0.1, 1.4
"""Power of looks by which the first attempt weighs frames, the k-th by 1 / k of it; the least look that counts,
relative to the largest; and the largest logarithm of a weight."""
BELL = (1 / 16, 4 / 16, 6 / 16, 4 / 16, 1 / 16)  # smooths weights, whose quick changes are dear in the temporal basis
RELIEF = 0.3  # share of the largest change of a weight by which the excess falls, about
TRIES, ENOUGH = 20, 5  # attempts at a step: at most, and those after which one that keeps the promise suffices
_PIXEL = 4 * 6 / 16  # bytes of a `LookMetric` for each sample along the side of its pictures, squared


class Candidate(Protocol):
    """Frames that were encoded with some step."""

    @property
    def size(self) -> int:
        """Bytes."""

    def decoded_frames(self) -> Iterator[Matrix]:
        """Yield each decoded frame, shape (n, 3)."""


Found = TypeVar("Found", bound=Candidate)


class StepSearch:
    """Searches for the widest step with which the frames of a GOP keep a promise."""

    def __init__(self, frames: Positions, faces: Faces, promise: Contract, scale: float, threads: int | None) -> None:
        self._frames, self._faces, self._promise, self._threads = frames, faces, promise, threads
        self._reach = promise.farthest / scale if promise.absolute else promise.farthest
        self._metrics: dict[int, LookMetric | None] = {}
        self._room = KEPT
        self._knots: set[int] = set()
        self.worst_look = 0.0  # of the frames that were drawn of the returned encoding
        if promise.look < math.inf:
            self._twins = same_frames(frames, (), TWIN_STEP * self._reach)
            self._knots.update(np.linspace(0, len(frames) - 1, min(KNOTS, len(frames))).round().astype(int).tolist())

    def run(self, encode: Callable[[float, Matrix], Found], first: float, finest: float, *, weighed: bool) -> Found:
        """Return the smallest encoding that keeps the promise in every frame; `encode` takes step and weights."""
        kept: Found | None = None
        step, evened, missed, most = first, np.zeros(len(self._frames)), 0, COARSEST_STEP
        uneven = weighed and len(evened) > 1 and bool(self._knots)
        slack = SLACK if len(evened) > 1 else SLACK_OF_ONE
        for attempt in range(1, TRIES + 1):
            step = min(max(step, finest), most)
            found = encode(step, np.exp(evened))
            measured = self._measure(list(found.decoded_frames()))
            excess, relief = measured.excess, 0.0
            if excess <= 0.0 and (kept is None or found.size <= kept.size):
                kept = found
                self.worst_look = self._promise.look * max(
                    (measured.drawn[i] for i in measured.drawn if self._twins[i] == i), default=0.0
                )
            enough = attempt >= ENOUGH or (excess > -slack and (attempt > 1 or not uneven))
            if step == (most if excess <= 0.0 else finest) or (excess <= 0.0 and enough):
                break
            missed = missed + 1 if excess > 0.0 else 0
            if uneven:
                change = EVENING * _evening(measured.looks()) / attempt
                relief = RELIEF * float(change.max())
                evened = (evened + change).clip(-WIDEST, WIDEST)
            step *= math.exp(relief - excess - slack / 2.0 * (1 + missed))
        if kept is None:
            raise TargetError(f"{self._promise} cannot be kept in every frame, even with step {step:.2g}")
        return kept

    def _measure(self, decoded: Sequence[Matrix]) -> Measured:
        """Measure all frames, and draw those that may exceed the bound until one does."""
        pairs = list(zip(self._frames, decoded, strict=True))
        farthest = max(_kernels.farthest_apart(*map(np.ascontiguousarray, pair)) for pair in pairs) / self._reach
        if not self._knots:
            return Measured(farthest, np.zeros(0), {})
        wrong = ordered_map(lambda pair: shading_error(*pair, self._faces), pairs, self._threads)
        errors = np.array(list(wrong)).clip(1e-12) ** POWER
        knots = sorted({*self._knots, int(errors.argmax())})  # the verification draws the largest error, too
        measured = Measured(farthest, errors, {index: self._look(index, decoded) for index in knots})
        while (index := int(measured.looks().argmax())) not in measured.drawn:
            measured.drawn[index] = self._look(index, decoded)
        while measured.excess <= 0.0 and (doubtful := measured.doubtful) is not None:
            measured.drawn[doubtful] = self._look(doubtful, decoded)
        self._knots.add(int(measured.looks().argmax()))
        return measured

    def _look(self, index: int, decoded: Sequence[Matrix]) -> float:
        """Return the look of a frame as a share of the bound; 0 if nothing of it is seen."""
        twin = int(self._twins[index])
        if twin != index and np.array_equal(decoded[twin], decoded[index]):
            return TWIN * self._look(twin, decoded)
        metric = self._metrics[index] if index in self._metrics else self._metric(index)
        if metric is None:
            return 0.0
        held = int(_PIXEL * metric.pixels**2)
        if index not in self._metrics and held <= self._room:
            self._room -= held
            self._metrics[index] = metric
        return metric.look(decoded[index]).moving / self._promise.look

    def _metric(self, index: int) -> LookMetric | None:
        """Return the metric of an original frame, or None if nothing of it is seen."""
        try:
            return LookMetric(TriangleMesh(self._frames[index], self._faces), threads=self._threads)
        except MeshError:
            return None


@dataclass(eq=False)
class Measured:
    """Measurements of the frames of one attempt, as shares of their bounds; `errors` are of normals."""

    farthest: float
    errors: Matrix
    drawn: dict[int, float]

    @property
    def excess(self) -> float:
        """Logarithm of the largest share, drawn or expected."""
        return math.log(max(self.farthest, float(self.looks().max(initial=1e-9))))

    @property
    def doubtful(self) -> int | None:
        """The frame that may exceed the bound most of those not drawn; None if none may."""
        most = self.looks(DEVIATIONS)
        most[list(self.drawn)] = 0.0
        return int(most.argmax()) if most.max(initial=0.0) > 1.0 else None

    def looks(self, deviations: float = 0.0) -> Matrix:
        """Return the looks of all frames, shape (T,), expected ones of those not drawn plus standard deviations. Looks
        over errors are interpolated in time, as a Brownian bridge between frames that are drawn."""
        seen = np.array(sorted(index for index, share in self.drawn.items() if share > 0.0), np.int64)
        if not len(seen):
            return np.zeros(len(self.errors))
        ratios = np.log([self.drawn[index] for index in seen]) - np.log(self.errors[seen])
        steps, frames = np.diff(seen), np.arange(len(self.errors))
        rate = float(np.mean(np.diff(ratios) ** 2 / steps)) if len(steps) else 1.0
        since = frames - seen[np.maximum(np.searchsorted(seen, frames, side="right") - 1, 0)]
        until = seen[np.minimum(np.searchsorted(seen, frames), len(seen) - 1)] - frames
        inside = np.minimum(since, until) >= 0
        spans = np.where(inside, since * until / np.maximum(since + until, 1), np.maximum(since, until))
        looks = self.errors * np.exp(np.interp(frames, seen, ratios) + deviations * np.sqrt(rate * spans))
        looks[list(self.drawn)] = list(self.drawn.values())
        return np.asarray(looks)


def _evening(looks: Matrix) -> Matrix:
    """Return logarithms of weights of frames, shape (T,), with which all of them look about alike."""
    logarithms = np.log(np.maximum(looks, LEAST_LOOK * looks.max(initial=0.0) or 1.0))
    smooth = np.convolve(np.pad(logarithms, len(BELL) // 2, mode="edge"), BELL, mode="valid")
    return np.asarray(smooth - smooth.mean())


def look_of_frame(original: Positions, decoded: Positions, faces: Faces) -> float | None:
    """How a frame of a moving mesh looks; None if nothing of it can be seen."""
    try:
        return LookMetric(TriangleMesh(original, faces)).look(decoded).moving
    except MeshError:
        return None


def shading_error(original: Positions, decoded: Positions, faces: Faces) -> float:
    """How far normals of vertices, shape (n, 3), are off the original's: a measure much cheaper than pictures."""
    first, second = (np.ascontiguousarray(positions, np.float64) for positions in (original, decoded))
    around = np.zeros((len(first), 7))
    return _kernels.normals_apart(first, second, np.ascontiguousarray(faces, np.int32), around)
