"""Which rows of a block are eliminated when: nested dissection along the bisection that ordered the rows.

The rows before a cut that see across it separate the two halves; they are eliminated after both. The rows of a
separator, or of a half that is not cut further, make a front: its own steps, and the later steps to which they lead,
its border. A front is kept as a dense matrix, one row for each of its own steps, own steps first and then the border;
this costs some fill and buys vector instructions (C. Ashcraft, R. Grimes, "The influence of relaxed supernode
partitions on the multifrontal method", 1989).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.errors import LimitError
from codec.basis.solver.simd import LANES

LEAF = 16
"""Halves of at most so many rows are not cut further."""

WORK = 1 << 16
"""Operations of a factorisation, per row, that are too many; surfaces in blocks of 8,000 take an eighth of them."""

_LANES = np.uint64(LANES)
_ONE, _TWO = np.uint64(1), np.uint64(2)
_NONE = np.uint32(0xFFFFFFFF)


class Fronts(NamedTuple):
    """The fronts of a block of n rows, in the order of elimination.

    Attributes
    ----------
    rows : uint32 array, shape (n,)
        Row that is eliminated at each step.
    steps : uint32 array, shape (n,)
        Its inverse: step at which each row is eliminated.
    owners : uint32 array, shape (n,)
        Front of each step.
    firsts : uint32 array, shape (t + 1,)
        First own step of each front.
    starts, borders : uint32 arrays
        Border of front f, ascending: `borders[starts[f]:starts[f + 1]]`, filled up to an even number of steps by a
        step that does not exist, n.
    places : uint32 array, shape (t + 1,)
        Where each front's matrix begins in an array of all of them; its rows are `stride` apart.
    """

    rows: npt.NDArray[np.uint32]
    steps: npt.NDArray[np.uint32]
    owners: npt.NDArray[np.uint32]
    firsts: npt.NDArray[np.uint32]
    starts: npt.NDArray[np.uint32]
    borders: npt.NDArray[np.uint32]
    places: npt.NDArray[np.uint32]


def find_fronts(offsets: npt.NDArray[np.int32], neighbours: npt.NDArray[np.int32]) -> Fronts:
    """Fronts of a graph (CSR) whose rows are in the order of a recursive bisection; any order will do.

    Raises
    ------
    LimitError
        If the graph has no small separators, as that of a surface has, and factorising it would take too long.
    """
    rows, firsts = _dissect(offsets, neighbours)
    work, *arrays = _find_borders(offsets, neighbours, rows, firsts)
    if work > WORK * len(rows):
        raise LimitError(
            f"the faces of a block of {len(rows)} vertices are too entangled: more than {WORK} operations a vertex; "
            "if this is a surface, take smaller blocks"
        )
    return Fronts(*arrays)


@njit(cache=True, nogil=True)
def stride(width: Any) -> Any:
    """Doubles from one row of a front's matrix to the next, `width` steps being in front and border."""
    return (np.uint64(width) + _LANES - _ONE) // _LANES * _LANES


@njit(cache=True, nogil=True)
def _dissect(offsets, neighbours):  # type: ignore[no-untyped-def]
    """Elimination order of a graph whose rows are in bisection order, and the first step of each front."""
    n = len(offsets) - 1
    # The widest cut between a row and its farthest later neighbour has the row in its separator.
    cut_of = np.zeros(n, np.int32)
    for r in range(n):
        top = neighbours[offsets[r + 1] - 1] if offsets[r + 1] > offsets[r] else r
        for i in range(offsets[r], offsets[r + 1]):
            top = max(top, neighbours[i])
        first, last = 0, n
        while top > r and last - first > LEAF:
            middle = (first + last) // 2
            if r < middle <= top:
                cut_of[r] = middle
                break
            if r < middle:
                last = middle
            else:
                first = middle
    rows = np.empty(n, np.uint32)
    firsts = np.empty(n + 1, np.uint32)
    count, filled_from = n, n
    firsts[count] = n
    stack = np.empty((64, 2), np.int64)
    stack[0, 0], stack[0, 1] = 0, n
    depth = 1
    # Post-order, written from the back: a separator, before it the right half, before that the left one.
    while depth > 0:
        depth -= 1
        first, last = stack[depth]
        cut = 0
        if last - first > LEAF:
            cut = (first + last) // 2
            stack[depth] = (first, cut)
            stack[depth + 1] = (cut, last)
            depth += 2
        before = filled_from
        for r in range((cut if cut > 0 else last) - 1, first - 1, -1):
            if cut_of[r] == cut:
                filled_from -= 1
                rows[filled_from] = r
        if filled_from < before:
            count -= 1
            firsts[count] = filled_from
    return rows, firsts[count:].copy()


@njit(cache=True, nogil=True)
def _find_borders(offsets, neighbours, row_at, first_of):  # type: ignore[no-untyped-def]
    """Operations for one factorisation, and the arrays of `Fronts`, from the first and the fourth of them.

    Gives up where the operations are too many.
    """
    offsets, neighbours = offsets.view(np.uint32), neighbours.view(np.uint32)
    n, count = np.uint64(len(row_at)), np.uint64(len(first_of) - 1)
    step_of = np.empty(n, np.uint32)
    front_of = np.empty(n, np.uint32)
    for t in range(count):
        for k in range(first_of[t], first_of[t + _ONE]):
            step_of[row_at[k]] = k
            front_of[k] = t
    starts = np.zeros(count + _ONE, np.uint32)
    borders = np.empty(16 * n + 64, np.uint32)
    mark = np.full(n, _NONE, np.uint32)
    # Fronts whose borders begin in the same front, as linked lists.
    child = np.full(count, _NONE, np.uint32)
    sibling = np.full(count, _NONE, np.uint32)
    size, work = np.uint64(0), 0.0
    for t in range(count):
        end = first_of[t + _ONE]
        if np.uint64(len(borders)) < size + n + _TWO:
            grown = np.empty(2 * len(borders) + len(row_at), np.uint32)
            grown[:size] = borders[:size]
            borders = grown
        begin = size
        for k in range(first_of[t], end):
            for i in range(offsets[row_at[k]], offsets[row_at[k] + _ONE]):
                step = step_of[neighbours[i]]
                if step >= end and mark[step] != t:
                    mark[step] = t
                    size = _insert(borders, begin, size, step)
        c = child[t]
        while c != _NONE:
            for i in range(starts[c], starts[c + _ONE]):
                step = borders[i]
                if end <= step < n and mark[step] != t:
                    mark[step] = t
                    size = _insert(borders, begin, size, step)
            c = sibling[c]
        if size > begin:
            owner = front_of[borders[begin]]
            sibling[t] = child[owner]
            child[owner] = t
            if (size - begin) % _TWO > 0:
                borders[size] = n
                size += _ONE
        starts[t + _ONE] = size
        own, width = end - first_of[t], end - first_of[t] + size - begin
        work += np.float64(own) * np.float64(width) ** 2
        if work > WORK * len(row_at):
            count = t + _ONE
            break
    places = np.zeros(count + _ONE, np.uint32)
    for t in range(count):
        own = first_of[t + _ONE] - first_of[t]
        places[t + _ONE] = places[t] + own * stride(own + starts[t + _ONE] - starts[t])
    return work, row_at, step_of, front_of, first_of, starts, borders[:size].copy(), places


@njit(cache=True, nogil=True)
def _insert(values, begin, end, value):  # type: ignore[no-untyped-def]
    """Insert into the ascending `values[begin:end]`; returns the new end."""
    place = end
    while place > begin and values[place - _ONE] > value:
        values[place] = values[place - _ONE]
        place -= _ONE
    values[place] = value
    return end + _ONE
