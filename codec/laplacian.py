"""The binary Laplacian of a block, L = D - A, and the solver behind R = (L + delta I)^-1 (paper, sections 3 and 4).

Equation 1 of the paper weighs edges by geometry; the decoder has only connectivity, so the weights here are one.
Sparse Cholesky factorisation in the nested-dissection order that the rows' own bisection implies, then forward and
back substitution for all columns of a subspace at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.blocks import Block
from codec.graph import Indices
from codec.panels import pack, unpack
from codec.simd import LANES, add_scaled, load, scaled, store

Matrix = npt.NDArray[np.float64]

_LANES = np.uint64(LANES)
_ONE = np.uint64(1)
_NONE = np.uint32(0xFFFFFFFF)


@dataclass(frozen=True, eq=False)
class Factor:
    """L + delta I = P^T C D C^T P with C unit lower triangular, stored by columns.

    Parameters
    ----------
    elimination : int32 array, shape (n,)
        Row eliminated at each step (the permutation P).
    starts, rows, values : arrays
        Columns of C below its diagonal.
    pivots : float64 array, shape (n,)
        Diagonal of D.
    """

    elimination: Indices
    starts: Indices
    rows: Indices
    values: Matrix
    pivots: Matrix


def factorize(block: Block, shift: float | Matrix) -> Factor:
    """Factorise L + delta I of a block; `shift` is delta > 0, or one for every row, shape (n,)."""
    return Factor(*factorize_csr(block.offsets, block.neighbours, np.broadcast_to(np.float64(shift), block.size)))


def solve(factor: Factor, columns: Matrix, power: int) -> Matrix:
    """R^z X for X of shape (n, c), C-contiguous, with z = `power` >= 1."""
    return _solve(
        factor.elimination,
        factor.starts,
        factor.rows,
        factor.values,
        factor.pivots,
        np.ascontiguousarray(columns),
        power,
    )


def dense_laplacian(block: Block) -> Matrix:
    """L of a block as a dense matrix, shape (n, n)."""
    laplacian = np.zeros((block.size, block.size))
    laplacian[np.repeat(np.arange(block.size), block.degrees), block.neighbours] = -1.0
    np.fill_diagonal(laplacian, block.degrees)
    return laplacian


@njit(cache=True, nogil=True)
def _dissection(offsets, neighbours):  # type: ignore[no-untyped-def]
    """Elimination order: at each cut of the rows into halves, the rows before the cut that see across it come last."""
    n = len(offsets) - 1
    # claim[r]: the widest cut whose separator holds row r, as (depth from above, or -1).
    first_of = np.empty(n, np.int32)
    last_of = np.empty(n, np.int32)
    claimed = np.zeros(n, np.bool_)
    for r in range(n):
        top = r
        for i in range(offsets[r], offsets[r + 1]):
            top = max(top, neighbours[i])
        if top > r:
            # The farthest neighbour is parted from r by the widest cut.
            first, last = 0, n
            while True:
                middle = (first + last) // 2
                if r < middle <= top:
                    break
                if r < middle:
                    last = middle
                else:
                    first = middle
            first_of[r], last_of[r], claimed[r] = first, last, True
    elimination = np.empty(n, np.int32)
    filled = n
    stack = np.empty((128, 2), np.int32)
    stack[0, 0], stack[0, 1] = 0, n
    depth = 1
    # Post-order written from the back: separator, then the right half, then the left one.
    while depth > 0:
        depth -= 1
        first, last = stack[depth, 0], stack[depth, 1]
        if last - first == 1:
            if not claimed[first]:
                filled -= 1
                elimination[filled] = first
            continue
        middle = (first + last) // 2
        for r in range(middle - 1, first - 1, -1):
            if claimed[r] and first_of[r] == first and last_of[r] == last:
                filled -= 1
                elimination[filled] = r
        stack[depth, 0], stack[depth, 1] = first, middle
        depth += 1
        stack[depth, 0], stack[depth, 1] = middle, last
        depth += 1
    return elimination


@njit(cache=True, nogil=True)
def factorize_csr(offsets, neighbours, shift):  # type: ignore[no-untyped-def]
    """Compiled body of `factorize`: up-looking (T. A. Davis, Direct Methods for Sparse Linear Systems, 2006, ch. 4)."""
    n = np.uint64(len(offsets) - 1)
    elimination = _dissection(offsets, neighbours)
    # Indices are unsigned in all loops: compiled code then need not provide for negative ones.
    offsets, neighbours = offsets.view(np.uint32), neighbours.view(np.uint32)
    row_at = elimination.view(np.uint32)
    step_of = np.empty(n, np.uint32)
    for k in range(n):
        step_of[row_at[k]] = k
    parent, starts = _elimination_tree(offsets, neighbours, row_at, step_of)
    rows = np.empty(starts[n], np.uint32)
    values = np.empty(starts[n], np.float64)
    pivots = np.empty(n, np.float64)
    work = np.zeros(n, np.float64)
    pattern = np.empty(n, np.uint32)
    path = np.empty(n, np.uint32)
    mark = np.full(n, _NONE, np.uint32)
    filled = starts[:-1].copy()
    for k in range(n):
        # The pattern of row k of C, in an order in which every step comes after those it needs.
        top = n
        mark[k] = k
        r = row_at[k]
        for i in range(offsets[r], offsets[r + _ONE]):
            j = step_of[neighbours[i]]
            if j < k:
                work[j] = -1.0
                length = np.uint64(0)
                while mark[j] != k:
                    path[length] = j
                    length += _ONE
                    mark[j] = k
                    j = parent[j]
                while length > np.uint64(0):
                    length -= _ONE
                    top -= _ONE
                    pattern[top] = path[length]
        pivot = offsets[r + _ONE] - offsets[r] + shift[r]
        for p in range(top, n):
            j = pattern[p]
            value = work[j]
            work[j] = 0.0
            for q in range(starts[j], filled[j]):
                work[rows[q]] -= values[q] * value
            scaled = value / pivots[j]
            pivot -= scaled * value
            rows[filled[j]] = k
            values[filled[j]] = scaled
            filled[j] += np.uint32(1)
        pivots[k] = pivot
    return elimination, starts.view(np.int32), rows.view(np.int32), values, pivots


@njit(cache=True, nogil=True)
def _elimination_tree(offsets, neighbours, row_at, step_of):  # type: ignore[no-untyped-def]
    """Parent of each step in the elimination tree, and where each column of C starts."""
    n = np.uint64(len(row_at))
    parent = np.full(n, _NONE, np.uint32)
    mark = np.full(n, _NONE, np.uint32)
    starts = np.zeros(n + _ONE, np.uint32)
    for k in range(n):
        mark[k] = k
        r = row_at[k]
        for i in range(offsets[r], offsets[r + _ONE]):
            j = step_of[neighbours[i]]
            while j < k and mark[j] != k:
                if parent[j] == _NONE:
                    parent[j] = k
                starts[j + _ONE] += np.uint32(1)
                mark[j] = k
                j = parent[j]
    for k in range(n):
        starts[k + _ONE] += starts[k]
    return parent, starts


@njit(cache=True, nogil=True)
def solve_panels(starts, rows, values, pivots, panels, power):  # type: ignore[no-untyped-def]
    """Overwrite panels of X, their rows in the order of elimination, by (C D C^T)^-power X."""
    n = np.uint64(len(pivots))
    starts, rows = starts.view(np.uint32), rows.view(np.uint32)
    for b in range(panels.shape[0]):
        x = panels[b].reshape(-1)
        for _ in range(power):
            for k in range(n):
                source = load(x, k * _LANES)
                for q in range(starts[k], starts[k + _ONE]):
                    place = rows[q] * _LANES
                    store(x, place, add_scaled(load(x, place), -values[q], source))
            for done in range(n):
                last = n - _ONE - done
                target = scaled(load(x, last * _LANES), 1.0 / pivots[last])
                for q in range(starts[last], starts[last + _ONE]):
                    target = add_scaled(target, -values[q], load(x, rows[q] * _LANES))
                store(x, last * _LANES, target)


@njit(cache=True, nogil=True)
def _solve(elimination, starts, rows, values, pivots, columns, power):  # type: ignore[no-untyped-def]
    panels = pack(columns, elimination)
    solve_panels(starts, rows, values, pivots, panels, power)
    return unpack(panels, elimination, columns.shape[1])
