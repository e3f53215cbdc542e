"""Positions on grids whose places are rounded, or chosen for the normals: ways to code a mesh."""

import math
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.header import Header
from bsm.bitstream.errors import TargetError
from bsm.bitstream.fields.corners import MOST_LARGEST
from bsm.bitstream.fields.grid import ordered
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.geometry.mesh import box_around, extent_of
from bsm.codec.static.choice.bounds import COARSEST, SPIKE, Bounds, Candidate, turned
from bsm.codec.static.choice.shaping import Aim
from bsm.codec.static.preamble_encoding import Draft, Prepared
from bsm.codec.static.units import single
from bsm.codec.static.ways.grid import Grid, encode_grid, sampled_ratio

MOST_CELLS = 65535  # along the longest side, where floats are exact, and of a grid on which a mesh may have been made
PART_OF_CELL = 1.0 / 64.0
SAMPLE = 1 << 11
"""Vertices that tell that a mesh is on no grid, and about how large a grid is, before all are looked at."""


def grid_draft(prepared: Prepared, grid: Grid, places: Levels, light: bool = False) -> Draft:
    """The stream of places on a grid, shape (n, 3), none negative; with the small model, which is quick, if `light`."""
    grid = replace(grid, light=light or prepared.light)
    header = Header(vertices=prepared.graph.size, faces=len(prepared.mesh.faces), **grid.fields)
    body = (*prepared.before_grid, *encode_grid(prepared.mesh.faces, grid, places))
    return Draft(header, body, grid.positions(places), places)


def rounded(prepared: Prepared, bits: int) -> Draft:
    """Round every position to a grid with `bits` bits along the longest side of the bounding box."""
    positions = prepared.mesh.positions
    cells = (1 << bits) - 1
    largest, extent = np.abs(positions).max(), np.ptp(positions, axis=0).max()
    with np.errstate(over="ignore", invalid="ignore"):
        narrow = np.spacing(np.float32(largest)) * cells < PART_OF_CELL * extent
    kind = np.float32 if narrow else np.float64
    if (recomputed := _made_on_grid(positions, cells, kind)) is not None:
        return grid_draft(prepared, *recomputed)
    values = positions.astype(kind)
    low = values.min(axis=0)
    most, extent = kind(cells), (values - low).max()
    if not extent > 0:
        extent = kind(1)
    places = np.floor((values - low) * (most / extent) + kind(0.5)).astype(np.int32)
    step = float(extent / most)
    if not (step > 0.0 and np.isfinite(step)):
        raise TargetError(f"a grid of {bits} bits is beyond the range of numbers for this mesh")
    return grid_draft(prepared, Grid(tuple(map(float, low)), step, tuple(places.max(axis=0).tolist())), places)


def _made_on_grid(positions: Matrix, cells: int, kind: type[np.floating[Any]]) -> tuple[Grid, Levels] | None:
    """Return the grid with `cells` cells that positions, shape (n, 3), lie on, or None."""
    low = positions.min(axis=0)
    near = kind((positions - low).max() / cells)
    if not near > 0:
        return None
    for step in map(float, (near, np.nextafter(near, kind(0)), np.nextafter(near, kind(np.inf)))):
        if step > 0.0 and np.isfinite(step):
            places = np.rint((positions - low) / step)
            grid = Grid(tuple(map(float, low)), step, tuple(places.max(axis=0).astype(int).tolist()))
            if (grid.positions(places.astype(np.int32)) == positions).all():
                return grid, places.astype(np.int32)
    return None


def exact(prepared: Prepared) -> Draft:
    """Every position, which is one of single precision, to the bit: a grid, and which float of its cell each is."""
    narrow = prepared.mesh.positions.astype(np.float32)
    held, floats = narrow.astype(np.float64), ordered(narrow)
    coarsest = 2.0 * float(np.spacing(np.abs(narrow).max()))  # in a smaller cell there may be no float
    step = _decimal(narrow, coarsest)
    if step is None:
        step = max(float(np.ptp(held, axis=0).max()) / MOST_CELLS, coarsest)
    origin = (np.floor(held.min(axis=0) / step) - 1.0) * step
    places = np.floor((held - origin) / step + 0.5).astype(np.int64)
    grid = Grid(tuple(map(float, origin)), step, tuple(int(value) for value in places.max(axis=0) + 1), exact=True)
    for _ in range(4):  # where rounding has put one beside its cell
        cells = grid.cells(places.astype(np.int32))
        places += (floats >= cells.high).astype(np.int64) - (floats < cells.low)
    coded = places.astype(np.int32)
    grid = replace(grid, largest=tuple(int(value) for value in coded.max(axis=0)))
    header = Header(vertices=prepared.graph.size, faces=len(prepared.mesh.faces), **grid.fields)
    body = (*prepared.before_grid, *encode_grid(prepared.mesh.faces, grid, coded, held))
    return Draft(header, body, held, coded)


def _decimal(narrow: npt.NDArray[np.float32], least: float) -> float | None:
    """A power of ten, at least so much, of which all coordinates, shape (n, 3), are multiples, but for rounding."""
    held = narrow.astype(np.float64)
    for power in range(math.floor(math.log10(max(np.ptp(held, axis=0).max(), least))), -sys.float_info.max_10_exp, -1):
        step = float(f"1e{power}")
        places = np.rint(held / step)
        if step < least or np.ptp(places, axis=0).max() >= MOST_LARGEST - 1:
            return None
        if (np.float32(places * step) == narrow).all():
            return step
    return None


def rounded_to_cells(prepared: Prepared, cell: float, origin: tuple[float, float, float]) -> Draft:
    """Every position at the nearest place of a grid that is given: at ``origin + k * cell``, k whole numbers."""
    corner = np.array(origin)
    with np.errstate(over="ignore", invalid="ignore"):
        places = np.floor((prepared.mesh.positions - corner) / cell + 0.5)
    if not (np.spacing(np.abs(places)) < 1.0).all():
        raise TargetError(f"cells of {cell:g} are too small to count from {origin} to this mesh")
    everywhere = np.full(3, -float(MOST_LARGEST // 2 + 1))
    wanted = (places - everywhere) * cell + (everywhere * cell + corner)
    # Counted from the mesh, or from the origin if that gives the same positions: smaller numbers.
    for least in (places.min(axis=0), np.zeros(3), everywhere):
        coded, low = places - least, least * cell + corner
        if coded.min() >= 0.0 and coded.max() <= MOST_LARGEST and (coded * cell + low == wanted).all():
            grid = Grid(tuple(map(float, low)), cell, tuple(int(value) for value in coded.max(axis=0)))
            return grid_draft(prepared, grid, coded.astype(np.int32))
    if np.ptp(places, axis=0).max() > MOST_LARGEST:
        raise TargetError(f"this mesh is larger than {MOST_LARGEST} cells of {cell:g}; choose larger ones")
    raise TargetError(
        f"this mesh is more than {MOST_LARGEST // 2} cells of {cell:g} from {origin}, too far to tell places exactly; "
        "choose an origin that is nearer, or a power of two as cell and multiples of it as origin"
    )


def made_on(positions: Matrix, within: float) -> float | None:
    """The step of the coarsest grid from the lower corner on that all positions are on, within so much or rounding."""
    extent = float(extent_of(positions).max())
    noise = max(4.0 * float(np.spacing(np.float32(np.abs(positions).max()))), within) / extent
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
            if step < max(1.0 / MOST_CELLS, 8.0 * noise):
                return None
        if not len(values) or (np.abs(values - np.rint(values / step) * step) > noise).any():
            return None
    return step * extent


class Gridded:
    """Grids of one mesh, at one step after another; the worth of a nat in angles by which a step bends a mean face."""

    def __init__(self, prepared: Prepared, bounds: Bounds, worth: float = 0.0) -> None:
        self._prepared, self._shaper = prepared, bounds.measures.shaper
        self._worth = worth
        low = box_around(prepared.mesh.positions)[0]
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
        self.at = lru_cache(1)(self._made)

    @cached_property
    def first(self) -> float:
        # Where half a diagonal of cells is beyond the least reach, it is not the look that decides.
        return min(self._bounds.first_step, COARSEST, 2.0 * float(self._bounds.reaches.min()) / math.sqrt(3.0))

    def _made(self, step: float) -> Candidate:
        unit = self._prepared.units.scale
        held = single(max(step, self.least) * unit)
        places = np.floor((self._prepared.positions - self._low) / (held / unit) + 0.5).astype(np.int32)
        if self._worth:
            reach = min(float(self._bounds.reaches.min()), SPIKE * step)
            aim = Aim(self._worth * step / self._shaper.mean_edge, reach, 3)
            places = self._shaper.places(places, self._low, held / unit, aim)
        candidate = self._placed(held, places)
        return turned(candidate) or candidate

    def _placed(self, held: float, places: Levels) -> Candidate:
        """Places from the origin on, some below it, perhaps."""
        least = places.min(axis=0)
        origin = tuple(self._hold(value) for value in self._origin + least * held)
        grid = Grid(origin, held, tuple(int(value) for value in np.ptp(places, axis=0)))
        candidate = self._candidate(grid, places - least)

        def unfold() -> Candidate | None:
            cell = held / self._prepared.units.scale
            directions, reach = cell * np.eye(3).reshape(1, 9), np.minimum(self._bounds.reaches, SPIKE * cell)
            turned = self._shaper.unfold(candidate.positions, places, directions, reach)
            return None if turned is None else self._placed(held, turned)

        return replace(candidate, unfold=unfold)

    def made(self) -> Iterator[Candidate]:
        """The grids that the mesh was made on, or about, in single precision; and exactly, where one holds all."""
        positions = self._prepared.mesh.positions
        for within in (0.0, PART_OF_CELL * self._shaper.mean_edge * self._prepared.units.scale):
            if (step := made_on(positions, within)) is not None:
                yield self.at(step / self._prepared.units.scale)
                exactly = _made_on_grid(positions, round(float(extent_of(positions).max()) / step), np.float64)
                yield from () if exactly is None else (self._candidate(*exactly),)

    def _candidate(self, grid: Grid, places: Levels) -> Candidate:
        coded, step = partial(grid_draft, self._prepared, grid, places), grid.step / self._prepared.units.scale
        positions = np.ascontiguousarray(self._prepared.units.into(grid.positions(places)))
        sampled = partial(sampled_ratio, self._prepared.mesh.faces, grid, places, SAMPLE)
        few = len(places) <= SAMPLE or self._prepared.light
        return Candidate(step, positions, coded, guess=None if few else lambda: coded(light=True).size * sampled())
