"""The dictionaries of a sequence, and the way between vertices and coefficients."""

from dataclasses import dataclass

import numpy as np

from bsm.codec.arrays import Basis, Faces, Indices, Matrix, Positions
from bsm.codec.basis.laplacian import Factor, Held, cotangent_weights, hold, iteration_memory
from bsm.codec.signal.chain import Suspended, continued, key_dictionary
from bsm.codec.signal.transform import project, reconstruct
from bsm.codec.static.coding import Scheme
from bsm.codec.threads import ordered_map

PART_MEMORY, ROW_MEMORY = 6000.0, 352.0  # bytes that decoders keep for a part, and for each row
TETHER = 2.0**-16  # stiffness of each row's spring to the mean of the pulls; it places rows without other springs


@dataclass(frozen=True, eq=False)
class Part:
    """A part of the mesh and its dictionary."""

    held: Held
    factor: Factor
    basis: Basis

    @property
    def vertices(self) -> Indices:
        """Vertex of the mesh for each row, shape (n_i,)."""
        return self.held.laplacian.block.vertices

    @property
    def around(self) -> Indices:
        """Vertices of the mesh, shape (k_i,), of parts before, with edges to this one."""
        return self.held.around

    @property
    def width(self) -> int:
        return int(self.basis.shape[1])

    @property
    def memory(self) -> float:
        """Bytes that decoders keep of it, besides the dictionary."""
        return PART_MEMORY + ROW_MEMORY * len(self.vertices) + 8.0 * int(self.held.laplacian.fronts.places[-1])

    @property
    def making(self) -> float:
        """Bytes for making its dictionary, that itself included."""
        return iteration_memory(self.held.laplacian.fronts, self.width)

    def coefficients(self, values: Matrix, ends: Matrix) -> Matrix:
        """Return coefficients, (c_i, m), of values here, (n_i, m), minus their extension from `ends`, (k_i, m)."""
        return project(self.basis, values - self._extended(ends), self.width)

    def difference(self, wanted: Matrix, field: Matrix) -> Matrix:
        """Coefficients, shape (c_i, m), of a field less its prediction from the parts before."""
        return self.coefficients(wanted[self.vertices], field[self.around])

    def place(self, field: Matrix, difference: Matrix) -> None:
        """Fill this part of a field from its difference to the extension, shape (c_i, m)."""
        field[self.vertices] = reconstruct(self.basis, difference) + self._extended(field[self.around])

    def _extended(self, ends: Matrix) -> Matrix:
        """Rows, shape (n_i, m), that continue a field from its values `ends`, shape (k_i, m), around the part."""
        return continued(self.factor, self.held.springs, self.held.pulls(ends))


def make_parts(
    scheme: Scheme, faces: Faces, first_frame: Positions, *, width: int, threads: int | None
) -> tuple[Part, ...]:
    """All parts with dictionaries of up to `width` columns; weights are those of the decoded first frame, (n, 3)."""
    blocks, rules = scheme.blocks, scheme.rules
    graph = blocks.graph
    weights = cotangent_weights(graph, faces, first_frame)
    rank = np.empty(graph.size, np.int32)
    for index in range(blocks.count):
        rank[blocks.core(index)] = index

    def make(index: int) -> Part:
        held = hold(graph, weights, rank, blocks.part(index))
        factor = Suspended(held.laplacian, held.springs, TETHER).factor
        columns = min(width, len(blocks.core(index)))
        basis = key_dictionary(rules, Suspended(held.laplacian, held.springs, rules.shift), columns)
        return Part(held, factor, basis)

    return tuple(ordered_map(make, range(blocks.count), threads))
