"""The binary Laplacian of a block, L = D - A, and the solver behind R = (L + delta I)^-1 (paper, sections 3 and 4).

Equation 1 of the paper weighs edges by geometry; the decoder has only connectivity, so the weights here are one.
Sparse Cholesky factorisation front by front (`codec.basis.solver.fronts`), then forward and back substitution for all
columns of a subspace at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.basis.solver.fronts import Fronts, stride
from codec.basis.solver.panels import pack, unpack
from codec.basis.solver.simd import LANES, add_scaled, aligned, filled, load, scaled, store
from codec.blocks.overlap import Block

Matrix = npt.NDArray[np.float64]

_LANES = np.uint64(LANES)
_ZERO, _ONE, _TWO = np.uint64(0), np.uint64(1), np.uint64(2)
_NONE = np.uint32(0xFFFFFFFF)


@dataclass(frozen=True, eq=False)
class Factor:
    """L + delta I = P^T C D C^T P with C unit lower triangular.

    Parameters
    ----------
    fronts : Fronts
        The order of elimination P, and the pattern of C.
    values : float64 array
        The columns of C, as rows of the fronts' matrices.
    inverse : float64 array, shape (n,)
        Diagonal of D^-1.
    """

    fronts: Fronts
    values: Matrix
    inverse: Matrix


def factorize(block: Block, shift: float | Matrix) -> Factor:
    """Factorise L + delta I of a block; `shift` is delta > 0, or one for every row, shape (n,)."""
    return Factor(block.fronts, *_factorize(block.offsets, block.neighbours, block.degrees + shift, block.fronts))


def solve(factor: Factor, columns: Matrix, power: int) -> Matrix:
    """R^z X for X of shape (n, c), C-contiguous, with z = `power` >= 1."""
    solution: Matrix = _solve(factor.fronts, factor.values, factor.inverse, np.ascontiguousarray(columns), power)
    return solution


def dense_laplacian(block: Block) -> Matrix:
    """L of a block as a dense matrix, shape (n, n)."""
    laplacian = np.zeros((block.size, block.size))
    laplacian[np.repeat(np.arange(block.size), block.degrees), block.neighbours] = -1.0
    np.fill_diagonal(laplacian, block.degrees)
    return laplacian


@njit(cache=True, nogil=True)
def _factorize(offsets, neighbours, diagonal, fronts):  # type: ignore[no-untyped-def]
    """Factorise the matrix that has `diagonal`, and -1 for every edge; returns `values` and `inverse` of `Factor`.

    A front gets its part of the matrix, eliminates its own steps, and takes what they leave to the steps of its border
    straight to the fronts that own those.
    """
    # Indices are unsigned in all loops: compiled code then need not provide for negative ones.
    offsets, neighbours = offsets.view(np.uint32), neighbours.view(np.uint32)
    n, count = np.uint64(len(fronts.rows)), np.uint64(len(fronts.firsts) - 1)
    values = aligned(fronts.places[count])
    values[:] = 0.0
    inverse = np.empty(len(fronts.rows))
    column = np.empty(n + _ONE, np.uint32)
    row = aligned(len(fronts.rows) + 2 * LANES)
    for t in range(count):
        first, end, edge = fronts.firsts[t], fronts.firsts[t + _ONE], fronts.starts[t]
        own = end - first
        width = own + fronts.starts[t + _ONE] - edge
        apart = stride(width)
        front = values[fronts.places[t] : fronts.places[t + _ONE]]
        _find_columns(fronts, t, column)
        for k in range(own):
            r = fronts.rows[first + k]
            front[k * apart + k] += diagonal[r]
            for i in range(offsets[r], offsets[r + _ONE]):
                step = fronts.steps[neighbours[i]]
                if step > first + k:
                    front[k * apart + column[step]] -= 1.0
        for k in range(own):
            for p in range(k // _LANES * _LANES, apart, _LANES):
                lanes = load(front, k * apart + p)
                for i in range(k):
                    lanes = add_scaled(lanes, -front[i * apart + k] * inverse[first + i], load(front, i * apart + p))
                store(front, k * apart + p, lanes)
            inverse[first + k] = 1.0 / front[k * apart + k]
        owner, beside = _NONE, _ZERO
        for i in range(own, width):
            step = fronts.borders[edge + i - own]
            if step == n:
                break
            for p in range(i // _LANES * _LANES, apart, _LANES):
                lanes = filled(0.0)
                for k in range(own):
                    lanes = add_scaled(lanes, -front[k * apart + i] * inverse[first + k], load(front, k * apart + p))
                store(row, p, lanes)
            if fronts.owners[step] != owner:
                owner = fronts.owners[step]
                beside = _find_columns(fronts, owner, column)
            target = fronts.places[owner] + (step - fronts.firsts[owner]) * beside
            for j in range(i, width):
                later = fronts.borders[edge + j - own]
                if later < n:
                    values[target + column[later]] += row[j]
        for k in range(own):
            for p in range(_ZERO, apart, _LANES):
                store(front, k * apart + p, scaled(load(front, k * apart + p), inverse[first + k]))
    return values, inverse


@njit(cache=True, nogil=True)
def _find_columns(fronts, t, column):  # type: ignore[no-untyped-def]
    """Column of each of its steps in the matrix of front t; returns the stride of that matrix."""
    first, own = fronts.firsts[t], fronts.firsts[t + _ONE] - fronts.firsts[t]
    edge, size = fronts.starts[t], fronts.starts[t + _ONE] - fronts.starts[t]
    for j in range(own):
        column[first + j] = j
    for j in range(size):
        column[fronts.borders[edge + j]] = own + j
    return stride(own + size)


@njit(cache=True, nogil=True)
def solve_panels(fronts, values, inverse, panels, power):  # type: ignore[no-untyped-def]
    """Overwrite panels of X, their rows in the order of elimination, by (C D C^T)^-power X."""
    for b in range(panels.shape[0]):
        for _ in range(power):
            _substitute_forward(fronts, values, panels[b].reshape(-1))
            _substitute_back(fronts, values, inverse, panels[b].reshape(-1))


@njit(cache=True, nogil=True)
def _substitute_forward(fronts, values, x):  # type: ignore[no-untyped-def]
    for t in range(np.uint64(len(fronts.firsts) - 1)):
        first, own = fronts.firsts[t], fronts.firsts[t + _ONE] - fronts.firsts[t]
        edge, last = np.uint64(fronts.starts[t]), np.uint64(fronts.starts[t + _ONE])
        front, apart = np.uint64(fronts.places[t]), stride(own + last - edge)
        for i in range(_ONE, own):
            lanes = load(x, (first + i) * _LANES)
            for k in range(i):
                lanes = add_scaled(lanes, -values[front + k * apart + i], load(x, (first + k) * _LANES))
            store(x, (first + i) * _LANES, lanes)
        # Two rows of the border at a time: an addition takes longer than the processor needs to begin the next.
        for i in range(edge, last, _TWO):
            here, there = fronts.borders[i] * _LANES, fronts.borders[i + _ONE] * _LANES
            lanes, others = load(x, here), load(x, there)
            column = front + own + i - edge
            for k in range(own):
                source = load(x, (first + k) * _LANES)
                lanes = add_scaled(lanes, -values[column + k * apart], source)
                others = add_scaled(others, -values[column + k * apart + _ONE], source)
            store(x, here, lanes)
            store(x, there, others)


@njit(cache=True, nogil=True)
def _substitute_back(fronts, values, inverse, x):  # type: ignore[no-untyped-def]
    count = np.uint64(len(fronts.firsts) - 1)
    for done in range(count):
        t = count - _ONE - done
        first, own = fronts.firsts[t], fronts.firsts[t + _ONE] - fronts.firsts[t]
        edge, last = np.uint64(fronts.starts[t]), np.uint64(fronts.starts[t + _ONE])
        front, apart = np.uint64(fronts.places[t]), stride(own + last - edge)
        for below in range(own):
            k = own - _ONE - below
            row = front + k * apart
            lanes, others = scaled(load(x, (first + k) * _LANES), inverse[first + k]), filled(0.0)
            for i in range(edge, last, _TWO):
                column = row + own + i - edge
                lanes = add_scaled(lanes, -values[column], load(x, fronts.borders[i] * _LANES))
                others = add_scaled(others, -values[column + _ONE], load(x, fronts.borders[i + _ONE] * _LANES))
            for i in range(k + _ONE, own):
                lanes = add_scaled(lanes, -values[row + i], load(x, (first + i) * _LANES))
            store(x, (first + k) * _LANES, add_scaled(lanes, 1.0, others))


@njit(cache=True, nogil=True)
def _solve(fronts, values, inverse, columns, power):  # type: ignore[no-untyped-def]
    panels = pack(columns, fronts.rows)
    solve_panels(fronts, values, inverse, panels, power)
    return unpack(panels, fronts.rows, columns.shape[1])
