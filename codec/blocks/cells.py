"""Cells of a mesh, the graph that blocks lie on one level up, and places of cells spread to vertices by smoothing.

A cell is a center and the vertices that are nearest to it by edges; centers are more than some edges apart. Both sides
find the same cells, since they see nothing but faces. Two cells are neighbors if vertices of them are; faces of cells
are those of the mesh whose corners are in three cells, and only give the local frames of cells.
"""

from dataclasses import dataclass

import numpy as np

from bsm._core import Cut
from bsm._core import codec as _kernels
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Basis, Faces, Indices, Levels, Matrix, Order
from bsm.codec.geometry.graph import Graph


@dataclass(frozen=True, eq=False)
class CellMesh:
    """The cell of each vertex, the graph of the cells, and their faces."""

    own: Indices
    graph: Graph
    faces: Faces


def cells_of(graph: Graph, faces: Faces, reach: int) -> CellMesh:
    """Cells of the vertices at most `reach` edges from their centers."""
    own, offsets, neighbors, rows = Cut(graph.offsets, graph.neighbors).cells(
        np.ascontiguousarray(faces, np.int32), reach
    )
    return CellMesh(own, Graph(offsets, neighbors), rows)


def prolonged(cells: CellMesh, graph: Graph, places: Matrix, rounds: int) -> Matrix:
    """Positions of the vertices, shape (n, 3), from those of their cells; the same for encoder and decoder."""
    # Single precision in between: a decoder does this for every scan, and the final levels are measured from its
    # result.
    positions, room = np.empty((graph.size, 3)), np.empty(8 * graph.size, np.float32)
    _kernels.prolong(
        graph.offsets,
        graph.neighbors,
        cells.own,
        np.ascontiguousarray(places),
        rounds,
        room,
        positions,
    )
    return positions


STEPS = 8  # of conjugate gradients; sixty come to the same bytes
# What bends between cells cost over errors of vertices: they take bits, and vertices hardly see them.
BENT = 0.1
COUPLED = 32  # entries of half a row that there is room for; rows have about 20


@dataclass(frozen=True, eq=False)
class Fit:
    """Places and levels of cells that bring the vertices of a mesh near their positions, shape (n, 3)."""

    cells: CellMesh
    graph: Graph
    positions: Matrix
    rounds: int

    @cached_property
    def places(self) -> Matrix:
        """Places of the cells, shape (m, 3), that are prolonged to about the positions."""
        own, size = self.cells.own, self.cells.graph.size
        sums = [np.bincount(own, column, size) for column in self.positions.T]
        places = np.column_stack(sums) / np.bincount(own, minlength=size)[:, None]
        self._fitted(places, STEPS)
        return places

    def level(
        self, frames: Matrix, steps: Matrix, places: Matrix, levels: Levels, first: int = 0
    ) -> None:
        """Change levels of cells at these places, of shape (m, 3), so that errors of neighbors cancel.

        `first` is the first axis whose levels may change."""
        pulls = self._fitted(places.copy(), 0)
        _kernels.level_cells(
            *self._coupling, np.ascontiguousarray(frames), steps, first, pulls, levels
        )

    def _fitted(self, places: Matrix, steps: int) -> Matrix:
        """Bring places nearer in a number of steps; returns where they are pulled from there."""
        coarse, pulls = self.cells.graph, np.empty(places.shape)
        room = np.empty(8 * self.graph.size + 24 * coarse.size, np.float32)
        given = (
            self.graph.offsets,
            self.graph.neighbors,
            self.cells.own,
            coarse.offsets,
            coarse.neighbors,
        )
        _kernels.fit_cells(*given, self.positions, self.rounds, BENT, steps, room, places, pulls)
        return pulls

    @cached_property
    def _coupling(self) -> tuple[Order, Indices, Basis, Matrix]:
        """Starts, ends and values of what an error of one cell costs beside that of another; and of itself."""
        own, fine, coarse = self.cells.own, self.graph, self.cells.graph
        n, m = fine.size, coarse.size
        bounds = np.cumsum([0, *np.bincount(own, minlength=m)], dtype=np.int32)
        order, most = np.argsort(own, kind="stable").astype(np.int32), COUPLED * m
        room, listed = np.empty(18 * n + m, np.float32), np.empty(18 * n + 3 * m + 1, np.int32)
        starts, ends, weights = (
            np.empty(m + 1, np.int64),
            np.empty(2 * most, np.int32),
            np.empty(m, np.float64),
        )
        below, half, values = (
            np.empty(most, np.int32),
            np.empty(most, np.float32),
            np.empty(2 * most, np.float32),
        )
        links = fine.offsets, fine.neighbors, bounds, order, coarse.offsets, coarse.neighbors
        count = _kernels.couple_cells(
            *links, self.rounds, BENT, room, listed, below, half, weights, starts, ends, values
        )
        return starts, ends[:count].copy(), values[:count].copy(), weights
