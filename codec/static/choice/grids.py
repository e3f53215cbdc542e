"""Positions on grids whose places are rounded, or chosen for the normals: ways to code a mesh."""

import math
from collections.abc import Iterable, Iterator
from copy import copy
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np
import numpy.typing as npt

from bsm._core import rounded as places_on
from bsm.bitstream.container.header import MOST_GRID, Header
from bsm.bitstream.container.packets import Grid
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Levels, Matrix
from bsm.codec.geometry.mesh import box_around, extent_of, squares_of
from bsm.codec.geometry.turns import UNTURNED, Turn, turn_of, turned_by
from bsm.codec.static.choice.bounds import COARSEST, SEEN, SPIKE, Bounds, Trial
from bsm.codec.static.choice.congruence import lattice, motions_of, planes_of, transforms_of
from bsm.codec.static.preamble_encoding import Draft, Prepared
from bsm.codec.static.targets import SLACK
from bsm.codec.static.units import single
from bsm.codec.static.ways.grid import SAMPLE, Raster, encode_going, encode_grid, grid_of, sampled_size

MOST_CONGRUENT = 1 << 19  # vertices: of larger meshes, images would take more than some decoders grant


def grid_draft(
    prepared: Prepared, grid: Raster, places: Levels, brief: bool = False, wanted: Matrix | None = None
) -> Draft:
    """The stream of places on a grid, shape (n, 3), none negative; some may come to be elsewhere (`wanted`)."""
    grid = replace(grid, light=grid.light or prepared.light)
    header = Header(vertices=prepared.graph.size, faces=len(prepared.mesh.faces), **grid.fields)
    faces = prepared.linked if brief else prepared.mesh.faces  # if others follow
    coded: Iterable[Grid] = ()
    if wanted is None:
        coded = encode_grid(faces, grid, places)
    else:
        coded, places = encode_going(faces, grid, places, wanted)
    return Draft(header, (*prepared.before_grid, *coded), grid.positions(places), places, brief)


def may_repeat(prepared: Prepared) -> bool:
    """Whether congruent parts are sought."""
    return prepared.congruence and 0 < prepared.graph.size <= MOST_CONGRUENT


def paying(prepared: Prepared, draft: Draft) -> Draft:
    """A draft without quarters of its transforms, and with whole vertices split, which decode slowly, if that pays."""
    places, header = draft.places, draft.header
    if places is None or not header.congruence:
        return draft
    grid, transforms = grid_of(header), transforms_of(prepared, grid_of(header))[: header.transforms]
    kept = [part for part in np.array_split(transforms, 4) if len(part)]
    for i in range(count := len(kept), max(count - 3, 0), -1):
        some = kept[:i] + kept[i + 1 :]
        grid = replace(grid, transforms=np.concatenate(some), whole=i < count and draft.header.whole)
        coded = grid_draft(prepared, grid, places, draft.may_be_brief)
        if coded.size < (1.0 - SLACK * (i == count)) * draft.size:
            draft, kept = coded, some
        elif i < count:
            break  # the quarters before explain more vertices
    return draft


def rounded(prepared: Prepared, bits: int) -> Draft:
    """Round every position to a grid with `bits` bits along the longest side of the bounding box."""
    return grid_draft(prepared, *_rounded(prepared, bits=bits))


def rounded_to_cells(prepared: Prepared, cell: float, origin: tuple[float, float, float]) -> Draft:
    """Every position at the nearest place of a grid that is given: at ``origin + k * cell``, k whole numbers."""
    return grid_draft(prepared, *_rounded(prepared, cell=cell, origin=origin))


def exact(prepared: Prepared) -> Draft:
    """Every position, which is one of single precision, to the bit: a grid, and which float of its cell each is."""
    grid, places = _rounded(prepared)
    grid, held = replace(grid, exact=True), prepared.mesh.positions.astype(np.float32).astype(np.float64)
    header = Header(vertices=prepared.graph.size, faces=len(prepared.mesh.faces), **grid.fields)
    body = (*prepared.before_grid, *encode_grid(prepared.mesh.faces, grid, places, held))
    return Draft(header, body, held, places)


def _rounded(
    prepared: Prepared, bits: int = 0, cell: float = 0.0, origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> tuple[Raster, Levels]:
    """A grid of so many bits, of given cells, or of exact floats, and the places on it, shape (n, 3)."""
    positions = np.ascontiguousarray(prepared.mesh.positions, np.float64)
    corner, step, largest, places = places_on(positions, bits, cell, np.array(origin, np.float64))
    return Raster(corner, step, largest), places


def made_on(positions: Matrix, within: float) -> float | None:
    """The step of the coarsest grid from the lower corner on that all positions are on, within so much or rounding."""
    extent = float(extent_of(positions).max())
    noise = max(4.0 * float(np.spacing(np.float32(np.abs(positions).max()))), within) / extent
    for some in (positions[:: 1 + len(positions) // SAMPLE], positions):
        values = np.sort((some - some.min(axis=0)) / extent, axis=None)  # np.unique would load numpy.ma
        values = values[np.append(values[1:] != values[:-1], True) & (values > noise)]
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
            if step < 8.0 * noise:
                return None
        if not len(values) or (np.abs(values - np.rint(values / step) * step) > noise).any():
            return None
    return step * extent


def spacing_of(positions: Matrix, faces: Faces) -> float:
    """The spacing of rows and columns of a regular mesh, or what divides both, down to an eighth; 0: there is none."""
    some, extent = faces[:: 1 + len(faces) // SAMPLE], extent_of(positions)
    spans = np.abs(positions[some] - positions[np.roll(some, 1, axis=1)]).reshape(-1, 3)
    noise, common = 1e-6 * float(extent.max()), 0.0
    for axis in range(3):
        along = np.sort(spans[spans[:, axis] > 4.0 * noise, axis])
        if 8 * len(along) <= len(spans):
            continue
        alike = np.searchsorted(along, (1.0 + 1e-4) * along + noise) - np.arange(len(along))
        spacing = float(along[alike.argmax() :][: alike.max()].mean())  # what more edges span than anything else
        off = np.abs(along / spacing - np.rint(along / spacing)) > 2.0 * SLACK
        # Without rows, seven in eight would be off.
        if off.mean() < 8.0 * SLACK and extent[axis] > 8.0 * spacing:
            parts = max(spacing, common) / np.arange(1.0, 9.0)
            whole = (min(spacing, common) if common else spacing) / parts
            fits = np.abs(whole - np.rint(whole)) < SLACK / 4.0
            common = float(parts[fits.argmax()] if fits.any() else parts[0])
    return common


class Gridded:
    """Grids of one mesh, at one step after another; the worth of a nat in angles by which a step bends a mean face."""

    def __init__(
        self, prepared: Prepared, bounds: Bounds, worth: float = 0.0, turn: Turn = UNTURNED, spacing: float = 0.0
    ) -> None:
        self._prepared, self._shaper = prepared, bounds.measures.shaper
        self._worth, self.turn, self.spacing = worth, turn, spacing
        self.repeats = False  # whether a grid surely takes fewer bytes with congruent parts
        self.stays = False  # whether vertices do not go to images then
        own = turned_by(prepared.mesh.positions, turn, back=True)
        self._positions = prepared.units.into(own) if any(turn) else prepared.positions
        low = box_around(own)[0]
        if spacing:  # then on rows
            around = np.exp(2j * math.pi / spacing * (self._positions - prepared.units.into(low))).mean(axis=0)
            low = low + np.angle(around) / (2.0 * math.pi) * spacing * prepared.units.scale
        narrow = low.astype(np.float32)
        fine = np.spacing(np.abs(narrow)).max() < 1e-6 * prepared.units.scale
        self._hold = single if fine else float
        below = np.where(narrow > low, np.nextafter(narrow, np.float32(-np.inf)), narrow).astype(np.float64)
        self._origin = below if fine else low
        self._low = prepared.units.into(self._origin)
        smallest = float(np.finfo(np.float32).smallest_subnormal) / prepared.units.scale
        self.least = max(float((self._positions - self._low).max()) / (MOST_GRID - 4), smallest)
        self.most = COARSEST
        self._bounds = bounds
        self._last: tuple[float, Trial] | None = None

    @cached_property
    def first(self) -> float:
        # Where half a diagonal of cells is beyond the least reach, it is not the look that decides.
        step = min(self._bounds.first_step, COARSEST, 2.0 * float(self._bounds.reaches.min()) / math.sqrt(3.0))
        return float(self.dividing(step))

    def dividing(self, step: npt.ArrayLike) -> Matrix:
        """The widest step up to a wanted one that divides the spacing of rows and columns, if there are any."""
        parts = np.maximum(np.ceil(self.spacing / np.asarray(step) - 2.0 * SLACK), 1.0)
        return np.asarray(self.spacing / parts if self.spacing else step)

    def regular(self) -> list["Gridded"]:
        """These grids, rounded and chosen, with cells that divide the spacing of a regular mesh: at such steps, which
        others meet by luck, its rows and columns take hardly any bytes."""
        spacing = spacing_of(self._positions, self._prepared.mesh.faces)
        worths = (0.0, 1.0) if spacing > 2.0 * SLACK * self.first else ()
        return [Gridded(self._prepared, self._bounds, worth, self.turn, spacing) for worth in worths]

    @cached_property
    def _planes(self) -> list[Matrix]:
        own = turned_by(self._prepared.mesh.positions, self.turn, back=True)
        return planes_of(own, self._prepared.mesh.faces)

    def at(self, step: float) -> Trial:
        if self._last is None or self._last[0] != step:
            self._last = step, self._made(step)
        return self._last[1]

    def _made(self, step: float, mirrored: bool = True) -> Trial:
        unit = self._prepared.units.scale
        step = float(self.dividing(step))
        held, origin = single(max(step, self.least) * unit), self._origin
        if mirrored and not self.spacing and may_repeat(self._prepared):
            if not self._prepared.motions:  # the same ladder for all looks
                motions_of(self._prepared, max(self._bounds.usual_step, self.least) * unit, self.turn)
            held, moved = lattice(self._prepared, origin, held, self.least * unit, self.turn, self._planes)
            origin = np.array([self._hold(value) for value in moved])
        low = self._prepared.units.into(origin)
        places = np.floor((self._positions - low) / (held / unit) + 0.5).astype(np.int32)
        if self._worth:
            worth, reach = self._worth * step / self._shaper.mean_edge, float(self._bounds.reaches.min())
            places = self._shaper.places(places, low, held / unit, worth, min(reach, SPIKE * step))
        places = self._apart(places, low, held / unit)
        least = places.min(axis=0)  # some may be below the origin
        start = tuple(self._hold(value) for value in origin + least * held)
        grid = Raster(start, held, tuple(int(value) for value in np.ptp(places, axis=0)), turn=self.turn)
        largest = np.array(grid.largest, np.int32)
        places = places - least
        if self._bounds.metric is not None:  # pictures show faces without area; on coarse grids there are many
            places = self._prepared.linked.mended(places, largest, self._wanted(grid, places))
        return replace(self._candidate(grid, places), step=step)

    def _apart(self, places: Levels, low: Matrix, cell: float) -> Levels:
        """Places from `low` on; vertices that would close a gap between parts are moved away, a cell or a few."""
        gaps, toward = self._bounds.gaps, turned_by(self._bounds.gaps.closing[:, 0], self.turn, back=True)
        away = -np.rint(toward / np.abs(toward).max(axis=1, keepdims=True)).astype(np.int32)
        for first in (1, 0, 0) if len(away) else ():
            closed = gaps.closed(turned_by(places * cell + low - self._positions, self.turn)) > 1.0
            wrong = closed & (gaps.ends[:, 0] >= first * gaps.ends[:, 1])  # at first, of one of two parts
            places[gaps.ends[wrong, 0]] += away[wrong]
        return places

    def in_frame(self) -> "Gridded":
        """The grid in the axes of the part, if that takes much fewer bytes at the first step."""
        prepared = self._prepared
        if not may_repeat(prepared) or prepared.light or self._bounds.measures.normals is not None:
            return self  # sent normals stay in the axes of the mesh, and may be predicted from the grid
        positions, faces = prepared.positions, prepared.mesh.faces
        if not any(turn := turn_of(positions, faces[:: 1 + len(faces) // (4 * SAMPLE)])):
            return self
        other = Gridded(prepared, self._bounds, turn=turn)
        own, others = (grid.at(self.first).congruent.size for grid in (self, other))
        return other if others < (1.0 - SLACK) * own else self

    def repeat(self, first: Trial) -> Trial:
        """Predict by congruent parts from now on if that pays in the first trial; return it so."""
        prepared, step = self._prepared, max(first.step, self.least) * self._prepared.units.scale
        if may_repeat(prepared) and len(motions_of(prepared, step, self.turn)[0]):
            self.repeats = True
            made = self._made(first.step)
            self.repeats = made.draft.size < (1.0 - SLACK) * first.draft.size
            if self.repeats:
                self._last = None
                return made
        return first

    def still(self) -> "Gridded":
        """These grids with vertices that stay where parts repeat, because what moves may be seen."""
        other = Gridded(self._prepared, self._bounds, turn=self.turn)
        other.repeats, other.stays = self.repeats, True
        return other

    def usual(self) -> Iterator[Trial]:
        """The trial with which the search for a look of 1 begins, if that is a stricter one and parts or spacings
        repeat: there, bytes hardly depend on steps, but on luck."""
        step = self._bounds.usual_step
        if (self.repeats or self.spacing) and step < self.first:
            yield self.at(max(step, self.least))

    def made(self) -> Iterator[Trial]:
        """The grids that the mesh was made on, or about, in single precision."""
        unit = self._prepared.units.scale
        for within in (0.0, SEEN * self._shaper.mean_edge * unit):
            if (step := made_on(self._prepared.mesh.positions, within)) is not None:
                yield self._made(step / unit, mirrored=False)

    def _candidate(self, grid: Raster, places: Levels) -> Trial:
        prepared, may = self._prepared, may_repeat(self._prepared)
        way = copy(self)  # as it is now, and without its last trial, which would keep itself
        way._last = None

        @lru_cache
        def coded(repeats: bool) -> Draft:
            found = transforms_of(prepared, grid) if repeats else None
            moves = way.repeats and not way.stays and found is not None and len(found) > 0
            wanted = way._wanted(grid, places) if moves else None
            whole = replace(grid, transforms=found)
            return grid_draft(prepared, whole, places, may and not prepared.light, wanted)

        def repeating() -> Draft:
            if not may or way.repeats:
                return coded(way.repeats)
            some, sized = transforms_of(prepared, grid), partial(sampled_size, prepared.mesh.faces, coded=places)
            if len(some) or prepared.light or len(places) <= SAMPLE:
                return coded(len(some) > 0 or not prepared.light)
            return coded(sized(replace(grid, transforms=some)) < sized(grid))

        def about() -> int:
            if may and len(transforms_of(prepared, grid)):
                return 0
            return grid_draft(prepared, replace(grid, light=True), places, may).size

        decoded = coded(True).decoded if self.repeats else grid.positions(places)
        positions = np.ascontiguousarray(prepared.units.into(decoded))
        step, fixed = grid.step / prepared.units.scale, len(prepared.connectivity.data)
        make = partial(coded, self.repeats)
        return Trial(step, positions, make, fixed, repeating=repeating, decoded=decoded, about=about)

    def _wanted(self, grid: Raster, places: Levels) -> Matrix:
        """Where each vertex would be, in cells, and the square of how far from there it may come, shape (n, 4)."""
        cell, low = grid.step / self._prepared.units.scale, self._prepared.units.into(np.array(grid.origin))
        wanted, gaps = (self._positions - low) / cell, self._bounds.gaps
        reach = np.minimum(gaps.kept(self._bounds.reaches) / cell, SPIKE)
        # Who is past the middle of a gap leaves no room in it: there, all stay where they are.
        past = squares_of(places - wanted) > np.square(reach)
        reach[gaps.ends[past[gaps.ends].any(axis=1)]] = 0.0
        return np.column_stack([wanted, np.square(reach)])
