"""The widest step with which every frame keeps a promise; no part of the format."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import Protocol, TypeVar

import numpy as np

from bsm.bitstream.errors import MeshError, TargetError
from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import LookMetric
from bsm.codec.look.pictures import MOST_PIXELS
from bsm.codec.sequence.frames import same_frames
from bsm.codec.sequence.options import Promise
from bsm.codec.sequence.row_prediction import ROUNDS
from bsm.codec.static.targets import COARSEST_STEP, secant
from bsm.codec.threads import ordered_map

KNOTS = 10  # frames, evenly over a GOP, that small pictures are drawn of at every attempt, beside those that were large
LOOKS = 0.5  # what a frame that is in doubt takes: what is seen of one settles others
SMALL = 256  # pixels of the side of these
COARSENESS = 0.03  # how far what is seen in them is off at least, in logarithms, scaled by what is seen in large ones
MORE = 1  # frames that seem the worst, drawn large at every attempt
PARTS = 3  # of a GOP, of which one frame each is drawn large before it is done with
DEVIATIONS = 4.0
"""Standard deviations: an attempt is accepted once all frames that may exceed the bound within them are drawn."""
KEPT = 1 << 27  # bytes of pictures of originals that are kept from attempt to attempt
SLACK, SLACK_OF_ONE = 0.04, 0.15
"""Part of a bound that may be left, in a GOP and in a frame by itself, which must be quick."""
ROUGH = 0  # rounds over levels in a first attempt, which only tells what weights frames need: less than half the time
FINER = 0.1  # by how much that seems better than it is, since its levels were chosen whatever they cost
POWERS, PRIOR = (0.7, 2.0), 0.01
"""What pictures show grows with such powers of what normals let expect; and the squares that are for a power of 1."""
SLOPE = 0.7  # power of the step with which the look distance grows
EVENING, SMOOTHNESS = 1.2, 2.0
"""Frames are weighed by this power of what would make all look alike if errors were as weights ask, smoothed over
several frames: weights that change quickly are dear in the temporal basis."""
AGAIN, ALONE, YIELD = 0.5, 6.0, 0.15
"""Powers of weights from a second look, and for single frames at the end, and that by which errors follow weights."""
LEAST = 1e-3  # excess that is left of one, whatever other weights let expect
WIDEST = 1.4  # logarithm of the largest weight, and of one over the smallest
TWIN_STEP, TWIN = 1 / 16, 1.005
"""A step, in reaches, far below which frames are the same; and how much worse than another one may look."""
TRIES = 20
_PIXEL = 4 * 6 / 16  # bytes of a `LookMetric` for each sample along the side of its pictures, squared


class Candidate(Protocol):
    """Frames that were encoded with some step."""

    @property
    def decoded(self) -> Positions:
        """The decoded frames, shape (T, n, 3)."""


Found = TypeVar("Found", bound=Candidate)


class StepSearch:
    """Looks for the widest step with which the frames of a GOP keep a promise."""

    def __init__(
        self,
        frames: Positions,
        faces: Faces,
        promise: Promise,
        scale: float,
        threads: int | None,
        drawn: Callable[[float], None] = lambda share: None,
    ) -> None:
        self._drawn, self._begun = drawn, time.perf_counter()
        self._frames, self._faces, self._promise, self._threads = frames, faces, promise, threads
        self._reach = promise.reach(scale)
        self._metrics: dict[tuple[int, int], LookMetric | None] = {}
        self._power = 0.0  # of what normals let expect, that pictures show; unknown before the first attempt
        self._scales: dict[int, float] = {}  # by frames: logarithms of what large pictures show over what small ones do
        self._room = KEPT
        self._knots: list[int] = []
        self._twins = np.arange(len(frames))  # the first frame that each is the same as, as in loops
        self._looked: tuple[Positions, dict[tuple[int, int], float]] = frames, {}  # what was seen of decoded ones
        if promise.look < math.inf:
            self._twins = same_frames(frames, (), TWIN_STEP * self._reach)
            self._knots = np.linspace(0, len(frames) - 1, min(KNOTS, len(frames))).round().astype(int).tolist()

    def run(self, encode: Callable[[float, Matrix | None, int], Found], first: float, finest: float) -> Found:
        """What keeps the promise in every frame with little to spare; `encode` takes step, weights and rounds."""
        weights: Matrix | None = None
        many = len(self._frames) > 1
        slack = SLACK if many else SLACK_OF_ONE
        first = min(max(first, finest), COARSEST_STEP)
        if self._knots and many:
            measured = self._measure(encode(first, None, ROUGH).decoded)
            weights = _evening(measured.shares)
            first = _finer(first, measured.excess + FINER, slack)
        kept: tuple[float, Measured, Positions, Found] | None = None
        least, evened = math.inf, False

        def excess(step: float) -> float:
            nonlocal kept, least, weights, evened
            least = min(least, step)
            found = encode(step, weights, ROUNDS)
            decoded = found.decoded
            measured = self._measure(decoded)
            if measured.excess <= 0.0 and (kept is None or step > kept[0]):
                kept = step, measured, decoded, found
            if weights is None or evened or -slack < measured.excess <= 0.0:
                return measured.excess
            evened, more = True, _evening(measured.shares) ** AGAIN
            weights = weights * more
            expected = math.log(max(measured.farthest, float((measured.shares * more**-YIELD).max(initial=1e-9))))
            return max(expected, LEAST) if measured.excess > 0.0 else expected

        secant(excess, first, finest, COARSEST_STEP, TRIES, SLOPE, slack)
        for _ in range(TRIES if kept else 0):
            assert kept is not None
            step, measured, decoded, found = kept
            self._draw_doubtful(measured, decoded)
            if measured.excess <= 0.0:
                return found
            least = step
            if step <= finest:
                break
            if weights is not None:  # a few frames are worse than they seemed, and cost less by themselves
                weights = weights * _evening(measured.shares.clip(1.0)) ** ALONE
            step = max(_finer(step, measured.excess, slack), finest)
            found = encode(step, weights, ROUNDS)
            decoded = found.decoded
            kept = step, self._measure(decoded), decoded, found
        raise TargetError(f"{self._promise} cannot be kept in every frame, even with step {least:.2g}")

    def _measure(self, decoded: Positions) -> Measured:
        """How the frames look, by small pictures of those all over the GOP, and large ones of what seems the worst."""
        pairs = list(zip(self._frames, decoded, strict=True))
        farthest = max(_kernels.farthest_apart(*map(np.ascontiguousarray, pair)) for pair in pairs) / self._reach
        if not self._knots:
            return Measured(farthest, np.zeros(0), {})
        wrong = ordered_map(lambda pair: shading_error(*pair, self._faces), pairs, self._threads)
        errors = np.array(list(wrong)).clip(1e-12)
        small = {index: self._look(index, decoded, SMALL) for index in self._knots} if len(pairs) > 1 else {}
        self._power = self._power or _power_of(errors[list(small)], np.array(list(small.values())))
        measured = Measured(farthest, errors**self._power, {}, small, self._scales)
        if not self._scales:
            self._draw(max(small, key=small.__getitem__, default=0), measured, decoded)
        for _ in range(MORE):
            self._draw(int(measured.shares.argmax()), measured, decoded)
        self._knots = sorted({*self._knots, *measured.drawn})
        return measured

    def _draw(self, index: int, measured: Measured, decoded: Positions) -> None:
        """Look at a large picture of a frame."""
        if index not in measured.drawn:
            share = measured.drawn[index] = self._look(index, decoded)
            if share and measured.small.get(index):
                self._scales[index] = math.log(share / measured.small[index])

    def _draw_doubtful(self, measured: Measured, decoded: Positions) -> None:
        """Draw frames that may be worse than the bound: small, and large where that leaves a doubt; and of each part of
        a GOP the worst, large, since what small ones hide may change."""
        for part in np.array_split(np.array(self._knots, np.int64), PARTS):
            if len(part) and measured.excess <= 0.0:
                self._draw(int(part[measured.shares[part].argmax()]), measured, decoded)
        if len(measured.errors) and measured.excess <= 0.0:
            self._draw(int(measured.errors.argmax()), measured, decoded)  # which the verification will look at, too
        begin = time.perf_counter()
        for looks in count(1):
            if measured.excess > 0.0 or (index := measured.doubtful) is None or not measured.most[index] > 1.0:
                break
            if index in measured.small or len(decoded) == 1 or not measured.may_settle_small(index):
                self._draw(index, measured, decoded)
            else:
                measured.small[index] = self._look(index, decoded, SMALL)
            now, left = time.perf_counter(), LOOKS * np.count_nonzero(measured.most > 1.0)
            self._drawn((now - self._begun) / (now - self._begun + left * (now - begin) / looks))
        self._knots = sorted({*measured.small, *measured.drawn})

    def _look(self, index: int, decoded: Positions, most_pixels: int = MOST_PIXELS) -> float:
        """Share of the bound; 0 for an invisible frame. Repeated frames are drawn once."""
        if self._looked[0] is not decoded:
            self._looked = decoded, {}
        twin, looked = int(self._twins[index]), self._looked[1]
        if twin != index and not np.array_equal(decoded[twin], decoded[index]):
            twin = index
        if (twin, most_pixels) not in looked:
            looked[twin, most_pixels] = self._seen((twin, most_pixels), decoded[twin])
        return looked[twin, most_pixels] * (1.0 if twin == index else TWIN)

    def _seen(self, key: tuple[int, int], decoded: Matrix) -> float:
        if key not in self._metrics:
            metric = self._metric(*key)
            held = int(_PIXEL * metric.pixels**2) if metric else 0
            if held <= self._room:
                self._room -= held
                self._metrics[key] = metric
        else:
            metric = self._metrics[key]
        if metric is None:
            return 0.0
        return metric.look(decoded).moving / self._promise.look

    def _metric(self, index: int, most_pixels: int) -> LookMetric | None:
        """None for a frame of which nothing is seen."""
        mesh = TriangleMesh(self._frames[index], self._faces)
        try:
            return LookMetric(mesh, threads=self._threads, most_pixels=most_pixels)
        except MeshError:
            return None


@dataclass(eq=False)
class Measured:
    """Measurements of the frames of one attempt, as shares of their bounds."""

    farthest: float
    errors: Matrix
    drawn: dict[int, float]
    small: dict[int, float] = field(default_factory=dict)
    scales: dict[int, float] = field(default_factory=dict)

    @property
    def coarseness(self) -> float:
        """Error of the look in small pictures, in logarithms: half of the variance from scale to scale."""
        apart = np.diff([self.scales[index] for index in sorted(self.scales)])
        return max(COARSENESS, math.sqrt(float(np.mean(apart**2)) / 2.0)) if len(apart) else COARSENESS

    @property
    def excess(self) -> float:
        """Logarithm of the largest share, drawn or expected."""
        return math.log(max(self.farthest, float(self.shares.max(initial=1e-9))))

    @property
    def shares(self) -> Matrix:
        """Looks of all frames, shape (T,): measured if drawn, else expected."""
        return self._expected(0.0)

    @property
    def most(self) -> Matrix:
        """Upper estimates of the looks, shape (T,)."""
        return self._expected(DEVIATIONS)

    def may_settle_small(self, index: int) -> bool:
        """Whether a small picture of a frame, as it probably is, leaves no doubt that the bound is kept."""
        expected, most = math.log(max(self.shares[index], LEAST)), math.log(max(self.most[index], LEAST))
        return expected + DEVIATIONS * self.coarseness <= (most - expected) / DEVIATIONS

    @property
    def doubtful(self) -> int | None:
        """The frame that may be the worst of those not drawn; None if all are, or none needs to be."""
        most = self.most
        most[list(self.drawn)] = 0.0
        return int(most.argmax()) if most.any() else None

    def _expected(self, deviations: float) -> Matrix:
        """Return the expected looks plus a number of standard deviations."""
        shares, scaled = self.errors.copy(), sorted(self.scales) or [0]
        scales = np.exp(np.interp([*self.small], scaled, [self.scales.get(index, 0.0) for index in scaled]))
        known = {
            index: share * scale for (index, share), scale in zip(self.small.items(), scales, strict=True)
        } | self.drawn
        seen = np.array(sorted(index for index, share in known.items() if share > 0.0), np.int64)
        if len(seen):
            ratios = np.log([known[index] for index in seen]) - np.log(self.errors[seen])
            steps = np.diff(seen)
            rate = float(np.mean(np.diff(ratios) ** 2 / steps)) if len(steps) else 1.0
            frames, coarse = np.arange(len(shares)), [self.coarseness * (index not in self.drawn) for index in seen]
            off = np.interp(frames, seen, coarse)
            since = frames - seen[np.maximum(np.searchsorted(seen, frames, side="right") - 1, 0)]
            until = seen[np.minimum(np.searchsorted(seen, frames), len(seen) - 1)] - frames
            inside = np.minimum(since, until) >= 0
            spans = np.where(inside, since * until / np.maximum(since + until, 1), np.maximum(since, until))
            shares *= np.exp(np.interp(frames, seen, ratios) + deviations * np.sqrt(rate * spans + off**2))
        else:
            shares[:] = 0.0
        for index, share in self.drawn.items():
            shares[index] = share
        return shares


def _finer(step: float, excess: float, slack: float) -> float:
    """A step that is expected to take so much excess away."""
    return step * math.exp(-(min(excess, 3.0) + slack / 2.0) / SLOPE)


def _power_of(errors: Matrix, shares: Matrix) -> float:
    """The power of errors, shape (k,), that shares grow with."""
    seen = shares > 0.0
    if np.count_nonzero(seen) < 3:
        return 1.0
    log_errors, log_shares = (np.log(values[seen]) - np.log(values[seen]).mean() for values in (errors, shares))
    return float(np.clip((log_errors @ log_shares + PRIOR) / (log_errors @ log_errors + PRIOR), *POWERS))


def _evening(shares: Matrix) -> Matrix:
    """Weights of frames, shape (T,), with which all of them would look about alike."""
    logarithms = np.log(np.maximum(shares, 1e-3 * shares.max() or 1.0))  # of faces without area nothing is seen
    reach = int(4.0 * SMOOTHNESS)
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / SMOOTHNESS) ** 2)
    padded = np.pad(EVENING / SLOPE * (logarithms - logarithms.mean()), reach, mode="edge")
    weights = np.convolve(padded, bell / bell.sum(), mode="valid")
    evening: Matrix = np.exp(np.clip(weights - weights.mean(), -WIDEST, WIDEST))
    return evening


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
