"""The smallest stream that keeps a contract, and the best one of a size.

A trial is a way to code a mesh at a step. There are few ways: positions on a grid, rounded or chosen for the normals;
blocks; and blocks with a layer of levels. Where no look is asked for, errors grow with the step. A secant then finds
the widest step of each way that keeps the contract, and gives the way up where it takes more bytes than another one.
Looks need pictures, which have a price, and depend on luck: `laws.py` expects of the next trial as much as those before
it tell, and the search ends when none is worth its price. So it does with grids where parts repeat: there, luck decides
about bytes. If a size is given, bytes and look change their roles. The efforts differ in the price.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial

from bsm.bitstream.errors import LimitError, TargetError
from bsm.codec.static.choice.blocks import Plain, Refined
from bsm.codec.static.choice.bounds import Bounds, Measures, Trial
from bsm.codec.static.choice.grids import Gridded, paying, rounded
from bsm.codec.static.choice.laws import DOUBT, Hopes, Law, Way, search, steps_of
from bsm.codec.static.choice.settling import RATIO
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Draft
from bsm.codec.static.targets import ANY_ANGLE, SLACK, TRIES, Contract, secant

PRICES = {"quick": 2e-3, "normal": 6e-4, "best": 8e-5}
"""Prices of a stage of a trial, as shares of the bytes, over the fourth root of the number of vertices."""
BYTES = 3.0 / math.log(256.0)  # of a vertex, that a step e times as wide saves where most levels are not 0


@dataclass(eq=False)
class Smallest:
    """Few bytes are wanted; those that attributes save by positions on a grid are counted where they are not saved."""

    bounds: Bounds
    saved: Callable[[Trial], int]
    most: int
    _losses: dict[Way, int] = field(default_factory=dict)

    def size(self, way: Way, size: float) -> float:
        return max(size + self._losses.get(way, 0 if isinstance(way, Gridded) else self.most), 1.0)

    def bytes(self, way: Way, made: Trial) -> float:
        if way not in self._losses:
            self._losses[way] = self.most - (self.saved(made) if isinstance(way, Gridded) else 0)
        return math.log(self.size(way, made.draft.size))

    def error(self, made: Trial) -> float:
        over, folded = self.bounds.excess(made), 0.0
        if self.bounds.contract.look < math.inf:  # what else nobody has asked for
            folded = self.bounds.folded(made.positions)
        return max(over, math.log(folded) / 2.0) if folded > 1.0 else over  # they grow about as squares of steps

    def kept(self, made: Trial) -> bool:
        return self.bounds.keeps(made)


@dataclass(eq=False)
class Best:
    """A good look is wanted, within a size."""

    promised: Bounds
    size: Callable[[Draft], int]
    most: float

    def bytes(self, way: Way, made: Trial) -> float:
        return math.log(self.size(made.congruent) / self.most)

    def error(self, made: Trial) -> float:
        return self.promised.quality(made)

    def kept(self, made: Trial) -> bool:
        return self.promised.keeps(made)


class Search:
    """Looks for the best stream of a mesh among all ways to code it."""

    def __init__(
        self, measures: Measures, options: EncodeOptions, size: Callable[[Draft], int], saved: Callable[[Trial], int]
    ) -> None:
        self._measures, self._prepared = measures, measures.prepared
        self._options, self._size, self._saved = options, size, saved
        self._price = PRICES[options.effort] * self._prepared.graph.size**0.25

    def smallest(self, contract: Contract) -> Draft:
        """The smallest stream that keeps a contract; raises `TargetError` if none does."""
        if not self._prepared.mesh.diagonal > 0.0:
            return rounded(self._prepared, 1)  # a point
        bounds = Bounds(self._measures, contract)
        plain = Gridded(self._prepared, bounds)
        grid = plain.in_frame()
        usual = grid.at(grid.first)
        aim, ways = Smallest(bounds, self._saved, self._saved(usual)), self._ways(bounds, grid)
        hopeful = (made for made in plain.made() if made.about() < 2 * (usual.about() or usual.draft.size))
        kept = [made for made in hopeful if bounds.keeps(made)]
        if contract.look < math.inf:
            queue = self._queue(ways, grid, aim, usual)
        else:
            kept += self._widest(ways, aim)
            queue = self._lucky(grid, aim, usual, kept)
        least = math.log(min((made.draft.size for made in kept), default=math.inf))
        kept += search(queue, aim, self._price, least)
        if not kept:
            raise TargetError(f"{contract} cannot be kept on this mesh; the best possible is {bounds.had}")
        return paying(self._prepared, min((made.congruent for made in kept), key=self._size))

    def _widest(self, ways: list[Way], aim: Smallest) -> list[Trial]:
        """Of each way the widest steps that keep the bounds, until finer ones would take more bytes than another."""
        sizes: dict[Trial, float] = {}
        promise: dict[Way, float] = {}

        def excess(way: Way, step: float) -> float:
            made = way.at(step)
            size, over = aim.bytes(way, made), aim.error(made)
            promise.setdefault(way, size + max(over, 0.0))
            if over <= 0.0 and aim.kept(made):
                sizes[made] = size
            return over if over <= 0.0 or size < min(sizes.values(), default=math.inf) else -SLACK / 4.0

        for tries in (1, TRIES):
            for way in sorted(ways, key=lambda way: promise.get(way, 0.0)):
                with suppress(LimitError):  # blocks that decoders would refuse
                    secant(partial(excess, way), way.first, way.least, way.most, tries, slack=SLACK / 2.0)
        return [*sizes]

    def _lucky(self, grid: Gridded, aim: Smallest, usual: Trial, kept: list[Trial]) -> list[Hopes]:
        """What to expect of grids where parts repeat, and luck decides about bytes."""
        about, least = usual.about(), min((made.draft.size for made in kept), default=math.inf)
        first = usual if least < (1.0 - DOUBT) * about else grid.repeat(usual)
        if not grid.repeats:
            return []
        hopes = self._hopes(grid, aim.bounds, first, aim.size(grid, first.draft.size))
        hopes.begin(first, math.log(aim.size(grid, first.draft.size)))
        return [hopes]

    def _queue(self, ways: list[Way], grid: Gridded, aim: Smallest, usual: Trial) -> list[Hopes]:
        """What to expect of ways whose looks count, of which some have begun."""
        begun: dict[Way, Trial] = {}
        sizes: dict[Way, float] = {}
        for refined in [way for way in ways if isinstance(way, Refined)][:1]:
            with suppress(LimitError):  # blocks that decoders would refuse
                made = begun[refined] = refined.at(min(max(refined.first, refined.least), refined.most))
                sizes[refined] = aim.size(refined, made.draft.size)
        about = usual.about() if begun else 0
        if begun and min(sizes.values()) < (1.0 - DOUBT) * about:  # no grid is coded in full
            first, other = next(iter(begun.values())), aim.size(grid, about)
        else:
            begun[grid] = first = grid.repeat(usual)
            sizes[grid] = aim.size(grid, first.draft.size)
            other = max(sizes[grid], aim.size(grid, (1.0 - DOUBT) * usual.draft.size))  # few chosen places are images
        queue = [self._hopes(way, aim.bounds, begun.get(way, first), sizes.get(way, other)) for way in ways]
        for hopes in queue:
            if hopes.way in begun:
                hopes.begin(begun[hopes.way], math.log(sizes[hopes.way]))
        return queue

    def best(self, contract: Contract, most_bytes: float) -> Draft | None:
        """Return the best stream of at most `most_bytes` that keeps a contract, or None."""
        if not self._prepared.mesh.diagonal > 0.0:
            point = rounded(self._prepared, 1)
            return point if self._size(point) <= most_bytes else None
        kept, near = Bounds(self._measures, contract), Bounds(self._measures, replace(contract, look=1.0))
        usual = Gridded(self._prepared, near).in_frame()
        first = usual.repeat(usual.at(usual.first))
        octave = BYTES * math.log(2.0) * self._prepared.graph.size  # a step twice as wide looks about twice as far off
        octaves = min(max((first.draft.size - most_bytes) / octave, -12.0), 6.0)
        bounds = Bounds(self._measures, replace(contract, look=2.0**octaves))
        grid = Gridded(self._prepared, bounds, turn=usual.turn) if abs(octaves) > 1.0 else usual
        grid.repeats = usual.repeats
        found, ways = [first, *grid.made()], self._ways(bounds, grid)
        queue = [self._hopes(way, bounds, first, most_bytes, most_bytes) for way in ways]

        aim = Best(kept, self._size, most_bytes)
        if grid is usual:
            queue[0] = self._hopes(grid, near, first, first.draft.size, most_bytes)
            queue[0].begin(first, aim.bytes(grid, first))
        fitting = (made for made in found if self._size(paying(self._prepared, made.congruent)) <= most_bytes)
        least = min(map(kept.quality, fitting), default=math.inf)
        price = self._price / -queue[0].bytes.slope  # of bytes, in looks
        found += search(queue, aim, price, least)
        best = sorted(filter(kept.keeps, found), key=kept.quality)
        drafts = (paying(self._prepared, made.congruent) for made in best)
        return next((draft for draft in drafts if self._size(draft) <= most_bytes), None)

    def _hopes(self, way: Way, bounds: Bounds, like: Trial, size: float, most_bytes: float = 0.0) -> Hopes:
        """What to expect of a way if it takes about so many bytes at its first step, and others as a trial does."""
        (first, steps), look = steps_of(way), bounds.contract.look
        luck = self._prepared.graph.size**-0.25 if look < math.inf else SLACK
        slope = -min(BYTES * self._prepared.graph.size, max(like.draft.size - like.fixed, 1.0)) / size
        taken = Law(steps, first, math.log(size / (most_bytes or 1.0)), slope, DOUBT, SLACK)
        rise = 2.0 if bounds.contract.visual < math.inf else 1.0
        errors = Law(steps, first, math.log(look) if most_bytes else 0.0, rise, DOUBT, luck)
        return Hopes(way, steps, taken, errors, most_bytes > 0.0)

    def seen(self, draft: Draft) -> str:
        metric = self._measures.look
        return "nothing is visible" if metric is None else f"look {metric.distance(draft.decoded):.3g}"

    def _ways(self, bounds: Bounds, grid: Gridded) -> list[Way]:
        """Ways that may be smallest."""
        prepared, options = self._prepared, self._options
        if options.effort == "quick":
            return [grid]
        ways: list[Way] = [grid, Gridded(prepared, bounds, 1.0, grid.turn)]
        if not prepared.has_low_frequencies:
            return ways
        ways.append(Refined(prepared, options, bounds))
        if bounds.contract.angle < ANY_ANGLE:
            ways.append(Refined(prepared, options, bounds, settled=False))
        if bounds.contract.visual < math.inf:  # it counts errors in all directions
            ways.append(Refined(prepared, options, bounds, ratio=math.sqrt(RATIO)))
        if bounds.contract.look == math.inf:
            ways.append(Plain(prepared, options, bounds))
        return ways
