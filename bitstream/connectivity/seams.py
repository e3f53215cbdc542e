"""Which fans of the conquered surface are the same vertex of the mesh, and faces that repeat a corner.

Where faces met at an edge in more than two or in opposite directions, both sides of the cut run along the same
vertices. So if a fan is a vertex met before, its neighbour along the boundary is likely a neighbour of that vertex
along the boundary of another of its fans: these are the candidates; a vertex that is none of them is told by number.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bitstream.connectivity.halfedges import match_halfedges
from bitstream.entropy.range_coder import Bank, Coder, code_mixed_bit, code_uniform, leaf, make_bank, overran

Ints = npt.NDArray[np.int32]

_CANDIDATES = 8
_REPEAT, _CANDIDATE = 0, 16
_SLOTS = 16 + 2 * _CANDIDATES


class Seams(NamedTuple):
    """Working memory for the vertices of fans.

    Attributes
    ----------
    vertex : int32 array
        Vertex of each fan, -1 as long as it is not known.
    after, before : int32 array
        Neighbour along the boundary, -1 for a fan inside the surface.
    sibling : int32 array
        The fan of the same vertex that was met before, -1 if none.
    latest : int32 array
        The latest fan of each vertex.
    candidates : int32 array
        Scratch.
    """

    vertex: Ints
    after: Ints
    before: Ints
    sibling: Ints
    latest: Ints
    candidates: Ints


def code_seams(coder: Coder, faces: Ints, vertices: Ints) -> tuple[int, Ints]:
    """Code the vertex of every fan; return the number of vertices, or -1 for nonsense, and the vertices.

    The writer gives them in `vertices`, numbered by first appearance; a reader gives as many -1.
    """
    seams = _make_seams(_find_borders(faces, len(vertices)))
    bank = make_bank(_SLOTS, 1, 1)
    return _code_fans(coder, bank, np.zeros(1, np.int64), vertices, seams), seams.vertex


def _find_borders(faces: Ints, fans: int) -> Ints:
    """The next fan along the boundary, -1 for a fan inside the surface."""
    origin = faces.reshape(-1)
    border = np.flatnonzero(match_halfedges(origin, fans) < 0)
    after = np.full(fans, -1, np.int32)
    after[origin[border]] = np.roll(faces, -1, axis=1).reshape(-1)[border]
    return after


def _make_seams(after: Ints) -> Seams:
    size = len(after)
    before = np.full(size, -1, np.int32)
    at_border = np.flatnonzero(after >= 0)
    before[after[at_border]] = at_border
    unknown = np.full(size, -1, np.int32)
    return Seams(unknown, after, before, unknown.copy(), np.empty(size, np.int32), np.empty(_CANDIDATES, np.int32))


@leaf
def _code_fans(coder: Coder, bank: Bank, contexts: npt.NDArray[np.int64], known: Ints, seams: Seams) -> int:
    vertex, after, before, sibling, latest, _ = seams
    count = 0
    for fan in range(len(vertex)):
        if overran(coder):
            return -1
        u = int(known[fan])
        # 0 inside, else 1 to 9: each neighbour along the boundary is not known yet, or new, or a repetition.
        contexts[0] = _REPEAT
        if after[fan] >= 0:
            contexts[0] += 1 + 3 * _state(seams, after[fan]) + _state(seams, before[fan])
        if code_mixed_bit(coder, bank, contexts, 0, 0, 1 if u < count else 0) != 0 and count > 0:
            u = _code_vertex(coder, bank, contexts, seams, fan, u, count)
            sibling[fan] = latest[u]
        else:
            u = count
            count += 1
        vertex[fan] = u
        latest[u] = fan
    return count


@leaf
def _state(seams: Seams, fan: int) -> int:
    if fan < 0 or seams.vertex[fan] < 0:
        return 0
    return 1 if seams.sibling[fan] < 0 else 2


@leaf
def _code_vertex(
    coder: Coder, bank: Bank, contexts: npt.NDArray[np.int64], seams: Seams, fan: int, u: int, count: int
) -> int:
    """Code a vertex below `count`: one of the candidates, or by number."""
    number = _find_candidates(seams, fan)
    for k in range(number):
        contexts[0] = _CANDIDATE + 2 * k + (1 if number > 1 else 0)
        if code_mixed_bit(coder, bank, contexts, 0, 0, 1 if u == seams.candidates[k] else 0) != 0:
            return seams.candidates[k]
    return code_uniform(coder, u, count)


@leaf
def _find_candidates(seams: Seams, fan: int) -> int:
    """List the vertices along the boundary next to all fans of the vertices next to `fan`, opposite direction first."""
    vertex, after, before, sibling, latest, candidates = seams
    number = 0
    for side in range(2):
        neighbour = after[fan] if side == 0 else before[fan]
        if neighbour < 0 or vertex[neighbour] < 0:
            continue
        other = latest[vertex[neighbour]]
        for _ in range(_CANDIDATES):
            for turn in range(2):
                beyond = before[other] if turn == side else after[other]
                if number == _CANDIDATES or beyond < 0 or vertex[beyond] < 0:
                    continue
                fresh = vertex[beyond] != vertex[neighbour]
                for k in range(number):
                    fresh = fresh and candidates[k] != vertex[beyond]
                if fresh:
                    candidates[number] = vertex[beyond]
                    number += 1
            other = sibling[other]
            if other < 0:
                break
    return number


@leaf
def code_degenerate(coder: Coder, corners: Ints, count: int) -> int:
    """Code the corners of degenerate faces, shape (3 * k,), each a vertex below `count` or the next new one.

    Fills `corners` when reading. Returns the number of vertices afterwards, or -1 for nonsense.
    """
    for i in range(len(corners)):
        corners[i] = code_uniform(coder, corners[i], count + 1)
        if corners[i] == count:
            count += 1
        if i % 3 == 2:
            a, b, c = corners[i - 2], corners[i - 1], corners[i]
            if overran(coder) or (a != b and b != c and c != a):
                return -1
    return count
