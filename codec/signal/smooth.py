"""Smoothing in the decoder, by an amount that the stream carries.

Not in the paper. Coefficients that were quantized or left out show as roughness; a low-pass filter on the whole mesh
takes most of it away. The filter is a polynomial of degree 5 in the random-walk Laplacian K = I - D^-1 A, so a vertex
depends on five rings around it only and can be finished while the rest of the stream is still on its way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.geometry.graph import Graph, Indices

Matrix = npt.NDArray[np.float64]

DEGREE = 5
NODES = (0.4, 0.9, 1.4, 1.8)


def filter_polynomial(amount: float) -> Matrix:
    """Coefficients p_2 .. p_5 of p(x) = 1 + p_2 x^2 + ... + p_5 x^5.

    p(0) = 1 and p'(0) = 0; at four nodes in the spectrum of K, p equals 1 / (1 + alpha x^2), with alpha = `amount`.
    Newton's divided differences of (p(x) - 1) / x^2 = -alpha / (1 + alpha x^2), expanded.
    """
    table = [-amount / (1.0 + amount * x * x) for x in NODES]
    for level in range(1, len(NODES)):
        for i in range(len(NODES) - 1, level - 1, -1):
            table[i] = (table[i] - table[i - 1]) / (NODES[i] - NODES[i - level])
    powers = [0.0] * len(NODES)
    for i in range(len(NODES) - 1, -1, -1):
        # powers := powers * (x - node) + table entry
        powers = [(powers[k - 1] if k else table[i]) - NODES[i] * powers[k] for k in range(len(NODES))]
    return np.array(powers)


def smooth(graph: Graph, positions: Matrix, amount: float) -> Matrix:
    """Filter all positions, shape (n, 3); isolated vertices stay where they are."""
    return positions if amount == 0.0 else smoothing_spectrum(graph, positions).smoothed(amount)


@dataclass(frozen=True, eq=False)
class Spectrum:
    """What positions V filtered by any amount are a sum of.

    Parameters
    ----------
    positions : float64 array, shape (n, 3)
        V.
    terms : float64 array, shape (DEGREE - 1, n, 3)
        K^2 V to K^DEGREE V.
    """

    positions: Matrix
    terms: Matrix

    def smoothed(self, amount: float) -> Matrix:
        """`smooth` of the positions by `amount`."""
        result: Matrix = _combine(self.positions, self.terms, filter_polynomial(amount))
        return result

    def only(self, vertices: npt.NDArray[np.integer]) -> Spectrum:
        """The same of some of the vertices."""
        return Spectrum(self.positions[vertices], np.ascontiguousarray(self.terms[:, vertices]))


def smoothing_spectrum(graph: Graph, positions: Matrix) -> Spectrum:
    """Spectrum of `positions`, shape (n, 3)."""
    return Spectrum(positions, _powers(graph.offsets, graph.neighbours, positions))


class LocalFilter:
    """`smooth` for some vertices at a time, from positions that need to be known only `DEGREE` rings around them.

    Parameters
    ----------
    graph : Graph
    amount : float
    """

    def __init__(self, graph: Graph, amount: float) -> None:
        self._graph = graph
        self._amount = amount
        # Number of each vertex among those at hand; -1 between calls.
        self._number = np.full(graph.size, -1, np.int32)

    def around(self, vertices: Indices, rings: int) -> Indices:
        """`vertices` and all others at most `rings` edges away, ring after ring."""
        rows, _ = _rings(self._graph.offsets, self._graph.neighbours, self._number, vertices, rings)
        self._number[rows] = -1
        return rows

    def smoothed(self, positions: Matrix, vertices: Indices) -> Matrix:
        """The rows `vertices`, all different, of `smooth` of `positions`, shape (n, 3)."""
        if self._amount == 0.0:
            return positions[vertices]
        offsets, neighbours = self._graph.offsets, self._graph.neighbours
        rows, starts = _rings(offsets, neighbours, self._number, vertices, DEGREE)
        weights = filter_polynomial(self._amount)
        result: Matrix = _filter_rows(offsets, neighbours, self._number, positions, weights, rows, starts)
        self._number[rows] = -1
        return result


@njit(cache=True, nogil=True)
def _powers(offsets, neighbours, positions):  # type: ignore[no-untyped-def]
    """K^2 V to K^DEGREE V."""
    offsets, neighbours = offsets.view(np.uint32), neighbours.view(np.uint32)
    n = np.uint64(len(offsets) - 1)
    terms = np.empty((DEGREE, len(offsets) - 1, 3))
    for k in range(DEGREE):
        values = terms[k - 1] if k > 0 else positions
        for v in range(n):
            first, last = offsets[v], offsets[v + np.uint64(1)]
            x, y, z = 0.0, 0.0, 0.0
            for i in range(first, last):
                w = neighbours[i]
                x += values[w, 0]
                y += values[w, 1]
                z += values[w, 2]
            share = 1.0 / max(last - first, np.uint64(1))
            isolated = last == first
            terms[k, v, 0] = 0.0 if isolated else values[v, 0] - share * x
            terms[k, v, 1] = 0.0 if isolated else values[v, 1] - share * y
            terms[k, v, 2] = 0.0 if isolated else values[v, 2] - share * z
    return terms[1:]


@njit(cache=True, nogil=True)
def _combine(positions, terms, weights):  # type: ignore[no-untyped-def]
    result = np.empty_like(positions)
    for v in range(len(positions)):
        for d in range(3):
            value = positions[v, d]
            for k in range(DEGREE - 1):
                value += weights[k] * terms[k, v, d]
            result[v, d] = value
    return result


@njit(cache=True, nogil=True)
def _rings(offsets, neighbours, number, vertices, rings):  # type: ignore[no-untyped-def]
    """`vertices` and the rings around them; ring k ends before `starts[k]`; `number` becomes their place in the list.

    `number` is -1 everywhere before.
    """
    rows = np.empty(2 * len(vertices) + 64, np.int32)
    starts = np.empty(rings + 1, np.int64)
    count = 0
    for v in vertices:
        if number[v] < 0:
            number[v] = count
            rows[count] = v
            count += 1
    starts[0] = count
    head = 0
    for ring in range(rings):
        end = count
        while head < end:
            v = rows[head]
            head += 1
            if count + offsets[v + 1] - offsets[v] > len(rows):
                grown = np.empty(2 * (count + offsets[v + 1] - offsets[v]), np.int32)
                grown[:count] = rows[:count]
                rows = grown
            for i in range(offsets[v], offsets[v + 1]):
                w = neighbours[i]
                if number[w] < 0:
                    number[w] = count
                    rows[count] = w
                    count += 1
        starts[ring + 1] = count
    return rows[:count].copy(), starts


@njit(cache=True, nogil=True)
def _filter_rows(offsets, neighbours, number, positions, weights, rows, starts):  # type: ignore[no-untyped-def]
    """The filter on the innermost of the rings `rows`; each power of K is known on one ring less than the last."""
    current = np.empty((len(rows), 3))
    for r in range(len(rows)):
        current[r] = positions[rows[r]]
    following = np.empty((starts[DEGREE - 1], 3))
    result = current[: starts[0]].copy()
    for k in range(DEGREE):
        for r in range(starts[DEGREE - 1 - k]):
            first, last = offsets[rows[r]], offsets[rows[r] + 1]
            for d in range(3):
                total = 0.0
                for i in range(first, last):
                    total += current[number[neighbours[i]], d]
                following[r, d] = current[r, d] - (1.0 / (last - first)) * total if last > first else 0.0
        current, following = following, current
        if k > 0:
            for r in range(starts[0]):
                for d in range(3):
                    result[r, d] += weights[k - 1] * current[r, d]
    return result
