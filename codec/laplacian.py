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

Matrix = npt.NDArray[np.float64]


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


def factorize(block: Block, shift: float) -> Factor:
    """Factorise L + delta I of a block; `shift` is delta > 0."""
    return Factor(*_factorize(block.offsets, block.neighbours, shift))


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
def _factorize(offsets, neighbours, shift):  # type: ignore[no-untyped-def]
    """Up-looking sparse LDL^T (T. A. Davis, Direct Methods for Sparse Linear Systems, 2006, chapter 4)."""
    n = len(offsets) - 1
    elimination = _dissection(offsets, neighbours)
    step_of = np.empty(n, np.int32)
    for k in range(n):
        step_of[elimination[k]] = k
    parent = np.full(n, -1, np.int32)
    mark = np.full(n, -1, np.int32)
    counts = np.zeros(n, np.int32)
    for k in range(n):
        mark[k] = k
        r = elimination[k]
        for i in range(offsets[r], offsets[r + 1]):
            j = step_of[neighbours[i]]
            while j < k and mark[j] != k:
                if parent[j] == -1:
                    parent[j] = k
                counts[j] += 1
                mark[j] = k
                j = parent[j]
    starts = np.zeros(n + 1, np.int32)
    for k in range(n):
        starts[k + 1] = starts[k] + counts[k]
    rows = np.empty(starts[n], np.int32)
    values = np.empty(starts[n], np.float64)
    pivots = np.empty(n, np.float64)
    work = np.zeros(n, np.float64)
    pattern = np.empty(n, np.int32)
    path = np.empty(n, np.int32)
    filled = starts[:-1].copy()
    mark[:] = -1
    for k in range(n):
        top = n
        mark[k] = k
        r = elimination[k]
        for i in range(offsets[r], offsets[r + 1]):
            j = step_of[neighbours[i]]
            if j < k:
                work[j] = -1.0
                length = 0
                while mark[j] != k:
                    path[length] = j
                    length += 1
                    mark[j] = k
                    j = parent[j]
                while length > 0:
                    length -= 1
                    top -= 1
                    pattern[top] = path[length]
        pivot = offsets[r + 1] - offsets[r] + shift
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
            filled[j] += 1
        pivots[k] = pivot
    return elimination, starts, rows, values, pivots


@njit(cache=True, nogil=True)
def _solve(elimination, starts, rows, values, pivots, columns, power):  # type: ignore[no-untyped-def]
    n, c = columns.shape
    x = np.empty((n, c))
    for k in range(n):
        x[k] = columns[elimination[k]]
    for _ in range(power):
        for k in range(n):
            for q in range(starts[k], starts[k + 1]):
                value = values[q]
                target = x[rows[q]]
                source = x[k]
                for j in range(c):
                    target[j] -= value * source[j]
        for k in range(n - 1, -1, -1):
            target = x[k]
            scale = 1.0 / pivots[k]
            for j in range(c):
                target[j] *= scale
            for q in range(starts[k], starts[k + 1]):
                value = values[q]
                source = x[rows[q]]
                for j in range(c):
                    target[j] -= value * source[j]
    result = np.empty((n, c))
    for k in range(n):
        result[elimination[k]] = x[k]
    return result
