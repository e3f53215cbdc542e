"""Which fans of the conquered surface are the same vertex of the mesh, and faces that repeat a corner.

Where faces met at an edge in more than two or in opposite directions, both sides of the cut run along the same
vertices. So if a fan is a vertex met before, its neighbour along the boundary is likely a neighbour of that vertex
along the boundary of another of its fans: these are the candidates; a vertex that is none of them is told by number.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.connectivity.halfedges import match_halfedges
from bsm.bitstream.entropy.range_coder import Coder, make_bank

Ints = npt.NDArray[np.int32]

_SLOTS = 32


class Seams(NamedTuple):
    """Working memory for the vertices of fans."""

    vertex: Ints
    after: Ints
    before: Ints
    sibling: Ints
    latest: Ints


def code_seams(coder: Coder, faces: Ints, vertices: Ints) -> tuple[int, Ints]:
    """Code the vertex of every fan; return the number of vertices, or -1 for nonsense, and the vertices, shape (f,)."""
    seams = _make_seams(_find_borders(faces, len(vertices)))
    bank = make_bank(_SLOTS, 1, 1)
    return _kernels.code_fans(coder, bank, vertices, seams), seams.vertex


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
    vertex, sibling, latest = (np.empty(size, np.int32) for _ in range(3))
    return Seams(vertex, after, before, sibling, latest)


def code_degenerate(coder: Coder, corners: Ints, count: int) -> int:
    """Code the corners of degenerate faces, shape (3 * k,), each a vertex below `count` or the next new one."""
    return _kernels.code_degenerate(coder, corners, count)
