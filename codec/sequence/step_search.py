"""The widest step with which every frame keeps a promise; no part of the format.

Frames and a bound come in; the smallest encoding that keeps it in every frame goes out. A frame that looks worse than
the others sets the step of all. So an attempt has two results: how far the worst frame is from its bound, which gives
the next step, and how unlike frames are, which gives weights of frames: the temporal basis then spends more on those
that are nearer to their bounds. Pictures are the dear part. The first attempt draws a few frames, each one those that
are likely the worst; foreseen looks, which cost little, tell of the others: the logarithm of look over foresight is
noise on a random walk in time. It hardly changes from attempt to attempt, so that frames drawn before count as known,
nearly. Only the encoding that would be returned has all of its own frames drawn that may exceed the bound: it is the
promise, so that nothing is taken on trust. If one does exceed it, the search goes on from there, or takes the next
smallest. The search ends when another attempt would save less than its price in bytes, by the power law of bytes over
the step; each attempt has to save more than the one before it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Generic, Protocol, TypeVar

import numpy as np

from bsm.bitstream.errors import MeshError, OptionError, TargetError
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh, squares_of
from bsm.codec.geometry.welding import group_rows
from bsm.codec.look.foreseen import Foresight
from bsm.codec.look.measure import POWER, LookMetric
from bsm.codec.look.pictures import sides_of
from bsm.codec.progress import Nearing
from bsm.codec.sequence.frames import same_frames
from bsm.codec.static.targets import WIDEST as COARSEST_STEP
from bsm.codec.static.targets import Contract
from bsm.codec.static.units import Units
from bsm.codec.threads import ordered_map

KNOTS = 8  # frames, evenly over a GOP, that are drawn at the first attempt
# Standard deviation of what the logarithm of look over foresight changes by from attempt to attempt.
DRIFT = 0.05
PACE, NOISE, LIKE_SEEN = 0.05, 0.03, 3
"""Of the logarithm of look over foresight: the variance by which it walks from frame to frame, over that of its noise;
the standard deviation of this before frames are drawn, and how many differences of frames that counts as."""
LIKELY, DEVIATIONS = 1.5, 4.0
"""Standard deviations: frames that may be the worst within the first are drawn at each attempt; an attempt is accepted
once all frames that may exceed the bound within the second are drawn."""
KEPT = 1 << 27  # bytes of pictures of originals that are kept from attempt to attempt
PRICE, PRICE_OF_ONE = 0.01, 0.04
"""Share of the bytes that the second attempt must save, about, the third twice as much and so on, of a GOP; and that
each must save of a frame by itself, which must be quick."""
# Logarithm of what a step is aimed below the bound; more after each miss and each doubtful frame over it.
SPARE = 0.02
SLOPE = 0.5  # the power of the step that bytes fall by, about
TWIN_STEP, TWIN = 1 / 16, 1.005
"""A step, in reaches, far below which frames are the same; and how much worse than another one may look."""
EVENING, LEAST_LOOK, WIDEST = 1.6, 0.1, 1.4
"""Power of looks by which the first attempt weighs frames, the k-th by 1 / k of it; the least look that counts,
relative to the largest; and the largest logarithm of a weight."""
# Smooths weights, whose quick changes are dear in the temporal basis.
BELL = (1 / 16, 4 / 16, 6 / 16, 4 / 16, 1 / 16)
RELIEF = 0.35  # share of the largest change of a weight by which the excess falls, about
TRIES, HELD = 20, 2  # attempts, and how many of them are held that seem to keep the promise
DRAWING = 0.03  # share of the remaining time that pictures of a frame take; measured
# The finest step, and what steps shrink by at least once all attempts have failed.
LEAST_STEP, FINER = 1e-7, 0.8
COPIES_APART = 2.0**-22
"""How far copies of a vertex are drawn apart, as a share of the extent, so that they are not shaded as one: a few steps
of the grid on which a picture joins vertices."""
# Bytes of a `LookMetric` for each sample along the side of its pictures, squared.
_PIXEL = 4 * 6 / 16


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

    def __init__(
        self,
        frames: Positions,
        faces: Faces,
        promise: Contract,
        units: Units,
        threads: int | None,
        progress: Nearing | None = None,
    ) -> None:
        self._progress = progress or Nearing(None)
        self._frames, self._faces, self._promise, self._threads = frames, faces, promise, threads
        self._units, self._reach = (
            units,
            promise.reach(1.0, units.scale if promise.absolute else 1.0),
        )
        self._metrics: dict[int, LookMetric] = {}
        self._room = KEPT
        self._knots: set[int] = set()
        self._ratios: dict[int, float] = {}
        self.worst_look = 0.0  # of the frames that were drawn of the returned encoding
        if promise.look < math.inf:
            self._foresight = Foresight(faces)
            self._sides = [sides_of(frame) for frame in frames]
            # Captured motion rests for many frames, which look the same and need be drawn once.
            self._twins = same_frames(frames, (), TWIN_STEP * self._reach)
            self._knots.update(
                np.linspace(0, len(frames) - 1, min(KNOTS, len(frames)))
                .round()
                .astype(int)
                .tolist()
            )

    def run(
        self,
        encode: Callable[[float, Matrix], Found],
        first: float,
        finest: float,
        *,
        weighed: bool,
    ) -> Found:
        """Return the smallest encoding that keeps the promise in every frame; `encode` takes step and weights."""
        weighed = weighed and len(self._frames) > 1 and bool(self._knots)
        candidates: list[Tried[Found]] = []  # the smallest that seem to keep the promise
        step, evened, missed, above, spare = first, np.zeros(len(self._frames)), 0, math.inf, SPARE
        for attempt in range(1, TRIES + 1):
            price = PRICE * attempt if len(self._frames) > 1 else PRICE_OF_ONE
            # Beyond these, levels do not fit, or nothing is left of the motion.
            step = min(max(step, finest), COARSEST_STEP)
            try:
                latest = self._tried(encode, step, evened)
            except OptionError:
                break  # with weights, levels may not fit, either
            missed = missed + 1 if latest.excess > 0.0 else 0
            if missed and not weighed:  # weights may make good what missed
                above = min(above, step)
            # By bytes and not by steps: with weights, a finer step may give the smaller stream.
            candidates = self._by_size([latest, *candidates])
            while True:
                margin = spare if weighed else spare * (1 + missed)
                step, evened = self._following(latest, attempt if weighed else 0, margin)
                step = min(step, math.sqrt(latest.step * above))
                last = latest.step == (COARSEST_STEP if latest.excess <= 0.0 else finest)
                # What the next attempt would take, about. It is made only if it can save more than its price.
                likely = latest.gops.size * (latest.step / step) ** SLOPE
                if not candidates or not (
                    last or attempt == TRIES or likely > (1.0 - price) * candidates[0].gops.size
                ):
                    break
                # Only here are all doubtful frames drawn: once, for the stream that would be returned.
                if self._is_certain(candidates[0]):
                    return candidates[0].gops
                # Expected looks were too low once, and may be again; the others are expected anew.
                latest, missed, spare = candidates[0], 1, spare + SPARE
                candidates = self._by_size(candidates[1:])
            if last:
                break
        certain = (tried.gops for tried in candidates if self._is_certain(tried))
        return next(certain, None) or self._finer(encode, min(max(step, finest), COARSEST_STEP))

    def _tried(
        self, encode: Callable[[float, Matrix], Found], step: float, evened: Matrix
    ) -> Tried[Found]:
        gops = encode(step, np.exp(evened))
        return Tried(gops, step, evened, self._measure(list(gops.decoded_frames())))

    def _by_size(self, attempts: list[Tried[Found]]) -> list[Tried[Found]]:
        """Return those that seem to keep the promise, by the looks known now; the smallest first."""
        for tried in attempts:
            tried.measured.before = tried.measured.before | self._ratios
        return sorted(
            (tried for tried in attempts if tried.excess <= 0.0), key=lambda tried: tried.gops.size
        )[:HELD]

    def _finer(self, encode: Callable[[float, Matrix], Found], step: float) -> Found:
        """Return the first encoding, with finer and finer steps, that keeps the promise."""
        with suppress(OptionError):  # levels do not fit
            while step >= LEAST_STEP:
                tried = self._tried(encode, step, np.zeros(len(self._frames)))
                if self._is_certain(tried):
                    return tried.gops
                step *= min(FINER, math.exp(-tried.excess / POWER))
        raise TargetError(
            f"{self._promise} cannot be kept in every frame, even with step {step:.2g}"
        )

    def _following(self, tried: Tried[Found], attempt: int, spare: float) -> tuple[float, Matrix]:
        """The step after one that was tried, and weights; they stay if the `attempt` is 0."""
        change = np.zeros(len(tried.evened))
        if attempt:
            shares = np.maximum(tried.measured.looks(), tried.measured.distances)
            # Less with each attempt, or weights would swing from frame to frame for ever.
            change = EVENING * _evening(shares) / attempt
        evened = (tried.evened + change).clip(-WIDEST, WIDEST)
        relief = RELIEF * float((evened - tried.evened).max())
        if attempt > 1 and tried.excess > 0.0:
            relief = 0.0  # weights have brought less than was expected of them
        return tried.step * math.exp(relief - tried.excess - spare), evened

    def _measure(self, decoded: Sequence[Matrix]) -> Measured:
        """Measure all frames, and draw those that may be the worst."""
        pairs = list(zip(self._frames, decoded, strict=True))
        distances = np.sqrt([squares_of(one - two).max() for one, two in pairs]) / self._reach
        if not self._knots:
            return Measured(distances, np.zeros(0), {})
        # Foreseen looks follow the drawn ones closely and cost a twentieth of them.
        versions = zip(self._frames, decoded, self._sides, strict=True)
        looks = ordered_map(lambda version: self._foresight.look(*version), versions, self._threads)
        foreseen = np.array(list(looks)).clip(1e-12)
        knots = () if self._ratios else self._knots
        measured = Measured(
            distances,
            foreseen,
            {index: self._look(index, decoded) for index in knots},
            self._ratios,
        )
        while (index := int(measured.looks(LIKELY).argmax())) not in measured.drawn:
            measured.drawn[index] = self._look(index, decoded)
        self._ratios = measured.ratios
        return measured

    def _is_certain(self, tried: Tried[Found]) -> bool:
        """Whether an encoding keeps the promise; frames that may exceed the bound are drawn until one does."""
        # Frames that earlier attempts drew tell where to look; they prove nothing of this one, which has another step.
        measured = replace(tried.measured, before={})
        decoded = list(tried.gops.decoded_frames())
        for knot in sorted(self._knots - measured.drawn.keys()):
            if measured.largest <= 1.0:
                measured.drawn[knot] = self._look(knot, decoded)
        while measured.largest <= 1.0 and (doubtful := measured.doubtful) is not None:
            measured.drawn[doubtful] = self._look(doubtful, decoded)
        self._ratios = tried.measured.ratios
        shares = (share for frame, share in measured.drawn.items() if self._twins[frame] == frame)
        self.worst_look = self._promise.look * max(shares, default=0.0)
        return measured.largest <= 1.0

    def _look(self, index: int, decoded: Sequence[Matrix]) -> float:
        """Return the look of a frame as a share of the bound; 0 if nothing of it is seen."""
        twin = int(self._twins[index])
        # Equal pictures need not be drawn twice. The little more keeps the twin from setting the pace.
        if twin != index and np.array_equal(decoded[twin], decoded[index]):
            return TWIN * self._look(twin, decoded)
        # As users have them: where two normals are nearly a crease apart, rounding decides how they are shaded.
        original = self._units.back(self._frames[index])
        metric = self._metrics.get(index) or metric_of(original, self._faces, self._threads)
        if metric is None:
            return 0.0
        size = int(_PIXEL * metric.pixels**2)
        # Pictures of originals take megabytes each; the first ones are the knots, which every attempt draws.
        if index not in self._metrics and size <= self._room:
            self._room -= size
            self._metrics[index] = metric
        look = metric.look(self._units.back(decoded[index])).moving
        self._progress.by(DRAWING)
        return look / self._promise.look


@dataclass(frozen=True, eq=False)
class Tried(Generic[Found]):
    """Frames encoded with a step, and with weights of which these are the logarithms, and measured."""

    gops: Found
    step: float
    evened: Matrix
    measured: Measured

    @property
    def excess(self) -> float:
        return self.measured.excess


@dataclass(eq=False)
class Measured:
    """Measurements of the frames of one attempt, as shares of their bounds; `foreseen` are looks without pictures."""

    distances: Matrix
    """Of the farthest vertex of each frame."""
    foreseen: Matrix
    drawn: dict[int, float]
    before: dict[int, float] = field(default_factory=dict)
    """Logarithms of looks over foreseen ones, of frames that earlier attempts drew."""

    @property
    def farthest(self) -> float:
        return float(self.distances.max())

    @property
    def excess(self) -> float:
        """Logarithm of the largest share, drawn or expected."""
        return math.log(max(self.farthest, float(self.looks().max(initial=1e-9))))

    @property
    def largest(self) -> float:
        """The largest share that is known and not only expected: few frames tell little of the others."""
        return max(self.farthest, *self.drawn.values(), 0.0)

    @property
    def doubtful(self) -> int | None:
        """The frame that may exceed the bound most of those not drawn; None if none may."""
        most = self.looks(DEVIATIONS)
        if self.drawn:
            most[self.foreseen.argmax()] = 2.0  # the verification draws this frame, too
        most[list(self.drawn)] = 0.0
        return int(most.argmax()) if most.max(initial=0.0) > 1.0 else None

    @property
    def ratios(self) -> dict[int, float]:
        """Logarithms of looks over foreseen ones, of all frames that were ever drawn."""
        now = {
            index: math.log(share / self.foreseen[index])
            for index, share in self.drawn.items()
            if share > 0.0
        }
        return {**self.before, **now}

    def looks(self, deviations: float = 0.0) -> Matrix:
        """Return the looks of all frames, shape (T,), expected ones of those not drawn plus standard deviations."""
        if not (drawn := sorted(self.ratios.items())):
            return np.zeros(len(self.foreseen))
        numbers, ratios = (np.array(column) for column in zip(*drawn))
        doubts = np.where(np.isin(numbers, list(self.drawn)), 0.0, DRIFT**2)
        mean, variance = _foretold(numbers, ratios, doubts, len(self.foreseen))
        looks = self.foreseen * np.exp(mean + deviations * np.sqrt(variance))
        looks[list(self.drawn)] = list(self.drawn.values())
        return np.asarray(looks)


def _foretold(numbers: Matrix, ratios: Matrix, doubts: Matrix, count: int) -> tuple[Matrix, Matrix]:
    """The mean and variance of a series of numbers, shape (T,), of which some were seen, each with a variance of its
    own: noise on a random walk (kriging)."""
    steps, frames = np.diff(numbers), np.arange(count)
    # By maximum likelihood of the differences of neighbors.
    size, jumps = len(steps), np.diff(ratios)
    spreads = np.diag(2.0 + PACE * steps) - np.eye(size, k=1) - np.eye(size, k=-1)
    noise = (LIKE_SEEN * NOISE**2 + jumps @ np.linalg.solve(spreads, jumps)) / (LIKE_SEEN + size)
    apart = np.abs(numbers[:, None] - frames)
    # Generalized covariances of a walk that begins anywhere; the last row is of its unknown mean.
    shared = np.vstack([noise * ((apart == 0) - PACE * apart), np.ones(count)])
    system = np.pad(shared[:-1, numbers] + np.diag(doubts), (0, 1), constant_values=1.0)
    system[-1, -1] = 0.0
    weights = np.linalg.solve(system, shared)
    return ratios @ weights[:-1], np.maximum(noise - (weights * shared).sum(axis=0), 0.0)


def _evening(looks: Matrix) -> Matrix:
    """Return logarithms of weights of frames, shape (T,), with which all of them look about alike."""
    logarithms = np.log(np.maximum(looks, LEAST_LOOK * looks.max(initial=0.0) or 1.0))
    smooth = np.convolve(np.pad(logarithms, len(BELL) // 2, mode="edge"), BELL, mode="valid")
    return np.asarray(smooth - smooth.mean())


def _with_copies_apart(frame: Positions) -> Positions:
    """Return a frame whose vertices at one place are hardly apart.

    Vertices that a run keeps apart, for instance since their colors differ, are coded and shaded apart.
    """
    index = group_rows(np.ascontiguousarray(frame, np.float64))
    if index[-1] == len(index) - 1:
        return frame  # no vertex is a copy
    counts = np.bincount(index)
    rank = np.empty(len(index), np.int64)
    rank[np.argsort(index, kind="stable")] = np.arange(len(index)) - np.repeat(
        np.cumsum(counts) - counts, counts
    )
    apart = COPIES_APART * np.ptp(frame, axis=0).max(initial=0.0)
    return np.asarray(frame + (apart * rank)[:, None])


# A frame of an explosion may show nothing, and then no step is too wide for it.
def metric_of(frame: Positions, faces: Faces, threads: int | None = None) -> LookMetric | None:
    """Return the metric of an original frame, or None if nothing of it is seen."""
    try:
        return LookMetric(TriangleMesh(_with_copies_apart(frame), faces), threads=threads)
    except MeshError:
        return None
