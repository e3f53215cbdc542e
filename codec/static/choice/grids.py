"""Positions on grids whose places are rounded, or chosen for the normals: ways to code a mesh."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from bsm.bitstream.fields.corners import MOST_LARGEST
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.geometry.mesh import extent_of
from bsm.codec.static.choice.bounds import COARSEST, Bounds, Candidate
from bsm.codec.static.choice.lattices import grid_draft
from bsm.codec.static.choice.shaping import SAMPLE, Aim
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.units import single
from bsm.codec.static.ways.grid import Grid

NEAR_PLACE = 3.0  # how far shaping may bring a vertex from its place, in cells, where bounds are wide
FINEST_BITS, PARTS_OF_OCTAVE, WIDER, MOST_TRIED, APART = 16, 128, 1.4, 8, 1.02
"""Bits along the longest side of the finest grid on which a mesh may have been made; how many steps are compared
between one and twice it; how much coarser ones may be than one that is about right; how many are tried; and how far
apart, at least, those are that are coarser."""
MOST_PARTS = 256  # of models of few vertices: cells along the longest side


def made_on(positions: Matrix) -> float | None:
    """The step of the coarsest grid from the lower corner on that all positions are on, but for rounding to floats."""
    extent = float(extent_of(positions).max())
    noise = 4.0 * float(np.spacing(np.float32(np.abs(positions).max()))) / extent
    for some in (positions[:: 1 + len(positions) // SAMPLE], positions):
        values = np.unique((some - some.min(axis=0)) / extent)
        values = values[values > noise]
        step = reach = float(values.min(initial=math.inf))
        while len(values) and reach < 4.0 * values[-1]:
            near = values[values <= reach]
            counts = np.rint(near / step)
            left = np.abs(near - counts * step)
            if (left > step / 8.0).any():  # then the step divides that, too, as Euclid has it
                step = float(left[left > step / 8.0].min())
                reach = max(step, float(values[0]))
            else:
                step, reach = float(counts @ near / (counts @ counts)), 4.0 * reach
            if step * 2.0**FINEST_BITS < 1.0:
                return None
        if not len(values) or (np.abs(values - np.rint(values / step) * step) > noise).any():
            return None
    return step * extent


class Gridded:
    """Grids of one mesh, at one step after another; what a nat is worth in angles that a step bends a mean face by."""

    def __init__(self, prepared: Prepared, bounds: Bounds, worth: float, low: Matrix | None = None) -> None:
        self._prepared, self._shaper = prepared, bounds.measures.shaper
        self._reach = float(bounds.reaches.min())
        self._worth = worth
        low = prepared.mesh.positions.min(axis=0) if low is None else low
        narrow = low.astype(np.float32)
        fine = np.spacing(np.abs(narrow)).max() < 1e-6 * prepared.units.scale
        self._hold = single if fine else float
        below = np.where(narrow > low, np.nextafter(narrow, np.float32(-np.inf)), narrow).astype(np.float64)
        self._origin = below if fine else low
        self._low = prepared.units.into(self._origin)
        smallest = float(np.finfo(np.float32).smallest_subnormal) / prepared.units.scale
        self.least = max(float((prepared.positions - self._low).max()) / (MOST_LARGEST - 4), smallest)
        self.most = COARSEST
        self._bounds = bounds

    @cached_property
    def first(self) -> float:
        """The step that is about right."""
        return min(self._bounds.first_step, COARSEST)

    def guess(self) -> float:
        """About the bytes that it takes; of a model nobody can tell."""
        character = self._shaper.character
        return 0.0 if character.is_model else character.entropy(self._bounds.rough_step)

    def at(self, step: float) -> Candidate:
        """What a step comes to."""
        unit = self._prepared.units.scale
        held = single(max(step, self.least) * unit)
        places = np.floor((self._prepared.positions - self._low) / (held / unit) + 0.5).astype(np.int32)
        if self._worth:
            aim = Aim(self._worth * step / self._shaper.character.mean_edge, min(self._reach, NEAR_PLACE * step), 3)
            places = self._shaper.places(places, self._low, held / unit, aim)
        return self._placed(held, places)

    def _placed(self, held: float, places: Levels) -> Candidate:
        """Places from the origin on, some below it, perhaps."""
        least = places.min(axis=0)
        origin = tuple(self._hold(value) for value in self._origin + least * held)
        grid = Grid(origin, held, tuple(int(value) for value in np.ptp(places, axis=0)))
        candidate = self._candidate(grid, places - least)

        def unfold() -> Candidate | None:
            directions = held / self._prepared.units.scale * np.eye(3).reshape(1, 9)
            turned = self._shaper.unfold(candidate.positions, places, directions, self._bounds.reaches)
            return None if turned is None else self._placed(held, turned)

        return replace(candidate, unfold=unfold)

    def made(self) -> Iterator[Candidate]:
        """The grid that the mesh was made on."""
        step = made_on(self._prepared.mesh.positions)
        if step is not None:  # wherever coarser ones are looked for, from what looks about right on
            made = self.at(step / self._prepared.units.scale)
            yield replace(made, step=max(made.step, self._bounds.rough_step))

    def counted(self, step: float) -> Candidate:
        """A grid of this step with places that are counted from where the mesh's unit begins: shorter to write."""
        held = single(step * self._prepared.units.scale)
        places = np.floor(self._prepared.mesh.positions / held + 0.5).astype(np.int32)
        least = places.min(axis=0)
        corner = tuple(map(int, least)) if least.any() else ()
        grid = Grid((0.0, 0.0, 0.0), held, tuple(map(int, np.ptp(places, axis=0))), corner=corner)
        return self._candidate(grid, places - least)

    def smooth(self, right: float) -> Iterator[Candidate]:
        """Grids on which the mesh takes less than on those beside them, as where it was made on one.

        First ones that are finer than one that is about right, and take less all the same; then ones that are coarser.
        """
        character, extent = self._shaper.character, float(extent_of(self._prepared.positions).max())
        steps = {extent / ((1 << bits) - 1) for bits in range(1, FINEST_BITS)}
        steps |= {extent * 2.0 ** (-k / PARTS_OF_OCTAVE) for k in range(FINEST_BITS * PARTS_OF_OCTAVE)}
        tried = sorted(step for step in steps if step <= WIDER * right)
        entropies = np.array([character.entropy(step) for step in tried])
        low = (entropies[1:-1] <= np.minimum(entropies[:-2], entropies[2:])) & (
            entropies[1:-1] < character.entropy(right)
        )
        found = np.flatnonzero(low) + 1
        made, last = [i for i in found if tried[i] <= right], right
        made.sort(key=lambda i: float(entropies[i]))
        for i in found:
            if tried[i] > APART * last:
                made.append(i)
                last = tried[i]
        yield from (self.at(tried[i]) for i in made[:MOST_TRIED])

    def fitting(self) -> Iterator[Candidate]:
        """Grids that a model of few vertices fits better than all coarser ones, from its corner or from its zero."""
        extent, closest = float(extent_of(self._prepared.positions).max()), math.inf
        farthest = float(np.abs(self._prepared.mesh.positions).max()) / self._prepared.units.scale
        far = farthest > MOST_LARGEST * extent / MOST_PARTS
        for parts, make in product(range(1, MOST_PARTS), (self.at, self.counted)[: 1 if far else 2]):
            if not single(extent / parts * self._prepared.units.scale) > 0.0:
                return  # beyond the range of numbers
            candidate = make(extent / parts)
            off = float(np.square(candidate.positions - self._prepared.positions).sum(axis=1).max())
            if off <= closest:
                closest = off
                yield candidate

    def _candidate(self, grid: Grid, places: Levels) -> Candidate:
        positions = np.ascontiguousarray(self._prepared.units.into(grid.positions(places)))
        return Candidate(
            grid.step / self._prepared.units.scale, positions, lambda: grid_draft(self._prepared, grid, places)
        )
