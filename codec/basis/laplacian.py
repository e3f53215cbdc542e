"""The Laplacian of a block, L = D - W, and the solver behind R = (L + delta I)^-1 (paper, sections 3 and 4).

Equation 2 of the paper weighs edges by geometry; the decoder of a mesh has only connectivity, so all weights are one
there, while the frames of a sequence have a first one to weigh them by (`codec.basis.weighted`).

The order of elimination is nested dissection along the bisection that ordered the rows. The rows before a cut that see
across it separate the two halves; they are eliminated after both. The rows of a separator, or of a half that is not cut
further, make a front: its own steps, and the later steps to which they lead, its border. A front is kept as a dense
matrix, one row for each of its own steps, own steps first and then the border; this costs some fill and buys vector
instructions (C. Ashcraft, R. Grimes, "The influence of relaxed supernode partitions on the multifrontal method", 1989).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import LimitError
from bsm.codec import _kernels
from bsm.codec.arrays import Basis, Matrix
from bsm.codec.blocks.overlap import Block

LEAF = 8  # halves of at most so many rows are not cut further

WORK = 1 << 16
"""Operations of a factorisation, per row, that are too many; surfaces in blocks of 8,000 take an eighth of them."""

_FULL, _TOO_MUCH = -1, -2
"""What the kernel answers where there is no room for the borders, and where there are too many operations."""


class Fronts(NamedTuple):
    """The fronts of a block of n rows, in the order of elimination."""

    rows: npt.NDArray[np.uint32]
    steps: npt.NDArray[np.uint32]
    owners: npt.NDArray[np.uint32]
    firsts: npt.NDArray[np.uint32]
    starts: npt.NDArray[np.uint32]
    borders: npt.NDArray[np.uint32]
    places: npt.NDArray[np.uint32]
    sums: npt.NDArray[np.float64]


def find_fronts(offsets: npt.NDArray[np.int32], neighbours: npt.NDArray[np.int32]) -> Fronts:
    """Fronts of a graph whose rows are in the order of a recursive bisection; any order will do."""
    n = len(offsets) - 1
    rows, steps, owners = np.empty((3, n), np.uint32)
    firsts, starts, places = np.empty((3, n + 1), np.uint32)
    scratch, sums = np.empty(3 * n, np.uint32), np.empty(2)
    room, count = 16 * n + 64, _FULL
    while count == _FULL:
        borders = np.empty(room, np.uint32)
        made = scratch, rows, steps, owners, firsts, starts, borders, places, sums
        count = _kernels.find_fronts(offsets, neighbours, LEAF, float(WORK * n), *made)
        room *= 4
    if count == _TOO_MUCH:
        raise LimitError(
            f"the faces of a block of {n} vertices are too entangled: more than {WORK} operations a vertex; "
            "if this is a surface, take smaller blocks"
        )
    firsts, starts, places = firsts[: count + 1], starts[: count + 1], places[: count + 1]
    return Fronts(rows, steps, owners, firsts, starts, borders[: starts[-1]].copy(), places, sums)


PADDING = 15  # floats more than a kernel uses of an array that it begins where a cache line does


@dataclass(frozen=True, eq=False)
class Laplacian:
    """L of a block, and how it is factorised whatever is added to its diagonal."""

    block: Block
    fronts: Fronts
    weights: Matrix
    diagonal: Matrix


def laplacian_of(block: Block) -> Laplacian:
    """L of a block whose rows are in the order of a recursive bisection, with all weights one."""
    fronts = find_fronts(block.offsets, block.neighbours)
    return Laplacian(block, fronts, np.empty(0), block.degrees.astype(np.float64))


def weighted_laplacian(block: Block, weights: Matrix) -> Laplacian:
    """`laplacian_of` with the given weights, one for each entry of `block.neighbours`, shape (e,)."""
    rows = np.repeat(np.arange(block.size), block.degrees)
    diagonal: Matrix = np.bincount(rows, weights=weights, minlength=block.size).astype(np.float64)
    return Laplacian(block, find_fronts(block.offsets, block.neighbours), weights, diagonal)


@dataclass(frozen=True, eq=False)
class Factor:
    """L + delta I = P^T C D C^T P with C unit lower triangular."""

    fronts: Fronts
    values: Basis
    inverse: Basis


def factorize(laplacian: Laplacian, shift: float | Matrix) -> Factor:
    """Factorise L + delta I; `shift` is delta > 0, or one for every row, shape (n,)."""
    block, fronts, n = laplacian.block, laplacian.fronts, laplacian.block.size
    values, inverse = factor_room(fronts), np.empty(n, np.float32)
    column, scratch = np.empty(n + 1, np.uint32), np.empty(3 * (n + 16) + PADDING, np.float32)
    given = block.offsets, block.neighbours, laplacian.weights, laplacian.diagonal + shift, fronts
    _kernels.factorize_fronts(*given, column, scratch, values, inverse)
    return Factor(fronts, values, inverse)


def factor_room(fronts: Fronts) -> Basis:
    """Room for the values of a factor, shape (fronts.places[-1] + PADDING,)."""
    return np.empty(int(fronts.places[-1]) + PADDING, np.float32)


def solve(factor: Factor, columns: Matrix) -> Matrix:
    """R X for X of shape (n, c), rounded to single precision."""
    n, c = columns.shape
    check_rows(factor, n)
    solution = np.empty((n, c))
    columns = np.ascontiguousarray(columns)
    _kernels.solve_columns(factor.fronts, factor.values, factor.inverse, columns, solving_room(n, c), solution)
    return solution


def solving_room(rows: int, columns: int) -> Basis:
    """Scratch that a solution takes."""
    return np.empty((rows + 4) * (columns + 16) + PADDING, np.float32)


def check_rows(factor: Factor, rows: int) -> None:
    """Raise ValueError unless a factor is that of a matrix of so many rows."""
    if len(factor.inverse) != rows:
        raise ValueError(f"{rows} rows for a factor of {len(factor.inverse)}")


def dense_laplacian(block: Block) -> Matrix:
    """L of a block, with all weights one, as a dense matrix, shape (n, n)."""
    laplacian = np.zeros((block.size, block.size))
    laplacian[np.repeat(np.arange(block.size), block.degrees), block.neighbours] = -1.0
    np.fill_diagonal(laplacian, block.degrees)
    return laplacian
