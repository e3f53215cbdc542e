"""The smallest stream that keeps a contract, and the best one of a size: one secant for every way to code a mesh."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from copy import copy
from dataclasses import dataclass, replace
from itertools import islice, takewhile
from operator import attrgetter
from typing import Protocol

from bsm.bitstream.errors import LimitError, TargetError
from bsm.codec.look.measure import LookMetric, Shading
from bsm.codec.static.choice.blocks import Plain, Refined
from bsm.codec.static.choice.bounds import NEARLY, Bounds, Candidate, Measures, turned
from bsm.codec.static.choice.grids import Gridded, rounded
from bsm.codec.static.options import RANGES, EncodeOptions
from bsm.codec.static.preamble_encoding import FEW_VERTICES, Draft
from bsm.codec.static.targets import SLACK, SLACK_OF_LOOK, STEEPEST, TRIES, Contract, secant

DEARER = 1.08  # give up a way whose first step takes this many times the bytes of the best result
GUESSED = 1.4  # and a grid that is guessed to: of smooth surfaces it takes less than that
LITTLE = 1.01  # and leave faces flat that rounding has made so, where giving them an area takes more than this
FINER = tuple(0.02 * 2.0**k for k in range(4))  # how much finer steps are where mending folds breaks bounds at one
SMOOTH = 6  # grids that are tried of those that suit a model, and twice as many by the best effort
SPENT = 3.5  # budgets of pictures after which only what is needed in any case is looked at


class Way(Protocol):
    """A way to code a mesh, at one step after another: a pure function of the step."""

    least: float
    most: float

    @property
    def first(self) -> float:
        """A step that is about right."""

    def under(self, bounds: Bounds) -> Way:
        """Return the same way for other bounds."""

    def at(self, step: float) -> Candidate:
        """What a step comes to."""


@dataclass(frozen=True)
class Found:
    """What a search ended with."""

    way: Way
    step: float
    contract: Contract


class Search:
    """Looks for the best stream of a mesh among all ways to code it."""

    def __init__(
        self, measures: Measures, options: EncodeOptions, size: Callable[[Draft], int] = attrgetter("size")
    ) -> None:
        self._measures, self._prepared = measures, measures.prepared
        self._options = options
        self._size = size
        self._before: Found | None = None
        self._lost: frozenset[type[Way]] = frozenset()

    @property
    def metric(self) -> LookMetric | None:
        return self._measures.look

    def smallest(self, contract: Contract) -> Draft:
        """The smallest stream that keeps a contract.

        Raises
        ------
        TargetError
            If none does; says what can be had.
        """
        if not self._prepared.mesh.diagonal > 0.0:
            return rounded(self._prepared, 1)  # a point
        bounds = Bounds(self._measures, contract)
        before, self._before = self._before, None
        if before is not None and replace(contract, look=before.contract.look) == before.contract:
            way = before.way.under(bounds)
            found = widest(way, bounds, first=before.step * contract.look / before.contract.look)
            if found is not None:
                return self._noted(unfolded(found, bounds, way), way, contract)
        kept = [c for c in Gridded(self._prepared, bounds, 0.0).made() if bounds.keeps(c.positions)]
        least, made = min((candidate.draft.size for candidate in kept), default=math.inf), list[Candidate]()
        ways = dict[int, Way]()
        for way in self._ways(bounds, contract.look):
            on_grid = any(candidate.draft.places is not None for candidate in (*kept, *made))
            if made and on_grid and self._exhausted():  # one grid is tried in any case: it may be much smaller
                break
            if isinstance(way, Gridded) and not on_grid and way.guess() > GUESSED * least:
                continue
            # A good first step of blocks alone is unknown, so their first result says little about their bytes.
            most = math.inf if isinstance(way, Plain) else least
            found = widest(way, bounds, most, patient=self._options.effort == "best")
            if found is not None:
                made.append(unfolded(found, bounds, way))
                ways[id(made[-1])] = way
                least = min(least, made[-1].draft.size * penalty(made[-1]))
        kept += made
        near = bounds.excess()
        for candidate in self._made_on(bounds, made or kept):
            if candidate.draft.size < least and not bounds.breaks(candidate.positions):
                over, look = near(candidate)
                if over <= 0.0 and bounds.keeps(candidate.positions, look):
                    kept.append(unfolded(candidate, bounds, Gridded(self._prepared, bounds, 0.0)))
                    least = min(least, kept[-1].draft.size * penalty(kept[-1]))
        if not kept:
            kept += self._last_resort(bounds)
        best = min(kept, key=lambda candidate: self._size(candidate.draft) * penalty(candidate))
        near_best = {type(ways[id(other)]) for other in made if other.draft.size <= DEARER * best.draft.size}
        self._lost = frozenset({Refined, Plain} - near_best)
        return self._noted(best, ways.get(id(best), Gridded(self._prepared, bounds, 0.0)), contract)

    def shaded_by(self, shading: Shading) -> Search:
        """Return a search for the same mesh, where decoded meshes are drawn with normals that `shading` makes."""
        other = copy(self)
        other._before = None  # other normals may want another way, but none that has lost by far
        other._measures = copy(self._measures)
        if self.metric is not None:
            other._measures.look = self.metric.shaded_by(shading)
        return other

    def _noted(self, found: Candidate, way: Way, contract: Contract) -> Draft:
        """Take note of what was found: a contract of another look begins there."""
        if found.step > 0.0:
            self._before = Found(way, found.step, contract)
        return found.draft

    def _last_resort(self, bounds: Bounds) -> list[Candidate]:
        """What grids do that are finer than where a search began, where it came to nothing."""
        way = Gridded(self._prepared, bounds, 0.0)
        finest_bits = int(RANGES["grid"][1])
        while way.first > 2.0**-finest_bits:
            way.first /= 4.0
            if bounds.keeps(way.at(way.first).positions):
                found = widest(way, bounds)
                return [way.at(way.first) if found is None else found]
        finest = rounded(self._prepared, finest_bits)
        positions = self._prepared.units.into(finest.decoded)
        if bounds.keeps(positions):
            return [Candidate(0.0, positions, lambda: finest)]
        raise TargetError(f"{bounds.contract} cannot be kept on this mesh; the best possible is {bounds.had}")

    def best(self, contract: Contract, most_bytes: float) -> Draft | None:
        """Return the best stream of at most `most_bytes` that keeps a contract, or None."""
        bounds = Bounds(self._measures, contract)
        found = list(Gridded(self._prepared, bounds, 0.0).made())
        for way in self._ways(bounds, min(contract.look, 1.0)):
            fitting: dict[float, Candidate] = {}

            def excess(fineness: float, way: Way = way, fitting: dict[float, Candidate] = fitting) -> float:
                candidate = way.at(1.0 / fineness)
                over = math.log(self._size(candidate.draft) / most_bytes)
                if over <= 0.0:
                    fitting[fineness] = candidate
                return over

            with suppress(LimitError):
                secant(excess, 1.0 / way.first, 1.0 / way.most, 1.0 / way.least)
            found += [fitting[finest] for finest in sorted(fitting)[-1:]]
        found += self._made_on(bounds, found)
        found = [c for c in found if self._size(c.draft) <= most_bytes and bounds.keeps(c.positions)]
        return min(found, key=lambda candidate: bounds.quality(candidate.positions)).draft if found else None

    def _exhausted(self, budgets: float = 1.0) -> bool:
        return self.metric is not None and self.metric.spent > budgets

    def seen(self, draft: Draft) -> str:
        metric = self._measures.look
        if metric is None:
            return "nothing that can be seen"
        look = metric.look(self._prepared.units.into(draft.decoded))
        return f"a look of {look.distance:.3g}, {100.0 * look.visible:.3g} % of the pixels differ visibly"

    def _ways(self, bounds: Bounds, look: float) -> Iterator[Way]:
        """Ways that may be smallest; blocks never are where a surface is flat but for sharp edges."""
        prepared, options = self._prepared, self._options
        character, seen = self._measures.shaper.character, bounds.contract.look < math.inf
        grids = [Gridded(prepared, bounds, worth) for worth in (1.0, 0.0)]
        blocks: list[Way] = []
        if prepared.has_low_frequencies and not options.quick and not (character.is_model and seen):
            blocks += [Refined(prepared, options, bounds, look)]
            if not seen:
                blocks += [Plain(prepared, options, bounds)]
        # The smaller ones first, nearly always: the others are left alone sooner.
        blocks = [way for way in blocks if type(way) not in self._lost]
        grids_first = character.is_sharp and any(first_size(way) > grids[0].guess() for way in blocks[:1])
        yield from (*grids, *blocks) if grids_first else (*blocks, *grids)

    def _made_on(self, bounds: Bounds, found: list[Candidate]) -> Iterator[Candidate]:
        """Grids of few cells, or finer than one that was found, on which a model may have been made."""
        prepared, steps = self._prepared, [candidate.step for candidate in found if candidate.draft.places is not None]
        if prepared.graph.size < FEW_VERTICES:
            grid = Gridded(prepared, bounds, 0.0)
            wider = (grid.at(max(steps) * 2.0 ** (eighths / 8.0)) for eighths in range(24 if steps else 0, 0, -1))
            # The former also behind others that took long, so that stricter contracts find no smaller ones.
            yield from takewhile(lambda _: not self._exhausted(SPENT), grid.fitting())
            yield from takewhile(lambda _: not self._exhausted(), wider)
        elif steps and self._measures.shaper.character.is_sharp:
            tries = SMOOTH * (2 if self._options.effort == "best" else 1)
            yield from islice(Gridded(prepared, bounds, 1.0).smooth(max(steps)), tries)


def penalty(candidate: Candidate) -> float:
    """What its bytes are multiplied by before they are compared: more where too many edges are folded over."""
    return DEARER if candidate.folded else 1.0


def unfolded(found: Candidate, bounds: Bounds, way: Way) -> Candidate:
    """What was found, with few edges folded over where that keeps the bounds, or does at a finer step of its way; and
    with no face flat where that costs next to nothing."""
    shaper, metric = bounds.measures.shaper, bounds.measures.look
    best, better, most = found, turned(found), shaper.most_folded
    least = max(shaper.folded(found.positions), most)
    for finer in FINER:
        if better is None:
            break
        folds = max(shaper.folded(better.positions), most)
        if folds < least and better.draft.size < DEARER * found.draft.size and not bounds.breaks(better.positions):
            best, least = (better, folds) if bounds.keeps(better.positions) else (best, least)
        if least == most or (metric is not None and metric.spent > SPENT):
            break
        better = way.at(found.step * (1.0 - finer))
        better = turned(better) or better
    flat = turned(best, flat=True)
    if flat is not None and flat.draft.size <= LITTLE * best.draft.size and shaper.folded(flat.positions) <= least:
        best = flat if bounds.keeps(flat.positions) else best
    return replace(best, make=lambda: best.draft, folded=least > most)


def first_size(way: Way) -> float:
    """Bytes of a way at its first step; infinite where decoders would refuse it."""
    try:
        return way.at(way.first).draft.size
    except LimitError:
        return math.inf


def widest(
    way: Way, bounds: Bounds, most_bytes: float = math.inf, first: float | None = None, patient: bool = False
) -> Candidate | None:
    """Return the smallest candidate found that keeps the bounds; None if it would not be smaller than `most_bytes`."""
    slack = SLACK_OF_LOOK if isinstance(way, Refined) and bounds.contract.look < math.inf else SLACK
    kept, excess = list[tuple[Candidate, float | None]](), bounds.excess(slack)
    begin = min(max(first or way.first, way.least), way.most)
    tried: Candidate | None = None

    def at(step: float) -> float | None:
        candidate = tried if tried is not None and math.isclose(step, begin) else way.at(step)
        sure = math.inf
        if most_bytes < math.inf:  # a step twice as wide saves three bits of a vertex at most, half as wide costs one
            bits = math.log(2.0) * 8.0 * (candidate.draft.size - most_bytes) / len(candidate.positions)
            sure = -bits * STEEPEST if bits < 0.0 else -bits / (3.0 * STEEPEST)
        over, look = excess(candidate, math.exp(min(sure, 1.0)))
        if over <= 0.0:
            kept.append((candidate, look))
        return over if over < sure else None

    with suppress(LimitError):  # blocks that decoders would refuse
        tried = way.at(begin) if most_bytes < math.inf else None
        if tried is not None and tried.draft.size > DEARER * most_bytes:
            return None
        tries, slack = (3 * TRIES, slack / 4.0) if patient else (TRIES, slack)
        secant(at, begin, way.least, way.most, tries, slack=slack)
    fine = NEARLY[0] * max((candidate.step for candidate, _ in kept), default=0.0)
    fine *= len(bounds.reaches) >= FEW_VERTICES  # of many vertices, what has far finer steps is no smaller
    kept.sort(key=lambda pair: pair[0].draft.size if pair[0].step > fine else math.inf)
    found, good, bad = None, math.inf, 0.0
    for candidate, look in kept:
        if bounds.keeps(candidate.positions, look):
            found, good = candidate, candidate.step
            break
        bad = candidate.step  # a few sides have praised it too much
    while bad > good * math.exp(slack):
        step = math.sqrt(good * bad)
        between = way.at(step)
        found, good, bad = (between, step, bad) if bounds.keeps(between.positions) else (found, good, step)
    return found
