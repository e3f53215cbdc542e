"""The smallest stream that keeps a contract, and the best one of a size.

`table.py` has the ways to code a mesh. Each tells about how many bytes it takes before any is coded. Where no look is
asked for, errors grow with the step. A secant then finds the widest step of each way that keeps the contract, and gives
the way up where it takes more bytes than another one. Looks need pictures, which have a price, and depend on luck:
`laws.py` expects of the next trial as much as those before it tell, and the search ends when none is worth its price.
So it does with grids where parts repeat: there, luck decides about bytes. The efforts differ in the price.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from operator import itemgetter

import numpy as np

from bsm.bitstream.errors import LimitError, TargetError
from bsm.codec.static.choice.bounds import Bounds, Measures, trial_of
from bsm.codec.static.choice.grids import exact, rounded
from bsm.codec.static.choice.laws import UNCODED, Prospect
from bsm.codec.static.choice.sizing import SizeSearch
from bsm.codec.static.choice.table import ways_of
from bsm.codec.static.choice.trace import Trace
from bsm.codec.static.choice.trials import DOUBT, Trial, Way
from bsm.codec.static.options import BALANCED, RANGES, EncodeOptions
from bsm.codec.static.preamble_encoding import Draft
from bsm.codec.static.targets import SLACK, TRIES, WIDEST, Contract, secant

QUICK, PRICE = 2e-3, 9e-4
"""Prices of a stage of a trial, as shares of the bytes, over the fourth root of the number of vertices."""
FINDING, ESTIMATING, CODING = 0.1, 0.05, 0.1
"""Shares of the remaining time that finding the ways, estimating the bytes of one, and coding a trial take."""
MOST_REFUSALS = 6  # of trials in which faces lose their areas or fold: then, such a trial is taken
# Of bytes, as a logarithm, from which on no finer steps are coded than the usual one.
RISE = 2.0 * SLACK
# Times the bytes of the default, up and down, within which its own stream may be the best of a size.
USUAL = 2.0


class Search:
    """Looks for the best stream of a mesh among all ways to code it."""

    def __init__(
        self,
        measures: Measures,
        options: EncodeOptions,
        size: Callable[[Draft], int],
        additions: int,
        trace: Trace,
    ) -> None:
        self._measures = measures
        self.prepared = measures.prepared
        self._options = options
        self.size = size
        self.additions = additions  # about the bytes of attributes and metadata
        self.trace = trace
        share = PRICE
        if options.effort == "quick":
            share = QUICK
        price = share * self.prepared.graph.size**0.25
        self._prices = [price]
        if options.effort == "best":  # first does all that the normal effort does
            self._prices.append(price / 8.0)

    def smallest(self, contract: Contract) -> Draft:
        """Return the smallest stream that keeps a contract; raise `TargetError` if none does."""
        if not self.prepared.mesh.diagonal > 0.0:
            return rounded(self.prepared, 1)  # a point
        bounds = Bounds(self._measures, contract)
        trial = self._smallest_trial(bounds)
        if trial is None:
            return self._finest(bounds)
        return trial.final

    def best(self, contract: Contract | None, most: float) -> Draft | None:
        """Return the best stream of at most `most` bytes that keeps a contract, or None."""
        if not self.prepared.mesh.diagonal > 0.0:
            point = rounded(self.prepared, 1)
            if self.size(point) > most:
                return None
            return point
        promise = contract or Contract(WIDEST)
        promised = Bounds(self._measures, promise)
        # Ways do not depend on the size, and neither do their steps.
        usual = Bounds(self._measures, replace(promise, look=1.0))
        ways = ways_of(self.prepared, usual, self._options)
        sizing = SizeSearch(promised, self.size, self.additions, self.trace)
        candidates = list(sizing.trials(ways, most))
        # These are candidates of all sizes that are large enough for them.
        specials: list[Trial] = []
        if self._options.effort != "quick":
            specials.append(trial_of(self.prepared, exact(self.prepared)))
        if sizing.usual_size / USUAL <= most <= USUAL * sizing.usual_size:
            usual_trial = self._smallest_trial(Bounds(self._measures, contract or BALANCED))
            if usual_trial is not None:
                specials.append(usual_trial)
        small = [trial for trial in specials if self.size(trial.final) <= most]
        fitting = [trial for trial in small if promised.keeps(trial)]
        candidates += [(promised.quality(trial), trial) for trial in fitting]
        if not candidates:
            return None
        _, nearest = min(candidates, key=itemgetter(0))
        return nearest.final

    def _smallest_trial(self, bounds: Bounds) -> Trial | None:
        """Return the smallest trial that keeps all bounds."""
        ways = ways_of(self.prepared, bounds, self._options)
        search = OneSearch(self, bounds)
        if bounds.contract.look == math.inf:
            search.widen(ways)
            # Luck decides about bytes.
            ways = [way for way in ways if way.name.startswith("images")]
        search.begin(ways)
        for count, price in enumerate(self._prices, 1):
            search.run(price, count)
        return search.best

    def _finest(self, bounds: Bounds) -> Draft:
        """Return the finest grid, or exact positions, where no other stream keeps a contract."""
        for draft in (rounded(self.prepared, int(RANGES["grid"][1])), exact(self.prepared)):
            if bounds.keeps(trial_of(self.prepared, draft)):
                return draft
        raise TargetError(
            f"{bounds.contract} cannot be kept on this mesh; the best possible is {bounds.had}"
        )

    def seen(self, draft: Draft) -> str:
        """Return the look of a stream, in words."""
        metric = self._measures.look
        if metric is None:
            return "nothing is visible"
        return f"look {metric.distance(draft.decoded):.3g}"


class OneSearch:
    """One search for the fewest bytes that keep some bounds."""

    def __init__(self, search: Search, bounds: Bounds) -> None:
        self._search = search
        self._bounds = bounds
        self._trace = search.trace
        self.best: Trial | None = None
        self._refusals = 0  # of trials in which faces lose their areas or fold
        self._least = math.inf  # the logarithm of the bytes of the best trial
        self.prospects: list[Prospect] = []
        # Bytes of attributes and metadata, which depend on the way.
        self._additions: dict[str, int] = {}

    def size_of(self, way: Way, trial: Trial) -> float:
        """Return the logarithm of the bytes of a trial, and of attributes as far as their bytes depend on the way."""
        if way.name not in self._additions:
            self._additions[way.name] = self._search.size(trial.draft) - trial.draft.size
        usual = next(iter(self._additions.values()))
        return math.log(max(trial.draft.size + self._additions[way.name] - usual, 1))

    def begin(self, ways: list[Way]) -> None:
        """Estimate the bytes of all ways before any is coded."""
        rise, luck = self._rise_and_luck()
        rival = math.inf
        progress = self._bounds.measures.progress
        progress.by(FINDING)
        for way in ways:
            try:
                estimate = way.estimate(rival)
            except LimitError:  # blocks that decoders would refuse
                self._trace.note("end", way.name, reason="decoders would refuse it")
                continue
            progress.by(ESTIMATING)
            rival = min(rival, estimate.size)
            self._trace.note("estimate", way.name, step=way.first, size=estimate.size)
            prospect = Prospect(way, estimate, rise, luck)
            if estimate.trial is not None:
                prospect.add(prospect.first, estimate.trial, self.size_of(way, estimate.trial))
            self.prospects.append(prospect)
        for prospect in self.prospects:
            self._code_also(prospect)

    def _rise_and_luck(self) -> tuple[float, float]:
        """Return how fast errors grow with steps, as logarithms, and how far luck takes them from that."""
        contract = self._bounds.contract
        rise, luck = 1.0, SLACK
        if contract.visual < math.inf:
            rise = 2.0
        if contract.look < math.inf:
            luck = self._search.prepared.graph.size**-0.25
        return rise, luck

    def _code_also(self, prospect: Prospect) -> None:
        """Code the trials that a way names with its estimate, until their bytes rise."""
        way = prospect.way
        least = float(prospect.sizes.mean[prospect.first])
        for step in prospect.estimate.also:
            trial = way.at(step)
            size = self.size_of(way, trial)
            prospect.add(prospect.index_of(trial.step), trial, size)
            facts = {"step": trial.step, "size": math.exp(size)}
            self._trace.note("code", way.name, **facts, reason="finer than the first one")
            if size > least + RISE:
                return
            least = min(least, size)

    def run(self, price: float, searches: int) -> None:
        """Open stages of trials until none is worth its price."""
        while prospects := [prospect for prospect in self.prospects if prospect.is_open]:
            stages = [prospect.next_stage(self._least, price) for prospect in prospects]
            number = int(np.argmax([gain for gain, _ in stages]))
            prospect = prospects[number]
            gain, index = stages[number]
            reason = "nothing keeps the bounds yet"
            if self._least < math.inf:
                if gain <= 0.0:
                    self._trace.note("end", reason="no trial is worth its price")
                    return
                reason = f"{gain:.2%} expected"
            try:
                self._open(prospect, index, reason)
            except LimitError:  # blocks that decoders would refuse
                self.prospects.remove(prospect)
        self._trace.note("end", reason="all steps were tried")

    def _open(self, prospect: Prospect, index: int, reason: str) -> None:
        """Code a trial, or draw one that is coded."""
        if prospect.states[index] == UNCODED:
            self._code(prospect, index, reason)
        else:
            self._draw(prospect, index, reason)

    def _code(self, prospect: Prospect, index: int, reason: str) -> None:
        way = prospect.way
        trial = way.at(math.exp(prospect.steps[index]))
        self._bounds.measures.progress.by(CODING)
        size = self.size_of(way, trial)
        if not prospect.sizes.count:
            self._correct_kin(prospect, size - float(prospect.sizes.mean[index]))
        prospect.add(index, trial, size)
        self._trace.note("code", way.name, step=trial.step, size=math.exp(size), reason=reason)

    def _draw(self, prospect: Prospect, index: int, reason: str) -> None:
        """Draw a trial, and take it if it is the best one; close steps that are too coarse if it is faulty."""
        way = prospect.way
        trial = prospect.coded[index]
        error = self._bounds.excess(trial)
        prospect.judge(index, error)
        size = float(prospect.sizes.mean[index])
        self._note_drawing(way, trial, size, error, reason)
        if error > 0.0 or size >= self._least:
            return
        is_faulty = self._is_faulty(trial)
        mended = None
        if is_faulty:
            mended = way.mended(trial)
        if mended is not None:
            trial = mended
            error = self._bounds.excess(trial)
            size = self.size_of(way, trial)
            self._note_drawing(way, trial, size, error, "with fewer folds")
            if error > 0.0 or size >= self._least:
                return
            is_faulty = self._is_faulty(trial)
        finer = self._finer(trial, is_faulty)
        if finer:
            prospect.close(prospect.steps > prospect.steps[index] - finer)
        else:
            self.best = trial
            self._least = size

    def _note_drawing(
        self, way: Way, trial: Trial, size: float, error: float, reason: str = ""
    ) -> None:
        """Add a drawn trial to the trace; size and error are logarithms."""
        facts = {"step": trial.step, "size": math.exp(size), "error": math.exp(error)}
        self._trace.note("draw", way.name, **facts, reason=reason)

    def _correct_kin(self, opened: Prospect, surprise: float) -> None:
        """Correct the estimates of ways that err together with one whose first trial is coded."""
        for prospect in self.prospects:
            is_kin = prospect is not opened and prospect.estimate.kin == opened.estimate.kin != ""
            if is_kin and not prospect.sizes.count:
                prospect.sizes.shift(surprise, 2.0 * SLACK)

    def _finer(self, trial: Trial, is_faulty: bool) -> float:
        """Return by how much a step must be finer, as a logarithm, where a trial is refused; 0: it is not."""
        if is_faulty:
            self._refusals += 1  # slivers may need steps that are far finer
            return DOUBT
        if self._bounds.keeps(trial):
            return 0.0
        return SLACK

    def _is_faulty(self, trial: Trial) -> bool:
        is_seen = self._bounds.metric is not None
        return is_seen and self._refusals < MOST_REFUSALS and self._bounds.is_faulty(trial)

    def widen(self, ways: list[Way]) -> None:
        """Find the widest step of each way that keeps the bounds, until finer ones take more bytes than another way."""
        expected: dict[str, float] = {}

        def excess(way: Way, step: float) -> float:
            trial = way.at(step)
            size = self.size_of(way, trial)
            error = self._bounds.excess(trial)
            self._note_drawing(way, trial, size, error)
            expected.setdefault(way.name, size + max(error, 0.0))
            if error > 0.0:
                if size < self._least:
                    return error
                # A way that takes more bytes than another one where it is too coarse ends here.
                return -SLACK / 4.0
            if size < self._least and not self._finer(trial, self._is_faulty(trial)):
                self.best = trial
                self._least = size
            return error

        for tries in (1, TRIES):
            for way in sorted(ways, key=lambda way: expected.get(way.name, 0.0)):
                range_of_steps = way.first, way.least, way.most
                with suppress(LimitError):  # blocks that decoders would refuse
                    secant(partial(excess, way), *range_of_steps, tries, slack=SLACK / 2.0)
