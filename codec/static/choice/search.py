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
from operator import attrgetter

from bsm.bitstream.errors import LimitError, TargetError
from bsm.codec.geometry.mesh import squares_of
from bsm.codec.static.choice.blocks import OnCells, OnVertices, Plain, Refined
from bsm.codec.static.choice.bounds import Bounds, Measures, Trial, trial_of
from bsm.codec.static.choice.grids import Gridded, exact, paying, rounded
from bsm.codec.static.choice.laws import DOUBT, Hopes, Law, Way, search, steps_of
from bsm.codec.static.choice.settling import RATIO
from bsm.codec.static.options import BALANCED, PRESETS, RANGES, EncodeOptions
from bsm.codec.static.preamble_encoding import Draft
from bsm.codec.static.targets import ANY_ANGLE, SLACK, TRIES, WIDEST, Contract, secant

QUICK, PRICE = 2e-3, 6e-4
"""Prices of a stage of a trial, as shares of the bytes, over the fourth root of the number of vertices."""
blocks_of = attrgetter("paper", "block_size", "overlap", "key_interval")
BYTES = 3.0 / math.log(256.0)  # of a vertex, that a step e times as wide saves where most levels are not 0


@dataclass(eq=False)
class Smallest:
    """Few bytes are wanted, within the bounds of a contract."""

    bounds: Bounds
    size: Callable[[Draft], int]
    rest: int = -1  # bytes of attributes and metadata, those of the first trial
    _rests: dict[Way, int] = field(default_factory=dict)  # grids may predict attributes

    def bytes(self, way: Way, made: Trial) -> float:
        if way not in self._rests:
            self._rests[way] = self.size(made.draft) - made.draft.size
        if self.rest < 0:
            self.rest = self._rests[way]
        return math.log(max(made.draft.size + self._rests[way] - self.rest, 1))

    def error(self, made: Trial) -> float:
        return self.bounds.excess(made)

    def finer(self, made: Trial) -> float:
        if self.bounds.metric is None or (folded := self.bounds.folded(made.positions)) <= 1.0:
            return 0.0 if self.bounds.keeps(made) else SLACK
        return min(math.log(folded) / 2.0, DOUBT)  # folds grow about as squares of steps, or faster


@dataclass(eq=False)
class Best:
    """A good look is wanted, within a size, which is given as a logarithm and without attributes."""

    smallest: Smallest
    promised: Bounds
    most: float

    def bytes(self, way: Way, made: Trial) -> float:
        return self.smallest.bytes(way, made) - self.most

    def error(self, made: Trial) -> float:
        return self.promised.quality(made)

    def finer(self, made: Trial) -> float:
        return 0.0 if self.promised.keeps(made) else SLACK


class Search:
    """Looks for the best stream of a mesh among all ways to code it."""

    def __init__(self, measures: Measures, options: EncodeOptions, size: Callable[[Draft], int]) -> None:
        self._measures, self._prepared = measures, measures.prepared
        self._options, self._size = options, size
        price = (QUICK if options.effort == "quick" else PRICE) * self._prepared.graph.size**0.25
        # The best effort first does all that the normal one does.
        self._prices = [price, price / 8.0] if options.effort == "best" else [price]

    def smallest(self, contract: Contract) -> Draft:
        """The smallest stream that keeps a contract; raises `TargetError` if none does."""
        if not self._prepared.mesh.diagonal > 0.0:
            return rounded(self._prepared, 1)  # a point
        bounds = Bounds(self._measures, contract)
        kept, _ = self._kept(Smallest(bounds, self._size), Gridded(self._prepared, bounds).in_frame())
        if not kept:
            return self._finest(bounds)
        return paying(self._prepared, min((made.congruent for made in kept), key=self._size))

    def best(self, contract: Contract | None, most: float) -> Draft | None:
        """Return the best stream of at most `most` bytes that keeps a contract, or None."""
        if not self._prepared.mesh.diagonal > 0.0:
            point = rounded(self._prepared, 1)
            return point if self._size(point) <= most else None
        promised = contract or Contract(WIDEST)
        near = Bounds(self._measures, replace(contract or BALANCED, look=1.0))
        grid, smallest = Gridded(self._prepared, near).in_frame(), Smallest(near, self._size)
        octave = BYTES * math.log(2.0) * self._prepared.graph.size  # a step twice as wide looks about twice as far off
        # At the bytes of the default, its own stream is found, and what follows can only be better.
        kept, queue = self._kept(smallest, grid)
        taken = min((self._size(made.congruent) for made in kept), default=self._size(grid.at(grid.first).congruent))
        octaves = min(max((taken - most) / octave, -12.0), 6.0)
        if abs(octaves) > 1.0:
            bare = self._measures.painting(lambda decoded: 0.0)  # the look of the shape alone
            near = Bounds(bare, replace(promised, look=2.0**octaves))
            smallest = Smallest(near, self._size)
            other, queue = self._kept(smallest, Gridded(self._prepared, near, turn=grid.turn))
            kept += other
        aim = Best(smallest, Bounds(self._measures, promised), math.log(max(most - smallest.rest, 1.0)))
        for hopes in queue:
            hopes.fit(aim.most, -math.log(near.contract.look))
        fitting = (made for made in kept[-2:] if self._size(paying(self._prepared, made.congruent)) <= most)
        least = min(map(aim.error, fitting), default=math.inf)
        price = self._prices[-1] / max((-hopes.bytes.slope for hopes in queue), default=1.0)  # of bytes, in looks
        kept += search(queue, aim, price, least, len(self._prices))
        best = sorted((made for made in kept if aim.promised.keeps(made)), key=aim.error)
        drafts = (paying(self._prepared, made.congruent) for made in best)
        return next((draft for draft in drafts if self._size(draft) <= most), None)

    def _kept(self, aim: Smallest, grid: Gridded) -> tuple[list[Trial], list[Hopes]]:
        """Trials that keep a contract, the smallest ones last; and what to expect of others."""
        usual, ways = grid.at(grid.first), self._ways(aim.bounds, grid)
        made_on = Gridded(self._prepared, aim.bounds).made()
        hopeful = (made for made in made_on if (made.about() or made.draft.size) < (usual.about() or usual.draft.size))
        kept = [made for made in hopeful if aim.bounds.keeps(made)]
        if aim.bounds.contract.look < math.inf:
            queue = self._queue(ways, grid, aim, usual)
        else:
            first = grid.repeat(usual)  # before any of its trials counts: places may move where parts repeat
            still = [Gridded(self._prepared, aim.bounds, turn=grid.turn)] if grid.repeats else []  # none moves
            kept += self._widest([*ways, *still], aim)
            queue = [self._hopes(grid, aim, first, begun=True)] if grid.repeats else []  # luck decides about bytes
        for count, price in enumerate(self._prices, 1):
            least = math.log(max(min((self._size(made.draft) for made in kept), default=math.inf) - aim.rest, 1.0))
            queue = [hopes for hopes in queue if hopes.left.any()]
            kept += search(opened := [*queue], aim, price, least, count)
        return kept, opened

    def _finest(self, bounds: Bounds) -> Draft:
        """The finest grid, or exact positions, where no other stream keeps a contract."""
        for draft in (rounded(self._prepared, int(RANGES["grid"][1])), exact(self._prepared)):
            if bounds.keeps(trial_of(self._prepared, draft)):
                return draft
        raise TargetError(f"{bounds.contract} cannot be kept on this mesh; the best possible is {bounds.had}")

    def _widest(self, ways: list[Way], aim: Smallest) -> list[Trial]:
        """Find the widest steps that keep the bounds, for each way, until finer ones take more bytes than another."""
        sizes: dict[Trial, float] = {}
        promise: dict[Way, float] = {}

        def excess(way: Way, step: float) -> float:
            made = way.at(step)
            size, over = aim.bytes(way, made), aim.error(made)
            promise.setdefault(way, size + max(over, 0.0))
            if over <= 0.0 and not aim.finer(made):
                sizes[made] = size
            return over if over <= 0.0 or size < min(sizes.values(), default=math.inf) else -SLACK / 4.0

        for tries in (1, TRIES):
            for way in sorted(ways, key=lambda way: promise.get(way, 0.0)):
                with suppress(LimitError):  # blocks that decoders would refuse
                    secant(partial(excess, way), way.first, way.least, way.most, tries, slack=SLACK / 2.0)
        return [*sizes]

    def _queue(self, ways: list[Way], grid: Gridded, aim: Smallest, usual: Trial) -> list[Hopes]:
        """What to expect of ways whose looks count, of which some have begun."""
        begun: dict[Way, Trial] = {}
        sizes: dict[Way, float] = {}
        first, about = grid.repeat(usual), 0
        for refined in [way for way in ways if isinstance(way, Refined) and not grid.repeats][:1]:
            with suppress(LimitError):  # blocks that decoders would refuse
                made = begun[refined] = refined.at(min(max(refined.first, refined.least), refined.most))
                sizes[refined], about = aim.bytes(refined, made), usual.about()
        if begun and min(sizes.values()) < math.log(max((1.0 - DOUBT) * (about - aim.rest), 1.0)):
            first, other = next(iter(begun.values())), math.log(about)  # no grid is coded in full
        else:
            begun[grid], other = first, aim.bytes(grid, first)
            sizes[grid] = other
            if grid.repeats:  # few chosen places are images of others, and blocks take more bytes than a usual grid
                other = max(other, math.log(usual.draft.size))
                # What moves may be seen: then, a wider step may take fewer bytes, whose vertices stay.
                patient = self._options.effort != "quick"
                if patient and self._far(first, usual) and aim.error(first) > 2.0 * SLACK:
                    ways = [*ways, still := grid.still()]
                    begun[still] = still.at(grid.first)
                    sizes[still] = aim.bytes(still, begun[still])
        if rows := [way for way in ways if isinstance(way, Gridded) and way.spacing]:
            begun[rows[0]] = rows[0].repeat(rows[0].at(rows[0].first))
            sizes.update(dict.fromkeys(rows, aim.bytes(rows[0], begun[rows[0]])))
        return [self._hopes(way, aim, begun.get(way, first), sizes.get(way, other), begun=way in begun) for way in ways]

    def _far(self, moved: Trial, usual: Trial) -> bool:
        """Whether vertices are much farther off where they went to images, and images bring less than a half."""
        off, before = (squares_of(made.positions - self._prepared.positions).sum() for made in (moved, usual))
        return moved.draft.size > 0.5 * usual.draft.size and bool(off > math.exp(2.0 * DOUBT) * before)

    def _hopes(self, way: Way, aim: Smallest, like: Trial, size: float | None = None, *, begun: bool) -> Hopes:
        """What to expect of a way of about this size at its first step, in logarithms, and else as of a trial."""
        (first, steps), bounds = steps_of(way), aim.bounds
        size = aim.bytes(way, like) if size is None else size
        luck = self._prepared.graph.size**-0.25 if bounds.contract.look < math.inf else SLACK
        slope = -min(BYTES * self._prepared.graph.size, max(like.draft.size - like.fixed, 1.0)) / math.exp(size)
        rise = 2.0 if bounds.contract.visual < math.inf else 1.0
        taken = Law(steps, first, size, slope, DOUBT, SLACK)
        hopes = Hopes(way, steps, taken, Law(steps, first, 0.0, rise, DOUBT, luck))
        if begun:
            hopes.begin(like, size)
        for made in way.usual() if isinstance(way, Gridded) else ():
            hopes.begin(made, aim.bytes(way, made))
        return hopes

    def seen(self, draft: Draft) -> str:
        metric = self._measures.look
        return "nothing is visible" if metric is None else f"look {metric.distance(draft.decoded):.3g}"

    def _ways(self, bounds: Bounds, grid: Gridded) -> list[Way]:
        """Ways that may be smallest."""
        prepared, options = self._prepared, self._options
        if options.effort == "quick":
            return [grid]
        seen = bounds.contract.look < math.inf
        rows = grid.regular() if seen else []
        ways: list[Way] = [grid, *(rows or [Gridded(prepared, bounds, 1.0, grid.turn)])]
        if not prepared.has_low_frequencies:
            return ways
        blocks = OnVertices(prepared, options, bounds)
        # Blocks that somebody asks for are on the mesh itself; but a size begins with the default's own blocks.
        usual = [EncodeOptions(), *([PRESETS["none"]] if options.target and options.target.shrinks_with_step else ())]
        asked = blocks_of(options) not in map(blocks_of, usual)
        based = OnCells(prepared, options, bounds) if seen and not asked else blocks
        refined = Refined(prepared, bounds, based, settled=seen or bounds.contract.angle == ANY_ANGLE)
        ways.append(refined)
        if bounds.contract.visual < math.inf:  # it counts errors in all directions
            ways.append(Refined(prepared, bounds, based, ratio=math.sqrt(RATIO)))
        return ways if seen else [*ways, Plain(bounds, blocks, refined.first)]
