"""How far each vertex may come to lie from its place: small parts keep their shape, near ones their order."""

from __future__ import annotations

import numpy as np

from bsm.codec.arrays import Indices, Matrix
from bsm.codec.geometry.graph import component_sizes
from bsm.codec.static.contract import Contract
from bsm.codec.static.preamble import Prepared

FINEST_PART = 0.1
"""No part is bound more tightly than this, over the bound of the whole: where that is 1 % of the diagonal, it is half a
pixel in a picture of 512."""


def reaches(prepared: Prepared, contract: Contract) -> Matrix:
    """In BSM units, shape (n,)."""
    whole = contract.reach(prepared.mesh.diagonal, prepared.units.scale)
    found = np.full(len(prepared.positions), whole)
    if not contract.by_part:
        return found
    count, part = _parts(prepared)
    if count > 1:
        low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
        np.minimum.at(low, part, prepared.positions)
        np.maximum.at(high, part, prepared.positions)
        diagonals = np.sqrt(np.square(high - low).sum(axis=1)) * prepared.units.scale / prepared.mesh.diagonal
        found *= np.maximum(diagonals, FINEST_PART)[part].clip(max=1.0)
    return found


def _parts(prepared: Prepared) -> tuple[int, Indices]:
    """How many connected parts there are, and the one of each vertex, shape (n,)."""
    size, faces = prepared.graph.size, prepared.mesh.faces
    if len(component_sizes(prepared.graph)) == 1:
        return 1, np.zeros(size, np.int32)
    least = np.arange(size)
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
