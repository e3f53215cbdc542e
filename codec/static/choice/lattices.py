"""Drafts of positions on given grids, and of exact ones."""

import math
import sys
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.header import Header
from bsm.bitstream.errors import TargetError
from bsm.bitstream.fields.corners import MOST_LARGEST
from bsm.bitstream.fields.grid import find_lattice, ordered
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.static.draft import Draft
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.ways.grid import Grid, encode_exact, encode_grid

EXACT_CELLS = 65535  # along the longest side, where floats are exact; from 2^15 to 2^20 bytes are the same within 0.1 %
PART_OF_CELL = 1.0 / 64.0


def grid_draft(prepared: Prepared, grid: Grid, places: Levels) -> Draft:
    """The stream of places on a grid, shape (n, 3), none negative."""
    grid = replace(grid, light=prepared.light)
    header = Header(vertices=prepared.graph.size, faces=len(prepared.mesh.faces), **grid.fields)
    body = (*prepared.before_grid, *encode_grid(prepared.mesh.faces, grid, places))
    return Draft(header, body, grid.positions(places), places)


def rounded(prepared: Prepared, bits: int) -> Draft:
    """Every position at the nearest place of a grid of so many bits along the longest side of the bounding box."""
    positions = prepared.mesh.positions
    cells = (1 << bits) - 1
    largest, extent = np.abs(positions).max(), np.ptp(positions, axis=0).max()
    with np.errstate(over="ignore", invalid="ignore"):
        narrow = np.spacing(np.float32(largest)) * cells < PART_OF_CELL * extent
    kind = np.float32 if narrow else np.float64
    values = positions.astype(kind)
    low = values.min(axis=0)
    most, extent = kind(cells), (values - low).max()
    if not extent > 0:
        extent = kind(1)
    places = np.floor((values - low) * (most / extent) + kind(0.5)).astype(np.int64)
    step = float(extent / most)
    if not (step > 0.0 and np.isfinite(step)):
        raise TargetError(f"a grid of {bits} bits is beyond the range of numbers for this mesh")
    return grid_draft(prepared, *latticed(tuple(map(float, low)), step, places, cells))


def exact(prepared: Prepared) -> Draft:
    """Every position, which is one of single precision, to the bit: a grid, and which float of its cell each is."""
    narrow = prepared.mesh.positions.astype(np.float32)
    held, floats = narrow.astype(np.float64), ordered(narrow)
    coarsest = 2.0 * float(np.spacing(np.abs(narrow).max()))  # in a smaller cell there may be no float
    step = _decimal(narrow, coarsest)
    if step is None:
        step = max(float(np.ptp(held, axis=0).max()) / EXACT_CELLS, coarsest)
    origin = (np.floor(held.min(axis=0) / step) - 1.0) * step
    places = np.floor((held - origin) / step + 0.5).astype(np.int64)
    grid = Grid(tuple(map(float, origin)), step, tuple(int(value) for value in places.max(axis=0) + 1), exact=True)
    for _ in range(4):  # where rounding has put one beside its cell
        cells = grid.cells(places.astype(np.int32))
        places += (floats >= cells.high).astype(np.int64) - (floats < cells.low)
    coded = places.astype(np.int32)
    grid = replace(grid, largest=tuple(int(value) for value in coded.max(axis=0)))
    header = Header(vertices=prepared.graph.size, faces=len(prepared.mesh.faces), **grid.fields)
    body = (*prepared.before_grid, *encode_exact(prepared.mesh.faces, grid, coded, floats))
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
    # Counted from the mesh on, or from the origin, if the same positions come of that: smaller numbers.
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


def latticed(origin: tuple[float, ...], step: float, places: Matrix, cells: int) -> tuple[Grid, Levels]:
    """The grid of places, shape (n, 3), on a coarser lattice where they all are on one, and the places on that."""
    points, lattice = find_lattice(places, cells)
    return Grid(origin, step, tuple(int(value) for value in points.max(axis=0)), lattice), points
