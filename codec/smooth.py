"""Smoothing in the decoder, by an amount that the stream carries.

Not in the paper. Coefficients that were quantized or left out show as roughness; a low-pass filter on the whole mesh
takes most of it away. The filter is a polynomial of degree 5 in the random-walk Laplacian K = I - D^-1 A, so a vertex
depends on five rings around it only and can be finished while the rest of the stream is still on its way.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from codec.graph import Graph, Indices

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
    if amount == 0.0:
        return positions
    return _filter(graph.offsets, graph.neighbours, positions, filter_polynomial(amount))


def smooth_some(graph: Graph, positions: Matrix, amount: float, vertices: Indices) -> Matrix:
    """The rows `vertices` of `smooth`, from positions that need to be known only `DEGREE` rings around them."""
    if amount == 0.0:
        return positions[vertices]
    rows, starts = _rings(graph.offsets, graph.neighbours, vertices, DEGREE)
    return _filter_rings(
        graph.offsets, graph.neighbours, positions, filter_polynomial(amount), rows, starts, len(vertices)
    )


def rings_around(graph: Graph, vertices: Indices, rings: int) -> Indices:
    """`vertices` and all others at most `rings` edges away."""
    return _rings(graph.offsets, graph.neighbours, vertices, rings)[0]


@njit(cache=True, nogil=True)
def _laplacian_row(offsets, neighbours, values, v, out):  # type: ignore[no-untyped-def]
    """out := (K values)[v]."""
    first, last = offsets[v], offsets[v + 1]
    x, y, z = 0.0, 0.0, 0.0
    for i in range(first, last):
        w = neighbours[i]
        x += values[w, 0]
        y += values[w, 1]
        z += values[w, 2]
    if last > first:
        share = 1.0 / (last - first)
        out[0] = values[v, 0] - share * x
        out[1] = values[v, 1] - share * y
        out[2] = values[v, 2] - share * z
    else:
        out[0], out[1], out[2] = 0.0, 0.0, 0.0


@njit(cache=True, nogil=True)
def _filter(offsets, neighbours, positions, powers):  # type: ignore[no-untyped-def]
    n = len(offsets) - 1
    current = positions.copy()
    following = np.empty_like(current)
    result = positions.copy()
    for k in range(DEGREE):
        for v in range(n):
            _laplacian_row(offsets, neighbours, current, v, following[v])
        current, following = following, current
        if k > 0:
            for v in range(n):
                for d in range(3):
                    result[v, d] += powers[k - 1] * current[v, d]
    return result


@njit(cache=True, nogil=True)
def _rings(offsets, neighbours, vertices, rings):  # type: ignore[no-untyped-def]
    """`vertices` and the rings around them; ring k ends before `starts[k]`."""
    n = len(offsets) - 1
    seen = np.zeros(n, np.bool_)
    rows = np.empty(n, np.int32)
    starts = np.empty(rings + 1, np.int64)
    count = 0
    for i in range(len(vertices)):
        if not seen[vertices[i]]:
            seen[vertices[i]] = True
            rows[count] = vertices[i]
            count += 1
    starts[0] = count
    head = 0
    for ring in range(rings):
        end = count
        while head < end:
            v = rows[head]
            head += 1
            for i in range(offsets[v], offsets[v + 1]):
                w = neighbours[i]
                if not seen[w]:
                    seen[w] = True
                    rows[count] = w
                    count += 1
        starts[ring + 1] = count
    return rows[:count].copy(), starts


@njit(cache=True, nogil=True)
def _filter_rings(offsets, neighbours, positions, powers, rows, starts, count):  # type: ignore[no-untyped-def]
    n = len(offsets) - 1
    current = np.empty((n, 3))
    following = np.empty((n, 3))
    for i in range(len(rows)):
        current[rows[i]] = positions[rows[i]]
    result = np.empty((count, 3))
    for r in range(count):
        result[r] = positions[rows[r]]
    for k in range(DEGREE):
        for i in range(starts[DEGREE - 1 - k]):
            _laplacian_row(offsets, neighbours, current, rows[i], following[rows[i]])
        current, following = following, current
        if k > 0:
            for r in range(count):
                for d in range(3):
                    result[r, d] += powers[k - 1] * current[rows[r], d]
    return result
