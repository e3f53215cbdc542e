"""How far each vertex may come to lie from its place: small parts keep their shape, near ones their order."""

from __future__ import annotations

import numpy as np

from bsm.codec.arrays import Indices, Matrix
from bsm.codec.geometry.graph import component_sizes
from bsm.codec.geometry.surface_distance import distances_to_surface
from bsm.codec.static.contract import Contract
from bsm.codec.static.preamble_encoding import Prepared

FINEST_PART = 0.1
"""No part is bound more tightly than this, over the bound of the whole: where that is 1 % of the diagonal, it is half a
pixel in a picture of 512."""
SHARE_OF_GAP = 0.45
"""How far both of two surfaces may come to each other, over what is between them."""
LEAST_GAP, MOST_PARTS = 2e-4, 64
"""Parts nearer to each other than this, in BSM units, touch, so that none is before the other; and of more parts than
these, none is asked how near it is to others."""


def reaches(prepared: Prepared, contract: Contract) -> Matrix:
    """In BSM units, shape (n,)."""
    whole = contract.reach(prepared.mesh.diagonal, prepared.units.scale)
    found = np.full(len(prepared.positions), whole)
    if not contract.by_part or len(component_sizes(prepared.graph)) == 1:
        return found
    count, part = _parts(prepared)
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, part, prepared.positions)
    np.maximum.at(high, part, prepared.positions)
    diagonals = np.sqrt(np.square(high - low).sum(axis=1)) * prepared.units.scale / prepared.mesh.diagonal
    found *= np.maximum(diagonals, FINEST_PART)[part].clip(max=1.0)
    if count <= MOST_PARTS:
        _keep_apart(prepared, part, low - 2.0 * whole, high + 2.0 * whole, found)
    return found


def _keep_apart(prepared: Prepared, part: Indices, low: Matrix, high: Matrix, found: Matrix) -> None:
    """Lower `found` so that no part comes before or behind another one; `low` and `high` are boxes around parts."""
    positions, faces = prepared.positions, prepared.mesh.faces
    of_face = part[faces[:, 0]]
    corners = positions[faces]
    first, last = corners.min(axis=1), corners.max(axis=1)
    for number in range(len(low)):
        near = (of_face != number) & (first <= high[number]).all(axis=1) & (last >= low[number]).all(axis=1)
        if not near.any():
            continue
        own, others = faces[of_face == number], faces[near]
        mine, theirs = np.unique(own), np.unique(others)
        gap = min(
            distances_to_surface(positions[mine], positions, others).min(),
            distances_to_surface(positions[theirs], positions, own).min(),
        )
        if gap >= LEAST_GAP:
            for some in (mine, theirs):
                found[some] = np.minimum(found[some], SHARE_OF_GAP * gap)


def _parts(prepared: Prepared) -> tuple[int, Indices]:
    """How many connected parts there are, and the one of each vertex, shape (n,)."""
    faces = prepared.mesh.faces
    least = np.arange(prepared.graph.size)
    while True:
        # Every corner of a face hooks what it hangs on to the least that one of them hangs on.
        hangs = least[faces]
        np.minimum.at(least, hangs.ravel(), np.repeat(hangs.min(axis=1), 3))
        while (least[least] != least).any():
            least = least[least]
        if (least[faces] == least[faces[:, :1]]).all():
            break
    names, part = np.unique(least, return_inverse=True)
    return len(names), part.astype(np.int32)
