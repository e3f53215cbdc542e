"""The dictionaries of a sequence, and the way between vertices and coefficients."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bsm._core import Part as Coder
from bsm.codec.arrays import Faces, Indices, Matrix, Positions
from bsm.codec.signal.chain import Chain
from bsm.codec.static.coding import Scheme
from bsm.codec.threads import ordered_map


@dataclass(frozen=True, eq=False)
class Part:
    """A part of the mesh: its vertices, shape (n_i,), those around it, (k_i,), and columns of its dictionary."""

    coder: Coder
    vertices: Indices
    around: Indices
    width: int
    memory: float
    """Bytes that decoders keep of it, besides the dictionary."""
    making: float
    """Bytes for making its dictionary, that itself included."""

    def coefficients(self, values: Matrix, ends: Matrix) -> Matrix:
        """Return coefficients, (c_i, m), of values here, (n_i, m), minus their extension from `ends`, (k_i, m)."""
        found = np.empty((self.width, values.shape[1]))
        self.coder.coefficients(np.ascontiguousarray(values), np.ascontiguousarray(ends), found)
        return found

    def difference(self, wanted: Matrix, field: Matrix) -> Matrix:
        """Coefficients, shape (c_i, m), of a field less its prediction from the parts before."""
        return self.coefficients(wanted[self.vertices], field[self.around])

    def place(self, field: Matrix, difference: Matrix) -> None:
        """Fill this part of a field from its difference to the extension, shape (c_i, m)."""
        found = np.empty((len(self.vertices), field.shape[1]))
        self.coder.values(np.ascontiguousarray(difference), np.ascontiguousarray(field[self.around]), found)
        field[self.vertices] = found


def make_parts(scheme: Scheme, faces: Faces, first_frame: Positions, threads: int | None) -> tuple[Part, ...]:
    """All parts with their dictionaries; weights are those of the decoded first frame, shape (n, 3)."""
    whole = Chain(scheme.rules, scheme.blocks)
    whole.hang(faces, np.ascontiguousarray(first_frame))

    def make(index: int) -> Part:
        coder = Coder(whole, index)
        return Part(coder, *coder.facts())

    return tuple(ordered_map(make, range(scheme.blocks.count), threads))
