"""Errors of a decoded mesh as shares of a contract; measurements of its original, made once."""

import math
from collections.abc import Callable
from copy import copy
from functools import lru_cache, partial
from typing import NamedTuple
from weakref import ReferenceType

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Matrix, Order, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh, extent_of, squares_of
from bsm.codec.geometry.metrics import face_geometry, nearest_points
from bsm.codec.look.measure import LookMetric
from bsm.codec.look.pictures import Normals
from bsm.codec.progress import Nearing
from bsm.codec.static.choice.shaping import Shaper
from bsm.codec.static.choice.trials import Trial
from bsm.codec.static.preamble_encoding import Draft, Prepared
from bsm.codec.static.targets import ANY_ANGLE, SLACK, Contract

BOUNDS = "vertex error", "normal error", "visual error", "look"
COARSEST, SEEN = 0.05, 1.0 / 32.0
"""Largest step, in BSM units; and about the one, in mean edges, at which rounding has a look of 1."""
# Share of a bound below which all is as good as it can be; rounding of measures adds less.
LEAST = 1e-6
# Steps that a vertex may be off where its place is chosen: farther ones stand out as spikes.
SPIKE = 4.0
FINEST_PART = 0.1
"""No part is bound more tightly than this, over the bound of the whole: where that is 1 % of the diagonal, it is half a
pixel in a picture of 512. Of a gap between parts, as much is left."""
FLAT = 1e-9  # area of a face that has none, over the square of its longest side
# The widest look with which no face loses its area; one in so many with wider ones.
NO_FACE_LOST, FEW_LOST = 0.5, 200
SLIVERS = 2e-3  # of the faces: so many edges may fold on a grid
DRAWING = 0.06  # share of the remaining time that pictures of the original take; measured
PIECE = 1 << 15  # faces that are looked at together
MOST_PARTS = 64  # of more parts than these, none is asked how near it is to others


class Measures:
    """Measurements of an original, made once for all contracts; `alike`: angles count all faces alike; `shown`:
    pictures of the mesh for which this one stands."""

    def __init__(
        self,
        prepared: Prepared,
        threads: int | None,
        normals: Normals | None = None,
        *,
        alike: bool = False,
        progress: Nearing | None = None,
        drawn: LookMetric | None = None,
    ) -> None:
        self.prepared = prepared
        if alike:
            self.original = prepared.reference.alike
        else:
            self.original = prepared.reference.by_area
        self.shaper = Shaper(self.original, prepared.graph)
        self.reaches = lru_cache(1)(partial(reaches, prepared))
        self.gaps = lru_cache(1)(partial(gaps, prepared))
        self._threads = threads
        self.drawn = drawn
        self.normals = normals
        self.progress = progress or Nearing(None)
        self.unseen = ""  # why there is no look
        self.painted: Callable[[Positions], float] = lambda decoded: 0.0  # the look of attributes

    def painting(self, painted: Callable[[Positions], float]) -> "Measures":
        """Return these measurements with looks of attributes."""
        measures = copy(self)
        measures.painted = painted
        return measures

    def flat_faces(self, positions: Matrix) -> int:
        """Return how many faces have no area, within rounding."""
        faces = self.prepared.mesh.faces
        # In pieces: their sides take six times the memory of the faces.
        pieces = (faces[begin : begin + PIECE] for begin in range(0, len(faces), PIECE))
        return sum(count_flat(positions, piece) for piece in pieces)

    @cached_property
    def flat_before(self) -> int:
        return self.flat_faces(self.prepared.positions)

    @cached_property
    def look(self) -> LookMetric | None:
        """None: nothing of the mesh can be seen."""
        normals = []
        if self.normals is not None:
            values = self.normals.reshape(-1, 3)
            normals.append(Attribute("normal", values, "corner", "normal"))
        # As given and as decoded, to the last bit: in BSM units, rounding may show other shades.
        original = self.prepared.mesh
        mesh = TriangleMesh(original.positions, original.faces, tuple(normals))
        try:
            if self.drawn is not None:
                return self.drawn.against(mesh)
            return LookMetric(mesh, threads=self._threads, around=self.shaper.around)
        except MeshError as error:
            self.unseen = error.message
            return None
        finally:
            self.progress.by(DRAWING)


def count_flat(positions: Matrix, faces: Faces) -> int:
    """Return how many faces have no area, within rounding."""
    areas = face_geometry(positions, faces).areas
    # Most faces are too large for any side that a face of this mesh may have.
    extent = extent_of(positions)
    longest = 2.0 * float(np.square(extent).sum())
    small = areas <= FLAT * longest
    corners = positions[faces[small]]
    sides = corners - np.roll(corners, 1, axis=1)
    longest_squares = np.square(sides).sum(axis=2).max(axis=1, initial=0.0)
    return int(np.count_nonzero(areas[small] <= FLAT * longest_squares))


def trial_of(prepared: Prepared, draft: Draft) -> Trial:
    """A stream as it is, for judging."""
    return Trial(0.0, prepared.units.into(draft.decoded), lambda: draft, decoded=draft.decoded)


class Bounds:
    """Measures decoded positions, in BSM units, shape (n, 3), against a contract."""

    def __init__(self, measures: Measures, contract: Contract) -> None:
        self.measures = measures
        self.contract = contract
        self.reaches = measures.reaches(contract) * (1.0 - LEAST)
        self.gaps = measures.gaps(contract)
        self._best: tuple[float, ...] | None = None
        # Weakly: trials know how they are made, and so these bounds; both would live until garbage is collected.
        self._last: tuple[ReferenceType[Trial], tuple[float, float, float, float]] | None = None

    def excess(self, candidate: Trial) -> float:
        """The logarithm of the largest share of a bound that depends on the step."""
        farther, *shares = self._shares(candidate)
        if not (candidate.settled and farther <= 1.0):
            shares.insert(0, farther)
        self.measures.progress.by()
        return math.log(max(*shares, LEAST))

    def is_faulty(self, trial: Trial) -> bool:
        """Whether more faces lose their areas, or more edges fold, than may."""
        shaper = self.measures.shaper
        if self.loses_faces(trial.positions):
            return True
        folds = shaper.more_folds(trial.positions)
        if trial.settled:
            return folds > shaper.most_folds
        # On grids, slivers of parts fold where nothing shows.
        faces = self.measures.prepared.mesh.faces
        return folds > max(SLIVERS * len(faces), 1.0)

    def loses_faces(self, positions: Matrix) -> bool:
        """Whether more faces lose their areas than may: up to a look of 0.5 none, up to 1 one in 200."""
        if self.contract.look > 1.0:
            return False
        most = 0
        if self.contract.look > NO_FACE_LOST:
            most = len(self.measures.prepared.mesh.faces) // FEW_LOST
        return self.measures.flat_faces(positions) - self.measures.flat_before > most

    @property
    def metric(self) -> LookMetric | None:
        """None: no look is asked for, or nothing can be seen."""
        if self.contract.look == math.inf:
            return None
        return self.measures.look

    def keeps(self, candidate: Trial, look: float | None = None) -> bool:
        """Whether all bounds are kept; `look`, where it is known otherwise."""
        return max(self._shares(candidate, look)) <= 1.0

    def broken_by(self, candidate: Trial, look: float | None = None) -> str:
        """Return the bounds that the best positions broke that were seen; empty where a trial keeps all."""
        if self.keeps(candidate, look):
            return ""
        return self.had

    def binding(self, candidate: Trial, look: float | None = None) -> str:
        """Return the bound that keeps a stream from being smaller; "step" where wider ones break one."""
        shares = dict(zip(BOUNDS, self._shares(candidate, look), strict=True))
        name = max(shares, key=lambda name: shares[name])
        if shares[name] > 1.0 - 4.0 * SLACK:
            return name
        return "step"

    def quality(self, candidate: Trial) -> float:
        """How far off positions are where the nearest ones are wanted, as a logarithm."""
        metric = self.measures.look
        if metric:
            error = metric.distance(self._decoded(candidate))
        else:
            error = self.measures.original.angle(candidate.positions)
        return math.log(max(error, LEAST))

    @cached_property
    def first_step(self) -> float:
        """Return a step at which rounding uses up about the whole bound, in BSM units."""
        contract = self.contract
        positions = self.measures.prepared.positions
        widest = COARSEST
        if self.metric is not None:
            widest = min(self.usual_step * contract.look / self._aim, COARSEST)
            if contract.angle == ANY_ANGLE and contract.visual == math.inf:
                return widest
        step = widest
        for _ in range(3):  # of errors, or of their squares
            shares = self._measured(np.rint(positions / step) * step)
            step /= math.sqrt(max(*shares, LEAST))
        return min(step, widest)

    @cached_property
    def usual_step(self) -> float:
        """About the step at which rounding has a look of 1, in BSM units, whatever is promised."""
        step = min(SEEN * self.measures.shaper.mean_edge, COARSEST)
        metric = self.metric
        if metric is None:
            return step
        prepared = self.measures.prepared
        for _ in range(2):
            rounded = np.rint(prepared.positions / step) * step
            placed = prepared.units.back(rounded)
            wider = self._aim / max(metric.glance(placed), LEAST)
            step *= min(max(wider, 0.1), 10.0)
            step = min(step, COARSEST)
            if 0.5 < wider < 2.0:
                break
        return step

    @property
    def _aim(self) -> float:
        """From one step for all looks, so that a stricter one begins with a finer step; but a mesh that stands for
        another one looks different without any step."""
        if self.measures.drawn:
            return self.contract.look
        return 1.0

    @property
    def had(self) -> str:
        """The bounds that the best positions broke that were seen."""
        if self._best is None:
            return "nothing"
        contract = self.contract
        (farther, angle, visual, look) = self._best
        return contract.worded(
            farther, angle * contract.angle, look * contract.look, visual * contract.visual
        )

    def _shares(
        self, candidate: Trial, look: float | None = None
    ) -> tuple[float, float, float, float]:
        """Shares of the bounds on distances, on the angle of normals, on the visual error, and on the look."""
        if look is None and self._last is not None and self._last[0]() is candidate:
            return self._last[1]
        distance = look or 0.0
        decoded = self._decoded(candidate)
        if look is None and self.metric is not None:
            distance = self.metric.with_room(decoded)
            if distance <= self.contract.look:
                distance = max(distance, self.measures.painted(decoded))
        others = self._measured(candidate.positions)
        shares = (*others, distance / self.contract.look)
        if look is None:
            self._last = ReferenceType(candidate), shares
        if self._best is None or shares < self._best:
            self._best = shares
        return shares

    def _measured(self, positions: Matrix) -> tuple[float, float, float]:
        """Shares of the bounds that are not in pictures."""
        contract = self.contract
        measures = self.measures
        off = positions - measures.prepared.positions
        distances = np.sqrt(squares_of(off))
        reaches = np.maximum(self.reaches, np.finfo(np.float64).tiny)
        shares = np.append(distances / reaches, self.gaps.closed(off))
        farther = float(shares.max(initial=0.0))
        angle = visual = 0.0
        if contract.angle < ANY_ANGLE:
            angle = measures.original.angle(positions) / contract.angle
        if contract.visual < math.inf:
            visual = measures.prepared.reference.nmsve(positions) / contract.visual
        return farther, angle, visual

    def _decoded(self, candidate: Trial) -> Positions:
        """Positions as a decoder has them."""
        if candidate.decoded is not None:
            return candidate.decoded
        return self.measures.prepared.units.back(candidate.positions)


def reaches(prepared: Prepared, contract: Contract) -> Matrix:
    """How far each vertex may come to lie from its place, in BSM units, shape (n,)."""
    diagonal = prepared.mesh.diagonal
    unit = prepared.units.scale
    part = prepared.components
    farthest = contract.reach(diagonal, unit)
    by_part = contract.by_part * diagonal / unit
    if not by_part < math.inf:
        return np.full(len(part), farthest)
    order = np.argsort(part, kind="stable")
    sizes = np.bincount(part)
    starts = np.cumsum([0, *sizes[:-1]])
    positions = prepared.positions[order]
    low = np.minimum.reduceat(positions, starts)
    high = np.maximum.reduceat(positions, starts)
    diagonals = np.sqrt(squares_of(high - low))
    diagonals = diagonals * unit / (diagonal or 1.0)
    shares = diagonals.clip(FINEST_PART, 1.0)[part]
    return np.asarray(np.minimum(farthest, by_part * shares))


class Gaps(NamedTuple):
    """Where parts are near each other: a vertex and the corners of another part's face, shape (k, 4), and for each the
    direction in which it closes the gap, over the distance that closes it, shape (k, 4, 3)."""

    ends: Order
    closing: Matrix

    def closed(self, moved: Matrix) -> Matrix:
        """How much of each gap moves of vertices, shape (n, 3), close, over what may be, shape (k,)."""
        closed = (self.closing * moved[self.ends]).sum(axis=(1, 2))
        return np.asarray(closed / (1.0 - FINEST_PART))

    def kept(self, reach: Matrix, moved: Matrix | None = None) -> Matrix:
        """How far vertices may be, of `reach`, so that no gap closes, or none of those that `moved` would close."""
        ends = self.ends
        directions = self.closing[:, 0]
        if moved is not None:
            wrong = self.closed(moved) > 1.0
            ends = ends[wrong]
            directions = directions[wrong]
        half = (1.0 - FINEST_PART) / 2.0 / np.sqrt(squares_of(directions))
        reach = reach.copy()
        np.minimum.at(reach, ends, half[:, None])
        return reach


def gaps(prepared: Prepared, contract: Contract) -> Gaps:
    """Where parts are near each other, but do not touch."""
    part = prepared.components
    positions = prepared.positions
    reach = 2.0 * contract.by_part * prepared.mesh.diagonal / prepared.units.scale
    count = int(part.max(initial=0)) + 1
    if not 1 < count <= MOST_PARTS or not reach < math.inf:
        no_ends = np.empty((0, 4), np.int64)
        return Gaps(no_ends, np.empty((0, 4, 3)))
    closest = _closest_points(prepared, reach, count)
    ends = closest[:, :4].astype(np.int64)
    weights = np.insert(closest[:, 4:], 0, -1.0, axis=1)
    weights = weights[:, :, None]
    across = -(weights * positions[ends]).sum(axis=1)
    squares = squares_of(across)
    parts = part[ends[:, :2]]
    nearest = np.full(count, np.inf)
    distances = np.sqrt(squares)
    np.minimum.at(nearest, parts, distances[:, None])
    touching = FINEST_PART**2 * reach  # none of such parts is before the other
    is_apart = nearest[parts].max(axis=1) >= touching
    free = (squares < reach**2) & is_apart
    directions = (weights * across[:, None])[free]
    return Gaps(ends[free], directions / squares[free, None, None])


def _closest_points(prepared: Prepared, reach: float, count: int) -> Matrix:
    """Vertices that may be within reach of another of `count` parts, with the nearest points of that: shape (k, 7), as
    `nearest_points` has them after the vertex."""
    part = prepared.components
    positions = prepared.positions
    faces = prepared.mesh.faces
    low = positions[faces].min(axis=1)
    high = positions[faces].max(axis=1)
    rows = [np.empty((0, 7))]
    for number in range(count):
        is_own = part[faces[:, 0]] == number
        first = low[is_own].min(axis=0) - reach
        last = high[is_own].max(axis=0) + reach
        begins_before = (low <= last).all(axis=1)
        ends_after = (high >= first).all(axis=1)
        is_close = ~is_own & begins_before & ends_after
        if not is_close.any():
            continue
        first = low[is_close].min(axis=0) - reach
        last = high[is_close].max(axis=0) + reach
        is_within = ((positions >= first) & (positions <= last)).all(axis=1)
        vertices = np.flatnonzero((part == number) & is_within)
        points = nearest_points(positions[vertices], positions, faces[is_close])
        rows.append(np.column_stack([vertices, *points]))
    return np.concatenate(rows)
