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
from bsm.codec.geometry.mesh import TriangleMesh, squares_of
from bsm.codec.look.measure import POWER, LookMetric
from bsm.codec.sequence.frames import same_frames
from bsm.codec.static.targets import WIDEST as COARSEST_STEP
from bsm.codec.static.targets import Contract
from bsm.codec.threads import ordered_map

KNOTS = 8  # frames, evenly over a GOP, that are drawn at every attempt, besides the worst one of each attempt
DEVIATIONS = 4.0
"""Standard deviations: an attempt is accepted once all frames that may exceed the bound within them are drawn."""
KEPT = 1 << 27  # bytes of pictures of originals that are kept from attempt to attempt
SLACK, SLACK_OF_ONE = 0.06, 0.15
"""Part of a bound that may be left, in a GOP and in a frame by itself, which must be quick; twice, of the smallest."""
TWIN_STEP, TWIN = 1 / 16, 1.005
"""A step, in reaches, far below which frames are the same; and how much worse than another one may look."""
EVENING, LEAST_LOOK, WIDEST = 1.6, 0.1, 1.4
"""Power of looks by which the first attempt weighs frames, the k-th by 1 / k of it; the least look that counts,
relative to the largest; and the largest logarithm of a weight."""
BELL = (1 / 16, 4 / 16, 6 / 16, 4 / 16, 1 / 16)  # smooths weights, whose quick changes are dear in the temporal basis
RELIEF = 0.3  # share of the largest change of a weight by which the excess falls, about
TRIES, ENOUGH = 20, 5  # attempts at a step: at most, and those after which one that is near the bound suffices
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
        self._metrics: dict[int, LookMetric] = {}
        self._room = KEPT
        self._knots: set[int] = set()
        self.worst_look = 0.0  # of the frames that were drawn of the returned encoding
        if promise.look < math.inf:
            self._twins = same_frames(frames, (), TWIN_STEP * self._reach)
            self._knots.update(np.linspace(0, len(frames) - 1, min(KNOTS, len(frames))).round().astype(int).tolist())

    def run(self, encode: Callable[[float, Matrix], Found], first: float, finest: float, *, weighed: bool) -> Found:
        """Return the smallest encoding that keeps the promise in every frame; `encode` takes step and weights."""
        kept: tuple[Found, float, float, Matrix] | None = None
        step, evened, missed, high = first, np.zeros(len(self._frames)), 0, COARSEST_STEP
        uneven = weighed and len(evened) > 1 and bool(self._knots)
        slack = SLACK if len(evened) > 1 else SLACK_OF_ONE
        for attempt in range(1, TRIES + 1):
            step = min(max(step, finest), COARSEST_STEP)
            found = encode(step, np.exp(evened))
            measured = self._measure(list(found.decoded_frames()))
            excess, relief = measured.excess, 0.0
            missed, high = (missed + 1, step) if excess > 0.0 else (0, high)
            if excess <= 0.0 and (kept is None or found.size <= kept[0].size):
                kept = found, excess, step, evened
                shares = (share for frame, share in measured.drawn.items() if self._twins[frame] == frame)
                self.worst_look = self._promise.look * max(shares, default=0.0)
            if step == (COARSEST_STEP if excess <= 0.0 else finest):
                break
            near = -slack < excess <= 0.0 and (attempt > 1 or not uneven)
            if kept is not None and (near or attempt >= ENOUGH):
                if kept[1] > -2.0 * slack or attempt >= ENOUGH + 2:
                    break  # else it may be far below its bound
                _, excess, step, evened = kept
                step, uneven = min(math.sqrt(step * high), step * math.exp(-excess - slack / 2.0)), False
                continue
            if uneven:
                change = EVENING * _evening(measured.looks()) / attempt
                relief = RELIEF * float(change.max())
                evened = (evened + change).clip(-WIDEST, WIDEST)
            step *= math.exp(relief - excess - slack / 2.0 * (1 + missed))
        if kept is None:
            raise TargetError(f"{self._promise} cannot be kept in every frame, even with step {step:.2g}")
        return kept[0]

    def _measure(self, decoded: Sequence[Matrix]) -> Measured:
        """Measure all frames, and draw those that may exceed the bound until one does."""
        pairs = list(zip(self._frames, decoded, strict=True))
        farthest = math.sqrt(max(squares_of(one - other).max() for one, other in pairs)) / self._reach
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
        metric = self._metrics.get(index) or metric_of(self._frames[index], self._faces, self._threads)
        if metric is None:
            return 0.0
        held = int(_PIXEL * metric.pixels**2)
        if index not in self._metrics and held <= self._room:
            self._room -= held
            self._metrics[index] = metric
        return metric.look(decoded[index]).moving / self._promise.look


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


def metric_of(frame: Positions, faces: Faces, threads: int | None = None) -> LookMetric | None:
    """Return the metric of an original frame, or None if nothing of it is seen."""
    try:
        return LookMetric(TriangleMesh(frame, faces), threads=threads)
    except MeshError:
        return None


def shading_error(original: Positions, decoded: Positions, faces: Faces) -> float:
    """How far normals of vertices, shape (n, 3), are off the original's: a measure much cheaper than pictures."""
    first, second = (np.ascontiguousarray(positions, np.float64) for positions in (original, decoded))
    around = np.zeros((len(first), 7))
    return _kernels.normals_apart(first, second, np.ascontiguousarray(faces, np.int32), around)
