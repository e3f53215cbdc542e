"""Blocks, alone or with a layer of refinement on them: ways to code a mesh."""

import math
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from bsm.bitstream.container.header import Layer
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix, end_phase
from bsm.codec.geometry.mesh import squares_of
from bsm.codec.signal.transform import smallest_step
from bsm.codec.static.choice.bounds import COARSEST, LEAST, SEEN, SPIKE, Bounds
from bsm.codec.static.choice.settling import RATIO, Settler
from bsm.codec.static.choice.trials import BYTES, DOUBT, Estimate, Trial, ladder_of
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.targets import TRIES
from bsm.codec.static.units import single
from bsm.codec.static.ways.in_blocks import InBlocks, RefinementBase, refine_blocks
from bsm.codec.static.ways.in_cells import MOST_STEPS, SPREADS, InCells, LeveledCells, Spread

BROADEST = 0.14
"""Columns of a dictionary over the rows of a block: wider ones cost decoders more time than their bytes are worth."""
# The step of blocks on all vertices below a layer, over the square root of the layer's step.
BASE = 0.36
APART = 4.0  # steps with other blocks, over one another
UNFOLDED = 4  # rounds in which edges that fold over are mended
SMOOTH, ROUGHER = 0.42, 0.25
"""Bytes of blocks with levels over those of a usual grid, where vertices are a step from the mean of their neighbors;
and the power by which they grow with that."""
# Shares of the remaining time that one spread and all spreads take; measured.
TIME, TIME_OF_ALL = 0.25, 0.45
# Steps of cells that placing these, and what an error costs beside others, take; measured.
PLACING, COUPLING = 5, 4
VAIN = 1.5  # times the bytes of another way, from which on a rough estimate is enough
CODED = 0.72  # bytes by the sizes of levels, over those of the stream
PULLED = 0.12  # what a bit is worth, over the mean cost of an error of one step along the normal


class OnCells:
    """Blocks on the cells of a mesh, spread as takes the fewest bytes."""

    def __init__(self, prepared: Prepared, options: EncodeOptions, bounds: Bounds) -> None:
        self._prepared = prepared
        self._options = options
        self._measures = bounds.measures

    def below(self, step: float) -> RefinementBase:
        """Return the blocks for levels of about a step."""
        layer = Layer(single(step), RATIO)
        spreads, share_of_time = self._spreads(step)
        within = self._measures.progress.within(share_of_time)
        smoothings = len({spread.smoothing for spread in spreads})
        done = 0
        total = MOST_STEPS * len(spreads) + (PLACING + COUPLING) * smoothings
        best: tuple[InCells, LeveledCells] | None = None
        least = math.inf
        in_cells: InCells | None = None
        for spread in spreads:
            # They take as much memory as the mesh, and end with this search.
            if in_cells is None or spread.smoothing != in_cells.smoothing:
                in_cells = InCells(self._prepared, self._options, BROADEST, *spread.smoothing)
                in_cells.place()
                within(done + PLACING, total)
                done += PLACING + COUPLING
            before, begin = math.inf, done
            for cells in in_cells.leveled(spread, step):
                # One after another: each base holds arrays as large as several meshes.
                size = in_cells.base(cells).about(layer)
                end_phase(self._prepared.graph.size)
                done += 1
                within(done, total)
                if size < least:
                    best = (in_cells, cells)
                    least = size
                # From the finest step of cells on, sizes fall to the best one and rise after it.
                if size > before:
                    break
                before = size
            done = begin + MOST_STEPS
        assert best is not None  # each spread has at least one
        in_cells, cells = best
        return in_cells.base(in_cells.settled(cells))

    def _spreads(self, step: float) -> tuple[tuple[Spread, ...], float]:
        """Return the spreads to try for levels of about a step, and the share of the remaining time they take."""
        if step > 2.0 * SEEN * self._measures.shaper.mean_edge:  # most levels are 0
            return SPREADS, TIME_OF_ALL
        return SPREADS[:1], TIME


class OnVertices:
    """Blocks on all vertices of a mesh, which take decoders longer."""

    def __init__(self, prepared: Prepared, options: EncodeOptions, bounds: Bounds) -> None:
        spectral = InBlocks(prepared, options, BROADEST)
        progress = bounds.measures.progress
        self.least = 1.01 * smallest_step(prepared.size)
        self.at = lru_cache(2)(lambda step: spectral.base(step, progress.within()))

    def step_below(self, step: float) -> float:
        """Return the step of blocks for levels of a step."""
        return max(BASE * math.sqrt(step), self.least)

    def below(self, step: float) -> RefinementBase:
        """Return the blocks for levels of about a step."""
        return self.at(self.step_below(step))


class Plain:
    """Only blocks; a layer of levels corrects vertices that are out of reach."""

    name = "blocks only"

    def __init__(self, bounds: Bounds, blocks: OnVertices, first: float) -> None:
        self._bounds = bounds
        self._blocks = blocks
        self.least = blocks.least
        self.most = 0.5
        self.first = blocks.step_below(first)

    @property
    def ladder(self) -> Matrix:
        return ladder_of(self.least, self.most)

    def estimate(self, rival: float) -> Estimate:
        """Return a guess: about as many bytes as others take."""
        return Estimate(rival, DOUBT, BYTES * self._bounds.measures.prepared.graph.size)

    def at(self, step: float) -> Trial:
        """Return the trial of a step."""
        base = self._blocks.at(step)
        reaches = self._bounds.reaches
        out = squares_of(base.positions - base.prepared.positions) > reaches**2
        if not out.any():
            return Trial(step, base.positions, lambda: base.draft)
        least_reach = float(reaches[out].min())
        layer = Layer(single(max(least_reach, LEAST)), 1.0)
        nearest = np.rint(base.offsets / layer.step)
        levels = np.where(out[:, None], nearest, 0.0).astype(np.int32)
        moved = base.moved(layer, levels, base.known_steps(layer, levels))
        code = partial(refine_blocks, base.prepared, base.draft, layer, levels, moved)
        return Trial(step, moved, code)

    def mended(self, trial: Trial) -> Trial | None:
        """Return None: no look is asked for."""


class Refined:
    """Blocks and a layer of refinement, by its step; steps along tangents are wider by a ratio."""

    def __init__(
        self,
        name: str,
        prepared: Prepared,
        bounds: Bounds,
        blocks: OnCells | OnVertices,
        *,
        settled: bool = True,
        ratio: float = RATIO,
    ) -> None:
        self.name = name
        self._prepared = prepared
        self._bounds = bounds
        self._settled = settled
        self.ratio = ratio
        # Half a diagonal of steps is within the least reach, so that all vertices can be.
        self._diagonal = 2.0 * float(bounds.reaches.min())
        self.least = LEAST
        widest = min(COARSEST, self._diagonal / math.sqrt(3.0))
        self.most = max(widest, LEAST)
        self._below = lru_cache(2)(blocks.below)

    @cached_property
    def first(self) -> float:
        # Of the look that a usual layer takes, steps along tangents take a little less than those along normals.
        wider = math.hypot(1.0, 0.93 * self.ratio / RATIO)
        step = self._bounds.first_step / wider
        return min(max(step, self.least), self.most)

    @property
    def ladder(self) -> Matrix:
        return ladder_of(self.least, self.most)

    def estimate(self, rival: float) -> Estimate:
        """Return about the bytes of a trial at the first step: from the blocks below it, unless the mesh is so rough
        that these would be coded in vain."""
        roughness = self._bend() / self.first
        rough = rival * SMOOTH * roughness**ROUGHER
        saving = BYTES * self._prepared.graph.size
        if rough > VAIN * rival:
            return Estimate(rough, DOUBT, saving)
        base = self._base(self.first)
        size = base.about(Layer(single(self.first), self.ratio))
        finer_layer = Layer(single(self.first / math.e), self.ratio)
        finer = base.about(finer_layer)
        estimate = (size + len(self._prepared.connectivity.data)) / CODED
        return Estimate(estimate, DOUBT, min(saving, (finer - size) / CODED))

    def _bend(self) -> float:
        """How far vertices are from the mean of their neighbors, as a root mean square."""
        graph = self._prepared.graph
        positions = self._prepared.positions
        degrees = np.diff(graph.offsets)
        starts = graph.offsets[:-1]
        sums = [np.add.reduceat(column[graph.neighbors], starts) for column in positions.T]
        means = np.column_stack(sums) / degrees[:, None]
        squares = squares_of(positions - means)
        return math.sqrt(float(squares.mean()))

    def at(self, step: float) -> Trial:
        """Return the trial of a step."""
        # A copy: what levels need of a base, which is large, ends with it.
        base = replace(self._base(step))
        if self._settled:
            nearest = self._nearer(base, *self._evened(step, base))
            return self._unfolded(step, base, *nearest)
        layer = Layer(single(step), RATIO)
        levels = self._shaped(base, layer)
        return self._leveled(step, base, layer, levels, base.known_steps(layer, levels))

    def mended(self, trial: Trial) -> Trial | None:
        """Return None: folds are mended as levels are chosen."""

    def _unfolded(
        self, step: float, base: RefinementBase, layer: Layer, levels: Levels, steps: Matrix
    ) -> Trial:
        """Return the trial of levels with fewer edges folded over; others may then need it."""
        for _ in range(UNFOLDED):
            positions = base.moved(layer, levels, steps)
            directions = base.directions(steps).reshape(-1, 9)
            shaper = self._bounds.measures.shaper
            reach = self._near(steps)
            unfolded = shaper.unfold(positions, levels, directions, reach)
            if unfolded is None:
                break
            levels = unfolded
            steps = base.known_steps(layer, unfolded)
        return self._leveled(step, base, layer, levels, steps)

    def _leveled(
        self, step: float, base: RefinementBase, layer: Layer, levels: Levels, steps: Matrix
    ) -> Trial:
        positions = base.moved(layer, levels, steps)
        code = partial(refine_blocks, base.prepared, base.draft, layer, levels, positions)
        return Trial(step, positions, code, self._settled)

    def _near(self, steps: Matrix) -> Matrix:
        """How far vertices may be brought from their places by steps, shape (n, 3)."""
        heights, shifts = steps[:, 0], steps[:, 1]
        reach = SPIKE * np.maximum(heights, shifts)
        return np.asarray(np.minimum(self._bounds.reaches, reach))

    def _evened(self, step: float, base: RefinementBase) -> tuple[Layer, Levels, Matrix]:
        """Levels that are worth their bits; and their known steps."""
        reaches = self._bounds.reaches
        room = (self._diagonal / step) ** 2 - 1.0
        widest_ratio = math.sqrt(max(room, 0.0) / 2.0)
        ratio = min(max(widest_ratio, 1.0), self.ratio)
        layer = Layer(single(step), ratio)
        steps = base.expected_steps(layer)
        expected = partial(base.known_steps, layer)
        farthest = self._near(steps)
        levels = self._settler.levels(
            base.offsets, base.frames, steps, expected, PULLED, farthest, self.ratio
        )
        levels, known_steps = base.within(reaches, layer, levels)
        gaps = self._bounds.gaps
        if len(gaps.ends):
            moved = base.moved(layer, levels, known_steps) - self._prepared.positions
            levels, known_steps = base.within(gaps.kept(reaches, moved), layer, levels)
        return layer, levels, known_steps

    def _nearer(
        self, base: RefinementBase, layer: Layer, levels: Levels, steps: Matrix
    ) -> tuple[Layer, Levels, Matrix]:
        """These levels, but the nearest ones at edges that fold over."""
        shaper = self._bounds.measures.shaper
        for _ in range(TRIES):  # heights that are mended change steps of others
            wrong = shaper.over(base.moved(layer, levels, steps))
            if not len(wrong):
                break
            levels = levels.copy()
            nearest = base.offsets[wrong] / steps[wrong]
            levels[wrong] = np.rint(nearest)
            steps = base.known_steps(layer, levels)
        return layer, levels, steps

    def _base(self, step: float) -> RefinementBase:
        """The blocks below levels of about a step, which are the same for steps that are near the first one."""
        rung = round(math.log(step / self.first, APART))
        return self._below(self.first * APART**rung)

    def _shaped(self, base: RefinementBase, layer: Layer) -> Levels:
        """Levels that bend faces least: heights first, for the steps of others follow from these."""
        shaper = self._bounds.measures.shaper
        aim = layer.step / shaper.mean_edge, float(self._bounds.reaches.max())
        expected = base.best_levels(base.expected_steps(layer))
        heights = shaper.levels(base.positions, *expected, *aim)
        heights_wanted, directions = base.best_levels(base.known_steps(layer, heights))
        heights_wanted[:, 0] = heights[:, 0]
        return shaper.levels(base.positions, heights_wanted, directions, *aim)

    @cached_property
    def _settler(self) -> Settler:
        return Settler(self._prepared.positions, self._prepared.mesh.faces, self._prepared.graph)
