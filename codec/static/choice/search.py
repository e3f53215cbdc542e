"""The smallest stream that keeps a contract, and the best one of a size: one search over trials of all ways.

A trial is a way to code a mesh at a step. Coding it and drawing its pictures have a price, and `laws.py` says what it
may save, by the trials before it. The search opens the trial that promises most, and ends when none is worth its price.
If a size is given, bytes and look change their roles. The efforts differ in the price.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

from bsm.bitstream.errors import LimitError, TargetError
from bsm.codec.static.choice.blocks import Plain, Refined
from bsm.codec.static.choice.bounds import Bounds, Measures, Trial
from bsm.codec.static.choice.grids import Gridded, paying, rounded
from bsm.codec.static.choice.laws import DOUBT, Hopes, Law, Way, search, steps_of
from bsm.codec.static.choice.settling import RATIO
from bsm.codec.static.options import LARGE_BLOCKS, WORTH, EncodeOptions
from bsm.codec.static.preamble_encoding import Draft
from bsm.codec.static.targets import ANY_ANGLE, SLACK, Contract

PRICES = {"quick": 2e-3, "normal": 6e-4, "best": 8e-5}
"""Prices of a stage of a trial, as shares of the bytes, over the fourth root of the number of vertices."""
BYTES = 3.0 / math.log(256.0)  # of a vertex, that a step e times as wide saves where most levels are not 0


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
        usual, refined = grid.at(grid.first), Refined(self._prepared, self._options, bounds)
        ways, saved = self._ways(bounds, grid, refined), self._saved(usual)

        def total(way: object, size: float) -> float:
            return size if isinstance(way, Gridded | Trial) else size + saved  # positions on grids predict attributes

        losses: dict[object, int] = {}  # of what the first places save, which chosen ones may not

        def coded(way: Way, made: Trial) -> float:
            if way not in losses:
                losses[way] = saved - (self._saved(made) if isinstance(way, Gridded) else 0)
            return math.log(max(made.draft.size + losses[way], 1.0))

        def excess(made: Trial) -> float:
            over, _ = bounds.excess(made), bounds.keeps(made)
            folded = bounds.folded(made.positions)
            return max(over, math.log(folded) / 2.0) if folded > 1.0 else over  # they grow about as squares of steps

        begun: dict[Way, Trial] = {}
        sizes: dict[Way, float] = {}
        with suppress(LimitError):  # blocks that decoders would refuse
            if refined in ways:
                made = begun[refined] = refined.at(min(max(refined.first, refined.least), refined.most))
                if (larger := self._larger(refined, made, bounds)) is not None:
                    ways.append(larger)
                    sizes[larger] = made.draft.size - refined.base.coded + larger.base.coded
        about = usual.about() if begun else 0.0
        if begun and total(refined, begun[refined].draft.size) < (1.0 - DOUBT) * about:  # no grid is coded in full
            first, other = begun[refined], about
        else:
            begun[grid] = first = grid.repeat(usual)
            other = max(first.draft.size, (1.0 - DOUBT) * usual.draft.size)  # few chosen places are images of others
        hopeful = (made for made in plain.made() if made.about() < 2 * first.draft.size)
        kept: dict[object, Trial] = {made: made for made in hopeful if bounds.keeps(made)}
        queue = []
        for way in ways:
            made = begun.get(way, first)
            size = sizes.get(way, made.draft.size if way in begun else other)
            queue.append(self._hopes(way, bounds, made, total(way, size)))
            if way in begun:
                queue[-1].begin(made, queue[-1].bytes.known[0][1])
        least = math.log(min((made.draft.size for made in kept.values()), default=math.inf))
        kept.update(search(queue, coded, excess, self._price, least))
        if not kept:
            raise TargetError(f"{contract} cannot be kept on this mesh; the best possible is {bounds.had}")
        return paying(self._prepared, min((made.congruent for made in kept.values()), key=self._size))

    def _larger(self, way: Refined, found: Trial, bounds: Bounds) -> Refined | None:
        """The way with larger blocks, where these may take fewer bytes than those that it has come to."""
        usual, best = self._prepared.parts.size == EncodeOptions.block_size, self._options.effort == "best"
        if bounds.contract.look == math.inf or not usual or (way.base.coded <= found.draft.size / 4.0 and not best):
            return None
        parts = replace(self._prepared.parts, size=LARGE_BLOCKS["block_size"])
        larger = Refined(replace(self._prepared, parts=parts), self._options, bounds)
        larger.first = found.step
        saved = (way.base.coded - larger.base.coded) / found.draft.size
        return larger if best or larger.base.work < way.base.work * (1.0 + WORTH * saved) else None

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
        found, ways = [first, *grid.made()], self._ways(bounds, grid, Refined(self._prepared, self._options, bounds))
        queue = [self._hopes(way, bounds, first, most_bytes, most_bytes) for way in ways]

        def coded(way: Way, made: Trial) -> float:
            return math.log(self._size(made.congruent) / most_bytes)

        if grid is usual:
            queue[0] = self._hopes(grid, near, first, first.draft.size, most_bytes)
            queue[0].begin(first, coded(grid, first))
        fitting = (made for made in found if self._size(paying(self._prepared, made.congruent)) <= most_bytes)
        least = min(map(kept.quality, fitting), default=math.inf)
        price = self._price / -queue[0].bytes.slope  # of bytes, in looks
        found += [made for _, made in search(queue, coded, kept.quality, price, least)]
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

    def _ways(self, bounds: Bounds, grid: Gridded, refined: Refined) -> list[Way]:
        """Ways that may be smallest."""
        prepared, options = self._prepared, self._options
        if options.effort == "quick":
            return [grid]
        ways: list[Way] = [grid, Gridded(prepared, bounds, 1.0, grid.turn)]
        if not prepared.has_low_frequencies:
            return ways
        ways.append(refined)
        if bounds.contract.angle < ANY_ANGLE:
            ways.append(Refined(prepared, options, bounds, settled=False))
        if bounds.contract.visual < math.inf:  # it counts errors in all directions
            ways.append(Refined(prepared, options, bounds, ratio=math.sqrt(RATIO)))
        if bounds.contract.look == math.inf:
            ways.append(Plain(prepared, options, bounds))
        return ways
