"""The smallest stream that keeps a contract, and the best one of a size: one secant for every way to code a mesh."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import chain
from operator import attrgetter, itemgetter

from bsm.bitstream.errors import LimitError, TargetError
from bsm.codec.static.choice.blocks import Plain, Refined
from bsm.codec.static.choice.bounds import Bounds, Measures, Trial
from bsm.codec.static.choice.grids import LEAST_SAVED, Gridded, may_repeat, paying, rounded
from bsm.codec.static.choice.settling import RATIO
from bsm.codec.static.options import LARGE_BLOCKS, RANGES, WORTH, EncodeOptions
from bsm.codec.static.preamble_encoding import FEW_VERTICES, Draft
from bsm.codec.static.targets import ANY_ANGLE, SLACK, STEEPEST, TRIES, Contract, secant
from bsm.codec.static.ways.grid import FIRST, SAMPLE
from bsm.codec.threads import Crew, threads_of

RUNGS = 6  # an octave: steps of grids, the same for all promises, as some make more parts congruent by chance
SHAPED = 0.85  # bytes of a grid whose places are chosen over those of a rounded one: hardly ever less
ALIKE = 1.02  # bytes over the least, within which normals choose where a visual error is bounded
Way = Gridded | Plain | Refined  # ways to code a mesh at one step after another: pure functions of the step


class Search:
    """Looks for the best stream of a mesh among all ways to code it."""

    def __init__(
        self, measures: Measures, options: EncodeOptions, size: Callable[[Draft], int], saved: Callable[[Trial], int]
    ) -> None:
        self._measures, self._prepared = measures, measures.prepared
        self._tries = {"quick": TRIES // 2, "best": 3 * TRIES}.get(options.effort, TRIES)
        self._options, self._size, self._saved = options, size, saved
        self._crew, self._ahead = Crew(options.threads), min(threads_of(options.threads), 2)

    def smallest(self, contract: Contract) -> Draft:
        """The smallest stream that keeps a contract; raises `TargetError` if none does."""
        if not self._prepared.mesh.diagonal > 0.0:
            return rounded(self._prepared, 1)  # a point
        bounds = Bounds(self._measures, contract)
        grid = Gridded(self._prepared, bounds)
        kept = list(filter(bounds.keeps, grid.made()))
        grid = grid.in_frame()
        first, refined = grid.at(grid.first), Refined(self._prepared, self._options, bounds)
        saved, share, parts = self._saved(first), 1.0, -1
        if may_repeat(self._prepared) and not self._outdone(first, grid, refined):
            if any(map(len, self._prepared.motions.values())):
                self._crew.map(first.like, (-1, 1))
            share, parts = first.congruent.size / first.draft.size, first.congruent.header.transforms
            grid.transforms = parts if share < 1.0 - LEAST_SAVED else -1
        least, seen = min((candidate.size for candidate in kept), default=math.inf) - saved, contract.look < math.inf
        near = 1.0 if seen or contract.visual == math.inf else ALIKE
        ways = self._ways(bounds, grid, refined, share)
        for way in ways:  # which may lead to others
            leaning, gain = 0, 1.0
            if isinstance(way, Gridded):
                leaning, gain = saved, share
                if seen and SHAPED * first.size > (least + leaning) / gain:
                    continue
            like = (lambda made, gain=gain: made.like(parts) / gain) if gain < 1.0 else attrgetter("size")
            found = widest(
                way, bounds, (near * least + leaning) / gain, tries=self._tries, size=like, each=self._crew.map
            )
            if found is not None:
                kept.append(found)
                # The guess is for steps at which a mesh looks right.
                size = found.congruent.size if gain < 1.0 else found.size if seen else found.draft.size
                least = min(least, size - leaning)
                ways += self._larger(way, found, bounds) if isinstance(way, Refined) else []
        if not kept:
            kept.append(self._last_resort(bounds))
        repeats = share < 1.0 - LEAST_SAVED and not self._prepared.light
        if repeats or 8 * first.size < self._prepared.graph.size:
            kept += self._at_rungs(grid, bounds, kept)
        most = near * min(self._size(candidate.congruent) for candidate in kept)
        alike = [candidate for candidate in kept if self._size(candidate.congruent) <= most]
        bent = self._measures.original.angle
        best = min(alike, key=lambda candidate: bent(candidate.positions) if near > 1.0 else 0.0)
        return paying(self._prepared, best.congruent)

    def _outdone(self, first: Trial, grid: Gridded, refined: Refined) -> bool:
        """Whether blocks take fewer bytes than a grid if congruent parts predicted all that they may."""
        prepared = self._prepared
        if self._options.effort != "normal" or prepared.graph.size <= SAMPLE or not prepared.has_low_frequencies:
            return False
        with suppress(LimitError):  # blocks that decoders would refuse
            least = ALIKE * refined.at(max(refined.first, refined.least)).size
            return least < first.size and least < first.size * (1.0 - grid.covered(first.step))
        return False

    def _at_rungs(self, grid: Gridded, bounds: Bounds, kept: list[Trial]) -> Iterator[Trial]:
        """Grids of steps that are the same for all promises, each smaller than those before it."""
        found = min(kept, key=lambda candidate: candidate.congruent.size)
        best, rung = found.congruent, math.floor(RUNGS * math.log2(grid.first))
        more = LEAST_SAVED * best.size * min(FIRST / self._prepared.graph.size, 1.0)
        transforms = grid.transforms if best.places is None else best.header.transforms
        least, like = best.size, (transforms, best.begun + more)
        seen, hopeless = bounds.contract.look < math.inf, 0
        steps = [2.0 ** ((rung + 1 - finer) / RUNGS) for finer in range(RUNGS + 2 if seen else 2 * RUNGS)]
        made = (list(map(grid.at, steps[at : at + self._ahead])) for at in range(0, len(steps), self._ahead))
        hoped = ([c for c in some if transforms < 0 or c.step < found.step or bounds.keeps(c)] for some in made)
        sized = (zip(some, self._crew.map(lambda made: made.like(*like), some), strict=True) for some in hoped)
        for candidate, size in chain.from_iterable(sized):
            hopeless = hopeless + 1 if (1.0 - LEAST_SAVED) * size > least else 0
            if seen and hopeless > 1:  # without pictures, all can be tried
                break
            if size < least and not bounds.folds(candidate.positions) and bounds.keeps(candidate):
                yield candidate
                least = candidate.congruent.size

    def _larger(self, way: Refined, found: Trial, bounds: Bounds) -> list[Refined]:
        """The way with larger blocks, where these may take fewer bytes than those that it has come to."""
        usual = self._prepared.parts.size == EncodeOptions.block_size and way.ratio == RATIO
        if bounds.contract.look == math.inf or not usual or way.base.coded <= found.size / 4.0:
            return []
        parts = replace(self._prepared.parts, size=LARGE_BLOCKS["block_size"])
        larger = way.replaced(found.step, replace(self._prepared, parts=parts))
        with suppress(LimitError):  # blocks that decoders would refuse
            saved = (way.base.coded - larger.base.coded) / found.size
            return [larger] if larger.base.work < way.base.work * (1.0 + WORTH * saved) else []
        return []

    def _last_resort(self, bounds: Bounds) -> Trial:
        """The result of grids that are finer than where a search began, where it came to nothing."""
        way = Gridded(self._prepared, bounds)
        finest_bits = int(RANGES["grid"][1])
        while way.first > 2.0**-finest_bits:
            way.first /= 4.0
            if bounds.keeps(way.at(way.first)):
                return widest(way, bounds) or way.at(way.first)
        if bounds.keeps(finest := way.rounded(finest_bits)):
            return finest
        raise TargetError(f"{bounds.contract} cannot be kept on this mesh; the best possible is {bounds.had}")

    def best(self, contract: Contract, most_bytes: float) -> Draft | None:
        """Return the best stream of at most `most_bytes` that keeps a contract, or None."""
        if not self._prepared.mesh.diagonal > 0.0:
            point = rounded(self._prepared, 1)
            return point if self._size(point) <= most_bytes else None
        kept, near = Bounds(self._measures, contract), Bounds(self._measures, replace(contract, look=1.0))
        first = (usual := Gridded(self._prepared, near)).at(usual.first)
        parts, size = first.congruent.header.transforms, self._size(first.congruent)
        # A step twice as wide, which looks about twice as far off, saves three bits of a vertex.
        octaves = min(max(8.0 * (size - most_bytes) / (3.0 * self._prepared.graph.size), -12.0), 6.0)
        bounds = Bounds(self._measures, replace(contract, look=2.0**octaves))
        grid = Gridded(self._prepared, bounds).in_frame()
        grid.transforms = parts if size < (1.0 - LEAST_SAVED) * self._size(first.draft) else -1
        found = [*grid.made()]
        for way in self._ways(bounds, grid, Refined(self._prepared, self._options, bounds)):
            found += self._fitting(way, most_bytes, tickets=RUNGS if way is grid and parts else 0)
        drafts = (candidate.congruent for candidate in sorted(filter(kept.keeps, found), key=kept.quality))
        draft = next((draft for draft in drafts if self._size(draft) <= most_bytes), None)
        return None if draft is None else paying(self._prepared, draft)

    def _fitting(self, way: Way, most_bytes: float, tickets: int) -> list[Trial]:
        """The finest candidate of at most so many bytes that was found; and some near it, which may look better."""
        repeats, fitting = isinstance(way, Gridded) and way.transforms >= 0, dict[float, Trial]()

        def excess(fineness: float) -> float:
            candidate = way.at(1.0 / fineness)
            over = math.log(self._size(candidate.congruent if repeats else candidate.draft) / most_bytes)
            if over <= 0.0:
                fitting[fineness] = candidate
            return over

        with suppress(LimitError):  # blocks that decoders would refuse
            secant(excess, 1.0 / way.first, 1.0 / way.most, 1.0 / way.least)
            finest = max(fitting, default=0.0)
            for aside in range(-tickets // 3, tickets) if finest else ():
                excess(finest * 2.0 ** (-(aside + 0.5) / (4.0 * RUNGS)))
        return list(fitting.values()) if tickets else [fitting[finest] for finest in sorted(fitting)[-1:]]

    def seen(self, draft: Draft) -> str:
        metric = self._measures.look
        if metric is None:
            return "nothing is visible"
        return f"look {metric.distance(draft.decoded):.3g}"

    def _ways(self, bounds: Bounds, grid: Gridded, refined: Refined, share: float = 1.0) -> list[Way]:
        """Ways that may be smallest, first those that are smaller at their first step; `share`: what parts leave."""
        prepared, options = self._prepared, self._options
        few = prepared.graph.size < FEW_VERTICES and self._measures.normals is None
        only = few or (share < SHAPED and bounds.contract.look < math.inf)  # places that are chosen repeat less
        grids: list[Way] = [grid] if only else [Gridded(prepared, bounds, 1.0), grid]
        if options.effort == "quick":
            return grids[:1]
        if not prepared.has_low_frequencies:
            return grids
        blocks: list[Way] = [refined]
        if bounds.contract.angle < ANY_ANGLE:
            blocks.append(Refined(prepared, options, bounds, settled=False))
        if bounds.contract.visual < math.inf:  # it counts errors in all directions
            blocks.append(Refined(prepared, options, bounds, ratio=math.sqrt(RATIO)))
        if bounds.contract.look == math.inf:
            blocks.append(Plain(prepared, options, bounds))
        with suppress(LimitError):  # blocks that decoders would refuse
            size, usual = grid.at(grid.first).size, refined.at(max(refined.first, refined.least)).size
            if size < usual or share * size < usual - refined.base.coded:  # as if larger blocks took nothing
                if share >= SHAPED and bounds.contract.look < math.inf:  # first what is smaller at the bound, about
                    most = 3.0 * prepared.graph.size / 8.0 / math.log(2.0)  # bytes that a finer step takes
                    grids.sort(key=lambda way: way.at(way.first).size + most * bounds.excess(way.at(way.first)))
                return grids + blocks
        return blocks + grids


def widest(
    way: Way,
    bounds: Bounds,
    most_bytes: float = math.inf,
    tries: int = TRIES,
    size: Callable[[Trial], float] = attrgetter("size"),
    each: Callable[[Callable[[Trial], float], list[Trial]], Iterable[float]] = map,
) -> Trial | None:
    """Return the smallest candidate found that keeps the bounds, or has few folds; None: not below `most_bytes`."""
    kept = list[tuple[bool, Trial]]()

    def at(step: float) -> float | None:
        candidate, sure = way.at(step), math.inf
        folded = bounds.folds(candidate.positions)
        if most_bytes < math.inf and not (folded and bounds.contract.look == math.inf):
            # A step twice as wide saves three bits of a vertex at most, half as wide costs one.
            bits = math.log(2.0) * 8.0 * (candidate.size - most_bytes) / len(candidate.positions)
            sure = -bits * STEEPEST if bits < 0.0 else -bits / (3.0 * STEEPEST)
        if sure < -10.0 * SLACK and bounds.contract.look < math.inf:
            return None  # hardly any first step is so much too narrow
        over = bounds.excess(candidate)
        if over <= 0.0 and bounds.keeps(candidate):
            kept.append((folded, candidate))
        over = max(over, SLACK) if folded else over  # a finer step has fewer folds
        return over if over < sure else None

    with suppress(LimitError):  # blocks that decoders would refuse
        layered = isinstance(way, Refined) and bounds.contract.look < math.inf
        quick = tries < TRIES  # a first step that will do in most cases
        slack = SLACK * (8.0 if quick else 0.25 if tries > TRIES else 2.0 if layered else 1.0)
        secant(at, way.first * math.exp(-4.0 * SLACK * quick), way.least, way.most, tries, slack=slack)
    if isinstance(way, Gridded):  # finer ones hardly ever take fewer bytes
        kept = sorted(kept, key=lambda tried: (not tried[0], tried[1].step))[-2:]
    sizes = each(size, [found for _, found in kept])
    sized = [(folded, taken, found) for (folded, found), taken in zip(kept, sizes, strict=True)]
    _, least, smallest = min(sized, key=itemgetter(0, 1), default=(False, math.inf, None))
    return smallest if least < most_bytes else None
