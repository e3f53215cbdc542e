"""Looking after promises: the step that is just fine enough for every frame. The encoder's own business."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Protocol, TypeVar

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.sparse import csr_array

from bsm.bitstream.errors import MeshError, TargetError
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import Looker
from bsm.codec.sequence.promise import Promise
from bsm.codec.static.targets import COARSEST_STEP

KNOTS = 10
"""Frames, evenly over a GOP, that pictures are drawn of at every attempt."""
SPACING = 8
"""If all is well there, one in so many frames is drawn."""
MORE = 3
"""Frames that are added to them: those of which the worst is expected."""
MARGIN = 1.1
"""A frame that is not drawn is expected to look so much worse than its normals and its drawn neighbours say: in 350
frames of two dancers, none was off by more when one in eight was drawn."""
NEAR = 0.8
"""Before an attempt is taken, all frames are drawn that are expected to come nearer to the bound: motion that changes
within `SPACING` frames was off by 1.15 margins."""
SLACK, SLACK_OF_ONE = 0.04, 0.15
"""Part of a bound that may be left, in a GOP and in a frame by itself, which must be quick."""
SLOPE, SLOPES = 0.7, (0.4, 2.5)
"""What is seen grows with about this power of the step; and the range of what two attempts may say about it."""
EVENING, SMOOTHNESS = 0.8, 2.0
"""Frames are weighed by this power of what would make all look alike, smoothly over so many frames: weights that
change quickly are dear in the temporal basis."""
WIDEST = 1.0
"""Logarithm of the largest weight, and of one over the smallest."""
_TRIES = 20


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
        self._shares: Matrix = np.zeros(len(frames))
        if promise.look < math.inf:
            self._shading = Shading(frames[0], faces)
            for index in np.linspace(0, len(frames) - 1, min(KNOTS, len(frames))).round().astype(int).tolist():
                self._lookers[index] = self._looker(index)

    def settle(self, attempt: Callable[[float, Matrix | None], Found], first: float, finest: float) -> Found:
        """What keeps the promise in every frame with little to spare.

        Parameters
        ----------
        attempt : callable
            Encodes with a step, and with weights of frames, shape (T,), if there are any: what a frame's errors count.
        first, finest : float
            The step to try first, and the last one.

        Raises
        ------
        TargetError
            If no step down to `finest` keeps it.
        """
        low, high = math.log(finest), math.log(COARSEST_STEP)
        at = min(max(math.log(first), low), high)
        weights = None
        if self._lookers and len(self._frames) > 1:
            excess = self._excess(attempt(math.exp(at), None).decoded)
            weights = self._evening()
            at = min(max(at - (min(excess, 3.0) + SLACK / 2) / SLOPE, low), high)
        slack = SLACK if len(self._frames) > 1 else SLACK_OF_ONE
        kept: tuple[float, float, Found] | None = None  # logarithms of step and excess
        broken: tuple[float, float] | None = None
        before: tuple[float, float] | None = None
        for tries in range(_TRIES):
            found = attempt(math.exp(at), weights)
            excess = self._excess(found.decoded)
            if excess <= 0.0 and (kept is None or at > kept[0]):
                kept = at, excess, found
            elif excess > 0.0 and (broken is None or at < broken[0]):
                broken = at, excess
            if kept is None and at <= low:
                break
            if kept is not None and (kept[1] > -slack * (1 + tries / 4) or at >= high):
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
        at, _, found = kept
        if len(self._frames) == 1:
            return found  # it was drawn, if looks are promised
        for _ in range(_TRIES):
            excess = self._excess_of_near(found.decoded)
            if excess <= 0.0:
                return found
            if at <= low:
                break
            at = max(at - (excess + slack / 2) / SLOPE, low)
            found = attempt(math.exp(at), weights)
        raise self._refusal(math.exp(at))

    def _refusal(self, step: float) -> TargetError:
        return TargetError(f"{self._promise} in every frame cannot be kept, not even with a step of {step:.2g}")

    def _evening(self) -> Matrix:
        """Weights of frames with which all of them would look about alike."""
        shares = np.log(np.maximum(self._shares, 1e-3 * self._shares.max()))
        weights = gaussian_filter1d(EVENING / SLOPE * (shares - shares.mean()), SMOOTHNESS, mode="nearest")
        evening: Matrix = np.exp(np.clip(weights - weights.mean(), -WIDEST, WIDEST))
        return evening

    def _excess(self, decoded: Positions) -> float:
        """Logarithm of the largest share of a bound, of farthest vertices and looks of all frames."""
        farthest = max(float(np.square(a - b).sum(axis=1).max()) for a, b in zip(self._frames, decoded, strict=True))
        worst = math.sqrt(farthest) / self._reach
        if self._lookers:
            worst = max(worst, self._worst_look(decoded))
        return math.log(max(worst, 1e-9))

    def _worst_look(self, decoded: Positions) -> float:
        """The largest share of the bound of looks, drawn or expected; a few of the worst expected ones are drawn."""
        pairs = zip(self._frames, decoded, strict=True)
        errors = np.array([self._shading.error(own, other) for own, other in pairs]).clip(1e-12)
        drawn = {index: self._look(looker, decoded[index]) for index, looker in self._lookers.items()}

        def draw(index: int) -> None:
            self._lookers[index] = self._looker(index)
            drawn[index] = self._look(self._lookers[index], decoded[index])

        if 1.0 - 2.0 * SLACK < _expected(errors, drawn).max() <= 1.0:
            for index in range(0, len(errors), SPACING):
                if index not in drawn:
                    draw(index)
            for _ in range(MORE):
                worst = int(_expected(errors, drawn).argmax())
                if worst not in drawn:
                    draw(worst)
        self._shares = _expected(errors, drawn)
        return float(self._shares.max())

    def _excess_of_near(self, decoded: Positions) -> float:
        """`_excess`, once all frames are drawn that come near the bound; up to the first one that is beyond it."""
        worst = self._excess(decoded)
        near = [index for index in np.argsort(-self._shares).tolist() if self._shares[index] > NEAR]
        for index in near:
            if worst > 0.0:
                break
            if index not in self._lookers:
                looker = self._looker(index)
                share = self._look(looker, decoded[index])
                if share > 1.0:
                    self._lookers[index] = looker
                    worst = math.log(share)
        return worst

    def _looker(self, index: int) -> Looker | None:
        """None for a frame of which nothing is seen."""
        try:
            return Looker(TriangleMesh(self._frames[index], self._faces), threads=self._threads)
        except MeshError:
            return None

    def _look(self, looker: Looker | None, decoded: Positions) -> float:
        """Share of the bound."""
        return 0.0 if looker is None else looker.look(decoded).moving / self._promise.look


def _expected(errors: Matrix, drawn: Mapping[int, float]) -> Matrix:
    """Shares of the bound: of frames that were drawn as they are, of others by their errors of normals, and more."""
    index = np.array(sorted(drawn))
    found = np.array([drawn[k] for k in index])
    shares: Matrix = MARGIN * errors * np.interp(np.arange(len(errors)), index, found / errors[index])
    shares[index] = found
    return shares


class Shading:
    """How faces are shaded, for a measure that is much cheaper than pictures: by normals of vertices alone."""

    def __init__(self, positions: Positions, faces: Faces) -> None:
        self._faces = faces
        count = len(positions)
        corners = np.ones(faces.size), (faces.ravel(), np.repeat(np.arange(len(faces)), 3))
        self._around = csr_array(corners, shape=(count, len(faces)))

    def error(self, original: Positions, decoded: Positions) -> float:
        """How far normals of vertices of `decoded` are off those of `original`, both of shape (n, 3).

        That is the root of 1 - cosine, mean by area.
        """
        (own, areas), (other, _) = self._normals(original), self._normals(decoded)
        cosines = np.minimum(np.einsum("ij,ij->i", own, other), 1.0)
        total = float(areas.sum())
        return float(areas @ np.sqrt(1.0 - cosines)) / total if total else 0.0

    def _normals(self, positions: Positions) -> tuple[Matrix, Matrix]:
        """Normals of vertices, shape (n, 3), with the areas around them, shape (n,)."""
        a, b, c = (positions[self._faces[:, k]] for k in range(3))
        crosses = np.cross(b - a, c - a)
        sums = self._around @ crosses
        lengths = np.sqrt(np.einsum("ij,ij->i", sums, sums))[:, None]
        unit = np.divide(sums, lengths, out=np.zeros_like(sums), where=lengths > 0.0)
        return unit, self._around @ np.sqrt(np.einsum("ij,ij->i", crosses, crosses))
