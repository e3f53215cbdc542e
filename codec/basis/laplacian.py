"""The Laplacian of a block, L = D - W, and the solver for R = (L + delta I)^-1 (paper, sections 3 and 4).

Equation 2 of the paper weighs edges by geometry; the decoder of a mesh has only connectivity, so all weights are one
there, while the frames of a sequence have a first one to weigh them by (`cotangent_weights`): decoders know that to
rounding, so that weights are smooth functions of it which make little of little: soft cotangents, whose denominators
stay away from zero, within soft bounds above zero (cotangents may be negative, and L indefinite, where a triangle is
obtuse; U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates", 1993, section 4).

The order of elimination is nested dissection along the bisection that ordered the rows. The rows before a cut that see
across it separate the two halves; they are eliminated after both. The rows of a separator, or of a half that is not cut
further, make a front: its own steps, and the later steps to which they lead, its border. A front is kept as a dense
matrix, one row for each of its own steps, own steps first and then the border; this costs some fill and buys vector
instructions (C. Ashcraft, R. Grimes, "The influence of relaxed supernode partitions on the multifrontal method", 1989).

Costs are nanoseconds of a core and bytes, as decoders estimate them: encoders leave out early what decoders would
refuse.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.bitstream.errors import LimitError, NumericError
from bsm.codec.arrays import Basis, Faces, Indices, Matrix, Positions
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import Graph

WORK = 1 << 16
"""Operations of a factorisation, per row, that are too many; surfaces in blocks of 8,000 take an eighth of them."""

_FULL, _TOO_MUCH = -1, -2
"""Answers of the kernel: not enough room for the borders, or too many operations."""


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


def find_fronts(offsets: npt.NDArray[np.int32], neighbors: npt.NDArray[np.int32]) -> Fronts:
    """Fronts of a graph whose rows are in the order of a recursive bisection; any order will do."""
    n = len(offsets) - 1
    rows, steps, owners = np.empty((3, n), np.uint32)
    firsts, starts, places = np.empty((3, n + 1), np.uint32)
    scratch, sums = np.empty(3 * n, np.uint32), np.empty(2)
    room, count = 16 * n + 64, _FULL
    while count == _FULL:
        borders = np.empty(room, np.uint32)
        made = scratch, rows, steps, owners, firsts, starts, borders, places, sums
        count = _kernels.find_fronts(offsets, neighbors, float(WORK * n), *made)
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


def laplacian_of(block: Block, weights: Matrix | None = None) -> Laplacian:
    """L of a block in the order of a recursive bisection; weights of `block.neighbors`, shape (e,), are one if None."""
    rows = np.repeat(np.arange(block.size), block.degrees)
    diagonal: Matrix = np.bincount(rows, weights=weights, minlength=block.size).astype(np.float64)
    fronts = find_fronts(block.offsets, block.neighbors)
    return Laplacian(block, fronts, np.empty(0) if weights is None else weights, diagonal)


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
    given = block.offsets, block.neighbors, laplacian.weights, laplacian.diagonal + shift, fronts
    _kernels.factorize_fronts(*given, column, scratch, values, inverse)
    return Factor(fronts, values, inverse)


def factor_room(fronts: Fronts) -> Basis:
    """Room for the values of a factor, shape (fronts.places[-1] + PADDING,)."""
    return np.empty(int(fronts.places[-1]) + PADDING, np.float32)


def solving_room(rows: int, columns: int) -> Basis:
    return np.empty((rows + 4) * (columns + 16) + PADDING, np.float32)


def check_rows(factor: Factor, rows: int) -> None:
    """Raise ValueError unless the factor belongs to a matrix with this many rows."""
    if len(factor.inverse) != rows:
        raise ValueError(f"{rows} rows for a factor of {len(factor.inverse)}")


def dense_laplacian(block: Block) -> Matrix:
    """L of a block, with all weights one, as a dense matrix, shape (n, n)."""
    laplacian = np.zeros((block.size, block.size))
    laplacian[np.repeat(np.arange(block.size), block.degrees), block.neighbors] = -1.0
    np.fill_diagonal(laplacian, block.degrees)
    return laplacian


ONCE = 5.0  # of each number of a dictionary, however often it is iterated
IN_DOUBLES = 2.0  # Onorm, over that in single precision


def factor_cost(fronts: Fronts) -> float:
    return float(fronts.sums[1]) / 6.0 + 50.0 * len(fronts.rows) + 4000.0


def solve_cost(fronts: Fronts, columns: int) -> float:
    """Return the work of one solution; columns are solved in panels of 64, a panel in vectors of 16."""
    return 50.0 + float(fronts.sums[0]) * (0.3 * -(-columns // 64) + 0.02 * _whole(columns))


def onorm_cost(rows: int, columns: int) -> float:
    """Work of one orthonormalization, nanoseconds."""
    whole = _whole(columns)
    return rows * (3.0 + 0.4 * whole + whole * whole / 80.0) + 3000.0


def dictionary_cost(fronts: Fronts, columns: int, power: int, iterations: int, apart: int = 0) -> float:
    """Work of making a dictionary, with Onorm after each solution, or in doubles after each `apart` of an iteration."""
    rows, solutions = len(fronts.rows), power * iterations
    onorms = IN_DOUBLES * iterations * -(-power // apart) if apart else solutions + 1.0
    rounds = solutions * solve_cost(fronts, columns) + onorms * onorm_cost(rows, columns)
    return ONCE * rows * _whole(columns) + rounds


def iteration_memory(fronts: Fronts, columns: int) -> int:
    """Bytes for finding a dictionary, at most, that itself included."""
    rows, whole = len(fronts.rows), _whole(columns)
    return 8 * (6 * rows * whole + 2 * whole * whole + int(fronts.places[-1])) + 500 * rows


def _whole(columns: int) -> int:
    return -(-columns // 16) * 16


def cotangent_weights(graph: Graph, faces: Faces, positions: Positions) -> Matrix:
    """Weight of every entry of `graph.neighbors`: half the cotangents opposite to the edge, softly bounded."""
    if positions.shape != (graph.size, 3):
        raise ValueError(f"positions of shape {positions.shape} for {graph.size} vertices")
    weights, positions = np.zeros(len(graph.neighbors)), np.ascontiguousarray(positions)
    if not _kernels.weigh_by_cotangents(graph.offsets, graph.neighbors, faces, positions, weights):
        raise NumericError("the first frame is too large for weights of its edges")
    return weights


@dataclass(frozen=True, eq=False)
class Held:
    """A part that springs connect to earlier, known parts: its edges to those parts."""

    laplacian: Laplacian
    springs: Matrix
    starts: Indices
    around: Indices
    outer: Indices
    stiffness: Matrix

    def pulls(self, ends: Matrix) -> Matrix:
        """Return, for each row, the sum of stiffness times the field at the other end: shape (n_i, m)."""
        pulls = np.empty((len(self.springs), ends.shape[1]))
        _kernels.pull(self.starts, self.outer, self.stiffness, np.ascontiguousarray(ends), pulls)
        return pulls


def hold(graph: Graph, weights: Matrix, rank: Indices, block: Block) -> Held:
    """Hang a part on the parts before it."""
    if len(weights) != len(graph.neighbors) or len(rank) != graph.size:
        raise ValueError(f"{len(weights)} weights and {len(rank)} ranks for a graph of {graph.size} vertices")
    vertices = block.vertices
    room = int((graph.offsets[vertices + 1] - graph.offsets[vertices]).sum())
    inner, springs = np.empty(len(block.neighbors)), np.empty(block.size)
    starts, outer, stiffness = np.empty(block.size + 1, np.int32), np.empty(room, np.int32), np.empty(room)
    given = graph.offsets, graph.neighbors, weights, rank, vertices, block.offsets, block.neighbors
    count = _kernels.hold(*given, inner, springs, starts, outer, stiffness)
    around, ends = np.unique(outer[:count], return_inverse=True)
    return Held(laplacian_of(block, inner), springs, starts, around, ends.astype(np.int32), stiffness[:count].copy())
